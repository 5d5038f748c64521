// The mesh prims of a .usda file. For usda.cpp only.
#pragma once

#include <string>
#include <vector>

#include "modeler/export/out_file.h"
#include "modeler/export/surface.h"
#include "modeler/export/texture_sets.h"

namespace sgm::exporter {

/// What all mesh prims of a file share.
struct UsdSurface {
    const ExportInput& input;
    const TextureSets& texture;
    const PatchedMesh& patched;
    const std::vector<std::string>& materialNames;
    const std::string& root;  ///< path of the default prim, below which the materials are
};

/// "(x, y, z)".
std::string usdTuple(Vec3f v);

/// Writes the prim "Surface" of one object, whose patches are [begin, end). `local` has an element a mesh vertex, for
/// this function's use; what it holds between calls means nothing.
void writeUsdMesh(OutFile& out, const UsdSurface& surface, std::vector<uint32_t>& local, size_t begin, size_t end);

}  // namespace sgm::exporter
