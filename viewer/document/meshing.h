// From a model to its mesh and to files: what the window's export and `sgm build` share.
// Enters: a model, a grid. Leaves: a mesh with the blocks it came from. Assumes a bounded model.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "modeler/export/exporter.h"
#include "modeler/mesh/polygonize.h"
#include "modeler/mesh/rebuild.h"
#include "viewer/document/model.h"

namespace sgm::viewer {

/// A mesh with the grid and blocks it came from.
struct MeshedModel {
    mesh::Grid grid;
    std::vector<mesh::Block> blocks;
    mesh::Mesh mesh;
    mesh::Counts counts;
};
Result<MeshedModel> makeMesh(const Model& model, const mesh::Grid& grid, const mesh::PolygonizeOptions& options,
                             Stages& stages, Progress* progress);
/// The same, taking what didn't change from the last mesh of `rebuild`; without blocks, which only volumes want.
Result<MeshedModel> makeMesh(const Model& model, const mesh::Grid& grid, mesh::Rebuild& rebuild, Stages& stages,
                             Progress* progress);

/// Why nothing is written of a model that has no surface at such cells.
Error noSurface(const Model& model, float cell_m);

/// The level set of the model for formats that hold volumes.
Result<volume::Volume> levelSet(const Model& model, const MeshedModel& meshed, int threads, Progress* progress);

/// What a file says of the model it holds: names, materials, seed, parameters. `mesh` or `volume` is the caller's to
/// set.
exporter::ExportInput exportInput(const Model& model, const std::filesystem::path& grammarFile);

/// How a file divides a mesh: by an object tree, where there is one, and by material.
struct Division {
    std::optional<ObjectTree> objects;
    bool byMaterial = true;

    /// Sets what a writer reads of it; this object has to stay until that has written.
    void applyTo(exporter::ExportInput& input) const {
        input.objects = objects ? &*objects : nullptr;
        input.byMaterial = byMaterial;
    }
};
/// The division that `objects` asks for, as lower::parseObjects reads it, "" being "material". Error::Usage for what
/// it can't read and for symbols that the model doesn't know.
Result<Division> divide(const Model& model, const std::string& objects);

}  // namespace sgm::viewer
