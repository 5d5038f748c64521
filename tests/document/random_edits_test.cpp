// A thousand edits by chance through the panels' calls: text and tree agree after every one, and undoing all restores
// the bytes. What the tree should be is found without the text: the same change is made to a syntax tree of its own.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "grammar/operations/operations.h"
#include "modeler/core/random.h"
#include "tests/document/texts.h"
#include "tests/fuzz_keys.h"
#include "viewer/document/nodes.h"

namespace sgm::document {
namespace {

using edits::Edit;
using syntax::Ast;
using syntax::Attribute;
using syntax::Body;
using syntax::Element;
using syntax::Operator;
using syntax::RuleDecl;
using Id = const syntax::Operation*;

/// Elements of a tree in the order of the text, the same in trees of the same text.
std::vector<std::pair<Body*, std::pair<size_t, size_t>>> elementsOf(const Ast& ast) {
    std::vector<std::pair<Body*, std::pair<size_t, size_t>>> list;
    edits::forBodies(ast, [&](const Body& body) {
        for (size_t s = 0; s < body.siblings.size(); ++s)
            for (size_t i = 0; i < body.siblings[s].size(); ++i) list.push_back({const_cast<Body*>(&body), {s, i}});
    });
    return list;
}

bool isControl(const Element& e) { return e.kind != Element::Kind::Shape && e.kind != Element::Kind::Group; }

/// Edits a document and a tree side by side.
class Twins {
public:
    explicit Twins(const std::string& text) : document(text), first(text) {}

    /// One edit by chance; false when the verb was refused.
    bool step(uint64_t key) {
        key_ = key;
        expected = parsed(document.text());
        const Edit edit = change();
        if (!edit.ok()) return false;
        const std::string before = document.text();
        if (edit->empty()) return false;
        EXPECT_TRUE(document.apply(*edit, "edit").ok());
        compare(before);
        return true;
    }

    Document document;
    std::string first;

private:
    uint64_t draw(uint64_t count) { return pick(key_ = mix(key_), count); }
    template <class T>
    T one(std::initializer_list<T> list) {
        return *(list.begin() + draw(list.size()));
    }
    syntax::Expr expression(const std::string& text) {
        syntax::Diagnostics problems;
        sources_.push_back(std::make_shared<const syntax::Source>("e", text));
        return syntax::parseExpression(sources_.back(), problems);
    }

    Edit change() {
        if (!expected.rules.empty() && draw(3) == 0) return changeRule();
        return changeElement();
    }

    /// How a `derive` line calls a rule.
    static std::string called(const std::vector<RuleDecl>& rules, const RuleDecl& rule) {
        if (!rule.name.empty()) return rule.name.text;
        int number = 0;
        for (const RuleDecl* r = rules.data(); r <= &rule; ++r)
            number += r->name.empty() && r->symbol.text == rule.symbol.text;
        return rule.symbol.text + "#" + std::to_string(number);
    }

    /// `derive` lines go on meaning the same rules, which are known again by a number kept in their spans.
    Edit changeRule() {
        for (size_t k = 0; k < expected.rules.size(); ++k) expected.rules[k].span.begin = static_cast<uint32_t>(k) + 1;
        const std::vector<RuleDecl> before = expected.rules;
        Edit edit = changeRuleAlone();
        for (syntax::DeriveDecl& way : expected.derives)
            for (auto& step : way.steps) {
                const auto was = std::find_if(before.begin(), before.end(),
                                              [&](const RuleDecl& r) { return called(before, r) == step.rule.text; });
                if (was == before.end()) continue;
                const auto is = std::find_if(expected.rules.begin(), expected.rules.end(),
                                             [&](const RuleDecl& r) { return r.span.begin == was->span.begin; });
                if (is != expected.rules.end())
                    step.rule.text = called(expected.rules, *is);
                else if (was->name.empty())
                    step.rule.text = was->symbol.text + "#" +
                                     std::to_string(std::count_if(before.begin(), before.end(), [&](const RuleDecl& r) {
                                         return r.name.empty() && r.symbol.text == was->symbol.text;
                                     }));
            }
        return edit;
    }

    Edit changeRuleAlone() {
        const Ast& now = *document.ast();
        const size_t i = draw(now.rules.size()), j = draw(now.rules.size());
        std::vector<RuleDecl>& rules = expected.rules;
        const auto at = [&](size_t k) { return rules.begin() + static_cast<ptrdiff_t>(k); };
        const std::string value = one<std::string>({"1", "i + 2", "floors > 2", "(1, 2, 3)[0] < 4", "not true"});
        const auto set = [&](std::optional<syntax::Expr>& part) {
            part = draw(3) ? std::optional(expression(value)) : std::nullopt;
            return part ? value : "";
        };
        switch (draw(8)) {
            case 0: {
                const Edit edit = edits::removeRule(now, now.rules[i]);
                rules.erase(at(i));
                return edit;
            }
            case 1: {
                const Edit edit = edits::duplicateRule(now, now.rules[i]);
                RuleDecl copy = rules[i];
                if (edit.ok() && !copy.name.empty())
                    copy.name.text = parsed(applied(document.text(), *edit)).rules[i + 1].name.text;
                copy.span.begin = 0;
                for (const RuleDecl& r : rules) EXPECT_TRUE(copy.name.empty() || r.name.text != copy.name.text);
                rules.insert(at(i + 1), std::move(copy));
                return edit;
            }
            case 2: {
                const bool last = draw(4) == 0;
                const Edit edit = edits::moveRule(now, now.rules[i], last ? nullptr : &now.rules[j]);
                RuleDecl moved = rules[i];
                const size_t to = last ? rules.size() : j;
                if (!last && i == j) return edit;
                rules.insert(at(to), moved);
                rules.erase(at(to <= i ? i + 1 : i));
                return edit;
            }
            case 3: {
                const std::string symbol = now.rules[i].symbol.text;
                const Edit edit = edits::addRule(now, symbol, "+ sphere at +y : " + symbol, &now.rules[i]);
                rules.insert(at(i + 1), kept("grammar 1\nrule " + symbol + " -> + sphere at +y : " + symbol).rules[0]);
                rules[i + 1].span.begin = 0;
                return edit;
            }
            case 4:
                return edits::setGuard(now, now.rules[i], set(rules[i].when));
            case 5:
                return edits::setWeight(now, now.rules[i], set(rules[i].weight));
            case 6:
                return edits::setRepeat(now, now.rules[i], set(rules[i].repeat));
            default: {
                const std::string name = draw(2) ? "N" + std::to_string(draw(1000)) : "";
                rules[i].name.text = name;
                return edits::setName(now, now.rules[i], name);
            }
        }
    }

    /// What `removeElement` says it does.
    void erase(Body& body, size_t s, size_t i) {
        auto& chain = body.siblings[s];
        if (chain.size() > 1) {
            if (i == 0 && chain[0].op == Operator::None && !isControl(chain[1])) chain[1].op = Operator::None;
            chain.erase(chain.begin() + static_cast<ptrdiff_t>(i));
        } else if (body.siblings.size() > 1) {
            body.siblings.erase(body.siblings.begin() + static_cast<ptrdiff_t>(s));
        } else {
            body = parsedBody("nil");
        }
    }

    /// A tree whose text stays, since nodes of it go on to live in another.
    Ast kept(const std::string& text) {
        Ast ast = parsed(text);
        sources_.push_back(ast.source);
        return ast;
    }
    Body parsedBody(const std::string& text) { return kept("grammar 1\nrule A -> " + text).rules[0].body; }

    Edit changeElement() {
        const auto mine = elementsOf(*document.ast()), twin = elementsOf(expected);
        const size_t k = draw(mine.size());
        const auto [s, i] = mine[k].second;
        const Ast& now = *document.ast();
        const Element& element = mine[k].first->siblings[s][i];
        Body& body = *twin[k].first;
        auto& chain = body.siblings[s];
        Element& e = chain[i];
        switch (draw(9)) {
            case 0: {
                const Edit edit = edits::removeElement(now, element);
                if (edit.ok()) erase(body, s, i);
                return edit;
            }
            case 1: {
                const Edit edit = edits::duplicateElement(now, element);
                Element copy = e;
                if (copy.op == Operator::None && !isControl(copy)) copy.op = Operator::Sum;
                chain.insert(chain.begin() + static_cast<ptrdiff_t>(i + 1), std::move(copy));
                return edit;
            }
            case 2: {
                const Edit edit = edits::moveElement(now, element, 1);
                if (!edit.ok()) return edit;
                std::swap(chain[i], chain[i + 1]);
                if (i == 0 && chain[1].op == Operator::None && !isControl(chain[1]))
                    std::swap(chain[0].op, chain[1].op);
                return edit;
            }
            case 3: {
                const Operator op = one({Operator::Sum, Operator::Difference, Operator::Intersection, Operator::Morph});
                const Edit edit = edits::setOperator(now, element, op);
                if (op == e.op) return edit;
                e.op = op;
                if (op != Operator::Morph) drop(e, &operations::by);
                return edit;
            }
            case 4: {
                const std::string solid = one<std::string>({"cone", "Level", "morph(cube, sphere, .5)", "roof(.3)"});
                const Edit edit = edits::setSolid(now, element, solid);
                if (edit.ok()) e.solid = expression(solid);
                return edit;
            }
            case 5: {
                const std::string name = draw(3) ? "Live" + std::to_string(draw(5)) : "";
                e.live.text = name;
                return edits::setLive(now, element, name);
            }
            case 6: {
                const std::string text = one<std::string>({"+ torus size 2", "- cone at +x blend .2m",
                                                           "morph sphere by .4", "for d in axes { + cube at d }"});
                const Edit edit = edits::addElement(now, element, text);
                chain.insert(chain.begin() + static_cast<ptrdiff_t>(i + 1), parsedBody(text).siblings[0][0]);
                return edit;
            }
            case 7: {
                const Id id = one<Id>(
                    {&operations::size, &operations::shift, &operations::at, &operations::blend, &operations::rough});
                const Edit edit = edits::removeAttribute(now, element, *id);
                if (edit.ok()) drop(e, id);
                return edit;
            }
            default: {
                const Id id = one<Id>({&operations::size, &operations::shift, &operations::blend, &operations::rough,
                                       &operations::color});
                const std::string value =
                    id == &operations::color ? "#aabbcc"
                                             : one<std::string>({"2", "1 ~> .5", "floors + 1", "-.1..(.2)", "(a * b)"});
                const Edit edit = edits::setAttribute(now, element, *id, value);
                if (edit.ok()) put(e, id, expression(value));
                return edit;
            }
        }
    }

    static Attribute* find(Element& e, Id id) {
        for (auto* list : {&e.after, &e.before})
            for (Attribute& a : *list)
                if (a.operation == id) return &a;
        return nullptr;
    }
    static void drop(Element& e, Id id) {
        for (auto* list : {&e.after, &e.before})
            for (size_t i = 0; i < list->size(); ++i)
                if ((*list)[i].operation == id) {
                    list->erase(list->begin() + static_cast<ptrdiff_t>(i));
                    return;
                }
    }
    static void put(Element& e, Id id, syntax::Expr value) {
        if (Attribute* a = find(e, id)) {
            a->args = {std::move(value)};
            return;
        }
        Attribute a;
        a.operation = id;
        a.name.text = id->name;
        a.args = {std::move(value)};
        const bool only = !e.solid && e.kind == Element::Kind::Shape;
        (only ? e.before : e.after).push_back(std::move(a));
    }

    void compare(const std::string& before) {
        const std::string& text = document.text();
        ASSERT_FALSE(document.syntaxProblems().hasErrors()) << before << "\n--- became\n" << text;
        ASSERT_EQ(meaning(*document.ast()), meaning(expected)) << before << "\n--- became\n" << text;
        const std::string laidOut = syntax::format(*document.ast()->source, operations::table());
        ASSERT_EQ(meaning(parsed(laidOut)), meaning(expected)) << laidOut;
    }

    Ast expected;
    std::vector<syntax::SourcePtr> sources_;
    uint64_t key_ = 0;
};

size_t comments(const std::string& text) {
    size_t n = 0;
    for (size_t at = text.find("//"); at != std::string::npos; at = text.find("//", at + 2)) ++n;
    return n;
}

std::string fileText(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

TEST(RandomEdits, KeepTextAndTreeInAgreementAndUndoToTheBytes) {
    const FuzzKeys keys = fuzzKeys(1000);
    std::vector<std::string> texts{tower};
    for (const char* path : {"examples/figure1.sgm", "examples/grotto.sgm", "examples/joints.sgm", "examples/tower.sgm",
                             "grammar/std/cave.sgm", "tests/syntax/sketch.sgm"})
        texts.push_back(fileText(path));
    size_t done = 0, refused = 0;
    for (uint64_t round = keys.first; done < keys.count; ++round) {
        Twins twins(texts[round % texts.size()]);
        for (uint64_t k = 0; k < 40 && !HasFailure(); ++k) twins.step(combine(round, k)) ? ++done : ++refused;
        ASSERT_FALSE(HasFailure());
        const std::string last = twins.document.text();
        while (twins.document.history().canUndo()) twins.document.undo();
        ASSERT_EQ(twins.document.text(), twins.first);
        EXPECT_FALSE(twins.document.dirty());
        while (twins.document.history().canRedo()) twins.document.redo();
        ASSERT_EQ(twins.document.text(), last);
    }
    EXPECT_GT(done, 2 * refused);
}

/// Changes that take nothing away keep every comment.
TEST(RandomEdits, KeepComments) {
    Document document(tower);
    for (uint64_t k = 0; k < 200; ++k) {
        const auto list = elementsOf(*document.ast());
        const auto& [body, at] = list[pick(mix(k), list.size())];
        const Element& element = body->siblings[at.first][at.second];
        const Edit edit =
            k % 3 == 0   ? edits::setAttribute(*document.ast(), element, operations::size, std::to_string(k + 1))
            : k % 3 == 1 ? edits::setOperator(*document.ast(), element, k % 2 ? Operator::Sum : Operator::Difference)
                         : edits::moveElement(*document.ast(), element, 1);
        if (edit.ok()) {
            ASSERT_TRUE(document.apply(*edit, "edit").ok());
        }
        ASSERT_EQ(comments(document.text()), comments(tower)) << document.text();
    }
}

}  // namespace
}  // namespace sgm::document
