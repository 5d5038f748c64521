// The sizes of a split: which parts stand one behind the other, and how long each is.
// Enters: the checked parts and a length to fill. Leaves: places from low to high. Assumes one scope. Not for other
// folders.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "grammar/derive/parts_context.h"

namespace sgm::operations {

/// Parts no longer than this vanish (metres; of areas, square metres).
inline constexpr double leastPart = 1e-6;

/// Sizes of one part, or of several together.
struct Length {
    double fixed = 0;     ///< absolute and relative sizes
    double floating = 0;  ///< share of what is left; the wished length inside a repetition

    Length& operator+=(const Length& other) {
        fixed += other.fixed, floating += other.floating;
        return *this;
    }
    double wished() const { return fixed + floating; }
};

/// One part in its place.
struct Piece {
    const rules::Parts::Part* part = nullptr;
    Length length;
    uint64_t key = 0;                                ///< tells it from its neighbours
    std::vector<std::pair<uint32_t, double>> turns;  ///< locals that count its repetitions
    double from = 0, to = 0;                         ///< of the whole; filled by `placePieces`
};

/// The parts of a split in order, repetitions written out; floating sizes aren't shared out yet. `{ … }*` repeats to
/// the nearest whole where its parts can give way, else as often as it fits whole; sizes that are drawn are drawn for
/// every repetition. Nothing after a failure.
std::optional<std::vector<Piece>> layOut(derive::PartsContext& context, const rules::Parts& split, double whole);

/// Gives every piece its place: floating sizes share what fixed ones leave; what lies beyond the whole is cut off, with
/// a warning. Parts of the split for which nothing is left wherever it is derived are told as well.
void placePieces(derive::PartsContext& context, const rules::Parts& split, std::vector<Piece>& pieces, double whole);

/// Moves cuts between floating sizes onto the nearest of `lines` within `reach`; what is fixed keeps its length, and
/// every floating part a fifth of its own. Assumes placed pieces.
void snapCuts(std::vector<Piece>& pieces, std::vector<double> lines, double reach);

}  // namespace sgm::operations
