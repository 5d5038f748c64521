// Parameters, terminals, derivations, styles and checks.
#include <fmt/format.h>

#include <algorithm>

#include "grammar/rules/bodies.h"
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

Vec3d vectorOf(const Value& v) { return {v.n[0], v.n[1], v.n[2]}; }

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
template <class Expr, class Visit>
void eachNumber(Expr& e, const Visit& visit) {
    if (e.kind == Written::Kind::Number) visit(e);
    const bool holdsNumbers = e.kind == Written::Kind::Tuple || e.kind == Written::Kind::Range ||
                              (e.kind == Written::Kind::Unary && e.text == "-");
    if (holdsNumbers)
        for (auto& arg : e.args) eachNumber(arg, visit);
}

/// Plain numbers beside centimetres, millimetres or kilometres are such too. An error where two of them stand.
void takeLengths(CheckContext& ctx, std::initializer_list<Written*> values) {
    std::string unit, other;
    const Written* plain = nullptr;
    const auto note = [&](const Written& number) {
        if (number.unit.empty() && number.number != 0) plain = &number;
        if (number.unit.empty() || number.unit == unit) return;
        (unit.empty() ? unit : other) = number.unit;
    };
    for (const Written* value : values) eachNumber(*value, note);
    if (unit != "cm" && unit != "mm" && unit != "km" && other != "cm" && other != "mm" && other != "km") return;
    if (!other.empty()) {
        if (plain)
            ctx.diagnostics.error(
                plain->span, fmt::format("'{:g}' stands beside {} and {}", plain->number, unit, other),
                fmt::format("say its unit: '{:g}{}' or '{:g}{}'", plain->number, unit, plain->number, other));
        return;
    }
    for (Written* value : values)
        eachNumber(*value, [&](Written& number) {
            if (number.unit.empty()) number.unit = unit;
        });
}

void checkParameter(CheckContext& ctx, const syntax::ParamDecl& written) {
    syntax::ParamDecl decl = written;
    if (decl.range) takeLengths(ctx, {&decl.value, &*decl.range});
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

void checkDeclaredJoint(CheckContext& ctx, const syntax::TerminalDecl::JointDecl& decl, std::vector<Joint>& joints) {
    Joint joint;
    joint.name = decl.name.text;
    if (axisNumber(joint.name) >= 0 || isTaken(joint.name))
        ctx.diagnostics.error(decl.name.span,
                              fmt::format("'{}' is a word of the language and can't name a joint", joint.name));
    if (std::any_of(joints.begin(), joints.end(), [&](const Joint& j) { return j.name == joint.name; }))
        ctx.diagnostics.error(decl.name.span, fmt::format("there is already a joint '{}'", joint.name));
    if (const auto at = plainValue(ctx, decl.at, false)) {
        if (at->kind != Value::Kind::Vector || at->count != 3 || !fits(Type::of(*at), Want::Triple))
            ctx.diagnostics.error(decl.at.span,
                                  "a joint stands at a point (x, y, z), in shares of the solid's size from its centre");
        joint.at = vectorOf(*at) * 2.0;  // written in the unit solid, −.5 … .5; held in half-sizes
    }
    if (const auto facing = plainValue(ctx, decl.facing, false)) {
        const int axis = facing->kind == Value::Kind::Axis ? static_cast<int>(facing->num()) : -1;
        if (axis >= 0 && axis < 6)
            joint.facing[axis / 2] = axis % 2 ? -1 : 1;
        else if (facing->kind == Value::Kind::Vector && facing->count == 3)
            joint.facing = normalized(vectorOf(*facing));
        else if (axis != 6)
            ctx.diagnostics.error(decl.facing.span,
                                  "a joint faces a direction such as -z or (1, 1, 0), or 'centre' to meet any other");
    }
    joints.push_back(std::move(joint));
}

void checkLook(CheckContext& ctx, const syntax::TerminalDecl& decl, Material& material, std::vector<Attribute>& open) {
    Place place(Place::Where::Look);
    Element none;
    for (const Attribute& a : checkAttributes(ctx, place, none, decl.attributes)) {
        if (a.operation->phase != Operation::Phase::Look) {
            ctx.diagnostics.error(
                a.span,
                fmt::format("a terminal has a colour, a roughness, a metalness and joints, but no '{}'",
                            a.operation->name),
                "say it where the terminal is used");
            continue;
        }
        if (a.args.empty()) continue;
        const auto value = fold(a.args[0], ctx.params.defaults);
        if (!value) continue;
        const bool isMaterial = a.operation->arguments[0].type == syntax::ArgumentType::Material;
        if (isMaterial && value->kind == Value::Kind::Word) {  // of: the look of a material declared above
            const SymbolId base = findMaterial(ctx.grammar, value->text);
            if (base == rules::none || ctx.grammar.symbols[base].material == rules::none || !fold(a.args[0], {})) {
                ctx.diagnostics.error(a.span, fmt::format("'{}' is no material declared above", value->text),
                                      "name a material whose line stands before this one");
                continue;
            }
            const std::string name = material.name;
            material = ctx.grammar.materials[ctx.grammar.symbols[base].material];
            material.name = name;
            open = ctx.grammar.symbols[base].look;
            continue;
        }
        const bool isFile = value->kind == Value::Kind::Text;
        if (a.operation->decorate && !isFile) a.operation->decorate(*value, material);
        if (!a.operation->decorate || isFile || !fold(a.args[0], {})) open.push_back(a);
    }
}

void checkTerminal(CheckContext& ctx, const syntax::TerminalDecl& decl) {
    Material material;
    std::vector<Attribute> open;
    checkLook(ctx, decl, material, open);
    std::vector<Joint> joints;
    for (const auto& joint : decl.joints) checkDeclaredJoint(ctx, joint, joints);
    bool first = true;
    for (const syntax::Name& name : decl.names) {
        const auto owner = ctx.names.terminals.find(name.text);
        if (owner == ctx.names.terminals.end() || owner->second != &decl) continue;
        Symbol& symbol = ctx.grammar.symbols[ctx.names.symbols.at(name.text)];
        symbol.joints = joints;
        symbol.look = open;
        if (!decl.attributes.empty()) {
            material.name = name.text;
            symbol.material = static_cast<uint32_t>(ctx.grammar.materials.size());
            ctx.grammar.materials.push_back(material);
        }
        if (decl.solid)
            symbol.solid =
                first ? terminalSolid(ctx, name) : ctx.grammar.symbols[ctx.names.symbols.at(decl.names[0].text)].solid;
        first = false;
    }
}

uint32_t findStart(CheckContext& ctx, const syntax::Name& name) {
    if (name.empty()) return none;
    std::vector<std::string> known;
    for (size_t i = 0; i < ctx.grammar.starts.size(); ++i) {
        known.push_back(ctx.grammar.symbols[ctx.grammar.starts[i].symbol].name);
        if (known.back() == name.text) return static_cast<uint32_t>(i);
    }
    failUnknown(ctx, name.span, name.text, fmt::format("there is no start '{}'", name.text),
                nearestHint(name.text, known));
    return none;
}

void checkStepPlace(CheckContext& ctx, const syntax::DeriveDecl::Step& step) {
    std::string_view rest = step.place;
    while (!rest.empty()) {
        const size_t end = std::min(rest.find('/'), rest.size());
        const std::string name(rest.substr(0, std::min(rest.find('['), end)));
        if (!ctx.names.symbols.contains(name) && !field::findPrimitive(name) && name != "morph" && name != "group") {
            failUnknown(ctx, step.at.span, name, fmt::format("no shape is called '{}'", name),
                        nearestHint(name, symbolNames(ctx, false)));
            return;
        }
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
}

void checkDerive(CheckContext& ctx, const syntax::DeriveDecl& decl) {
    if (isDeclaredTwice(ctx, ctx.seen.derives, decl.name, "derivation")) return;
    Derive out;
    out.name = decl.name.text;
    out.span = decl.span;
    std::vector<std::string> known;
    for (const auto& [name, rule] : ctx.names.rules) known.push_back(name);
    for (const auto& step : decl.steps) {
        if (step.rule.empty()) continue;
        const auto rule = ctx.names.rules.find(step.rule.text);
        if (rule == ctx.names.rules.end()) {
            failUnknown(ctx, step.rule.span, step.rule.text, fmt::format("there is no rule named '{}'", step.rule.text),
                        nearestHint(step.rule.text, known));
            continue;
        }
        checkStepPlace(ctx, step);
        out.steps.push_back({rule->second, step.place, step.rule.span});
    }
    ctx.grammar.derives.push_back(std::move(out));
}

}  // namespace

std::optional<Value> plainValue(CheckContext& ctx, const Written& e, bool word) {
    if (word && e.kind == Written::Kind::Name) return makeWord(e.text);
    Place place(Place::Where::Constant);
    const Typed typed = checkExpression(ctx, place, e);
    return typed.type.known ? fold(typed.expr, {}) : std::nullopt;
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

void checkTerminals(CheckContext& ctx, const syntax::Ast& ast) {
    for (const auto& decl : ast.terminals)
        if (!decl.isMaterial) checkTerminal(ctx, decl);
}

void checkMaterials(CheckContext& ctx, const syntax::Ast& ast) {
    for (const auto& decl : ast.terminals) {
        if (!decl.isMaterial) continue;
        if (decl.attributes.empty())
            ctx.diagnostics.error(decl.span, "a material says how it looks",
                                  "write 'material stone color #c2b59b rough .9'");
        checkTerminal(ctx, decl);
    }
}

/// Constants of a file: each asks parameters and those above it.
void checkLets(CheckContext& ctx, const syntax::Ast& ast) {
    constexpr size_t most = 1000;
    const auto sizeOf = [](const Expr& e, const auto& self) -> size_t {
        size_t count = 1;
        for (const Expr& arg : e.args) count += self(arg, self);
        return count;
    };
    for (const auto& decl : ast.lets) {
        const auto known = ctx.names.lets.find(decl.name.text);
        if (known == ctx.names.lets.end() || known->second.decl != &decl) continue;
        Place place(Place::Where::Look);
        place.material = true;
        Typed typed = checkExpression(ctx, place, decl.value);
        if (sizeOf(typed.expr, sizeOf) > most)
            typed = fail(ctx, decl.value.span, fmt::format("a value is made of at most {} numbers and operators", most),
                         "use fewer of the values above it");
        known->second.value = std::move(typed);
    }
}

void checkDeclarations(CheckContext& ctx, const syntax::Ast& ast) {
    for (const auto& decl : ast.derives) checkDerive(ctx, decl);
    for (const auto& decl : ast.styles) {
        const bool plain = decl.start.empty();
        if (isDeclaredTwice(ctx, ctx.seen.styles,
                            {decl.name.text + (plain ? "" : " for " + decl.start.text), decl.name.span}, "style"))
            continue;
        ctx.grammar.styles.push_back(
            {decl.name.text, plain ? none : findStart(ctx, decl.start), checkSettings(ctx, decl.settings), decl.span});
    }
    for (const auto& decl : ast.checks) {
        Check out;
        out.span = decl.span;
        out.start = findStart(ctx, decl.start);
        out.settings = checkSettings(ctx, decl.settings);
        Place place(Place::Where::Expect);
        if (decl.expect) out.expect = checkExpression(ctx, place, *decl.expect, Want::Truth, "'expect'");
        ctx.grammar.checks.push_back(std::move(out));
    }
}

void warnOfUnused(CheckContext& ctx, const syntax::Ast& ast) {
    for (const auto& decl : ast.params)
        if (const auto param = ctx.names.params.find(decl.name.text);
            param != ctx.names.params.end() && !ctx.params.used.contains(param->second))
            ctx.diagnostics.warning(decl.name.span, fmt::format("nothing uses the parameter '{}'", decl.name.text));
    for (const auto& decl : ast.lets)
        if (const auto let = ctx.names.lets.find(decl.name.text); let != ctx.names.lets.end() && !let->second.used)
            ctx.diagnostics.warning(decl.name.span, fmt::format("nothing uses the value '{}'", decl.name.text));
    for (const auto& [name, value] : ctx.names.inherited) {
        if (!value.span.source || value.used) continue;
        const bool isHidden = ctx.names.lets.contains(name), isWord = ast.operations && ast.operations->find(name);
        ctx.diagnostics.warning(value.span,
                                fmt::format("nothing reads '{}', which 'with' sets for the shapes below", name),
                                isHidden ? "the file's own value of that name is read instead: give one of them another"
                                : isWord ? fmt::format("write '{} …' without 'with' and '='", name)
                                         : "");
    }
}

}  // namespace sgm::rules
