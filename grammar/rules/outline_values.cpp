#include "grammar/rules/outline_values.h"

#include <fmt/format.h>

#include <algorithm>

#include "grammar/rules/measure_text.h"

namespace sgm::rules {
namespace {

std::string_view nameOf(Unit unit) {
    switch (unit) {
        case Unit::Metre:
            return "length";
        case Unit::Angle:
            return "angle";
        default:
            return "number";
    }
}

/// 'feature 5 of "lots.geojson"', 'line 12 of "lots.svg"'.
std::string placeIn(const std::string& file, uint64_t place) {
    const bool hasLines = file.ends_with(".svg") || file.ends_with(".obj");
    return fmt::format("{} {} of \"{}\"", hasLines ? "line" : "feature", place, file);
}

}  // namespace

void warnOfUnreadValues(CheckContext& ctx) {
    std::set<std::pair<size_t, std::string>> told;
    for (const OutlineValue& asked : ctx.outlineValues)
        for (size_t file = 0; file < ctx.grammar.outlines.size(); ++file) {
            if (!ctx.grammar.outlines[file]) continue;
            const plan::Feature* first = nullptr;
            std::string text;
            size_t count = 0;
            for (const plan::Feature& feature : ctx.grammar.outlines[file]->list) {
                const auto* said = feature.find(asked.property);
                const auto* word = said ? std::get_if<std::string>(said) : nullptr;
                if (!word || word->empty() || readMeasure(*word, asked.unit)) continue;
                if (count++ == 0) first = &feature, text = *word;
            }
            if (!first || !told.insert({file, asked.property}).second) continue;
            const std::string more = count > 1 ? fmt::format(" (and {} more)", count - 1) : "";
            ctx.diagnostics.warning(
                asked.span,
                fmt::format("{}{} says \"{}\": \"{}\", which is no {}, so the default holds",
                            placeIn(ctx.files.outlinesName(file), first->place), more, asked.property, text,
                            nameOf(asked.unit)),
                asked.unit == Unit::Metre ? "files say metres as 6.5, or a unit: m, km, cm, mm, ft, ', in"
                : asked.unit == Unit::Angle
                    ? "files say degrees as 12.5, or '12.5 deg'"
                    : "files say numbers as 6.5, with nothing behind them; word(\"…\", …) reads words");
        }
}

}  // namespace sgm::rules
