// footprint, extrude, offset, setback, court, rectify, inner: the plan of a scope (modeler/plan).
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "grammar/derive/builder.h"
#include "grammar/operations/operations.h"
#include "grammar/operations/plan_expressions.h"
#include "grammar/rules/evaluate.h"
#include "modeler/plan/edge_words.h"
#include "modeler/plan/edit.h"
#include "modeler/plan/validate.h"

namespace sgm::operations {
namespace {

using derive::AttributeContext;
using rules::Attribute;
using rules::Element;
using rules::OperationChecker;
using syntax::ArgumentType;
using syntax::Operation;
using syntax::OperationArgument;

constexpr double mostSide_m = 1e5;

/// Whether a solid, or a part of it, stands over the plan of its scope.
bool standsOverPlan(const rules::Solid& solid) {
    if (solid.kind == rules::Solid::Kind::Primitive) return solid.primitive->plan != field::PlanUse::None;
    return solid.kind == rules::Solid::Kind::Nil || std::ranges::any_of(solid.parts, standsOverPlan);
}

/// Whether an attribute draws or changes a plan.
bool isOfPlan(const Attribute& attribute) {
    constexpr std::array all{&footprint, &offset, &setback, &court, &rectify};
    return std::ranges::find(all, attribute.operation) != all.end();
}

/// Whether an attribute makes a box of the scope, whose plan a solid may leave aside.
bool makesBox(const Attribute& attribute) {
    return attribute.operation == &inner ||
           (attribute.plan && attribute.plan->row && attribute.plan->row->name == "rect");
}

/// The attributes of an element that the attribute is one of: those before its shape, or behind it.
const std::vector<Attribute>& listOf(const Element& element, const Attribute& attribute) {
    const bool isBefore = std::ranges::any_of(element.prefix, [&](const Attribute& a) { return &a == &attribute; });
    return isBefore ? element.prefix : element.attributes;
}

/// Warns of a plan that the element's solid takes no notice of; once for all that is said of the plan.
void agreePlan(OperationChecker& checker, const Element& element, const Attribute& attribute) {
    const rules::SymbolId symbol = element.content.symbol();
    const bool isTerminal = symbol != rules::none && checker.grammar().symbols[symbol].terminal;
    const rules::Solid* solid = element.content.solid();
    if (isTerminal && checker.grammar().symbols[symbol].solid) solid = &*checker.grammar().symbols[symbol].solid;
    const std::vector<Attribute>& list = listOf(element, attribute);
    const bool isBox = std::ranges::any_of(list, makesBox) || std::ranges::any_of(element.attributes, makesBox);
    if (!solid || standsOverPlan(*solid) || isBox || &*std::ranges::find_if(list, isOfPlan) != &attribute) return;
    checker.warning(
        attribute.span,
        fmt::format("'{}' fills its scope, whatever plan it has: this does nothing but set its size", element.label),
        "write 'block' for what stands over the plan, or a terminal without a solid");
}

/// Whether a size sets metres along an axis, as far as the defaults of parameters tell.
bool setsMetres(const OperationChecker& checker, const rules::Expr& written, size_t axis) {
    const auto value = checker.atDefaults(rules::sizeAlong(written, axis));
    return value && value->units[value->count == 3 ? axis : 0] == rules::Unit::Metre;
}

/// Warns of a size behind the attribute that sets metres along one of the axes anew.
void agreeSize(OperationChecker& checker, const Element& element, const Attribute& attribute,
               std::initializer_list<size_t> axes) {
    bool isBehind = false;
    for (const Attribute& a : listOf(element, attribute)) {
        if (isBehind && a.operation == &size && !a.args.empty() &&
            std::ranges::any_of(axes, [&](size_t axis) { return setsMetres(checker, a.args[0], axis); })) {
            checker.warning(a.span, fmt::format("this size undoes '{}' before it", attribute.operation->name),
                            fmt::format("write 'size' before '{}'", attribute.operation->name));
            return;
        }
        isBehind |= &a == &attribute;
    }
}

void agreeExtrude(OperationChecker& checker, const Element& element, const Attribute& attribute) {
    agreeSize(checker, element, attribute, {1});
}
void agreeOffset(OperationChecker& checker, const Element& element, const Attribute& attribute) {
    agreePlan(checker, element, attribute);
    agreeSize(checker, element, attribute, {0, 2});
}

constexpr OperationArgument footprintArguments[] = {
    {"plan", ArgumentType::Plan,
     "rect, ell, tee, yard, ring, ngon, round, arc, outline((x, z), …), file(\"lots.geojson\", n), an lsystem, "
     "walls(lsystem, width), walls(width, (x, z), …), or (a + b), (a - b) of them"}};
constexpr OperationArgument extrudeArguments[] = {
    {"height", ArgumentType::Length, "metres above the foot of the scope"}};
constexpr OperationArgument offsetArguments[] = {{"distance", ArgumentType::Length, "outward; inward where negative"}};
constexpr OperationArgument setbackArguments[] = {
    {"distance", ArgumentType::Plan,
     "metres inward of every edge, or edges(front: 5m, back: 8m, rest: 2m): by side or tag"}};
constexpr OperationArgument courtArguments[] = {{"wing", ArgumentType::Length, "metres from every edge to the court"}};
constexpr OperationArgument rectifyArguments[] = {{"within", ArgumentType::Angle, "of the plan's main direction"}};

void checkFootprint(OperationChecker& checker, const syntax::Attribute& written) {
    if (written.args.empty()) return;
    Attribute out;
    out.operation = written.operation;
    out.span = written.span;
    checker.beginDraws("footprint");
    out.plan = checkPlan(checker, written.args[0]);
    checker.add(std::move(out));
}

/// Why nothing is left of a plan: edges that cross by name, where some do.
std::string faultOf(const std::optional<DrawnPlan>& drawn) {
    const auto fault = drawn ? plan::firstFault(drawn->footprint) : std::nullopt;
    if (fault && fault->kind == plan::FaultKind::Crossing) return plan::sentenceOf(*fault, drawn->footprint);
    return "the plan encloses no area: its edges lie on one line, or are nearer to each other than 1 mm";
}

void applyFootprint(AttributeContext& context, const Attribute& attribute) {
    auto drawn = drawPlan(context, *attribute.plan);
    if (!drawn) return;
    // What is drawn in metres comes centred on the scope; shares of the scope and outlines of files keep their place.
    const Vec3d before = context.out.moved_m;
    context.setFootprint(std::move(drawn->footprint), attribute.span);
    if (context.out.vanishes) context.fail(faultOf(drawPlan(context, *attribute.plan)), attribute.span);
    if (!drawn->keepsPlace) context.out.moved_m = before;
}

/// The foot stays where it is, unless a joint says where the newcomer stands.
void applyExtrude(AttributeContext& context, const Attribute& attribute) {
    const double height_m = context.number(attribute.args[0]);
    context.out.grown_m += context.out.scope.axes.y * ((height_m - context.out.scope.size.y) / 2);
    context.out.scope.size.y = height_m;
    context.out.sizeSpan = attribute.span;
}

void applyOffset(AttributeContext& context, const Attribute& attribute) {
    context.setFootprint(plan::offset(context.footprint(), context.number(attribute.args[0])), attribute.span);
}

/// `edges(front: 5m, rest: 2m)`: args are the distances, and the plan's parts hold the words.
void checkSetback(OperationChecker& checker, const syntax::Attribute& written) {
    if (written.args.empty()) return;
    Attribute out;
    out.operation = written.operation;
    out.span = written.span;
    const syntax::Expr& e = written.args[0];
    checker.beginDraws("setback");
    auto words = std::make_shared<rules::PlanExpr>();
    const bool named = e.kind == syntax::Expr::Kind::Call && e.text == "edges";
    for (size_t i = 0; named && i < e.args.size(); ++i) {
        if (e.argNames[i].empty()) {
            checker.error(e.args[i].span, "each distance of 'edges' has the word of its edges before it",
                          "write 'edges(front: 5m, rest: 2m)'");
            return;
        }
        checker.beginDraws("setback." + e.argNames[i]);
        words->words.push_back(e.argNames[i]);
        out.args.push_back(checker.expression(e.args[i], rules::Want::Length, "a setback"));
    }
    if (!named) {
        words->words.push_back("side");
        out.args.push_back(checker.expression(e, rules::Want::Length, "'setback'"));
    }
    for (const rules::Expr& arg : out.args)
        if (const auto value = checker.atDefaults(arg); value && value->num() < 0)
            checker.error(arg.span, "a setback goes inward and is no less than 0", "write 'offset' to go outward");
    out.plan = std::move(words);
    checker.add(std::move(out));
}

void applySetback(AttributeContext& context, const Attribute& attribute) {
    const plan::Footprint footprint = context.footprint();
    const auto& words = attribute.plan->words;
    std::vector<double> distances;
    std::vector<bool> called(words.size(), false);
    for (const plan::PlacedEdge& edge : plan::edgesOf(footprint)) {
        const auto word = std::find_if(words.begin(), words.end(),
                                       [&](const std::string& w) { return plan::isEdgeCalled(footprint, edge, w); });
        const auto at = static_cast<size_t>(word - words.begin());
        distances.push_back(at == words.size() ? 0 : std::max(0.0, context.number(attribute.args[at])));
        if (at < words.size()) called[at] = true;
    }
    for (size_t i = 0; i < words.size(); ++i)
        if (words[i] != "rest" && words[i] != "side")
            derive::select(*context.place.builder, attribute.args[i].span, called[i], [&] {
                return derive::noEdgeLeft(words[i], footprint, "words", "so none goes inward by this");
            });
    auto inner = plan::setbackInBudget(footprint, distances);
    if (!inner.ok())
        return context.place.builder->monitor().fail(inner.error().kind, inner.error().message, attribute.span);
    context.setFootprint(std::move(*inner), attribute.span);
}

void applyCourt(AttributeContext& context, const Attribute& attribute) {
    const double wing_m = context.number(attribute.args[0]);
    auto court = plan::court(context.footprint(), wing_m);
    derive::select(*context.place.builder, attribute.span, court.has_value(), [&] {
        const Vec3d size = context.out.scope.size;
        return derive::Explanation{
            fmt::format("wings of {:.4g} m leave no court in a plan of {:.3g} m by {:.3g} m, which stays whole", wing_m,
                        size.x, size.z),
            "make the wings narrower, or begin with a larger plan"};
    });
    if (court) context.setFootprint(std::move(*court), attribute.span);
}

void applyRectify(AttributeContext& context, const Attribute& attribute) {
    context.setFootprint(plan::rectified(context.footprint(), context.number(attribute.args[0])), attribute.span);
}

void applyInner(AttributeContext& context, const Attribute& attribute) {
    const auto box = plan::innerRectangle(context.footprint());
    if (!box) return context.leave(false, attribute.span);
    context.setFootprint(
        plan::footprintOf(plan::polygonOf({box->lo, {box->hi.x, box->lo.z}, box->hi, {box->lo.x, box->hi.z}})),
        attribute.span);
    context.out.scope.footprint = derive::none;
}

}  // namespace

constinit const Operation footprint{
    .name = "footprint",
    .doc =
        "Gives the scope a plan, which terminals without a solid and roofs stand over; a plan in metres sets its size "
        "along x and z.",
    .example = "footprint ell(16, 12, 5, 6) block",
    .arguments = footprintArguments,
    .traits = {.beforeShape = true},
    .check = checkFootprint,
    .agree = agreePlan,
    .apply = applyFootprint,
};

constinit const Operation extrude{
    .name = "extrude",
    .doc = "Sets the height of the scope; its foot stays.",
    .example = "footprint ngon(6) extrude 9m block",
    .arguments = extrudeArguments,
    .range = {1e-6, mostSide_m, "more than 0, and at most 100 km"},
    .traits = {.beforeShape = true},
    .agree = agreeExtrude,
    .apply = applyExtrude,
};

constinit const Operation offset{
    .name = "offset",
    .doc = "Moves all edges of the footprint outward, with mitred corners; where nothing is left no shape is made.",
    .example = "footprint ell(16, 12, 5, 6) offset .4m block",
    .arguments = offsetArguments,
    .range = {-mostSide_m, mostSide_m, "at most 100 km"},
    .traits = {.beforeShape = true},
    .agree = agreeOffset,
    .apply = applyOffset,
};

constinit const Operation setback{
    .name = "setback",
    .doc =
        "Moves edges of the footprint inward, all or those called by a word: front (+z) back left right side court cut "
        "rest, or a tag.",
    .example = "footprint rect(30, 20) setback edges(front: 5m, rest: 2m) block",
    .arguments = setbackArguments,
    .traits = {.beforeShape = true},
    .check = checkSetback,
    .agree = agreePlan,
    .apply = applySetback,
};

constinit const Operation court{
    .name = "court",
    .doc =
        "Cuts a court out of the footprint that leaves wings of one depth; its edges are called court. A plan in which "
        "the wings leave none stays whole.",
    .example = "footprint rect(40, 30) court 11m block",
    .arguments = courtArguments,
    .range = {1e-3, mostSide_m, "at least 1 mm"},
    .traits = {.beforeShape = true},
    .agree = agreePlan,
    .apply = applyCourt,
};

constinit const Operation rectify{
    .name = "rectify",
    .doc = "Lays the edges of a surveyed plan along its main directions, where they are nearly so.",
    .example = "footprint outline((0, 0), (9, .2), (9.1, 6), (0, 6)) rectify 5deg block",
    .arguments = rectifyArguments,
    .traits = {.beforeShape = true},
    .agree = agreePlan,
    .apply = applyRectify,
};

constinit const Operation inner{
    .name = "inner",
    .doc = "Makes the largest rectangle inside the footprint the scope.",
    .example = "footprint ell(16, 12, 5, 6) inner cube",
    .traits = {.beforeShape = true},
    .apply = applyInner,
};

}  // namespace sgm::operations
