// `clad` from text to field: every mass model, free values per facade id, storey bands, any solid; who owns what.
#include <gtest/gtest.h>

#include "grammar/lower/solids.h"
#include "modeler/core/random.h"
#include "tests/lower/lowered.h"

namespace sgm {
namespace {

using namespace testing_;

std::string text(const std::string& body, const std::string& more = "") {
    return "grammar 1\nuse \"std/kifs.sgm\"\n" + more + "start Test -> " + body + "\n";
}

/// Random places of the box, as shares of the model's bounds.
template <class Visit>
void eachPlace(const Lowered& model, int count, Visit visit) {
    const Box3f b = model.model->field.bounds;
    for (int i = 0; i < count; ++i) {
        const auto share = [&](uint64_t axis) { return static_cast<float>(uniform(combine(uint64_t(i), axis), 0, 1)); };
        visit(Vec3f{b.lo.x + share(0) * b.size().x, b.lo.y + share(1) * b.size().y, b.lo.z + share(2) * b.size().z});
    }
}

/// Volumes of a solid and of what is left of it clad: carved, but not hollow, and nowhere beyond it.
void expectClad(const std::string& solid, const std::string& clad) {
    SCOPED_TRACE(solid);
    const Lowered bare(text(solid)), cladOne(text(solid + " " + clad));
    ASSERT_TRUE(bare.model && cladOne.model);
    int full = 0, left = 0, beyond = 0;
    eachPlace(bare, 4000, [&](Vec3f p) {
        const bool in = bare.inside(p), stays = cladOne.inside(p);
        full += in;
        left += stays;
        beyond += stays && bare.value(p) > 1e-4f;
    });
    EXPECT_EQ(beyond, 0);
    EXPECT_LT(left, full);
    EXPECT_GT(left, full / 3);
}

TEST(Clad, EveryMassModel) {
    const std::pair<const char*, double> masses[] = {{"Box", 1},    {"Tee", 5.0 / 9}, {"Aitch", 7.0 / 9},
                                                     {"Ell", 0.64}, {"You", 2.0 / 3}, {"Court", 0.75}};
    for (const auto& [mass, share] : masses) {
        const std::string solid = std::string(mass) + " size (24, 12, 24)";
        expectClad(solid, "clad palazzo");
        const Lowered bare(text(solid));
        int in = 0;
        eachPlace(bare, 8000, [&](Vec3f p) { in += bare.inside(p); });
        EXPECT_NEAR(in / 8000.0, share, 0.02) << mass;
    }
    for (const char* mass : {"Drum", "Ring", "Arc"})
        expectClad(std::string(mass) + " size (24, 12, 24)",
                   "clad ornament(center: (.93, .93, .33), zoom: 1.6, pan: .5, round: 12m, core: 2m, bay: 4m)");
}

TEST(Clad, AnySolidOfTheGrammar) {
    for (const char* solid :
         {"sphere size 14", "torus(.4) size (20, 8, 20)", "cone size 14", "morph(sphere, cube, .5) size (16, 12, 10)",
          "(cube size (18, 14, 10) + sphere size 16 - cylinder size (5, 20, 5) turn 20deg)",
          "roof(.4) size (16, 9, 12)"})
        expectClad(solid, "clad loggia thickness .8m tile (4m, 3m)");
}

TEST(Clad, AKifsOfTheSketchLiesAsItIsTold) {
    const char* ornate =
        "terminal ornate = kifs(center: (.93, .93, .33), scale: 3, fold: rotY(12deg), passes: 6) color #ffffff\n";
    const Lowered model(
        text("(cube size (18, 24, 10) + cube size (8, 24, 22)) clad ornate thickness .4m tile (6m, 3m) mirror (.25, "
             ".125, .4)",
             ornate));
    ASSERT_TRUE(model.model);
    const derive::Cladding& clad = model.derivation.tree.extras.at(model.derivation.tree.shapes[1].extras).clad.at(0);
    const auto value = [&](field::FacadeParameter p, size_t i = 0) {
        return clad.ornament.args[static_cast<size_t>(p)].n[i];
    };
    EXPECT_EQ(value(field::FacadeParameter::Bay), 6);
    EXPECT_EQ(value(field::FacadeParameter::Storey), 3);
    EXPECT_EQ(value(field::FacadeParameter::Wall), 0.4);
    EXPECT_EQ(value(field::FacadeParameter::Mirror, 1), 0.125);
    EXPECT_EQ(value(field::FacadeParameter::Passes), 6);
    EXPECT_EQ(clad.name, "ornate");
    // What stands in the middle is the solid's own, what sticks out the ornament's.
    EXPECT_EQ(model.owner({0, 0, 0}).symbol(), "cube");
    int ornaments = 0;
    eachPlace(model, 20000,
              [&](Vec3f p) { ornaments += std::abs(model.value(p)) < 0.05f && model.owner(p).symbol() == "ornate"; });
    EXPECT_GT(ornaments, 0);
}

/// One facade id's numbers change the wall there and nowhere else.
TEST(Clad, FreeValuesForAnId) {
    const auto facade = [](const std::string& zoom) {
        return text(
            "cube size (12, 9, 8) clad ornament(center: (.93, .93, .33), bay: 4m, storey: 3m, mirror: (.25, .125, .4), "
            "zoom: " +
            zoom + ", pan: .4)");
    };
    const Lowered plain(facade("(1.4, 1.4, 1.4, 1.4)")), other(facade("(1.4, 2.2, 1.4, 1.4)"));
    const derive::ShapeTree& tree = plain.derivation.tree;
    int changed = 0, elsewhere = 0;
    eachPlace(plain, 20000, [&](Vec3f p) {
        if (plain.inside(p) == other.inside(p)) return;
        const auto cell = lower::facadeCellAt(tree, 1, p.as<double>());
        ASSERT_TRUE(cell);
        ++(cell->idX == 1 || cell->idZ == 1 ? changed : elsewhere);
    });
    EXPECT_GT(changed, 50);
    EXPECT_LE(elsewhere, changed / 50);  // beside a border of bays
}

TEST(Clad, BandsOfStoreysAndPatternsThatChangeAlongAChain) {
    const Lowered bands(text("split y { 4m: cube clad palazzo | ~1: cube clad loggia } size (16, 12, 12)"));
    const Lowered chain(text("cube size (12, 4, 12) clad palazzo : Storey",
                             "rule Storey repeat 4 -> + cube size (12, 4, 12) at +y clad ornament(center: (.93, .93, "
                             ".33) ~> (1.04, .92, .3), "
                             "zoom: 1.4 ~> 3, pan: .4, bay: 4m, storey: 4m) : Storey\n"));
    for (const Lowered* model : {&bands, &chain}) {
        ASSERT_TRUE(model->model);
        int in = 0, out = 0;
        eachPlace(*model, 2000, [&](Vec3f p) { ++(model->inside(p) ? in : out); });
        EXPECT_GT(in, 0);
        EXPECT_GT(out, 0);
    }
}

}  // namespace
}  // namespace sgm
