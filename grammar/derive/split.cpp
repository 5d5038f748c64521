// `split`: cuts a scope along one of its axes and runs a body in every part (the split of CGA shape grammars: Müller,
// Wonka, Haegler, Ulmer, Van Gool, "Procedural modeling of buildings", 2006).
#include <cmath>

#include "grammar/derive/interpreter.h"
#include "modeler/core/random.h"

namespace sgm::derive {
namespace {

constexpr double leastPart_m = 1e-6;  // parts no longer than this vanish

/// One size of a split, evaluated.
struct Length {
    double fixed_m = 0;    ///< absolute and relative sizes
    double floating = 0;   ///< share of what is left; the wished metres inside `{ … }*`
};

Length sum(const std::vector<Length>& lengths) {
    Length total;
    for (const Length& l : lengths) total.fixed_m += l.fixed_m, total.floating += l.floating;
    return total;
}

/// How often `{ … }*` fits into `room_m`: to the nearest whole where its parts can give way, else what fits whole.
double repetitions(const Length& once, double room_m, bool fillsAlone) {
    const double n = room_m / (once.fixed_m + once.floating);
    if (once.floating <= 0) return std::floor(n + 1e-9);
    return std::max(std::floor(n + 0.5), fillsAlone ? 1.0 : 0.0);
}

}  // namespace

/// The parts from low to high along the axis; floating sizes share what fixed ones leave. What lies beyond the scope is
/// cut off, and parts without extent vanish.
bool Interpreter::runSplit(const rules::Split& split, const Frame& frame) {
    using Part = rules::Split::Part;
    const double whole_m = frame.place.scope.size[split.axis];
    Place place = frame.place;
    const auto lengthOf = [&](const Part& part, uint64_t key) {
        place.key = combine(frame.key, key);
        const rules::Value v = evaluate(part.size, place);
        const double size = std::max(0.0, v.num());
        if (part.floating) return Length{0, size};
        return Length{v.units[0] == rules::Unit::Share ? size * whole_m : size, 0};
    };

    std::vector<std::vector<Length>> lengths(split.parts.size());  // one, or those of a repeated group
    Length outside, groups;
    for (size_t p = 0; p < split.parts.size(); ++p) {
        const Part& part = split.parts[p];
        const std::vector<Part>& parts = part.repeated;
        if (part.local != rules::none) locals_[part.local] = rules::Value::number(1);
        for (size_t k = 0; k < std::max<size_t>(1, parts.size()); ++k)
            lengths[p].push_back(lengthOf(parts.empty() ? part : parts[k], combine(p, k)));
        const Length once = sum(lengths[p]);
        Length& total = parts.empty() ? outside : groups;
        total.fixed_m += once.fixed_m, total.floating += once.floating;
        if (!parts.empty() && once.fixed_m + once.floating <= leastPart_m) {
            builder_.fail(Error::Kind::Input, "what repeats has no extent, so it would never fill the scope", part.span);
            return false;
        }
    }
    const double room_m = std::max(0.0, whole_m - outside.fixed_m - outside.floating);
    const double n = groups.fixed_m + groups.floating > 0 ? repetitions(groups, room_m, outside.floating <= 0 && room_m > 0) : 0;
    const double left_m = std::max(0.0, whole_m - outside.fixed_m - n * groups.fixed_m);
    const double floats = outside.floating + n * groups.floating;
    const double perFloat_m = floats > 0 ? left_m / floats : 0;

    double from_m = 0;
    const auto run = [&](const Part& part, const Length& length, uint64_t key) {
        const double to_m = std::min(whole_m, from_m + length.fixed_m + length.floating * perFloat_m);
        const double low_m = std::exchange(from_m, to_m);
        if (to_m - low_m <= leastPart_m) return true;
        Frame inner = frame;
        inner.key = inner.place.key = combine(frame.key, key);
        Scope& scope = inner.place.scope;
        Vec3d moved;
        moved[split.axis] = (low_m + to_m - whole_m) / 2;
        scope.centre += scope.axes * moved;
        scope.size[split.axis] = to_m - low_m;
        return builder_.work() && runBody(*part.body, inner, 0);
    };
    for (size_t p = 0; p < split.parts.size(); ++p) {
        const Part& part = split.parts[p];
        if (part.repeated.empty()) {
            if (!run(part, lengths[p][0], combine(p, 0))) return false;
            continue;
        }
        for (double i = 1; i <= n; ++i)
            for (size_t k = 0; k < part.repeated.size(); ++k) {
                locals_[part.local] = rules::Value::number(i);
                locals_[part.local].integer = true;
                if (!run(part.repeated[k], lengths[p][k], combine(combine(p, k), static_cast<uint64_t>(i)))) return false;
            }
    }
    return true;
}

}  // namespace sgm::derive
