#include "viewer/document/param_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "grammar/rules/color.h"
#include "grammar/rules/params.h"
#include "modeler/core/random.h"

namespace sgm::document {
namespace {

using rules::Value;
using Kind = ParamRow::Kind;

constexpr double sliderSteps = 1000;  ///< a drag over the whole range sets about so many values
constexpr double keySteps = 20;

Kind kindOf(const rules::Param& p) {
    if (!p.choices.empty()) return Kind::Choice;
    switch (p.value.kind) {
        case Value::Kind::Bool:
            return Kind::Truth;
        case Value::Kind::Color:
            return Kind::Color;
        case Value::Kind::Number:
        case Value::Kind::Vector:
            return p.value.integer ? Kind::Integer : Kind::Real;
        case Value::Kind::Word:
        case Value::Kind::Text:
        case Value::Kind::Rotation:
        case Value::Kind::Axis:
            return Kind::Text;
    }
    return Kind::Text;
}

std::vector<double> numbersOf(const Value& v) {
    std::vector<double> numbers;
    for (size_t i = 0; i < v.count; ++i) numbers.push_back(rules::shown(v, i));
    return numbers;
}

/// Decimals that tell the values of a slider apart: 1/1000 of the range, or three where there is none.
int decimalsOf(const ParamRow& row, size_t i) {
    if (row.kind == Kind::Integer) return 0;
    const double range = row.lo.empty() ? 1 : row.hi[i] - row.lo[i];
    return range > 0 ? std::clamp(static_cast<int>(std::ceil(-std::log10(range / sliderSteps) - 1e-9)), 0, 12) : 3;
}

/// The number rounded to the slider's digits, unless it is one of the range's ends.
std::string numberText(const ParamRow& row, size_t i) {
    double v = row.number[i];
    if (!row.lo.empty()) v = std::clamp(v, row.lo[i], row.hi[i]);
    const bool end = !row.lo.empty() && (v == row.lo[i] || v == row.hi[i]);
    std::string text = end ? fmt::format("{:.12g}", v) : fmt::format("{:.{}f}", v, decimalsOf(row, i));
    if (!end && text.find('.') != std::string::npos) {
        text.erase(text.find_last_not_of('0') + 1);
        if (text.back() == '.') text.pop_back();
    }
    if (text == "-0") text = "0";
    return text + row.unit;
}

}  // namespace

std::vector<ParamRow> paramRows(const rules::Grammar& grammar, const derive::Options& options, const Choice& choice) {
    std::vector<ParamRow> rows;
    for (size_t i = 0; i < grammar.params.size(); ++i) {
        const rules::Param& p = grammar.params[i];
        const Value& value = i < options.params.size() ? options.params[i] : p.value;
        ParamRow row;
        row.kind = kindOf(p);
        row.name = p.name;
        row.label = p.label.empty() ? p.name : p.label;
        row.group = p.group;
        row.key = p.key.empty() ? '\0' : p.key[0];
        row.choices = p.choices;
        row.locked = choice.locked.contains(p.name);
        row.span = p.span;
        if (row.kind == Kind::Integer || row.kind == Kind::Real) {
            row.unit = rules::unitName(value.units[0]);
            row.number = numbersOf(value);
            if (p.lo && p.hi) row.lo = numbersOf(*p.lo), row.hi = numbersOf(*p.hi);
        } else if (row.kind == Kind::Truth) {
            row.number = {value.truth() ? 1.0 : 0.0};
        } else if (row.kind == Kind::Color) {
            row.color = {value.n[0], value.n[1], value.n[2]};
        } else {
            row.word =
                value.kind == Value::Kind::Text || value.kind == Value::Kind::Word ? value.text : rules::toText(value);
        }
        rows.push_back(std::move(row));
    }
    return rows;
}

std::string valueText(const ParamRow& row) {
    switch (row.kind) {
        case Kind::Truth:
            return row.number[0] != 0 ? "true" : "false";
        case Kind::Color:
            return fmt::format("#{:06x}", rules::hexFromLinear({row.color[0], row.color[1], row.color[2]}));
        case Kind::Choice:
            return row.word;
        case Kind::Text:
            return fmt::format("\"{}\"", row.word);
        case Kind::Integer:
        case Kind::Real:
            break;
    }
    std::vector<std::string> parts;
    for (size_t i = 0; i < row.number.size(); ++i) parts.push_back(numberText(row, i));
    // Without a point anywhere it would be read as a whole number.
    const bool whole = std::all_of(parts.begin(), parts.end(),
                                   [](const std::string& t) { return t.find_first_of(".e") == std::string::npos; });
    if (row.kind == Kind::Real && row.unit.empty() && whole) parts[0] += ".0";
    return parts.size() == 1 ? parts[0] : fmt::format("({})", fmt::join(parts, ", "));
}

edits::Edit setParams(const syntax::Ast& ast, const Choice& choice, const std::vector<ParamRow>& rows) {
    std::vector<edits::NamedValue> values;
    for (const ParamRow& row : rows) values.push_back({row.name, valueText(row)});
    const std::string start = !choice.start.empty() ? choice.start
                              : ast.starts.empty()  ? ""
                                                    : ast.starts[0].symbol.text;
    return edits::setValues(ast, start, choice.style, values);
}

ParamRow stepped(ParamRow row, bool back) {
    if (row.kind == Kind::Truth) row.number[0] = row.number[0] == 0;
    if (row.kind == Kind::Choice && !row.choices.empty()) {
        const auto at =
            static_cast<size_t>(std::find(row.choices.begin(), row.choices.end(), row.word) - row.choices.begin());
        row.word = row.choices[(at + (back ? row.choices.size() - 1 : 1)) % row.choices.size()];
    }
    if (row.kind != Kind::Integer && row.kind != Kind::Real) return row;
    for (size_t i = 0; i < row.number.size(); ++i) {
        const double step = row.kind == Kind::Integer ? 1 : row.lo.empty() ? 0.1 : (row.hi[i] - row.lo[i]) / keySteps;
        row.number[i] += back ? -step : step;
        if (!row.lo.empty()) row.number[i] = std::clamp(row.number[i], row.lo[i], row.hi[i]);
    }
    return row;
}

const ParamRow* rowOfKey(const std::vector<ParamRow>& rows, char key) {
    const auto row =
        std::find_if(rows.begin(), rows.end(), [&](const ParamRow& r) { return key != 0 && r.key == key; });
    return row == rows.end() ? nullptr : &*row;
}

std::vector<ParamRow> rerolled(std::vector<ParamRow> rows, uint64_t seed) {
    for (ParamRow& row : rows) {
        if (row.locked) continue;
        const uint64_t key = combine(mix(seed), hashText(row.name));
        if (row.kind == Kind::Truth) row.number[0] = static_cast<double>(pick(key, 2));
        if (row.kind == Kind::Choice && !row.choices.empty()) row.word = row.choices[pick(key, row.choices.size())];
        if ((row.kind != Kind::Integer && row.kind != Kind::Real) || row.lo.empty()) continue;
        for (size_t i = 0; i < row.number.size(); ++i) {
            const uint64_t draw = combine(key, i);
            row.number[i] =
                row.kind == Kind::Integer
                    ? row.lo[i] + static_cast<double>(pick(draw, static_cast<uint64_t>(row.hi[i] - row.lo[i]) + 1))
                    : uniform(draw, row.lo[i], row.hi[i]);
        }
    }
    return rows;
}

std::vector<std::string> stylesFor(const rules::Grammar& grammar, uint32_t start) {
    std::vector<std::string> names;
    for (const rules::Style& s : grammar.styles) {
        const bool fits = s.name != "default" && (s.start == rules::none || s.start == start);
        if (fits && std::find(names.begin(), names.end(), s.name) == names.end()) names.push_back(s.name);
    }
    return names;
}

std::vector<std::string> startsOf(const rules::Grammar& grammar) {
    std::vector<std::string> names;
    for (const rules::Start& s : grammar.starts) names.push_back(grammar.symbols[s.symbol].name);
    return names;
}

std::vector<std::string> waysOf(const rules::Grammar& grammar) {
    std::vector<std::string> names;
    for (const rules::Derive& d : grammar.derives) names.push_back(d.name);
    return names;
}

}  // namespace sgm::document
