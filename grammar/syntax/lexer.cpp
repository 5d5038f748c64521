#include "grammar/syntax/lexer.h"

#include <algorithm>

namespace sgm::syntax {

namespace {

// Longest first, so that the first that fits is the right one.
constexpr std::string_view symbols[] = {
    "->", "=>", "~>", "..", "==", "!=", "<=", ">=", "&&", "||", "+", "-", "*", "/", "%", "&",
    "|",  ":",  ",",  "=",  "<",  ">",  "(",  ")",  "[",  "]",  "{", "}", ".", "~", "!", ";",
};

constexpr bool isDigit(char c) { return c >= '0' && c <= '9'; }
constexpr bool isLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
constexpr bool isWordPart(char c) { return isLetter(c) || isDigit(c); }
constexpr bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
constexpr std::string_view byteOrderMark = "\xef\xbb\xbf";

/// Reads one token at a time from `text_`.
class Lexer {
public:
    explicit Lexer(std::string_view text) : text_(text) {}

    bool atEnd() const { return at_ == text_.size(); }
    size_t position() const { return at_; }

    /// Moves past the next token and says what it was.
    Token::Kind next() {
        const char c = peek();
        if (at_ == 0 && text_.substr(0, 3) == byteOrderMark) return at_ += 3, Token::Kind::Blank;
        if (isBlank(c)) return skipWhile(isBlank), Token::Kind::Blank;
        if (c == '/' && peek(1) == '/') return skipWhile([](char k) { return k != '\n'; }), Token::Kind::Comment;
        if (isLetter(c)) return skipWhile(isWordPart), Token::Kind::Word;
        if (isDigit(c) || (c == '.' && isDigit(peek(1)))) return number(), Token::Kind::Number;
        if (c == '"') return text(), Token::Kind::Text;
        if (c == '#') return ++at_, skipWhile(isWordPart), Token::Kind::Color;
        for (const std::string_view symbol : symbols)
            if (text_.compare(at_, symbol.size(), symbol) == 0) return at_ += symbol.size(), Token::Kind::Symbol;
        return unknown(), Token::Kind::Unknown;
    }

private:
    char peek(size_t ahead = 0) const { return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0'; }

    template <class Predicate>
    void skipWhile(Predicate fits) {
        while (!atEnd() && fits(text_[at_])) ++at_;
    }

    /// digits [. digits] [e digits] [unit]. A dot without a digit behind it stays out: 0..1 are three tokens.
    void number() {
        skipWhile(isDigit);
        if (peek() == '.' && isDigit(peek(1))) ++at_, skipWhile(isDigit);
        const size_t sign = peek(1) == '-' || peek(1) == '+';
        if ((peek() == 'e' || peek() == 'E') && isDigit(peek(1 + sign))) at_ += 1 + sign, skipWhile(isDigit);
        if (peek() == '%')
            ++at_;
        else if (peek() == '/' && peek(1) == 'm' && !isWordPart(peek(2)))
            at_ += 2;
        else
            unit();
    }

    /// Letters and digits, and a raised 2 or 3 behind them: m².
    void unit() {
        skipWhile(isWordPart);
        if (peek() == '\xc2' && (peek(1) == '\xb2' || peek(1) == '\xb3')) at_ += 2;
    }

    void text() {
        ++at_;
        while (!atEnd() && peek() != '"' && peek() != '\n' && peek() != '\r') {
            const bool escape = peek() == '\\' && (peek(1) == '"' || peek(1) == '\\');
            at_ += escape ? 2 : 1;
        }
        if (peek() == '"') ++at_;
    }

    /// A run of bytes that begin no token, so that a word in another script is one problem and not ten.
    void unknown() {
        const bool ascii = static_cast<unsigned char>(peek()) < 0x80;
        ++at_;
        if (!ascii) skipWhile([](char k) { return static_cast<unsigned char>(k) >= 0x80; });
    }

    std::string_view text_;
    size_t at_ = 0;
};

}  // namespace

bool isWord(std::string_view text) {
    return !text.empty() && isLetter(text[0]) && std::all_of(text.begin(), text.end(), isWordPart);
}

std::vector<Token> lex(const Source& source) {
    std::vector<Token> tokens;
    Lexer lexer(source.text());
    while (!lexer.atEnd()) {
        const size_t begin = lexer.position();
        Token token;
        token.kind = lexer.next();
        token.begin = static_cast<uint32_t>(begin);
        token.end = static_cast<uint32_t>(lexer.position());
        token.glued = !tokens.empty() && !isTrivia(tokens.back().kind);
        token.columnOne = begin == 0 || source.text()[begin - 1] == '\n' ||
                          (begin == byteOrderMark.size() && source.text().substr(0, begin) == byteOrderMark);
        tokens.push_back(token);
    }
    return tokens;
}

std::vector<Token> lexSignificant(const Source& source) {
    std::vector<Token> tokens = lex(source);
    const auto trivia = [](const Token& t) { return isTrivia(t.kind); };
    tokens.erase(std::remove_if(tokens.begin(), tokens.end(), trivia), tokens.end());
    return tokens;
}

}  // namespace sgm::syntax
