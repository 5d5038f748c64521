// around, row, mirror: the same body in several places of the scope.
#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <string>

#include "grammar/derive/parts_context.h"
#include "grammar/operations/operations.h"
#include "grammar/rules/lookup.h"
#include "grammar/rules/operation_checker.h"
#include "modeler/core/random.h"

namespace sgm::operations {
namespace {

using derive::PartsContext;
using derive::Scope;
using rules::OperationChecker;
using rules::Parts;
using rules::Want;
using syntax::ArgumentType;
using syntax::Operation;
using syntax::OperationArgument;

constexpr OperationArgument aroundArguments[] = {
    {"count", ArgumentType::Number, "how many; 'i' counts them from 1"},
    {"distance", ArgumentType::Length, "from the scope's centre to theirs", false, "radius"}};
constexpr OperationArgument rowArguments[] = {
    {"count", ArgumentType::Number, "how many parts; 'i' counts them from 1"},
    {"axis", ArgumentType::Axis, "x, y or z of the scope", false, "along"},
    {"width", ArgumentType::Length, "what stays free between two parts; 0 unless said", true, "gap"}};
constexpr OperationArgument mirrorArguments[] = {{"axis", ArgumentType::Axis, "x, y or z of the scope"}};

int axisOf(const syntax::Expr& e) { return e.text == "y" ? 1 : e.text == "z" ? 2 : 0; }

/// The whole number of copies and their body, in sight of `i`.
std::shared_ptr<Parts> checkCopies(OperationChecker& checker, const syntax::Attribute& written, bool counts) {
    auto out = std::make_shared<Parts>();
    out->span = written.span;
    out->operation = written.operation;
    checker.beginDraws(std::string(written.operation->name));
    if (counts && !written.args.empty()) {
        const syntax::Expr& count = written.args[0];
        if (count.kind == syntax::Expr::Kind::Number && count.number == 0)
            checker.error(count.span, fmt::format("'{}' makes no copy", written.operation->name), "write 1 or more");
        out->args.push_back(checker.expression(count, Want::Count, fmt::format("'{}'", written.operation->name)));
    }
    Parts::Part& part = out->parts.emplace_back();
    part.span = written.span;
    checker.withLocal("i", part.local, [&] {
        const bool whole = written.cases.size() == 1 && written.cases[0].body;
        part.body = whole ? checker.partBody(*written.cases[0].body) : std::make_shared<const rules::Body>();
    });
    return out;
}

/// `grammar 1` takes a radius below 0, for copies that look inward, and a gap below 0.
bool refusesBelowZero(const rules::Grammar& grammar, syntax::SourceSpan span) {
    return rules::versionOf(grammar, span) >= 2;
}
std::string belowZero(const char* name, double length_m) {
    return fmt::format("'{}' is {:.6g}m, but must be no less than 0", name, length_m);
}
constexpr const char* turnBodies = "copies that look inward say 'turn 180deg' in their body";
constexpr const char* sizeBodies = "parts that overlap say 'size' in their body";

/// Refuses a length that is below 0 at the defaults of parameters.
void checkBelowZero(OperationChecker& checker, const syntax::Attribute& written, const rules::Expr& length,
                    const char* name, const char* fix) {
    const auto value = checker.atDefaults(length);
    if (value && value->num() < 0 && refusesBelowZero(checker.grammar(), written.span))
        checker.error(length.span, belowZero(name, value->num()), fix);
}

std::shared_ptr<Parts> checkAround(OperationChecker& checker, const syntax::Attribute& written) {
    auto out = checkCopies(checker, written, true);
    if (written.args.size() < 2) return out;
    out->args.push_back(checker.expression(written.args[1], Want::Length, "'radius'"));
    checkBelowZero(checker, written, out->args.back(), "radius", turnBodies);
    return out;
}

std::shared_ptr<Parts> checkRow(OperationChecker& checker, const syntax::Attribute& written) {
    auto out = checkCopies(checker, written, true);
    if (written.args.size() > 1) out->axis = axisOf(written.args[1]);
    if (written.args.size() <= 2) return out;
    out->args.push_back(checker.measure(written.args[2], Want::Extent, "'gap'", out->axis));
    checkBelowZero(checker, written, out->args.back(), "gap", sizeBodies);
    return out;
}

std::shared_ptr<Parts> checkMirror(OperationChecker& checker, const syntax::Attribute& written) {
    auto out = checkCopies(checker, written, false);
    if (!written.args.empty()) out->axis = axisOf(written.args[0]);
    return out;
}

/// How many are asked for; fewer than none is told.
double countOf(PartsContext& context, const Parts& copies) {
    const double count = std::floor(context.evaluate(copies.args[0], hashText("count")).num() + 1e-9);
    if (count < 0)
        context.warn(copies.args[0].span,
                     fmt::format("'{}' is {:g} here, so it makes nothing", copies.operation->name, count),
                     "write 'max(0, …)' where that is meant");
    return count;
}

/// The scope again for every copy, turned about y so that its z looks outward.
bool runAround(PartsContext& context, const Parts& copies) {
    if (copies.args.size() < 2) return true;
    const double count = countOf(context, copies),
                 radius_m = context.evaluate(copies.args[1], hashText("radius")).num();
    if (radius_m < 0 && refusesBelowZero(context.grammar(), copies.span))
        return context.fail(belowZero("radius", radius_m) + ": " + turnBodies, copies.args[1].span);
    for (double i = 1; i <= count; ++i) {
        context.count(copies.parts[0].local, i);
        Scope scope = context.scope();
        scope.axes = scope.axes * Mat3::rotation({0, 1, 0}, 2 * std::numbers::pi * (i - 1) / count);
        scope.centre += scope.axes * Vec3d{0, 0, radius_m};
        if (!context.run(*copies.parts[0].body, scope, static_cast<uint64_t>(i))) return false;
    }
    return true;
}

bool runRow(PartsContext& context, const Parts& copies) {
    if (copies.args.empty()) return true;
    const double count = countOf(context, copies), whole_m = context.scope().size[copies.axis];
    double gap_m = 0;
    if (copies.args.size() > 1) {
        const rules::Value gap = context.evaluate(copies.args[1], hashText("gap"));
        gap_m = gap.num() * (gap.units[0] == rules::Unit::Share ? whole_m : 1);
    }
    if (gap_m < 0 && refusesBelowZero(context.grammar(), copies.span))
        return context.fail(belowZero("gap", gap_m) + ": " + sizeBodies, copies.args[1].span);
    const double part_m = (whole_m - gap_m * (count - 1)) / count;
    if (count >= 1 && !(part_m > 1e-6))
        return context.fail(
            fmt::format(
                "{:g} parts with gaps of {:.4g}m don't fit into {:.4g}m; write fewer parts or a smaller gap, or "
                "give what they stand in a larger 'size'",
                count, gap_m, whole_m),
            copies.span);
    for (double i = 1; i <= count; ++i) {
        context.count(copies.parts[0].local, i);
        const double low_m = (i - 1) * (part_m + gap_m);
        const auto scope = context.cut(copies.axis, low_m, low_m + part_m);
        if (scope && !context.run(*copies.parts[0].body, *scope, static_cast<uint64_t>(i))) return false;
    }
    return true;
}

/// The scope, and its mirror image about its centre.
bool runMirror(PartsContext& context, const Parts& copies) {
    for (const double side : {1.0, 2.0}) {
        context.count(copies.parts[0].local, side);
        Scope scope = context.scope();
        if (side > 1) {
            Vec3d flip{1, 1, 1};
            flip[copies.axis] = -1;
            scope.axes = scope.axes * Mat3{{flip.x, 0, 0}, {0, flip.y, 0}, {0, 0, flip.z}};
        }
        if (!context.run(*copies.parts[0].body, scope, static_cast<uint64_t>(side))) return false;
    }
    return true;
}

}  // namespace

constinit const Operation around{
    .name = "around",
    .doc =
        "Runs a body several times on a circle about the scope's y; z of each looks outward, and the first stands at "
        "+z.",
    .example = "around 12 radius 4m { cylinder size (.5m, 3m, .5m) }",
    .arguments = aroundArguments,
    .phase = Operation::Phase::Content,
    .block = {.isBody = true},
    .checkParts = checkAround,
    .run = runAround,
};

constinit const Operation row{
    .name = "row",
    .doc = "Cuts the scope into equal parts along an axis, with gaps between them, and runs a body in each.",
    .example = "row 5 along x gap .4m { cube of stone }",
    .arguments = rowArguments,
    .phase = Operation::Phase::Content,
    .block = {.isBody = true},
    .checkParts = checkRow,
    .run = runRow,
};

constinit const Operation mirrored{
    .name = "mirror",
    .doc =
        "Runs a body in the scope and in its mirror image about the scope's middle; what is drawn by chance differs.",
    .example = "mirror x { cylinder size (.4m, 3m, .4m) move (2m, 0, 0) }",
    .arguments = mirrorArguments,
    .phase = Operation::Phase::Content,
    .block = {.isBody = true},
    .checkParts = checkMirror,
    .run = runMirror,
};

}  // namespace sgm::operations
