#include "viewer/document/picking.h"

#include <fmt/format.h>

#include <algorithm>

#include "grammar/derive/lift.h"
#include "viewer/document/nodes.h"

namespace sgm::document {

using derive::Derivation;
using derive::none;
using derive::ShapeId;
using derive::ShapeTree;

Picked about(const Derivation& derivation, ShapeId shape) {
    const derive::Shape& s = derivation.tree.shapes[shape];
    Picked picked{shape,
                  derivation.tree.path(shape, true),
                  derivation.tree.labels[s.label],
                  {},
                  s.span,
                  derivation.grammar->starts[derivation.start].span};
    if (s.madeBy != none) {
        const rules::Rule& rule = derivation.grammar->rules[derivation.steps[s.madeBy].rule];
        picked.rule = rule.name;
        picked.ruleText = rule.span;
    }
    return picked;
}

std::optional<Picked> pick(const BuiltModel& shown, OriginId origin) {
    const auto& shapeOf = shown.model.lowered->shapeOf;
    // Surface that no operand owns is the root's.
    const ShapeId shape = origin == 0 ? 0 : origin < shapeOf.size() ? shapeOf[origin] : none;
    if (shape == none || shape >= shown.model.derivation.tree.shapes.size()) return std::nullopt;
    return about(shown.model.derivation, shape);
}

std::optional<derive::NamedFace> faceAt(const BuiltModel& shown, ShapeId shape, Vec3d point) {
    const Vec3d lift{0, derive::liftOf(shown.model.derivation, shape), 0};
    auto face = derive::namedFaceAt(shown.model.derivation.tree, shape, point - lift);
    if (face)
        for (Vec3d& corner : face->corners) corner += lift;
    return face;
}

std::string labelOf(const derive::NamedFace& face) {
    return face.words.empty() ? face.kind : fmt::format("{}: {}", face.kind, fmt::join(face.words, ", "));
}

ShapeId selected(const ShapeTree& tree, const std::string& path) {
    return path.empty() || tree.shapes.empty() ? none : tree.find(path);
}

namespace {

/// The text whose shapes a row stands for.
TextRange makerOf(const RuleRow& row) {
    const bool divides = row.attribute && !row.attribute->cases.empty();
    const syntax::SourceSpan span = row.kind == RuleRow::Kind::Attribute && !divides ? row.element->span
                                    : row.kind == RuleRow::Kind::Part                ? row.rule->span
                                                                                     : row.span;
    return {span.begin, span.end};
}

}  // namespace

std::vector<ShapeId> shapesOf(const Derivation& derivation, const RuleRow& row) {
    const ShapeTree& tree = derivation.tree;
    const syntax::Source* file = derivation.grammar->sources[0].get();
    const TextRange maker = makerOf(row);
    std::vector<ShapeId> exact, within;
    std::vector<bool> holds(tree.shapes.size(), false);  // it was made by this text
    for (ShapeId id = 0; id != none; id = tree.next(id)) {
        const derive::Shape& s = tree.shapes[id];
        const auto [begin, end] = TextRange{s.span.begin, s.span.end};
        if (s.span.source != file || begin < maker.begin || end > maker.end) continue;
        holds[id] = true;
        if (begin == maker.begin && end == maker.end) exact.push_back(id);
        const bool nested = s.parent != none && holds[s.parent] && tree.shapes[s.parent].madeBy == s.madeBy;
        if (!nested) within.push_back(id);
    }
    return exact.empty() ? within : exact;
}

std::vector<OriginId> originsOf(const BuiltModel& shown, ShapeId shape) {
    const ShapeTree& tree = shown.model.derivation.tree;
    const auto& shapeOf = shown.model.lowered->shapeOf;
    std::vector<bool> below(tree.shapes.size(), false);
    for (ShapeId id = shape; id != none; id = tree.next(id, shape)) below[id] = true;
    std::vector<OriginId> origins;
    if (shape == 0) origins.push_back(0);
    for (OriginId o = 1; o < shapeOf.size(); ++o)
        if (shapeOf[o] != none && below[shapeOf[o]]) origins.push_back(o);
    return origins;
}

bool isCurrent(const Document& document, const BuiltModel& shown) {
    return shown.grammar->sources[0]->text() == document.text();
}

const syntax::Element* elementOf(const Document& document, const BuiltModel& shown, ShapeId shape) {
    const syntax::SourceSpan span = shown.model.derivation.tree.shapes[shape].span;
    if (!isCurrent(document, shown) || span.source != shown.grammar->sources[0].get()) return nullptr;
    const syntax::Element* found = nullptr;
    edits::forBodies(*document.ast(), [&](const syntax::Body& body) {
        for (const auto& chain : body.siblings)
            for (const syntax::Element& e : chain)
                if (e.span.begin == span.begin && e.span.end == span.end) found = &e;
    });
    return found;
}

namespace {

/// The shape on which `shape` was put: that of its bond as a newcomer, else the one it lies in.
ShapeId hostOf(const ShapeTree& tree, ShapeId shape) {
    for (const derive::Bond& bond : tree.bonds().all)
        if (bond.shape[1] == shape) return bond.shape[0];
    return tree.shapes[shape].parent;
}

/// A shape and the content that fills it exactly have the same joints.
bool samePlace(const ShapeTree& tree, ShapeId a, ShapeId b) {
    return a == b || tree.bonds().bodyOf[a] == tree.bonds().bodyOf[b];
}

}  // namespace

namespace {

/// The element that puts `moved` on another shape, if it can be joined elsewhere.
Result<const syntax::Element*> joinedElement(const Document& document, const BuiltModel& shown, ShapeId moved) {
    const ShapeTree& tree = shown.model.derivation.tree;
    if (!isCurrent(document, shown)) return edits::refused("the text has changed since this model was made");
    const syntax::Element* element = elementOf(document, shown, moved);
    if (!element)
        return edits::refused(
            fmt::format("'{}' was made by another file: '{}'", tree.path(moved),
                        tree.shapes[moved].span.source ? tree.shapes[moved].span.source->name() : ""));
    if (moved == 0 || element->op == syntax::Operator::None)
        return edits::refused(fmt::format("'{}' is the content of its shape and joined to nothing", tree.path(moved)));
    return element;
}

}  // namespace

namespace {

/// The symbol of which a rule would have to be to join something to `host`; "" where it is a plain solid.
std::string symbolOf(const Derivation& derivation, ShapeId host) {
    const rules::SymbolId symbol = derivation.tree.shapes[host].symbol;
    if (symbol == rules::none || derivation.grammar->symbols[symbol].terminal) return "";
    return derivation.grammar->symbols[symbol].name;
}

/// The used file in which the rules of `host` stand, to which the document's own can't be added; "" where it has none.
std::string otherFileOf(const Derivation& derivation, ShapeId host) {
    const rules::Grammar& grammar = *derivation.grammar;
    const rules::SymbolId symbol = derivation.tree.shapes[host].symbol;
    if (symbol == rules::none || grammar.symbols[symbol].rules.empty()) return "";
    const syntax::Source* source = grammar.rules[grammar.symbols[symbol].rules[0]].span.source;
    return source == grammar.sources[0].get() ? "" : source->name();
}

/// What to write so that `moved` stands at a joint of a shape that its own rule doesn't match.
std::string ruleFor(const Document& document, const BuiltModel& shown, const syntax::Element& element, ShapeId host,
                    std::string_view joint) {
    const Derivation& derivation = shown.model.derivation;
    std::string symbol = symbolOf(derivation, host), text(element.span.text());
    if (const auto edit = edits::attach(*document.ast(), element, joint); edit.ok()) {
        const std::string whole = applied(document.text(), *edit);
        text = whole.substr(element.span.begin, text.size() + whole.size() - document.text().size());
    }
    const std::string name = symbol.empty() ? "Name" : symbol;
    const std::string rule = fmt::format("'rule {} -> {}'", name, text);
    if (const std::string file = otherFileOf(derivation, host); !file.empty())
        return fmt::format("write {} in '{}', where the rules of '{}' stand,", rule, file, symbol);
    return symbol.empty() ? fmt::format("give '{}' a name, as by ': Name', and write {}",
                                        derivation.tree.labels[derivation.tree.shapes[host].label], rule)
                          : "write " + rule;
}

}  // namespace

Result<std::vector<ShapeId>> hostsFor(const Document& document, const BuiltModel& shown, ShapeId moved) {
    const auto element = joinedElement(document, shown, moved);
    if (!element.ok()) return element.error();
    const ShapeTree& tree = shown.model.derivation.tree;
    const ShapeId stands = hostOf(tree, moved);
    std::vector<ShapeId> hosts;
    for (ShapeId id = 0; id != none; id = tree.next(id))
        if (tree.bonds().ownsBody(id) && samePlace(tree, stands, id)) hosts.push_back(id);
    return hosts;
}

edits::Edit attach(const Document& document, const BuiltModel& shown, ShapeId moved, ShapeId host, uint32_t joint) {
    const auto element = joinedElement(document, shown, moved);
    if (!element.ok()) return element.error();
    const ShapeTree& tree = shown.model.derivation.tree;
    const ShapeId stands = hostOf(tree, moved);
    if (!samePlace(tree, stands, host))
        return edits::refused(
            fmt::format("'{}' grows on '{}': its rule can't join it to '{}'; {} for one there, and take this one out",
                        tree.path(moved), tree.path(stands), tree.path(host),
                        ruleFor(document, shown, **element, host, tree.joint(host, joint).name)));
    return edits::attach(*document.ast(), **element, tree.joint(host, joint).name);
}

}  // namespace sgm::document
