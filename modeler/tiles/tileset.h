// What workers leave beside their cells, and what is made of it: 3D Tiles 1.1 (OGC) and a manifest.
// Enters: a plan and a note a cell. Leaves: tileset.json, manifest.json. Assumes that all bytes follow from the plan,
// so that the same ones are made whoever baked the cells.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "modeler/core/result.h"
#include "modeler/tiles/cell_content.h"

namespace sgm::tiles {

/// What is baked into a folder: the same for every worker.
struct BakePlan {
    std::string model;  ///< digest of grammar, start, parameters, seed and the settings below
    std::string name;   ///< of the grammar's file
    double side_m = 256, cell_m = 2, objectCell_m = .3;
    std::vector<double> errors_m;  ///< by level: how far its content is off
    std::vector<Cell> cells;       ///< finest level first, each in Morton order
    uint64_t objects = 0, places = 0;
};

std::filesystem::path planFile(const std::filesystem::path& folder);
/// Of a cell's content, and of the note beside it.
std::filesystem::path contentFile(const std::filesystem::path& folder, const Cell& cell);
std::filesystem::path noteFile(const std::filesystem::path& folder, const Cell& cell);

/// Writes the plan where there is none. Error::Input where the folder holds another plan.
Status keepPlan(const BakePlan& plan, const std::filesystem::path& folder);
/// Error::Input where the folder holds another plan; none is fine.
Status checkPlan(const BakePlan& plan, const std::filesystem::path& folder);
/// Error::Input where there is none or it can't be read.
Result<BakePlan> readPlan(const std::filesystem::path& folder);

/// Notes a cell that is done: its figures, and the digest of its file, which is there unless the cell is empty.
Status noteCell(const std::filesystem::path& folder, const Cell& cell, const CellFigures& figures);
/// Whether a cell is done: its note is there.
bool isDone(const std::filesystem::path& folder, const Cell& cell);

/// Degrees; heights are the model's own.
struct EarthPlace {
    double latitude_deg = 0, longitude_deg = 0;
};

/// Writes tileset.json and manifest.json. Without a place the tileset stays where an earlier merge put it. With
/// `verify` the digests of all files are taken anew. Error::Input names the first cell that is missing or differs.
Status merge(const std::filesystem::path& folder, const std::optional<EarthPlace>& at, bool verify);

/// 32 hexadecimal digits that follow from the bytes.
std::string digestOf(std::string_view bytes);

}  // namespace sgm::tiles
