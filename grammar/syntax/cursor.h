// A walk over the tokens of one declaration.
// Enters: a slice of tokens without blanks and comments. Leaves: tokens one at a time, and diagnostics. After a
// failure the slice counts as used up, so nothing more is said about it and every loop ends; nodes made then are empty
// but well formed. Who reads parts that are independent of each other may go on with the next one (`resume`).
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "grammar/syntax/lexer.h"
#include "grammar/syntax/operations.h"

namespace sgm::syntax {

class Cursor {
public:
    Cursor(const Source& source, std::span<Token> tokens, const OperationTable& operations, Diagnostics& diagnostics);

    /// The operations of the language that is read.
    const OperationTable& operations() const { return operations_; }

    /// The token `ahead` of the next one; End (empty, behind the last one taken) when the slice is used up.
    Token peek(size_t ahead = 0) const;
    /// The token taken `back` before the next one (1: the last one taken); an empty one before the first.
    Token previous(size_t back) const;
    std::string_view text(const Token& token) const { return textOf(source_, token); }
    std::string_view peekText(size_t ahead = 0) const { return text(peek(ahead)); }
    SourceSpan span(const Token& token) const { return {&source_, token.begin, token.end}; }

    bool done() const { return at_ == tokens_.size(); }
    bool failed() const { return failed_; }
    bool at(std::string_view wanted, size_t ahead = 0) const { return peekText(ahead) == wanted; }
    bool at(Token::Kind kind, size_t ahead = 0) const { return peek(ahead).kind == kind; }
    Token take(Token::Role role = Token::Role::Plain);
    /// Gives the next token a role.
    void mark(Token::Role role);
    /// Takes the next token if it is `wanted`.
    bool accept(std::string_view wanted, Token::Role role = Token::Role::Plain);
    /// Takes `wanted`, or fails with "expected 'wanted' <where>, found …".
    bool expect(std::string_view wanted, std::string_view where, std::string hint = {});
    /// Takes what closes the bracket `open`, or fails with "expected ')' to close '(' of line 3, found …".
    bool close(const Token& open);

    /// From `begin` to the end of the last token taken.
    SourceSpan since(uint32_t begin) const { return {&source_, begin, begin > lastEnd_ ? begin : lastEnd_}; }
    /// What stands at the cursor, for a message: "'facade'", "the end of the rule".
    std::string found() const;

    /// Reads the tokens of `range` with a cursor of its own: what stands in a text.
    template <class Read>
    void within(SourceSpan range, Read&& read) {
        std::vector<Token> tokens = tokensOf(range);
        Cursor inner(source_, tokens, operations_, diagnostics_);
        read(inner);
        if (!inner.failed() && !inner.done()) inner.fail("expected nothing more here, found " + inner.found());
        if (inner.failed()) giveUp();
    }

    /// Reports the token at the cursor and gives up the slice.
    void fail(std::string message, std::string hint = {});
    void failAt(SourceSpan span, std::string message, std::string hint = {});
    /// Reports and goes on: the meaning is clear all the same.
    void complain(SourceSpan span, std::string message, std::string hint = {});
    /// Warns and goes on.
    void warn(SourceSpan span, std::string message, std::string hint = {});

    /// The index of the next token.
    size_t position() const { return at_; }
    /// What reading may go on with after a failure.
    enum class Next {
        Part,     ///< of a block: the next bar, or what closes the block
        Sibling,  ///< of a body: the next ',' at an end of its line or operator that begins one, 'finally', or its end
        Body,     ///< the arrow before it
        Declaration  ///< a line that begins one, indented or misspelt
    };
    /// After a failure: goes on there, where it is behind the failure and not within brackets that were opened from
    /// token `from` on. False, and nothing changes, where there is no such place, where curly braces aren't paired so
    /// that places can't be told, and where enough problems were reported.
    bool resume(size_t from, Next next);

    /// Holds one level of nesting; gives up the slice when there are too many: the stack must not end first.
    class Nest {
    public:
        explicit Nest(Cursor& cursor);
        ~Nest() { --cursor_.depth_; }
        Nest(const Nest&) = delete;
        Nest& operator=(const Nest&) = delete;

    private:
        Cursor& cursor_;
    };

private:
    std::vector<Token> tokensOf(SourceSpan range) const;
    void giveUp();
    bool beginsLine(size_t index) const;
    bool stopsAt(size_t index, Next next) const;

    const Source& source_;
    std::span<Token> tokens_;
    const OperationTable& operations_;
    Diagnostics& diagnostics_;
    size_t at_ = 0;
    size_t failedAt_ = 0;  ///< the index of the token at which reading failed
    uint32_t lastEnd_ = 0;
    int depth_ = 0;
    bool failed_ = false;
    bool isTooDeep_ = false;
};

/// `text` in quotes for a message, cut where it is long.
std::string quoted(std::string_view text);

}  // namespace sgm::syntax
