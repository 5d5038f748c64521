// A model that follows its derivation: parts whose shapes stay as they are stay too.
// Enters: a derivation, and which of its shapes changed in place. Leaves: the model that `lower` gives. Assumes one
// thread. The graph is kept: the second time its numbers change, and where its nodes would too, the model starts over.
#pragma once

#include <memory>

#include "grammar/lower/lower.h"

namespace sgm::lower {

class Lowering;

class IncrementalLowering {
public:
    IncrementalLowering();
    ~IncrementalLowering();
    IncrementalLowering(IncrementalLowering&&) noexcept;
    IncrementalLowering& operator=(IncrementalLowering&&) noexcept;

    /// Lowers from the start; errors as of `lower`, after which nothing is kept.
    Status startOver(const derive::Derivation& derivation, Progress* progress);
    /// The same after `changed` shapes of that derivation got other numbers (derive::IncrementalDerivation): starts
    /// over where it must.
    Status follow(const derive::Derivation& derivation, std::span<const derive::ShapeId> changed, Progress* progress);
    /// Of the last good call; changes in place with the next one.
    Model& model() const { return *model_; }
    /// True when the last call started over; else the graph has the same nodes and slots as before, and parts their
    /// ids.
    bool whole() const { return whole_; }

private:
    std::unique_ptr<Model> model_;
    std::unique_ptr<Lowering> lowering_;
    bool whole_ = true;
};

}  // namespace sgm::lower
