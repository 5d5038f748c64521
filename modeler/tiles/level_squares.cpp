#include "modeler/tiles/level_squares.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

namespace sgm::tiles {
namespace {

constexpr int mostSide = 16, leastSide = 4;
constexpr uint32_t none = 0xffffffffu;

/// Half a square of the grid.
struct Half {
    int x, z;    ///< the square's low corner, in steps of the grid
    uint32_t y;  ///< the bits of its height
    bool up;     ///< the way it looks
    std::array<uint32_t, 3> vertices;
};

using LayerKey = std::pair<uint32_t, bool>;  ///< bits of the height, whether it looks up
using TileKey = std::pair<int, int>;         ///< steps along x and z, in sides of a tile

/// The squares of one height that look the same way, in tiles of mostSide × mostSide.
struct Layer {
    struct Tile {
        std::array<std::array<uint32_t, 2>, mostSide * mostSide> halves;  ///< triangles of each square, or none
        Tile() {
            for (auto& h : halves) h = {none, none};
        }
        bool isWhole(int x, int z) const { return halves[static_cast<size_t>(z * mostSide + x)][1] != none; }
    };
    std::map<TileKey, Tile> tiles;
};

int floored(int v) { return (v >= 0 ? v : v - mostSide + 1) / mostSide; }

class Merger {
public:
    Merger(std::span<const uint32_t> corners, std::span<const Vec3f> positions, Vec3d origin, double pitch_m)
        : corners_(corners), positions_(positions), origin_(origin), pitch_m_(pitch_m) {}

    std::vector<uint32_t> run() {
        const auto triangles = static_cast<uint32_t>(corners_.size() / 3);
        dropped_.assign(triangles, false);
        for (uint32_t t = 0; t < triangles; ++t)
            if (const auto half = halfAt(t)) take(*half, t);
        for (auto& [key, layer] : layers_)
            for (auto& [at, tile] : layer.tiles) merge(tile, key.second, 0, 0, mostSide);
        std::vector<uint32_t> out;
        out.reserve(corners_.size());
        for (uint32_t t = 0; t < triangles; ++t)
            if (!dropped_[t]) out.insert(out.end(), {corners_[3 * t], corners_[3 * t + 1], corners_[3 * t + 2]});
        out.insert(out.end(), fans_.begin(), fans_.end());
        return out;
    }

private:
    /// A coordinate in steps of the grid, where it is a whole number of them.
    std::optional<int> stepOf(double v) const {
        const double step = v / pitch_m_, whole = std::round(step);
        return step == whole ? std::optional(static_cast<int>(whole)) : std::nullopt;
    }

    std::optional<Half> halfAt(uint32_t t) const {
        const float y = positions_[corners_[3 * t]].y;
        std::array<int, 3> x{}, z{};
        for (size_t k = 0; k < 3; ++k) {
            const Vec3f& p = positions_[corners_[3 * t + k]];
            if (p.y != y) return {};
            const auto px = stepOf(double{p.x} - origin_.x), pz = stepOf(double{p.z} - origin_.z);
            if (!px || !pz) return {};
            x[k] = *px, z[k] = *pz;
        }
        const auto [x0, x1] = std::minmax({x[0], x[1], x[2]});
        const auto [z0, z1] = std::minmax({z[0], z[1], z[2]});
        if (x1 - x0 != 1 || z1 - z0 != 1) return {};
        const int across = (z[1] - z[0]) * (x[2] - x[0]) - (x[1] - x[0]) * (z[2] - z[0]);
        return Half{x0,
                    z0,
                    std::bit_cast<uint32_t>(y),
                    across > 0,
                    {corners_[3 * t], corners_[3 * t + 1], corners_[3 * t + 2]}};
    }

    void take(const Half& half, uint32_t t) {
        const LayerKey layer{half.y, half.up};
        const TileKey place{floored(half.x), floored(half.z)};
        if (!last_.tile || last_.layer != layer || last_.place != place)
            last_ = {&layers_[layer].tiles[place], layer, place};
        Layer::Tile& tile = *last_.tile;
        const int x = half.x - floored(half.x) * mostSide, z = half.z - floored(half.z) * mostSide;
        auto& halves = tile.halves[static_cast<size_t>(z * mostSide + x)];
        (halves[0] == none ? halves[0] : halves[1]) = t;
    }

    /// The square of the tile with this low corner, or its quarters.
    void merge(const Layer::Tile& tile, bool up, int x, int z, int side) {
        bool whole = true;
        for (int dz = 0; whole && dz < side; ++dz)
            for (int dx = 0; whole && dx < side; ++dx) whole = tile.isWhole(x + dx, z + dz);
        if (whole) return addFan(tile, up, x, z, side);
        const int half = side / 2;
        if (half < leastSide) return;
        for (const int quarter : {0, 1, 2, 3})
            merge(tile, up, x + (quarter & 1) * half, z + (quarter >> 1) * half, half);
    }

    void addFan(const Layer::Tile& tile, bool up, int x0, int z0, int side) {
        for (int z = z0; z < z0 + side; ++z)
            for (int x = x0; x < x0 + side; ++x)
                for (const uint32_t t : tile.halves[static_cast<size_t>(z * mostSide + x)]) dropped_[t] = true;
        const auto at = [&](int x, int z) { return vertexAt(tile, x0, z0, side, x, z); };
        const uint32_t middle = at(side / 2, side / 2);
        std::vector<uint32_t> ring;
        for (int k = 0; k < side; ++k) ring.push_back(at(k, 0));
        for (int k = 0; k < side; ++k) ring.push_back(at(side, k));
        for (int k = side; k > 0; --k) ring.push_back(at(k, side));
        for (int k = side; k > 0; --k) ring.push_back(at(0, k));
        for (size_t k = 0; k < ring.size(); ++k) {
            const uint32_t a = ring[k], b = ring[(k + 1) % ring.size()];
            fans_.insert(fans_.end(), {middle, up ? b : a, up ? a : b});
        }
    }

    /// The vertex at a corner of the square's own grid: that of the square that touches it.
    uint32_t vertexAt(const Layer::Tile& tile, int x0, int z0, int side, int x, int z) const {
        const int sx = std::min(x, side - 1), sz = std::min(z, side - 1);
        const auto& halves = tile.halves[static_cast<size_t>((z0 + sz) * mostSide + x0 + sx)];
        Vec3f low = positions_[corners_[3 * halves[0]]];
        for (const uint32_t t : halves)
            for (size_t k = 0; k < 3; ++k) low = min(low, positions_[corners_[3 * t + k]]);
        for (const uint32_t t : halves)
            for (size_t k = 0; k < 3; ++k) {
                const Vec3f& p = positions_[corners_[3 * t + k]];
                if ((p.x > low.x) == (x > sx) && (p.z > low.z) == (z > sz)) return corners_[3 * t + k];
            }
        return none;  // not reached: two halves have all four corners
    }

    const std::span<const uint32_t> corners_;
    const std::span<const Vec3f> positions_;
    const Vec3d origin_;
    const double pitch_m_;
    struct Last {
        Layer::Tile* tile = nullptr;
        LayerKey layer;
        TileKey place;
    };

    std::map<LayerKey, Layer> layers_;
    Last last_;  ///< the tile of the last triangle, which is mostly the next one's
    std::vector<bool> dropped_;
    std::vector<uint32_t> fans_;
};

}  // namespace

std::vector<uint32_t> mergedSquares(std::span<const uint32_t> corners, std::span<const Vec3f> positions, Vec3d origin,
                                    double pitch_m) {
    return Merger(corners, positions, origin, pitch_m).run();
}

}  // namespace sgm::tiles
