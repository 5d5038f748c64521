#include "viewer/document/nodes.h"

#include <fmt/format.h>

#include <algorithm>

#include "grammar/syntax/lexer.h"
#include "grammar/syntax/parser.h"

namespace sgm::document::edits {

using syntax::Body;
using syntax::Case;
using syntax::Diagnostics;
using syntax::Expr;
using syntax::Token;

namespace {

using Visit = std::function<void(const Body&)>;

void visitBody(const Body& body, const Visit& visit);

void visitCases(const std::vector<Case>& cases, const Visit& visit) {
    for (const Case& part : cases) {
        if (part.body) visitBody(*part.body, visit);
        visitCases(part.cases, visit);
    }
}

void visitBody(const Body& body, const Visit& visit) {
    visit(body);
    for (const auto& chain : body.siblings)
        for (const Element& element : chain) {
            for (const auto* attributes : {&element.before, &element.after})
                for (const syntax::Attribute& attribute : *attributes) visitCases(attribute.cases, visit);
            if (element.body) visitBody(*element.body, visit);
            visitCases(element.cases, visit);
        }
}

/// The last token that ends at or before `offset`.
Token tokenBefore(const Ast& ast, uint32_t offset) {
    Token found;
    for (const Token& token : syntax::lexSignificant(*ast.source)) {
        if (token.end > offset) break;
        found = token;
    }
    return found;
}

/// Must it stand in parentheses to be an argument?
bool calculates(const Expr& e) {
    switch (e.kind) {
        case Expr::Kind::Binary:
            return true;
        case Expr::Kind::Unary:
            return e.text == "not" || calculates(e.args[0]);
        case Expr::Kind::Range:
        case Expr::Kind::Ramp:
            return std::any_of(e.args.begin(), e.args.end(), [&](const Expr& arg) {
                return arg.span.begin == e.span.begin || &arg != &e.args[0]
                           ? calculates(arg) && arg.span.text().substr(0, 1) != "("
                           : false;
            });
        default:
            return false;
    }
}

/// Spans its own parentheses: its first operand begins behind them.
bool parenthesised(const Expr& e) {
    return !e.args.empty() && e.args[0].span.begin > e.span.begin && e.span.text().substr(0, 1) == "(";
}

/// Reads `text` as one expression without comments or line ends.
Result<Expr> readAlone(std::string_view text, syntax::SourcePtr& source) {
    source = std::make_shared<const syntax::Source>("value", std::string(text));
    const std::vector<Token> tokens = syntax::lex(*source);
    const bool comments =
        std::any_of(tokens.begin(), tokens.end(), [](const Token& t) { return t.kind == Token::Kind::Comment; });
    if (comments || text.find('\n') != std::string_view::npos)
        return refused(fmt::format("'{}' can't stand here: no comment, no line end", text));
    Diagnostics problems;
    Expr e = syntax::parseExpression(source, problems);
    if (problems.hasErrors()) return refused(fmt::format("'{}' can't be read: {}", text, problems.all()[0].message));
    return e;
}

std::string_view trimmed(std::string_view text) {
    const size_t begin = text.find_first_not_of(" \t\r\n");
    return begin == std::string_view::npos ? std::string_view()
                                           : text.substr(begin, text.find_last_not_of(" \t\r\n") + 1 - begin);
}

size_t errorsOf(const Diagnostics& problems) {
    return static_cast<size_t>(std::count_if(problems.all().begin(), problems.all().end(),
                                             [](const auto& d) { return d.severity == syntax::Severity::Error; }));
}

}  // namespace

Error refused(std::string why) { return {Error::Kind::Input, std::move(why)}; }

void forBodies(const Ast& ast, const Visit& visit) {
    for (const syntax::StartDecl& start : ast.starts) visitBody(start.body, visit);
    for (const RuleDecl& rule : ast.rules) {
        visitBody(rule.body, visit);
        if (rule.finally_) visitBody(*rule.finally_, visit);
    }
}

Place placeOf(const Ast& ast, const Element& element) {
    Place place;
    forBodies(ast, [&](const Body& body) {
        for (size_t s = 0; s < body.siblings.size(); ++s)
            for (size_t i = 0; i < body.siblings[s].size(); ++i)
                if (&body.siblings[s][i] == &element) place = {&body, s, i};
    });
    return place;
}

uint32_t endBefore(const Ast& ast, uint32_t offset) { return tokenBefore(ast, offset).end; }
uint32_t beginBefore(const Ast& ast, uint32_t offset) { return tokenBefore(ast, offset).begin; }

syntax::SourceSpan tokenFrom(const Ast& ast, uint32_t offset) {
    for (const Token& token : syntax::lexSignificant(*ast.source))
        if (token.begin >= offset) return {ast.source.get(), token.begin, token.end};
    const auto end = static_cast<uint32_t>(ast.source->text().size());
    return {ast.source.get(), end, end};
}

uint32_t lineBegin(std::string_view text, uint32_t offset) {
    const size_t before = offset == 0 ? std::string_view::npos : text.rfind('\n', offset - 1);
    return before == std::string_view::npos ? 0 : static_cast<uint32_t>(before + 1);
}

uint32_t lineEnd(std::string_view text, uint32_t offset) {
    return static_cast<uint32_t>(std::min(text.find('\n', offset), text.size()));
}

bool beginsLine(std::string_view text, uint32_t offset) {
    const uint32_t begin = lineBegin(text, offset);
    return text.substr(begin, offset - begin).find_first_not_of(" \t") == std::string_view::npos;
}

bool endsLine(std::string_view text, uint32_t offset) {
    const std::string_view rest = trimmed(text.substr(offset, lineEnd(text, offset) - offset));
    return rest.empty() || rest.substr(0, 2) == "//";
}

TextEdit removal(std::string_view text, uint32_t begin, uint32_t end) {
    const auto blank = [&](uint32_t at) { return text[at] == ' ' || text[at] == '\t'; };
    if (!beginsLine(text, begin)) {
        while (begin > 0 && blank(begin - 1)) --begin;
        return {begin, end, {}};
    }
    if (trimmed(text.substr(end, lineEnd(text, end) - end)).empty() && begin > 0) {
        const uint32_t first = lineBegin(text, begin);
        return {first == 0 ? 0 : first - 1, lineEnd(text, end), {}};  // with the line end before it
    }
    while (end < text.size() && blank(end)) ++end;
    return {begin, end, {}};
}

Edit tried(const Ast& ast, TextEdit edit) {
    Diagnostics before, after;
    syntax::parse(ast.source, *ast.operations, before);
    syntax::parse(std::make_shared<const syntax::Source>(ast.source->name(), applied(ast.source->text(), edit)),
                  *ast.operations, after);
    if (errorsOf(after) <= errorsOf(before)) return edit;
    const auto first = std::find_if(after.all().begin(), after.all().end(),
                                    [](const auto& d) { return d.severity == syntax::Severity::Error; });
    return refused(first->hint.empty() ? first->message : fmt::format("{} ({})", first->message, first->hint));
}

Result<std::string> asArgument(std::string_view text) {
    syntax::SourcePtr source;
    const auto e = readAlone(trimmed(text), source);
    if (!e.ok()) return e.error();
    std::string written(trimmed(text));
    return calculates(*e) && !parenthesised(*e) ? "(" + written + ")" : written;
}

Result<std::string> asExpression(std::string_view text) {
    syntax::SourcePtr source;
    const auto e = readAlone(trimmed(text), source);
    if (!e.ok()) return e.error();
    return std::string(trimmed(text));
}

Result<std::string> asName(std::string_view text) {
    syntax::SourcePtr source;
    const auto e = readAlone(trimmed(text), source);
    if (!e.ok()) return e.error();
    const std::string written(trimmed(text));
    if (e->kind != Expr::Kind::Name || e->text != written) return refused(fmt::format("'{}' is no name", written));
    return written;
}

}  // namespace sgm::document::edits
