// Networks on hills: what their grammar derives, and the field that it lowers to.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "grammar/lower/lower.h"
#include "modeler/field/height_grid.h"
#include "modeler/town/terrain.h"
#include "tests/derive/grammars.h"
#include "tests/field/probe.h"
#include "tests/rules/read.h"

namespace sgm::testing_ {
namespace {

using derive::Derivation;
using derive::ReliefLayer;
using derive::Shape;
using plan::Vec2;

/// A town of 500 m on a hill and beside a river; its ground ends at y = 0 where the heights are 0.
std::string town(const std::string& settings, const std::string& parts, const std::string& more = "") {
    return "grammar 2\n"
           "map people = bump((-40m, -30m), 400m)\n"
           "map bank = abs(here.z - 80m - .2 * here.x)\n"
           "map hill = 11m * bump((-90m, -60m), 260m) + 4m * bump((150m, -120m), 140m)\n"
           "roads Net { pull = people spread = people > .2 water = bank < 12m highway = 14m street = 9m block = 60m "
           "step = 60m junction = 4 " +
           settings +
           " }\n"
           "terminal asphalt, deck, lawn, sea, grove, wall, tube\n"
           "start Town -> size (500m, 80m, 500m) network Net { " +
           parts + " }\n" + more;
}

const std::string ground = "ground: extrude 40m lawn", roads =
                                                           "highway: extrude 40.3m asphalt | street: extrude 40.3m "
                                                           "asphalt | crossing: extrude 40.3m asphalt";

const town::HeightMap& layer(const Derivation& d, ReliefLayer which) {
    for (const derive::Relief& r : d.reliefs)
        if (r.layer == which) {
            const town::TerrainLayers& layers = r.terrain->layers();
            return which == ReliefLayer::Ground ? layers.ground
                   : which == ReliefLayer::Deck ? layers.deck
                                                : layers.water;
        }
    ADD_FAILURE() << "no such layer";
    static const town::HeightMap none{{}, 1, 2, 2, {0, 0, 0, 0}};
    return none;
}

/// Asks the model's field whether places are inside.
class Solid {
public:
    explicit Solid(const Derivation& d) : model_(lowered(d)), probe_(model_->graph, model_->field) {}
    bool has(double x, double y, double z) { return probe_(Vec3d{x, y, z}.as<float>()) < 0; }
    const lower::Model& model() const { return *model_; }

private:
    static std::unique_ptr<lower::Model> lowered(const Derivation& d) {
        auto model = lower::lower(d, nullptr);
        EXPECT_TRUE(model.ok());
        return std::move(*model);
    }

    std::unique_ptr<lower::Model> model_;
    field::test::Probe probe_;
};

TEST(Hills, LevelTownsHaveNoRelief) { EXPECT_TRUE(derived(town("", ground + " | " + roads)).reliefs.empty()); }

TEST(Hills, GroundAndRoadsFollowTheHeights) {
    const Derivation d = derived(town("height = hill", ground + " | " + roads));
    ASSERT_FALSE(d.reliefs.empty());
    const town::HeightMap& heights = layer(d, ReliefLayer::Ground);
    Solid solid(d);
    size_t roadPlaces = 0;
    for (const auto& f : d.plan.features) {
        if (f.layer != "street" && f.layer != "highway" && f.layer != "crossing") continue;
        const Vec2 at = centroid(f.area);
        const double h = heights.at(at);
        EXPECT_TRUE(solid.has(at.x, h + .28, at.z)) << at.x << " " << at.z;
        EXPECT_FALSE(solid.has(at.x, h + .32, at.z));
        ++roadPlaces;
    }
    EXPECT_GT(roadPlaces, 60u);
    field::test::Draws draw(7);
    for (int i = 0; i < 400; ++i) {
        const double x = draw.uniform(-245, 245), z = draw.uniform(-245, 245), h = heights.at({x, z});
        EXPECT_TRUE(solid.has(x, h - .05, z));
        EXPECT_FALSE(solid.has(x, h + .35, z));
    }
    const Box3f& box = solid.model().field.bounds;
    EXPECT_GT(box.hi.y, 8);
    EXPECT_LT(box.hi.y, 16);
    EXPECT_LE(solid.model().field.lipschitz, 1);
}

TEST(Hills, FieldsKeepTheirPromises) {
    const Derivation d = derived(town("height = hill tunnel = 200m",
                                      ground + " | bore: move (0m, 40m, 0m) size (80%, 100%, 100%) extrude 6m tube | " +
                                          roads + " | water: extrude 39.5m sea | bridge: extrude 40.3m deck"));
    const auto model = lower::lower(d, nullptr);
    ASSERT_TRUE(model.ok());
    field::test::expectPromises((*model)->graph, (*model)->field, (*model)->field.bounds.as<double>(), 5, "hills");
}

/// Objects of their own stand upright on level ground, with their foot on it.
TEST(Hills, ObjectsStandOnLevelGround) {
    const Derivation d =
        derived(town("height = hill",
                     ground + " | " + roads +
                         " | block: move (0m, 40m, 0m) lots box(420m2, front: 9m) { lot: setback 3m inner Home "
                         "| corner: nil }",
                     "rule Home -> place House { wide = clamp(2m * floor(scope.x / 2m), 2m, 60m) }\n"
                     "param wide = 8m in 2m..60m\n"
                     "start House -> size (wide, 5m, 6m) wall\n"));
    const town::HeightMap& heights = layer(d, ReliefLayer::Ground);
    size_t places = 0, off = 0;
    double least = 1e9, most = -1e9;
    for (const derive::Placement& p : derive::placementsOf(d)) {
        const Shape& s = d.tree.shapes[p.shape];
        const double lift = d.tree.extrasOf(p.shape)->lift_m;
        least = std::min(least, lift), most = std::max(most, lift), ++places;
        for (const double x : {-1.0, 0.0, 1.0})
            for (const double z : {-1.0, 0.0, 1.0}) {
                const Vec3d at = s.scope.point({x, -1, z});
                const double over = heights.at({at.x, at.z}) - lift;
                EXPECT_GT(over, -.5) << "hangs in the air";
                off += std::abs(over) > .4;
            }
    }
    EXPECT_GT(places, 60u);
    EXPECT_GT(most, 7);
    EXPECT_LT(least, 1);
    EXPECT_LT(off, places * 9 / 6);  // corners that share their patch of ground with a road or a neighbour
}

TEST(Hills, WaterLiesInItsBedBelowBridges) {
    const Derivation d =
        derived(town("height = hill bed = 5m", ground + " | " + roads +
                                                   " | water: extrude 39.5m sea | bridge: move (0m, 38.5m, "
                                                   "0m) extrude 1.5m deck"));
    const town::HeightMap &bed = layer(d, ReliefLayer::Ground), &water = layer(d, ReliefLayer::Water),
                          &decks = layer(d, ReliefLayer::Deck);
    Solid solid(d);
    size_t bridges = 0;
    for (const auto& f : d.plan.features) {
        if (f.layer != "bridge") continue;
        const Vec2 at = centroid(f.area);
        if (std::abs(at.z - 80 - .2 * at.x) > 8) continue;
        const double deck = decks.at(at), surface = water.at(at) - .5;
        EXPECT_TRUE(solid.has(at.x, deck - .1, at.z));
        EXPECT_FALSE(solid.has(at.x, (deck - 1.5 + surface) / 2, at.z)) << "room to pass below";
        EXPECT_TRUE(solid.has(at.x, surface - .1, at.z));
        ++bridges;
    }
    EXPECT_GT(bridges, 0u);
    size_t deep = 0;
    for (double x = -240; x <= 240; x += 10) deep += bed.at({x, 80 + .2 * x}) < water.at({x, 80 + .2 * x}) - 3.5;
    EXPECT_GT(deep, 45u);
}

TEST(Hills, TunnelsAreBoredThroughThem) {
    const Derivation d = derived(town(
        "height = 42m * bump((-40m, -30m), 130m) tunnel = 400m slope = 8% from = (-220m, -30m) turn = 2deg ends = keep",
        ground +
            " | bore: move (0m, 40m, 0m) size (60%, 100%, 100%) extrude 5m tube | tunnel: extrude 40.3m asphalt | " +
            roads));
    const town::HeightMap &hill = layer(d, ReliefLayer::Ground), &road = layer(d, ReliefLayer::Deck);
    Solid solid(d);
    size_t tunnels = 0;
    for (const auto& f : d.plan.features) {
        if (f.layer != "tunnel") continue;
        const Vec2 at = centroid(f.area);
        const double floor = road.at(at);
        if (hill.at(at) < floor + 12 || hill.at(at) > floor + 44) continue;  // too low, or thicker than the ground
        EXPECT_TRUE(solid.has(at.x, floor + .2, at.z));
        EXPECT_FALSE(solid.has(at.x, floor + 2.5, at.z));
        EXPECT_TRUE(solid.has(at.x, floor + 5.5, at.z));
        ++tunnels;
    }
    EXPECT_GT(tunnels, 0u);
}

/// What is beside the network stays level: a cave below the town is an ordinary shape.
TEST(Hills, CavesLieBelowTheTown) {
    std::string text = town("height = hill", ground + " | " + roads);
    text.replace(text.find("start Town -> size"), 18,
                 "start Town -> Land - sphere size 20m move (0m, -25m, 0m)\nrule Land -> size");
    const Derivation d = derived(text);
    Solid solid(d);
    const double top = layer(d, ReliefLayer::Ground).at({0, 0});
    EXPECT_FALSE(solid.has(0, -25, 0));
    EXPECT_TRUE(solid.has(0, -12, 0));
    EXPECT_TRUE(solid.has(0, top - .1, 0));
}

TEST(Hills, AreTheSameEachTime) {
    const std::string text = town("height = hill", ground + " | " + roads + " | water: sea | bridge: deck");
    const Derivation a = derived(text), b = derived(text);
    ASSERT_EQ(a.reliefs.size(), b.reliefs.size());
    ASSERT_EQ(a.reliefs.size(), 3u);
    for (size_t i = 0; i < a.reliefs.size(); ++i)
        EXPECT_EQ(a.reliefs[i].heights->words(), b.reliefs[i].heights->words());
}

/// Without the river.
std::string dry(std::string text) {
    const std::string river = "water = bank < 12m ";
    return text.replace(text.find(river), river.size(), "");
}

std::string warningsOf(const std::string& text) {
    std::string all;
    for (const derive::Warning& w : derived(text).warnings) all += w.message + " | " + w.hint + "\n";
    return all;
}

TEST(Hills, SayWhatIsWrongWithTheirHeights) {
    EXPECT_NE(warningsOf(dry(town("height = 3m", ground))).find("equally high everywhere"), std::string::npos);
    EXPECT_NE(warningsOf(dry(town("height = 90m * bump((-40m, -30m), 90m)", ground))).find("more than 'slope', 12%"),
              std::string::npos);
    // Along the level lines the ground is gentle, but no road begins that way.
    const std::string steep = warningsOf(
        "grammar 2\nmap relief = 40m * bump((-90m, 10m), 250m)\nmap dens = bump((0m, 0m), 260m)\n"
        "roads Net { pull = dens spread = dens > .2 height = relief slope = 15% highway = 8m street = 5m step = 40m "
        "block = 40m junction = 3 snap = 12m }\n"
        "start Town -> size (300, 60, 300) network Net { street: extrude 40m cube | highway: extrude 40m cube }\n");
    EXPECT_NE(steep.find("where roads begin, the ground rises by more than 'slope', 15%"), std::string::npos) << steep;
    EXPECT_NE(steep.find("raise 'slope'"), std::string::npos) << steep;
    const auto far = tryDerive(town("height = if(here.x > 100m, 1e12m, 0m)", ground));
    ASSERT_FALSE(far.ok());
    EXPECT_NE(far.error().message.find("test.sgm:5"), std::string::npos) << far.error().message;
    std::string leaning = town("height = hill", ground);
    leaning.replace(leaning.find("network"), 7, "turn (20deg, 0deg, 0deg) network");
    const auto leans = tryDerive(leaning);
    ASSERT_FALSE(leans.ok());
    EXPECT_NE(leans.error().message.find("turn it about y alone"), std::string::npos) << leans.error().message;
}

}  // namespace
}  // namespace sgm::testing_
