// Where reading goes on after a failure within a declaration.
#include <algorithm>

#include "grammar/syntax/cursor.h"
#include "grammar/syntax/declarations.h"
#include "grammar/syntax/expressions.h"

namespace sgm::syntax {
namespace {

constexpr size_t mostErrors = 20;

bool isAnyOf(std::string_view text, std::initializer_list<std::string_view> list) {
    return std::find(list.begin(), list.end(), text) != list.end();
}

bool isBar(std::string_view text) { return text == "|" || text == "||"; }

std::string_view openingOf(std::string_view closing) { return closing == ")" ? "(" : closing == "]" ? "[" : "{"; }

bool areBracesPaired(std::span<const std::string_view> words) {
    int depth = 0;
    for (const std::string_view word : words) {
        depth += (word == "{") - (word == "}");
        if (depth < 0) return false;
    }
    return depth == 0;
}

/// The brackets that are open.
class OpenBrackets {
public:
    bool empty() const { return open_.empty(); }
    /// Whether one of them is a curly brace. O(1).
    bool holdBrace() const { return braces_ > 0; }
    /// The innermost; "" where none is open.
    std::string_view innermost() const { return open_.empty() ? "" : open_.back(); }
    void open(std::string_view word) {
        open_.push_back(word);
        braces_ += word == "{";
    }
    void close() {
        if (open_.empty()) return;
        braces_ -= open_.back() == "{";
        open_.pop_back();
    }

private:
    std::vector<std::string_view> open_;
    size_t braces_ = 0;
};

bool opens(std::string_view word) { return isAnyOf(word, {"(", "[", "{"}); }
bool closes(std::string_view word) { return isAnyOf(word, {")", "]", "}"}); }

/// The innermost bracket that stays open in `words`; "" where none does.
std::string_view openedIn(std::span<const std::string_view> words) {
    OpenBrackets brackets;
    for (const std::string_view word : words) {
        if (opens(word)) brackets.open(word);
        if (closes(word)) brackets.close();
    }
    return brackets.innermost();
}

/// A word that stands where a declaration's should, and resembles one.
bool isMisspelt(std::string_view word) {
    std::vector<std::string> words;
    for (const Declaration& d : declarations()) words.emplace_back(d.word);
    return !didYouMean(word, words).empty();
}

}  // namespace

bool Cursor::beginsLine(size_t index) const {
    if (index == 0 || index >= tokens_.size()) return true;
    const uint32_t end = tokens_[index - 1].end;
    return source_.text().substr(end, tokens_[index].begin - end).find('\n') != std::string_view::npos;
}

/// Whether `next` begins at a token that stands in no bracket of its own.
bool Cursor::stopsAt(size_t index, Next next) const {
    const std::string_view word = text(tokens_[index]);
    const auto follows = [&](size_t by) { return index + by < tokens_.size() ? text(tokens_[index + by]) : ""; };
    if (next == Next::Body) return word == "->";
    if (next == Next::Declaration) {
        if (!beginsLine(index) || tokens_[index].kind != Token::Kind::Word) return false;
        if (findDeclaration(word) && isReserved(word)) return true;
        const bool isNamed = index + 1 < tokens_.size() && tokens_[index + 1].kind == Token::Kind::Word;
        return tokens_[index].columnOne && (follows(1) == "->" || (isNamed && isMisspelt(word)));
    }
    if (next != Next::Sibling) return false;
    if (word == "finally") return true;
    if (word == ",") return beginsLine(index) || beginsLine(index + 1);
    if (!beginsLine(index) || !isAnyOf(word, {"+", "-", "&", "morph"})) return false;
    // '+x' may be a joint, and a calculation may go on in this line.
    const bool isAxis = isAnyOf(follows(1), {"x", "y", "z"}) && tokens_[index + 1].glued;
    const bool isCall = word == "morph" && follows(1) == "(" && tokens_[index + 1].glued;
    return !isAxis && !isCall && (follows(1) == "(" || isWord(follows(1)));
}

bool Cursor::resume(size_t from, Next next) {
    if (!failed_ || isTooDeep_ || diagnostics_.errorCount() >= mostErrors) return false;
    const bool isFlat = next == Next::Declaration;
    std::vector<std::string_view> words;
    for (const Token& token : tokens_) words.push_back(text(token));
    if (!isFlat && !areBracesPaired(words)) return false;
    const auto goOn = [&](size_t index) {
        if (index < failedAt_) return false;
        at_ = index;
        failed_ = false;
        return true;
    };
    const std::string_view around = openedIn(std::span(words).first(from));
    OpenBrackets brackets;
    for (size_t i = from; i < tokens_.size(); ++i) {
        if ((isFlat || brackets.empty()) && i >= failedAt_ && stopsAt(i, next)) return goOn(i);
        if (isFlat) continue;
        const std::string_view word = words[i];
        // No parentheses reach beyond it: they were left open.
        if (next == Next::Sibling && word == "finally" && !brackets.holdBrace() && i >= failedAt_) return goOn(i);
        if (opens(word)) {
            brackets.open(word);
        } else if (closes(word)) {
            // What was left open within is closed too; what wasn't opened closes what stands around.
            while (!brackets.empty() && brackets.innermost() != openingOf(word) &&
                   (word == "}" || brackets.innermost() != "{"))
                brackets.close();
            if (brackets.empty()) return next != Next::Body && around == openingOf(word) && goOn(i);
            if (brackets.innermost() == openingOf(word)) brackets.close();
        } else if (isBar(word) && !brackets.holdBrace()) {
            return next != Next::Body && around == "{" && goOn(i);
        }
    }
    return false;
}

}  // namespace sgm::syntax
