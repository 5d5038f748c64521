// What files hold of a model beside its mesh, and all of it as the exporters read it: what the window's export, `sgm
// build` and programs that link the library share. Enters: a model, its mesh, what is asked for. Leaves: products, from
// which any number of files can be written.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "grammar/pipeline/colliders.h"
#include "grammar/pipeline/mesh_edits.h"
#include "grammar/pipeline/meshing.h"
#include "modeler/export/exporter.h"
#include "modeler/mesh/levels.h"

namespace sgm::pipeline {

/// How a file divides a mesh: by an object tree, where there is one, and by material.
struct Division {
    std::optional<ObjectTree> objects;
    bool byMaterial = true;
};
/// The division that `objects` asks for, as lower::parseObjects reads it, "" being "material". Error::Usage for what
/// it can't read and for symbols that the model doesn't know.
Result<Division> divide(const Model& model, const std::string& objects);

/// What a file says of the model it holds: name, seed, parameters, materials. The mesh, volume or solid tree is the
/// caller's to set.
exporter::ExportInput exportInput(const Model& model, const std::filesystem::path& grammarFile);

/// What is wanted beside the mesh.
struct ProductRequest {
    Division division;
    std::string collider;  ///< "boxes", "convex" or "mesh", "" for none
    int levels = 1;        ///< of detail, the finest included
    bool levelSet = false;
    bool flipNormals = false;         ///< the mesh was turned inside out, and so are its levels
    MeshEdits edits;                  ///< that the mesh had
    mesh::PolygonizeOptions meshing;  ///< that it was made with
};

/// A model as files hold it.
struct Products {
    mesh::Mesh mesh;
    Division division;
    Colliders colliders;
    std::vector<mesh::LevelOfDetail> levels;  ///< the coarser ones
    std::optional<volume::Volume> levelSet;

    /// Sets what a writer reads of these; they have to stay until it has written.
    void applyTo(exporter::ExportInput& input) const;
};
/// Stages "colliders", "levels of detail" and "level set", for a mesh that is edited already; `meshed` has the grid and
/// blocks it came from. The errors of makeColliders, mesh::makeLevels and volume::sample.
Result<Products> makeProducts(const Model& model, const MeshedModel& meshed, mesh::Mesh mesh, ProductRequest request,
                              Context& context);

/// Writes a mesh of the model in the format that the file's ending names, divided by material: all or nothing. The
/// errors of exporter::write.
Status writeMesh(const Model& model, const mesh::Mesh& mesh, const std::filesystem::path& file, Context& context);

/// The model's solid tree, for formats that hold it; Error::Input, located, where the model isn't exactly one.
Result<field::SolidTree> makeSolidTree(const Model& model, Context& context);

}  // namespace sgm::pipeline
