// Edits of rules as a whole and of what stands before their arrows.
#include <fmt/format.h>

#include <algorithm>

#include "grammar/syntax/parser.h"
#include "viewer/document/nodes.h"

namespace sgm::document::edits {
namespace {

using syntax::Expr;
using syntax::SourceSpan;

/// The lines a rule stands in, from its word to the line end behind it, comments in its last line with it.
struct Lines {
    uint32_t begin = 0, end = 0;  ///< without the last line end
};

Lines linesOf(const Ast& ast, const RuleDecl& rule) {
    const std::string_view text = ast.source->text();
    return {lineBegin(text, rule.span.begin), lineEnd(text, rule.span.end)};
}

/// The same with the comment lines right above.
Lines linesWithComments(const Ast& ast, const RuleDecl& rule) {
    const std::string_view text = ast.source->text();
    Lines lines = linesOf(ast, rule);
    while (lines.begin > 0) {
        const uint32_t above = lineBegin(text, lines.begin - 1);
        if (text.substr(above, 2) != "//") break;
        lines.begin = above;
    }
    return lines;
}

TextEdit removalOf(std::string_view text, Lines lines) {
    if (lines.end == text.size() && lines.begin > 0) return {lines.begin - 1, lines.end, {}};
    uint32_t end = std::min<uint32_t>(lines.end + 1, static_cast<uint32_t>(text.size()));
    const bool gap = lines.begin >= 2 && text.substr(lines.begin - 2, 2) == "\n\n" && text.substr(end, 1) == "\n";
    if (gap) ++end;  // of two empty lines one is enough
    return {lines.begin, end, {}};
}

/// Whole lines put in behind the line that ends at `end`.
TextEdit insertion(std::string_view text, uint32_t end, std::string lines) {
    if (end < text.size()) return {end + 1, end + 1, std::move(lines) + "\n", 0};
    const std::string gap = text.empty() || text.back() == '\n' ? "" : "\n";
    return {end, end, gap + std::move(lines) + "\n", static_cast<uint32_t>(gap.size())};
}

/// Its place among the rules of the text.
std::ptrdiff_t placeOf(const Ast& ast, const RuleDecl& rule) {
    const auto same = [&](const RuleDecl& r) { return r.span.begin == rule.span.begin; };
    return std::find_if(ast.rules.begin(), ast.rules.end(), same) - ast.rules.begin();
}

std::string freeName(const Ast& ast, const std::string& name) {
    const auto taken = [&](const std::string& wanted) {
        return std::any_of(ast.rules.begin(), ast.rules.end(),
                           [&](const RuleDecl& r) { return r.name.text == wanted; });
    };
    for (char letter = 'b'; letter <= 'z'; ++letter)
        if (!taken(name + letter)) return name + letter;
    int number = 2;
    while (taken(fmt::format("{}_{}", name, number))) ++number;
    return fmt::format("{}_{}", name, number);
}

/// Sets, changes or takes out "WORD VALUE" before the arrow; `value` is empty to take it out.
Edit setPart(const Ast& ast, const RuleDecl& rule, std::string_view word, const SourceSpan* present,
             std::string_view value) {
    const std::string_view text = ast.source->text();
    if (present && !value.empty()) return tried(ast, {present->begin, present->end, std::string(value)});
    if (present) return tried(ast, removal(text, beginBefore(ast, present->begin), present->end));
    if (value.empty()) return TextEdit{};
    const uint32_t at =
        endBefore(ast, beginBefore(ast, rule.body.span.begin));  // behind the last token before the arrow
    return tried(ast, {at, at, fmt::format(" {} {}", word, value)});
}

Edit setPart(const Ast& ast, const RuleDecl& rule, std::string_view word, const std::optional<Expr>& present,
             std::string_view value) {
    if (value.empty()) return setPart(ast, rule, word, present ? &present->span : nullptr, value);
    const auto written = asExpression(value);
    if (!written.ok()) return written.error();
    return setPart(ast, rule, word, present ? &present->span : nullptr, *written);
}

/// A rule in lines of its own: behind `after`, or else behind the last of its symbol, or else of all.
Edit insertRule(const Ast& ast, const ListedRule& added, std::string lines, const RuleDecl* after) {
    const std::string_view text = ast.source->text();
    if (!after)
        for (const RuleDecl& rule : ast.rules)
            if (rule.symbol.text == added.symbol) after = &rule;
    if (!after && !ast.rules.empty()) after = &ast.rules.back();
    const uint32_t end = after ? linesOf(ast, *after).end : static_cast<uint32_t>(text.size());
    std::vector<ListedRule> rules = listed(ast);
    rules.insert(rules.begin() + (after ? placeOf(ast, *after) + 1 : 0), added);
    return withWays(ast, insertion(text, end, std::move(lines)), rules);
}

/// A start: behind the last one, or else before the first rule and its comments, or else at the end.
Edit insertStart(const Ast& ast, std::string_view declared) {
    const std::string_view text = ast.source->text();
    std::string lines = fmt::format("start {}", declared);
    if (!ast.starts.empty()) return tried(ast, insertion(text, lineEnd(text, ast.starts.back().span.end), lines));
    if (ast.rules.empty()) return tried(ast, insertion(text, static_cast<uint32_t>(text.size()), lines));
    const uint32_t at = linesWithComments(ast, ast.rules.front()).begin;
    return tried(ast, {at, at, lines + "\n", 0});
}

std::optional<Error> nameTaken(const Ast& ast, std::string_view name) {
    const bool taken = !name.empty() && std::any_of(ast.rules.begin(), ast.rules.end(),
                                                    [&](const RuleDecl& r) { return r.name.text == name; });
    return taken ? std::optional(refused(fmt::format("another rule is called '{}'", name))) : std::nullopt;
}

}  // namespace

Edit addRule(const Ast& ast, std::string_view symbol, std::string_view body, const RuleDecl* after) {
    const auto name = asName(symbol);
    if (!name.ok()) return name.error();
    return insertRule(ast, {nullptr, *name, {}}, fmt::format("rule {} -> {}", *name, body), after);
}

Edit addDeclaration(const Ast& ast, std::string_view written, const RuleDecl* after) {
    const auto from = [](std::string_view text) {
        return text.substr(std::min(text.find_first_not_of(" \t"), text.size()));
    };
    std::string_view text = from(written);
    const bool saysStart = text.substr(0, 6) == "start ";
    if (saysStart || text.substr(0, 5) == "rule ") text = from(text.substr(saysStart ? 6 : 5));
    if (saysStart || ast.starts.empty()) return insertStart(ast, text);
    // What is wrong with the text itself is said of it alone.
    syntax::Diagnostics problems;
    const syntax::Ast alone = syntax::parse(
        std::make_shared<const syntax::Source>("rule", fmt::format("grammar {}\nrule {}\n", ast.version, text)),
        *ast.operations, problems);
    if (problems.hasErrors()) return refused(problems.all()[0].message);
    if (alone.rules.size() != 1) return refused(fmt::format("'{}' is no rule: write 'Name -> body'", text));
    const RuleDecl& rule = alone.rules[0];
    if (const auto taken = nameTaken(ast, rule.name.text)) return *taken;
    return insertRule(ast, {nullptr, rule.symbol.text, rule.name.text}, fmt::format("rule {}", text), after);
}

Edit removeRule(const Ast& ast, const RuleDecl& rule) {
    std::vector<ListedRule> rules = listed(ast);
    rules.erase(rules.begin() + placeOf(ast, rule));
    return withWays(ast, removalOf(ast.source->text(), linesOf(ast, rule)), rules);
}

Edit duplicateRule(const Ast& ast, const RuleDecl& rule) {
    const Lines lines = linesOf(ast, rule);
    const std::string_view text = ast.source->text();
    std::string copy(text.substr(lines.begin, lines.end - lines.begin));
    if (!rule.name.empty())
        copy.replace(rule.name.span.begin - lines.begin, rule.name.text.size(), freeName(ast, rule.name.text));
    std::vector<ListedRule> rules = listed(ast);
    rules.insert(rules.begin() + placeOf(ast, rule) + 1,
                 {nullptr, rule.symbol.text, rule.name.empty() ? "" : freeName(ast, rule.name.text)});
    return withWays(ast, insertion(text, lines.end, std::move(copy)), rules);
}

Edit moveRule(const Ast& ast, const RuleDecl& rule, const RuleDecl* before) {
    if (before == &rule || (before ? before == &rule + 1 : &ast.rules.back() == &rule))
        return TextEdit{};  // it stands there
    const std::string_view text = ast.source->text();
    const Lines lines = linesWithComments(ast, rule);
    std::string moved(text.substr(lines.begin, lines.end - lines.begin));
    TextEdit put;
    if (before) {
        const uint32_t at = linesWithComments(ast, *before).begin;
        put = {at, at, std::move(moved) + "\n", 0};
    } else {
        put = insertion(text, linesOf(ast, ast.rules.back()).end, std::move(moved));
    }
    put.node = *put.node + rule.span.begin - lines.begin;  // behind its comments
    std::vector<ListedRule> rules = listed(ast);
    const ListedRule taken = rules[static_cast<size_t>(placeOf(ast, rule))];
    rules.insert(rules.begin() + (before ? placeOf(ast, *before) : static_cast<std::ptrdiff_t>(rules.size())),
                 {taken.rule, taken.symbol, taken.name});
    rules.erase(rules.begin() + placeOf(ast, rule) + (before && before < &rule ? 1 : 0));
    return withWays(ast, merged(text, {removalOf(text, lines), put}), rules);
}

Edit setName(const Ast& ast, const RuleDecl& rule, std::string_view name) {
    std::vector<ListedRule> rules = listed(ast);
    std::string& called = rules[static_cast<size_t>(placeOf(ast, rule))].name;
    if (name.empty()) {
        if (rule.name.empty()) return TextEdit{};
        called.clear();
        return withWays(ast, {rule.name.span.begin, rule.symbol.span.begin, {}}, rules);
    }
    const auto written = asName(name);
    if (!written.ok()) return written.error();
    const auto same = std::find_if(ast.rules.begin(), ast.rules.end(),
                                   [&](const RuleDecl& r) { return &r != &rule && r.name.text == *written; });
    if (same != ast.rules.end()) return refused(fmt::format("another rule is called '{}'", *written));
    called = *written;
    if (!rule.name.empty()) return withWays(ast, {rule.name.span.begin, rule.name.span.end, *written}, rules);
    return withWays(ast, {rule.symbol.span.begin, rule.symbol.span.begin, *written + ": "}, rules);
}

Edit setSymbol(const Ast& ast, const RuleDecl& rule, std::string_view symbol) {
    const auto written = asName(symbol);
    if (!written.ok()) return written.error();
    std::vector<ListedRule> rules = listed(ast);
    rules[static_cast<size_t>(placeOf(ast, rule))].symbol = *written;
    return withWays(ast, {rule.symbol.span.begin, rule.symbol.span.end, *written}, rules);
}

Edit setGuard(const Ast& ast, const RuleDecl& rule, std::string_view condition) {
    return setPart(ast, rule, "when", rule.when, condition);
}
Edit setWeight(const Ast& ast, const RuleDecl& rule, std::string_view weight) {
    return setPart(ast, rule, "weight", rule.weight, weight);
}
Edit setRepeat(const Ast& ast, const RuleDecl& rule, std::string_view count) {
    return setPart(ast, rule, "repeat", rule.repeat, count);
}

Edit setBeside(const Ast& ast, const RuleDecl& rule, std::string_view symbol) {
    if (!symbol.empty()) {
        const auto written = asName(symbol);
        if (!written.ok()) return written.error();
    }
    return setPart(ast, rule, "beside", rule.beside.empty() ? nullptr : &rule.beside.span, symbol);
}

}  // namespace sgm::document::edits
