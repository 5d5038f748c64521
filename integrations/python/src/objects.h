// What Python holds of the library: grammars, models, meshes, level sets and models that follow their parameters.
// Enters: arguments of Python. Leaves: objects that own what their arrays show. Assumes Python's lock.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "grammar/pipeline/incremental.h"
#include "grammar/pipeline/mesh_edits.h"
#include "grammar/pipeline/meshing.h"
#include "grammar/pipeline/scene.h"
#include "modeler/core/pages.h"
#include "modeler/volume/dense.h"

namespace sgm::python {

using Points = pybind11::array_t<float, pybind11::array::c_style | pybind11::array::forcecast>;

/// A checked grammar with what the checker warned of.
struct Grammar {
    std::shared_ptr<const rules::Grammar> rules;
    std::string warnings;  ///< JSON, as syntax::toJson has it
};

/// A model, with the times of its stages.
struct Model {
    std::shared_ptr<const pipeline::Model> made;
    pipeline::Stages stages;
    int threads = 0;
    bool apart = false;  ///< the objects that `place` puts are left out of the field
};

/// How a mesh is made.
struct MeshRequest {
    int resolution = 128;
    double cell_m = 0;  ///< > 0 wins over resolution
    mesh::Surface surface = mesh::Surface::Crisp;
    pipeline::MeshEdits edits;
};

/// A mesh as flat arrays, with the chunks they were made of.
struct Mesh {
    std::shared_ptr<const pipeline::Model> model;  ///< null for an object of a scene
    std::shared_ptr<const Provenance> provenance;
    std::string name;  ///< of an object of a scene
    mesh::Mesh chunks;
    mesh::Grid grid;
    mesh::Counts counts;
    mesh::PolygonizeOptions meshing;
    pipeline::MeshEdits edits;
    pipeline::Stages stages;
    int threads = 0;
    // Filled where the mesh has several chunks or vertices that count in others.
    PageVector<Vec3f> positions, normals, cornerNormals;
    PageVector<mesh::Triangle> triangles;
    PageVector<OriginId> origins;

    /// The arrays are those of the only chunk.
    bool isOneChunk() const;
    /// Fills positions, normals, triangles and origins, in parallel.
    void flatten();
};

/// The objects of a model and their places.
struct Scene {
    std::shared_ptr<const pipeline::Model> model;
    pipeline::MadeScene made;
    std::vector<std::shared_ptr<Mesh>> meshes;  ///< by object
    std::vector<uint32_t> objectOf;             ///< by place
    std::vector<double> matrices;               ///< 16 a place, row after row
    pipeline::Stages stages;
    int threads = 0;
};

/// A level set, with its array once it is asked for.
struct LevelSet {
    std::shared_ptr<const pipeline::Model> model;
    volume::Volume volume;
    float voxel_m;
    std::optional<volume::Dense> dense;
    pipeline::Stages stages;
};

/// A model whose parameters change, with the stages that keep what a change doesn't reach.
struct Live {
    std::shared_ptr<const rules::Grammar> rules;
    MeshRequest request;
    int threads = 0;
    mesh::Grid grid;
    std::unique_ptr<pipeline::IncrementalPipeline> pipeline;
    bool isInUse = false;  ///< by a call that runs; read and written with Python's lock held
};

/// What chooses a model: arguments of `Grammar.model` and `Live.mesh`.
struct Choice : pipeline::ModelChoice {
    /// The options of the choice; throws its errors.
    derive::Options optionsFor(const rules::Grammar& grammar) const;
};

/// Edits, as the arguments of `Model.mesh` say them; throws ValueError for words and numbers that mean nothing.
MeshRequest requestOf(int resolution, std::optional<double> cell_m, const std::string& surface, const std::string& keep,
                      int smooth, double simplify, std::optional<double> tolerance_m);

/// Makes a Mesh of what was meshed: drops components, edits, flattens.
Result<std::shared_ptr<Mesh>> finish(std::shared_ptr<const pipeline::Model> model, pipeline::MeshedModel meshed,
                                     const MeshRequest& request, pipeline::Context& context);

/// The scene of a model whose objects are apart; `most` places.
Scene sceneOf(const Model& model, const MeshRequest& request, uint64_t most, const pybind11::object& progress);

/// The stages as {name: seconds}.
pybind11::dict dictOf(const pipeline::Stages& stages);
/// ((x, y, z), (x, y, z)).
pybind11::tuple tupleOf(const Box3f& box);

void bindGrammar(pybind11::module_& module);
void bindModel(pybind11::module_& module);
void bindMesh(pybind11::module_& module);
void bindScene(pybind11::module_& module);
void bindLevelSet(pybind11::module_& module);
void bindLive(pybind11::module_& module);

}  // namespace sgm::python
