// split, snap: cuts a scope along one of its axes, along edges of its plan or by area, and runs a body in every part
// (the split of CGA shape grammars: Müller, Wonka, Haegler, Ulmer, Van Gool, "Procedural modeling of buildings", 2006;
// snap lines: section 4.2 there).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "grammar/derive/parts_context.h"
#include "grammar/operations/operations.h"
#include "grammar/operations/split_layout.h"
#include "grammar/rules/lookup.h"
#include "grammar/rules/operation_checker.h"
#include "grammar/rules/words.h"
#include "modeler/core/random.h"
#include "modeler/plan/cut.h"
#include "modeler/plan/edge_words.h"

namespace sgm::operations {
namespace {

using derive::PartsContext;
using derive::Scope;
using plan::Vec2;
using rules::OperationChecker;
using rules::Parts;
using rules::Want;
using syntax::ArgumentType;
using syntax::Operation;
using syntax::OperationArgument;
using Part = Parts::Part;
using Written = syntax::Expr;

constexpr OperationArgument splitArguments[] = {{"way", ArgumentType::Cut,
                                                 "x, y or z of the scope; along WORD: along the edges of the plan that "
                                                 "are called so, as 'along street'; area x: by "
                                                 "square metres of the plan, along x or z"}};
constexpr OperationArgument snapArguments[] = {{"shapes", ArgumentType::Symbol, "whose faces cuts move to"},
                                               {"reach", ArgumentType::Length, "metres that a cut moves at most"}};

/// Whether a draw, or the number of the repetition, decides about the value.
bool isDrawn(const rules::Expr& e, uint32_t local) {
    using Kind = rules::Expr::Kind;
    if (e.kind == Kind::Range || e.kind == Kind::Choose) return true;
    if (e.kind == Kind::Local && e.index == local) return true;
    return std::any_of(e.args.begin(), e.args.end(), [&](const rules::Expr& arg) { return isDrawn(arg, local); });
}

/// One part, its body checked against the part's own scope.
Part checkPart(OperationChecker& checker, const syntax::Case& written, const Parts& split, uint32_t local) {
    Part out;
    out.span = written.span;
    checker.beginDraws("part");
    if (written.label) {
        out.floating = written.label->kind == Written::Kind::Floating;
        const Written& size = out.floating && !written.label->args.empty() ? written.label->args[0] : *written.label;
        if (split.byArea)
            out.size = checker.expression(size, Want::Area, "the area of a part");
        else if (out.floating || !split.edges.empty())
            out.size = checker.expression(size, out.floating ? Want::Length : Want::Extent,
                                          out.floating ? "what follows '~'" : "the size of a part");
        else
            out.size = checker.measure(size, Want::Extent, "the size of a part", split.axis);
        if (const auto value = checker.atDefaults(out.size); value && value->num() < 0)
            checker.error(size.span, "the size of a part is no less than 0");
        // In `grammar 1` all repetitions have the sizes of the first.
        out.isDrawn = rules::versionOf(checker.grammar(), written.span) >= 2 && isDrawn(out.size, local);
    } else if (!written.tag.empty()) {
        checker.error(written.tag.span, "a part of a split has a size, not a tag",
                      "write '4m: …', '30%: …' or '~1: …'");
    }
    out.body = written.body ? checker.partBody(*written.body) : std::make_shared<const rules::Body>();
    return out;
}

/// `{ … }*`, `{ … }+`, `{ … }3`: `i` is the number of the repetition, from 1.
Part checkRepeated(OperationChecker& checker, const syntax::Case& written, const Parts& split, bool insideFill) {
    Part out;
    out.span = written.span;
    out.atLeastOnce = written.atLeastOnce;
    if (written.times) {
        checker.beginDraws("times");
        out.times = checker.expression(*written.times, Want::Count, "how often a block repeats");
        if (const auto value = checker.atDefaults(*out.times); value && value->num() < 0)
            checker.error(written.times->span, "a block repeats no less than 0 times");
    } else if (insideFill) {
        checker.error(written.span, "two blocks that repeat to fit, one in the other, have no lengths of their own",
                      "say how often one of them repeats: '{ … }3'");
    }
    checker.withLocal("i", out.local, [&] {
        for (const syntax::Case& c : written.cases)
            out.repeated.push_back(c.repeated ? checkRepeated(checker, c, split, insideFill || !written.times)
                                              : checkPart(checker, c, split, out.local));
    });
    return out;
}

void checkSnap(OperationChecker& checker, const syntax::Attribute& written) {
    if (written.args.size() != 2) return;
    rules::Attribute out;
    out.operation = written.operation;
    out.span = written.span;
    if (const auto symbol = checker.names().findSymbol(written.args[0].text))
        out.symbol = *symbol;
    else
        checker.unknownName(written.args[0].span, written.args[0].text,
                            fmt::format("no shape is called '{}'", written.args[0].text),
                            rules::nearestHint(written.args[0].text, checker.names().symbols()));
    checker.beginDraws("snap");
    out.args.push_back(checker.expression(written.args[1], Want::Length, "how far a cut moves"));
    checker.add(std::move(out));
}

void agreeSnap(OperationChecker& checker, const rules::Element& element, const rules::Attribute& attribute) {
    const Parts* parts = element.content.parts();
    if (!parts || parts->operation != &split || !parts->edges.empty() || parts->byArea)
        checker.error(attribute.span, "'snap' moves the cuts of a 'split' along an axis, and there is none here",
                      "write 'split x { … } snap Bay .3m'");
}

std::shared_ptr<Parts> checkSplit(OperationChecker& checker, const syntax::Attribute& written) {
    auto out = std::make_shared<Parts>();
    out->span = written.span;
    out->operation = written.operation;
    if (!written.args.empty()) {
        const Written& way = written.args[0];
        const bool isCall = way.kind == Written::Kind::Call;
        const Written& word = isCall ? way.args[0] : way;
        out->byArea = isCall && way.text == "area";
        if (isCall && !out->byArea)
            out->edges = word.text;
        else
            out->axis = word.text == "x" ? 0 : word.text == "y" ? 1 : 2;
        const bool isAxis = word.text == "x" || word.text == "z" || (word.text == "y" && !out->byArea);
        if (out->edges.empty() && !isAxis && word.kind != Written::Kind::Error)
            checker.error(word.span,
                          fmt::format("a split goes along x, y or z{}, not '{}'",
                                      out->byArea ? " (by area: x or z)" : "", word.text),
                          "write 'split x { … }' or 'split along street { … }'");
    }
    for (const syntax::Case& c : written.cases)
        out->parts.push_back(c.repeated ? checkRepeated(checker, c, *out, false)
                                        : checkPart(checker, c, *out, rules::none));
    for (const rules::Attribute& attribute : checker.element().attributes)
        if (attribute.operation == &snap) out->snap = {attribute.symbol, attribute.args[0], attribute.span};
    return out;
}

/// The bodies of pieces in their scopes, which `scopeOf` gives by number: nothing where there is none.
template <class ScopeOf>
bool runPieces(PartsContext& context, const std::vector<Piece>& pieces, ScopeOf scopeOf) {
    for (size_t i = 0; i < pieces.size(); ++i) {
        const Piece& piece = pieces[i];
        if (piece.to - piece.from <= leastPart) continue;
        for (const auto& [local, turn] : piece.turns) context.count(local, turn);
        const std::optional<Scope> scope = scopeOf(i);
        if (scope && !context.run(*piece.part->body, *scope, piece.key)) return false;
    }
    return true;
}

/// A scope over a piece of the plan, in a frame of its own: `right` and `out` square to each other, about `origin`.
std::optional<Scope> scopeOver(PartsContext& context, plan::Footprint footprint, Vec2 origin, Vec2 right, Vec2 out,
                               syntax::SourceSpan span) {
    if (footprint.empty()) return std::nullopt;
    for (plan::Polygon& polygon : footprint.polygons) {
        const auto turn = [&](plan::Ring& ring) {
            for (Vec2& p : ring.points) p = {dot(p - origin, right), dot(p - origin, out)};
        };
        turn(polygon.outer);
        for (plan::Ring& court : polygon.courts) turn(court);
    }
    const plan::Box2 box = bounds(footprint);
    const Vec2 middle = box.centre(), at = origin + right * middle.x + out * middle.z;
    const Scope& whole = context.scope();
    Scope scope = whole;
    scope.centre = whole.centre + whole.axes * Vec3d{at.x, 0, at.z};
    scope.axes = whole.axes * Mat3{{right.x, 0, right.z}, {0, 1, 0}, {out.x, 0, out.z}};
    scope.size = {box.size().x, whole.size.y, box.size().z};
    return context.over(scope, plan::placed(footprint, {1, 1}, {-middle.x, -middle.z}), span);
}

/// Parts one behind the other along the edges of a word, each standing on its own chord: x from left to right seen from
/// outside, z outward.
bool runAlong(PartsContext& context, const Parts& split) {
    constexpr double leastCut_m = 2e-3;
    const plan::Footprint footprint = context.footprint();
    const std::vector<plan::PlacedEdge> edges = plan::edgesOf(footprint);
    std::vector<bool> belongs;
    for (const plan::PlacedEdge& edge : edges) belongs.push_back(plan::isEdgeCalled(footprint, edge, split.edges));
    const plan::Chain chain = plan::longestChain(footprint, belongs);
    if (chain.count == 0) {
        const Scope& scope = context.scope();
        derive::Explanation explanation = derive::noEdgeCalled(
            split.edges, footprint,
            fmt::format(
                "so nothing stands along it here: a plan of {:.3g} m by {:.3g} m about ({:.3g}, {:.3g}, {:.3g})",
                scope.size.x, scope.size.z, scope.centre.x, scope.centre.y, scope.centre.z));
        context.warn(split.span, std::move(explanation.message), std::move(explanation.hint));
        return true;
    }
    const double whole = plan::length(footprint, chain);
    auto pieces = layOut(context, split, whole);
    if (!pieces) return false;
    placePieces(context, split, *pieces, whole);
    std::erase_if(*pieces, [&](const Piece& p) { return p.to - p.from <= leastCut_m; });
    std::vector<double> cuts;
    for (const Piece& piece : *pieces)
        if (piece.from > leastCut_m) cuts.push_back(piece.from);
    const bool isShort = !pieces->empty() && pieces->back().to < whole - leastCut_m;  // what is left stays empty
    if (isShort) cuts.push_back(pieces->back().to);
    const auto parts = plan::splitAlong(footprint, chain, cuts);
    if (!parts.ok()) return context.fail(parts.error(), split.span);
    // Chains run with the solid on their left: seen from outside from right to left.
    return runPieces(context, *pieces, [&](size_t i) -> std::optional<Scope> {
        if (i >= parts->size()) return std::nullopt;
        const plan::AlongPart& part = (*parts)[i];
        const Vec2 chord = part.to - part.from;
        const double metres = length(chord);
        if (metres <= leastCut_m) return std::nullopt;
        const Vec2 right = chord * (-1 / metres), out{-right.z, right.x};
        return scopeOver(context, part.footprint, (part.from + part.to) * .5, right, out, split.span);
    });
}

bool runByArea(PartsContext& context, const Parts& split) {
    const plan::Footprint footprint = context.footprint();
    const double whole = area(footprint);
    auto pieces = layOut(context, split, whole);
    if (!pieces) return false;
    placePieces(context, split, *pieces, whole);
    std::vector<double> areas;
    for (const Piece& piece : *pieces) areas.push_back(piece.to - piece.from);
    const std::vector<plan::Footprint> parts = plan::splitByArea(footprint, split.axis == 0 ? 0 : 1, areas);
    return runPieces(context, *pieces, [&](size_t i) -> std::optional<Scope> {
        if (i >= parts.size()) return std::nullopt;
        return scopeOver(context, parts[i], {0, 0}, {1, 0}, {0, 1}, split.span);
    });
}

bool snapPieces(PartsContext& context, const Parts& split, std::vector<Piece>& pieces) {
    const double reach_m = context.evaluate(split.snap->reach, hashText("snap")).num();
    std::vector<double> lines = context.facesAlong(split.snap->symbol, split.axis);
    if (lines.empty())
        context.warn(split.snap->span,
                     fmt::format("no '{}' stands yet when this is split, so no cut moves",
                                 context.grammar().symbols[split.snap->symbol].name),
                     "let the rule wait for the shapes that make it: 'rule Row after Shops -> …'");
    snapCuts(pieces, std::move(lines), reach_m);
    return true;
}

/// The parts from low to high along the axis.
bool runSplit(PartsContext& context, const Parts& split) {
    if (!split.edges.empty()) return runAlong(context, split);
    if (split.byArea) return runByArea(context, split);
    const double whole_m = context.scope().size[split.axis];
    auto pieces = layOut(context, split, whole_m);
    if (!pieces) return false;
    placePieces(context, split, *pieces, whole_m);
    if (split.snap && !snapPieces(context, split, *pieces)) return false;
    return runPieces(context, *pieces,
                     [&](size_t i) { return context.cut(split.axis, (*pieces)[i].from, (*pieces)[i].to); });
}

}  // namespace

constinit const Operation split{
    .name = "split",
    .doc =
        "Cuts the scope along an axis, along edges of its plan or by area: sizes are absolute (4m), relative (30%) or "
        "floating (~1); { … }* repeats to fit, { … }+ at least once, { … }3 three times.",
    .example = "split x { 1m: wall | { ~2.4m: Tile }* | 1m: wall }",
    .arguments = splitArguments,
    .phase = Operation::Phase::Content,
    .block = {.label = "~1"},
    .checkParts = checkSplit,
    .run = runSplit,
};

constinit const Operation snap{
    .name = "snap",
    .doc =
        "Lets the cuts of a split move onto faces of other shapes: those between floating sizes, and fixed parts "
        "between them as a whole.",
    .example = "split x { 1m: wall | { ~2.4m: Tile }* | 1m: wall } snap Shop .4m",
    .arguments = snapArguments,
    .phase = Operation::Phase::Detail,
    .check = checkSnap,
    .agree = agreeSnap,
};

}  // namespace sgm::operations
