#include "grammar/rules/upgrade.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <span>
#include <tuple>

#include "modeler/field/primitives.h"

namespace sgm::rules {
namespace {

using syntax::Attribute;
using syntax::Body;
using syntax::Element;
using syntax::Expr;
using syntax::Operation;
using syntax::SourceSpan;

/// Whether the value hangs on the scope: a share of it, or `scope` and `here` themselves.
bool asksScope(const Expr& e) {
    if (e.kind == Expr::Kind::Number && e.unit == "%") return true;
    if (e.kind == Expr::Kind::Name && (e.text == "scope" || e.text == "here")) return true;
    return std::any_of(e.args.begin(), e.args.end(), [](const Expr& arg) { return asksScope(arg); });
}
bool isOfScope(const Attribute& a) {
    return std::any_of(a.args.begin(), a.args.end(), [](const Expr& arg) { return asksScope(arg); });
}

bool hasShare(const Expr& e) {
    return (e.kind == Expr::Kind::Number && e.unit == "%") || std::any_of(e.args.begin(), e.args.end(), hasShare);
}
/// Whether the value mixes a share of the scope with a length, as `100% - 1m` does.
bool isMixed(const Expr& e) {
    const bool isSum = e.kind == Expr::Kind::Binary && (e.text == "+" || e.text == "-");
    return (isSum && hasShare(e.args[0]) != hasShare(e.args[1])) || std::any_of(e.args.begin(), e.args.end(), isMixed);
}

const Attribute* find(const std::vector<Attribute>& list, std::string_view name) {
    const auto found = std::find_if(list.begin(), list.end(), [&](const Attribute& a) { return a.name.text == name; });
    return found == list.end() ? nullptr : &*found;
}
const Attribute* find(const Element& e, std::string_view name) {
    const Attribute* found = find(e.after, name);
    return found ? found : find(e.before, name);
}

/// How a chain's first shape stands in the scope that its rule matched.
struct Head {
    bool turned = false, moved = false;
};

/// Whether a newcomer stands or measures by the shape that its chain begins with.
bool leansOn(const Element& e, Head head) {
    if (e.op == syntax::Operator::None || find(e, "on")) return false;
    const Attribute* size = find(e, "size");
    return !size || (head.moved && !find(e, "at")) || head.turned ||
           std::any_of(e.after.begin(), e.after.end(), isOfScope) ||
           std::any_of(e.before.begin(), e.before.end(), isOfScope);
}

/// Whether the solid makes its scope as high as itself, as roofs do: no group has that scope.
bool hasOwnHeight(const Element& e) {
    const field::Primitive* row = e.solid ? field::findPrimitive(e.solid->text) : nullptr;
    return row && row->plan == field::PlanUse::OwnHeight;
}

bool anyLeansOn(const Body& body, Head head);

bool elementLeansOn(const Element& e, Head head) {
    if (e.kind == Element::Kind::Shape || e.kind == Element::Kind::Group) return leansOn(e, head);
    if (e.body && anyLeansOn(*e.body, head)) return true;
    return std::any_of(e.cases.begin(), e.cases.end(),
                       [&](const syntax::Case& c) { return c.body && anyLeansOn(*c.body, head); });
}

bool anyLeansOn(const Body& body, Head head) {
    for (const auto& chain : body.siblings)
        for (const Element& e : chain)
            if (elementLeansOn(e, head)) return true;
    return false;
}

bool isDrawn(const Expr& e) {
    return e.kind == Expr::Kind::Range || e.kind == Expr::Kind::Choose ||
           std::any_of(e.args.begin(), e.args.end(), [](const Expr& arg) { return isDrawn(arg); });
}
/// Whether the value counts the repetition that it stands in.
bool counts(const Expr& e) {
    return (e.kind == Expr::Kind::Name && e.text == "i") || std::any_of(e.args.begin(), e.args.end(), counts);
}
/// The same wherever it stands: neither of the scope nor drawn by chance.
bool isPlain(const Attribute& a) {
    return !isOfScope(a) && std::none_of(a.args.begin(), a.args.end(), [](const Expr& arg) { return isDrawn(arg); });
}
/// A newcomer that leans on the first shape by its size alone, or not at all.
bool takesSize(const Element& e) {
    if (e.kind != Element::Kind::Shape) return !elementLeansOn(e, {});
    return !leansOn(e, {}) ||
           (!find(e, "size") && e.solid && std::none_of(e.after.begin(), e.after.end(), isOfScope) && e.before.empty());
}

class Rewriter {
public:
    explicit Rewriter(const syntax::Ast& ast) : ast_(ast) {}

    Upgrade run() {
        for (const auto& d : ast_.starts) body(d.body);
        for (const auto& d : ast_.rules) {
            neighbour(d);
            body(d.body);
            if (d.finally_) body(*d.finally_);
        }
        version();
        std::stable_sort(result_.notes.begin(), result_.notes.end(),
                         [](const auto& a, const auto& b) { return a.span.begin < b.span.begin; });
        result_.text = written();
        return std::move(result_);
    }

private:
    struct Edit {
        uint32_t begin, end;
        std::string text;
    };

    void note(SourceSpan span, std::string message, std::string hint) {
        result_.notes.push_back({syntax::Severity::Warning, span, std::move(message), std::move(hint)});
    }
    void replace(SourceSpan span, std::string text) { edits_.push_back({span.begin, span.end, std::move(text)}); }
    void insert(uint32_t at, std::string text) { edits_.push_back({at, at, std::move(text)}); }

    void version() {
        const std::string_view text = ast_.source->text();
        const size_t word = text.find("grammar");
        const size_t number = word == std::string_view::npos ? word : text.find('1', word);
        if (number != std::string_view::npos)
            edits_.push_back({static_cast<uint32_t>(number), static_cast<uint32_t>(number + 1), "2"});
    }

    /// A plain rule that was drawn against `beside` loses now.
    void neighbour(const syntax::RuleDecl& rule) {
        if (rule.beside.empty() || rule.when) return;
        for (const auto& other : ast_.rules)
            if (other.symbol.text == rule.symbol.text && other.beside.empty() && !other.when)
                return note(rule.symbol.span,
                            fmt::format("beside a '{}' this rule wins now; it was drawn by weight against the one of "
                                        "line {}",
                                        rule.beside.text, ast_.source->place(other.symbol.span.begin).line),
                            "where both shall be drawn, choose between them within one rule");
    }

    void body(const Body& b) {
        for (const auto& chain : b.siblings) {
            frame(chain);
            for (const Element& e : chain) element(e);
        }
    }

    void element(const Element& e) {
        if (!moved_.contains(&e)) {
            order(e.before);
            order(e.after);
        }
        stretch(e);
        for (const auto* list : {&e.before, &e.after})
            for (const Attribute& a : *list) cases(a.cases);
        cases(e.cases);
        if (e.body) body(*e.body);
    }

    void cases(const std::vector<syntax::Case>& all) {
        for (const syntax::Case& c : all) {
            if (c.repeated) sizes(c.cases);
            cases(c.cases);
            if (c.body) body(*c.body);
        }
    }

    /// Sizes in `{ … }*` are drawn and counted for every repetition now.
    void sizes(const std::vector<syntax::Case>& repeated) {
        for (const syntax::Case& c : repeated)
            if (c.label && (isDrawn(*c.label) || counts(*c.label)))
                note(c.label->span, "this size is drawn and counted anew for every repetition now",
                     "where all shall be alike, draw it before: 'let w = …' at the beginning of the body");
    }

    /// A size that mixes shares and lengths stretches the plan of its scope now.
    void stretch(const Element& e) {
        const Attribute* size = find(e, "size");
        if (size && hasPlans_ && std::any_of(size->args.begin(), size->args.end(), isMixed))
            note(size->span, "over a plan this size stretches the plan now; it was that of a box",
                 "where a box is meant, write 'scope.x' for 100%");
    }

    /// `turn 90deg size 50%`: the share was of the axes before the turn, so the size comes first.
    void order(const std::vector<Attribute>& list) {
        const Attribute *turn = find(list, "turn"), *size = find(list, "size");
        if (!turn || !size || turn->span.begin > size->span.begin || !isOfScope(*size)) return;
        replace(turn->span, std::string(size->span.text()));
        replace(size->span, std::string(turn->span.text()));
        note(size->span, "shares behind a 'turn' follow it now: the size was put before it", "");
    }

    /// What a chain's first shape was made of its scope goes before a group of all of them, whose scope it becomes.
    void frame(const std::vector<Element>& chain) {
        const auto head =
            std::find_if(chain.begin(), chain.end(), [](const Element& e) { return e.kind != Element::Kind::Let; });
        if (head == chain.end() || head->op != syntax::Operator::None || std::next(head) == chain.end()) return;
        if (head->kind != Element::Kind::Shape && head->kind != Element::Kind::Group) return;
        std::vector<const Attribute*> scope;
        bool others = false;
        for (const Attribute& a : head->after)
            if (a.operation->phase == Operation::Phase::Scope) {
                const bool simple = a.name.text == "size" || a.name.text == "move" || a.name.text == "turn";
                simple ? scope.push_back(&a) : void(others = true);
            }
        const bool prefixed = !head->before.empty();
        others = others || hasOwnHeight(*head);
        if (scope.empty() && !others && !prefixed) return;
        const Head stand{find(*head, "turn") != nullptr, others || find(*head, "move") != nullptr};
        if (std::none_of(std::next(head), chain.end(), [&](const Element& e) { return elementLeansOn(e, stand); }))
            return;
        if (others || (!head->solid && head->kind == Element::Kind::Shape))
            return note(head->span, "shapes behind this one are measured by the matched scope now, not by this one's",
                        "group them, with what makes the scope before the group");
        if (scope.size() == 1 && !prefixed && find(*head, "size") == scope[0] && isPlain(*scope[0]) &&
            std::all_of(std::next(head), chain.end(), takesSize))
            return giveSize(*head, std::span(&*std::next(head), &*chain.begin() + chain.size()), *scope[0]);
        move(chain, *head, std::move(scope));
    }

    /// What was as large as the chain's first shape says that size itself.
    void giveSize(const Element& head, std::span<const Element> others, const Attribute& size) {
        for (const Element& e : others)
            if (leansOn(e, {})) insert(e.solid->span.end, " " + std::string(size.span.text()));
        note(head.span, "shapes behind this one were as large as it: they have its size of their own now", "");
    }

    void move(const std::vector<Element>& chain, const Element& head, std::vector<const Attribute*> scope) {
        const auto rank = [](const Attribute* a) {
            return a->name.text == "move" ? 0 : a->name.text == "size" ? 1 : 2;
        };
        std::stable_sort(scope.begin(), scope.end(), [&](auto* a, auto* b) { return rank(a) < rank(b); });
        std::string prefix;
        const std::string_view text = ast_.source->text();
        for (const Attribute* a : scope) {
            prefix += std::string(a->span.text()) + " ";
            uint32_t begin = a->span.begin;
            while (begin > 0 && (text[begin - 1] == ' ' || text[begin - 1] == '\t')) --begin;
            edits_.push_back({begin, a->span.end, ""});
        }
        const uint32_t at = head.before.empty() ? head.span.begin : head.before.back().span.end;
        insert(at, (head.before.empty() ? "" : " ") + prefix + "(");
        insert(chain.back().span.end, ")");
        moved_.insert(&head);
        note(head.span, "shapes behind this one were measured by it: its scope stands before a group of them now",
             "what these shapes draw by chance differs");
    }

    /// The text with all edits; of two at one place the one noted first comes first.
    std::string written() {
        std::stable_sort(edits_.begin(), edits_.end(), [](const Edit& a, const Edit& b) {
            return std::tie(a.begin, a.end) < std::tie(b.begin, b.end);
        });
        const std::string_view text = ast_.source->text();
        std::string out;
        uint32_t from = 0;
        for (const Edit& e : edits_) {
            if (e.begin < from) continue;
            out += text.substr(from, e.begin - from);
            out += e.text;
            from = e.end;
        }
        return out + std::string(text.substr(from));
    }

    const syntax::Ast& ast_;
    const bool hasPlans_ = ast_.source->text().find("footprint") != std::string_view::npos;
    Upgrade result_;
    std::vector<Edit> edits_;
    std::set<const Element*> moved_;
};

}  // namespace

Upgrade upgraded(const syntax::Ast& ast) {
    if (ast.version != 1) return {std::string(ast.source->text()), {}};
    return Rewriter(ast).run();
}

}  // namespace sgm::rules
