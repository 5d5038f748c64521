// Cells and objects of a baked city as USD text: a stage of payloads, point instancers over references.
// Enters: content in metres. Leaves: .usda files. Assumes y up; a program that lacks UsdGeomPointInstancer shows the
// ground alone.
#pragma once

#include <filesystem>
#include <vector>

#include "modeler/tiles/cell_content.h"

namespace sgm::tiles {

/// Writes an object as prim </Object>, all or nothing.
Status writeUsdObject(const LibraryObject& object, const std::filesystem::path& path);
/// Writes a cell about its centre as prim </Cell>: its ground as a mesh, its places as a PointInstancer. Objects'
/// `file` says where their .usda lies.
Status writeUsdCell(const CellContent& content, const std::filesystem::path& path);
/// Writes the stage: a payload a cell, at its centre.
struct UsdPayload {
    std::string name, file;
    Vec3d centre;
};
Status writeUsdStage(const std::vector<UsdPayload>& cells, const std::filesystem::path& path);

}  // namespace sgm::tiles
