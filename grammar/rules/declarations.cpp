// Parameters, terminals, derivations, styles and checks.
#include <fmt/format.h>

#include <algorithm>

#include "grammar/rules/checker.h"
#include "grammar/rules/evaluate.h"
#include "grammar/rules/lookup.h"
#include "grammar/rules/make.h"
#include "grammar/rules/params.h"
#include "grammar/rules/words.h"

namespace sgm::rules {
namespace {

using Written = syntax::Expr;

Vec3d vectorOf(const Value& v) { return {v.n[0], v.n[1], v.n[2]}; }

}  // namespace

std::optional<Value> Checker::plain(const Written& e, bool word) {
    if (word && e.kind == Written::Kind::Name) return makeWord(e.text);
    Place place(Place::Where::Constant);
    const Typed typed = expression(place, e);
    return typed.type.known ? fold(typed.expr, {}) : std::nullopt;
}

void Checker::parameter(const syntax::ParamDecl& decl) {
    Param& param = grammar_.params[params_.at(decl.name.text)];
    param.label = decl.label;
    param.group = decl.group;
    param.key = decl.key.text;
    for (const syntax::Name& choice : decl.choices) {
        if (std::find(param.choices.begin(), param.choices.end(), choice.text) != param.choices.end())
            diagnostics_.error(choice.span, fmt::format("'{}' is offered twice", choice.text));
        param.choices.push_back(choice.text);
    }
    if (!param.choices.empty()) {
        if (decl.range) diagnostics_.error(decl.range->span, "a parameter has a range or choices, not both");
        param.value = makeWord(decl.value.text);
        const bool offered =
            std::find(param.choices.begin(), param.choices.end(), decl.value.text) != param.choices.end();
        if (decl.value.kind != Written::Kind::Error && (decl.value.kind != Written::Kind::Name || !offered))
            diagnostics_.error(decl.value.span,
                               fmt::format("the default '{}' is none of the choices {}", decl.value.span.text(),
                                           fmt::join(param.choices, ", ")),
                               nearest(decl.value.text, param.choices));
        return;
    }
    const auto value = plain(decl.value, false);
    if (!value) {
        brokenParams_.insert(params_.at(decl.name.text));
        return;
    }
    param.value = *value;
    if (!decl.range) return;
    if (value->kind != Value::Kind::Number && value->kind != Value::Kind::Vector) {
        diagnostics_.error(decl.range->span, fmt::format("a range belongs to a number, but '{}' is {}", param.name,
                                                         describe(Type::of(*value))));
        return;
    }
    if (decl.range->kind != Written::Kind::Range) {
        if (decl.range->kind != Written::Kind::Error)
            diagnostics_.error(decl.range->span, "'in' takes a range", "write 'in 0..1'");
        return;
    }
    const auto lo = plain(decl.range->args[0], false), hi = plain(decl.range->args[1], false);
    if (!lo || !hi) return;
    if (const std::string problem = setRange(param, *lo, *hi); !problem.empty())
        diagnostics_.error(decl.range->span, problem);
    else if (const auto fitted = conform(param, param.value); !fitted.ok()) {
        diagnostics_.error(decl.value.span, fitted.error().message);
        brokenParams_.insert(params_.at(decl.name.text));
    } else if (param.value.integer && param.value.count == 1 && param.lo->num() == 0 && param.hi->num() == 1) {
        diagnostics_.warning(decl.range->span,
                             fmt::format("'{}' is a whole number, so it is 0 or 1 and nothing between", param.name),
                             "write '0..1.0' for a real number, or 'true' for a switch");
    }
}

/// `use "file" { name = value }`: other defaults for the parameters of the files used.
void Checker::usedDefaults(const syntax::Ast& ast) {
    for (const syntax::UseDecl& use : ast.uses)
        for (const Setting& s : settings(use.settings)) {
            Param& p = grammar_.params[s.param];
            if (p.span.source == ast.source.get()) {
                diagnostics_.error(s.span, fmt::format("'{}' is this file's own parameter", p.name),
                                   "give it another default where it is declared");
                continue;
            }
            p.value = s.value;
            p.valueSpan = s.valueSpan;
        }
}

void Checker::parameters(const syntax::Ast& ast) {
    usedDefaults(ast);
    for (const auto& decl : ast.params)
        if (const auto seen = seenParams_.find(decl.name.text); seen != seenParams_.end() &&
                                                                seen->second.begin == decl.name.span.begin &&
                                                                seen->second.source == decl.name.span.source)
            parameter(decl);
    defaults_.clear();
    for (const Param& p : grammar_.params) defaults_.push_back(p.value);
}

void Checker::declaredJoint(const syntax::TerminalDecl::JointDecl& decl, std::vector<Joint>& joints) {
    Joint joint;
    joint.name = decl.name.text;
    if (axisNumber(joint.name) >= 0 || isTaken(joint.name))
        diagnostics_.error(decl.name.span,
                           fmt::format("'{}' is a word of the language and can't name a joint", joint.name));
    if (std::any_of(joints.begin(), joints.end(), [&](const Joint& j) { return j.name == joint.name; }))
        diagnostics_.error(decl.name.span, fmt::format("there is already a joint '{}'", joint.name));
    if (const auto at = plain(decl.at, false)) {
        if (at->kind != Value::Kind::Vector || at->count != 3 || !fits(Type::of(*at), Want::Triple))
            diagnostics_.error(decl.at.span,
                               "a joint stands at a point (x, y, z), in shares of the solid's size from its centre");
        joint.at = vectorOf(*at) * 2.0;  // written in the unit solid, −.5 … .5; held in half-sizes
    }
    if (const auto facing = plain(decl.facing, false)) {
        const int axis = facing->kind == Value::Kind::Axis ? static_cast<int>(facing->num()) : -1;
        if (axis >= 0 && axis < 6)
            joint.facing[axis / 2] = axis % 2 ? -1 : 1;
        else if (facing->kind == Value::Kind::Vector && facing->count == 3)
            joint.facing = normalized(vectorOf(*facing));
        else if (axis != 6)
            diagnostics_.error(decl.facing.span,
                               "a joint faces a direction such as -z or (1, 1, 0), or 'centre' to meet any other");
    }
    joints.push_back(std::move(joint));
}

void Checker::look(const syntax::TerminalDecl& decl, Material& material, std::vector<Attribute>& open) {
    Place place(Place::Where::Look);
    Element none;
    for (const Attribute& a : attributes(place, none, decl.attributes)) {
        if (a.operation->phase != Operation::Phase::Look) {
            diagnostics_.error(a.span,
                               fmt::format("a terminal has a colour, a roughness, a metalness and joints, but no '{}'",
                                           a.operation->name),
                               "say it where the terminal is used");
            continue;
        }
        if (a.args.empty()) continue;
        const auto value = fold(a.args[0], defaults_);
        if (!value) continue;
        const bool isMaterial = a.operation->arguments[0].type == syntax::ArgumentType::Material;
        if (isMaterial && value->kind == Value::Kind::Word) {  // of: the look of a material declared above
            const SymbolId base = findMaterial(grammar_, value->text);
            if (base == rules::none || grammar_.symbols[base].material == rules::none || !fold(a.args[0], {})) {
                diagnostics_.error(a.span, fmt::format("'{}' is no material declared above", value->text),
                                   "name a material whose line stands before this one");
                continue;
            }
            const std::string name = material.name;
            material = grammar_.materials[grammar_.symbols[base].material];
            material.name = name;
            open = grammar_.symbols[base].look;
            continue;
        }
        const bool isFile = value->kind == Value::Kind::Text;
        if (a.operation->decorate && !isFile) a.operation->decorate(*value, material);
        if (!a.operation->decorate || isFile || !fold(a.args[0], {})) open.push_back(a);
    }
}

void Checker::terminal(const syntax::TerminalDecl& decl) {
    Material material;
    std::vector<Attribute> open;
    look(decl, material, open);
    std::vector<Joint> joints;
    for (const auto& joint : decl.joints) declaredJoint(joint, joints);
    bool first = true;
    for (const syntax::Name& name : decl.names) {
        const auto owner = terminalDecls_.find(name.text);
        if (owner == terminalDecls_.end() || owner->second != &decl) continue;
        Symbol& symbol = grammar_.symbols[symbols_.at(name.text)];
        symbol.joints = joints;
        symbol.look = open;
        if (!decl.attributes.empty()) {
            material.name = name.text;
            symbol.material = static_cast<uint32_t>(grammar_.materials.size());
            grammar_.materials.push_back(material);
        }
        if (decl.solid)
            symbol.solid = first ? terminalSolid(name) : grammar_.symbols[symbols_.at(decl.names[0].text)].solid;
        first = false;
    }
}

void Checker::terminals(const syntax::Ast& ast) {
    for (const auto& decl : ast.terminals)
        if (!decl.isMaterial) terminal(decl);
}

void Checker::materials(const syntax::Ast& ast) {
    for (const auto& decl : ast.terminals) {
        if (!decl.isMaterial) continue;
        if (decl.attributes.empty())
            diagnostics_.error(decl.span, "a material says how it looks",
                               "write 'material stone color #c2b59b rough .9'");
        terminal(decl);
    }
}

/// Constants of a file: each asks parameters and those above it.
void Checker::lets(const syntax::Ast& ast) {
    constexpr size_t most = 1000;
    const auto sizeOf = [](const Expr& e, const auto& self) -> size_t {
        size_t count = 1;
        for (const Expr& arg : e.args) count += self(arg, self);
        return count;
    };
    for (const auto& decl : ast.lets) {
        const auto known = lets_.find(decl.name.text);
        if (known == lets_.end() || known->second.decl != &decl) continue;
        Place place(Place::Where::Look);
        place.material = true;
        Typed typed = expression(place, decl.value);
        if (sizeOf(typed.expr, sizeOf) > most)
            typed = failed(decl.value.span, fmt::format("a value is made of at most {} numbers and operators", most),
                           "use fewer of the values above it");
        known->second.value = std::move(typed);
    }
}

uint32_t Checker::startCalled(const syntax::Name& name) {
    if (name.empty()) return none;
    std::vector<std::string> known;
    for (size_t i = 0; i < grammar_.starts.size(); ++i) {
        known.push_back(grammar_.symbols[grammar_.starts[i].symbol].name);
        if (known.back() == name.text) return static_cast<uint32_t>(i);
    }
    unknown(name.span, name.text, fmt::format("there is no start '{}'", name.text), nearest(name.text, known));
    return none;
}

std::vector<Setting> Checker::settings(const std::vector<syntax::Setting>& written) {
    std::vector<Setting> result;
    for (const syntax::Setting& s : written) {
        if (s.name.empty()) continue;  // the parser spoke of it
        const auto param = params_.find(s.name.text);
        if (param == params_.end()) {
            std::vector<std::string> known;
            for (const Param& p : grammar_.params) known.push_back(p.name);
            unknown(s.name.span, s.name.text, fmt::format("there is no parameter '{}'", s.name.text),
                    nearest(s.name.text, known));
            continue;
        }
        const Param& p = grammar_.params[param->second];
        if (brokenParams_.contains(param->second)) continue;
        if (std::any_of(result.begin(), result.end(), [&](const Setting& r) { return r.param == param->second; }))
            diagnostics_.error(s.span, fmt::format("'{}' is set twice", p.name));
        const auto value = plain(s.value, !p.choices.empty());
        if (!value) continue;
        const auto fitted = conform(p, *value);
        if (!fitted.ok())
            diagnostics_.error(s.value.span, fitted.error().message, nearest(value->text, p.choices));
        else
            result.push_back({param->second, *fitted, s.span, s.value.span});
    }
    return result;
}

void Checker::placeOf(const syntax::DeriveDecl::Step& step) {
    std::string_view rest = step.place;
    while (!rest.empty()) {
        const size_t end = std::min(rest.find('/'), rest.size());
        const std::string name(rest.substr(0, std::min(rest.find('['), end)));
        if (!symbols_.contains(name) && !field::findPrimitive(name) && name != "morph" && name != "group") {
            unknown(step.at.span, name, fmt::format("no shape is called '{}'", name),
                    nearest(name, symbolNames(false)));
            return;
        }
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
}

void Checker::derive(const syntax::DeriveDecl& decl) {
    if (twice(seenDerives_, decl.name, "derivation")) return;
    Derive out;
    out.name = decl.name.text;
    out.span = decl.span;
    std::vector<std::string> known;
    for (const auto& [name, rule] : rules_) known.push_back(name);
    for (const auto& step : decl.steps) {
        if (step.rule.empty()) continue;
        const auto rule = rules_.find(step.rule.text);
        if (rule == rules_.end()) {
            unknown(step.rule.span, step.rule.text, fmt::format("there is no rule named '{}'", step.rule.text),
                    nearest(step.rule.text, known));
            continue;
        }
        placeOf(step);
        out.steps.push_back({rule->second, step.place, step.rule.span});
    }
    grammar_.derives.push_back(std::move(out));
}

void Checker::checkDeclarations(const syntax::Ast& ast) {
    for (const auto& decl : ast.derives) derive(decl);
    for (const auto& decl : ast.styles) {
        const bool plain = decl.start.empty();
        if (twice(seenStyles_, {decl.name.text + (plain ? "" : " for " + decl.start.text), decl.name.span}, "style"))
            continue;
        grammar_.styles.push_back(
            {decl.name.text, plain ? none : startCalled(decl.start), settings(decl.settings), decl.span});
    }
    for (const auto& decl : ast.checks) {
        Check out;
        out.span = decl.span;
        out.start = startCalled(decl.start);
        out.settings = settings(decl.settings);
        Place place(Place::Where::Expect);
        if (decl.expect) out.expect = expression(place, *decl.expect, Want::Truth, "'expect'");
        grammar_.checks.push_back(std::move(out));
    }
}

void Checker::unused(const syntax::Ast& ast) {
    for (const auto& decl : ast.params)
        if (const auto param = params_.find(decl.name.text);
            param != params_.end() && !usedParams_.contains(param->second))
            diagnostics_.warning(decl.name.span, fmt::format("nothing uses the parameter '{}'", decl.name.text));
    for (const auto& decl : ast.lets)
        if (const auto let = lets_.find(decl.name.text); let != lets_.end() && !let->second.used)
            diagnostics_.warning(decl.name.span, fmt::format("nothing uses the value '{}'", decl.name.text));
}

}  // namespace sgm::rules
