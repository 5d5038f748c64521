#include "modeler/field/graph.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include "modeler/core/random.h"
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

/// Slots of few paths in any order are those that a map of keys gives, however they lie in runs.
TEST(Graph, SlotsAreFoundByTheirKeysInAnyOrder) {
    Graph g;
    std::map<std::pair<uint64_t, uint64_t>, std::pair<NodeId, float>> known;
    const auto add = [&](uint64_t path, uint64_t attribute, NodeRef node, float value) {
        const auto [at, isNew] = known.try_emplace({path, attribute}, node.id(), value);
        EXPECT_EQ(at->second.first, node.id()) << path << ' ' << attribute;
        at->second.second = value;
    };
    for (uint64_t i = 0; i < 4000; ++i) {
        const auto value = static_cast<float>(i);
        const uint64_t path = pick(mix(i), i % 3 == 0 ? 8 : 200), attribute = pick(mix(i + 1'000'000), 100);
        if (i % 5 == 0) {
            const std::array attributes{attribute, attribute + 1, attribute + 2};
            const auto made = g.slots(path, attributes, std::array{value, value + 1, value + 2});
            for (size_t k = 0; k < 3; ++k) add(path, attributes[k], made[k], value + static_cast<float>(k));
        } else {
            add(path, attribute, g.slot({path, attribute}, value), value);
        }
        if (i % 7 == 0) g.slot(value);
    }
    for (const auto& [key, slot] : known) {
        const SlotId id = g.node(slot.first).data;
        EXPECT_EQ(g.slotKeys()[id], (SlotKey{key.first, key.second}));
        EXPECT_EQ(g.constants()[id], slot.second);
    }
    EXPECT_EQ(g.constants().size(), known.size() + 572);
}

/// Nodes are one where a map of their contents has one, with room reserved or not.
TEST(Graph, NodesAreOneWhereTheirContentsAre) {
    for (const bool reserves : {false, true}) {
        Graph g;
        if (reserves) g.reserve(1000, 100);
        std::vector<NodeRef> nodes{g.x(), g.y(), g.z(), g.slot({1, 1}, 1), g.slot({1, 2}, 2)};
        std::map<std::tuple<uint16_t, NodeId, NodeId>, NodeId> known;
        size_t again = 0;
        for (uint64_t i = 0; i < 5000; ++i) {
            const OpCode op = i % 2 ? codeOf<ops::Sub> : codeOf<ops::Max>;
            const auto drawn = [&](uint64_t key, uint64_t among) {
                return pick(mix(key), std::min<uint64_t>(nodes.size(), among));
            };
            // Old ones, of which most pairs are known after a while, and old with new ones.
            const NodeRef a = nodes[drawn(i, 60)],
                          b = i % 3 == 0 ? nodes[drawn(i + 77, 8)] : nodes[nodes.size() - 1 - drawn(i + 77, 6)];
            const NodeRef made = g.apply(op, {a, b});
            const bool swaps = op == codeOf<ops::Max> && b.id() < a.id();
            const std::tuple content{static_cast<uint16_t>(op), swaps ? b.id() : a.id(), swaps ? a.id() : b.id()};
            const auto [at, isNew] = known.try_emplace(content, made.id());
            ASSERT_EQ(at->second, made.id()) << i;
            if (isNew)
                nodes.push_back(made);
            else
                ++again;
        }
        EXPECT_EQ(g.nodeCount(), nodes.size());
        EXPECT_GT(again, 100u);
    }
}

/// Boxes of a row, set in any order, are those that are made one by one, and are found again.
TEST(Graph, BoxesOfARowAreThoseMadeOneByOne) {
    constexpr size_t count = 50;
    const auto boxAt = [](size_t i) {
        Graph::Box box{mix(i), {}};
        for (size_t k = 0; k < box.numbers.size(); ++k) box.numbers[k] = static_cast<float>(10 * i + k);
        return box;
    };
    Graph single, row;
    std::vector<NodeRef> boxes;
    const auto makeOne = [](Graph& g, const Graph::Box& box) {
        const auto n = g.slots(box.path, Graph::boxAttributes, box.numbers);
        return g.apply(codeOf<ops::Box>, {g.x(), g.y(), g.z(), n[0], n[1], n[2], n[3], n[4], n[5]});
    };
    for (Graph* g : {&single, &row}) EXPECT_EQ(min(g->position().x, sqrt(g->position().z)).id(), 4u);
    single.y(), row.y();
    for (size_t i = 0; i < count; ++i) boxes.push_back(makeOne(single, boxAt(i)));
    const NodeId first = row.addBoxes(count);
    for (size_t i = count; i-- > 0;) row.setBox(first, i, row.position(), boxAt(i));
    for (Graph* g : {&single, &row}) min(g->x(), NodeRef(g, boxes[7].id()));  // both go on
    ASSERT_EQ(row.nodeCount(), single.nodeCount());
    for (NodeId id = 0; id < row.nodeCount(); ++id) {
        EXPECT_EQ(row.node(id).op, single.node(id).op) << id;
        EXPECT_EQ(row.node(id).data, single.node(id).data) << id;
        EXPECT_TRUE(std::equal(row.operands(id).begin(), row.operands(id).end(), single.operands(id).begin(),
                               single.operands(id).end()))
            << id;
    }
    EXPECT_TRUE(std::equal(row.slotKeys().begin(), row.slotKeys().end(), single.slotKeys().begin()));
    EXPECT_TRUE(std::equal(row.constants().begin(), row.constants().end(), single.constants().begin()));
    const size_t nodes = row.nodeCount();
    for (size_t i = 0; i < count; ++i) EXPECT_EQ(makeOne(row, boxAt(i)).id(), boxes[i].id());
    EXPECT_EQ(row.nodeCount(), nodes);
    EXPECT_EQ(row.constants().size(), count * Graph::boxAttributes.size());
}

/// A path that was said to be new has its slots found like any other's, also once others came between.
TEST(Graph, SlotsOfABegunPathAreFoundAgain) {
    Graph g;
    std::vector<NodeId> slots;
    const auto slotsOf = [&](uint64_t path, auto&& fn) {
        for (uint64_t attribute = 0; attribute < 300; ++attribute) fn(g.slot({mix(path), mix(attribute)}, 1.0f));
    };
    for (uint64_t path = 0; path < 20; ++path) {
        if (path % 2 == 0) g.beginPath(mix(path));
        slotsOf(path, [&](NodeRef slot) { slots.push_back(slot.id()); });
        const uint64_t before = path / 2;
        EXPECT_EQ(g.slot({mix(before), mix(3)}, 1.0f).id(), slots[before * 300 + 3]);
    }
    g.beginPath(mix(100));  // and never asked for
    ASSERT_EQ(g.constants().size(), slots.size());
    size_t at = 0;
    for (uint64_t path = 0; path < 20; ++path) slotsOf(path, [&](NodeRef slot) { EXPECT_EQ(slot.id(), slots[at++]); });
    EXPECT_EQ(g.constants().size(), slots.size());
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
    EXPECT_EQ(m.id(), g.apply(codeOf<ops::Min>, ab).id());
    EXPECT_NE(m.id(), g.apply(codeOf<ops::Min>, ba).id()) << "the first of equal ones owns the surface";
    EXPECT_EQ(g.apply(codeOf<ops::Min>, {g.x(), g.y()}).id(), g.apply(codeOf<ops::Min>, {g.y(), g.x()}).id());
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
