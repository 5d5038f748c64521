// Variations of a grammar's parameters, and which of them are worth showing.
// Enters: a grammar and what is chosen of it. Leaves: settings as text, and verdicts. Assumes the choice resolves.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "cli/requests.h"
#include "modeler/mesh/connected_components.h"
#include "viewer/document/edits.h"

namespace sgm::cli {

/// Values for every parameter that may vary: drawn by `seed` alone, `spread` (0 … 1) of the way from the present ones
/// to any in their ranges; words and switches change with that chance. Rounded as a slider would, so that what is
/// written into a text gives the very same model.
std::vector<document::edits::NamedValue> variation(const rules::Grammar& grammar, const pipeline::ModelChoice& choice,
                                                   const std::set<std::string>& locked, double spread, uint64_t seed);

/// Whether any parameter may vary: a switch, choices or a range that isn't locked.
bool canVary(const rules::Grammar& grammar, const pipeline::ModelChoice& choice, const std::set<std::string>& locked);

/// What `degenerate` returns for a mesh of a few planes.
inline constexpr std::string_view featureless = "featureless";
/// Why a model isn't worth a look: nothing solid; mostly debris; parts in the air; or a few bare planes. Empty for a
/// good one. `cell_m` is that of the mesh.
std::optional<std::string> degenerate(const mesh::Mesh& mesh, float cell_m);

/// Whether more than a hundredth of a model, by the boxes of its solids, touches nothing that stands: a mesh tells then
/// whether it floats, and of narrow gaps only one of halved cells. O(n log n).
bool mayFloat(const derive::Derivation& derivation);

}  // namespace sgm::cli
