#include "grammar/derive/series.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "grammar/derive/builder.h"
#include "grammar/derive/expressions.h"
#include "modeler/core/random.h"

namespace sgm::derive {
namespace {

/// Turns that one series may have: memory is held for each.
constexpr size_t mostTurns = 1'000'000;

/// What a turn may not draw: the alternative before it, and of a shuffled series those of its round so far.
void exclude(std::vector<double>& weights, rules::Series series, const std::vector<uint32_t>& drawn,
             uint32_t previous) {
    const size_t turn = drawn.size();
    const auto kinds =
        static_cast<size_t>(std::count_if(weights.begin(), weights.end(), [](double w) { return w > 0; }));
    if (kinds < 2) return;
    if (previous != rules::none) weights[previous] = 0;
    if (series != rules::Series::Shuffled) return;
    for (size_t i = turn - turn % kinds; i < turn; ++i) weights[drawn[i]] = 0;
}

}  // namespace

uint32_t SeriesDraws::draw(std::span<const double> weights, rules::Series series, uint64_t stream, size_t turn,
                           uint32_t previous) {
    stream = combine(combine(stream, static_cast<uint64_t>(series)), previous);
    for (const double w : weights) stream = combine(stream, std::bit_cast<uint64_t>(w + 0.0));
    std::vector<uint32_t>& drawn = drawn_[stream];
    while (drawn.size() <= turn) {
        std::vector<double> left(weights.begin(), weights.end());
        exclude(left, series, drawn, drawn.empty() ? previous : drawn.back());
        const uint32_t at = drawByWeight(left, combine(stream, drawn.size()));
        if (at == none) return none;
        drawn.push_back(at);
    }
    return drawn[turn];
}

uint32_t drawInSeries(std::span<const double> weights, rules::Series series, uint32_t counter, uint64_t draw,
                      const Place& place, syntax::SourceSpan span) {
    if (!place.builder || !place.series || counter >= place.series->size() || counter >= place.locals.size())
        return drawByWeight(weights, combine(place.key, draw));
    if (Recording* recording = place.builder->recording()) recording->readsLocal();
    const double turn = std::floor(place.locals[counter].num());
    const uint64_t stream = combine((*place.series)[counter], draw);
    if (!(std::abs(turn) <= static_cast<double>(mostTurns))) {
        place.builder->monitor().fail(Error::Kind::Budget, "a series of draws has at most a million turns", span);
        return 0;
    }
    place.builder->monitor().noteChance();
    SeriesDraws& draws = place.builder->series();
    if (turn >= 1) return draws.draw(weights, series, stream, static_cast<size_t>(turn - 1));
    // Turns below the first run the other way, and the first of them stands beside it.
    const uint32_t first = draws.draw(weights, series, stream, 0);
    return draws.draw(weights, series, combine(stream, hashText("below")), static_cast<size_t>(-turn), first);
}

}  // namespace sgm::derive
