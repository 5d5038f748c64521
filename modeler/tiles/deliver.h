// A baked folder as other programs take it: plain glTF, USD, height maps.
// Enters: a folder whose cells are all done. Leaves: folders beside them. Assumes nothing of the grammar.
#pragma once

#include <filesystem>

#include "modeler/core/progress.h"
#include "modeler/core/result.h"

namespace sgm::tiles {

enum class Delivery {
    Blender,  ///< blender/: plain .glb cells, a node a place, over a library of plain .glb objects
    Usd,      ///< usd/city.usda: a payload a cell, point instancers over references
    Heights   ///< heights/: 16-bit height maps of the ground
};

/// Writes the finest cells so. Error::Input where a cell is missing or damaged.
Status deliver(const std::filesystem::path& folder, Delivery delivery, Progress* progress);

}  // namespace sgm::tiles
