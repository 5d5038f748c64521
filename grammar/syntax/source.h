// Source text, spans in it, and problems with it.
// Enters: file text. Leaves: spans and rendered diagnostics. Assumes UTF-8; columns count bytes from 1.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "modeler/core/result.h"

namespace sgm::syntax {

/// One file's text with its line starts.
class Source {
public:
    Source(std::string name, std::string text);
    const std::string& name() const { return name_; }
    std::string_view text() const { return text_; }
    struct Place {
        uint32_t line = 1, column = 1;
    };
    /// Line and column (from 1) of a byte offset; an offset past the end gives the end.
    Place place(uint32_t offset) const;
    /// The text of a line (from 1) without its line end.
    std::string_view line(uint32_t number) const;

private:
    std::string name_, text_;
    std::vector<uint32_t> lineStarts_;
};
using SourcePtr = std::shared_ptr<const Source>;

/// A half-open range of bytes [begin, end) of a source. A default span points nowhere.
struct SourceSpan {
    const Source* source = nullptr;
    uint32_t begin = 0, end = 0;
    std::string_view text() const { return source ? source->text().substr(begin, end - begin) : std::string_view(); }
};
/// "file:line:column: ", or nothing for a span that points nowhere.
std::string placeText(SourceSpan span);
/// An error about the text of `span`, whose message begins with its place.
Error errorAt(SourceSpan span, Error::Kind kind, const std::string& message);
/// The smallest span that holds both (same source).
SourceSpan join(SourceSpan a, SourceSpan b);

enum class Severity { Error, Warning };

/// One problem: where, a sentence in plain words, and the hint where one can be given ("did you mean 'Wing'?").
struct Diagnostic {
    Severity severity = Severity::Error;
    SourceSpan span;
    std::string message;
    std::string hint;
};

class Diagnostics {
public:
    void error(SourceSpan span, std::string message, std::string hint = {});
    void warning(SourceSpan span, std::string message, std::string hint = {});
    bool hasErrors() const { return errors_ > 0; }
    size_t errorCount() const { return errors_; }
    const std::vector<Diagnostic>& all() const { return list_; }
    /// Keeps a source alive as long as the problems that point into it.
    void keep(SourcePtr source) { sources_.push_back(std::move(source)); }

private:
    std::vector<Diagnostic> list_;
    std::vector<SourcePtr> sources_;
    size_t errors_ = 0;
};

/// "file:line:column: error: message", the line, a caret under the span, and the hint.
std::string render(const Diagnostic& diagnostic);
/// [{file, line, column, endLine, endColumn, severity, message, hint}], sorted by place.
std::string toJson(const Diagnostics& diagnostics);
/// The candidate that begins with `word`, else the nearest by edit distance (at most a third of its length), or "".
std::string didYouMean(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace sgm::syntax
