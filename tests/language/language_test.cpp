// Names, completion, renaming, fixes and outlines of texts.
#include <gtest/gtest.h>

#include <algorithm>

#include "grammar/language/completion.h"
#include "grammar/language/edits.h"
#include "grammar/operations/operations.h"
#include "grammar/pipeline/files.h"
#include "grammar/syntax/declarations.h"

namespace sgm::language {
namespace {

constexpr const char* house = R"(grammar 1
use "std/walls.sgm"

// How many storeys there are.
param floors = 4 in 2..9 "Storeys" group House
param kind = flat of flat, steep
terminal gate = cube joint door at (.5, 0, 0) facing -z   // the way in

start House -> stone size (4, 3, 4) with wide = 2m : Storey
rule Grow: Storey repeat floors - 1 when kind == flat
  -> + stone size (wide, 3, 3) at +y : Storey
  finally + gate on last at +x to door
rule Storey -> for d in sides { + cube size 1 at d }
style Tall for House { floors = 8 }
check House { floors = 3 } expect count(Storey) >= 1
derive left: Grow
)";

class Language : public testing::Test {
protected:
    Analysis of(std::string text) {
        return analyze(std::make_shared<const syntax::Source>("test.sgm", std::move(text)), loader_);
    }
    std::vector<LibraryFile> library() const {
        std::vector<LibraryFile> files;
        for (auto& [name, source] : pipeline::standardFiles()) files.push_back({name, source});
        return files;
    }
    /// Labels offered at the '|' of a text.
    std::set<std::string> offered(std::string text) {
        const auto at = static_cast<uint32_t>(text.find('|'));
        text.erase(at, 1);
        std::set<std::string> labels;
        for (const Item& item : completionsAt(of(text), at, library())) labels.insert(item.label);
        return labels;
    }
    static uint32_t at(const std::string& text, const std::string& what, size_t skip = 0) {
        size_t found = text.find(what);
        while (skip-- > 0) found = text.find(what, found + 1);
        return static_cast<uint32_t>(found);
    }
    rules::Loader loader_ = pipeline::fileLoader();
};

TEST_F(Language, PositionsCountUtf16) {
    const syntax::Source source("", "// ä𝄞b\nx");
    EXPECT_EQ(positionOf(source, 9), (Position{0, 6})) << "behind ä (1) and the clef (2)";
    EXPECT_EQ(offsetOf(source, {0, 6}), 9u);
    EXPECT_EQ(offsetOf(source, {1, 0}), 11u);
    EXPECT_EQ(offsetOf(source, {1, 7}), 12u) << "the line's end";
    EXPECT_EQ(offsetOf(source, {9, 0}), 12u) << "the text's end";
    for (uint32_t offset : {0u, 3u, 5u, 9u, 10u, 12u}) EXPECT_EQ(offsetOf(source, positionOf(source, offset)), offset);
}

TEST_F(Language, NamesMeanWhatTheCheckerTakesThemFor) {
    const Analysis analysis = of(house);
    EXPECT_TRUE(analysis.diagnostics.all().empty()) << syntax::render(analysis.diagnostics.all()[0]);
    const auto kindAt = [&](const std::string& what, size_t skip = 0) {
        const Occurrence* o = occurrenceAt(analysis.file().names, at(house, what, skip));
        return o ? static_cast<int>(o->kind) : -1;
    };
    EXPECT_EQ(kindAt("floors"), static_cast<int>(NameKind::Parameter));
    EXPECT_EQ(kindAt("floors - 1"), static_cast<int>(NameKind::Parameter));
    EXPECT_EQ(kindAt("floors = 8"), static_cast<int>(NameKind::Parameter));
    EXPECT_EQ(kindAt("wide, 3"), static_cast<int>(NameKind::Value));
    EXPECT_EQ(kindAt("door\n"), static_cast<int>(NameKind::Joint));
    EXPECT_EQ(kindAt("d }\n"), static_cast<int>(NameKind::Local));
    EXPECT_EQ(kindAt("Grow\n"), static_cast<int>(NameKind::Rule));
    EXPECT_EQ(kindAt("Storey) >="), static_cast<int>(NameKind::Symbol));
    EXPECT_EQ(kindAt("stone"), static_cast<int>(NameKind::Symbol));
    EXPECT_EQ(kindAt("sides"), -1) << "a word of the language";
    EXPECT_EQ(referencesAt(analysis, at(house, "floors"), true).size(), 4u);
    EXPECT_EQ(referencesAt(analysis, at(house, "floors"), false).size(), 3u);
    EXPECT_EQ(referencesAt(analysis, at(house, "Storey\n"), true).size(), 5u);
}

TEST_F(Language, HoversTellDocsValuesAndFigures) {
    Analysis analysis = of(house);
    analysis.figures = figuresOf(analysis.grammar, nullptr);
    const auto told = [&](const std::string& what, size_t skip = 0) {
        return describe(analysis, *occurrenceAt(analysis.file().names, at(house, what, skip)));
    };
    EXPECT_NE(told("floors - 1").find("How many storeys there are."), std::string::npos) << told("floors - 1");
    EXPECT_NE(told("floors - 1").find("value: `4` in `2..9`"), std::string::npos) << told("floors - 1");
    EXPECT_NE(told("gate on").find("the way in"), std::string::npos) << told("gate on");
    EXPECT_NE(told("Grow").find("runs 4 times and makes 4 shapes"), std::string::npos) << told("Grow");
    EXPECT_NE(told("stone").find("walls.sgm"), std::string::npos);
    for (const auto* row : operations::table().rows()) EXPECT_NE(docOf(row->name).find(row->doc), std::string::npos);
    for (const auto& d : syntax::declarations()) EXPECT_FALSE(docOf(d.word).empty()) << d.word << " has no doc";
}

TEST_F(Language, CompletionKnowsThePlace) {
    const std::string head =
        "grammar 1\nuse \"std/walls.sgm\"\nparam floors = 2 in 1..9\nterminal gate = cube joint door at (0, 0, 1) "
        "facing +z\n";
    const auto has = [](const std::set<std::string>& all, std::initializer_list<const char*> wanted,
                        std::initializer_list<const char*> unwanted) {
        for (const char* w : wanted) EXPECT_TRUE(all.contains(w)) << w;
        for (const char* u : unwanted) EXPECT_FALSE(all.contains(u)) << u;
    };
    has(offered(head + "ru|"), {"rule", "param", "start", "use"}, {"cube", "size"});
    has(offered(head + "start A -> |"), {"cube", "gate", "stone", "size", "for", "House"}, {"floors", "rule"});
    has(offered(head + "start A -> cube |"), {"size", "at", "color", "split"}, {"cube", "rule"});
    has(offered(head + "start A -> cube size |"), {"floors", "max", "scope"}, {"cube", "stone"});
    has(offered(head + "start A -> cube size (1, fl|"), {"floors", "max"}, {"cube", "size"});
    has(offered(head + "start A -> cube + gate at |"), {"+x", "centre", "free", "door"}, {"cube", "floors"});
    has(offered(head + "start A -> cube + gate at free(|"), {"+x", "door"}, {"cube"});
    has(offered(head + "start A -> cube : |"), {"A"}, {"cube", "gate"});
    has(offered(head + "start A -> cube + gate on |"), {"last", "any", "each"}, {"cube"});
    has(offered(head + "start A -> split |"), {"x", "y", "z"}, {"cube"});
    has(offered(head + "start A -> cube\nrule A re|"), {"repeat", "when", "weight", "beside"}, {"cube"});
    has(offered(head + "start A -> cube\nrule A when |"), {"floors", "true"}, {"rule"});
    has(offered(head + "start A -> cube\nstyle Big { |"), {"floors"}, {"cube", "rule"});
    has(offered(head + "start A -> cube\nstyle Big for |"), {"A"}, {"cube"});
    has(offered(head + "start A -> cube\ncheck |"), {"A"}, {"cube"});
    has(offered("grammar 1\nuse \"|"), {"std/walls.sgm", "std/cave.sgm"}, {"cube"});
    has(offered(head + "start A -> cube // si|"), {}, {"size", "cube"});
    has(offered(head + "start A -> for d in sides { + cube at | }"), {"+x"}, {});
}

TEST_F(Language, LibraryNamesBringTheirUse) {
    const std::string text = "grammar 1\n\nstart A -> st";
    const Analysis analysis = of(text);
    const auto items = completionsAt(analysis, static_cast<uint32_t>(text.size()), library());
    const auto stone = std::find_if(items.begin(), items.end(), [](const Item& i) { return i.label == "stone"; });
    ASSERT_NE(stone, items.end());
    EXPECT_EQ(stone->use, "std/walls.sgm");
    EXPECT_EQ(useOffset(analysis), 10u);
}

TEST_F(Language, RenamesEverywhereOrSaysWhyNot) {
    const Analysis analysis = of(house);
    const auto renamed = [&](const std::string& what, const std::string& name) {
        auto edits = rename(analysis, at(house, what), name);
        if (!edits.ok()) return "refused: " + edits.error().message;
        std::string text = house;
        std::sort(edits->begin(), edits->end(),
                  [](const Edit& a, const Edit& b) { return a.span.begin > b.span.begin; });
        for (const Edit& e : *edits) text.replace(e.span.begin, e.span.end - e.span.begin, e.text);
        const Analysis after = of(text);
        EXPECT_TRUE(after.diagnostics.all().empty()) << text << syntax::render(after.diagnostics.all()[0]);
        EXPECT_EQ(text.find(what + " "), std::string::npos) << text;
        return std::to_string(edits->size());
    };
    EXPECT_EQ(renamed("floors", "levels"), "4");
    EXPECT_EQ(renamed("Storey repeat", "Level"), "5");
    EXPECT_EQ(renamed("wide", "broad"), "2");
    EXPECT_EQ(renamed("door", "way"), "2");
    EXPECT_EQ(renamed("Grow", "Rise"), "2");
    EXPECT_EQ(renamed("gate", "portal"), "2");
    EXPECT_EQ(renamed("d in", "side"), "2");
    EXPECT_EQ(renamed("floors", "kind"), "refused: there is already a 'kind'");
    EXPECT_EQ(renamed("floors", "rule"), "refused: 'rule' is a word of the language");
    EXPECT_EQ(renamed("gate", "Gate"), "refused: a terminal begins with a small letter");
    EXPECT_EQ(renamed("gate", "sphere"), "refused: 'sphere' is a solid");
    EXPECT_EQ(renamed("Storey repeat", "2nd"),
              "refused: '2nd' is no name: letters, digits and '_', beginning with no digit");
    EXPECT_EQ(renamed("stone", "rock"), "refused: 'stone' is declared in the standard library");
}

TEST_F(Language, OutlinesFoldsAndColoursStandWhereTheirThingsDo) {
    const Analysis analysis = of(house);
    std::string outline;
    for (const Entry& e : outlineOf(analysis)) outline += e.detail + ":" + e.name + " ";
    EXPECT_EQ(
        outline,
        "param:floors param:kind terminal:gate start:House rule of Storey:Grow rule:Storey style:Tall derive:left ");
    EXPECT_EQ(foldsOf(analysis), (std::vector<Fold>{{9, 11, false}}));
    const auto stretches = stretchesOf(analysis);
    EXPECT_TRUE(std::is_sorted(stretches.begin(), stretches.end(),
                               [](const Stretch& a, const Stretch& b) { return a.end <= b.begin; }));
    const auto kindOf = [&](const std::string& what) {
        const uint32_t begin = at(house, what);
        for (const Stretch& s : stretches)
            if (s.begin == begin) return static_cast<int>(s.kind);
        return -1;
    };
    EXPECT_EQ(kindOf("rule"), static_cast<int>(TokenKind::Keyword));
    EXPECT_EQ(kindOf("size"), static_cast<int>(TokenKind::Operation));
    EXPECT_EQ(kindOf("cube"), static_cast<int>(TokenKind::Solid));
    EXPECT_EQ(kindOf("stone"), static_cast<int>(TokenKind::Terminal));
    EXPECT_EQ(kindOf("// How"), static_cast<int>(TokenKind::Comment));
    EXPECT_EQ(kindOf("\"std"), static_cast<int>(TokenKind::Text));
}

}  // namespace
}  // namespace sgm::language
