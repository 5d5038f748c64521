// turtle: shapes along the way that the letters of an L-system draw in space.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "grammar/derive/lsystem.h"
#include "grammar/derive/parts_context.h"
#include "grammar/operations/operations.h"
#include "grammar/rules/letters.h"
#include "grammar/rules/operation_checker.h"
#include "grammar/rules/words.h"
#include "modeler/core/random.h"

namespace sgm::operations {
namespace {

using derive::PartsContext;
using derive::Scope;
using derive::TurtleStep;
using rules::OperationChecker;
using rules::Parts;
using syntax::ArgumentType;
using syntax::Operation;
using syntax::OperationArgument;

constexpr double leastStep_m = 1e-4;

constexpr OperationArgument turtleArguments[] = {
    {"letters", ArgumentType::Name, "the lsystem whose letters it reads"},
    {"way", ArgumentType::Name,
     "upward: it begins at the foot of the scope and rises; else it begins amid the scope and goes along x", true}};

void warnOfUnusedParts(OperationChecker& checker, const Parts& turtle) {
    const rules::Lsystem& lsystem = checker.grammar().lsystems[turtle.index];
    const auto letters = rules::lettersOf(lsystem);
    if (letters.empty()) return;  // the axiom wasn't read
    for (const Parts::Part& part : turtle.parts)
        if (!rules::holdsLetter(letters, part.label[0]))
            checker.warning(
                part.span,
                fmt::format("no '{}' ever stands in '{}', so this part draws nothing", part.label, lsystem.name),
                fmt::format("write {} into the axiom or into a production", part.label));
}

std::shared_ptr<Parts> checkTurtle(OperationChecker& checker, const syntax::Attribute& written) {
    auto out = std::make_shared<Parts>();
    out->span = written.span;
    out->operation = written.operation;
    if (!written.args.empty() && written.args[0].kind == syntax::Expr::Kind::Name) {
        const syntax::Expr& name = written.args[0];
        std::vector<std::string> known;
        for (const rules::Lsystem& lsystem : checker.grammar().lsystems) known.push_back(lsystem.name);
        if (const auto index = checker.names().findLsystem(name.text))
            out->index = *index;
        else
            checker.unknownName(name.span, name.text, fmt::format("there is no lsystem called '{}'", name.text),
                                rules::nearestHint(name.text, known));
    }
    if (written.args.size() > 1 && written.args[1].kind == syntax::Expr::Kind::Name) {
        out->axis = 1;
        if (written.args[1].text != "upward")
            checker.error(written.args[1].span,
                          fmt::format("a turtle goes along x, or 'upward', not '{}'", written.args[1].text),
                          "write 'turtle Oak upward { F: … }'");
    }
    for (const syntax::Case& c : written.cases) {
        const bool isLetter =
            !c.repeated && c.label && c.label->kind == syntax::Expr::Kind::Name && c.label->text.size() == 1;
        if (!isLetter) {
            checker.error(c.label ? c.label->span : c.span, "a part of 'turtle' is called by a letter",
                          c.label && c.label->kind == syntax::Expr::Kind::Name && !c.repeated
                              ? fmt::format("write '{}: …'", c.label->text.substr(0, 1))
                              : "write 'F: cylinder'");
            continue;
        }
        Parts::Part& part = out->parts.emplace_back();
        part.span = c.span;
        part.label = c.label->text;
        checker.beginDraws("part");
        part.body = c.body ? checker.partBody(*c.body) : std::make_shared<const rules::Body>();
    }
    if (out->index != rules::none && !checker.hasErrors()) warnOfUnusedParts(checker, *out);
    return out;
}

/// Where the body of a letter stands: along its step, or at the turtle where it draws none.
Scope scopeOf(const Scope& whole, const TurtleStep& step, bool rises) {
    const Vec3d start = rises ? Vec3d{0, -whole.size.y / 2, 0} : Vec3d{};
    const double length_m = length(step.to - step.from), width_m = std::max(step.width_m, leastStep_m);
    const bool goes = length_m > leastStep_m;
    Scope scope = whole;
    scope.footprint = derive::none;
    scope.centre = whole.centre + whole.axes * (start + (step.from + step.to) * .5);
    const double along_m = goes ? length_m : width_m;
    if (rises) {
        scope.axes = whole.axes * Mat3{cross(step.heading, step.up), step.heading, step.up};
        scope.size = {width_m, along_m, width_m};
    } else {
        scope.axes = whole.axes * Mat3{step.heading, step.up, cross(step.heading, step.up)};
        scope.size = {along_m, whole.size.y, width_m};
    }
    return scope;
}

bool runTurtle(PartsContext& context, const Parts& turtle) {
    if (turtle.index == rules::none) return true;
    const bool rises = turtle.axis == 1;
    const Vec3d size = context.scope().size;
    const double width_m = rises ? std::min(size.x, size.z) : size.z;
    const rules::Lsystem& lsystem = context.grammar().lsystems[turtle.index];
    const auto letters = derive::rewritten(lsystem, context.place());
    if (!letters.ok()) return context.fail(letters.error(), turtle.span);
    const derive::Place& place = context.place();
    place.builder->noteLetters({turtle.index, place.key, place.scope, place.valuesAt, true, rises, width_m});
    const std::vector<TurtleStep> steps = derive::walk(lsystem, *letters, place, rises, width_m);
    std::array<const Parts::Part*, 256> partOf{};
    for (const Parts::Part& part : turtle.parts) partOf[static_cast<unsigned char>(part.label[0])] = &part;
    for (const TurtleStep& step : steps) {
        const Parts::Part* part = partOf[static_cast<unsigned char>(step.letter)];
        if (part && !context.run(*part->body, scopeOf(context.scope(), step, rises), combine(step.key, 1)))
            return false;
        if (!context.work()) return false;
    }
    return true;
}

}  // namespace

constinit const Operation turtle{
    .name = "turtle",
    .doc =
        "Runs a body at every letter of an lsystem that has one. The scope of F, G, f and g lies along their step: "
        "with x along it and as high as the scope, or where the turtle goes 'upward' with y along it and as wide as "
        "'!' says. Other letters stand at the turtle.",
    .example = "turtle Oak upward { F: cylinder | L: sphere size .5m }",
    .arguments = turtleArguments,
    .phase = Operation::Phase::Content,
    .block = {.label = "F"},
    .checkParts = checkTurtle,
    .run = runTurtle,
};

}  // namespace sgm::operations
