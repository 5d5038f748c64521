// Words, numbers and lines of a text that may hold anything.
// Enters: bytes. Leaves: views into them. Assumes that they outlive the scanner; a NUL is a character like any other.
#pragma once

#include <charconv>
#include <cstdint>
#include <optional>
#include <string_view>

namespace sgm::mesh {

class TextScanner {
public:
    /// `comment` begins a remark up to the end of its line; '\0': there are none. With `joinsLines` a '\' before the
    /// end of a line joins the next one to it.
    explicit TextScanner(std::string_view text, char comment = '\0', bool joinsLines = false)
        : text_(text), comment_(comment), joinsLines_(joinsLines) {}

    bool atEnd() const { return at_ == text_.size(); }
    size_t position() const { return at_; }
    /// From 1; counted anew, for messages.
    uint64_t line() const {
        uint64_t n = 1;
        for (size_t i = 0; i < at_; ++i) n += text_[i] == '\n';
        return n;
    }

    /// The next word of this line; "" at its end.
    std::string_view wordOfLine() {
        for (;;) {
            while (!atEnd() && isBlank(text_[at_])) ++at_;
            if (!joinsNextLine()) break;
        }
        if (!atEnd() && comment_ != '\0' && text_[at_] == comment_)
            while (!atEnd() && text_[at_] != '\n') ++at_;
        const size_t begin = at_;
        while (!atEnd() && !isBlank(text_[at_]) && text_[at_] != '\n') ++at_;
        return text_.substr(begin, at_ - begin);
    }

    /// Moves behind the end of this line.
    void nextLine() {
        while (!wordOfLine().empty()) {
        }
        if (!atEnd()) ++at_;
    }

    /// The next word, on this line or a later one; "" at the end of the text.
    std::string_view word() {
        for (;;) {
            const std::string_view found = wordOfLine();
            if (!found.empty() || atEnd()) return found;
            ++at_;
        }
    }

private:
    static bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }
    bool joinsNextLine() {
        if (!joinsLines_) return false;
        const std::string_view rest = text_.substr(at_);
        const size_t length = rest.starts_with("\\\n") ? 2 : rest.starts_with("\\\r\n") ? 3 : 0;
        at_ += length;
        return length > 0;
    }

    std::string_view text_;
    char comment_;
    bool joinsLines_;
    size_t at_ = 0;
};

/// A word that is one number and nothing else, in the range of its type. Infinities and NaN count as numbers.
template <class T>
std::optional<T> numberOf(std::string_view word) {
    if (word.starts_with('+')) word.remove_prefix(1);
    T value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
    return value;
}

}  // namespace sgm::mesh
