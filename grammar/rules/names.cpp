// What the declarations of a grammar are called, taken before anything is checked.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "grammar/rules/checker.h"
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

}  // namespace

bool isNonTerminal(std::string_view name) { return !name.empty() && std::isupper(static_cast<unsigned char>(name[0])); }

bool isTaken(std::string_view name) { return std::find(taken.begin(), taken.end(), name) != taken.end(); }

bool Checker::twice(std::map<std::string, SourceSpan>& seen, const syntax::Name& name, std::string_view kind) {
    const auto [entry, fresh] = seen.emplace(name.text, name.span);
    if (fresh || name.empty()) return false;
    const SourceSpan first = entry->second;
    diagnostics_.error(name.span,
                       fmt::format("there is already a {} '{}' in {}, line {}", kind, name.text, first.source->name(),
                                   first.source->place(first.begin).line),
                       "give one of them another name");
    return true;
}

SymbolId Checker::nonTerminal(const syntax::Name& name) {
    const auto [entry, fresh] = symbols_.emplace(name.text, static_cast<SymbolId>(grammar_.symbols.size()));
    if (fresh) {
        Symbol symbol;
        symbol.name = name.text;
        symbol.span = name.span;
        grammar_.symbols.push_back(std::move(symbol));
    }
    return entry->second;
}

void Checker::declareLet(const syntax::LetDecl& decl) {
    if (decl.name.empty() || twice(seenLets_, decl.name, "value")) return;
    if (isTaken(decl.name.text) || axisNumber(decl.name.text) >= 0)
        diagnostics_.error(decl.name.span,
                           fmt::format("'{}' is a word of the language and can't name a value", decl.name.text));
    if (params_.contains(decl.name.text))
        diagnostics_.error(decl.name.span, fmt::format("there is already a parameter '{}'", decl.name.text),
                           "give one of them another name");
    lets_[decl.name.text].decl = &decl;
}

void Checker::declareParameter(const syntax::ParamDecl& decl) {
    if (decl.name.empty() || twice(seenParams_, decl.name, "parameter")) return;
    if (isTaken(decl.name.text))
        diagnostics_.error(decl.name.span,
                           fmt::format("'{}' is a word of the language and can't name a parameter", decl.name.text));
    if (isJoining(decl.name.text))
        diagnostics_.warning(decl.name.span,
                             fmt::format("'{0}' is an operation as well: 'size {0} …' is hard to read", decl.name.text),
                             "give the parameter another name");
    params_.emplace(decl.name.text, static_cast<uint32_t>(grammar_.params.size()));
    Param param;
    param.name = decl.name.text;
    param.span = decl.span;
    param.valueSpan = decl.value.span;
    grammar_.params.push_back(std::move(param));
}

void Checker::declareTerminals(const syntax::TerminalDecl& decl) {
    for (const syntax::Name& name : decl.names) {
        const std::string_view kind = decl.isMaterial ? "material" : "terminal";
        if (name.empty() || twice(seenTerminals_, name, kind)) continue;
        if (isNonTerminal(name.text))
            diagnostics_.error(
                name.span,
                fmt::format("a {}'s name begins with a small letter: '{}' would be a shape that rules rewrite", kind,
                            name.text));
        else if (isTaken(name.text) || field::findPrimitive(name.text))
            diagnostics_.error(name.span,
                               fmt::format("'{}' is {} and can't name a {}", name.text,
                                           isTaken(name.text) ? "a word of the language" : "a primitive", kind));
        symbols_.emplace(name.text, static_cast<SymbolId>(grammar_.symbols.size()));
        terminalDecls_.emplace(name.text, &decl);
        Symbol symbol;
        symbol.name = name.text;
        symbol.terminal = true;
        symbol.isMaterial = decl.isMaterial;
        symbol.span = name.span;
        grammar_.symbols.push_back(std::move(symbol));
    }
    for (const auto& joint : decl.joints) jointNames_.insert(joint.name.text);
}

void Checker::declareRule(const syntax::RuleDecl& decl) {
    if (!decl.name.empty()) twice(seenRules_, decl.name, "rule");
    if (isNonTerminal(decl.symbol.text)) ruled_.insert(nonTerminal(decl.symbol));
    collect(decl.body);
    if (decl.finally_) collect(*decl.finally_);
}

void Checker::collect(const syntax::Attribute& attribute) {
    if (attribute.operation->namesValue && !attribute.args.empty()) withNames_.insert(attribute.args[0].text);
    collect(attribute.cases);
}

void Checker::collect(const std::vector<syntax::Case>& cases) {
    for (const syntax::Case& c : cases) {
        collect(c.cases);
        if (c.body) collect(*c.body);
    }
}

/// Non-terminals need no declaration: those that stand in a body exist, and so do the values set by `with`.
void Checker::collect(const syntax::Body& body) {
    for (const auto& chain : body.siblings)
        for (const syntax::Element& e : chain) {
            for (const auto& attribute : e.before) collect(attribute);
            for (const auto& attribute : e.after) collect(attribute);
            if (isNonTerminal(e.live.text)) placed_.insert(nonTerminal(e.live));
            if (e.solid && e.solid->kind == syntax::Expr::Kind::Name && isNonTerminal(e.solid->text))
                placed_.insert(nonTerminal({e.solid->text, e.solid->span}));
            if (e.body) collect(*e.body);
            collect(e.cases);
        }
}

void Checker::suppressErrors(const syntax::Diagnostics& unread, bool missingFile) {
    anythingExcused_ = missingFile;
    const auto inWord = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
    for (const syntax::Diagnostic& d : unread.all()) {
        if (d.severity != syntax::Severity::Error || !d.span.source) continue;
        const std::string_view line = d.span.source->line(d.span.source->place(d.span.begin).line);
        // A `use` that couldn't be read brings nothing, and nobody knows what it would have.
        anythingExcused_ = anythingExcused_ || line.starts_with("use");
        for (auto begin = line.begin(); begin != line.end();) {
            const auto end = std::find_if_not(begin, line.end(), inWord);
            if (end != begin) excused_.emplace(begin, end);
            begin = end == line.end() ? end : end + 1;
        }
    }
}

void Checker::declare(const syntax::Ast& ast) {
    for (const auto& decl : ast.params) declareParameter(decl);
    for (const auto& decl : ast.lets) declareLet(decl);
    for (const auto& decl : ast.terminals) declareTerminals(decl);
    for (const auto& decl : ast.maps) declareMap(decl);
    for (const auto& decl : ast.roads) declareRoads(decl);
    for (const auto& decl : ast.lsystems) declareLsystem(decl);
    for (const auto& decl : ast.starts) {
        twice(seenStarts_, decl.symbol, "start");
        if (isNonTerminal(decl.symbol.text)) placed_.insert(nonTerminal(decl.symbol));
        collect(decl.body);
    }
    for (const auto& decl : ast.rules) declareRule(decl);
    for (const field::Primitive& row : field::primitives())
        for (const field::PrimitiveJoint& joint : row.joints) jointNames_.insert(std::string(joint.name));
}

std::vector<std::string> Checker::symbolNames(bool withRulesOnly) const {
    std::vector<std::string> names;
    for (const auto& [name, id] : symbols_)
        if (!withRulesOnly || grammar_.symbols[id].terminal || ruled_.contains(id)) names.push_back(name);
    return names;
}

std::string Checker::nearest(std::string_view word, const std::vector<std::string>& candidates) const {
    const std::string name = syntax::didYouMean(word, candidates);
    return name.empty() ? std::string() : fmt::format("did you mean '{}'?", name);
}

std::optional<uint32_t> Checker::outlinesOf(const syntax::Expr& name) {
    const size_t place = placeOfFile(outlineFiles_, grammar_.outlines, load_.outlines, name);
    return grammar_.outlines[place] ? std::optional(static_cast<uint32_t>(place)) : std::nullopt;
}

std::optional<uint32_t> Checker::imageOf(const syntax::Expr& name) {
    const size_t place = placeOfFile(imageFiles_, grammar_.images, load_.image, name);
    return grammar_.images[place] ? std::optional(static_cast<uint32_t>(place)) : std::nullopt;
}

}  // namespace sgm::rules
