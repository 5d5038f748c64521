#include "grammar/incremental/pipeline.h"

#include <utility>

namespace sgm::incremental {

Status Pipeline::derive(std::shared_ptr<const rules::Grammar> grammar, const derive::Options& options,
                        Progress* progress) {
    const Status done = regrowth_.to(std::move(grammar), options, progress);
    lowered_ = lowered_ && done.ok() && !regrowth_.whole();
    return done;
}

Status Pipeline::lower(Progress* progress) {
    const bool follows = std::exchange(lowered_, false);
    const Status done = follows ? relowering_.follow(derivation(), regrowth_.changed(), progress)
                                : relowering_.startOver(derivation(), progress);
    lowered_ = done.ok();
    return done;
}

void Pipeline::compile() {
    if (relowering_.whole())
        recompiler_.startOver(model().graph, model().field);
    else
        recompiler_.follow(model().graph, model().field);
}

Status Pipeline::to(std::shared_ptr<const rules::Grammar> grammar, const derive::Options& options, Progress* progress) {
    if (const Status done = derive(std::move(grammar), options, progress); !done.ok()) return done;
    if (const Status done = lower(progress); !done.ok()) return done;
    compile();
    return Done{};
}

Result<const mesh::Mesh*> Pipeline::mesh(const mesh::Grid& grid, Progress* progress, mesh::Counts& counts) {
    return rebuild_.update(tape(), grid, progress, counts, recompiler_.whole() ? nullptr : &recompiler_.changed());
}

}  // namespace sgm::incremental
