#include "grammar/language/names.h"

#include <algorithm>
#include <cctype>

#include "grammar/rules/words.h"
#include "grammar/syntax/operations.h"

namespace sgm::language {
namespace {

using syntax::ArgumentType;
using syntax::Body;
using syntax::Element;
using syntax::Expr;
using syntax::Name;
using syntax::SourceSpan;

bool inWord(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

/// The word `text` within `span`, which may hold parentheses about it; an empty span at its begin where it isn't there.
SourceSpan wordIn(SourceSpan span, std::string_view text) {
    const std::string_view all = span.text();
    for (size_t at = all.find(text); !text.empty() && at != std::string_view::npos; at = all.find(text, at + 1)) {
        const bool begins = at == 0 || !inWord(all[at - 1]);
        const size_t end = at + text.size();
        if (begins && (end == all.size() || !inWord(all[end])))
            return {span.source, span.begin + static_cast<uint32_t>(at), span.begin + static_cast<uint32_t>(end)};
    }
    return {span.source, span.begin, span.begin};
}

/// Goes through every body of a tree.
template <class Visit>
void forElements(const Body& body, const Visit& visit);

template <class Visit>
void forCases(const std::vector<syntax::Case>& cases, const Visit& visit) {
    for (const syntax::Case& c : cases) {
        forCases(c.cases, visit);
        if (c.body) forElements(*c.body, visit);
    }
}

template <class Visit>
void forElements(const Body& body, const Visit& visit) {
    for (const auto& chain : body.siblings)
        for (const Element& e : chain) {
            visit(e);
            for (const auto* attributes : {&e.before, &e.after})
                for (const syntax::Attribute& a : *attributes) forCases(a.cases, visit);
            forCases(e.cases, visit);
            if (e.body) forElements(*e.body, visit);
        }
}

class Walk {
public:
    explicit Walk(const Known& known) : known_(known) {}

    void file(const syntax::Ast& ast) {
        for (const auto& d : ast.uses) settings(d.settings);
        for (const auto& d : ast.params) parameter(d);
        for (const auto& d : ast.lets) {
            define(NameKind::Constant, d.name, d.span);
            expr(d.value);
        }
        for (const auto& d : ast.maps) map(d);
        for (const auto& d : ast.roads) {
            define(NameKind::Map, d.name, d.span);
            for (const auto& s : d.settings) expr(s.value);
        }
        for (const auto& d : ast.terminals) terminal(d);
        for (const auto& d : ast.lsystems) lsystem(d);
        for (const auto& d : ast.starts) {
            define(NameKind::Symbol, d.symbol, d.span);
            body(d.body);
        }
        for (const auto& d : ast.rules) rule(d);
        for (const auto& d : ast.derives) way(d);
        for (const auto& d : ast.styles) {
            define(NameKind::Style, d.name, d.span);
            use(NameKind::Symbol, d.start);
            settings(d.settings);
        }
        for (const auto& d : ast.checks) {
            use(NameKind::Symbol, d.start);
            settings(d.settings);
            if (d.expect) expr(*d.expect);
        }
    }

    std::vector<Occurrence> take() {
        std::stable_sort(found_.begin(), found_.end(),
                         [](const Occurrence& a, const Occurrence& b) { return a.span.begin < b.span.begin; });
        return std::move(found_);
    }

private:
    void add(NameKind kind, std::string name, SourceSpan span, SourceSpan declaration = {}, uint32_t scope = 0) {
        if (name.empty() || span.begin == span.end) return;
        found_.push_back({kind, std::move(name), span, declaration.source != nullptr, declaration, scope});
    }
    void define(NameKind kind, const Name& name, SourceSpan declaration) {
        add(kind, name.text, name.span, declaration);
    }
    void use(NameKind kind, const Name& name) { add(kind, name.text, name.span); }

    void parameter(const syntax::ParamDecl& d) {
        define(NameKind::Parameter, d.name, d.span);
        expr(d.value);
        if (d.range) expr(*d.range);
    }

    void map(const syntax::MapDecl& d) {
        define(NameKind::Map, d.name, d.span);
        for (const auto* e : {&d.formula, &d.range, &d.over})
            if (*e) expr(**e);
    }

    void terminal(const syntax::TerminalDecl& d) {
        for (const Name& name : d.names) define(NameKind::Symbol, name, d.span);
        if (d.solid) expr(*d.solid, ArgumentType::Solid);
        for (const auto& a : d.attributes) attribute(a);
        for (const auto& joint : d.joints) {
            define(NameKind::Joint, joint.name, joint.span);
            expr(joint.at);
            expr(joint.facing, ArgumentType::Joint);
        }
    }

    void modules(const std::vector<syntax::LsystemDecl::Module>& all) {
        for (const auto& module : all)
            for (const Expr& arg : module.args) expr(arg);
    }
    void lsystem(const syntax::LsystemDecl& d) {
        define(NameKind::Lsystem, d.name, d.span);
        for (const auto& s : d.settings) expr(s.value);
        modules(d.axiomModules);
        for (const auto& p : d.productions) {
            modules(p.modules);
            if (p.when) expr(*p.when);
            if (p.weight) expr(*p.weight);
        }
    }

    void rule(const syntax::RuleDecl& d) {
        define(NameKind::Rule, d.name, d.span);
        define(NameKind::Symbol, d.symbol, d.span);
        use(NameKind::Symbol, d.beside);
        use(NameKind::Symbol, d.after);
        for (const auto* e : {&d.when, &d.weight, &d.repeat})
            if (*e) expr(**e);
        body(d.body);
        if (d.finally_) body(*d.finally_);
    }

    void way(const syntax::DeriveDecl& d) {
        define(NameKind::Way, d.name, d.span);
        for (const auto& step : d.steps) {
            const size_t number = step.rule.text.find('#');  // Cell#2 names a rule by its symbol
            if (number == std::string::npos)
                use(NameKind::Rule, step.rule);
            else
                add(NameKind::Symbol, step.rule.text.substr(0, number),
                    wordIn(step.rule.span, step.rule.text.substr(0, number)));
            if (step.hasPlace) path(step.at);
        }
    }

    /// Cave/Cell[3]: labels are symbols, terminals and primitives.
    void path(const Expr& e) {
        const std::string_view text = e.span.text();
        for (size_t at = 0; at < text.size();) {
            if (!inWord(text[at]) || std::isdigit(static_cast<unsigned char>(text[at]))) {
                while (at < text.size() && inWord(text[at])) ++at;
                at += at < text.size() && !inWord(text[at]);
                continue;
            }
            size_t end = at;
            while (end < text.size() && inWord(text[end])) ++end;
            std::string word(text.substr(at, end - at));
            const SourceSpan span{e.span.source, e.span.begin + static_cast<uint32_t>(at),
                                  e.span.begin + static_cast<uint32_t>(end)};
            if (known_.symbols.contains(word)) add(NameKind::Symbol, std::move(word), span);
            at = end;
        }
    }

    void settings(const std::vector<syntax::Setting>& all) {
        for (const auto& s : all) {
            use(NameKind::Parameter, s.name);
            expr(s.value);
        }
    }

    void body(const Body& b) {
        const size_t outside = locals_.size();
        for (const auto& chain : b.siblings)
            for (const Element& e : chain) {
                element(e);
                if (e.kind != Element::Kind::Let || e.variable.empty()) continue;
                locals_.push_back({e.variable.text, e.span.begin});
                const SourceSpan sight{e.span.source, e.span.begin, std::max(e.span.end, b.span.end)};
                add(NameKind::Local, e.variable.text, e.variable.span, sight, e.span.begin);
            }
        locals_.resize(outside);
    }

    void element(const Element& e) {
        for (const auto& a : e.before) attribute(a);
        if (e.solid) expr(*e.solid, ArgumentType::Solid);
        for (const auto& a : e.after) attribute(a);
        add(NameKind::Symbol, e.live.text, e.live.span);
        const bool runs = e.kind == Element::Kind::For && !e.variable.empty();
        if (e.over) expr(*e.over);
        if (runs) {
            locals_.push_back({e.variable.text, e.span.begin});
            add(NameKind::Local, e.variable.text, e.variable.span, e.span, e.span.begin);
        }
        if (e.guard) expr(*e.guard);
        if (e.body) body(*e.body);
        cases(e.cases);
        if (runs) locals_.pop_back();
    }

    void attribute(const syntax::Attribute& a) {
        for (size_t i = 0; i < a.args.size(); ++i) {
            const auto* row = a.operation && i < a.operation->arguments.size() ? &a.operation->arguments[i] : nullptr;
            if (i == 0 && a.operation && a.operation->traits.namesValue)
                add(NameKind::Value, a.args[0].text, wordIn(a.args[0].span, a.args[0].text), a.span);
            else if (row && (row->type == ArgumentType::Start || row->type == ArgumentType::Symbol))
                add(NameKind::Symbol, a.args[i].text, wordIn(a.args[i].span, a.args[i].text));
            else if (row && row->type == ArgumentType::Name)
                add(NameKind::Tag, a.args[i].text, wordIn(a.args[i].span, a.args[i].text));
            else
                expr(a.args[i], row ? row->type : ArgumentType::Number);
        }
        cases(a.cases);
        settings(a.settings);
    }

    void cases(const std::vector<syntax::Case>& all) {
        for (const syntax::Case& c : all) {
            if (c.label) expr(*c.label);
            use(NameKind::Tag, c.tag);
            cases(c.cases);
            if (c.body) body(*c.body);
        }
    }

    void expr(const Expr& e, ArgumentType wanted = ArgumentType::Number) {
        if (e.kind == Expr::Kind::Name || e.kind == Expr::Kind::Call) word(e, wanted);
        const bool shapes = e.kind == Expr::Kind::Call && (e.text == "each" || e.text == "count");
        for (const Expr& child : e.args) expr(child, shapes ? ArgumentType::Solid : wanted);
    }

    /// What a word means where `wanted` is asked for, in the order in which the checker looks.
    void word(const Expr& e, ArgumentType wanted) {
        const SourceSpan span = wordIn(e.span, e.text);
        for (auto local = locals_.rbegin(); local != locals_.rend(); ++local)
            if (local->first == e.text) return add(NameKind::Local, e.text, span, {}, local->second);
        if (rules::axisNumber(e.text) >= 0) return;
        const bool solid = wanted == ArgumentType::Solid || wanted == ArgumentType::Shape;
        if (solid && (known_.symbols.contains(e.text) || (rules::isNonTerminal(e.text) && e.kind == Expr::Kind::Name)))
            return add(NameKind::Symbol, e.text, span);
        if (wanted == ArgumentType::Plan && known_.lsystems.contains(e.text))
            return add(NameKind::Lsystem, e.text, span);
        const bool joint = wanted == ArgumentType::Joint || wanted == ArgumentType::Point;
        if (joint && known_.joints.contains(e.text)) return add(NameKind::Joint, e.text, span);
        if (wanted == ArgumentType::Material && known_.symbols.contains(e.text))
            return add(NameKind::Symbol, e.text, span);
        if (known_.constants.contains(e.text)) return add(NameKind::Constant, e.text, span);
        if (known_.parameters.contains(e.text)) return add(NameKind::Parameter, e.text, span);
        if (known_.values.contains(e.text)) return add(NameKind::Value, e.text, span);
        if (known_.joints.contains(e.text)) return add(NameKind::Joint, e.text, span);
        if (known_.maps.contains(e.text)) return add(NameKind::Map, e.text, span);
        if (known_.symbols.contains(e.text)) return add(NameKind::Symbol, e.text, span);
    }

    const Known& known_;
    std::vector<std::pair<std::string, uint32_t>> locals_;
    std::vector<Occurrence> found_;
};

}  // namespace

void Known::add(const syntax::Ast& ast) {
    const auto collect = [this](const Element& e) {
        if (!e.live.empty()) symbols.insert(e.live.text);
        if (e.solid && e.solid->kind == Expr::Kind::Name && rules::isNonTerminal(e.solid->text))
            symbols.insert(e.solid->text);
        for (const auto* attributes : {&e.before, &e.after})
            for (const syntax::Attribute& a : *attributes)
                if (a.operation && a.operation->traits.namesValue && !a.args.empty()) values.insert(a.args[0].text);
    };
    for (const auto& d : ast.params) {
        parameters.insert(d.name.text);
        for (const Name& choice : d.choices) choices[d.name.text].push_back(choice.text);
    }
    for (const auto& d : ast.lets) constants.insert(d.name.text);
    for (const auto& d : ast.maps) maps.insert(d.name.text);
    for (const auto& d : ast.roads) maps.insert(d.name.text);
    for (const auto& d : ast.terminals) {
        for (const Name& name : d.names) symbols.insert(name.text);
        for (const auto& joint : d.joints) joints.insert(joint.name.text);
    }
    for (const auto& d : ast.lsystems) lsystems.insert(d.name.text);
    for (const auto& d : ast.starts) {
        symbols.insert(d.symbol.text);
        forElements(d.body, collect);
    }
    for (const auto& d : ast.rules) {
        symbols.insert(d.symbol.text);
        if (!d.name.empty()) rules.insert(d.name.text);
        forElements(d.body, collect);
        if (d.finally_) forElements(*d.finally_, collect);
    }
    for (const auto& d : ast.derives) ways.insert(d.name.text);
    for (const auto& d : ast.styles) styles.insert(d.name.text);
}

std::vector<Occurrence> occurrencesOf(const syntax::Ast& ast, const Known& known) {
    Walk walk(known);
    walk.file(ast);
    return walk.take();
}

const Occurrence* occurrenceAt(const std::vector<Occurrence>& all, uint32_t offset) {
    const Occurrence* touched = nullptr;
    for (const Occurrence& o : all) {
        if (o.span.begin <= offset && offset < o.span.end) return &o;
        if (o.span.end == offset) touched = &o;
    }
    return touched;
}

}  // namespace sgm::language
