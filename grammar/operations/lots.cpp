// lots: a block cut into pieces along its streets (modeler/town/lots.h).
#include <fmt/format.h>

#include <algorithm>

#include "grammar/derive/parts_context.h"
#include "grammar/operations/operations.h"
#include "grammar/operations/plan_parts.h"
#include "grammar/rules/make.h"
#include "grammar/rules/words.h"
#include "modeler/core/packages.h"
#include "modeler/core/random.h"
#include "modeler/town/lots.h"

namespace sgm::operations {
namespace {

using derive::PartsContext;
using derive::Scope;
using rules::OperationChecker;
using rules::Parts;
using rules::Unit;
using rules::Want;
using syntax::Operation;
using syntax::OperationArgument;

constexpr std::string_view partWords[] = {"lot", "corner", "inner"};
constexpr double mostLots = 1e6;
constexpr OperationArgument lotsArguments[] = {
    {"area", syntax::ArgumentType::Plan,
     "area of a lot, or box(420m2, front: 8m, jitter: 15%), or skeleton(420m2, front: 8m, jitter: 15%, depth: 30m)"}};

/// box(area, front: length, jitter: share), skeleton(area, front: length, jitter: share, depth: length)
void checkCuts(OperationChecker& checker, const syntax::Expr& e, Parts& out) {
    const bool hasDepth = e.text == "skeleton";
    for (size_t i = 0; i < e.args.size(); ++i) {
        const std::string& name = e.argNames[i];
        checker.beginDraws("lots." + (name.empty() ? "area" : name));
        if (name.empty() && i == 0)
            out.args[0] = checker.expression(e.args[i], Want::Area, "the area of a lot");
        else if (name == "front")
            out.args[1] = checker.expression(e.args[i], Want::Length, "'front'");
        else if (name == "jitter")
            out.args[2] = checker.expression(e.args[i], Want::Number, "'jitter'");
        else if (name == "depth" && hasDepth)
            out.args[3] = checker.expression(e.args[i], Want::Length, "'depth'");
        else
            checker.error(e.args[i].span,
                          name.empty() ? fmt::format("'{}' takes one number, the area of a lot", e.text)
                                       : fmt::format("'{}' has no '{}'", e.text, name),
                          name.empty() ? fmt::format("write '{}(420m2, front: 8m)'", e.text)
                          : hasDepth   ? rules::nearestHint(name, {"front", "jitter", "depth"})
                                       : rules::nearestHint(name, {"front", "jitter"}));
    }
    if (e.args.empty() || !e.argNames[0].empty())
        checker.error(e.span, fmt::format("'{}' begins with the area of a lot", e.text),
                      fmt::format("write '{}(420, front: 8m)'", e.text));
}

std::shared_ptr<Parts> checkLots(OperationChecker& checker, const syntax::Attribute& written) {
    auto out = std::make_shared<Parts>();
    out->span = written.span;
    out->operation = written.operation;
    const town::LotParameters usual;
    out->args = {rules::makeConstant(written.span, rules::Value::number(usual.area_m2)),
                 rules::makeConstant(written.span, rules::Value::number(usual.front_m, Unit::Metre)),
                 rules::makeConstant(written.span, rules::Value::number(usual.jitter)),
                 rules::makeConstant(written.span, rules::Value::number(usual.depth_m, Unit::Metre)),
                 rules::makeConstant(written.span, rules::Value::boolean(false))};
    if (!written.args.empty()) {
        const syntax::Expr& e = written.args[0];
        checker.beginDraws("lots");
        const bool isCall = e.kind == syntax::Expr::Kind::Call;
        if (isCall && e.text == "skeleton" && !isBuiltWith(Package::Cgal))
            checker.error(e.span, missingPackage(Package::Cgal, "'skeleton'").message + "; write box(…)");
        out->args[4] = rules::makeConstant(written.span, rules::Value::boolean(isCall && e.text == "skeleton"));
        if (isCall && (e.text == "box" || e.text == "skeleton"))
            checkCuts(checker, e, *out);
        else
            out->args[0] = checker.expression(e, Want::Area, "the area of a lot");
    }
    constexpr std::pair<double, double> ranges[] = {{4, 1e8}, {0, 1000}, {0, .45}, {0, 1000}};
    constexpr std::string_view texts[] = {"the area of a lot is 4 … 10⁸ square metres", "'front' is 0 … 1 km",
                                          "'jitter' is 0 … 45%",
                                          "'depth' is 0 … 1 km, where 0 is twice the root of the area"};
    for (size_t i = 0; i < std::size(ranges); ++i)
        if (const auto value = checker.atDefaults(out->args[i]);
            value && !(value->num() >= ranges[i].first && value->num() <= ranges[i].second))
            checker.error(out->args[i].span, fmt::format("{}, not {}", texts[i], rules::toText(*value)));
    out->parts = checkWordParts(checker, written, partWords);
    return out;
}

bool runLots(PartsContext& context, const Parts& parts) {
    context.startsOver();
    const auto number = [&](size_t i) { return context.evaluate(parts.args[i], hashText("lots") + i).num(); };
    town::LotParameters parameters;
    parameters.area_m2 = std::clamp(number(0), 4.0, 1e8);
    parameters.front_m = std::clamp(number(1), 0.0, 1000.0);
    parameters.jitter = std::clamp(number(2), 0.0, .45);
    parameters.depth_m = std::clamp(number(3), 0.0, 1000.0);
    parameters.cuts = number(4) != 0 ? town::Cuts::Skeleton : town::Cuts::Boxes;
    const Parts::Part *lotPart = findPart(parts, "lot"), *cornerPart = findPart(parts, "corner"),
                      *innerPart = findPart(parts, "inner");
    const plan::Footprint block = context.footprint();
    if (const double count = area(block) / parameters.area_m2; count > mostLots)
        return context.fail({Error::Kind::Budget,
                             fmt::format("this would be {:.0f} lots, and a block has at most {:.0f}", count, mostLots)},
                            parts.span);
    const std::vector<town::Lot> cut = town::lotsOf(block, parameters, context.key(), context.progress());
    if (cancelled(context.progress())) return context.fail(cancelledError(), parts.span);
    const bool hasStreet = std::any_of(cut.begin(), cut.end(), [](const town::Lot& lot) { return lot.street_m > 0; });
    context.select(parts.span, hasStreet, [] {
        return derive::Explanation{
            "no edge of this block is called 'street', so all of it is 'inner' and no lot is made",
            "lots stand along streets: the blocks of a 'network' have them, and 'tag street' before 'lots' makes one "
            "of "
            "every edge, 'tag street along front' of some"};
    });
    for (const town::Lot& lot : cut) {
        const bool inner = lot.street_m <= 0;
        const Parts::Part* part = inner ? innerPart : lot.corner && cornerPart ? cornerPart : lotPart;
        Scope scope = context.scope();
        scope.centre += scope.axes * Vec3d{lot.centre.x, 0, lot.centre.z};
        scope.axes = scope.axes * Mat3{{lot.right.x, 0, lot.right.z}, {0, 1, 0}, {lot.front.x, 0, lot.front.z}};
        const plan::Box2 box = bounds(lot.land);
        scope.size = {box.size().x, scope.size.y, box.size().z};
        context.draw(inner ? "inner" : lot.corner ? "corner" : "lot", scope, lot.land, lot.key, lot.street_m);
        if (!part || context.derivation().planAlone) continue;
        const auto over = context.over(scope, lot.land, parts.span);
        if (!over || !context.run(*part->body, *over, lot.key)) return false;
    }
    return true;
}

}  // namespace

constinit const Operation lots{
    .name = "lots",
    .doc =
        "Cuts a block into lots of about so many square metres, each with a piece of street: x runs along it, z to it. "
        "corner is a lot at two streets (lot, where it isn't said), inner what lies behind all lots. Edges keep the "
        "block's tags; those between lots are called cut. By box they are halves of halves; by skeleton strips along "
        "the "
        "streets, cut square to them.",
    .example = "size (60, 4, 40) tag street lots box(300, front: 8m) { lot: setback 2m wall | inner: lawn }",
    .arguments = lotsArguments,
    .phase = Operation::Phase::Content,
    .block = {.label = "lot"},
    .checkParts = checkLots,
    .run = runLots,
};

}  // namespace sgm::operations
