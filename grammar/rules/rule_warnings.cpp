// What rules say in vain: weights of rules that conditions choose, steps that undo one another.
#include <fmt/format.h>

#include "grammar/rules/static_analysis.h"

namespace sgm::rules {
namespace {

/// The only shape that a body makes, where it is a solid that the rules of `symbol` go on from; null otherwise.
const Element* soleSuccessor(const Body& body, SymbolId symbol) {
    if (body.grows || body.siblings.size() != 1 || body.siblings[0].size() != 1) return nullptr;
    const Element& e = body.siblings[0][0];
    const bool isSolid = e.kind == Element::Kind::Shape && !e.content.parts() && !e.content.empty();
    return isSolid && e.live == symbol ? &e : nullptr;
}

}  // namespace

void findUnusedWeights(const Grammar& grammar, syntax::Diagnostics& diagnostics) {
    for (const Rule& rule : grammar.rules)
        if (rule.weight && (rule.when || rule.besideWins) && rule.span.source == grammar.sources[0].get())
            diagnostics.warning(
                rule.weight->span,
                fmt::format("this weight does nothing: of rules with '{}' the first one that holds wins",
                            rule.when ? "when" : "beside"),
                "draw among bodies instead: 'choose { 3: … | 1: … }'");
}

void findReplacingSteps(const Grammar& grammar, syntax::Diagnostics& diagnostics) {
    for (const Rule& rule : grammar.rules)
        if (rule.repeat && rule.span.source == grammar.sources[0].get())
            if (const Element* e = soleSuccessor(rule.body, rule.symbol))
                diagnostics.warning(rule.repeat->span,
                                    fmt::format("each step replaces what the one before made, so that the last '{}' "
                                                "alone is left",
                                                e->label),
                                    "begin the body with '+' to grow on what stands");
}

}  // namespace sgm::rules
