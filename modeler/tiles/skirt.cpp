#include "modeler/tiles/skirt.h"

#include <array>
#include <cmath>
#include <map>
#include <tuple>

namespace sgm::tiles {
namespace {

/// An edge on the border of a cell, as its only triangle there runs along it.
struct Edge {
    uint32_t from, to;
    Vec3d inwards;  ///< unit vector along the border, into the solid
};

/// Which of the four borders a place lies on, a bit each.
unsigned bordersAt(const Vec3f& p, double half) {
    const double x = static_cast<double>(p.x), z = static_cast<double>(p.z);
    return (x == -half ? 1u : 0u) | (x == half ? 2u : 0u) | (z == -half ? 4u : 0u) | (z == half ? 8u : 0u);
}

/// Along the border from a surface with that normal into the solid: straight down or up where the surface is no wall,
/// so that the strips of neighbouring edges meet. Zero for a surface that lies in the border.
Vec3d inwardsOf(Vec3d normal, bool isAcrossX) {
    if (std::abs(normal.y) > .3) return {0, normal.y > 0 ? -1.0 : 1.0, 0};
    (isAcrossX ? normal.x : normal.z) = 0;
    const double size = length(normal);
    return size > .1 ? normal / -size : Vec3d{};
}

/// The edges on the borders that one triangle alone has.
std::vector<Edge> openEdges(const SurfacePiece& piece, double half) {
    using Place = std::array<float, 3>;
    std::map<std::pair<Place, Place>, std::vector<Edge>> open;
    const auto placeOf = [&](uint32_t v) {
        const Vec3f& p = piece.positions[v];
        return Place{p.x, p.y, p.z};
    };
    for (size_t t = 0; t + 2 < piece.indices.size(); t += 3)
        for (size_t k = 0; k < 3; ++k) {
            const uint32_t a = piece.indices[t + k], b = piece.indices[t + (k + 1) % 3],
                           c = piece.indices[t + (k + 2) % 3];
            const unsigned shared = bordersAt(piece.positions[a], half) & bordersAt(piece.positions[b], half);
            if (shared == 0 || placeOf(a) == placeOf(b)) continue;
            // What runs along the same edge the other way closes it.
            if (const auto other = open.find({placeOf(b), placeOf(a)}); other != open.end()) {
                other->second.pop_back();
                if (other->second.empty()) open.erase(other);
                continue;
            }
            const Vec3d at = piece.positions[a].as<double>();
            const Vec3d across = cross(piece.positions[b].as<double>() - at, piece.positions[c].as<double>() - at);
            const double size = length(across);
            const Vec3d normal = size > 0 ? across / size : piece.normals[a].as<double>();
            open[{placeOf(a), placeOf(b)}].push_back({a, b, inwardsOf(normal, (shared & 3) != 0)});
        }
    std::vector<Edge> edges;
    for (const auto& [places, list] : open)
        for (const Edge& edge : list)
            if (length(edge.inwards) > 0) edges.push_back(edge);
    return edges;
}

/// The lower ends of strips: one for each vertex and direction.
class LowerEnds {
public:
    LowerEnds(SurfacePiece& piece, const SkirtRequest& request) : piece_(piece), request_(request) {}

    void want(uint32_t vertex, Vec3d inwards) {
        const auto [at, fresh] = numbers_.try_emplace(key(vertex, inwards), wanted_.size());
        if (fresh) wanted_.push_back({vertex, inwards, 0});
    }
    /// Lets each reach as far as it stays inside, by halves of the depth.
    void reach() {
        double depth = request_.depth_m;
        for (int halving = 0; halving < 4; ++halving, depth /= 2) {
            std::vector<size_t> open;
            std::vector<Vec3d> places;
            for (size_t i = 0; i < wanted_.size(); ++i)
                if (wanted_[i].depth == 0) {
                    open.push_back(i);
                    places.push_back(placeOf(wanted_[i], depth));
                }
            const std::vector<bool> inside = request_.inside(places);
            for (size_t i = 0; i < open.size(); ++i)
                if (inside[i]) wanted_[open[i]].depth = depth;
        }
    }
    /// The vertex at the end, which is the upper one where there is no room below it.
    uint32_t vertexOf(uint32_t upper, Vec3d inwards) {
        End& end = wanted_[numbers_.at(key(upper, inwards))];
        if (end.depth == 0) return upper;
        if (end.made == 0) {
            end.made = static_cast<uint32_t>(piece_.positions.size());
            piece_.positions.push_back(placeOf(end, end.depth).as<float>());
            piece_.normals.push_back(Vec3f(piece_.normals[upper]));
            if (!piece_.uvs.empty()) piece_.uvs.push_back(std::array(piece_.uvs[upper]));
            if (!piece_.tangents.empty()) piece_.tangents.push_back(Vec3f(piece_.tangents[upper]));
        }
        return end.made;
    }

private:
    struct End {
        uint32_t upper;
        Vec3d inwards;
        double depth;
        uint32_t made = 0;
    };
    using Key = std::tuple<uint32_t, double, double, double>;
    static Key key(uint32_t vertex, Vec3d d) { return {vertex, d.x, d.y, d.z}; }
    Vec3d placeOf(const End& end, double depth) const {
        return piece_.positions[end.upper].as<double>() + end.inwards * depth;
    }

    SurfacePiece& piece_;
    const SkirtRequest& request_;
    std::map<Key, size_t> numbers_;
    std::vector<End> wanted_;
};

}  // namespace

void addSkirts(SurfacePiece& piece, const SkirtRequest& request) {
    const std::vector<Edge> edges = openEdges(piece, request.side_m / 2);
    LowerEnds ends(piece, request);
    for (const Edge& edge : edges) ends.want(edge.from, edge.inwards), ends.want(edge.to, edge.inwards);
    ends.reach();
    for (const Edge& edge : edges) {
        const uint32_t a = edge.from, b = edge.to;
        const uint32_t lowerA = ends.vertexOf(a, edge.inwards), lowerB = ends.vertexOf(b, edge.inwards);
        for (const std::array<uint32_t, 3>& corners : {std::array{b, a, lowerA}, {b, lowerA, lowerB}}) {
            if (corners[0] == corners[1] || corners[1] == corners[2] || corners[0] == corners[2]) continue;
            piece.indices.insert(piece.indices.end(), corners.begin(), corners.end());
            ++piece.skirtTriangles;
        }
    }
}

}  // namespace sgm::tiles
