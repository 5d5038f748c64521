// What `choose distinct` and `choose shuffled` draw along a repetition.
// Enters: weights and a stream. Leaves: an alternative for every turn. Assumes that turns are asked for in order as a
// rule, which makes each cost O(alternatives); a function of stream and weights, whatever was asked before.
#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "grammar/rules/grammar.h"

namespace sgm::derive {

/// The draws of all series so far.
class SeriesDraws {
public:
    /// The alternative of a turn from 0 on by weight (those below 0 count as 0), or rules::none when all weigh 0.
    /// A `previous` is what the first turn has to differ from.
    uint32_t draw(std::span<const double> weights, rules::Series series, uint64_t stream, size_t turn,
                  uint32_t previous = rules::none);

private:
    std::unordered_map<uint64_t, std::vector<uint32_t>> drawn_;  ///< by stream and weights
};

}  // namespace sgm::derive
