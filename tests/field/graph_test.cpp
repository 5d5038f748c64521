#include "modeler/field/graph.h"

#include <gtest/gtest.h>

#include <bit>
#include <vector>

#include "modeler/field/ops.h"

namespace sgm::field {
namespace {

TEST(Graph, EqualStructureIsOneNode) {
    Graph g;
    const NodeRef a = sqrt(g.x() + g.y()), b = sqrt(g.y() + g.x());
    EXPECT_EQ(a.id(), b.id());
    EXPECT_EQ(min(g.x(), g.z()).id(), min(g.z(), g.x()).id());
    EXPECT_NE((g.x() - g.y()).id(), (g.y() - g.x()).id());
    EXPECT_EQ(g.literal(0.5f).id(), g.literal(0.5f).id());
}

TEST(Graph, SlotsAreNeverMergedAndKeysKeepThem) {
    Graph g;
    const NodeRef a = g.slot({1, 2}, 5), b = g.slot({1, 3}, 5), c = g.slot(5), d = g.slot(5);
    EXPECT_NE(a.id(), b.id());
    EXPECT_NE(c.id(), d.id());
    EXPECT_EQ(g.slot({1, 2}, 7).id(), a.id());
    ASSERT_EQ(g.constants().size(), 4u);
    EXPECT_EQ(g.constants()[0], 7.0f);
    EXPECT_EQ(g.slotKeys()[1], (SlotKey{1, 3}));
}

TEST(Graph, StructureSurvivesANewNumber) {
    Graph g;
    const NodeRef before = g.x() * g.slot({1, 2}, 5);
    const size_t nodes = g.nodeCount();
    EXPECT_EQ((g.x() * g.slot({1, 2}, 6)).id(), before.id());
    EXPECT_EQ(g.nodeCount(), nodes);
}

TEST(Graph, OwnersArePartOfTheStructure) {
    Graph g;
    const Operand ab[] = {{g.x().id(), 1}, {g.y().id(), 2}}, ba[] = {{g.y().id(), 2}, {g.x().id(), 1}};
    const Operand other[] = {{g.x().id(), 2}, {g.y().id(), 1}};
    const NodeRef m = g.apply(codeOf<ops::Min>, ab);
    EXPECT_EQ(m.id(), g.apply(codeOf<ops::Min>, ba).id());
    EXPECT_NE(m.id(), g.apply(codeOf<ops::Min>, other).id());
    EXPECT_EQ(g.operands(m.id())[0].origin, 1u);
}

TEST(Graph, FoldsLiteralsAndWhatChangesNothing) {
    Graph g;
    const NodeRef five = g.literal(2) + g.literal(3);
    EXPECT_EQ(five.id(), g.literal(5).id());
    EXPECT_EQ((g.x() * 1.0f).id(), g.x().id());
    EXPECT_EQ((1.0f * g.x()).id(), g.x().id());
    EXPECT_EQ((g.x() - 0.0f).id(), g.x().id());
    EXPECT_EQ((g.x() / 1.0f).id(), g.x().id());
    EXPECT_NE((1.0f / g.x()).id(), g.x().id());
    EXPECT_EQ((g.x() * g.x()).id(), square(g.x()).id());
}

TEST(Graph, ManyNodesAreFoundAgain) {
    Graph g;
    std::vector<NodeId> first;
    const auto build = [&](uint64_t i) {
        return sqrt(g.x() - g.slot({i, 1}, 1.0f)) + g.slot({i, 2}, 2.0f) * static_cast<float>(i % 100 + 2);
    };
    for (uint64_t i = 0; i < 20000; ++i) first.push_back(build(i).id());
    const size_t nodes = g.nodeCount(), slots = g.constants().size();
    EXPECT_EQ(slots, 40000u);
    for (uint64_t i = 0; i < 20000; ++i) ASSERT_EQ(build(i).id(), first[i]);
    EXPECT_EQ(g.nodeCount(), nodes);
    EXPECT_EQ(g.constants().size(), slots);
}

TEST(HashIndex, TellsItemsOfOneHashApart) {
    HashIndex index;
    const auto item = [](uint32_t wanted) { return [wanted](uint32_t id) { return id == wanted; }; };
    EXPECT_EQ(index.find(7, item(0)), HashIndex::none);
    for (uint32_t id = 0; id < 500; ++id) index.insert(id % 2 ? 7 : 7 + (uint64_t{id} << 32), id);  // one low half
    for (uint32_t id = 0; id < 500; ++id) EXPECT_EQ(index.find(7, item(id)), id);
    EXPECT_EQ(index.find(8, item(3)), HashIndex::none);
}

TEST(Graph, CodesNameTheirRows) {
    EXPECT_EQ(traits(codeOf<ops::Min>).name, "min");
    EXPECT_TRUE(traits(codeOf<ops::Min>).commutative);
    EXPECT_TRUE(traits(codeOf<ops::Blend>).chooses);
    EXPECT_EQ(traits(codeOf<ops::Blend>).firstPrunable, 1u);
    EXPECT_FALSE(traits(codeOf<ops::Morph>).chooses);
    const int arity = visitOp(codeOf<ops::Atan2>, []<class Row>() { return Row::arity; });
    EXPECT_EQ(arity, 2);
}

}  // namespace
}  // namespace sgm::field
