#include "tests/syntax/dump.h"

namespace sgm::syntax {

Dump::Dump(const Ast& ast) : source_(*ast.source) {
    word(std::to_string(ast.version));
    simpleDeclarations(ast);
    shapeDeclarations(ast);
    otherDeclarations(ast);
}

void Dump::check(const char* kind, SourceSpan span) {
    const bool nowhere = !span.source && span.begin == 0 && span.end == 0;
    const bool inside = span.source == &source_ && span.begin <= span.end && span.end <= source_.text().size();
    if (!nowhere && !inside && badSpan_.empty())
        badSpan_ = std::string(kind) + " [" + std::to_string(span.begin) + ", " + std::to_string(span.end) + ")";
}

void Dump::open(const char* kind, SourceSpan span) {
    check(kind, span);
    out_ += '(';
    out_ += kind;
}

void Dump::word(std::string_view text) { out_.append(" ").append(text); }

void Dump::name(const Name& name) {
    check("name", name.span);
    word(name.empty() ? "_" : name.text);
}

void Dump::expr(const Expr& e) {
    open("expr", e.span);
    word(std::to_string(static_cast<int>(e.kind)));
    word(std::to_string(e.number) + e.unit);
    word(e.text);
    for (const std::string& argName : e.argNames) word(argName);
    for (const Expr& arg : e.args) expr(arg);
    close();
}

void Dump::expr(const std::optional<Expr>& e) {
    if (e)
        expr(*e);
    else
        word("_");
}

void Dump::attribute(const Attribute& a) {
    open("attribute", a.span);
    name(a.name);
    word(a.operation->name);
    for (const Expr& arg : a.args) expr(arg);
    for (const Case& c : a.cases) part(c);
    close();
}

void Dump::part(const Case& c) {
    open(c.repeated ? "repeated" : "case", c.span);
    expr(c.label);
    name(c.tag);
    for (const Case& inner : c.cases) part(inner);
    body(c.body);
    close();
}

void Dump::body(const Body& b) {
    open("body", b.span);
    for (const std::vector<Element>& chain : b.siblings) {
        out_ += "\n  chain";
        for (const Element& e : chain) element(e);
    }
    close();
}

void Dump::body(const std::shared_ptr<Body>& b) {
    if (b) body(*b);
}

void Dump::element(const Element& e) {
    open("element", e.span);
    word(std::to_string(static_cast<int>(e.kind)));
    word(std::to_string(static_cast<int>(e.op)));
    for (const Attribute& a : e.before) attribute(a);
    expr(e.solid);
    for (const Attribute& a : e.after) attribute(a);
    name(e.live);
    name(e.variable);
    expr(e.over);
    expr(e.guard);
    for (const Case& c : e.cases) part(c);
    body(e.body);
    close();
}

void Dump::settings(const std::vector<Setting>& list) {
    for (const Setting& s : list) {
        open("setting", s.span);
        name(s.name);
        expr(s.value);
        close();
    }
}

void Dump::simpleDeclarations(const Ast& ast) {
    for (const UseDecl& d : ast.uses) {
        open("\nuse", d.span);
        expr(d.file);
        settings(d.settings);
        close();
    }
    for (const ParamDecl& d : ast.params) {
        open("\nparam", d.span);
        name(d.name);
        expr(d.value);
        expr(d.range);
        for (const Name& choice : d.choices) name(choice);
        word(d.label);
        word(d.group);
        name(d.key);
        close();
    }
    for (const LetDecl& d : ast.lets) {
        open("\nlet", d.span);
        name(d.name);
        expr(d.value);
        close();
    }
    for (const MapDecl& d : ast.maps) {
        open("\nmap", d.span);
        name(d.name);
        expr(d.file);
        if (d.formula) expr(*d.formula);
        expr(d.range);
        expr(d.over);
        for (const MapDecl::Class& c : d.classes) {
            open("class", c.span);
            expr(c.color);
            name(c.word);
            close();
        }
        close();
    }
    for (const RoadsDecl& d : ast.roads) {
        open("\nroads", d.span);
        name(d.name);
        settings(d.settings);
        close();
    }
}

void Dump::shapeDeclarations(const Ast& ast) {
    for (const TerminalDecl& d : ast.terminals) {
        open(d.isMaterial ? "\nmaterial" : "\nterminal", d.span);
        for (const Name& n : d.names) name(n);
        for (const Attribute& a : d.attributes) attribute(a);
        expr(d.solid);
        for (const TerminalDecl::JointDecl& j : d.joints) {
            open("joint", j.span);
            name(j.name);
            expr(j.at);
            expr(j.facing);
            close();
        }
        close();
    }
    for (const StartDecl& d : ast.starts) {
        open("\nstart", d.span);
        name(d.symbol);
        body(d.body);
        close();
    }
    for (const RuleDecl& d : ast.rules) {
        open("\nrule", d.span);
        for (const Name* n : {&d.name, &d.symbol, &d.beside}) name(*n);
        for (const std::optional<Expr>* e : {&d.when, &d.weight, &d.repeat}) expr(*e);
        body(d.body);
        if (d.finally_) body(*d.finally_);
        close();
    }
}

void Dump::otherDeclarations(const Ast& ast) {
    for (const DeriveDecl& d : ast.derives) {
        open("\nderive", d.span);
        name(d.name);
        for (const DeriveDecl::Step& s : d.steps) {
            name(s.rule);
            if (s.hasPlace) expr(s.at);
            word(s.place);
        }
        close();
    }
    for (const LsystemDecl& d : ast.lsystems) {
        open("\nlsystem", d.span);
        name(d.name);
        settings(d.settings);
        expr(d.axiom);
        for (const LsystemDecl::Production& p : d.productions) {
            open("production", p.span);
            name(p.symbol);
            expr(p.text);
            expr(p.weight);
            close();
        }
        close();
    }
    for (const StyleDecl& d : ast.styles) {
        open("\nstyle", d.span);
        name(d.name);
        name(d.start);
        settings(d.settings);
        close();
    }
    for (const CheckDecl& d : ast.checks) {
        open("\ncheck", d.span);
        name(d.start);
        settings(d.settings);
        expr(d.expect);
        close();
    }
}

}  // namespace sgm::syntax
