#include "grammar/language/edits.h"

#include <fmt/format.h>

#include <algorithm>

#include "grammar/operations/operations.h"
#include "grammar/rules/words.h"
#include "grammar/syntax/declarations.h"
#include "grammar/syntax/expressions.h"
#include "grammar/syntax/lexer.h"
#include "modeler/field/primitives.h"

namespace sgm::language {
namespace {

Error refused(std::string why) { return {Error::Kind::Input, std::move(why)}; }

/// Why a thing of this kind can't have a name, or "".
std::string whyNot(const Occurrence& what, const std::string& name) {
    if (!syntax::isWord(name))
        return fmt::format("'{}' is no name: letters, digits and '_', beginning with no digit", name);
    if (syntax::isReserved(name) || rules::isTaken(name) || syntax::findDeclaration(name))
        return fmt::format("'{}' is a word of the language", name);
    if (what.kind != NameKind::Symbol) return {};
    if (rules::isNonTerminal(name) != rules::isNonTerminal(what.name))
        return rules::isNonTerminal(what.name) ? "a shape that rules rewrite begins with a capital"
                                               : "a terminal begins with a small letter";
    if (operations::table().find(name)) return fmt::format("'{}' is an operation", name);
    if (field::findPrimitive(name)) return fmt::format("'{}' is a solid", name);
    return {};
}

/// What stands in quotes of a fix: 'write 'x'' gives x.
std::vector<std::string> quotedParts(std::string_view hint) {
    std::vector<std::string> parts;
    for (size_t at = 0; at < hint.size();) {
        const size_t open = hint.find('\'', at);
        if (open == std::string_view::npos) break;
        const size_t close = hint.find('\'', open + 1);
        if (close == std::string_view::npos) break;
        parts.emplace_back(hint.substr(open + 1, close - open - 1));
        at = close + 1;
    }
    return parts;
}

}  // namespace

std::vector<Occurrence> referencesAt(const Analysis& analysis, uint32_t offset, bool withDefinitions) {
    const Occurrence* at = occurrenceAt(analysis.file().names, offset);
    std::vector<Occurrence> found;
    if (!at) return found;
    for (const File& file : analysis.files)
        for (const Occurrence& o : file.names)
            if (same(o, *at) && (withDefinitions || !o.defines)) found.push_back(o);
    return found;
}

Result<std::vector<Edit>> rename(const Analysis& analysis, uint32_t offset, const std::string& name) {
    const Occurrence* at = occurrenceAt(analysis.file().names, offset);
    if (!at) return refused("no name stands here that could be changed");
    if (std::string why = whyNot(*at, name); !why.empty()) return refused(std::move(why));
    std::vector<Edit> edits;
    for (const File& file : analysis.files) {
        const bool library = file.source->name().find("/std/") != std::string::npos;
        for (const Occurrence& o : file.names) {
            Occurrence wanted = *at;
            wanted.name = name;
            if (name != at->name && same(o, wanted)) return refused(fmt::format("there is already a '{}'", name));
            if (!same(o, *at)) continue;
            if (library && o.defines) return refused(fmt::format("'{}' is declared in the standard library", at->name));
            edits.push_back({o.span, name});
        }
    }
    return edits;
}

std::vector<Fix> fixesOf(const syntax::Source& source, const syntax::Diagnostic& problem,
                         const std::vector<Edit>& extra,
                         const std::function<size_t(const std::string&, std::string_view, uint32_t)>& check) {
    std::vector<Fix> fixes;
    const syntax::SourceSpan span = problem.span;
    // "as in '…'" is an example, and nothing that could stand there.
    if (span.source != &source || problem.hint.empty() || problem.hint.starts_with("as in ")) return fixes;
    const std::string text(source.text());
    const size_t before = check(text, problem.message, span.begin);
    std::vector<Edit> candidates = extra;
    const std::string_view line = source.line(source.place(span.begin).line);
    const auto lineBegin = static_cast<uint32_t>(line.data() - source.text().data());
    const auto lineEnd = lineBegin + static_cast<uint32_t>(line.size());
    for (const std::string& part : quotedParts(problem.hint)) {
        if (part.find("…") != std::string::npos) continue;
        if (problem.hint.find("leave '" + part + "' out") != std::string::npos || problem.hint.find("leave ") == 0) {
            candidates.push_back({span, ""});
            continue;
        }
        candidates.push_back({span, part});
        candidates.push_back({{&source, lineBegin, lineEnd}, part});
        candidates.push_back({{&source, span.begin, span.begin}, part + ' '});
        candidates.push_back({{&source, span.end, span.end}, ' ' + part});
        if (span.begin == 0 || source.place(span.begin).line == 1) candidates.push_back({{&source, 0, 0}, part + '\n'});
    }
    if (problem.hint.starts_with("leave the quotes out") && span.end - span.begin >= 2)
        candidates.push_back({span, std::string(span.text().substr(1, span.text().size() - 2))});
    size_t least = before;
    for (Edit& edit : candidates) {
        std::string changed = text;
        changed.replace(edit.span.begin, edit.span.end - edit.span.begin, edit.text);
        const size_t after =
            check(changed, problem.message, edit.span.begin <= span.begin ? span.begin : edit.span.begin);
        if (after >= least) continue;
        least = after;
        fixes.assign(1, {problem.hint, std::move(edit)});
    }
    return fixes;
}

std::vector<Entry> outlineOf(const Analysis& analysis) {
    std::vector<Entry> entries;
    for (const Occurrence& o : analysis.file().names) {
        if (!o.defines || o.kind == NameKind::Value || o.kind == NameKind::Local || o.kind == NameKind::Joint) continue;
        const std::string_view text = o.declaration.text();
        const std::string word(text.substr(0, text.find_first_of(" \t")));
        const bool sameRule = !entries.empty() && entries.back().span.begin == o.declaration.begin && word == "rule";
        if (sameRule) {  // rule R0: Cell
            entries.back().detail = "rule of " + o.name;
            continue;
        }
        entries.push_back({o.kind, o.name, word, o.declaration, o.span});
    }
    return entries;
}

std::vector<Fold> foldsOf(const Analysis& analysis) {
    const syntax::Source& source = analysis.source();
    std::vector<Fold> folds;
    const auto add = [&](uint32_t begin, uint32_t end, bool comment) {
        const uint32_t first = source.place(begin).line, last = source.place(end).line;
        if (last > first) folds.push_back({first - 1, last - 1, comment});
    };
    std::vector<uint32_t> open;
    uint32_t commentBegin = 0, commentEnd = 0, commentLine = 0;
    uint32_t declaration = 0, declarationEnd = 0;
    const auto endComment = [&] {
        if (commentLine) add(commentBegin, commentEnd, true);
        commentLine = 0;
    };
    for (const syntax::Token& token : syntax::lex(source)) {
        if (token.kind == syntax::Token::Kind::Blank) continue;
        if (token.kind == syntax::Token::Kind::Comment) {
            const uint32_t line = source.place(token.begin).line;
            if (!token.columnOne || line != commentLine + 1) endComment();
            if (!commentLine) commentBegin = token.begin;
            commentEnd = token.end;
            commentLine = token.columnOne ? line : 0;
            continue;
        }
        endComment();
        if (token.columnOne) {
            add(declaration, declarationEnd, false);
            declaration = token.begin;
        }
        declarationEnd = token.end;
        const std::string_view text = textOf(source, token);
        if (text == "{" || text == "(") open.push_back(token.begin);
        if ((text == "}" || text == ")") && !open.empty()) {
            add(open.back(), token.begin, false);
            open.pop_back();
        }
    }
    endComment();
    add(declaration, declarationEnd, false);
    std::sort(folds.begin(), folds.end());
    folds.erase(std::unique(folds.begin(), folds.end()), folds.end());
    return folds;
}

namespace {

TokenKind kindOf(const Occurrence& o) {
    switch (o.kind) {
        case NameKind::Symbol:
            return rules::isNonTerminal(o.name) ? TokenKind::Shape : TokenKind::Terminal;
        case NameKind::Parameter:
            return TokenKind::Parameter;
        case NameKind::Joint:
            return TokenKind::Joint;
        case NameKind::Rule:
        case NameKind::Style:
        case NameKind::Way:
            return TokenKind::Rule;
        case NameKind::Lsystem:
            return TokenKind::Function;
        default:
            return TokenKind::Value;
    }
}

bool isClause(std::string_view word) {
    const auto words = clauseWords();
    return syntax::findDeclaration(word) || syntax::isReserved(word) ||
           std::any_of(words.begin(), words.end(), [&](const Keyword& k) { return k.word == word; });
}

}  // namespace

std::vector<Stretch> stretchesOf(const Analysis& analysis) {
    using Kind = syntax::Token::Kind;
    const syntax::Source& source = analysis.source();
    const std::vector<Occurrence>& names = analysis.file().names;
    auto name = names.begin();
    std::vector<Stretch> stretches;
    const std::vector<syntax::Token> tokens = syntax::lex(source);
    for (size_t i = 0; i < tokens.size(); ++i) {
        const syntax::Token& token = tokens[i];
        const std::string_view text = textOf(source, token);
        while (name != names.end() && name->span.end <= token.begin) ++name;
        const auto put = [&](TokenKind kind, bool defines = false) {
            stretches.push_back({token.begin, token.end, kind, defines});
        };
        if (token.kind == Kind::Comment)
            put(TokenKind::Comment);
        else if (token.kind == Kind::Number || token.kind == Kind::Color)
            put(TokenKind::Number);
        else if (token.kind == Kind::Text)
            put(TokenKind::Text);
        else if (token.kind != Kind::Word)
            continue;
        else if (name != names.end() && name->span.begin == token.begin)
            put(kindOf(*name), name->defines);
        else if (isClause(text))
            put(TokenKind::Keyword);
        else if (operations::table().find(text))
            put(TokenKind::Operation);
        else if (field::findPrimitive(text))
            put(TokenKind::Solid);
        else if (!docOf(text).empty())
            put(i + 1 < tokens.size() && textOf(source, tokens[i + 1]) == "(" ? TokenKind::Function : TokenKind::Value);
    }
    return stretches;
}

}  // namespace sgm::language
