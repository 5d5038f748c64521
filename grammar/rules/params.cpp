#include "grammar/rules/params.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "grammar/rules/check.h"
#include "grammar/rules/evaluate.h"
#include "grammar/rules/type.h"
#include "grammar/syntax/parser.h"
#include "modeler/core/conventions.h"
#include "modeler/core/decimal.h"

namespace sgm::rules {
namespace {

bool numeric(const Value& v) { return v.kind == Value::Kind::Number || v.kind == Value::Kind::Vector; }

/// `value` with the unit of `like` where it has none, spread over as many components.
Value adopted(const Value& value, const Value& like) {
    Value result = like;
    result.integer = value.integer;
    for (size_t i = 0; i < std::min<size_t>(like.count, value.units.size()); ++i) {
        const size_t j = value.count > 1 ? i : 0;
        result.n[i] = value.n[j];
        if (value.units[j] != Unit::None) result.units[i] = value.units[j];
    }
    return result;
}

/// A plain number where its fellows are angles would be taken for radians: what to write instead, or "".
std::string bareAngle(const Value& value, const Value& like) {
    for (size_t i = 0; i < std::min<size_t>(value.count, value.units.size()); ++i) {
        const Unit wanted = like.units[like.count > 1 ? std::min<size_t>(i, like.count - 1u) : 0];
        if (wanted == Unit::Angle && value.units[i] == Unit::None && value.n[i] != 0)
            return fmt::format("an angle needs its unit: write '{:g}deg'", value.n[i]);
    }
    return {};
}

std::string outOfRange(const Param& param, const Value& value) {
    for (size_t i = 0; i < value.count; ++i)
        if (value.n[i] < param.lo->n[i] || value.n[i] > param.hi->n[i])
            return fmt::format("'{}' is {}, outside its range {}..{}", param.name,
                               toText(component(value, Value::number(static_cast<double>(i)))),
                               toText(component(*param.lo, Value::number(static_cast<double>(i)))),
                               toText(component(*param.hi, Value::number(static_cast<double>(i)))));
    return {};
}

nlohmann::ordered_json jsonOf(const Value& v) {
    const auto one = [&](size_t i) -> nlohmann::ordered_json {
        constexpr double mostExact = 9007199254740992.0;  // 2⁵³: larger ones needn't be whole
        const double number = shown(v, i);
        if (v.integer && std::abs(number) <= mostExact) return static_cast<int64_t>(number);
        return number;
    };
    switch (v.kind) {
        case Value::Kind::Number:
            return one(0);
        case Value::Kind::Bool:
            return v.truth();
        case Value::Kind::Word:
        case Value::Kind::Text:
            return v.text;
        case Value::Kind::Vector: {
            auto list = nlohmann::ordered_json::array();
            for (size_t i = 0; i < v.count; ++i) list.push_back(one(i));
            return list;
        }
        default:
            return toText(v);
    }
}

}  // namespace

std::string setRange(Param& param, const Value& lo, const Value& hi) {
    for (const Value* end : {&lo, &hi})
        if (!numeric(*end) || (end->count != 1 && end->count != param.value.count) ||
            !compatible(Type::of(*end), Type::of(param.value)) || !compatible(Type::of(lo), Type::of(hi)))
            return fmt::format("the range of '{}' must be of the same kind as its default {}", param.name,
                               toText(param.value));
    const Value* const given[] = {&param.value, &lo, &hi};
    for (const Value* one : given)
        for (const Value* like : given)
            if (std::string problem = bareAngle(*one, *like); !problem.empty()) return problem;
    param.value = adopted(param.value, adopted(lo, adopted(hi, param.value)));
    param.lo = adopted(lo, param.value);
    param.hi = adopted(hi, param.value);
    param.value.integer = param.lo->integer = param.hi->integer = param.value.integer && lo.integer && hi.integer;
    for (size_t i = 0; i < param.lo->count; ++i)
        if (param.lo->n[i] > param.hi->n[i]) return fmt::format("the range of '{}' runs backwards", param.name);
    return {};
}

Result<Value> conformKind(const Param& param, Value value) {
    const auto refuse = [&](std::string message) { return Error{Error::Kind::Input, std::move(message)}; };
    const Type type = Type::of(value), wanted = Type::of(param.value);
    const bool spread = value.kind == Value::Kind::Number && param.value.kind == Value::Kind::Vector;
    if (value.kind != param.value.kind && !spread)
        return refuse(fmt::format("'{}' is {}, but this is {}", param.name, describe(wanted), describe(type)));
    if (!numeric(value)) return value;
    if ((value.count != param.value.count && !spread) || !compatible(type, wanted))
        return refuse(fmt::format("'{}' is {}, but this is {}", param.name, describe(wanted), describe(type)));
    const auto isWhole = [&] {
        return std::all_of(value.n.begin(), value.n.begin() + static_cast<ptrdiff_t>(value.count),
                           [](double n) { return n == std::floor(n); });
    };
    if (param.value.integer && !value.integer && !isWhole())
        return refuse(fmt::format(
            "'{}' is a whole number, not {}: with a point in its default or range (0..1.0) it would be a real one",
            param.name, toText(value)));
    if (std::string problem = bareAngle(value, param.value); !problem.empty()) return refuse(std::move(problem));
    Value fitted = adopted(value, param.value);
    fitted.integer = param.value.integer;
    for (size_t i = 0; i < fitted.count; ++i)
        if (fitted.units[std::min(i, fitted.units.size() - 1)] !=
            param.value.units[std::min(i, fitted.units.size() - 1)])
            return refuse(fmt::format("'{}' is {}, but this is {}", param.name, describe(wanted), describe(type)));
    return fitted;
}

Result<Value> conform(const Param& param, Value value) {
    if (!param.choices.empty()) {
        if (value.kind == Value::Kind::Word &&
            std::find(param.choices.begin(), param.choices.end(), value.text) != param.choices.end())
            return value;
        return Error{Error::Kind::Input,
                     fmt::format("'{}' is one of {}, not '{}'", param.name, fmt::join(param.choices, ", "),
                                 value.kind == Value::Kind::Word ? value.text : toText(value))};
    }
    auto fitted = conformKind(param, std::move(value));
    if (fitted.ok() && numeric(*fitted) && param.lo && param.hi)
        if (std::string problem = outOfRange(param, *fitted); !problem.empty())
            return Error{Error::Kind::Input, std::move(problem)};
    return fitted;
}

std::vector<Value> valuesOf(const Grammar& grammar, uint32_t start) {
    std::vector<Value> values;
    for (const Param& p : grammar.params) values.push_back(p.value);
    if (const Style* style = findStyle(grammar, "default", start))
        for (const Setting& s : style->settings) values[s.param] = s.value;
    return values;
}

const Style* findStyle(const Grammar& grammar, const std::string& name, uint32_t start) {
    const Style* found = nullptr;
    for (const Style& s : grammar.styles)
        if (s.name == name && (s.start == start || (s.start == none && !found))) found = &s;
    return found;
}

double shown(const Value& v, size_t i) {
    const Unit unit = v.units[std::min(i, v.units.size() - 1)];
    // Through text: 0.3 % stays 0.3, 12 degrees stay 12.
    const double raw = unit == Unit::Angle ? degrees(v.n[i]) : unit == Unit::Share ? v.n[i] * 100 : v.n[i];
    return decimalOf(fmt::format("{:.12g}", raw));
}

std::string_view kindName(const Value& v) {
    switch (v.kind) {
        case Value::Kind::Number:
            return v.integer ? "integer" : "real";
        case Value::Kind::Vector:
            return "vector";
        case Value::Kind::Bool:
            return "boolean";
        case Value::Kind::Color:
            return "color";
        case Value::Kind::Word:
            return "choice";
        case Value::Kind::Text:
            return "text";
        case Value::Kind::Rotation:
            return "rotation";
        case Value::Kind::Axis:
            return "axis";
    }
    return {};
}

std::string_view unitName(Unit unit) {
    switch (unit) {
        case Unit::Metre:
            return "m";
        case Unit::Angle:
            return "deg";
        case Unit::Share:
            return "%";
        case Unit::PerMetre:
            return "/m";
        case Unit::SquareMetre:
            return "m2";
        case Unit::CubicMetre:
            return "m3";
        default:
            return "";
    }
}

namespace {

constexpr auto replaceInvalid = nlohmann::ordered_json::error_handler_t::replace;

nlohmann::ordered_json parametersOf(const Grammar& grammar) {
    auto list = nlohmann::ordered_json::array();
    const std::vector<Value> values = valuesOf(grammar, 0);
    for (const Param& p : grammar.params) {
        nlohmann::ordered_json entry{{"name", p.name}, {"kind", kindName(p.value)}};
        const std::string_view unit = numeric(p.value) ? unitName(p.value.units[0]) : "";
        if (!unit.empty()) entry["unit"] = unit;
        entry["default"] = jsonOf(values[static_cast<size_t>(&p - grammar.params.data())]);
        if (p.lo) entry["minimum"] = jsonOf(*p.lo);
        if (p.hi) entry["maximum"] = jsonOf(*p.hi);
        if (!p.choices.empty()) entry["choices"] = p.choices;
        if (!p.label.empty()) entry["label"] = p.label;
        if (!p.group.empty()) entry["group"] = p.group;
        if (!p.key.empty()) entry["key"] = p.key;
        if (p.span.source) {
            entry["file"] = p.span.source->name();
            entry["line"] = p.span.source->place(p.span.begin).line;
        }
        list.push_back(std::move(entry));
    }
    return list;
}

nlohmann::ordered_json settingsOf(const Grammar& grammar, const Style& style) {
    auto values = nlohmann::ordered_json::object();
    for (const Setting& s : style.settings) values[grammar.params[s.param].name] = jsonOf(s.value);
    return values;
}

const std::string& nameOf(const Grammar& grammar, uint32_t start) {
    return grammar.symbols[grammar.starts[start].symbol].name;
}

}  // namespace

std::string paramsJson(const Grammar& grammar) { return parametersOf(grammar).dump(2, ' ', false, replaceInvalid); }

std::string panelJson(const Grammar& grammar) {
    nlohmann::ordered_json panel{{"parameters", parametersOf(grammar)}};
    auto starts = nlohmann::ordered_json::array(), styles = starts, ways = starts;
    for (uint32_t i = 0; i < grammar.starts.size(); ++i) {
        nlohmann::ordered_json start{{"name", nameOf(grammar, i)}};
        const Style* usual = findStyle(grammar, "default", i);
        start["values"] = usual ? settingsOf(grammar, *usual) : nlohmann::ordered_json::object();
        starts.push_back(std::move(start));
    }
    for (const Style& s : grammar.styles) {
        if (s.name == "default") continue;
        nlohmann::ordered_json style{{"name", s.name}};
        if (s.start != none) style["start"] = nameOf(grammar, s.start);
        style["values"] = settingsOf(grammar, s);
        styles.push_back(std::move(style));
    }
    for (const Derive& way : grammar.derives) ways.push_back(way.name);
    panel["starts"] = std::move(starts);
    panel["styles"] = std::move(styles);
    panel["ways"] = std::move(ways);
    return panel.dump(2, ' ', false, replaceInvalid);
}

}  // namespace sgm::rules
