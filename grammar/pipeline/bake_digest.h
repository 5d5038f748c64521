// What tells one bake from another, so that a task never goes on with the cells of another model.
// Enters: a derivation and what is asked of a bake. Leaves: a digest. Assumes nothing of either.
#pragma once

#include <string>

#include "grammar/pipeline/bake.h"

namespace sgm::pipeline {

/// The digest of everything that decides the bytes of a bake: the grammar's texts, the outlines, streets, maps, meshes
/// and textures that it reads, the derivation's way, start, parameters and seed, and the sizes of cells. Where files
/// lie and the order of tasks don't change it. O(bytes read).
std::string digestOf(const derive::Derivation& derivation, const BakeRequest& request);

}  // namespace sgm::pipeline
