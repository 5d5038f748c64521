#include "grammar/language/words.h"

#include <fmt/format.h>

#include <algorithm>

#include "grammar/operations/operations.h"
#include "grammar/rules/functions.h"
#include "grammar/rules/params.h"
#include "grammar/rules/plans.h"
#include "grammar/syntax/lexer.h"
#include "modeler/field/primitives.h"

namespace sgm::language {
namespace {

constexpr Keyword declarationTable[] = {
    {"use",
     "Everything in another file, once: `use \"std/walls.sgm\"`. `{ n = 3 }` behind it gives its parameters other "
     "defaults."},
    {"param", "A number the user may change: `param floors = 5 in 2..20 \"Storeys\" group House key f`."},
    {"let", "A value by name, of numbers and parameters: `let sill = 90cm`."},
    {"map", "A picture that is read as numbers: `map people = \"population.png\" as 0..1`."},
    {"material",
     "A look by name, without a solid: `material stone color #c2b59b rough .9`; `cylinder of stone` wears it."},
    {"terminal", "Names for finished shapes: `terminal wall color #c8b090 rough .8`."},
    {"start",
     "Where a derivation begins: `start House -> stone size (10, 3, 8) : Storey`. The first one runs unless another is "
     "asked for."},
    {"rule", "What a symbol becomes or grows: `rule Storey repeat floors - 1 -> + stone at +y : Storey`."},
    {"derive", "An explicit order of rules: `derive left: R0 => R1 => R3`."},
    {"roads", "How roads grow over maps: `roads Name { … }`."},
    {"lsystem", "Letters that draw a plan, rewritten some times over."},
    {"style",
     "A named set of parameter values: `style Tall for House { floors = 12 }`. One called `default` is used without "
     "asking."},
    {"check", "The grammar's own test: `check House { floors = 3 } expect bonds >= 3`."},
};

constexpr Keyword clauseTable[] = {
    {"grammar", "The version of the language, in the first line: `grammar 2`."},
    {"in", "The range of a parameter, `in 2..20`; what a `for` runs through, `for d in axes { … }`."},
    {"of", "The choices of a parameter: `param roof = flat of flat, steep`."},
    {"group", "The group of a parameter in panels."},
    {"key", "The key that changes a parameter in the window."},
    {"joint", "A joint of a terminal: `joint door at (0, -.5, .5) facing +z`."},
    {"facing", "The direction of a joint."},
    {"beside", "Asks that a shape of that name is bonded to the matched one: `rule Cell beside Hall -> …`."},
    {"when", "A guard: the rule or body runs where the condition holds. Rules whose guard holds win, in file order."},
    {"weight", "The weight with which a rule is drawn among those that match."},
    {"repeat", "One chain: the body runs once a step, `i` = 1 … n, each time on the newest live shape."},
    {"finally", "Runs once, at the end of a `repeat`, on all that was grown."},
    {"for", "Runs a body for each value: `for d in sides when … { … }`, `for k in 1..n { … }`."},
    {"while", "Runs a body while a condition holds."},
    {"choose", "Draws a body or a value by weight: `choose { 8: cube | 2: sphere }`."},
    {"distinct", "`choose distinct { … }`: in a repetition, another than in the turn before."},
    {"shuffled", "`choose shuffled { … }`: in a repetition, each once before any comes again."},
    {"let", "A value that a body names once, drawn once where chance decides: `let w = 1m..1.4m`."},
    {"expect",
     "What a check asks for: `bonds`, `overlaps`, `shapes`, `terminals`, `classic`, `morphic`, `floating`, "
     "`count(Name)`."},
    {"axiom", "The letters that an lsystem begins with."},
    {"morph", "Grows a newcomer into the matched shape; `morph(a, b, .5)` is a solid between two."},
    {"and", "Both conditions hold."},
    {"or", "One of the conditions holds."},
    {"not", "The condition doesn't hold."},
};

constexpr Keyword valueTable[] = {
    {"axes", "`+x -x +y -y +z -z`"},
    {"sides", "`+x -x +z -z`"},
    {"last", "`on last`: the newest shape of the chain."},
    {"any", "`on any(d)`: one drawn among the shapes placed toward `d` in the step before."},
    {"each",
     "`on each(Name)`: every shape of that name that the matched one holds. `at each(side)`: every such face of a "
     "block or roof: "
     "side, front, back, left, right, court, a tag; corner, slope, eave, gable, apex."},
    {"free", "`at free(+x, +z)`: one of these joints that nothing has met, drawn by the seed."},
    {"centre", "The joint at the centre: `to centre` lays a newcomer's centre on our joint."},
    {"scope", "The size of the matched shape's scope: `scope.x`."},
    {"i", "The step of a `repeat`, from 1."},
    {"nil", "The empty shape."},
    {"true", "A condition that holds."},
    {"false", "A condition that doesn't hold."},
    {"pi", "3.14159…"},
    {"x", "The axis x."},
    {"y", "The axis y, upward."},
    {"z", "The axis z."},
    {"billow", "Noise with round lumps: `displace billow(.05m, 2/m)`."},
    {"fbm", "Noise of several octaves: `displace fbm(.05m, 2/m, 4)`."},
    {"tag", "A part of a `split` or `faces` block by its tag: `tag K: …`."},
};

std::string operationDoc(const syntax::Operation& o) {
    std::string text = fmt::format("`{}", o.name);
    for (const auto& a : o.arguments) {
        const std::string argument = a.word.empty() ? std::string(a.name) : fmt::format("{} {}", a.word, a.name);
        text += a.optional ? fmt::format(" [{}]", argument) : " " + argument;
    }
    text += fmt::format("{}`, operation\n\n{}\n", o.hasBlock() || o.traits.takesSettings ? " { … }" : "", o.doc);
    for (const auto& a : o.arguments) text += fmt::format("\n- `{}`: {}", a.name, a.doc);
    if (!o.example.empty()) text += fmt::format("\n\n```sgm\n{}\n```", o.example);
    return text;
}

std::string primitiveDoc(const field::Primitive& p) {
    std::string text = fmt::format("`{}`, solid\n\n{}\n", p.name, p.doc);
    for (const auto& a : p.parameters) text += fmt::format("\n- `{}`: {}", a.name, a.doc);
    return text;
}

std::string planDoc(const rules::PlanRow& p) {
    std::string text = fmt::format("`{}`, plan\n\n{}\n", p.name, p.doc);
    for (const auto& a : p.parameters) text += fmt::format("\n- `{}`: {}", a.name, a.doc);
    return text + fmt::format("\n\n```sgm\n{}\n```", p.example);
}

std::string functionDoc(const rules::Function& f) {
    const std::string count = f.least == f.most ? fmt::format("{}", f.least)
                              : f.most == 255   ? fmt::format("{} or more", f.least)
                                                : fmt::format("{} to {}", f.least, f.most);
    return fmt::format("`{}(…)`, function of {} argument{}\n\n{}", f.name, count,
                       f.least == 1 && f.most == 1 ? "" : "s", f.doc);
}

std::string_view firstLine(std::string_view text) { return text.substr(0, text.find('\n')); }

/// A declaration as it is shown: its text, cut after some lines.
std::string excerpt(std::string_view text) {
    size_t end = 0;
    for (int lines = 0; lines < 8 && end < text.size(); ++lines)
        end = std::min(text.find('\n', end), text.size() - 1) + 1;
    std::string shown(text.substr(0, end));
    if (end < text.size()) shown += "…";
    return shown;
}

std::string parameterText(const Analysis& analysis, const std::string& name) {
    if (!analysis.grammar) return {};
    const auto values = rules::valuesOf(*analysis.grammar, 0);
    for (size_t i = 0; i < values.size(); ++i) {
        const rules::Param& p = analysis.grammar->params[i];
        if (p.name != name) continue;
        std::string text = fmt::format("\n\nvalue: `{}`", rules::toText(values[i]));
        if (p.lo && p.hi) text += fmt::format(" in `{}..{}`", rules::toText(*p.lo), rules::toText(*p.hi));
        if (!p.choices.empty()) text += fmt::format(" of `{}`", fmt::join(p.choices, "`, `"));
        return p.label.empty() ? text : "\n\n" + p.label + text;
    }
    return {};
}

std::string figuresText(const Analysis& analysis, const Occurrence& o) {
    if (!analysis.figures || !analysis.grammar) return {};
    std::string text;
    for (const rules::Rule& rule : analysis.grammar->rules) {
        const bool asked = o.kind == NameKind::Rule
                               ? rule.name == o.name
                               : o.defines && rule.symbol != rules::none && rule.symbolSpan.begin == o.span.begin &&
                                     rule.symbolSpan.source == o.span.source;
        const auto found = analysis.figures->rules.find(rule.name);
        if (asked && found != analysis.figures->rules.end())
            text += fmt::format("\n\nAt the defaults the rule runs {} times and makes {} shapes.", found->second.first,
                                found->second.second);
        else if (asked)
            text += "\n\nAt the defaults the rule doesn't run.";
    }
    if (o.kind != NameKind::Symbol) return text;
    const auto shapes = analysis.figures->symbols.find(o.name);
    return text + fmt::format("\n\n{} shapes of this name at the defaults.",
                              shapes == analysis.figures->symbols.end() ? 0 : shapes->second);
}

}  // namespace

std::span<const Keyword> declarationWords() { return declarationTable; }
std::span<const Keyword> clauseWords() { return clauseTable; }
std::span<const Keyword> valueWords() { return valueTable; }

std::string docOf(std::string_view word) {
    std::string text;
    const auto add = [&](std::string more) { text += (text.empty() ? "" : "\n\n---\n\n") + std::move(more); };
    for (const auto table : {declarationWords(), clauseWords(), valueWords()})
        for (const Keyword& k : table)
            if (k.word == word) add(fmt::format("`{}`\n\n{}", k.word, k.doc));
    if (const auto* row = operations::table().find(word)) add(operationDoc(*row));
    if (const auto* row = field::findPrimitive(word)) add(primitiveDoc(*row));
    if (const auto* row = rules::findPlan(word)) add(planDoc(*row));
    if (const auto* row = rules::findFunction(word)) add(functionDoc(*row));
    return text;
}

std::string commentOf(syntax::SourceSpan declaration) {
    if (!declaration.source) return {};
    const syntax::Source& source = *declaration.source;
    const auto trimmed = [](std::string_view text) {
        const size_t begin = text.find_first_not_of(" \t/");
        const size_t end = text.find_last_not_of(" \t\r");
        return begin == std::string_view::npos ? std::string_view() : text.substr(begin, end - begin + 1);
    };
    std::string text;
    const uint32_t line = source.place(declaration.begin).line;
    for (uint32_t at = line - 1; at >= 1 && source.line(at).starts_with("//"); --at)
        text = std::string(trimmed(source.line(at))) + (text.empty() ? "" : "\n") + text;
    if (!text.empty()) return text;
    const uint32_t last = source.place(declaration.end).line;
    const std::string_view behind = source.text().substr(
        declaration.end, source.line(last).data() + source.line(last).size() - source.text().data() - declaration.end);
    const size_t comment = behind.find("//");
    return comment == std::string_view::npos ? std::string() : std::string(trimmed(behind.substr(comment)));
}

std::string purposeOf(const syntax::Source& source) {
    for (const syntax::Token& token : syntax::lex(source)) {
        if (token.kind != syntax::Token::Kind::Comment) continue;
        const std::string_view text = textOf(source, token);
        return std::string(text.substr(std::min(text.find_first_not_of("/ "), text.size())));
    }
    return {};
}

const Occurrence* definitionOf(const Analysis& analysis, const Occurrence& occurrence) {
    if (occurrence.kind != NameKind::Local) {
        const auto found = analysis.definitions.find({occurrence.kind, occurrence.name});
        return found == analysis.definitions.end() ? nullptr : found->second;
    }
    for (const File& file : analysis.files)
        for (const Occurrence& o : file.names)
            if (o.defines && same(o, occurrence)) return &o;
    return nullptr;
}

std::string describe(const Analysis& analysis, const Occurrence& occurrence) {
    constexpr std::string_view kinds[] = {
        "shape", "parameter", "value set by `with`", "value of a `for`", "rule", "joint", "style", "way", "lsystem",
        "map",   "tag",       "value of the file"};
    std::string text = fmt::format("`{}`, {}", occurrence.name, kinds[static_cast<size_t>(occurrence.kind)]);
    const Occurrence* shown = occurrence.defines ? &occurrence : definitionOf(analysis, occurrence);
    if (shown && occurrence.kind != NameKind::Value && occurrence.kind != NameKind::Local) {
        text += fmt::format("\n\n```sgm\n{}\n```", excerpt(shown->declaration.text()));
        const std::string comment = commentOf(shown->declaration);
        if (!comment.empty()) text += "\n\n" + comment;
        if (shown->span.source != occurrence.span.source)
            text += fmt::format("\n\nfrom {}", firstLine(shown->span.source->name()));
    }
    if (occurrence.kind == NameKind::Parameter) text += parameterText(analysis, occurrence.name);
    return text + figuresText(analysis, occurrence);
}

}  // namespace sgm::language
