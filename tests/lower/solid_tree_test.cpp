// The solid tree is the field's inside: evaluated on its own formulas, point by point, and what it refuses.
#include "grammar/lower/solid_tree.h"

#include <cmath>

#include "grammar/rules/params.h"
#include "modeler/core/random.h"
#include "tests/lower/lowered.h"

namespace sgm {
namespace {

using namespace testing_;
using field::PlacedSolid;
using field::SolidNode;
using field::SolidTree;

double square(double v) { return v * v; }

/// Whether a point, in shares −1 … 1 of the half-size, is in a solid: written apart from modeler/field/solids_*.cpp.
bool insideUnit(const PlacedSolid& s, Vec3d u) {
    const std::string_view name = s.primitive->name;
    if (name == "halfspace") return u.y < 0;
    const double round2 = square(u.x) + square(u.z), up = (1 - u.y) / 2;  // up: 1 at the foot, 0 at the top
    if (name == "sphere" || name == "ellipsoid") return round2 + square(u.y) < 1;
    if (std::abs(u.x) >= 1 || std::abs(u.y) >= 1 || std::abs(u.z) >= 1) return false;
    if (name == "cube") return true;
    if (name == "cylinder") return round2 < 1;
    if (name == "cone") return round2 < square(up);
    if (name == "pyramid") return std::max(std::abs(u.x), std::abs(u.z)) < up;
    if (name == "prism") return std::abs(u.x) < up;
    if (name == "wedge") return u.x + u.y < 0;
    if (name == "torus") {
        const double tube = s.arguments.at(0);
        return square(std::sqrt(round2) - (1 - tube)) + square(u.y * tube) < square(tube);
    }
    if (name == "capsule") {
        const double r = minComponent(s.size) / 2;
        return round2 + square(std::max(0.0, std::abs(u.y) * s.size.y / 2 / r - (s.size.y / 2 / r - 1))) < 1;
    }
    ADD_FAILURE() << name;
    return false;
}

bool inside(const SolidTree& tree, Vec3d p) {
    using Op = SolidNode::Op;
    std::vector<bool> in;
    for (const SolidNode& n : tree.nodes) {
        bool value = false;
        if (n.op == Op::Solid) {
            const PlacedSolid& s = tree.solids[n.solid];
            const Vec3d local = s.frame.rotation.transposed() * (p - s.frame.centre);
            value = insideUnit(s, {2 * local.x / s.size.x, 2 * local.y / s.size.y, 2 * local.z / s.size.z});
        } else {
            value = in[n.operands[0]];
            for (size_t i = 1; i < n.operands.size(); ++i) {
                const bool other = in[n.operands[i]];
                value = n.op == Op::Union          ? value || other
                        : n.op == Op::Intersection ? value && other
                                                   : value && !other;
            }
        }
        in.push_back(value);
    }
    return in.back();
}

Result<SolidTree> treeOf(const Lowered& model) { return lower::solidTree(model.derivation, *model.model, nullptr); }

/// Points at which the field is clearly inside or outside and the tree says otherwise, of `count` random ones; and that
/// points of both kinds were met.
void expectSameInside(const Lowered& model, int count) {
    const auto tree = treeOf(model);
    ASSERT_TRUE(tree.ok()) << tree.error().message;
    for (const SolidNode& n : tree->nodes) EXPECT_TRUE(n.op == SolidNode::Op::Solid || n.operands.size() >= 2);
    const Box3d box = model.model->field.bounds.as<double>().inflated(0.5);
    int wrong = 0, in = 0, out = 0;
    for (uint64_t i = 0; i < static_cast<uint64_t>(count); ++i) {
        Vec3d p;
        for (int axis = 0; axis < 3; ++axis)
            p[axis] = uniform(3 * i + static_cast<uint64_t>(axis) + 1, box.lo[axis], box.hi[axis]);
        const double f = static_cast<double>(model.value(p.as<float>()));
        if (std::abs(f) < 1e-4) continue;
        ++(f < 0 ? in : out);
        wrong += inside(*tree, p) != (f < 0);
    }
    EXPECT_EQ(wrong, 0);
    EXPECT_GT(in, count / 200);
    EXPECT_GT(out, count / 200);
}

/// A model of an example with some parameters set.
Lowered example(const std::string& file, const std::vector<std::pair<std::string, double>>& settings = {}) {
    const std::string text = fileText(file);
    const auto grammar = grammarOf(text);
    derive::Options options;
    options.params = rules::valuesOf(*grammar, 0);
    for (const auto& [name, value] : settings)
        for (size_t i = 0; i < grammar->params.size(); ++i)
            if (grammar->params[i].name == name) options.params[i].n[0] = value;
    return Lowered(text, options);
}

TEST(SolidTree, EveryPrimitiveStandsWhereItsFieldDoes) {
    for (const char* solid :
         {"cube", "sphere", "ellipsoid", "torus", "torus(.4)", "cylinder", "cone", "pyramid", "prism", "wedge",
          "capsule", "roof(0)", "roof(1)", "morph(cube, cone, 0)", "morph(cube, cone, 1)"}) {
        SCOPED_TRACE(solid);
        expectSameInside(Lowered(std::string("grammar 1\nstart S -> ") + solid + " size (3, 2, 1.4)\n"), 3000);
        expectSameInside(Lowered(std::string("grammar 1\nstart S -> cube size .5 move (3, 0, 0) + ") + solid +
                                 " size (1.6, 3, 2.2) turn (20deg, 35deg, -50deg) move (.3, .2, -.4)\n"),
                         3000);
    }
}

TEST(SolidTree, JoinsInTheOrderOfTheFields) {
    for (const char* body : {
             "cube size 4 - cube size 2 + sphere size 1",
             "cube size 4 + sphere size 1 - cube size 2 - cube size (1, 5, 1)",
             "cube size 4, cube size 4 move (6, 0, 0) - cube size (20, 1, 1)",
             "cube size 2 + cube size (6, 1, 1) & sphere size 4",
             "cube size 2 & sphere size 2.4 - cylinder size (1, 3, 1) + cone size 1 move (0, 1, 0)",
             "cube size 4 - (cube size 3 - cube size 2)",
             "cube size 4 - (cube size 3 + sphere size 4.4 - cube size (5, 1, 1))",
             "cube size 4 - halfspace turn (0deg, 0deg, 30deg) move (0, -1, 0)",
             "cube size 4 & halfspace turn (40deg, 0deg, 0deg)",
             "cube size 4 morph sphere size 3 by 0 - cube size (1, 9, 1)",
             "cube size 4 + cone size 2 at +y morph sphere size 3 by 1 + cube size (1, 4, 1)",
             "cube size 4 + cube size 2 at +y blend 0m",
         }) {
        SCOPED_TRACE(body);
        expectSameInside(Lowered(std::string("grammar 1\nstart S -> ") + body + "\n"), 4000);
    }
}

TEST(SolidTree, IsTheInsideOfTheBuildings) {
    expectSameInside(example("examples/tower.sgm", {{"peak", 0}}), 20000);
    expectSameInside(example("examples/tower.sgm", {{"peak", 1}}), 5000);
    expectSameInside(example("examples/buildings/palace.sgm", {{"peak", 0}}), 20000);
    expectSameInside(example("examples/buildings/apartment.sgm"), 20000);
    expectSameInside(example("examples/buildings/cloister.sgm"), 20000);
    expectSameInside(example("examples/buildings/hall.sgm", {{"peak", 0}}), 20000);
    expectSameInside(example("examples/buildings/terrace.sgm"), 20000);
    expectSameInside(example("examples/buildings/villa.sgm"), 20000);
    expectSameInside(example("examples/buildings/perimeter.sgm", {{"wing", 10}}), 2000);
    expectSameInside(example("examples/buildings/skyscraper.sgm", {{"peak", 0}}), 5000);
}

TEST(SolidTree, KeepsTheOriginsOfTheModel) {
    const Lowered model(
        "grammar 1\nstart S -> cube size 2 color #ff0000 + cube size 1 at +y color #00ff00 - Hole size (1, 1, 3)\n"
        "rule Hole -> cylinder\n");
    const auto tree = treeOf(model);
    ASSERT_TRUE(tree.ok());
    ASSERT_EQ(tree->solids.size(), 3u);
    const Provenance& p = model.model->provenance;
    EXPECT_EQ(p.parts[tree->solids[0].origin].path, model.owner({1.01f, 0, 0}).path);
    EXPECT_EQ(p.parts[tree->solids[1].origin].path, model.owner({0, 2.01f, 0}).path);
    EXPECT_EQ(p.parts[tree->solids[2].origin].rule(), p.parts.back().rule());
    EXPECT_EQ(p.parts[tree->solids[2].origin].line(), 3u);
    EXPECT_EQ(p.materialOf(tree->solids[1].origin).color, (Vec3f{0, 1, 0}));
}

TEST(SolidTree, AMorphToItsEndOwnsWhatIsLeft) {
    const Lowered model("grammar 1\nstart S -> cube size 4 morph sphere size 3 by 1 + cube size (1, 4, 1)\n");
    const auto tree = treeOf(model);
    ASSERT_TRUE(tree.ok());
    ASSERT_EQ(tree->solids.size(), 2u);
    EXPECT_EQ(model.model->provenance.parts[tree->solids[0].origin].path, model.owner({1.5f, 0, 0}).path);
}

TEST(SolidTree, NamesWhatIsNoSolid) {
    const auto refusal = [](const std::string& rest) {
        const Lowered model("grammar 1\nstart S -> cube size 4\n  " + rest + "\n");
        const auto tree = treeOf(model);
        if (tree.ok()) return std::string();
        const size_t what = tree.error().message.find("; trees of solids (.scad, .csg.json) hold sharp unions");
        EXPECT_NE(tree.error().message.find("or write a mesh, such as .glb or .stl", what), std::string::npos);
        return tree.error().message.substr(0, what);
    };
    EXPECT_EQ(refusal("+ sphere size 4 at +y blend .3m"), "test.sgm:3:3: 'S/cube/sphere' is blended in over 0.3 m");
    EXPECT_EQ(refusal("- sphere size 4 at +y to centre blend .3m"),
              "test.sgm:3:3: 'S/cube/sphere' cuts with edges blended over 0.3 m");
    EXPECT_EQ(refusal("morph sphere size 4 by .4"),
              "test.sgm:3:3: 'S/cube/sphere' morphs what stands, 0.4 of the way: 0 and 1 alone are solids");
    EXPECT_EQ(refusal("+ morph(cube, sphere, .5) size 4"),
              "test.sgm:3:3: 'S/cube/morph' is a morph, 0.5 of the way: 0 and 1 alone are solids");
    EXPECT_EQ(refusal("+ roof(.3) size 4 at +y"),
              "test.sgm:3:3: 'S/cube/roof' is a roof 0.3 of the way from a pyramid to an ellipsoid: 0 and 1 alone are "
              "solids");
    EXPECT_EQ(refusal("+ kifs size 4 at +y"),
              "test.sgm:3:3: 'S/cube/kifs' is a fractal (kifs): no solid is exactly that");
    EXPECT_EQ(refusal("+ sphere size 4 at +y displace billow(.05m, 2/m)"),
              "test.sgm:3:3: 'S/cube/sphere' is displaced by noise");
    EXPECT_EQ(refusal("+ cube size 4 at +y clad ornament()"), "test.sgm:3:3: 'S/cube/cube' is clad with an ornament");
    EXPECT_EQ(refusal("+ shellBlock size 4 at +y"),
              "test.sgm:3:3: 'S/cube/shellBlock' is a shellBlock, which is no solid of the tree");
    EXPECT_EQ(refusal("+ mesh(\"a.obj\") size 4 at +y"),
              "test.sgm:3:3: 'S/cube/mesh' is a mesh from a file, of which the model knows samples alone");
}

}  // namespace
}  // namespace sgm
