#include "grammar/operations/plan_expressions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "grammar/derive/builder.h"
#include "grammar/derive/lsystem.h"
#include "grammar/rules/file_tables.h"
#include "grammar/rules/make.h"
#include "grammar/rules/words.h"
#include "modeler/core/random.h"
#include "modeler/plan/edit.h"
#include "modeler/plan/plates.h"

namespace sgm::operations {
namespace {

using derive::AttributeContext;
using rules::Expr;
using rules::OperationChecker;
using rules::PlanExpr;
using rules::PlanParameter;
using rules::PlanParameterKind;
using rules::Unit;
using rules::Value;
using rules::Want;
using Written = syntax::Expr;

Want wantOf(PlanParameterKind kind) {
    return kind == PlanParameterKind::Length  ? Want::Length
           : kind == PlanParameterKind::Angle ? Want::Angle
                                              : Want::Count;
}

Expr fallbackOf(syntax::SourceSpan span, const PlanParameter& parameter) {
    return rules::makeConstant(span, Value::number(parameter.fallback));
}

/// What a point is written in; (0, 0) may be either.
enum class PointUnit { Either, Lengths, Shares };

bool isZero(const Written& e) { return e.kind == Written::Kind::Number && e.number == 0 && e.unit.empty(); }

/// A point (x, z): two lengths, or where `unit` is given two shares.
Expr checkPoint(OperationChecker& checker, const Written& e, PointUnit* unit) {
    const rules::Typed point = checker.value(e);
    const Value& like = point.type.like;
    const bool two = !point.type.known || (like.kind == Value::Kind::Vector && like.count == 2);
    const auto zero = [&](size_t i) { return i < e.args.size() && isZero(e.args[i]); };
    const auto every = [&](auto holds) {
        return (zero(0) || holds(like.units[0])) && (zero(1) || holds(like.units[1]));
    };
    const bool lengths = every([](Unit u) { return u == Unit::None || u == Unit::Metre; });
    const bool parts = every([](Unit u) { return u == Unit::Share; });
    if (!two || (point.type.known && !lengths && !(parts && unit != nullptr)))
        checker.error(e.span,
                      two ? "a point of a plan has two lengths, or in 'outline' two shares"
                          : fmt::format("a point of a plan is (x, z), not {}", describe(point.type)),
                      unit ? "write '(4m, 2m)' or '(50%, 25%)'" : "write '(4m, 2m)'");
    if (unit)
        *unit = lengths && parts            ? PointUnit::Either
                : point.type.known && parts ? PointUnit::Shares
                                            : PointUnit::Lengths;
    return point.expr;
}

/// `at: (x, z)` and `turn: angle`, which any part of a plan takes; false for another name.
bool checkPlacement(OperationChecker& checker, const Written& e, size_t i, PlanExpr& plan) {
    const std::string& name = e.argNames[i];
    if (name != "at" && name != "turn") return false;
    checker.beginDraws("footprint." + name);
    if (name == "at")
        plan.at = checkPoint(checker, e.args[i], nullptr);
    else
        plan.turn = checker.expression(e.args[i], Want::Angle, "'turn' of a plan");
    return true;
}

void checkCall(OperationChecker& checker, const Written& e, PlanExpr& plan) {
    const rules::PlanRow& row = *plan.row;
    std::vector<bool> given(row.parameters.size(), false);
    for (const PlanParameter& parameter : row.parameters) plan.args.push_back(fallbackOf(e.span, parameter));
    size_t next = 0;
    for (size_t i = 0; i < e.args.size(); ++i) {
        const std::string& name = e.argNames[i];
        if (!name.empty() && checkPlacement(checker, e, i, plan)) continue;
        size_t index = next++;
        if (!name.empty()) {
            const auto found = std::find_if(row.parameters.begin(), row.parameters.end(),
                                            [&](const auto& p) { return p.name == name; });
            index = static_cast<size_t>(found - row.parameters.begin());
        }
        if (index >= row.parameters.size()) {
            std::vector<std::string> known{"at", "turn"};
            for (const PlanParameter& p : row.parameters) known.emplace_back(p.name);
            checker.error(e.args[i].span,
                          name.empty()
                              ? fmt::format("'{}' takes no more than {} numbers", row.name, row.parameters.size())
                              : fmt::format("'{}' has no parameter '{}'", row.name, name),
                          rules::nearestHint(name, known));
            return;
        }
        const Written& arg = e.args[i];
        if (row.parameters[index].kind == PlanParameterKind::Count && arg.kind == Written::Kind::Number &&
            !arg.unit.empty()) {
            checker.error(arg.span,
                          fmt::format("'{}' of '{}' is a number without a unit", row.parameters[index].name, row.name),
                          fmt::format("as in '{}'", row.example));
            return;
        }
        checker.beginDraws(fmt::format("footprint.{}", row.parameters[index].name));
        plan.args[index] = checker.expression(e.args[i], wantOf(row.parameters[index].kind),
                                              fmt::format("'{}' of '{}'", row.parameters[index].name, row.name));
        given[index] = true;
    }
    for (size_t i = 0; i < given.size(); ++i)
        if (row.parameters[i].required && !given[i]) {
            checker.error(e.span,
                          fmt::format("'{}' needs its {}: {}", row.name, row.parameters[i].name, row.parameters[i].doc),
                          fmt::format("as in '{}'", row.example));
            return;
        }
}

void checkOutline(OperationChecker& checker, const Written& e, PlanExpr& plan) {
    plan.kind = PlanExpr::Kind::Outline;
    PointUnit unit = PointUnit::Either;
    for (size_t i = 0; i < e.args.size(); ++i) {
        if (!e.argNames[i].empty()) {
            if (!checkPlacement(checker, e, i, plan))
                checker.error(e.args[i].span, fmt::format("'outline' has no parameter '{}'", e.argNames[i]));
            continue;
        }
        PointUnit own = PointUnit::Either;
        checker.beginDraws("footprint.outline");
        plan.args.push_back(checkPoint(checker, e.args[i], &own));
        if (own == PointUnit::Either) continue;
        if (unit != PointUnit::Either && unit != own)
            checker.error(e.args[i].span, "the points of an outline are all lengths or all shares of the scope",
                          unit == PointUnit::Shares ? "write shares here too, such as '(50%, 25%)'"
                                                    : "write lengths here too, such as '(4m, 2m)'");
        unit = own;
    }
    plan.inShares = unit == PointUnit::Shares;
    if (plan.args.size() < 3)
        checker.error(e.span, "an outline has three points or more", "write 'outline((0, 0), (8, 0), (8, 6))'");
}

/// walls(Plan, .25m); walls(.3m, (0, 0), (8, 0), (8, 6))
bool checkWalls(OperationChecker& checker, const Written& e, PlanExpr& plan) {
    plan.kind = PlanExpr::Kind::Walls;
    plan.index = rules::none;
    std::vector<const Written*> given;
    for (size_t i = 0; i < e.args.size(); ++i)
        if (e.argNames[i].empty() || !checkPlacement(checker, e, i, plan)) given.push_back(&e.args[i]);
    const auto refuse = [&] {
        checker.error(e.span, "'walls' takes an lsystem and a width, or a width and two points or more",
                      "write 'walls(Plan, .25m)' or 'walls(.3m, (0, 0), (8, 0), (8, 6))'");
        return false;
    };
    const auto lsystem = !given.empty() && given[0]->kind == Written::Kind::Name
                             ? checker.names().findLsystem(given[0]->text)
                             : std::nullopt;
    if (lsystem) {
        plan.index = *lsystem;
        given.erase(given.begin());
    }
    if (given.empty() || (lsystem ? given.size() != 1 : given.size() < 3)) return refuse();
    checker.beginDraws("footprint.walls");
    plan.args.push_back(checker.expression(*given[0], Want::Length, "the width of 'walls'"));
    for (size_t i = 1; i < given.size(); ++i) plan.args.push_back(checkPoint(checker, *given[i], nullptr));
    return true;
}

/// file("lots.geojson", n)
bool checkFile(OperationChecker& checker, const Written& e, PlanExpr& plan) {
    plan.kind = PlanExpr::Kind::File;
    plan.args.push_back(rules::makeConstant(e.span, Value::number(1)));
    size_t next = 0;
    for (size_t i = 0; i < e.args.size(); ++i) {
        if (!e.argNames[i].empty() && checkPlacement(checker, e, i, plan)) continue;
        checker.beginDraws("footprint.file");
        if (next == 1) plan.args[0] = checker.expression(e.args[i], Want::Count, "the number of an outline");
        if (next++ == 0 && e.args[i].kind != Written::Kind::Text) break;
    }
    if (next == 0 || next > 2 || e.args[0].kind != Written::Kind::Text) {
        checker.error(e.span, "'file' takes the name of a file in quotes, and maybe which of its outlines",
                      "write 'file(\"lots.geojson\", 3)'");
        return false;
    }
    const auto index = checker.files().readOutlines(e.args[0]);
    plan.index = index.value_or(0);
    return index.has_value();
}

/// What other programs call our plans.
constexpr std::pair<std::string_view, std::string_view> elsewhere[] = {
    {"circle", "write 'round(48, 5m)', its sides and its radius"},
    {"ellipse", "write 'round(48)', which fills its scope: 'size (9, 3, 5) footprint round(48) block'"},
    {"polygon", "write 'outline((0, 0), (8, 0), (8, 6))'"},
    {"rectangle", "write 'rect(8, 6)'"},
    {"square", "write 'rect(8, 6)'"}};

/// What to write instead of a plan that isn't known.
std::string hintForPlan(const OperationChecker& checker, const std::string& name) {
    const auto foreign = std::ranges::find(elsewhere, name, &std::pair<std::string_view, std::string_view>::first);
    if (foreign != std::end(elsewhere)) return std::string(foreign->second);
    std::vector<std::string> known{"outline", "file", "walls"};
    for (const rules::PlanRow& row : rules::planRows()) known.emplace_back(row.name);
    for (const rules::Lsystem& lsystem : checker.grammar().lsystems) known.push_back(lsystem.name);
    const std::string near = rules::nearestHint(name, known);
    return near.empty() ? fmt::format("write one of {}, or the name of an lsystem", fmt::join(known, ", ")) : near;
}

bool checkInto(OperationChecker& checker, const Written& e, PlanExpr& plan) {
    plan.span = e.span;
    const bool isUnion = e.kind == Written::Kind::Binary && e.text == "+";
    if (isUnion || (e.kind == Written::Kind::Binary && e.text == "-")) {
        plan.kind = isUnion ? PlanExpr::Kind::Union : PlanExpr::Kind::Difference;
        plan.parts.resize(2);
        return checkInto(checker, e.args[0], plan.parts[0]) && checkInto(checker, e.args[1], plan.parts[1]);
    }
    if (e.kind == Written::Kind::Call && e.text == "outline") {
        checkOutline(checker, e, plan);
        return true;
    }
    if (e.kind == Written::Kind::Call && e.text == "file") return checkFile(checker, e, plan);
    if (e.kind == Written::Kind::Call && e.text == "walls") return checkWalls(checker, e, plan);
    plan.row = rules::findPlan(e.text);
    if (plan.row && (e.kind == Written::Kind::Call || e.kind == Written::Kind::Name)) {
        checkCall(checker, e, plan);
        return true;
    }
    if (const auto index = e.kind == Written::Kind::Name ? checker.names().findLsystem(e.text) : std::nullopt) {
        plan.kind = PlanExpr::Kind::Lsystem;
        plan.index = *index;
        return true;
    }
    if (e.kind == Written::Kind::Error) return false;
    checker.unknownName(e.span, e.text, fmt::format("'{}' draws no footprint", e.span.text()),
                        hintForPlan(checker, e.text));
    return false;
}

plan::Vec2 pointOf(const AttributeContext& context, const Expr& e) {
    const Value v = context.evaluate(e);
    return {v.n[0], v.count > 1 ? v.n[1] : v.n[0]};
}

/// For the window, which shows the letters pass by pass.
void noteLetters(const AttributeContext& context, uint32_t lsystem) {
    const derive::Place& place = context.place;
    if (place.builder) place.builder->noteLetters({lsystem, place.key, place.scope, place.valuesAt});
}

Result<DrawnPlan> drawLsystem(const AttributeContext& context, const PlanExpr& plan) {
    noteLetters(context, plan.index);
    auto drawn = derive::drawOutline(context.grammar().lsystems[plan.index], context.place);
    if (!drawn.ok()) return drawn.error();
    return DrawnPlan{std::move(*drawn), false};
}

Result<DrawnPlan> drawWallsOf(const AttributeContext& context, const PlanExpr& plan) {
    const double width_m = context.number(plan.args[0]);
    if (plan.index != rules::none) {
        noteLetters(context, plan.index);
        auto drawn = derive::drawWalls(context.grammar().lsystems[plan.index], context.place, width_m);
        if (!drawn.ok()) return drawn.error();
        return DrawnPlan{std::move(*drawn), false};
    }
    plan::Ring chain;
    for (size_t i = 1; i < plan.args.size(); ++i) chain.points.push_back(pointOf(context, plan.args[i]));
    const bool isClosed = chain.size() > 3 && chain.points.front() == chain.points.back();
    if (isClosed) chain.points.pop_back();
    chain.edges.resize(chain.size());
    auto drawn = plan::band(chain, {""}, width_m, isClosed);
    if (!drawn.ok()) return drawn.error();
    return DrawnPlan{std::move(*drawn), false};
}

/// An outline of a file stays where the file has it.
Result<DrawnPlan> drawFile(const AttributeContext& context, const PlanExpr& plan) {
    const std::vector<plan::Feature>& list = context.grammar().outlines[plan.index]->list;
    const double n = std::floor(context.number(plan.args[0]));
    if (n >= 1 && n <= static_cast<double>(list.size())) {
        const plan::Feature& feature = list[static_cast<size_t>(n) - 1];
        for (const plan::Property& property : feature.properties) {
            if (!context.grammar().properties.contains(property.name)) continue;
            const double* number = std::get_if<double>(&property.value);
            Value value = number ? Value::number(*number) : rules::makeWord(std::get<std::string>(property.value));
            if (number) value.text = fmt::format("{}", *number);
            context.out.extras.values.emplace_back(derive::propertyName(property.name), std::move(value));
        }
        return DrawnPlan{feature.footprint, true};
    }
    return Error{Error::Kind::Input, fmt::format("the file has {} outlines, and none is number {:g}", list.size(), n)};
}

Result<DrawnPlan> draw(const AttributeContext& context, const PlanExpr& plan);

Result<DrawnPlan> drawParts(const AttributeContext& context, const PlanExpr& plan) {
    Result<DrawnPlan> a = draw(context, plan.parts[0]);
    if (!a.ok()) return a;
    Result<DrawnPlan> b = draw(context, plan.parts[1]);
    if (!b.ok()) return b;
    const auto how = plan.kind == PlanExpr::Kind::Union ? plan::Boolean::Union : plan::Boolean::Difference;
    auto both = plan::booleanInBudget(how, a->footprint, b->footprint);
    if (!both.ok()) return both.error();
    return DrawnPlan{std::move(*both), a->keepsPlace && b->keepsPlace};
}

Result<DrawnPlan> drawRow(const AttributeContext& context, const PlanExpr& plan) {
    std::vector<double> numbers;
    for (const Expr& arg : plan.args) numbers.push_back(context.number(arg));
    auto drawn = plan.row->draw(numbers);
    if (!drawn.ok()) return drawn.error();
    const int free = plan.row->fillsWithout;
    const bool fills = free >= 0 && numbers[static_cast<size_t>(free)] == 0;
    if (!fills) return DrawnPlan{std::move(*drawn), false};
    // Its bounding box becomes the scope's.
    const plan::Box2 box = bounds(*drawn);
    const Vec3d size = context.out.scope.size;
    const plan::Vec2 scale{size.x / box.size().x, size.z / box.size().z};
    return DrawnPlan{plan::placed(*drawn, scale, {-box.centre().x * scale.x, -box.centre().z * scale.z}), true};
}

DrawnPlan drawPoints(const AttributeContext& context, const PlanExpr& plan) {
    std::vector<plan::Vec2> points;
    const Vec3d size = context.out.scope.size;
    for (const Expr& arg : plan.args) {
        plan::Vec2 p = pointOf(context, arg);
        if (plan.inShares) p = {(p.x - .5) * size.x, (p.z - .5) * size.z};
        points.push_back(p);
    }
    return {plan::footprintOf(plan::polygonOf(std::move(points))), plan.inShares};
}

Result<DrawnPlan> draw(const AttributeContext& context, const PlanExpr& plan) {
    Result<DrawnPlan> drawn = plan.kind == PlanExpr::Kind::Drawn     ? drawRow(context, plan)
                              : plan.kind == PlanExpr::Kind::Outline ? Result<DrawnPlan>(drawPoints(context, plan))
                              : plan.kind == PlanExpr::Kind::Lsystem ? drawLsystem(context, plan)
                              : plan.kind == PlanExpr::Kind::File    ? drawFile(context, plan)
                              : plan.kind == PlanExpr::Kind::Walls   ? drawWallsOf(context, plan)
                                                                     : drawParts(context, plan);
    if (!drawn.ok()) return drawn;
    if (plan.turn) drawn->footprint = plan::turned(drawn->footprint, context.number(*plan.turn));
    if (plan.at) drawn->footprint = plan::placed(drawn->footprint, {1, 1}, pointOf(context, *plan.at));
    return drawn;
}

}  // namespace

std::shared_ptr<const PlanExpr> checkPlan(OperationChecker& checker, const Written& e) {
    auto plan = std::make_shared<PlanExpr>();
    return checkInto(checker, e, *plan) ? plan : nullptr;
}

std::optional<DrawnPlan> drawPlan(const AttributeContext& context, const PlanExpr& plan) {
    auto drawn = draw(context, plan);
    if (drawn.ok()) return std::move(*drawn);
    context.place.builder->monitor().fail(drawn.error().kind, drawn.error().message, plan.span);
    return std::nullopt;
}

}  // namespace sgm::operations
