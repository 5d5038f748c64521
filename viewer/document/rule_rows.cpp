#include "viewer/document/rule_rows.h"

#include <algorithm>

#include "grammar/syntax/lexer.h"
#include "grammar/syntax/printer.h"

namespace sgm::document {
namespace {

using syntax::Body;
using syntax::Case;
using syntax::Element;
using syntax::Expr;
using syntax::RuleDecl;
using syntax::SourceSpan;
using syntax::StartDecl;
using Kind = RuleRow::Kind;

/// The text of a span in one line: no comments, one blank for many.
std::string oneLine(SourceSpan span) {
    if (!span.source) return {};
    const syntax::Source alone("", std::string(span.text()));
    std::string line;
    for (const syntax::Token& token : syntax::lex(alone)) {
        if (token.kind == syntax::Token::Kind::Comment) continue;
        if (token.kind != syntax::Token::Kind::Blank)
            line += textOf(alone, token);
        else if (!line.empty() && line.back() != ' ')
            line += ' ';
    }
    while (!line.empty() && line.back() == ' ') line.pop_back();
    return line;
}

std::string oneLine(const std::optional<Expr>& e) { return e ? oneLine(e->span) : std::string(); }

std::string headOf(const Element& e) {
    switch (e.kind) {
        case Element::Kind::For:
            return "for " + e.variable.text + " in " + oneLine(e.over) + (e.guard ? " when " + oneLine(e.guard) : "");
        case Element::Kind::While:
            return "while " + oneLine(e.over);
        case Element::Kind::When:
            return "when " + oneLine(e.over);
        case Element::Kind::Choose:
            return e.variable.empty() ? "choose" : "choose " + e.variable.text;
        case Element::Kind::Let:
            return "let " + e.variable.text + " = " + oneLine(e.over);
        case Element::Kind::Group:
        case Element::Kind::Shape:
            break;
    }
    std::string text(syntax::sign(e.op));
    if (!text.empty()) text += ' ';
    if (e.kind == Element::Kind::Group)
        text += "( )";
    else if (e.solid)
        text += oneLine(e.solid->span);
    else if (!text.empty())
        text += "…";
    if (!e.live.empty()) text += " : " + e.live.text;
    return text;
}

std::string headOf(const syntax::Attribute& a) {
    std::string text = a.name.text;
    for (const Expr& arg : a.args) text += ' ' + oneLine(arg.span);
    if (a.operation->traits.namesValue && a.args.size() == 2)
        text = "with " + a.args[0].text + " = " + oneLine(a.args[1].span);
    return text;
}

/// How often a block repeats, as it is written.
std::string timesOf(const Case& c) { return c.atLeastOnce ? "{ }+" : c.times ? "{ }" + oneLine(c.times) : "{ }*"; }

class Writer {
public:
    void start(const StartDecl& decl) {
        rule_ = nullptr, start_ = &decl;
        add(Kind::Start, 0, decl.span, "start " + decl.symbol.text);
        body(decl.body, 1);
    }
    void rule(const RuleDecl& decl) {
        rule_ = &decl, start_ = nullptr;
        add(Kind::Rule, 0, decl.span, (decl.name.empty() ? "" : decl.name.text + ": ") + decl.symbol.text);
        if (!decl.beside.empty()) add(Kind::Part, 1, decl.beside.span, "beside " + decl.beside.text).word = "beside";
        part("when", decl.when);
        part("weight", decl.weight);
        part("repeat", decl.repeat);
        body(decl.body, 1);
        if (!decl.finally_) return;
        add(Kind::Finally, 1, decl.finally_->span, "finally");
        body(*decl.finally_, 2);
    }
    std::vector<RuleRow> take() { return std::move(rows_); }

private:
    RuleRow& add(Kind kind, uint32_t depth, SourceSpan span, std::string text) {
        RuleRow row;
        row.kind = kind;
        row.depth = depth;
        row.span = span;
        row.text = std::move(text);
        row.rule = rule_;
        row.start = start_;
        rows_.push_back(std::move(row));
        return rows_.back();
    }
    void part(const char* word, const std::optional<Expr>& e) {
        if (!e) return;
        RuleRow& row = add(Kind::Part, 1, e->span, std::string(word) + ' ' + oneLine(e->span));
        row.word = word;
        row.expression = &*e;
    }
    void body(const Body& b, uint32_t depth) {
        for (uint32_t s = 0; s < b.siblings.size(); ++s)
            for (const Element& e : b.siblings[s]) element(e, depth, s, &e == b.siblings[s].data());
    }
    void element(const Element& e, uint32_t depth, uint32_t sibling, bool first) {
        const std::string head = headOf(e);
        const size_t place = rows_.size();
        const uint32_t below = depth + !head.empty();
        if (!head.empty()) add(Kind::Element, depth, e.span, head).element = &e;
        for (const syntax::Attribute& a : e.before) attribute(e, a, below);
        if (e.body) body(*e.body, below);
        cases(e.cases, below);
        for (const syntax::Attribute& a : e.after) attribute(e, a, below);
        if (place == rows_.size()) return;
        rows_[place].sibling = sibling;
        rows_[place].first = first;
    }
    void attribute(const Element& e, const syntax::Attribute& a, uint32_t depth) {
        RuleRow& row = add(Kind::Attribute, depth, a.span, headOf(a));
        row.element = &e;
        row.attribute = &a;
        row.word = a.name.text;
        cases(a.cases, depth + 1);
    }
    void cases(const std::vector<Case>& list, uint32_t depth) {
        for (const Case& c : list) {
            if (!c.repeated && c.tag.empty() && !c.label) {  // a block without labels
                if (c.body) body(*c.body, depth);
                continue;
            }
            const std::string label = c.repeated      ? timesOf(c)
                                      : c.tag.empty() ? oneLine(c.label) + ":"
                                                      : "tag " + c.tag.text + ":";
            RuleRow& row = add(Kind::Case, depth, c.span, label);
            row.part = &c;
            if (c.label) row.expression = &*c.label;
            if (c.body) body(*c.body, depth + 1);
            cases(c.cases, depth + 1);
        }
    }

    std::vector<RuleRow> rows_;
    const RuleDecl* rule_ = nullptr;
    const StartDecl* start_ = nullptr;
};

}  // namespace

std::vector<RuleRow> ruleRows(const syntax::Ast& ast) {
    Writer writer;
    auto rule = ast.rules.begin();
    for (const StartDecl& start : ast.starts) {
        for (; rule != ast.rules.end() && rule->span.begin < start.span.begin; ++rule) writer.rule(*rule);
        writer.start(start);
    }
    for (; rule != ast.rules.end(); ++rule) writer.rule(*rule);
    return writer.take();
}

size_t rowAt(const std::vector<RuleRow>& rows, uint32_t offset) {
    size_t found = rows.size();
    for (size_t i = 0; i < rows.size(); ++i) {
        const SourceSpan span = rows[i].span;
        const bool holds = span.begin <= offset && offset < span.end;
        if (holds && (found == rows.size() || span.end - span.begin <= rows[found].span.end - rows[found].span.begin))
            found = i;
    }
    return found;
}

size_t rowOf(const std::vector<RuleRow>& rows, const SelectedNode& node) {
    const uint32_t at = node.range.begin;
    const bool outermost = node.range.begin == node.range.end;
    size_t around = rows.size();
    for (size_t i = 0; i < rows.size(); ++i) {
        const SourceSpan span = rows[i].span;
        if (span.begin == at && (outermost || rows[i].kind == node.kind)) return i;
        if (rows[i].kind == node.kind && span.begin <= at && at < span.end) around = i;  // inner rows follow outer ones
    }
    return around;
}

size_t rowOf(const std::vector<RuleRow>& rows, TextRange range) {
    size_t around = rows.size();
    for (size_t i = 0; i < rows.size(); ++i) {
        const SourceSpan span = rows[i].span;
        if (span.begin == range.begin && span.end == range.end) return i;
        if (span.begin <= range.begin && range.end <= span.end) around = i;
    }
    return around;
}

}  // namespace sgm::document
