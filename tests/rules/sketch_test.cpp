// The built part of the language's sketch, and what it became.
#include <gtest/gtest.h>

#include <algorithm>

#include "grammar/operations/operations.h"
#include "modeler/core/conventions.h"
#include "modeler/core/random.h"
#include "tests/rules/read.h"

namespace sgm::rules {
namespace {

using Id = const Operation*;

class Sketch : public testing::Test {
protected:
    static void SetUpTestSuite() { sketch_ = new Checked(checked(readText("tests/rules/sketch.sgm"))); }
    static void TearDownTestSuite() { delete sketch_; }
    void SetUp() override { ASSERT_TRUE(sketch_->grammar) << sketch_->messages(); }

    const Grammar& grammar() const { return *sketch_->grammar; }
    const Rule& rule(const std::string& name) const {
        const auto found =
            std::find_if(grammar().rules.begin(), grammar().rules.end(), [&](const Rule& r) { return r.name == name; });
        return found == grammar().rules.end() ? grammar().rules.at(999) : *found;
    }
    const std::string& symbol(SymbolId id) const { return grammar().symbols.at(id).name; }
    const Symbol& symbolCalled(const std::string& name) const {
        return *std::find_if(grammar().symbols.begin(), grammar().symbols.end(),
                             [&](const Symbol& s) { return s.name == name; });
    }
    static const Attribute& attribute(const Element& e, Id id) {
        return *std::find_if(e.attributes.begin(), e.attributes.end(),
                             [&](const Attribute& a) { return a.operation == id; });
    }

    static inline Checked* sketch_ = nullptr;
};

TEST_F(Sketch, ChecksWithoutAWord) { EXPECT_EQ(sketch_->messages(), ""); }

TEST_F(Sketch, CaveIsOneMorphicChain) {
    const Rule& cell = rule("Cell#1");
    EXPECT_TRUE(cell.morphic);
    EXPECT_TRUE(cell.body.grows);
    EXPECT_EQ(cell.stepLocal, 0u);
    EXPECT_EQ(cell.locals, 1u);
    ASSERT_TRUE(cell.repeat);
    EXPECT_EQ(cell.repeat->kind, Expr::Kind::Param);
    EXPECT_EQ(grammar().params[cell.repeat->index].name, "cells");

    const Element& e = cell.body.siblings.at(0).at(0);
    EXPECT_EQ(e.op, Operator::Sum);
    EXPECT_EQ(symbol(e.live), "Cell");
    EXPECT_EQ(e.label, "morph");
    ASSERT_EQ(e.content.solid()->kind, Solid::Kind::Morph);
    EXPECT_EQ(e.content.solid()->parts.at(0).primitive->name, "sphere");
    EXPECT_EQ(e.content.solid()->parts.at(1).primitive->name, "cube");
    EXPECT_EQ(e.content.solid()->amount.kind, Expr::Kind::Param);
}

TEST_F(Sketch, CaveAttributesCarryJointsUnitsAndDraws) {
    const Element& e = rule("Cell#1").body.siblings[0][0];
    const Attribute& size = attribute(e, &operations::size);
    ASSERT_EQ(size.args.at(0).kind, Expr::Kind::Ramp);
    EXPECT_EQ(size.args[0].args.at(0).value, Value::number(2, Unit::Metre));
    const JointChoice& at = *e.at;
    EXPECT_TRUE(at.free);
    ASSERT_EQ(at.joints.size(), 3u);
    EXPECT_EQ(at.joints[2].value.kind, Value::Kind::Axis);
    EXPECT_EQ(at.joints[2].value.num(), 4);
    EXPECT_EQ(e.to->joints.at(0).value.num(), 6) << "centre";
    const Expr& shift = attribute(e, &operations::shift).args.at(0);
    EXPECT_EQ(shift.kind, Expr::Kind::Range);
    EXPECT_EQ(shift.draw, hashText("shift"));
    EXPECT_EQ(static_cast<Fn>(shift.args.at(0).index), Fn::Neg);
}

TEST_F(Sketch, CloudLoopsOverAxesAndSteps) {
    const Rule& puff = rule("Puff#1");
    EXPECT_FALSE(puff.morphic);
    EXPECT_TRUE(puff.finallyMorphic);
    EXPECT_EQ(puff.locals, 3u) << "i, d, k";
    EXPECT_TRUE(puff.body.grows);
    const Element& axes = puff.body.siblings[0][0];
    ASSERT_EQ(axes.kind, Element::Kind::For);
    EXPECT_EQ(axes.local, 1u);
    ASSERT_EQ(axes.over->kind, Expr::Kind::Tuple);
    ASSERT_EQ(axes.over->args.size(), 6u);
    for (size_t i = 0; i < 6; ++i) EXPECT_EQ(axes.over->args[i].value.num(), i);
    EXPECT_EQ(axes.guard->args.at(0).kind, Expr::Kind::Element);
    const Element& steps = axes.body->siblings[0][0];
    EXPECT_EQ(steps.over->kind, Expr::Kind::Range);
    EXPECT_EQ(steps.over->args.at(1).index, puff.stepLocal);
    const Element& sphere = steps.body->siblings[0][0];
    EXPECT_EQ(sphere.on->kind, HostChoice::Kind::Any);
    EXPECT_EQ(sphere.on->of.index, axes.local);
    EXPECT_EQ(sphere.at->joints.at(0).kind, Expr::Kind::Local);
    const Element& torus = puff.finally_->siblings[0][0];
    EXPECT_EQ(torus.op, Operator::Morph);
    EXPECT_EQ(attribute(torus, &operations::by).args.at(0).value, Value::number(.2));
    EXPECT_EQ(torus.content.solid()->args.at(0).value.num(), torus.content.solid()->primitive->parameters[0].fallback)
        << "default filled in";
}

TEST_F(Sketch, BuildingChoosesItsProfileByGuard) {
    const Rule& convex = rule("Level#1");
    EXPECT_FALSE(convex.body.grows);
    ASSERT_TRUE(convex.when);
    EXPECT_EQ(static_cast<Fn>(convex.when->index), Fn::Equal);
    EXPECT_EQ(convex.when->args.at(1).value.text, "convex");
    const auto& chain = convex.body.siblings[0];
    ASSERT_EQ(chain.size(), 2u);
    EXPECT_EQ(chain[1].over->args.size(), 4u) << "sides";
    EXPECT_EQ(attribute(chain[1].body->siblings[0][0], &operations::size).args[0].value,
              Value::number(.3, Unit::Share));
    EXPECT_EQ(rule("Level#2").body.siblings[0][1].body->siblings[0][0].op, Operator::Difference);
    EXPECT_EQ(symbolCalled("Level").rules.size(), 3u);

    const Rule& storey = rule("Storey#1");
    const Expr& size = attribute(storey.body.siblings[0][0], &operations::size).args[0];
    ASSERT_EQ(size.kind, Expr::Kind::Tuple);
    EXPECT_EQ(size.args.at(1).kind, Expr::Kind::Ramp);
    const Element& roof = storey.finally_->siblings[0][0];
    EXPECT_EQ(roof.content.solid()->args.at(0).kind, Expr::Kind::Param);
    EXPECT_EQ(roof.on->kind, HostChoice::Kind::Last);
    EXPECT_FALSE(storey.finallyMorphic);
}

TEST_F(Sketch, FigureOneHasItsTwoWays) {
    ASSERT_EQ(grammar().derives.size(), 2u);
    const Derive& right = grammar().derives[1];
    ASSERT_EQ(right.steps.size(), 3u);
    EXPECT_EQ(grammar().rules[right.steps[1].rule].name, "R2");
    EXPECT_TRUE(rule("R2").morphic);
    EXPECT_FALSE(rule("R3").morphic);
    EXPECT_FALSE(rule("R1").body.grows);
    EXPECT_EQ(rule("R4").body.siblings.size(), 2u) << "cone : F, torus : G";
}

TEST_F(Sketch, TerminalsBecomeSymbolsWithMaterials) {
    const Symbol& wall = symbolCalled("wall");
    EXPECT_TRUE(wall.terminal);
    const Material& material = grammar().materials.at(wall.material);
    EXPECT_EQ(material.name, "wall");
    EXPECT_NEAR(material.color.x, 0.578, 0.001) << "#c8 as linear light";
    EXPECT_FLOAT_EQ(material.roughness, .8f);
    EXPECT_EQ(symbolCalled("facade").material, none);
    const Symbol& gate = symbolCalled("gate");
    ASSERT_EQ(gate.joints.size(), 1u);
    EXPECT_EQ(gate.joints[0].at, (Vec3d{1, 0, 0})) << "half a unit is one half-size";
    EXPECT_EQ(gate.joints[0].facing, (Vec3d{0, 0, -1}));
}

TEST_F(Sketch, KifsTakesNamedArguments) {
    const Solid& ornate = *symbolCalled("ornate").solid;
    ASSERT_EQ(ornate.primitive->name, "kifs");
    ASSERT_EQ(ornate.args.size(), ornate.primitive->parameters.size());
    for (size_t i = 0; i < ornate.args.size(); ++i) {
        const std::string_view name = ornate.primitive->parameters[i].name;
        if (name == "center") {
            EXPECT_EQ(ornate.args[i].value.n[2], .33);
        }
        if (name == "passes") {
            EXPECT_EQ(ornate.args[i].value.num(), 6);
        }
        if (name == "fold") {
            EXPECT_EQ(static_cast<Fn>(ornate.args[i].index), Fn::RotY);
        }
        if (name == "turn") {
            EXPECT_EQ(ornate.args[i].value.kind, Value::Kind::Rotation) << "default";
        }
    }
}

TEST_F(Sketch, SaysItsStylesAndChecks) {
    const Style& ruin = grammar().styles.at(0);
    EXPECT_EQ(symbol(grammar().starts.at(ruin.start).symbol), "Cave");
    ASSERT_EQ(ruin.settings.size(), 2u);
    EXPECT_EQ(ruin.settings[1].value.count, 3) << "one number counts for every component";
    EXPECT_EQ(ruin.settings[1].value.n[2], .6);
    const Check& check = grammar().checks.at(0);
    EXPECT_EQ(symbol(grammar().starts.at(check.start).symbol), "House");
    EXPECT_EQ(check.expect.args.at(0).args.at(0).kind, Expr::Kind::Figure);
    EXPECT_EQ(static_cast<Figure>(check.expect.args[1].args.at(0).index), Figure::Overlaps);
}

TEST(Draws, AreNamedByAttributeAndOrdinal) {
    const Checked c =
        checkedBody("start A -> cube : B\nrule B -> + cube size (1..2, 3, 4..5) at +x + cube size 1..2 at -x\n");
    ASSERT_TRUE(c.grammar) << c.messages();
    const auto& chain = c.grammar->rules[0].body.siblings[0];
    const Expr& first = chain[0].attributes[0].args[0];
    EXPECT_EQ(first.args.at(0).draw, hashText("size"));
    EXPECT_EQ(first.args.at(2).draw, combine(hashText("size"), 1));
    EXPECT_EQ(chain[1].attributes[0].args[0].draw, hashText("size"));
}

TEST(Ordinals, CountEachLabelByItself) {
    const Checked c = checkedBody("start A -> cube + sphere + cube + (cube - sphere)\n");
    ASSERT_TRUE(c.grammar) << c.messages();
    const auto& chain = c.grammar->starts[0].body.siblings[0];
    EXPECT_EQ(chain[0].ordinal, 0u);
    EXPECT_EQ(chain[1].ordinal, 0u);
    EXPECT_EQ(chain[2].ordinal, 1u);
    const auto& group = chain[3].content.group()->siblings[0];
    EXPECT_EQ(group[0].ordinal, 2u);
    EXPECT_EQ(group[1].ordinal, 1u);
}

TEST(Prefix, ChangesTheScopeOnlyWithoutAnOperator) {
    const Checked c = checkedBody("start A -> size (1, 2, 3) cube + size 2 sphere at +x\n");
    ASSERT_TRUE(c.grammar) << c.messages();
    const auto& chain = c.grammar->starts[0].body.siblings[0];
    EXPECT_EQ(chain[0].prefix.size(), 1u);
    EXPECT_TRUE(chain[1].prefix.empty());
    EXPECT_EQ(chain[1].attributes.at(0).operation, &operations::size);
}

TEST(Values, AreInheritedByName) {
    const Checked c = checkedBody("start A -> cube with bay = 2m : B\nrule B -> + cube size (bay, 1, 1) at +x\n");
    ASSERT_TRUE(c.grammar) << c.messages();
    const Expr& size = c.grammar->rules[0].body.siblings[0][0].attributes[0].args[0];
    EXPECT_EQ(size.args.at(0).kind, Expr::Kind::Inherited);
    EXPECT_EQ(size.args[0].value.text, "bay");
    const Attribute& with = c.grammar->starts[0].body.siblings[0][0].attributes[0];
    EXPECT_EQ(with.args.at(0).value.text, "bay");
    EXPECT_EQ(with.args.at(1).value, Value::number(2, Unit::Metre));
}

TEST(Choices, GrowWhenTheirAlternativesDo) {
    const Checked c = checkedBody("start A -> cube : B\nrule B -> choose { 2: + cube at +x : B | 1: nil }\n");
    ASSERT_TRUE(c.grammar) << c.messages();
    EXPECT_TRUE(c.grammar->rules[0].body.grows);
    EXPECT_EQ(c.grammar->rules[0].body.siblings[0][0].choices.at(0).weight.value.num(), 2);
}

TEST(Attributes, OfParametersStayOpen) {
    const Checked c = checkedBody("param paint = #804020\nterminal wall color paint rough .3\nstart A -> wall\n");
    ASSERT_TRUE(c.grammar) << c.messages();
    const Symbol& wall = c.grammar->symbols.at(0);
    ASSERT_EQ(wall.look.size(), 1u) << "the colour; the roughness is settled";
    EXPECT_EQ(wall.look[0].args.at(0).kind, Expr::Kind::Param);
    EXPECT_GT(c.grammar->materials.at(wall.material).color.x, c.grammar->materials[wall.material].color.z);
}

TEST(Choices, OfPrimitivesFollowParameters) {
    const Checked c = checkedBody(
        "param kind = ball of ball, cube\nterminal a = kifs(terminal: cube)\nterminal b = kifs(terminal: kind)\nstart "
        "A -> a + b at +x\n");
    ASSERT_TRUE(c.grammar) << c.messages();
    const auto& row = *c.grammar->symbols[0].solid->primitive;
    size_t i = 0;
    while (row.parameters[i].name != "terminal") ++i;
    EXPECT_EQ(c.grammar->symbols[0].solid->args[i].value.num(), 1);
    EXPECT_EQ(static_cast<Fn>(c.grammar->symbols[1].solid->args[i].index), Fn::If);
}

}  // namespace
}  // namespace sgm::rules
