#include "viewer/document/following.h"

#include <algorithm>

#include "grammar/rules/check.h"

namespace sgm::viewer {

std::optional<rules::Grammar> withValueOf(const rules::Grammar& grammar, std::string_view text) {
    const syntax::Source& source = *grammar.sources.front();
    const std::string_view before = source.text();
    rules::Grammar changed = grammar;
    if (before == text) return changed;
    const auto shorter = static_cast<std::ptrdiff_t>(std::min(before.size(), text.size()));
    const auto head = std::mismatch(before.begin(), before.begin() + shorter, text.begin()).first - before.begin();
    const auto tail =
        std::mismatch(before.rbegin(), before.rbegin() + (shorter - head), text.rbegin()).first - before.rbegin();
    const size_t end = before.size() - static_cast<size_t>(tail);
    const auto take = [&](const rules::Param& param, const syntax::SourceSpan& span, rules::Value& into) {
        if (span.source != &source || static_cast<size_t>(head) < span.begin || end > span.end) return false;
        const size_t size = span.end + text.size() - before.size() - span.begin;
        Result<rules::Value> value = rules::parseValue(param, std::string(text.substr(span.begin, size)));
        if (value.ok()) into = *value;
        return value.ok();
    };
    for (rules::Param& param : changed.params)
        if (take(param, param.valueSpan, param.value)) return changed;
    for (rules::Style& style : changed.styles)
        for (rules::Setting& setting : style.settings)
            if (take(changed.params[setting.param], setting.valueSpan, setting.value)) return changed;
    return std::nullopt;
}

Result<Model> Following::to(const derive::Options& options, Stages& stages, Progress* progress) {
    const Status derived = timed(stages, "derive", [&] { return pipeline_.derive(grammar_, options, progress); });
    if (!derived.ok()) return derived.error();
    const Status lowered = timed(stages, "lower", [&] { return pipeline_.lower(progress); });
    if (!lowered.ok()) return lowered.error();
    auto model = std::make_unique<lower::Model>();
    model->field = pipeline_.model().field;
    model->field.value = {};
    model->provenance = pipeline_.model().provenance;
    model->shapeOf = pipeline_.model().shapeOf;
    eval::Tape tape = timed(stages, "compile", [&] {
        pipeline_.compile();
        return pipeline_.tape();
    });
    return Model{pipeline_.derivation(), std::move(model), std::move(tape)};
}

}  // namespace sgm::viewer
