// The ground of baked cells: it welds without tolerance, level by level, and skirts reach over the gaps between levels.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "modeler/tiles/read_back.h"
#include "modeler/tiles/skirt.h"
#include "tests/scratch.h"
#include "tests/tiles/baked.h"

namespace sgm::pipeline {
namespace {

using tiles::Cell;
using Bits = std::array<double, 3>;

/// Two kilometres of hills with a street of another material over them and a tunnel below.
const std::string hills = R"(grammar 2
map hill = 14m * bump((40m, 30m), 600m) + 5m * bump((-300m, 210m), 160m)
roads Net { height = hill spread = false }
terminal lawn color #86a35f
terminal street color #5b5e62
start Town -> size (2048m, 40m, 2048m) network Net { ground: Ground }
rule Ground -> extrude 20m (lawn - cylinder size (9m, 2000m, 9m) turn (90deg, 0deg, 0deg) move (120m, 3m, 0m)
                            + cube of street size (2048m, 3m, 9m) turn (0deg, 17deg, 0deg) move (0m, 9.2m, 40m))
)";

/// A cell's ground, in the model's frame.
std::vector<tiles::SurfacePiece> groundOf(const std::filesystem::path& folder, const Cell& cell) {
    tiles::Library library;
    const auto read = tiles::readCell(tiles::contentFile(folder, cell), library);
    EXPECT_TRUE(read.ok()) << cell.name();
    return read.ok() ? read->content.ground : std::vector<tiles::SurfacePiece>{};
}

/// Joins vertices of equal place and counts how often edges are taken either way.
class Welded {
public:
    void add(const std::vector<tiles::SurfacePiece>& pieces, Vec3d centre) {
        for (const tiles::SurfacePiece& piece : pieces)
            for (size_t i = 0; i < piece.indices.size(); i += 3) {
                ++triangles;
                for (size_t k = 0; k < 3; ++k) {
                    const Bits a = at(piece, i + k, centre), b = at(piece, i + (k + 1) % 3, centre);
                    if (a < b) ++edges_[{a, b}];
                    if (b < a) --edges_[{b, a}];
                }
            }
    }
    /// Edges that are taken more often one way than the other, away from the border of the square around the origin.
    size_t openInside(double half_m) const {
        size_t open = 0;
        const auto onBorder = [&](const Bits& p) {
            return std::array{std::abs(p[0]) == half_m, std::abs(p[2]) == half_m};
        };
        for (const auto& [edge, count] : edges_) {
            if (count == 0) continue;
            const auto a = onBorder(edge.first), b = onBorder(edge.second);
            open += !((a[0] && b[0]) || (a[1] && b[1]));
        }
        return open;
    }

    size_t triangles = 0;

private:
    static Bits at(const tiles::SurfacePiece& piece, size_t corner, Vec3d centre) {
        const Vec3d p = piece.positions[piece.indices[corner]].as<double>() + centre;
        return {p.x + 0.0, p.y + 0.0, p.z + 0.0};
    }

    std::map<std::pair<Bits, Bits>, int> edges_;
};

TEST(Ground, SixteenBySixteenCellsWeldWithoutToleranceAtEachLevel) {
    Baked baked(hills);
    baked.side_m = 32;
    for (int level = 0; level < 3; ++level) {
        const Scratch folder;
        const auto wanted = [&](const Cell& c) {
            return c.level == level && c.x >= -8 && c.x < 8 && c.z >= -8 && c.z < 8;
        };
        baked.runCells(folder.path(), wanted);
        Welded welded;
        size_t cells = 0;
        for (const Cell& cell : baked.plan.cells)
            if (wanted(cell)) {
                welded.add(groundOf(folder.path(), cell), cell.centre(baked.side_m));
                ++cells;
            }
        EXPECT_EQ(cells, 256u);
        EXPECT_GT(welded.triangles, 20'000u);
        EXPECT_EQ(welded.openInside(8 * baked.side_m * (1 << level)), 0u) << "level " << level;
    }
}

TEST(Ground, OfACellIsTheSameAloneAndAmongItsNeighbours) {
    Baked baked(hills);
    baked.side_m = 32;  // a block: what it borrows is as wide as itself
    const auto inside = [](const Cell& c) { return c.level < 2 && c.x >= -2 && c.x < 2 && c.z >= -2 && c.z < 2; };
    const Scratch together, apart;
    baked.runCells(together.path(), inside);
    size_t cells = 0;
    for (const Cell& cell : std::vector(baked.plan.cells)) {
        if (!inside(cell)) continue;
        baked.runCells(apart.path(), [&](const Cell& c) { return c == cell; });
        EXPECT_EQ(contentOf(tiles::contentFile(together.path(), cell)),
                  contentOf(tiles::contentFile(apart.path(), cell)))
            << cell.name();
        ++cells;
    }
    EXPECT_EQ(cells, 32u);
}

/// Heights of the upper surface along a line x = const, by z.
std::map<double, double> profileOf(const std::vector<tiles::SurfacePiece>& pieces, Vec3d centre, double x_m) {
    std::map<double, double> heights;
    for (const tiles::SurfacePiece& piece : pieces)
        for (const Vec3f& p : piece.positions) {
            const Vec3d at = p.as<double>() + centre;
            if (at.x != x_m || at.y < -10) continue;
            const auto [known, fresh] = heights.try_emplace(at.z, at.y);
            if (!fresh) known->second = std::max(known->second, at.y);
        }
    return heights;
}

/// The greatest difference of two lines of heights at the places of the first, away from the street's kerbs.
double farthest(const std::map<double, double>& fine, const std::map<double, double>& coarse) {
    double most = 0;
    for (const auto& [z, height] : fine) {
        const auto after = coarse.lower_bound(z);
        if (std::abs(z - 40) < 9) continue;
        if (after == coarse.end() || after == coarse.begin()) continue;
        const auto before = std::prev(after);
        const double share = (z - before->first) / (after->first - before->first);
        most = std::max(most, std::abs(height - (before->second + share * (after->second - before->second))));
    }
    return most;
}

TEST(Ground, SkirtsReachOverTheGapsBetweenLevels) {
    Baked baked(hills);
    const Scratch folder;
    // Cells of each level that meet at x = 0, over the steepest of the hills.
    baked.runCells(folder.path(), [](const Cell& c) { return c.x >= -1 && c.x <= 0 && c.z >= 0 && c.z < 1; });
    for (int level = 0; level < 2; ++level) {
        const Cell fine{level, -1, 0}, coarse{level + 1, 0, 0};
        const auto a = profileOf(groundOf(folder.path(), fine), fine.centre(64), 0);
        const auto b = profileOf(groundOf(folder.path(), coarse), coarse.centre(64), 0);
        EXPECT_GT(a.size(), 16u);
        EXPECT_GT(b.size(), 16u);
        EXPECT_LT(farthest(a, b), .5 * (1 << level)) << "a skirt of the finer level";
        const auto glb = tiles::readGlb(tiles::contentFile(folder.path(), fine));
        ASSERT_TRUE(glb.ok());
        size_t skirts = 0;
        for (const auto& mesh : glb->json["meshes"])
            for (const auto& primitive : mesh["primitives"])
                if (primitive.contains("extras")) skirts += primitive["extras"]["skirtTriangles"].get<size_t>();
        EXPECT_GE(skirts, 4 * a.size());
    }
}

/// A square of two triangles that looks up or down.
tiles::SurfacePiece square(bool up) {
    tiles::SurfacePiece piece;
    piece.positions = {{-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}};
    piece.normals.assign(4, {0, up ? 1.f : -1.f, 0});
    piece.indices = up ? std::vector<uint32_t>{0, 1, 2, 0, 2, 3} : std::vector<uint32_t>{0, 2, 1, 0, 3, 2};
    return piece;
}

TEST(Ground, SkirtsHangInsideTheSolidAndFaceTheNeighbours) {
    for (const bool up : {true, false}) {
        tiles::SurfacePiece piece = square(up);
        const double sign = up ? -1 : 1;
        tiles::addSkirts(piece, {2, 1, [&](const std::vector<Vec3d>& places) {
                                     std::vector<bool> inside;
                                     for (const Vec3d& p : places) inside.push_back(sign * p.y > 0 && sign * p.y < .3);
                                     return inside;
                                 }});
        EXPECT_EQ(piece.skirtTriangles, 8u);
        ASSERT_EQ(piece.indices.size(), 6u + 24u);
        for (size_t i = 6; i < piece.indices.size(); i += 3) {
            const auto at = [&](size_t k) { return piece.positions[piece.indices[i + k]].as<double>(); };
            const Vec3d across = cross(at(1) - at(0), at(2) - at(0)), middle = (at(0) + at(1) + at(2)) / 3.0;
            EXPECT_GT(dot(across, Vec3d{middle.x, 0, middle.z}), 0) << "towards the neighbour";
            EXPECT_NEAR(across.y, 0, 1e-9);
        }
        for (size_t v = 4; v < piece.positions.size(); ++v)
            EXPECT_EQ(static_cast<double>(piece.positions[v].y), sign * .25) << "the depth halved twice";
    }
    tiles::SurfacePiece thin = square(true);
    tiles::addSkirts(thin, {2, 1, [](const std::vector<Vec3d>& places) { return std::vector<bool>(places.size()); }});
    EXPECT_EQ(thin.skirtTriangles, 0u) << "there is no room below";
    tiles::SurfacePiece inner = square(true);
    tiles::addSkirts(inner,
                     {8, 1, [](const std::vector<Vec3d>& places) { return std::vector<bool>(places.size(), true); }});
    EXPECT_EQ(inner.skirtTriangles, 0u) << "its edges lie on no border";
}

}  // namespace
}  // namespace sgm::pipeline
