// Pictures in baked cells: shared files, measured in metres, going on from cell to cell.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "modeler/core/packages.h"
#include "modeler/tiles/deliver.h"
#include "modeler/tiles/read_back.h"
#include "tests/scratch.h"
#include "tests/tiles/baked.h"

namespace sgm::pipeline {
namespace {

namespace fs = std::filesystem;
using tiles::Cell;

const std::string town = R"(grammar 2
material brickwork color #96533f texture "textures/brick.jpg" (1m, .5m) normals "textures/brick_normals.jpg"
material turf color #86a35f texture "textures/pantile.jpg" (3m, 2m)
material plain color #c8b090
start Town -> size (150m, 4m, 150m) (Ground, split x { { ~50m: Row }* })
rule Ground -> cube of turf
rule Row -> split z { { ~50m: Plot }* }
rule Plot -> move (0m, 6m, 0m) size (9m, 8m, 9m) turn (0deg..90deg) place House
start House -> size (8m, 6m, 5m) (cube of brickwork + cube of plain size (2m, 7m, 2m))
)";

/// How much a triangle's texture coordinates turn and stretch what they cover: 0 where not at all.
double strainOf(const tiles::SurfacePiece& piece, size_t triangle) {
    const uint32_t* t = piece.indices.data() + 3 * triangle;
    const auto p = [&](int k) { return piece.positions[t[k]].as<double>(); };
    const auto uv = [&](int k) { return piece.uvs[t[k]]; };
    double strain = 0;
    for (int k = 0; k < 3; ++k) {
        const auto a = uv(k), b = uv((k + 1) % 3);
        strain = std::max(
            strain, std::abs(std::hypot(double(b[0] - a[0]), double(b[1] - a[1])) - length(p((k + 1) % 3) - p(k))));
    }
    const auto a = uv(0), b = uv(1), c = uv(2);
    const double area = double(b[0] - a[0]) * double(c[1] - a[1]) - double(c[0] - a[0]) * double(b[1] - a[1]);
    return std::max(strain, std::abs(area - length(cross(p(1) - p(0), p(2) - p(0)))));
}

/// Vertices of triangles that look upwards; those without area look nowhere.
std::set<uint32_t> upper(const tiles::SurfacePiece& piece) {
    std::set<uint32_t> found;
    for (size_t i = 0; i < piece.indices.size(); i += 3) {
        const uint32_t* t = piece.indices.data() + i;
        const Vec3f& a = piece.positions[t[0]];
        const Vec3f across = cross(piece.positions[t[1]] - a, piece.positions[t[2]] - a);
        if (across.y > .9f * length(across)) found.insert({t[0], t[1], t[2]});
    }
    return found;
}

class Textures : public testing::Test {
protected:
    void SetUp() override {
        baked_.run(folder_.path(), {1, 1}, 2);
        baked_.merge(folder_.path());
    }
    /// The finest files of objects, or the coarse ones.
    std::vector<fs::path> objects(const std::string& ending) const {
        std::vector<fs::path> found;
        for (const auto& entry : fs::recursive_directory_iterator(folder_ / "lib"))
            if (entry.path().string().ends_with(ending)) found.push_back(entry.path());
        return found;
    }

    Baked baked_{town, "examples/buildings/town.sgm"};
    const Scratch folder_;
};

TEST_F(Textures, CoverObjectsInMetres) {
    if (!isBuiltWith(Package::Cgal))
        GTEST_SKIP() << "built without CGAL: triangles too small for the strain that packing leaves";
    ASSERT_EQ(objects("-0.glb").size(), 1u);
    const auto object = tiles::readObject(objects("-0.glb")[0]);
    ASSERT_TRUE(object.ok()) << object.error().message;
    size_t covered = 0;
    for (const tiles::SurfacePiece& piece : object->pieces) {
        const Material& material = object->materials[piece.material];
        EXPECT_EQ(material.texture != nullptr, material.name == "brickwork") << material.name;
        if (!material.texture) continue;
        EXPECT_FLOAT_EQ(material.texture->width_m, 1);
        EXPECT_FLOAT_EQ(material.texture->height_m, .5f);
        EXPECT_EQ(material.texture->color->bytes, contentOf("examples/buildings/textures/brick.jpg"));
        EXPECT_EQ(material.texture->normals->bytes, contentOf("examples/buildings/textures/brick_normals.jpg"));
        ASSERT_EQ(piece.uvs.size(), piece.positions.size());
        ASSERT_EQ(piece.tangents.size(), piece.positions.size());
        for (size_t t = 0; 3 * t < piece.indices.size(); ++t, ++covered)
            EXPECT_LT(strainOf(piece, t), .02) << "as packed positions are rounded";
        for (size_t v = 0; v < piece.positions.size(); ++v)
            EXPECT_NEAR(static_cast<double>(dot(piece.tangents[v], piece.normals[v])), 0, .03);
    }
    EXPECT_GE(covered, 10u);
}

TEST_F(Textures, LieInFilesThatAllShare) {
    size_t pictures = 0;
    for (const auto& entry : fs::directory_iterator(folder_ / "lib/textures")) pictures += entry.is_regular_file();
    EXPECT_EQ(pictures, 3u);
    for (const Cell& cell : baked_.plan.cells) {
        const fs::path file = tiles::contentFile(folder_.path(), cell);
        const auto glb = tiles::readGlb(file);
        if (!glb.ok() || !glb->json.contains("images")) continue;
        for (const auto& image : glb->json["images"])
            EXPECT_TRUE(fs::exists(file.parent_path() / image["uri"].get<std::string>())) << image;
    }
    const auto coarse = tiles::readGlb(objects("-1.glb").at(0));
    ASSERT_TRUE(coarse.ok());
    EXPECT_FALSE(coarse->json.contains("images")) << "from afar a picture is its mean colour";
}

TEST_F(Textures, OfTheGroundGoOnFromCellToCell) {
    std::map<std::array<double, 3>, std::array<double, 2>> known;
    size_t shared = 0;
    tiles::Library library;
    for (const Cell& cell : baked_.plan.cells) {
        if (cell.level != 0) continue;
        const auto read = tiles::readCell(tiles::contentFile(folder_.path(), cell), library);
        if (!read.ok()) continue;  // nothing is there
        const Vec3d centre = cell.centre(64);
        for (const tiles::SurfacePiece& piece : read->content.ground) {
            ASSERT_EQ(piece.uvs.size(), piece.positions.size());
            for (const uint32_t v : upper(piece)) {
                const Vec3d p = piece.positions[v].as<double>() + centre;
                const std::array<double, 2> uv{double(piece.uvs[v][0]), double(piece.uvs[v][1])};
                const auto [at, fresh] = known.try_emplace({p.x, p.y, p.z}, uv);
                if (fresh) continue;
                ++shared;
                EXPECT_NEAR(std::remainder(uv[0] - at->second[0], 3), 0, 1e-3);
                EXPECT_NEAR(std::remainder(uv[1] - at->second[1], 2), 0, 1e-3);
            }
        }
    }
    EXPECT_GT(shared, 100u);
}

TEST_F(Textures, ComeWithPlainFiles) {
    const Status done = tiles::deliver(folder_.path(), tiles::Delivery::Blender, nullptr);
    ASSERT_TRUE(done.ok()) << done.error().message;
    size_t covered = 0;
    for (const auto& entry : fs::directory_iterator(folder_ / "blender/cells")) {
        const auto glb = tiles::readGlb(entry.path());
        ASSERT_TRUE(glb.ok());
        ASSERT_TRUE(glb->json.contains("images")) << entry.path();
        for (const auto& image : glb->json["images"])
            EXPECT_TRUE(fs::exists(entry.path().parent_path() / image["uri"].get<std::string>())) << image;
        for (const auto& mesh : glb->json["meshes"])
            for (const auto& primitive : mesh["primitives"]) covered += primitive["attributes"].contains("TEXCOORD_0");
    }
    EXPECT_GT(covered, 4u);
}

}  // namespace
}  // namespace sgm::pipeline
