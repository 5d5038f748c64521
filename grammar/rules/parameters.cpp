// Parameters: defaults, ranges and choices.
#include <fmt/format.h>

#include <algorithm>

#include "grammar/rules/declarations.h"
#include "grammar/rules/evaluate.h"
#include "grammar/rules/expressions.h"
#include "grammar/rules/lookup.h"
#include "grammar/rules/make.h"
#include "grammar/rules/params.h"
#include "grammar/rules/words.h"
#include "modeler/core/conventions.h"

namespace sgm::rules {
namespace {

using Written = syntax::Expr;

/// Plain numbers beside angles are degrees.
void takeAngles(std::initializer_list<Value*> values) {
    bool hasAngle = false, hasOther = false;
    const auto eachUnit = [&](auto visit) {
        for (Value* v : values)
            for (size_t i = 0; i < std::min<size_t>(v->count, v->units.size()); ++i) visit(*v, i);
    };
    eachUnit([&](const Value& v, size_t i) {
        hasAngle = hasAngle || v.units[i] == Unit::Angle;
        hasOther = hasOther || (v.units[i] != Unit::Angle && v.units[i] != Unit::None);
    });
    if (!hasAngle || hasOther) return;
    eachUnit([](Value& v, size_t i) {
        if (v.units[i] != Unit::None) return;
        v.n[i] = radians(v.n[i]);
        v.units[i] = Unit::Angle;
        v.integer = false;
    });
}

/// Calls `visit` with every number of a value that is no calculation: 3cm, -3cm, (1, 2, 3).
template <class Visit>
void eachNumber(const Written& e, const Visit& visit) {
    if (e.kind == Written::Kind::Number) visit(e);
    const bool holdsNumbers = e.kind == Written::Kind::Tuple || e.kind == Written::Kind::Range ||
                              (e.kind == Written::Kind::Unary && e.text == "-");
    if (holdsNumbers)
        for (const Written& arg : e.args) eachNumber(arg, visit);
}

/// Plain numbers are metres, which is hardly meant beside centimetres, millimetres or kilometres.
void warnOfPlainLengths(CheckContext& ctx, std::initializer_list<const Written*> values) {
    std::string unit;
    std::vector<const Written*> plain;
    for (const Written* value : values)
        eachNumber(*value, [&](const Written& number) {
            if (number.unit == "cm" || number.unit == "mm" || number.unit == "km") unit = number.unit;
            if (number.unit.empty() && number.number != 0) plain.push_back(&number);
        });
    if (unit.empty()) return;
    for (const Written* number : plain)
        ctx.diagnostics.warning(number->span, fmt::format("'{0:g}' beside {1} is {0:g}m", number->number, unit),
                                fmt::format("say its unit: '{0:g}{1}' or '{0:g}m'", number->number, unit));
}

void checkParameter(CheckContext& ctx, const syntax::ParamDecl& decl) {
    if (decl.range) warnOfPlainLengths(ctx, {&decl.value, &*decl.range});
    Param& param = ctx.grammar.params[ctx.names.params.at(decl.name.text)];
    param.label = decl.label;
    param.group = decl.group;
    param.key = decl.key.text;
    for (const syntax::Name& choice : decl.choices) {
        if (std::find(param.choices.begin(), param.choices.end(), choice.text) != param.choices.end())
            ctx.diagnostics.error(choice.span, fmt::format("'{}' is offered twice", choice.text));
        param.choices.push_back(choice.text);
    }
    if (!param.choices.empty()) {
        if (decl.range) ctx.diagnostics.error(decl.range->span, "a parameter has a range or choices, not both");
        param.value = makeWord(decl.value.text);
        const bool offered =
            std::find(param.choices.begin(), param.choices.end(), decl.value.text) != param.choices.end();
        if (decl.value.kind != Written::Kind::Error && (decl.value.kind != Written::Kind::Name || !offered))
            ctx.diagnostics.error(decl.value.span,
                                  fmt::format("the default '{}' is none of the choices {}", decl.value.span.text(),
                                              fmt::join(param.choices, ", ")),
                                  nearestHint(decl.value.text, param.choices));
        return;
    }
    const auto value = plainValue(ctx, decl.value, false);
    if (!value) {
        ctx.params.broken.insert(ctx.names.params.at(decl.name.text));
        return;
    }
    param.value = *value;
    if (!decl.range) return;
    if (value->kind != Value::Kind::Number && value->kind != Value::Kind::Vector) {
        ctx.diagnostics.error(decl.range->span, fmt::format("a range belongs to a number, but '{}' is {}", param.name,
                                                            describe(Type::of(*value))));
        return;
    }
    if (decl.range->kind != Written::Kind::Range) {
        if (decl.range->kind != Written::Kind::Error)
            ctx.diagnostics.error(decl.range->span, "'in' takes a range", "write 'in 0..1'");
        return;
    }
    auto lo = plainValue(ctx, decl.range->args[0], false), hi = plainValue(ctx, decl.range->args[1], false);
    if (!lo || !hi) return;
    takeAngles({&param.value, &*lo, &*hi});
    if (const std::string problem = setRange(param, *lo, *hi); !problem.empty())
        ctx.diagnostics.error(decl.range->span, problem);
    else if (const auto fitted = conform(param, param.value); !fitted.ok()) {
        const bool isPlain = value->kind == Value::Kind::Number && value->units[0] == Unit::None;
        ctx.diagnostics.error(decl.value.span, fitted.error().message,
                              isPlain && hi->units[0] == Unit::Share ? fmt::format("write '{:g}%'", value->num()) : "");
        ctx.params.broken.insert(ctx.names.params.at(decl.name.text));
    } else if (param.value.integer && param.value.count == 1 && param.lo->num() == 0 && param.hi->num() == 1) {
        ctx.diagnostics.warning(decl.range->span,
                                fmt::format("'{}' is a whole number, so it is 0 or 1 and nothing between", param.name),
                                "write '0..1.0' for a real number, or 'true' for a switch");
    }
}

/// `use "file" { name = value }`: other defaults for the parameters of the files used.
void applyUsedDefaults(CheckContext& ctx, const syntax::Ast& ast) {
    for (const syntax::UseDecl& use : ast.uses)
        for (const Setting& s : checkSettings(ctx, use.settings)) {
            Param& p = ctx.grammar.params[s.param];
            if (p.span.source == ast.source.get()) {
                ctx.diagnostics.error(s.span, fmt::format("'{}' is this file's own parameter", p.name),
                                      "give it another default where it is declared");
                continue;
            }
            p.value = s.value;
            p.valueSpan = s.valueSpan;
        }
}

}  // namespace

std::vector<Setting> checkSettings(CheckContext& ctx, const std::vector<syntax::Setting>& written) {
    std::vector<Setting> result;
    for (const syntax::Setting& s : written) {
        if (s.name.empty()) continue;  // the parser spoke of it
        const auto param = ctx.names.params.find(s.name.text);
        if (param == ctx.names.params.end()) {
            std::vector<std::string> known;
            for (const Param& p : ctx.grammar.params) known.push_back(p.name);
            failUnknown(ctx, s.name.span, s.name.text, fmt::format("there is no parameter '{}'", s.name.text),
                        nearestHint(s.name.text, known));
            continue;
        }
        const Param& p = ctx.grammar.params[param->second];
        if (ctx.params.broken.contains(param->second)) continue;
        if (std::any_of(result.begin(), result.end(), [&](const Setting& r) { return r.param == param->second; }))
            ctx.diagnostics.error(s.span, fmt::format("'{}' is set twice", p.name));
        const auto value = plainValue(ctx, s.value, !p.choices.empty());
        if (!value) continue;
        const auto fitted = conform(p, *value);
        if (!fitted.ok())
            ctx.diagnostics.error(s.value.span, fitted.error().message, nearestHint(value->text, p.choices));
        else
            result.push_back({param->second, *fitted, s.span, s.value.span});
    }
    return result;
}

void checkParameters(CheckContext& ctx, const syntax::Ast& ast) {
    applyUsedDefaults(ctx, ast);
    for (const auto& decl : ast.params)
        if (const auto seen = ctx.seen.params.find(decl.name.text); seen != ctx.seen.params.end() &&
                                                                    seen->second.begin == decl.name.span.begin &&
                                                                    seen->second.source == decl.name.span.source)
            checkParameter(ctx, decl);
    ctx.params.defaults.clear();
    for (const Param& p : ctx.grammar.params) ctx.params.defaults.push_back(p.value);
}

}  // namespace sgm::rules
