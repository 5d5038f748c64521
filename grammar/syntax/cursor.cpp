#include "grammar/syntax/cursor.h"

#include <algorithm>

namespace sgm::syntax {

namespace {

constexpr int deepest = 100;

/// What a person most likely meant by bytes that are no token.
struct Lookalike {
    std::string_view bytes, mend;
};
constexpr Lookalike lookalikes[] = {
    {"\u2212", "write '-'"},  {"\u2013", "write '-'"},  {"\u00d7", "write '*'"},       {"\u2192", "write '->'"},
    {"\u201c", "write '\"'"}, {"\u201d", "write '\"'"}, {"\u00b0", "write 'deg'"},     {"\u2026", "write '..'"},
    {"\u2265", "write '>='"}, {"\u2264", "write '<='"}, {"'", "text stands in \"…\""},
};

std::string mendOf(std::string_view unknown) {
    for (const Lookalike& row : lookalikes)
        if (unknown.substr(0, row.bytes.size()) == row.bytes) return std::string(row.mend);
    return {};
}

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

Cursor::Cursor(const Source& source, std::span<Token> tokens, const OperationTable& operations, Diagnostics& diagnostics)
    : source_(source), tokens_(tokens), operations_(operations), diagnostics_(diagnostics), lastEnd_(tokens.empty() ? 0 : tokens[0].begin) {}

Token Cursor::peek(size_t ahead) const {
    if (ahead < tokens_.size() - at_) return tokens_[at_ + ahead];
    Token end;
    end.begin = end.end = lastEnd_;
    return end;
}

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

bool Cursor::expect(std::string_view wanted, std::string_view where, std::string mend) {
    if (accept(wanted)) return true;
    fail("expected " + quoted(wanted) + " " + std::string(where) + ", found " + found(), std::move(mend));
    return false;
}

bool Cursor::close(const Token& open) {
    const std::string_view opening = text(open);
    const std::string_view closing = opening == "(" ? ")" : opening == "[" ? "]" : "}";
    return expect(closing,
                  "to close " + quoted(opening) + " of line " + std::to_string(source_.place(open.begin).line));
}

std::string Cursor::found() const { return done() ? "the end of the declaration" : quoted(peekText()); }

void Cursor::fail(std::string message, std::string mend) {
    if (at(Token::Kind::Unknown)) {
        const std::string_view bytes = peekText();
        failAt(span(peek()), "unexpected character " + quoted(bytes), mendOf(bytes));
    } else {
        failAt(span(peek()), std::move(message), std::move(mend));
    }
}

void Cursor::failAt(SourceSpan span, std::string message, std::string mend) {
    complain(span, std::move(message), std::move(mend));
    failed_ = true;
    at_ = tokens_.size();
}

void Cursor::complain(SourceSpan span, std::string message, std::string mend) {
    if (!failed_) diagnostics_.error(span, std::move(message), std::move(mend));
}

Cursor::Nest::Nest(Cursor& cursor) : cursor_(cursor) {
    if (++cursor_.depth_ > deepest)
        cursor_.fail("nested more than " + std::to_string(deepest) + " deep", "give a part its own rule or name");
}

}  // namespace sgm::syntax
