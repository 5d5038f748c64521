#include "cli/validators.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <limits>

#include "grammar/rules/words.h"

namespace sgm::cli {
namespace {

/// Why the text is none of the words; empty where it is one.
std::string whyNoWord(const std::string& text, const std::vector<std::string>& words) {
    if (std::find(words.begin(), words.end(), text) != words.end()) return {};
    const std::string hint = rules::nearestHint(text, words);
    return fmt::format("'{}' is none of {}{}{}", text, fmt::join(words, ", "), hint.empty() ? "" : "; ", hint);
}

std::string listOf(const std::vector<std::string>& words) { return fmt::format("{{{}}}", fmt::join(words, ",")); }

}  // namespace

CLI::Validator between(double lo, double hi) {
    const auto refusal = [lo, hi](std::string& text) {
        double value = 0;
        const bool inside = CLI::detail::lexical_cast(text, value) && value >= lo && value <= hi;
        return inside ? std::string() : fmt::format("'{}' is no number from {:g} to {:g}", text, lo, hi);
    };
    return {refusal, fmt::format("FLOAT in [{:g} - {:g}]", lo, hi)};
}

CLI::Validator wholeNumber(uint64_t lo, uint64_t hi) {
    const auto refusal = [lo, hi](std::string& text) {
        uint64_t value = 0;
        const char* const end = text.data() + text.size();
        const auto [rest, fault] = std::from_chars(text.data(), end, value);
        const bool inside = fault == std::errc() && rest == end && value >= lo && value <= hi;
        return inside ? std::string() : fmt::format("'{}' is no whole number from {} to {}", text, lo, hi);
    };
    return {refusal, fmt::format("UINT in [{} - {}]", lo, hi)};
}

CLI::Validator anySeed() {
    CLI::Validator any = wholeNumber(0, std::numeric_limits<uint64_t>::max());
    any.description("");  // a seed has no range that anybody has to know
    return any;
}

CLI::Validator oneOf(std::vector<std::string> words) {
    const std::string list = listOf(words);
    return {[words = std::move(words)](std::string& text) { return whyNoWord(text, words); }, list};
}

CLI::Validator namedValue(std::map<std::string, int> values) {
    std::vector<std::string> words;
    for (const auto& [word, value] : values) words.push_back(word);
    const std::string list = listOf(words);
    const auto replace = [values = std::move(values), words](std::string& text) {
        std::string why = whyNoWord(text, words);
        if (why.empty()) text = std::to_string(values.at(text));
        return why;
    };
    return {replace, list};
}

}  // namespace sgm::cli
