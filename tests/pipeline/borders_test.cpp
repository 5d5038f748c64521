// Borders between two looks: on smooth ground, and where they end at edges thinner than a cell.
#include <gtest/gtest.h>

#include <map>

#include "modeler/mesh/validate.h"
#include "tests/pipeline/crisp_model.h"
#include "tests/pipeline/faces_of.h"

namespace sgm::pipeline {
namespace {

/// The length of all edges between two parts, metres.
double borderLength(const mesh::Mesh& mesh) {
    std::map<std::pair<uint32_t, uint32_t>, OriginId> seen;
    double sum_m = 0;
    for (const Face& face : facesOf(mesh))
        for (size_t k = 0; k < 3; ++k) {
            const uint32_t a = face.vertices[static_cast<int>(k)], b = face.vertices[static_cast<int>((k + 1) % 3)];
            const auto [known, isNew] = seen.emplace(std::minmax(a, b), face.origin);
            if (!isNew && known->second != face.origin)
                sum_m += static_cast<double>(length(face.places[(k + 1) % 3] - face.places[k]));
        }
    return sum_m;
}

mesh::Mesh usualMeshOf(const std::string& text, int resolution) {
    Context context{nullptr, 2};
    return crispModel(text, resolution, context).edit({}, context).value();
}

/// Three and four pieces of a blend meet without a crease, so that planes don't tell where: borders had teeth of half a
/// cell there.
TEST(Borders, OfLooksOnABlendHaveNoTeeth) {
    const std::string text =
        "grammar 2\n"
        "start A -> sphere size 1.6m color #d09a3c + sphere size 1m move (-.8, .5, .2) color #d03c6a blend .3m\n"
        "           - sphere size .7m move (0, .7, .4) blend .15m\n";
    const double fine_m = borderLength(usualMeshOf(text, 256));
    for (const int resolution : {32, 40, 48, 64, 96})
        EXPECT_NEAR(borderLength(usualMeshOf(text, resolution)) / fine_m, 1, .01) << resolution;
}

/// The corners where stripes of an awning meet at its front edge lie beyond their cells; within these, faces of stripes
/// side by side show in the seam between them.
TEST(Borders, OfStripesReachTheFrontOfAnAwning) {
    const std::string text =
        "grammar 2\n"
        "material canvas color #c23030\nmaterial white color #eeeeee\n"
        "start Shop -> cube size (6m, 4m, 1m) + Awning size (5.7m, .8m, 1.4m) move (0, .5m, 1.2m)\n"
        "rule Awning -> split x { { .3m: Stripe with k = i }* }\n"
        "rule Stripe -> when k % 2 == 1 { wedge of canvas turn (0deg, -90deg, 0deg) size (100%, 100%, 100%) }\n"
        "  when k % 2 == 0 { wedge of white turn (0deg, -90deg, 0deg) size (100%, 100%, 100%) }\n";
    for (const int resolution : {64, 96, 128, 160, 200, 256}) {
        const mesh::Mesh mesh = usualMeshOf(text, resolution);
        EXPECT_NEAR(mesh::measure(mesh).volume_m3, 24 + 5.7 * .8 * 1.4 / 2, 2e-5) << resolution;
        EXPECT_LE(mesh.triangleCount(), 180u) << resolution;
    }
}

/// Panes stand out 5 cm from bays, in cells of 30 cm. From a pane to its bay a cell's face meets two parallel planes,
/// and what lies between them shows as a plane along the face; cells with two corners of a pane are halved.
TEST(Borders, OfPanesOnTheBaysOfATowerAreWhole) {
    std::string text = fileText("examples/tower.sgm");
    const std::string peak = "param peak   = .35";
    text.replace(text.find(peak), peak.size(), "param peak   = 0  ");
    const mesh::Mesh mesh = usualMeshOf(text, 128);
    EXPECT_LE(mesh.triangleCount(), 4000u);  // exact booleans: 3,838
    EXPECT_NEAR(mesh::measure(mesh).volume_m3 / mesh::measure(usualMeshOf(text, 512)).volume_m3, 1, 4e-6);
}

TEST(Borders, WithOneFaultKeepTheirPointsThereAlone) {
    // A corner of the eaves is too small for halved cells. Where the simplified roof crosses itself there, all of its
    // eaves and hips got their points back: 3,814 triangles.
    const mesh::Mesh mesh = usualMeshOf(
        "grammar 2\nterminal plaster color #e8e4da\nterminal tiles color #a4503a\n"
        "start All -> nil, Plot footprint rect(8, 8) move (124m, 0, 36m)\nrule Plot -> extrude 6.096m House\n"
        "rule House -> plaster + hipRoof(35deg, overhang: .3m) of tiles at +y\n",
        128);
    EXPECT_LE(mesh.triangleCount(), 60u);
}

}  // namespace
}  // namespace sgm::pipeline
