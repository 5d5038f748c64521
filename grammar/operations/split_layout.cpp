#include "grammar/operations/split_layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "grammar/rules/value.h"
#include "modeler/core/random.h"

namespace sgm::operations {
namespace {

using derive::PartsContext;
using rules::Parts;
using Part = Parts::Part;
using Turns = std::vector<std::pair<uint32_t, double>>;

/// A piece, or the place of what repeats to fill: its pieces come in between.
struct Slot {
    Piece piece;
    const Part* fill = nullptr;
};

bool isFill(const Part& part) { return !part.repeated.empty() && !part.times; }

bool isDrawn(const Part& part) {
    return part.isDrawn ||
           std::any_of(part.repeated.begin(), part.repeated.end(), [](const Part& p) { return isDrawn(p); });
}

/// How often `{ … }*` fits into `room`: to the nearest whole where its parts can give way, else what fits whole.
double repetitions(const Length& once, double room, bool fillsAlone) {
    const double n = room / once.wished();
    if (once.floating <= 0) return std::floor(n + 1e-9);
    return std::max(std::floor(n + 0.5), fillsAlone ? 1.0 : 0.0);
}

class LayOut {
public:
    LayOut(PartsContext& context, double whole) : context_(context), whole_(whole) {}

    std::optional<std::vector<Piece>> run(const Parts& split) {
        std::vector<Slot> slots;
        if (!expand(split.parts, std::nullopt, {}, slots)) return std::nullopt;
        Length outside;
        for (const Slot& slot : slots)
            if (!slot.fill) outside += slot.piece.length;
        const double room = std::max(0.0, whole_ - outside.wished());
        std::vector<std::vector<Piece>> fills(slots.size());
        if (!fillUp(slots, room, outside.floating <= 0 && room > 0, fills)) return std::nullopt;
        std::vector<Piece> pieces;
        for (size_t i = 0; i < slots.size(); ++i) {
            if (!slots[i].fill) pieces.push_back(std::move(slots[i].piece));
            for (Piece& piece : fills[i]) pieces.push_back(std::move(piece));
        }
        return pieces;
    }

private:
    Length lengthOf(const Part& part, const Turns& turns, uint64_t key) {
        for (const auto& [local, turn] : turns) context_.count(local, turn);
        const rules::Value v = context_.evaluate(part.size, key);
        if (v.num() < -1e-9)
            context_.warn(part.size.span,
                          fmt::format("the size of a part is {} here, so the part is left out", rules::toText(v)),
                          "write 'max(0, …)' where that is meant");
        const double size = std::max(0.0, v.num());
        if (part.floating) return {0, size};
        return {v.units[0] == rules::Unit::Share ? size * whole_ : size, 0};
    }

    /// Parts one behind the other; `prefix` tells those of a repetition from others.
    bool expand(const std::vector<Part>& parts, std::optional<uint64_t> prefix, const Turns& turns,
                std::vector<Slot>& slots) {
        for (size_t p = 0; p < parts.size(); ++p) {
            const Part& part = parts[p];
            const uint64_t at = prefix ? combine(*prefix, p) : p;
            if (part.repeated.empty()) {
                const uint64_t key = prefix ? at : combine(at, 0);
                slots.push_back({{&part, lengthOf(part, turns, key), key, turns}, nullptr});
            } else if (isFill(part)) {
                slots.push_back({{&part, {}, at, turns}, &part});
            } else if (!times(part, at, turns, slots)) {
                return false;
            }
        }
        return true;
    }

    /// { … }3
    bool times(const Part& part, uint64_t at, const Turns& turns, std::vector<Slot>& slots) {
        for (const auto& [local, turn] : turns) context_.count(local, turn);
        const double count = std::floor(context_.evaluate(*part.times, combine(at, hashText("times"))).num() + 1e-9);
        for (double i = 1; i <= count; ++i) {
            Turns own = turns;
            own.emplace_back(part.local, i);
            if (!context_.work() || !expand(part.repeated, combine(at, static_cast<uint64_t>(i)), own, slots))
                return false;
        }
        return true;
    }

    /// The i-th repetition of a group that fills.
    std::vector<Piece> repetition(const Slot& slot, double i) {
        std::vector<Piece> pieces;
        Turns turns = slot.piece.turns, firstTurns = turns;
        turns.emplace_back(slot.fill->local, i);
        firstTurns.emplace_back(slot.fill->local, 1);
        for (size_t k = 0; k < slot.fill->repeated.size(); ++k) {
            const Part& part = slot.fill->repeated[k];
            const uint64_t first = combine(slot.piece.key, k), own = combine(first, static_cast<uint64_t>(i));
            if (!part.repeated.empty()) {
                std::vector<Slot> inner;
                if (!times(part, own, turns, inner)) return {};
                for (Slot& s : inner) pieces.push_back(std::move(s.piece));
            } else {
                // Sizes that aren't drawn for every repetition are those of the first.
                const bool isItsOwn = part.isDrawn && i > 1;
                const Length length = isItsOwn ? lengthOf(part, turns, own) : lengthOf(part, firstTurns, first);
                pieces.push_back({&part, length, own, turns});
            }
        }
        return pieces;
    }

    static Length sum(const std::vector<Piece>& pieces) {
        Length length;
        for (const Piece& piece : pieces) length += piece.length;
        return length;
    }

    /// Adds one repetition of every group; the length of all. Nothing after a failure.
    std::optional<Length> next(const std::vector<Slot>& slots, double i, std::vector<std::vector<Piece>>& added) {
        Length all;
        added.assign(slots.size(), {});
        for (size_t s = 0; s < slots.size(); ++s) {
            if (!slots[s].fill) continue;
            added[s] = repetition(slots[s], i);
            const Length once = sum(added[s]);
            if (once.wished() <= leastPart) {
                context_.fail(
                    "what repeats has no extent, so it would never fill the scope: give a part more than "
                    "0.000001m",
                    slots[s].fill->span);
                return std::nullopt;
            }
            all += once;
        }
        if (!context_.work()) return std::nullopt;
        return all;
    }

    bool fillUp(const std::vector<Slot>& slots, double room, bool fillsAlone, std::vector<std::vector<Piece>>& fills) {
        bool drawn = false, hasFill = false, once = fillsAlone;
        for (const Slot& slot : slots) {
            if (!slot.fill) continue;
            hasFill = true;
            drawn = drawn || isDrawn(*slot.fill);
            once = once || slot.fill->atLeastOnce;
        }
        if (!hasFill) return true;
        std::vector<std::vector<Piece>> added;
        double filled = 0;
        for (double i = 1, most = -1; most < 0 || i <= most; ++i) {
            const auto length = next(slots, i, added);
            if (!length) return false;
            const bool mustBe = i == 1 && once && (length->floating > 0 || atLeastOnce(slots));
            if (!drawn && i == 1) most = std::max(repetitions(*length, room, false), mustBe ? 1.0 : 0.0);
            const double after = filled + length->wished();
            const bool goesIn =
                length->floating > 0 ? after - room <= room - filled : after <= room * (1 + 1e-12) + 1e-9;
            if (drawn ? !goesIn && !mustBe : i > most) break;
            filled = after;
            for (size_t s = 0; s < slots.size(); ++s)
                for (Piece& piece : added[s]) fills[s].push_back(std::move(piece));
        }
        return true;
    }

    static bool atLeastOnce(const std::vector<Slot>& slots) {
        return std::any_of(slots.begin(), slots.end(), [](const Slot& s) { return s.fill && s.fill->atLeastOnce; });
    }

    PartsContext& context_;
    const double whole_;
};

/// Whether the nearest line lies within reach of one of the cuts from … to: by how much they would have to move.
std::optional<double> nearest(const std::vector<double>& lines, const std::vector<double>& cuts, double reach) {
    std::optional<double> best;
    for (const double cut : cuts) {
        const auto above = std::lower_bound(lines.begin(), lines.end(), cut);
        for (const auto line : {above, above == lines.begin() ? lines.end() : above - 1})
            if (line != lines.end() && std::abs(*line - cut) <= reach &&
                (!best || std::abs(*line - cut) < std::abs(*best)))
                best = *line - cut;
    }
    return best;
}

/// Whether a part is `nil` alone.
bool isNil(const Part& part) {
    if (!part.body || part.body->siblings.size() != 1 || part.body->siblings[0].size() != 1) return false;
    const rules::Solid* solid = part.body->siblings[0][0].content.solid();
    return solid && solid->kind == rules::Solid::Kind::Nil;
}

/// Notes of the parts that give way whether anything is left for them.
void noteParts(PartsContext& context, const Parts& split, const std::vector<Piece>& pieces, double whole) {
    for (const Part& part : split.parts) {
        if (!part.floating || isNil(part)) continue;
        const auto piece = std::find_if(pieces.begin(), pieces.end(), [&](const Piece& p) { return p.part == &part; });
        if (piece == pieces.end() || piece->length.wished() <= leastPart) continue;
        context.select(part.span, piece->to - piece->from > leastPart, [&] {
            const derive::Scope& root = context.place().tree->shapes[0].scope;
            const bool isOfStart = context.scope().size == root.size && root.size == Vec3d{1, 1, 1};
            return derive::Explanation{
                fmt::format("nothing is left of {:.4g}{} for this part", whole, split.byArea ? "m2" : "m"),
                isOfStart ? "the scope of a start is 1 m a side: write 'size (…)' before the split"
                          : "make the other sizes smaller, or what is split larger"};
        });
    }
}

}  // namespace

std::optional<std::vector<Piece>> layOut(PartsContext& context, const Parts& split, double whole) {
    return LayOut(context, whole).run(split);
}

void placePieces(PartsContext& context, const Parts& split, std::vector<Piece>& pieces, double whole) {
    Length all;
    for (const Piece& piece : pieces) all += piece.length;
    const double perFloat = all.floating > 0 ? std::max(0.0, whole - all.fixed) / all.floating : 0;
    double from = 0;
    bool isWarned = false;  // of the first part that is cut off; those behind it are as well
    for (Piece& piece : pieces) {
        const double wanted = piece.length.fixed + piece.length.floating * perFloat, left = whole - from;
        if (!isWarned && wanted > left + 1e-6 * std::max(1.0, whole)) {
            isWarned = true;
            context.warn(
                piece.part->span,
                fmt::format("this part is cut off: {:.4g}m are left for its {:.4g}m", std::max(0.0, left), wanted),
                "write '~' before a size, so that it gives way, or make the sizes fit");
        }
        piece.from = from;
        piece.to = from = std::min(whole, from + wanted);
    }
    noteParts(context, split, pieces, whole);
}

void snapCuts(std::vector<Piece>& pieces, std::vector<double> lines, double reach) {
    constexpr double leastShare = .2;
    std::sort(lines.begin(), lines.end());
    size_t before = 0;  // the floating part that the run of fixed ones lies behind
    while (before < pieces.size() && pieces[before].length.floating <= 0) ++before;
    while (before < pieces.size()) {
        size_t behind = before + 1;
        while (behind < pieces.size() && pieces[behind].length.floating <= 0) ++behind;
        if (behind == pieces.size()) return;
        std::vector<double> cuts{pieces[before].to};
        for (size_t i = before + 1; i < behind; ++i) cuts.push_back(pieces[i].to);
        const auto by = nearest(lines, cuts, reach);
        const auto keeps = [&](const Piece& p, double moved) {
            return p.to - p.from + moved >= leastShare * (p.to - p.from);
        };
        if (by && keeps(pieces[before], *by) && keeps(pieces[behind], -*by)) {
            pieces[before].to += *by;
            for (size_t i = before + 1; i < behind; ++i) pieces[i].from += *by, pieces[i].to += *by;
            pieces[behind].from += *by;
        }
        before = behind;
    }
}

}  // namespace sgm::operations
