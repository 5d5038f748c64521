// What becomes an object, and which triangles it holds.
#include "grammar/lower/objects.h"

#include <gtest/gtest.h>

#include "tests/lower/lowered.h"

namespace sgm {
namespace {

using namespace testing_;

const char* const street =
    "grammar 1\nterminal pane = cube\nstart Street -> House + House at +x\n"
    "rule House -> cube size (3, 3, 3) + Wing at +y with n = 4 with kind = 2m\n"
    "rule Wing -> Window + Window at +x\n"
    "rule Window -> pane size (1, 1, .2) + cylinder size (.1, 1, .1)\n";

struct Divided {
    Lowered model{street};
    ObjectTree tree;
    explicit Divided(const std::string& text) {
        const auto choice = lower::parseObjects(text);
        EXPECT_TRUE(choice.ok());
        auto made = lower::objectTree(model.derivation, *model.model, *choice);
        if (made.ok())
            tree = std::move(*made);
        else
            ADD_FAILURE() << made.error().message;
    }
    /// Names from the root, a level deeper in brackets.
    std::string outline(uint32_t node = 0) const {
        std::string text = tree.nodes[node].name, below;
        for (uint32_t i = 1; i < tree.nodes.size(); ++i)
            if (tree.nodes[i].parent == node) below += (below.empty() ? "" : " ") + outline(i);
        return below.empty() ? text : text + "(" + below + ")";
    }
    /// The object that holds the part at a path.
    std::string holderOf(const std::string& path) const {
        const auto& parts = model.model->provenance.parts;
        for (OriginId o = 1; o < parts.size(); ++o)
            if (parts[o].path == path) return tree.nodes[tree.nodeOf(o)].name;
        return "nobody";
    }
};

TEST(Objects, AreShapesOfASymbolUnderAllThatStandsAbove) {
    const Divided d("Window");
    EXPECT_EQ(d.outline(),
              "Street(group(House(cube(Wing(group_2(Window Window_2)))) House_2(cube_2(Wing_2(group_3(Window_3 "
              "Window_4))))))");
    EXPECT_EQ(d.holderOf("Street/group/House/cube"), "Street") << "no window above it: the rest is the root's";
    EXPECT_EQ(d.holderOf("Street/group/House[2]/cube/Wing/group/Window[2]/pane"), "Window_4");
    EXPECT_EQ(d.holderOf("Street/group/House[2]/cube/Wing/group/Window[2]/pane/cylinder"), "Window_4");
}

TEST(Objects, OfSeveralSymbolsGoToTheNearest) {
    const Divided d("House,pane");
    EXPECT_EQ(d.holderOf("Street/group/House/cube"), "House");
    EXPECT_EQ(d.holderOf("Street/group/House/cube/Wing/group/Window/pane/cylinder"), "pane");
    EXPECT_EQ(d.holderOf("Street/group/House[2]/cube/Wing/group/Window/pane"), "pane_3");
}

TEST(Objects, OfShapesAreThoseThatOwnSurface) {
    const Divided d("shape");
    EXPECT_EQ(d.outline(),
              "Street(group(House(cube(Wing(group_2(Window(pane(cylinder)) Window_2(pane_2(cylinder_2)))))) "
              "House_2(cube_2(Wing_2(group_3(Window_3(pane_3(cylinder_3)) Window_4(pane_4(cylinder_4))))))))");
    EXPECT_EQ(d.holderOf("Street/group/House/cube/Wing/group/Window[2]/pane"), "pane_2");
}

TEST(Objects, KnowRuleLineAndValues) {
    const Divided d("Wing");
    const ObjectNode& wing = d.tree.nodes[4];
    EXPECT_EQ(wing.path, "Street/group/House/cube/Wing");
    EXPECT_EQ(wing.symbol, "Wing");
    EXPECT_EQ(wing.rule, "House#1");
    EXPECT_EQ(wing.line, 4u);
    ASSERT_EQ(wing.values.size(), 3u);
    EXPECT_EQ(wing.values[0].first, "size");
    EXPECT_EQ(wing.values[1], (std::pair<std::string, ObjectValue>{"with n", 4.0}));
    EXPECT_EQ(wing.values[2], (std::pair<std::string, ObjectValue>{"with kind", 2.0}));
}

TEST(Objects, KnowTheirSolidWithItsArguments) {
    const Lowered model("grammar 1\nstart A -> roof(.35) size (2, 1, 2)\n");
    const auto tree = lower::objectTree(model.derivation, *model.model, *lower::parseObjects("shape"));
    ASSERT_TRUE(tree.ok());
    const auto& values = tree->nodes.back().values;
    ASSERT_EQ(values.size(), 3u);
    EXPECT_EQ(values[1], (std::pair<std::string, ObjectValue>{"solid", std::string("roof")}));
    EXPECT_EQ(values[2], (std::pair<std::string, ObjectValue>{"solid round", 0.35}));
}

TEST(Objects, OfUnknownSymbolsAreRefusedWithTheNearestName) {
    const Lowered model(street);
    const auto choice = lower::parseObjects("Windw");
    const auto tree = lower::objectTree(model.derivation, *model.model, *choice);
    ASSERT_FALSE(tree.ok());
    EXPECT_EQ(tree.error().kind, Error::Kind::Usage);
    EXPECT_NE(tree.error().message.find("no shape is called 'Windw' (did you mean 'Window'?)"), std::string::npos)
        << tree.error().message;
    for (const char* text : {"", ",", "Window,", "Window,,House"}) EXPECT_FALSE(lower::parseObjects(text).ok()) << text;
}

/// Likeness of each object called `name` in the street of a House rule's body, in order.
std::vector<uint64_t> likenessesOf(const std::string& text, const std::string& symbol) {
    const Lowered model("grammar 1\n" + text);
    const auto tree = lower::objectTree(model.derivation, *model.model, *lower::parseObjects(symbol));
    EXPECT_TRUE(tree.ok());
    std::vector<uint64_t> all;
    for (const ObjectNode& node : tree->nodes)
        if (node.symbol == symbol) all.push_back(node.likeness);
    return all;
}

TEST(Objects, AreAlikeWhereOnlyTheirPlaceDiffers) {
    const std::string street = "start Street -> cube for k in 1..3 { + House at +x to centre move (k * 3.7, k * .1, 0)";
    const std::string house = "rule House -> cube size 2 - cube size (.5, 1, 3) + prism size (2.2, 1, 2.2) at +y";
    const auto equal = likenessesOf(street + " }\n" + house + "\n", "House");
    ASSERT_EQ(equal.size(), 3u);
    EXPECT_NE(equal[0], 0u);
    EXPECT_EQ(equal[0], equal[1]);
    EXPECT_EQ(equal[0], equal[2]);
    for (const char* differs : {" turn (10deg * k)", " size (1 + k, 1, 1)", " with n = k"}) {
        SCOPED_TRACE(differs);
        const bool takesN = std::string(differs).find("with") != std::string::npos;
        const auto all = likenessesOf(
            street + differs + " }\n" + (takesN ? "rule House -> cube size (1, n, 1)" : house) + "\n", "House");
        ASSERT_EQ(all.size(), 3u);
        EXPECT_NE(all[0], all[1]);
    }
}

TEST(Objects, OfNoiseAndBlendsAreLikeNoOther) {
    const std::string street = "start Street -> cube for k in 1..2 { + House at +x to centre move (k * 3.7, 0, 0) }\n";
    for (const char* house : {"rule House -> cube size 2 displace fbm(.1m, 2/m, 2)\n",
                              "rule House -> cube size 2 + sphere size 1 at +y blend .2m\n"}) {
        SCOPED_TRACE(house);
        for (const uint64_t likeness : likenessesOf(street + house, "House")) EXPECT_EQ(likeness, 0u);
    }
}

TEST(Objects, OfAChainOfThousandsAreMadeWithoutRecursion) {
    const Lowered model(
        "grammar 1\nstart A -> cube size 1 : Step\nrule Step repeat 4000 -> + cube size 1 at +x : Step\n");
    const auto tree = lower::objectTree(model.derivation, *model.model, *lower::parseObjects("shape"));
    ASSERT_TRUE(tree.ok());
    EXPECT_GE(tree->nodes.size(), 4001u);
    for (uint32_t i = 1; i < tree->nodes.size(); ++i) ASSERT_LT(tree->nodes[i].parent, i);
}

}  // namespace
}  // namespace sgm
