// Terminals, derivations, styles and checks.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "grammar/rules/bodies.h"
#include "grammar/rules/declarations.h"
#include "grammar/rules/evaluate.h"
#include "grammar/rules/expressions.h"
#include "grammar/rules/lookup.h"
#include "grammar/rules/make.h"
#include "grammar/rules/params.h"
#include "grammar/rules/words.h"
#include "grammar/syntax/lexer.h"

namespace sgm::rules {
namespace {

using Written = syntax::Expr;

Vec3d vectorOf(const Value& v) { return {v.n[0], v.n[1], v.n[2]}; }

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

/// What to write for a material of a name that isn't one; that of a terminal may stand in a file of the library.
std::string hintForBase(const CheckContext& ctx, const syntax::TerminalDecl& decl, const std::string& name) {
    const auto terminal = ctx.names.terminals.find(name);
    if (terminal == ctx.names.terminals.end() || terminal->second->isMaterial)
        return "name a material whose line stands before this one";
    const syntax::Source* const source = terminal->second->span.source;
    if (source == decl.span.source) return fmt::format("write 'material {0}' in place of 'terminal {0}'", name);
    return fmt::format("it is a terminal of {}: write the look here, as 'material {} color #c8b090'", source->name(),
                       decl.names.empty() ? "…" : decl.names[0].text);
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
                                      hintForBase(ctx, decl, value->text));
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

namespace {

/// Terminals and materials of the file whose name no other place of any file has.
void warnOfUnusedLooks(CheckContext& ctx, const syntax::Ast& ast) {
    std::map<std::string_view, size_t> places;  // how often a name stands somewhere
    for (const syntax::TerminalDecl& decl : ast.terminals)
        for (const syntax::Name& name : decl.names) places.emplace(name.text, 0);
    if (places.empty()) return;
    for (const syntax::SourcePtr& source : ctx.grammar.sources)
        for (const syntax::Token& token : syntax::lexSignificant(*source))
            if (const auto found = places.find(syntax::textOf(*source, token)); found != places.end()) ++found->second;
    for (const syntax::TerminalDecl& decl : ast.terminals)
        for (const syntax::Name& name : decl.names)
            if (places.at(name.text) == 1)
                ctx.diagnostics.warning(name.span, fmt::format("nothing uses the {} '{}'",
                                                               decl.isMaterial ? "material" : "terminal", name.text));
}

}  // namespace

void warnOfUnused(CheckContext& ctx, const syntax::Ast& ast) {
    warnOfUnusedLooks(ctx, ast);
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
