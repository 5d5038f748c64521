// `sgm build --cave`: the report on a cave of known topology, floors, hollows.
#include <array>

#include "tests/cli/program.h"

namespace sgm::cli {
namespace {

const char* const threeRooms = R"(start Rock -> cube size (24, 8, 12) - Air
rule Air -> cube size (4, 3, 4) + cube size (4, 3, 4) move (-8, 0, 0) + cube size (4, 3, 4) move (8, 0, 0)
            + cube size (6, 2.4, 2) move (-4, -.3, 0) + cube size (6, 2.4, .5) move (4, -.3, 0)
start Void -> Air
)";

TEST_F(Cli, TheCaveReportTellsRoomsAndPassages) {
    const Outcome run = sgm("build " + grammar(threeRooms) + " --cave --agent .5,1.8 --cell .15 --report " +
                            path("r.json") + " --floor " + path("f.obj"));
    ASSERT_EQ(run.code, 0) << run.out;
    EXPECT_NE(run.out.find("too narrow"), std::string::npos) << run.out;
    const Json cave = Json::parse(read(path("r.json")))["cave"];
    EXPECT_EQ(cave["spaces"].size(), 1u);
    EXPECT_EQ(cave["rooms"].size(), 3u);
    ASSERT_EQ(cave["passages"].size(), 2u);
    EXPECT_NE(cave["passages"][0]["passable"], cave["passages"][1]["passable"]);
    EXPECT_NEAR(cave["narrowest_m"].get<double>(), 0.25, 0.15);
    EXPECT_EQ(cave["walkable"]["parts"], 2);
    EXPECT_NE(read(path("f.obj")).find("\nf "), std::string::npos);
}

/// A hall with a pool over half of its floor.
std::string hallWith(const std::string& look, const std::string& use) {
    return "terminal water = cube color #2a5a6a " + look +
           "\nstart Hall -> cube size (12, 6, 8) - cube size (10, 4, 6) + water size (5, .5, 6) move (2.5, -1.75, 0) " +
           use + "\n";
}

TEST_F(Cli, WaterIsNoFloor) {
    const auto floorOf = [&](const std::string& look, const std::string& use) {
        const Json report = built(grammar(hallWith(look, use)) + " --cave --cell .2");
        return report["cave"]["floor_m2"]["to_15_deg"].get<double>();
    };
    const double all = floorOf("", "");
    EXPECT_NEAR(all, 60, 3);
    EXPECT_NEAR(floorOf("walk none", ""), all / 2, 3);
    EXPECT_NEAR(floorOf("", "walk none"), all / 2, 3);
    const Outcome wrong = sgm("check " + grammar(hallWith("walk some", "")));
    EXPECT_EQ(wrong.code, 1);
    EXPECT_NE(wrong.out.find("'walk' takes the word 'none'"), std::string::npos) << wrong.out;
}

TEST_F(Cli, WithoutCaveThereIsNoSurvey) {
    ASSERT_EQ(sgm("build " + grammar(threeRooms) + " --cell .4 -q --report " + path("r.json")).code, 0);
    EXPECT_FALSE(Json::parse(read(path("r.json"))).contains("cave"));
}

TEST_F(Cli, AHollowFacesInward) {
    const std::string file = grammar(threeRooms);
    ASSERT_EQ(sgm("build " + file + " --start Void --cell .2 -q -o " + path("out.obj")).code, 0);
    ASSERT_EQ(sgm("build " + file + " --start Void --cell .2 -q --flip-normals --cave --agent .5,1.8 --report " +
                  path("r.json") + " -o " + path("in.obj"))
                  .code,
              0);
    const Json report = Json::parse(read(path("r.json")));
    EXPECT_EQ(report["cave"]["rooms"].size(), 3u);
    EXPECT_TRUE(report["cave"]["entrances"].empty());
    // The signed volume under each file's faces.
    const auto volume = [&](const std::string& name) {
        std::istringstream lines(read(path(name)));
        std::vector<std::array<double, 3>> v;
        double sum = 0;
        for (std::string line; std::getline(lines, line);) {
            std::istringstream words(line);
            std::string kind;
            words >> kind;
            if (kind == "v") {
                auto& p = v.emplace_back();
                words >> p[0] >> p[1] >> p[2];
            } else if (kind == "f") {
                size_t at[3];
                std::string corner;
                for (size_t& i : at) words >> corner, i = std::stoul(corner) - 1;
                const auto &a = v[at[0]], &b = v[at[1]], &c = v[at[2]];
                sum += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                        a[2] * (b[0] * c[1] - b[1] * c[0])) /
                       6;
            }
        }
        return sum;
    };
    const double outward = volume("out.obj");
    EXPECT_GT(outward, 100);
    EXPECT_NEAR(volume("in.obj"), -outward, 1e-3 * outward);
}

TEST_F(Cli, WrongCaveOptionsAreTwo) {
    const std::string file = grammar(threeRooms);
    EXPECT_EQ(sgm("build " + file + " --cave --agent tall").code, 2);
    EXPECT_EQ(sgm("build " + file + " --cave --agent 1,1 --cell .4").code, 2);
    EXPECT_EQ(sgm("build " + file + " --agent .3,1.8 --cell .4").code, 2) << "walks nowhere";
    EXPECT_EQ(sgm("build " + file + " --floor " + path("f.vdb")).code, 2);
    EXPECT_EQ(sgm("build " + file + " --floor " + path("f.obj") + " --agent .3,40 --cell .4").code, 1);
    EXPECT_FALSE(fs::exists(path("f.obj")));
}

// Frames kept from each other have no blocks, and a survey wants them.
TEST_F(Cli, EveryFrameHasItsOwnSurvey) {
    const std::string file =
        grammar("param w = 1m in .5m..4m\nstart Rock -> cube size (12, 6, 6) - cube size (8, 3, w)\n");
    const Outcome run = sgm("build " + file + " --cell .2 --cave --animate w=1..3:2 --report " + path("r%d.json") +
                            " -o " + path("f%d.off") + " --floor " + path("g%d.off"));
    ASSERT_EQ(run.code, 0) << run.out;
    const auto air = [&](const char* name) { return Json::parse(read(path(name)))["cave"]["air_m3"].get<double>(); };
    EXPECT_NEAR(air("r1.json"), 24, 5);  // whole voxels count
    EXPECT_NEAR(air("r2.json"), 72, 5);
}

}  // namespace
}  // namespace sgm::cli
