#include "grammar/syntax/source.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>

#include "modeler/core/lower_case.h"
#include "modeler/core/printable.h"

namespace sgm::syntax {

namespace {

constexpr bool isContinuation(char c) { return (static_cast<unsigned char>(c) & 0xc0) == 0x80; }

/// The stretch of a long line around byte `from`, and where it begins.
std::pair<std::string_view, size_t> window(std::string_view line, size_t from) {
    constexpr size_t widest = 160, before = 80;
    size_t begin = line.size() > widest && from > before ? std::min(from - before, line.size()) : 0;
    while (begin > 0 && begin < line.size() && isContinuation(line[begin])) --begin;
    size_t end = std::min(line.size(), begin + widest);
    while (end < line.size() && isContinuation(line[end])) ++end;
    return {line.substr(begin, end - begin), begin};
}

/// The line under `line` that marks bytes [from, to): tabs stay tabs, so that both lines step alike.
std::string caretLine(std::string_view line, size_t from, size_t to) {
    std::string marks;
    for (size_t i = 0; i < from; ++i) {
        if (i >= line.size())
            marks += ' ';
        else if (!isContinuation(line[i]))
            marks += line[i] == '\t' ? '\t' : ' ';
    }
    marks += '^';
    for (size_t i = from + 1; i < std::min(to, line.size()); ++i)
        if (!isContinuation(line[i])) marks += '~';
    return marks;
}

/// Letters to insert, delete, replace or swap with their neighbour (optimal string alignment); both words are short.
size_t editDistance(std::string_view a, std::string_view b) {
    std::vector<size_t> before(b.size() + 1), row(b.size() + 1), next(b.size() + 1);
    std::iota(row.begin(), row.end(), size_t{0});
    for (size_t i = 0; i < a.size(); ++i) {
        next[0] = i + 1;
        for (size_t j = 0; j < b.size(); ++j) {
            next[j + 1] = std::min({row[j] + (a[i] != b[j]), next[j] + 1, row[j + 1] + 1});
            if (i > 0 && j > 0 && a[i] == b[j - 1] && a[i - 1] == b[j])
                next[j + 1] = std::min(next[j + 1], before[j - 1] + 1);
        }
        std::swap(before, row);
        std::swap(row, next);
    }
    return row.back();
}

/// A message may quote the text, which may hold anything and be of any length.
std::string messageOf(const Diagnostic& diagnostic) {
    constexpr size_t longest = 2000;
    return shortened(printable(diagnostic.message, true), longest);
}

}  // namespace

Source::Source(std::string name, std::string text) : name_(std::move(name)), text_(std::move(text)), lineStarts_{0} {
    for (size_t i = 0; i < text_.size(); ++i)
        if (text_[i] == '\n') lineStarts_.push_back(static_cast<uint32_t>(i + 1));
}

Source::Place Source::place(uint32_t offset) const {
    offset = std::min(offset, static_cast<uint32_t>(text_.size()));
    const auto after = std::upper_bound(lineStarts_.begin(), lineStarts_.end(), offset);
    return {static_cast<uint32_t>(after - lineStarts_.begin()), offset - *(after - 1) + 1};
}

std::string_view Source::line(uint32_t number) const {
    if (number < 1 || number > lineStarts_.size()) return {};
    const uint32_t begin = lineStarts_[number - 1];
    const size_t end = number < lineStarts_.size() ? lineStarts_[number] - 1 : text_.size();
    std::string_view line = text().substr(begin, end - begin);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    return line;
}

std::string placeText(SourceSpan span) {
    if (!span.source) return {};
    const Source::Place place = span.source->place(span.begin);
    return printable(span.source->name()) + ':' + std::to_string(place.line) + ':' + std::to_string(place.column) +
           ": ";
}

Error errorAt(SourceSpan span, Error::Kind kind, const std::string& message) {
    return {kind, placeText(span) + message, span.end - span.begin};
}

SourceSpan join(SourceSpan a, SourceSpan b) {
    if (!a.source) return b;
    if (!b.source) return a;
    return {a.source, std::min(a.begin, b.begin), std::max(a.end, b.end)};
}

void Diagnostics::error(SourceSpan span, std::string message, std::string hint) {
    list_.push_back({Severity::Error, span, std::move(message), std::move(hint)});
    ++errors_;
}

void Diagnostics::warning(SourceSpan span, std::string message, std::string hint) {
    list_.push_back({Severity::Warning, span, std::move(message), std::move(hint)});
}

std::string render(const Diagnostic& diagnostic) {
    const char* severity = diagnostic.severity == Severity::Error ? "error" : "warning";
    const Source* source = diagnostic.span.source;
    std::string out;
    if (source) {
        const Source::Place place = source->place(diagnostic.span.begin);
        out += placeText(diagnostic.span);
        const auto [shown, begin] = window(source->line(place.line), place.column - 1);
        const std::string line = printable(shown);
        const size_t from = place.column - 1 - begin;
        const size_t to = from + (diagnostic.span.end - diagnostic.span.begin);
        out +=
            std::string(severity) + ": " + messageOf(diagnostic) + "\n  " + line + "\n  " + caretLine(line, from, to);
    } else {
        out += std::string(severity) + ": " + messageOf(diagnostic);
    }
    if (!diagnostic.hint.empty()) out += "\n  " + printable(diagnostic.hint, true);
    return out + '\n';
}

std::string toJson(const Diagnostics& diagnostics) {
    std::vector<Diagnostic> sorted = diagnostics.all();
    std::stable_sort(sorted.begin(), sorted.end(), [](const Diagnostic& a, const Diagnostic& b) {
        const std::string_view fileA = a.span.source ? a.span.source->name() : std::string_view();
        const std::string_view fileB = b.span.source ? b.span.source->name() : std::string_view();
        return fileA != fileB ? fileA < fileB : a.span.begin < b.span.begin;
    });
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const Diagnostic& d : sorted) {
        const Source* source = d.span.source;
        const Source::Place begin = source ? source->place(d.span.begin) : Source::Place{};
        const Source::Place end = source ? source->place(d.span.end) : Source::Place{};
        list.push_back({{"file", source ? source->name() : ""},
                        {"line", begin.line},
                        {"column", begin.column},
                        {"endLine", end.line},
                        {"endColumn", end.column},
                        {"severity", d.severity == Severity::Error ? "error" : "warning"},
                        {"message", d.message},
                        {"hint", d.hint}});
    }
    // A file may hold bytes that are no UTF-8, and messages quote it.
    return list.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

std::string didYouMean(std::string_view word, const std::vector<std::string>& candidates) {
    constexpr size_t longest = 64;
    if (word.empty() || word.size() > longest) return {};
    const std::string wanted = lowerCase(std::string(word));
    // What was begun and not ended, as 'over' of 'overhang', is no slip of letters.
    constexpr size_t leastBegun = 3;
    std::string best;
    if (wanted.size() >= leastBegun)
        for (const std::string& candidate : candidates)
            if (candidate.size() > word.size() + 1 && candidate.size() <= longest &&
                lowerCase(std::string(candidate)).starts_with(wanted) &&
                (best.empty() || candidate.size() < best.size()))
                best = candidate;
    if (!best.empty()) return best;
    size_t least = std::max<size_t>(1, word.size() / 3) + 1;
    for (const std::string& candidate : candidates) {
        if (candidate.size() > longest || candidate == word) continue;
        const size_t distance = editDistance(wanted, lowerCase(std::string(candidate)));
        if (distance < least) {
            least = distance;
            best = candidate;
        }
    }
    // One letter that turns into another is no slip.
    return least >= std::max(word.size(), best.size()) ? std::string() : best;
}

}  // namespace sgm::syntax
