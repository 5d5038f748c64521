// The clouds that ship (SG-M, section III-C), measured on their meshes: whole for every seed, and true to their names.
#include <algorithm>
#include <array>
#include <vector>

#include "tests/cli/program.h"

namespace sgm::cli {
namespace {

class Clouds : public Cli {
protected:
    Json cloud(const std::string& name, int seed, const std::string& more) const {
        return built("examples/clouds/" + name + ".sgm --seed " + std::to_string(seed) + " " + more);
    }
    /// Of all area that faces down, the share in the mesh's lowest tenth of a metre.
    double flatShare(const std::string& name, const std::string& more) const;
};

/// Extents of a mesh along x, y, z, metres.
std::array<double, 3> extents(const Json& report) {
    const Json& b = report["mesh"]["bounds"];
    return {b[1][0].get<double>() - b[0][0].get<double>(), b[1][1].get<double>() - b[0][1].get<double>(),
            b[1][2].get<double>() - b[0][2].get<double>()};
}

struct Named {
    const char* name;
    double least, most;  ///< of the mean width by the height
};
void PrintTo(const Named& c, std::ostream* out) { *out << c.name; }

class EveryCloud : public Clouds, public testing::WithParamInterface<Named> {};

TEST_P(EveryCloud, IsWholeAndAsWideAsItsNameSaysForEverySeed) {
    for (int seed = 1; seed <= 10; ++seed) {
        const Json report = cloud(GetParam().name, seed, "--resolution 36");
        ASSERT_FALSE(report.is_null());
        EXPECT_EQ(report["mesh"]["components"], 1) << "seed " << seed;
        const auto [x, y, z] = extents(report);
        EXPECT_GE((x + z) / 2 / y, GetParam().least) << "seed " << seed;
        EXPECT_LE((x + z) / 2 / y, GetParam().most) << "seed " << seed;
    }
}
INSTANTIATE_TEST_SUITE_P(Clouds, EveryCloud,
                         testing::Values(Named{"plain", .5, 3}, Named{"humilis", 2, 6}, Named{"mediocris", 1, 2},
                                         Named{"congestus", .4, 1}, Named{"bank", 2.5, 6}, Named{"ring", 2, 4},
                                         Named{"ball", .7, 1.4}, Named{"lens", 2.5, 4}),
                         [](const auto& info) { return std::string(info.param.name); });

double Clouds::flatShare(const std::string& name, const std::string& more) const {
    const std::string mesh = path("cloud.off");
    const Json report = cloud(name, 3, "--resolution 48 -o " + mesh + more);
    std::ifstream off(mesh);
    std::string word;
    size_t points = 0, faces = 0, edges = 0;
    off >> word >> points >> faces >> edges;
    std::vector<std::array<double, 3>> p(points);
    for (auto& q : p) off >> q[0] >> q[1] >> q[2];
    const double lowest = report["mesh"]["bounds"][0][1];
    const auto [width, height, depth] = extents(report);
    const double slack = .1 * std::max({width, height, depth}) / 48;  // of a cell
    double flat = 0, below = 0;
    for (size_t f = 0, n, a, b, c; f < faces && off >> n >> a >> b >> c; ++f) {
        // Twice the area seen from below: the cross product's -y.
        const double down = (p[b][0] - p[a][0]) * (p[c][2] - p[a][2]) - (p[b][2] - p[a][2]) * (p[c][0] - p[a][0]);
        if (down <= 0) continue;
        below += down;
        if (std::max({p[a][1], p[b][1], p[c][1]}) < lowest + slack) flat += down;
    }
    return flat / below;
}

TEST_F(Clouds, BasesAreFlat) {
    for (const std::string name : {"humilis", "mediocris", "congestus", "bank"}) {
        EXPECT_GT(flatShare(name, ""), .25) << name;
        EXPECT_LT(flatShare(name, " --set base=none"), .02) << name;
    }
}

TEST_F(Clouds, EveryParameterMatters) {
    const struct {
        const char *name, *other, *context;
    } cases[] = {{"reach", "(1,2,3,1,0,2)", ""},
                 {"root", "200m", ""},
                 {"tip", "120m", ""},
                 {"stray", ".2", ""},
                 {"sink", ".2", ""},
                 {"lift", ".2", ""},
                 {"pack", ".8", ""},
                 {"base", "flat", ""},
                 {"foot", "20m", "--set base=flat"},
                 {"aim", "ball", ""},
                 {"goal", "(600,500,400)", "--set aim=ring"},
                 {"tube", ".4", "--set aim=ring"},
                 {"become", ".8", "--set aim=ring"},
                 {"buds", "5", ""},
                 {"bud", "70%", ""},
                 {"low", "-1", ""},
                 {"tiers", "0", ""},
                 {"mist", "60m", ""},
                 {"puffed", "20m", ""},
                 {"puffs", ".01/m", ""}};
    const std::string bare = grammar("use \"std/cloud.sgm\"\nstart Sky -> Cloud\n");
    EXPECT_EQ(Json::parse(sgm("params --json " + bare).out).size(), std::size(cases)) << "a parameter without a case";
    const std::string start = bare + " --set reach='(2,2,2,1,2,2)' --cell 40 ";
    for (const auto& c : cases) {
        const std::string with = start + c.context;
        const Json before = built(with), after = built(with + " --set " + c.name + "='" + c.other + "'");
        ASSERT_FALSE(before.is_null() || after.is_null()) << c.name;
        EXPECT_NE(before["mesh"]["volume_m3"], after["mesh"]["volume_m3"]) << c.name;
    }
}

}  // namespace
}  // namespace sgm::cli
