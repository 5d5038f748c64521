#include "grammar/pipeline/live_edit.h"

#include <algorithm>

#include "grammar/rules/check.h"

namespace sgm::pipeline {

std::optional<ValueChange> valueChange(const rules::Grammar& grammar, std::string_view text) {
    const syntax::Source& source = *grammar.sources.front();
    const std::string_view before = source.text();
    if (before == text) return ValueChange{};
    const auto shorter = static_cast<std::ptrdiff_t>(std::min(before.size(), text.size()));
    const auto head = std::mismatch(before.begin(), before.begin() + shorter, text.begin()).first - before.begin();
    const auto tail =
        std::mismatch(before.rbegin(), before.rbegin() + (shorter - head), text.rbegin()).first - before.rbegin();
    const size_t end = before.size() - static_cast<size_t>(tail);
    const auto valueIn = [&](uint32_t param, const syntax::SourceSpan& span) -> std::optional<rules::Value> {
        if (span.source != &source || static_cast<size_t>(head) < span.begin || end > span.end) return std::nullopt;
        const size_t size = span.end + text.size() - before.size() - span.begin;
        Result<rules::Value> value =
            rules::parseValue(grammar.params[param], std::string(text.substr(span.begin, size)));
        return value.ok() ? std::optional(std::move(*value)) : std::nullopt;
    };
    for (uint32_t p = 0; p < grammar.params.size(); ++p)
        if (auto value = valueIn(p, grammar.params[p].valueSpan)) return ValueChange{p, nullptr, std::move(*value)};
    for (const rules::Style& style : grammar.styles)
        for (const rules::Setting& setting : style.settings)
            if (auto value = valueIn(setting.param, setting.valueSpan))
                return ValueChange{setting.param, &setting, std::move(*value)};
    return std::nullopt;
}

Result<Model> LiveEdit::to(const derive::Options& options, Context& context) {
    if (const Status done = pipeline_.to(grammar_, options, context); !done.ok()) return done.error();
    return pipeline_.copyModel();
}

}  // namespace sgm::pipeline
