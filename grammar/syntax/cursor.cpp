#include "grammar/syntax/cursor.h"

#include <algorithm>

#include "grammar/syntax/hints.h"

namespace sgm::syntax {

namespace {

constexpr int deepest = 100;

}  // namespace

std::string quoted(std::string_view text) {
    constexpr size_t most = 40;
    size_t shown = std::min(most, text.size());
    // No code point is cut in two.
    while (shown > 0 && shown < text.size() && (static_cast<unsigned char>(text[shown]) & 0xc0) == 0x80) --shown;
    std::string out(1, '\'');
    out.append(text.substr(0, shown)).append(shown < text.size() ? "…'" : "'");
    return out;
}

Cursor::Cursor(const Source& source, std::span<Token> tokens, const OperationTable& operations,
               Diagnostics& diagnostics)
    : source_(source),
      tokens_(tokens),
      operations_(operations),
      diagnostics_(diagnostics),
      lastEnd_(tokens.empty() ? 0 : tokens[0].begin) {}

std::vector<Token> Cursor::tokensOf(SourceSpan range) const {
    const Source part(source_.name(), std::string(range.text()));
    std::vector<Token> tokens = lexSignificant(part);
    for (Token& token : tokens) token.begin += range.begin, token.end += range.begin;
    return tokens;
}

Token Cursor::peek(size_t ahead) const {
    if (ahead < tokens_.size() - at_) return tokens_[at_ + ahead];
    Token end;
    end.begin = end.end = lastEnd_;
    return end;
}

Token Cursor::previous(size_t back) const { return back > 0 && back <= at_ ? tokens_[at_ - back] : Token{}; }

Token Cursor::take(Token::Role role) {
    if (done()) return peek();
    if (role != Token::Role::Plain) mark(role);
    lastEnd_ = tokens_[at_].end;
    return tokens_[at_++];
}

void Cursor::mark(Token::Role role) {
    if (!done()) tokens_[at_].role = role;
}

bool Cursor::accept(std::string_view wanted, Token::Role role) {
    if (!at(wanted)) return false;
    take(role);
    return true;
}

bool Cursor::expect(std::string_view wanted, std::string_view where, std::string hint) {
    if (accept(wanted)) return true;
    fail("expected " + quoted(wanted) + " " + std::string(where) + ", found " + found(), std::move(hint));
    return false;
}

bool Cursor::close(const Token& open) {
    const std::string_view opening = text(open);
    const std::string_view closing = opening == "(" ? ")" : opening == "[" ? "]" : "}";
    const bool isValue = previous(1).kind == Token::Kind::Number || previous(1).kind == Token::Kind::Word;
    if (opening == "(" && isValue && at(Token::Kind::Number)) {
        const std::string last(text(previous(1))), next(peekText());
        const bool isName = previous(1).kind == Token::Kind::Word;
        fail(
            isName ? "two values stand side by side" : "two numbers stand side by side",
            "put ',' between them: " + quoted("(" + last + ", " + next + " …)") +
                (isName && open.glued ? ", or ':' behind the name of an argument: " + quoted(last + ": " + next) : ""));
        return false;
    }
    return expect(closing, "to close " + quoted(opening) + " of line " + std::to_string(source_.place(open.begin).line),
                  opening == "{" && at(",") ? "what stands in '{ … }' is set apart by '|'" : "");
}

std::string Cursor::found() const { return done() ? "the end of the declaration" : quoted(peekText()); }

void Cursor::fail(std::string message, std::string hint) {
    if (auto found = failed_ ? std::nullopt : findHint(*this, message))
        failAt(found->span, std::move(found->message), std::move(found->hint));
    else
        failAt(span(peek()), std::move(message), std::move(hint));
}

void Cursor::failAt(SourceSpan span, std::string message, std::string hint) {
    complain(span, std::move(message), std::move(hint));
    giveUp();
}

void Cursor::giveUp() {
    if (!failed_) failedAt_ = at_;
    failed_ = true;
    at_ = tokens_.size();
}

void Cursor::complain(SourceSpan span, std::string message, std::string hint) {
    if (!failed_) diagnostics_.error(span, std::move(message), std::move(hint));
}

void Cursor::warn(SourceSpan span, std::string message, std::string hint) {
    if (!failed_) diagnostics_.warning(span, std::move(message), std::move(hint));
}

Cursor::Nest::Nest(Cursor& cursor) : cursor_(cursor) {
    if (++cursor_.depth_ <= deepest) return;
    cursor_.fail("nested more than " + std::to_string(deepest) + " deep", "give a part its own rule or name");
    cursor_.isTooDeep_ = true;
}

}  // namespace sgm::syntax
