// From surface to shape to text and back; dropping a shape on a joint.
#include "viewer/document/picking.h"

#include "tests/document/shown.h"

namespace sgm::document {
namespace {

constexpr const char* pair =
    "grammar 1\n"
    "start A -> cube size 2 : Body\n"
    "rule Grow: Body -> + sphere size 1 at +x : Arm\n"
    "rule Arm -> + cone size 1 at +y to -y + torus size 1 at -y\n";

class Picking : public testing::Test {
protected:
    derive::ShapeId find(const char* path) const { return tree().find(path); }
    const derive::ShapeTree& tree() const { return model->model.derivation.tree; }
    uint32_t at(std::string_view word) const { return static_cast<uint32_t>(document.text().find(word)); }

    Document document{pair};
    std::vector<RuleRow> rows = ruleRows(*document.ast());
    std::shared_ptr<const BuiltModel> model = shown(document);
};

TEST_F(Picking, OriginsLeadToShapesAndText) {
    size_t picked = 0;
    for (OriginId origin = 0; origin < model->model.lowered->shapeOf.size(); ++origin) {
        const auto found = pick(*model, origin);
        ASSERT_TRUE(found);
        EXPECT_EQ(selected(tree(), found->path), found->shape);
        const RuleRow row = rows[rowOf(rows, TextRange{found->element.begin, found->element.end})];
        const auto shapes = shapesOf(model->model.derivation, row);
        EXPECT_NE(std::find(shapes.begin(), shapes.end(), found->shape), shapes.end()) << found->path;
        picked +=
            found->symbol == "cone" && found->rule == "Arm#1" && found->element.text() == "+ cone size 1 at +y to -y";
    }
    EXPECT_EQ(picked, 1u);
    EXPECT_FALSE(pick(*model, 1000));
    const Picked cone = about(model->model.derivation, find("A/cone"));
    EXPECT_EQ(cone.ruleText.text().substr(0, 8), "rule Arm");
    EXPECT_EQ(elementOf(document, *model, cone.shape)->solid->text, "cone");
}

TEST_F(Picking, TextLeadsToShapes) {
    const auto labels = [&](uint32_t offset) {
        std::string list;
        for (const auto s : shapesOf(model->model.derivation, rows.at(rowAt(rows, offset))))
            list += tree().labels[tree().shapes[s].label] + " ";
        return list;
    };
    EXPECT_EQ(labels(at("cone size")), "cone ");
    EXPECT_EQ(labels(at("at -y")), "torus ");
    EXPECT_EQ(labels(at("rule Arm") + 1), "cone torus ") << "the head of a rule means all it made";
    EXPECT_EQ(labels(at("start")), "A ") << "what grew on it by rules is theirs";
}

TEST_F(Picking, OriginsOfASubtree) {
    const auto all = originsOf(*model, 0);
    EXPECT_EQ(all.size(), model->model.lowered->shapeOf.size());
    const auto cone = originsOf(*model, find("A/cone"));
    ASSERT_EQ(cone.size(), 1u);
    EXPECT_EQ(pick(*model, cone[0])->symbol, "cone");
}

TEST_F(Picking, DroppingOnAJointRetargets) {
    const derive::ShapeId cone = find("A/cone"), arm = find("A/Arm"), body = find("A/Body");
    ASSERT_TRUE(cone != derive::none && arm != derive::none && body != derive::none);
    const auto edit = attach(document, *model, cone, arm, 4);  // +z
    ASSERT_TRUE(edit.ok()) << edit.error().message;
    EXPECT_EQ(applied(pair, *edit), replaced(pair, "at +y to -y", "at +z"));
    const auto elsewhere = attach(document, *model, cone, body, 4);
    ASSERT_FALSE(elsewhere.ok());
    EXPECT_EQ(elsewhere.error().message,
              "'A/Body/Arm/cone' grows on 'A/Body/Arm': its rule can't join it to 'A/Body'; write 'rule Body -> + cone "
              "size 1 at +z' for one there, and take this one out");
    const auto plain = attach(document, *model, arm, cone, 2);
    ASSERT_FALSE(plain.ok());
    EXPECT_NE(plain.error().message.find("give 'cone' a name, as by ': Name', and write 'rule Name -> + sphere size 1 "
                                         "at +y : Arm'"),
              std::string::npos)
        << plain.error().message;
    EXPECT_FALSE(attach(document, *model, 0, arm, 0).ok());

    const auto hosts = hostsFor(document, *model, cone);
    ASSERT_TRUE(hosts.ok()) << hosts.error().message;
    EXPECT_EQ(*hosts, std::vector{arm}) << "only joints at which it can be joined light up";
    EXPECT_FALSE(hostsFor(document, *model, body).ok());

    // The edited model has the cone where it was dropped.
    ASSERT_TRUE(document.apply(*edit, "Attach").ok());
    EXPECT_FALSE(isCurrent(document, *model));
    EXPECT_FALSE(attach(document, *model, cone, arm, 0).ok());
    EXPECT_EQ(elementOf(document, *model, cone), nullptr);
    const auto now = shown(document);
    const derive::ShapeTree& moved = now->model.derivation.tree;
    EXPECT_NEAR(moved.shapes[moved.find("A/cone")].scope.centre.z, 1, 1e-9);
}

TEST(PickingUsedFiles, SaysWhereARuleForItsShapesHasToStand) {
    Document document("grammar 1\nuse \"std/house.sgm\" { floors = 2 }\nstart A -> House + torus at +x\n");
    const auto model = shown(document);
    const derive::ShapeTree& tree = model->model.derivation.tree;
    derive::ShapeId torus = derive::none;
    for (derive::ShapeId s = 0; s != derive::none; s = tree.next(s))
        if (tree.labels[tree.shapes[s].label] == "torus") torus = s;
    ASSERT_NE(torus, derive::none);
    size_t told = 0;
    for (derive::ShapeId s = 0; s != derive::none; s = tree.next(s)) {
        const auto edit = attach(document, *model, torus, s, 2);
        told += !edit.ok() && edit.error().message.find("house.sgm', where the rules of '") != std::string::npos;
    }
    EXPECT_GT(told, 0u);
}

TEST(PickingUsedFiles, SaysWhoseTextItIs) {
    Document document("grammar 1\nuse \"std/house.sgm\" { floors = 2 }\nstart A -> House\n");
    const auto model = shown(document);
    const derive::ShapeTree& tree = model->model.derivation.tree;
    derive::ShapeId foreign = derive::none;
    for (derive::ShapeId s = 0; s != derive::none; s = tree.next(s))
        if (tree.shapes[s].span.source != model->grammar->sources[0].get()) foreign = s;
    ASSERT_NE(foreign, derive::none);
    EXPECT_EQ(elementOf(document, *model, foreign), nullptr);
    const auto edit = attach(document, *model, foreign, 0, 0);
    ASSERT_FALSE(edit.ok());
    EXPECT_NE(edit.error().message.find("house.sgm"), std::string::npos);
}

}  // namespace
}  // namespace sgm::document
