// From a grammar to a mesh again and again while parameters change: every stage keeps what the change doesn't reach.
// Enters: options, a grid. Leaves: the derivation, model, tape and mesh that `derive`, `lower`, `compile`, `subdivide`
// and `polygonize` give, but for the order of the tape's constants. Assumes one caller at a time. What was asked for
// last changes in place: copy what is to stay. For a model once, call the stages themselves.
#pragma once

#include "grammar/derive/incremental_derivation.h"
#include "grammar/lower/incremental_lowering.h"
#include "grammar/pipeline/meshing.h"
#include "modeler/eval/incremental_compiler.h"
#include "modeler/mesh/rebuild.h"

namespace sgm::pipeline {

class IncrementalPipeline {
public:
    explicit IncrementalPipeline(mesh::PolygonizeOptions meshing = {}) : meshing_(meshing), rebuild_(meshing) {}

    /// The stages to the tape, one after the other ("derive", "lower", "compile"); or each by itself, in this order.
    /// Errors as of the stages; after one the next call starts over.
    Status to(std::shared_ptr<const rules::Grammar> grammar, const derive::Options& options, Context& context);
    Status derive(std::shared_ptr<const rules::Grammar> grammar, const derive::Options& options, Progress* progress);
    Status lower(Progress* progress);
    void compile();
    /// The mesh of the tape on a grid (mesh::gridToKeep); see mesh::Rebuild.
    Result<const mesh::Mesh*> mesh(const mesh::Grid& grid, Progress* progress, mesh::Counts& counts);
    /// That mesh with its grid and counts, without blocks, and with cells halved as in makeMesh, whose stages it has.
    Result<MeshedModel> meshed(const mesh::Grid& grid, Context& context);

    /// The model of the last `to`, valid until the next call.
    Model viewModel() const;
    /// The model of the last `to`, which stays. Its graph is empty, its tape says all that is drawn or meshed.
    Model copyModel() const;
    const derive::Derivation& derivation() const { return grafted_ ? *grafted_ : derivation_.derivation(); }
    const lower::Model& model() const { return lowering_.model(); }
    const eval::Tape& tape() const { return compiler_.tape(); }
    /// Blocks that the last mesh made anew and kept.
    const mesh::Rebuild& rebuild() const { return rebuild_; }
    /// Shapes that the last derivation made anew.
    size_t shapesMade() const {
        return derivation_.whole() || grafted_ ? derivation().tree.shapes.size() : derivation_.changed().size();
    }
    /// True when no stage up to the tape started over.
    bool followed() const { return !grafted_ && !derivation_.whole() && !lowering_.whole() && !compiler_.whole(); }

private:
    const mesh::PolygonizeOptions meshing_;
    derive::IncrementalDerivation derivation_;
    std::optional<derive::Derivation> grafted_;  ///< with the objects that it places, where there are any
    lower::IncrementalLowering lowering_;
    eval::IncrementalCompiler compiler_;
    mesh::Rebuild rebuild_;
    bool lowered_ = false;  ///< the model is that of the derivation before
};

}  // namespace sgm::pipeline
