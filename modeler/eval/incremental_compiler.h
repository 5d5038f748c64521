// A tape that follows the numbers of its graph.
// Enters: a graph and a field; again after slots changed. Leaves: a tape of the same code with other numbers. Assumes
// that nodes stay as they are; where a number decides on the code (a product with 1), the tape starts over.
#pragma once

#include <memory>
#include <vector>

#include "modeler/eval/tape.h"

namespace sgm::eval {

/// Which numbers tell a tape from the one before it, of the same code.
struct NumbersChanged {
    std::shared_ptr<const std::vector<float>> before;  ///< the table of constants then
    std::vector<uint32_t> places;                      ///< in the table, ascending
};

class IncrementalCompiler {
public:
    IncrementalCompiler();
    ~IncrementalCompiler();
    IncrementalCompiler(IncrementalCompiler&&) noexcept;
    IncrementalCompiler& operator=(IncrementalCompiler&&) noexcept;

    /// Compiles as `compile`. The graph has to outlive this, or the next call.
    void startOver(const field::Graph& graph, const field::Field& field);
    /// The same graph and field node with other constants: gives the tape that `compile` gives, but for the order of
    /// its table of constants.
    void follow(const field::Graph& graph, const field::Field& field);
    /// Changes in place with the next call; copies keep.
    const Tape& tape() const;
    /// True when the last call started over.
    bool whole() const { return whole_; }
    /// Unless it did: what changed.
    const NumbersChanged& changed() const { return changed_; }

private:
    struct State;
    bool rebind(const field::Graph& graph, const field::Field& field);

    std::unique_ptr<State> state_;
    NumbersChanged changed_;
    bool whole_ = true;
};

}  // namespace sgm::eval
