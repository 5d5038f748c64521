// A derivation that follows its parameters: what a change doesn't reach stays as it is.
// Enters: options, again and again. Leaves: the very derivation that `derive` gives for them, and which shapes changed.
// Assumes one thread. Only pieces of work that read a changed number run again (recording.h); where they take another
// course the derivation starts over.
#pragma once

#include <memory>
#include <span>

#include "grammar/derive/derive.h"

namespace sgm::derive {

class IncrementalDerivation {
public:
    IncrementalDerivation();
    ~IncrementalDerivation();
    IncrementalDerivation(IncrementalDerivation&&) noexcept;
    IncrementalDerivation& operator=(IncrementalDerivation&&) noexcept;

    /// Derives with these options; errors as of `derive`, after which nothing is kept. Only parameters may differ from
    /// the last call's for anything to be kept, and `derive` ways always start over.
    Status to(std::shared_ptr<const rules::Grammar> grammar, const Options& options, Progress* progress);
    /// Of the last good call; changes in place with the next one.
    const Derivation& derivation() const;
    /// True when the last call started over; else ids, names and bonds are those from before.
    bool whole() const { return whole_; }
    /// Shapes whose scope, solid, amounts, values or noise the last call changed in place.
    std::span<const ShapeId> changed() const;

private:
    struct State;
    Status startOver(std::shared_ptr<const rules::Grammar> grammar, const Options& options, Progress* progress);
    bool follow(const Options& options, Progress* progress);

    std::unique_ptr<State> state_;
    bool whole_ = true;
};

}  // namespace sgm::derive
