// What an edit of rules asks of the `derive` lines, which call a rule without a name by its number: "Cell#2".
#include <fmt/format.h>

#include <algorithm>

#include "viewer/document/nodes.h"

namespace sgm::document::edits {
namespace {

/// How a `derive` line calls the rule at `index`: its name, or its number among the nameless ones of its symbol.
std::string calledAs(const std::vector<ListedRule>& rules, size_t index) {
    const ListedRule& rule = rules[index];
    if (!rule.name.empty()) return rule.name;
    const auto before = std::count_if(rules.begin(), rules.begin() + static_cast<std::ptrdiff_t>(index) + 1,
                                      [&](const ListedRule& r) { return r.name.empty() && r.symbol == rule.symbol; });
    return fmt::format("{}#{}", rule.symbol, before);
}

}  // namespace

std::vector<ListedRule> listed(const Ast& ast) {
    std::vector<ListedRule> rules;
    for (const RuleDecl& rule : ast.rules) rules.push_back({&rule, rule.symbol.text, rule.name.text});
    return rules;
}

Edit withWays(const Ast& ast, TextEdit edit, const std::vector<ListedRule>& now) {
    const std::vector<ListedRule> before = listed(ast);
    std::vector<TextEdit> all{edit};
    for (const syntax::DeriveDecl& way : ast.derives)
        for (const auto& step : way.steps) {
            size_t old = 0;
            while (old < before.size() && calledAs(before, old) != step.rule.text) ++old;
            if (old == before.size()) continue;
            const auto kept =
                std::find_if(now.begin(), now.end(), [&](const ListedRule& r) { return r.rule == before[old].rule; });
            std::string called = step.rule.text;
            if (kept != now.end()) {
                called = calledAs(now, static_cast<size_t>(kept - now.begin()));
            } else if (before[old].name.empty()) {
                // Its number must not come to mean the next rule: the last one is free now, and `check` says so.
                const auto count = std::count_if(before.begin(), before.end(), [&](const ListedRule& r) {
                    return r.name.empty() && r.symbol == before[old].symbol;
                });
                called = fmt::format("{}#{}", before[old].symbol, count);
            }
            if (called != step.rule.text) all.push_back({step.rule.span.begin, step.rule.span.end, called});
        }
    return tried(ast, all.size() == 1 ? std::move(edit) : merged(ast.source->text(), std::move(all)));
}

}  // namespace sgm::document::edits
