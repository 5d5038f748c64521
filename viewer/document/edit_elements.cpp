// Edits of what stands in a body: elements, their operators and attributes.
#include <fmt/format.h>

#include <algorithm>

#include "grammar/operations/operations.h"
#include "grammar/syntax/printer.h"
#include "viewer/document/nodes.h"

namespace sgm::document::edits {
namespace {

using syntax::Attribute;
using syntax::Operation;
using syntax::Operator;
using Kind = Element::Kind;

bool isControl(const Element& e) { return e.kind != Kind::Shape && e.kind != Kind::Group; }

/// The element's text without its operator.
std::string_view operand(const Element& e) {
    std::string_view text = e.span.text();
    text.remove_prefix(syntax::sign(e.op).size());
    return text.substr(std::min(text.find_first_not_of(" \t"), text.size()));
}

/// The element's text with another operator.
std::string withOperator(const Element& e, Operator op) {
    return op == Operator::None ? std::string(operand(e)) : fmt::format("{} {}", syntax::sign(op), operand(e));
}

Error notHere() { return refused("this element is not part of the text any more"); }

/// Puts `text` behind an element: in a line of its own where the element has one.
TextEdit putBehind(const Ast& ast, const Element& element, std::string text) {
    const std::string_view all = ast.source->text();
    const uint32_t end = element.span.end;
    if (!beginsLine(all, element.span.begin)) return {end, end, " " + std::move(text), 1};
    const uint32_t begin = lineBegin(all, element.span.begin);
    const std::string indent(all.substr(begin, element.span.begin - begin));
    const uint32_t at = endsLine(all, end) ? lineEnd(all, end) : end;
    return {at, at, "\n" + indent + std::move(text), static_cast<uint32_t>(indent.size() + 1)};
}

const Attribute* find(const Element& element, const syntax::Operation& operation) {
    for (const auto* list : {&element.after, &element.before})
        for (const Attribute& attribute : *list)
            if (attribute.operation == &operation) return &attribute;
    return nullptr;
}

TextEdit removalOf(const Ast& ast, const Attribute& attribute) {
    return removal(ast.source->text(), attribute.span.begin, attribute.span.end);
}

/// Where an attribute that is new to the element goes: behind the last one, before `: Name`.
uint32_t attributesEnd(const Ast& ast, const Element& element) {
    if (element.live.empty()) return element.span.end;
    return endBefore(ast, beginBefore(ast, element.live.span.begin));  // behind the token before ':'
}

Result<std::string> argumentsOf(const syntax::Operation& row, std::string_view written) {
    if (row.arguments.size() != 1 || row.hasBlock()) return std::string(written);
    return asArgument(written);
}

/// The edit, not yet tried, that sets an attribute.
Edit attributeEdit(const Ast& ast, const Element& element, const syntax::Operation& operation,
                   std::string_view written) {
    if (isControl(element))
        return refused(fmt::format("'{}' belongs to a shape, not to a loop or a choice", operation.name));
    const auto arguments = argumentsOf(operation, written);
    if (!arguments.ok()) return arguments.error();
    const Attribute* present = find(element, operation);
    // A shape may set several values: `with` changes the one of this name, or adds one.
    if (operation.traits.namesValue) present = nullptr;
    if (present && !present->args.empty())
        return TextEdit{present->args.front().span.begin, present->args.back().span.end, *arguments};
    if (present)
        return TextEdit{present->span.begin, present->span.end, fmt::format("{} {}", operation.name, *arguments)};
    const uint32_t at = attributesEnd(ast, element);
    return TextEdit{at, at, fmt::format(" {} {}", operation.name, *arguments)};
}

}  // namespace

Edit addElement(const Ast& ast, const Element& after, std::string_view text) {
    if (!placeOf(ast, after).body) return notHere();
    return tried(ast, putBehind(ast, after, std::string(text)));
}

Edit removeElement(const Ast& ast, const Element& element) {
    const Place place = placeOf(ast, element);
    if (!place.body) return notHere();
    const std::string_view text = ast.source->text();
    const TextEdit gone = removal(text, element.span.begin, element.span.end);
    const auto& chain = place.chain();
    if (place.index > 0) return tried(ast, gone);
    if (chain.size() > 1) {
        const Element& next = chain[1];
        if (element.op != Operator::None || isControl(next)) return tried(ast, gone);
        if (next.op != Operator::Sum)
            return refused(fmt::format("what '{}' works on would be missing", syntax::sign(next.op)));
        return tried(ast, {element.span.begin,
                           next.span.begin + static_cast<uint32_t>(next.span.text().size() - operand(next).size()),
                           {}});
    }
    if (place.body->siblings.size() > 1) {
        const bool first = place.sibling == 0;
        const auto comma = first ? tokenFrom(ast, element.span.end)
                                 : syntax::SourceSpan{ast.source.get(), beginBefore(ast, element.span.begin),
                                                      endBefore(ast, element.span.begin)};
        return tried(ast, merged(text, {gone, {comma.begin, comma.end, {}}}));
    }
    if (element.op != Operator::None || isControl(element))
        return refused("it is all that this body does: delete what the body belongs to");
    return tried(ast, {element.span.begin, element.span.end, "nil"});
}

Edit duplicateElement(const Ast& ast, const Element& element) {
    if (!placeOf(ast, element).body) return notHere();
    const Operator op = element.op == Operator::None && !isControl(element) ? Operator::Sum : element.op;
    return tried(ast, putBehind(ast, element, withOperator(element, op)));
}

Edit moveElement(const Ast& ast, const Element& element, int by) {
    const Place place = placeOf(ast, element);
    if (!place.body) return notHere();
    const auto& chain = place.chain();
    const bool possible = by == -1 ? place.index > 0 : by == 1 && place.index + 1 < chain.size();
    if (!possible) return refused("there is no neighbour to change places with");
    const size_t at = by < 0 ? place.index - 1 : place.index;
    const Element &first = chain[at], &second = chain[at + 1];
    // The first of a chain is the content: whoever comes there leaves its operator to the other.
    const bool content = first.op == Operator::None && !isControl(first) && at == 0;
    if (content && (isControl(second) || second.op != Operator::Sum))
        return refused(isControl(second)
                           ? "a loop or a choice can't be the content of a shape"
                           : fmt::format("what follows '{}' can't be the content of a shape", syntax::sign(second.op)));
    const std::string_view text = ast.source->text();
    const std::string_view between = text.substr(first.span.end, second.span.begin - first.span.end);
    std::string swapped = withOperator(second, content ? Operator::None : second.op);
    swapped += between;
    const uint32_t node = by < 0 ? 0 : static_cast<uint32_t>(swapped.size());
    swapped += withOperator(first, content ? Operator::Sum : first.op);
    return tried(ast, {first.span.begin, second.span.end, std::move(swapped), node});
}

Edit setOperator(const Ast& ast, const Element& element, Operator op) {
    const Place place = placeOf(ast, element);
    if (!place.body) return notHere();
    if (isControl(element)) return refused("a loop or a choice has no operator: each shape in it has its own");
    if (op == element.op) return TextEdit{};
    if (op == Operator::None && place.index > 0) return refused("only the first of a chain has no operator");
    const auto head = static_cast<uint32_t>(element.span.text().size() - operand(element).size());
    const TextEdit change{element.span.begin, element.span.begin + head,
                          op == Operator::None ? "" : fmt::format("{} ", syntax::sign(op))};
    const Attribute* by = find(element, operations::by);
    if (by && op != Operator::Morph) return tried(ast, merged(ast.source->text(), {change, removalOf(ast, *by)}));
    return tried(ast, change);
}

Edit setSolid(const Ast& ast, const Element& element, std::string_view solid) {
    if (!element.solid) return refused("this element places no solid that could be another");
    const auto written = asExpression(solid);
    if (!written.ok()) return written.error();
    return tried(ast, {element.solid->span.begin, element.solid->span.end, *written});
}

Edit setLive(const Ast& ast, const Element& element, std::string_view name) {
    if (isControl(element)) return refused("a loop or a choice can't be live: name a shape in it");
    const std::string_view text = ast.source->text();
    if (name.empty()) {
        if (element.live.empty()) return TextEdit{};
        return tried(ast, removal(text, beginBefore(ast, element.live.span.begin), element.live.span.end));
    }
    const auto written = asName(name);
    if (!written.ok()) return written.error();
    if (!element.live.empty()) return tried(ast, {element.live.span.begin, element.live.span.end, *written});
    return tried(ast, {element.span.end, element.span.end, fmt::format(" : {}", *written)});
}

Edit setAttribute(const Ast& ast, const Element& element, const syntax::Operation& operation,
                  std::string_view arguments) {
    const Edit edit = attributeEdit(ast, element, operation, arguments);
    return edit.ok() ? tried(ast, *edit) : edit;
}

Edit removeAttribute(const Ast& ast, const Element& element, const syntax::Operation& operation) {
    const Attribute* present = find(element, operation);
    if (!present) return refused(fmt::format("there is no '{}' to take out", operation.name));
    return tried(ast, removalOf(ast, *present));
}

Edit attach(const Ast& ast, const Element& element, std::string_view joint) {
    if (element.op == Operator::None)
        return refused("the content of a shape is joined to nothing: give it an operator first");
    const Edit at = attributeEdit(ast, element, operations::at, joint);
    const Attribute* to = find(element, operations::to);
    const bool face = to && !to->args.empty() && to->args[0].text != "centre" && to->args[0].text.size() == 2;
    if (!at.ok() || !face) return at.ok() ? tried(ast, *at) : at;
    return tried(ast, merged(ast.source->text(), {*at, removalOf(ast, *to)}));
}

Edit setExpression(const Ast& ast, const syntax::Expr& expression, std::string_view text) {
    const auto written = asArgument(text);
    if (!written.ok()) return written.error();
    return tried(ast, {expression.span.begin, expression.span.end, *written});
}

Edit setBody(const Ast& ast, const syntax::Body& body, std::string_view text) {
    return tried(ast, {body.span.begin, body.span.end, std::string(text)});
}

}  // namespace sgm::document::edits
