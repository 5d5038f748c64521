#include "grammar/pipeline/incremental.h"

#include <utility>

#include "grammar/pipeline/refining.h"
#include "grammar/pipeline/scene.h"

namespace sgm::pipeline {

Status IncrementalPipeline::derive(std::shared_ptr<const rules::Grammar> grammar, const derive::Options& options,
                                   Progress* progress) {
    const bool hadObjects = grafted_.has_value();
    grafted_.reset();
    const Status done = derivation_.to(std::move(grammar), options, progress);
    lowered_ = lowered_ && done.ok() && !derivation_.whole() && !hadObjects;
    if (!done.ok() || derivation().objects.empty()) return done;
    lowered_ = false;
    Context context{progress};
    derive::Derivation whole = derivation();
    const Status grafted = graftObjects(whole, Objects::Sketched, options.budget, context);
    if (grafted.ok()) grafted_ = std::move(whole);
    return grafted;
}

Status IncrementalPipeline::lower(Progress* progress) {
    const bool follows = std::exchange(lowered_, false);
    const Status done = follows ? lowering_.follow(derivation(), derivation_.changed(), progress)
                                : lowering_.startOver(derivation(), progress);
    lowered_ = done.ok();
    return done;
}

void IncrementalPipeline::compile() {
    if (lowering_.whole())
        compiler_.startOver(model().graph, model().field);
    else
        compiler_.follow(model().graph, model().field);
}

Status IncrementalPipeline::to(std::shared_ptr<const rules::Grammar> grammar, const derive::Options& options,
                               Context& context) {
    const Status derived = context.timed("derive", [&] { return derive(grammar, options, context.progress); });
    if (!derived.ok()) return derived;
    const Status lowered = context.timed("lower", [&] { return lower(context.progress); });
    if (!lowered.ok()) return lowered;
    context.timed("compile", [&] { return compile(), Done{}; });
    return Done{};
}

Model IncrementalPipeline::viewModel() const {
    return Model{derivation(), std::shared_ptr<const lower::Model>(std::shared_ptr<void>(), &model()), tape()};
}

Model IncrementalPipeline::copyModel() const { return Model{derivation(), withoutGraph(model()), tape()}; }

Result<MeshedModel> IncrementalPipeline::meshed(const mesh::Grid& grid, Context& context) {
    MeshedModel made;
    made.grid = grid;
    const auto whole = mesh(grid, context.progress, made.counts);
    if (!whole.ok()) return whole.error();
    made.mesh = **whole;
    context.stages.emplace_back("subdivide", made.counts.subdivideSeconds);
    context.stages.emplace_back("sample", made.counts.sampleSeconds);
    context.stages.emplace_back("polygonize", made.counts.polygonizeSeconds);
    if (meshing_.surface == mesh::Surface::Crisp && meshing_.halvings > 0) {
        auto missing = holdThinParts(viewModel(), made.mesh, grid, meshing_, context, made.counts);
        if (!missing.ok()) return missing.error();
        made.missing = std::move(*missing);
    }
    return made;
}

Result<const mesh::Mesh*> IncrementalPipeline::mesh(const mesh::Grid& grid, Progress* progress, mesh::Counts& counts) {
    return rebuild_.update(tape(), grid, progress, counts, compiler_.whole() ? nullptr : &compiler_.changed());
}

}  // namespace sgm::pipeline
