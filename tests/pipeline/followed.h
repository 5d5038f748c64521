// A model followed through parameters by the incremental pipeline, compared with builds from the start.
// Enters: a grammar, then options. Leaves: failures where tree, field, parts or mesh differ. Assumes one grammar and
// lattice.
#pragma once

#include "grammar/pipeline/incremental.h"
#include "tests/derive/same.h"
#include "tests/mesh/mesh_bytes.h"

namespace sgm::pipeline {

using namespace testing_;

inline auto told(const Part& p) { return std::tuple(p.path.text(), p.source(), p.material, p.pose); }

/// A model followed through options, on one lattice, by marching cubes or crisp with halved cells.
class Followed {
public:
    Followed(std::shared_ptr<const rules::Grammar> grammar, int resolution,
             mesh::Surface surface = mesh::Surface::Cubes)
        : pipeline({.surface = surface, .threads = 2}),
          grammar_(std::move(grammar)),
          resolution_(resolution),
          surface_(surface) {}

    /// Brings the pipeline there, and compares with a build from the start; where that fails, so must the pipeline.
    void expectSame(const derive::Options& options) {
        const auto derivation = derive::derive(grammar_, options, nullptr);
        auto model = derivation.ok() ? lower::lower(*derivation, nullptr) : derivation.error();
        Context context;
        const Status done = pipeline.to(grammar_, options, context);
        ASSERT_EQ(done.ok(), model.ok());
        if (!done.ok()) {
            EXPECT_EQ(done.error().message, model.error().message);
            return;
        }
        testing_::expectSame(pipeline.derivation(), *derivation);
        const auto &parts = pipeline.model().provenance.parts, &wholeParts = (*model)->provenance.parts;
        ASSERT_TRUE(std::equal(parts.begin(), parts.end(), wholeParts.begin(), wholeParts.end(),
                               [](const Part& a, const Part& b) { return told(a) == told(b); }));
        EXPECT_EQ(pipeline.model().shapeOf, (*model)->shapeOf);
        const eval::Tape tape = eval::compile((*model)->graph, (*model)->field, (*model)->graph.constants());
        ASSERT_EQ(eval::fingerprint(pipeline.tape()), eval::fingerprint(tape));
        EXPECT_EQ(pipeline.tape().lipschitz(), tape.lipschitz());
        EXPECT_EQ(pipeline.model().field.bounds, (*model)->field.bounds);
        expectSameMesh({*derivation, std::shared_ptr<const lower::Model>(std::move(*model)), tape});
    }

    IncrementalPipeline pipeline;
    size_t blocksKept = 0, followed = 0;

private:
    void expectSameMesh(const Model& model) {
        const Box3f& bounds = model.lowered->field.bounds;
        if (cell_m_ == 0) cell_m_ = mesh::cellFor(bounds, resolution_);
        grid_ = mesh::gridToKeep(grid_, bounds, cell_m_, 1);
        Context context, wholeContext;
        context.threads = wholeContext.threads = 2;
        const auto again = pipeline.meshed(grid_, context);
        blocksKept += pipeline.rebuild().blocksKept();
        followed += pipeline.followed();
        const auto whole = makeMesh(model, grid_, {.surface = surface_}, wholeContext);
        ASSERT_EQ(again.ok(), whole.ok()) << (again.ok() ? whole : again).error().message;
        if (!whole.ok()) {
            EXPECT_EQ(again.error().message, whole.error().message);
            return;
        }
        ASSERT_EQ(mesh::bytesOf(again->mesh), mesh::bytesOf(whole->mesh));
    }

    std::shared_ptr<const rules::Grammar> grammar_;
    int resolution_;
    mesh::Surface surface_;
    mesh::Grid grid_;
    float cell_m_ = 0;
};

inline derive::Options defaults(const rules::Grammar& grammar, uint32_t start = 0) {
    derive::Options options;
    options.start = start;
    for (const rules::Param& p : grammar.params) options.params.push_back(p.value);
    return options;
}

}  // namespace sgm::pipeline
