// From a grammar to a mesh again and again while parameters change: every stage keeps what the change doesn't reach.
// Enters: options, a grid. Leaves: the derivation, model, tape and mesh that `derive`, `lower`, `compile`, `subdivide`
// and `polygonize` give, but for the order of the tape's constants. Assumes one caller at a time. What was asked for
// last changes in place: copy what is to stay. For a model once, call the doors themselves.
#pragma once

#include "grammar/derive/regrowth.h"
#include "grammar/lower/relowering.h"
#include "modeler/eval/recompiler.h"
#include "modeler/mesh/rebuild.h"

namespace sgm::incremental {

class Pipeline {
public:
    explicit Pipeline(mesh::PolygonizeOptions meshing = {}) : rebuild_(meshing) {}

    /// The stages to the tape, one after the other; or each by itself, in this order. Errors as of the doors; after one
    /// the next call starts over.
    Status to(std::shared_ptr<const rules::Grammar> grammar, const derive::Options& options, Progress* progress);
    Status derive(std::shared_ptr<const rules::Grammar> grammar, const derive::Options& options, Progress* progress);
    Status lower(Progress* progress);
    void compile();
    /// The mesh of the tape on a grid (mesh::gridToKeep); see mesh::Rebuild.
    Result<const mesh::Mesh*> mesh(const mesh::Grid& grid, Progress* progress, mesh::Counts& counts);

    const derive::Derivation& derivation() const { return regrowth_.derivation(); }
    const lower::Model& model() const { return relowering_.model(); }
    const eval::Tape& tape() const { return recompiler_.tape(); }
    /// Blocks that the last mesh made anew and kept.
    const mesh::Rebuild& rebuild() const { return rebuild_; }
    /// Shapes that the last derivation made anew.
    size_t shapesMade() const {
        return regrowth_.whole() ? derivation().tree.shapes.size() : regrowth_.changed().size();
    }
    /// True when no stage up to the tape started over.
    bool followed() const { return !regrowth_.whole() && !relowering_.whole() && !recompiler_.whole(); }

private:
    derive::Regrowth regrowth_;
    lower::Relowering relowering_;
    eval::Recompiler recompiler_;
    mesh::Rebuild rebuild_;
    bool lowered_ = false;  ///< the model is that of the derivation before
};

}  // namespace sgm::incremental
