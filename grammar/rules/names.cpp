// What the declarations of a grammar are called, taken before anything is checked.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "grammar/rules/declarations.h"
#include "grammar/rules/lookup.h"
#include "grammar/rules/words.h"

namespace sgm::rules {
namespace {

constexpr std::array<std::string_view, 19> taken{"axes", "sides", "last",  "any",    "free", "centre", "each",
                                                 "here", "nil",   "scope", "i",      "true", "false",  "morph",
                                                 "x",    "y",     "z",     "billow", "fbm"};

/// Operations of one short word that join or look up: a parameter of that name reads as one of them.
bool isJoining(std::string_view name) {
    constexpr std::array<std::string_view, 6> words{"at", "to", "on", "by", "with", "tag"};
    return std::find(words.begin(), words.end(), name) != words.end();
}

void declareLet(CheckContext& ctx, const syntax::LetDecl& decl) {
    if (decl.name.empty() || isDeclaredTwice(ctx, ctx.seen.lets, decl.name, "value")) return;
    if (isTaken(decl.name.text) || axisNumber(decl.name.text) >= 0)
        ctx.diagnostics.error(decl.name.span,
                              fmt::format("'{}' is a word of the language and can't name a value", decl.name.text));
    if (ctx.names.params.contains(decl.name.text))
        ctx.diagnostics.error(decl.name.span, fmt::format("there is already a parameter '{}'", decl.name.text),
                              "give one of them another name");
    ctx.names.lets[decl.name.text].decl = &decl;
}

void declareParameter(CheckContext& ctx, const syntax::ParamDecl& decl) {
    if (decl.name.empty() || isDeclaredTwice(ctx, ctx.seen.params, decl.name, "parameter")) return;
    if (isTaken(decl.name.text))
        ctx.diagnostics.error(decl.name.span,
                              fmt::format("'{}' is a word of the language and can't name a parameter", decl.name.text));
    if (isJoining(decl.name.text))
        ctx.diagnostics.warning(
            decl.name.span, fmt::format("'{0}' is an operation as well: 'size {0} …' is hard to read", decl.name.text),
            "give the parameter another name");
    ctx.names.params.emplace(decl.name.text, static_cast<uint32_t>(ctx.grammar.params.size()));
    Param param;
    param.name = decl.name.text;
    param.span = decl.span;
    param.valueSpan = decl.value.span;
    ctx.grammar.params.push_back(std::move(param));
}

void declareTerminals(CheckContext& ctx, const syntax::TerminalDecl& decl) {
    for (const syntax::Name& name : decl.names) {
        const std::string_view kind = decl.isMaterial ? "material" : "terminal";
        if (name.empty() || isDeclaredTwice(ctx, ctx.seen.terminals, name, kind)) continue;
        if (isNonTerminal(name.text))
            ctx.diagnostics.error(
                name.span,
                fmt::format("a {}'s name begins with a small letter: '{}' would be a shape that rules rewrite", kind,
                            name.text));
        else if (isTaken(name.text) || field::findPrimitive(name.text))
            ctx.diagnostics.error(name.span,
                                  fmt::format("'{}' is {} and can't name a {}", name.text,
                                              isTaken(name.text) ? "a word of the language" : "a primitive", kind));
        ctx.names.symbols.emplace(name.text, static_cast<SymbolId>(ctx.grammar.symbols.size()));
        ctx.names.terminals.emplace(name.text, &decl);
        Symbol symbol;
        symbol.name = name.text;
        symbol.terminal = true;
        symbol.isMaterial = decl.isMaterial;
        symbol.span = name.span;
        ctx.grammar.symbols.push_back(std::move(symbol));
    }
    for (const auto& joint : decl.joints) ctx.names.joints.insert(joint.name.text);
}

void collectNames(CheckContext& ctx, const syntax::Body& body);

void collectNames(CheckContext& ctx, const std::vector<syntax::Case>& cases) {
    for (const syntax::Case& c : cases) {
        collectNames(ctx, c.cases);
        if (c.body) collectNames(ctx, *c.body);
    }
}

void noteInherited(CheckContext& ctx, const syntax::Expr& name) {
    InheritedName& known = ctx.names.inherited[name.text];
    if (!known.span.source && name.span.source == ctx.grammar.sources[0].get()) known.span = name.span;
}

void collectNames(CheckContext& ctx, const syntax::Attribute& attribute) {
    if (attribute.operation->traits.namesValue && !attribute.args.empty()) noteInherited(ctx, attribute.args[0]);
    collectNames(ctx, attribute.cases);
}

/// Non-terminals need no declaration: those that stand in a body exist, and so do the values set by `with`.
void collectNames(CheckContext& ctx, const syntax::Body& body) {
    for (const auto& chain : body.siblings)
        for (const syntax::Element& e : chain) {
            for (const auto& attribute : e.before) collectNames(ctx, attribute);
            for (const auto& attribute : e.after) collectNames(ctx, attribute);
            if (isNonTerminal(e.live.text)) declareSymbol(ctx, e.live);
            if (e.solid && e.solid->kind == syntax::Expr::Kind::Name && isNonTerminal(e.solid->text))
                declareSymbol(ctx, {e.solid->text, e.solid->span});
            if (e.body) collectNames(ctx, *e.body);
            collectNames(ctx, e.cases);
        }
}

/// Rules of two files for one symbol: drawn by seed or hidden by a guard, although neither file knows of the other's.
void checkOneFile(CheckContext& ctx, const syntax::Name& symbol) {
    const auto [entry, fresh] = ctx.seen.ruledSymbols.emplace(symbol.text, symbol.span);
    const SourceSpan first = entry->second;
    if (fresh || first.source == symbol.span.source) return;
    entry->second = symbol.span;
    const int line = first.source->place(first.begin).line;
    std::string hint = fmt::format("give this shape another name, as 'My{}'", symbol.text);
    if (versionOf(ctx.grammar, symbol.span) >= 2)
        ctx.diagnostics.error(symbol.span,
                              fmt::format("there is already a rule for '{}' in {}, line {}: the rules of two files for "
                                          "one shape would be alternatives",
                                          symbol.text, first.source->name(), line),
                              std::move(hint));
    else
        ctx.diagnostics.warning(symbol.span,
                                fmt::format("there is already a rule for '{}' in {}, line {}, of which this one is "
                                            "another alternative: an error in 'grammar 2'",
                                            symbol.text, first.source->name(), line),
                                std::move(hint));
}

void declareRule(CheckContext& ctx, const syntax::RuleDecl& decl) {
    if (!decl.name.empty()) isDeclaredTwice(ctx, ctx.seen.rules, decl.name, "rule");
    if (isNonTerminal(decl.symbol.text)) {
        checkOneFile(ctx, decl.symbol);
        ctx.names.ruled.insert(declareSymbol(ctx, decl.symbol));
    }
    collectNames(ctx, decl.body);
    if (decl.finally_) collectNames(ctx, *decl.finally_);
}

}  // namespace

bool isNonTerminal(std::string_view name) { return !name.empty() && std::isupper(static_cast<unsigned char>(name[0])); }

bool isTaken(std::string_view name) { return std::find(taken.begin(), taken.end(), name) != taken.end(); }

bool isDeclaredTwice(CheckContext& ctx, std::map<std::string, SourceSpan>& seen, const syntax::Name& name,
                     std::string_view kind) {
    const auto [entry, fresh] = seen.emplace(name.text, name.span);
    if (fresh || name.empty()) return false;
    const SourceSpan first = entry->second;
    ctx.diagnostics.error(name.span,
                          fmt::format("there is already a {} '{}' in {}, line {}", kind, name.text,
                                      first.source->name(), first.source->place(first.begin).line),
                          "give one of them another name");
    return true;
}

SymbolId declareSymbol(CheckContext& ctx, const syntax::Name& name) {
    const auto [entry, fresh] = ctx.names.symbols.emplace(name.text, static_cast<SymbolId>(ctx.grammar.symbols.size()));
    if (fresh) {
        Symbol symbol;
        symbol.name = name.text;
        symbol.span = name.span;
        ctx.grammar.symbols.push_back(std::move(symbol));
    }
    return entry->second;
}

void declareNames(CheckContext& ctx, const syntax::Ast& ast) {
    for (const auto& decl : ast.params) declareParameter(ctx, decl);
    for (const auto& decl : ast.lets) declareLet(ctx, decl);
    for (const auto& decl : ast.terminals) declareTerminals(ctx, decl);
    for (const auto& decl : ast.maps) declareMap(ctx, decl);
    for (const auto& decl : ast.roads) declareRoads(ctx, decl);
    for (const auto& decl : ast.lsystems) declareLsystem(ctx, decl);
    for (const auto& decl : ast.starts) {
        isDeclaredTwice(ctx, ctx.seen.starts, decl.symbol, "start");
        if (isNonTerminal(decl.symbol.text)) declareSymbol(ctx, decl.symbol);
        collectNames(ctx, decl.body);
    }
    for (const auto& decl : ast.rules) declareRule(ctx, decl);
    for (const field::Primitive& row : field::primitives())
        for (const field::PrimitiveJoint& joint : row.joints) ctx.names.joints.insert(std::string(joint.name));
}

std::optional<SymbolId> findReferenced(CheckContext& ctx, const std::string& name) {
    const auto symbol = ctx.names.symbols.find(name);
    if (symbol == ctx.names.symbols.end()) return std::nullopt;
    ctx.names.referenced.insert(symbol->second);
    return symbol->second;
}

std::vector<std::string> symbolNames(CheckContext& ctx, bool withRulesOnly) {
    std::vector<std::string> names;
    for (const auto& [name, id] : ctx.names.symbols)
        if (!withRulesOnly || ctx.grammar.symbols[id].terminal || ctx.names.ruled.contains(id)) names.push_back(name);
    return names;
}

std::string nearestHint(std::string_view word, const std::vector<std::string>& candidates) {
    const std::string name = syntax::didYouMean(word, candidates);
    return name.empty() ? std::string() : fmt::format("did you mean '{}'?", name);
}

}  // namespace sgm::rules
