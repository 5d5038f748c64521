// Parts that lie within others wherever they are.
#include <string>
#include <vector>

#include "grammar/lower/buried_parts.h"
#include "tests/lower/lost_parts.h"

namespace sgm {
namespace {

using namespace testing_;

/// Symbol and number of parts of each buried element.
std::vector<std::string> buriedIn(const std::string& body) {
    const Lowered model("grammar 2\n" + body);
    const mesh::Mesh mesh = meshedWith(model, mesh::cellFor(model.model->field.bounds, 48), mesh::Surface::Crisp);
    const auto found = lower::findBuriedParts(model.derivation, *model.model, model.tape(), mesh, nullptr);
    EXPECT_TRUE(found.ok());
    std::vector<std::string> names;
    const auto symbolOf = [&](OriginId part) { return model.model->provenance.parts[part].symbol(); };
    for (const lower::BuriedParts& b : *found)
        names.push_back(symbolOf(b.first) + " " + std::to_string(b.count) +
                        (b.cutter == 0 ? "" : " by " + symbolOf(b.cutter)));
    return names;
}

using Names = std::vector<std::string>;

TEST(BuriedParts, AreThoseWithinOneOther) {
    EXPECT_EQ(buriedIn("start A -> cube size 4 + sphere size 2"), Names{"sphere 1"});
    EXPECT_EQ(buriedIn("start A -> cube size 4, sphere size 2, sphere size .2 move (1m, 0, 0)"),
              (Names{"sphere 1", "sphere 1"}));
    EXPECT_EQ(buriedIn("start A -> cube size 4 + B size 1\nrule B -> for k in 0..3 { cone move (.3m * k, 0, 0) }"),
              Names{"cone 4"});
}

TEST(BuriedParts, AreThoseThatACutTakesAway) {
    EXPECT_EQ(buriedIn("start A -> cube size 4 + sphere size 2 move (0, 3m, 0) - cylinder size 5 move (0, 4.5m, 0)"),
              Names{"sphere 1 by cylinder"});
    EXPECT_EQ(buriedIn("start A -> cube size 10 - sphere size 8 + cube size .3 move (0, 0, 4.3m)"), Names{"cube 1"})
        << "in the wall beside the cut";
}

TEST(BuriedParts, AreNoneThatShowSomewhere) {
    EXPECT_EQ(buriedIn("start A -> cube size 4 + sphere size 2 move (1.2m, 0, 0)"), Names{});
    EXPECT_EQ(buriedIn("start A -> cube size 4 + B size 1\nrule B -> for k in 0..3 { cone move (.7m * k, 0, 0) }"),
              Names{})
        << "the last one shows";
    EXPECT_EQ(buriedIn("start A -> cube size 4 + cylinder size .05 move (0, 2m, 0)"), Names{})
        << "thinner than a cell, but it stands out";
}

TEST(BuriedParts, AreNoCoresCuttersAndBlends) {
    EXPECT_EQ(
        buriedIn("start A -> size 4 B\nrule B -> faces .4m { side: cube | top: cube | bottom: cube | rest: cube }"),
        Names{})
        << "the core fills what would be hollow";
    EXPECT_EQ(buriedIn("start A -> cube size 4 - sphere size 2"), Names{}) << "a hollow";
    EXPECT_EQ(buriedIn("start A -> cube size 4 + sphere size 2 blend .5m"), Names{});
    EXPECT_EQ(buriedIn("start A -> cube size 4 + sphere size 2 morph cube by .5"), Names{});
}

}  // namespace
}  // namespace sgm
