// split: cuts a scope along one of its axes and runs a body in every part (the split of CGA shape grammars: Müller,
// Wonka, Haegler, Ulmer, Van Gool, "Procedural modeling of buildings", 2006).
#include <fmt/format.h>

#include <cmath>

#include "grammar/derive/parts_context.h"
#include "grammar/operations/operations.h"
#include "grammar/rules/operation_checker.h"
#include "modeler/core/random.h"

namespace sgm::operations {
namespace {

using derive::PartsContext;
using rules::OperationChecker;
using rules::Parts;
using rules::Want;
using syntax::Operation;
using syntax::OperationArgument;
using Part = Parts::Part;
using Written = syntax::Expr;

constexpr double leastPart_m = 1e-6;  // parts no longer than this vanish

constexpr OperationArgument splitArguments[] = {{"axis", syntax::ArgumentType::Axis, "x, y or z of the scope"}};

/// One part, its body checked against the part's own scope.
Part checkPart(OperationChecker& checker, const syntax::Case& written, int axis) {
    Part out;
    out.span = written.span;
    checker.beginDraws("part");
    if (written.label) {
        out.floating = written.label->kind == Written::Kind::Floating;
        const Written& size = out.floating && !written.label->args.empty() ? written.label->args[0] : *written.label;
        out.size = out.floating ? checker.expression(size, Want::Length, "what follows '~'")
                                : checker.measure(size, Want::Extent, "the size of a part", axis);
        if (const auto value = checker.atDefaults(out.size); value && value->num() < 0)
            checker.error(size.span, "the size of a part is no less than 0");
    } else if (!written.tag.empty()) {
        checker.error(written.tag.span, "a part of a split has a size, not a tag",
                      "write '4m: …', '30%: …' or '~1: …'");
    }
    out.body = written.body ? checker.partBody(*written.body) : std::make_shared<const rules::Body>();
    return out;
}

/// `{ … }*`: `i` is the number of the repetition, from 1.
Part checkRepeated(OperationChecker& checker, const syntax::Case& written, int axis) {
    Part out;
    out.span = written.span;
    checker.withLocal("i", out.local, [&] {
        for (const syntax::Case& c : written.cases) {
            if (c.repeated)
                checker.error(c.span, "what repeats can't hold another '{ … }*'", "split the part again instead");
            else
                out.repeated.push_back(checkPart(checker, c, axis));
        }
    });
    return out;
}

std::shared_ptr<Parts> checkSplit(OperationChecker& checker, const syntax::Attribute& written) {
    auto out = std::make_shared<Parts>();
    out->span = written.span;
    out->operation = written.operation;
    const std::string axis = written.args.empty() ? "x" : written.args[0].text;
    out->axis = axis == "x" ? 0 : axis == "y" ? 1 : 2;
    for (const syntax::Case& c : written.cases)
        out->parts.push_back(c.repeated ? checkRepeated(checker, c, out->axis) : checkPart(checker, c, out->axis));
    return out;
}

/// Sizes of one part, or of several together.
struct Length {
    double fixed_m = 0;   ///< absolute and relative sizes
    double floating = 0;  ///< share of what is left; the wished metres inside `{ … }*`

    Length& operator+=(const Length& other) {
        fixed_m += other.fixed_m, floating += other.floating;
        return *this;
    }
};

/// How often `{ … }*` fits into `room_m`: to the nearest whole where its parts can give way, else what fits whole.
double repetitions(const Length& once, double room_m, bool fillsAlone) {
    const double n = room_m / (once.fixed_m + once.floating);
    if (once.floating <= 0) return std::floor(n + 1e-9);
    return std::max(std::floor(n + 0.5), fillsAlone ? 1.0 : 0.0);
}

/// The sizes of a split, evaluated for one scope.
struct Layout {
    std::vector<std::vector<Length>> lengths;  ///< by part: one, or those of a repeated group
    double repetitions = 0;                    ///< of every group
    double perFloat_m = 0;                     ///< metres a unit of floating size gets
};

Length lengthOf(PartsContext& context, const Part& part, double whole_m, uint64_t key) {
    const rules::Value v = context.evaluate(part.size, key);
    const double size = std::max(0.0, v.num());
    if (part.floating) return {0, size};
    return {v.units[0] == rules::Unit::Share ? size * whole_m : size, 0};
}

/// Nothing after a failure.
std::optional<Layout> layOut(PartsContext& context, const Parts& split, double whole_m) {
    Layout layout;
    layout.lengths.resize(split.parts.size());
    Length outside, groups;
    for (size_t p = 0; p < split.parts.size(); ++p) {
        const Part& part = split.parts[p];
        const std::vector<Part>& parts = part.repeated;
        if (part.local != rules::none) context.count(part.local, 1);
        Length once;
        for (size_t k = 0; k < std::max<size_t>(1, parts.size()); ++k) {
            layout.lengths[p].push_back(lengthOf(context, parts.empty() ? part : parts[k], whole_m, combine(p, k)));
            once += layout.lengths[p].back();
        }
        (parts.empty() ? outside : groups) += once;
        if (!parts.empty() && once.fixed_m + once.floating <= leastPart_m) {
            context.fail("what repeats has no extent, so it would never fill the scope: give a part more than 0.000001m", part.span);
            return std::nullopt;
        }
    }
    const double room_m = std::max(0.0, whole_m - outside.fixed_m - outside.floating);
    if (groups.fixed_m + groups.floating > 0)
        layout.repetitions = repetitions(groups, room_m, outside.floating <= 0 && room_m > 0);
    const double left_m = std::max(0.0, whole_m - outside.fixed_m - layout.repetitions * groups.fixed_m);
    const double floats = outside.floating + layout.repetitions * groups.floating;
    layout.perFloat_m = floats > 0 ? left_m / floats : 0;
    return layout;
}

/// The parts from low to high along the axis; floating sizes share what fixed ones leave. What lies beyond the scope is
/// cut off, and parts without extent vanish.
bool runSplit(PartsContext& context, const Parts& split) {
    const double whole_m = context.scope().size[split.axis];
    const auto layout = layOut(context, split, whole_m);
    if (!layout) return false;
    double from_m = 0;
    const auto run = [&](const Part& part, const Length& length, uint64_t key) {
        const double wanted_m = length.fixed_m + length.floating * layout->perFloat_m, left_m = whole_m - from_m;
        if (left_m > leastPart_m &&
            wanted_m > left_m + 1e-6 * std::max(1.0, whole_m))  // the first one speaks for those behind it
            context.warn(
                part.span,
                fmt::format("this part is cut off: {:.4g}m are left for its {:.4g}m", std::max(0.0, left_m), wanted_m),
                "write '~' before a size, so that it gives way, or make the sizes fit");
        const double to_m = std::min(whole_m, from_m + wanted_m);
        const double low_m = std::exchange(from_m, to_m);
        if (to_m - low_m <= leastPart_m) return true;
        const auto scope = context.cut(split.axis, low_m, to_m);
        return !scope || context.run(*part.body, *scope, key);
    };
    for (size_t p = 0; p < split.parts.size(); ++p) {
        const Part& part = split.parts[p];
        if (part.repeated.empty()) {
            if (!run(part, layout->lengths[p][0], combine(p, 0))) return false;
            continue;
        }
        for (double i = 1; i <= layout->repetitions; ++i)
            for (size_t k = 0; k < part.repeated.size(); ++k) {
                context.count(part.local, i);
                const uint64_t key = combine(combine(p, k), static_cast<uint64_t>(i));
                if (!run(part.repeated[k], layout->lengths[p][k], key)) return false;
            }
    }
    return true;
}

}  // namespace

constinit const Operation split{
    .name = "split",
    .doc =
        "Cuts the scope along an axis: sizes are absolute (4m), relative (30%) or floating (~1); { … }* repeats to "
        "fit.",
    .example = "split x { 1m: wall | { ~2.4m: Tile }* | 1m: wall }",
    .arguments = splitArguments,
    .phase = Operation::Phase::Content,
    .blockLabel = "~1",
    .checkParts = checkSplit,
    .run = runSplit,
};

}  // namespace sgm::operations
