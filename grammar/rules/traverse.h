// One walk over the elements of a body, for every pass that asks something of all of them.
// Enters: a checked body. Leaves: calls in the order of the text. Assumes nesting that the parser has bounded.
#pragma once

#include "grammar/rules/grammar.h"

namespace sgm::rules {

/// Calls `visit` with the body of a part, or those of what it repeats.
template <class Visit>
void forEachBodyOf(const Parts::Part& part, const Visit& visit) {
    if (part.body) visit(*part.body);
    for (const Parts::Part& repeated : part.repeated) forEachBodyOf(repeated, visit);
}

/// Calls `visit` with every body that stands in `e`: its group, its parts, its loop and its alternatives.
template <class Visit>
void forEachInnerBody(const Element& e, const Visit& visit) {
    if (e.content.group()) visit(*e.content.group());
    if (e.body) visit(*e.body);
    if (const Parts* parts = e.content.parts())
        for (const Parts::Part& part : parts->parts) forEachBodyOf(part, visit);
    for (const Choice& choice : e.choices) visit(*choice.body);
}

/// Calls `visit` with every element of a body, those of the bodies in it included.
template <class Visit>
void forEachElement(const Body& body, const Visit& visit) {
    for (const auto& chain : body.siblings)
        for (const Element& e : chain) {
            visit(e);
            forEachInnerBody(e, [&](const Body& inner) { forEachElement(inner, visit); });
        }
}

}  // namespace sgm::rules
