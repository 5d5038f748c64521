#include "grammar/rules/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <set>

#include "grammar/rules/declarations.h"
#include "grammar/rules/evaluate.h"
#include "grammar/rules/expressions.h"
#include "grammar/rules/outline_values.h"
#include "grammar/rules/params.h"
#include "grammar/rules/static_analysis.h"
#include "grammar/rules/upgrade.h"
#include "grammar/rules/uses.h"
#include "grammar/syntax/parser.h"

namespace sgm::rules {

namespace {

/// The first line of the declaration around a span: the last one that doesn't begin with a blank.
uint32_t declarationOf(SourceSpan span) {
    uint32_t line = span.source->place(span.begin).line;
    while (line > 1 &&
           (span.source->line(line).empty() || std::isspace(static_cast<unsigned char>(span.source->line(line)[0]))))
        --line;
    return line;
}

/// What was found without those errors that stand in a declaration that couldn't be read: a slip is reported once.
syntax::Diagnostics withoutEchoes(const syntax::Diagnostics& found, const syntax::Diagnostics& unread) {
    std::set<std::pair<const syntax::Source*, uint32_t>> slips;
    for (const syntax::Diagnostic& d : unread.all())
        if (d.span.source) slips.emplace(d.span.source, declarationOf(d.span));
    const auto echoes = [&](const syntax::Diagnostic& d) {
        return !slips.empty() && d.span.source && slips.contains({d.span.source, declarationOf(d.span)});
    };
    syntax::Diagnostics kept;
    for (const syntax::Diagnostic& d : found.all()) {
        if (echoes(d)) continue;
        d.severity == syntax::Severity::Error ? kept.error(d.span, d.message, d.hint)
                                              : kept.warning(d.span, d.message, d.hint);
    }
    return kept;
}

/// In the order of the text: the main file last, as its uses stand before it.
void sortInto(syntax::Diagnostics& out, const syntax::Diagnostics& found,
              const std::vector<syntax::SourcePtr>& sources) {
    std::map<const syntax::Source*, size_t> places;
    for (size_t i = 1; i < sources.size(); ++i) places.emplace(sources[i].get(), i);
    const auto rank = [&](const syntax::Diagnostic& d) {
        const auto place = places.find(d.span.source);
        return std::pair(place == places.end() ? sources.size() : place->second, d.span.begin);
    };
    std::vector<syntax::Diagnostic> list = found.all();
    std::stable_sort(list.begin(), list.end(), [&](const auto& a, const auto& b) { return rank(a) < rank(b); });
    for (syntax::Diagnostic& d : list) {
        const bool error = d.severity == syntax::Severity::Error;
        (error ? out.error(d.span, std::move(d.message), std::move(d.hint))
               : out.warning(d.span, std::move(d.message), std::move(d.hint)));
    }
}

/// One warning where `grammar 2` reads a text of version 1 in another way, at the first such place.
void warnOfVersion(const syntax::Ast& ast, syntax::Diagnostics& diagnostics) {
    const auto isTold = [&](const syntax::Diagnostic& note) {
        return std::any_of(diagnostics.all().begin(), diagnostics.all().end(),
                           [&](const syntax::Diagnostic& d) { return d.span.begin == note.span.begin; });
    };
    std::vector<syntax::Diagnostic> notes = upgraded(ast).notes;
    std::erase_if(notes, isTold);
    if (notes.empty()) return;
    const size_t more = notes.size() - 1;
    diagnostics.warning(
        notes[0].span,
        more ? fmt::format("'grammar 2' reads this in another way, and {} more place{}", more, more == 1 ? "" : "s")
             : "'grammar 2' reads this in another way",
        "'sgm fmt --upgrade' rewrites the file so that it means the same, and shows each such place");
}

/// A warning for names of live shapes that may be misspelt: no rule matches them and nothing refers to them.
void warnOfMisspelt(CheckContext& ctx) {
    for (MaybeMisspelt& name : ctx.names.misspelt)
        if (!ctx.names.referenced.contains(name.symbol))
            ctx.diagnostics.warning(
                name.span,
                fmt::format("no rule matches '{}', so nothing will grow here", ctx.grammar.symbols[name.symbol].name),
                std::move(name.hint));
}

/// Everything behind the names, and what follows from it all.
void fill(Grammar& grammar, const Files& files, const Loader& load, const syntax::Diagnostics& unread,
          syntax::Diagnostics& diagnostics) {
    CheckContext ctx(grammar, diagnostics, load);
    ctx.suppressed.read(unread, files.missing);
    const auto each = [&](void (*pass)(CheckContext&, const syntax::Ast&)) {
        for (const syntax::Ast& part : files.asts) pass(ctx, part);
    };
    each(declareNames);
    each(checkParameters);
    each(checkLets);
    each(checkMaterials);
    each(checkLsystems);
    each(checkMaps);
    each(checkRoads);
    each(checkTerminals);
    each(checkProductions);
    // The file's own starts come before those of files that it uses.
    std::stable_partition(grammar.starts.begin(), grammar.starts.end(),
                          [&](const Start& start) { return start.span.source == grammar.sources[0].get(); });
    each(checkDeclarations);
    warnOfMisspelt(ctx);
    if (diagnostics.hasErrors() || unread.hasErrors()) return;
    if (grammar.starts.empty()) {
        diagnostics.error({grammar.sources[0].get(), 0, 0}, "there is nothing to begin with",
                          "write 'start Name -> cube'");
        return;
    }
    warnOfUnused(ctx, files.asts.back());
    findUnreachable(grammar, diagnostics);
    findShadowed(grammar, diagnostics);
    findUnusedWeights(grammar, diagnostics);
    findReplacingSteps(grammar, diagnostics);
    findSharesOfNothing(grammar, diagnostics);
    findUnsized(grammar, diagnostics);
    findUnusedHeights(grammar, diagnostics);
    findRoofsOverTheScope(grammar, diagnostics);
    findWaitingCycles(grammar, diagnostics);
    findEndless(grammar, diagnostics);
    findValuesOfOwnOutline(grammar, diagnostics);
    warnOfUnreadValues(ctx);
    warnOfVersion(files.asts.back(), diagnostics);
}

}  // namespace

std::shared_ptr<const Grammar> check(const syntax::Ast& ast, const Loader& load, syntax::Diagnostics& diagnostics) {
    const Files files = withUses(ast, load, diagnostics);
    auto grammar = std::make_shared<Grammar>();
    grammar->materials.emplace_back();
    grammar->sources.push_back(ast.source);
    grammar->versions.push_back(ast.version);
    for (size_t i = 0; i + 1 < files.asts.size(); ++i) {
        grammar->sources.push_back(files.asts[i].source);
        grammar->versions.push_back(files.asts[i].version);
    }

    syntax::Diagnostics found;
    fill(*grammar, files, load, diagnostics, found);
    sortInto(diagnostics, withoutEchoes(found, diagnostics), grammar->sources);
    return diagnostics.hasErrors() ? nullptr : grammar;
}

std::shared_ptr<const Grammar> load(syntax::SourcePtr source, const syntax::OperationTable& operations,
                                    const Loader& load, syntax::Diagnostics& diagnostics) {
    return check(syntax::parse(std::move(source), operations, diagnostics), load, diagnostics);
}

Result<Value> parseValue(const Param& param, const std::string& text) {
    if (text.find_first_not_of(" \t") == std::string::npos)
        return Error{Error::Kind::Input, fmt::format("'{}' is set to nothing", param.name)};
    const auto source = std::make_shared<const syntax::Source>("--set " + param.name, text);
    syntax::Diagnostics diagnostics;
    const syntax::Expr expr = syntax::parseExpression(source, diagnostics);
    Grammar empty;
    std::optional<Value> value;
    if (!diagnostics.hasErrors()) {
        CheckContext ctx(empty, diagnostics);
        value = plainValue(ctx, expr, !param.choices.empty());
    }
    if (value && diagnostics.all().empty()) return conform(param, std::move(*value));
    if (param.value.kind == Value::Kind::Bool)
        return Error{Error::Kind::Input, fmt::format("'{}' is true or false, not '{}'", param.name, text)};
    if (param.value.kind == Value::Kind::Color)
        return Error{Error::Kind::Input, fmt::format("'{}' is a colour such as #c8b090, not '{}'", param.name, text)};
    std::string why = "it is no value";
    if (!diagnostics.all().empty()) {
        const syntax::Diagnostic& first = diagnostics.all()[0];
        why = first.hint.empty() ? first.message : first.message + "; " + first.hint;
    }
    return Error{Error::Kind::Input, fmt::format("'{}' can't be '{}': {}", param.name, text, why)};
}

}  // namespace sgm::rules
