#include "modeler/mesh/curved_edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <unordered_map>
#include <unordered_set>

#include "modeler/eval/local_tapes.h"
#include "modeler/field/hash_index.h"
#include "modeler/mesh/edge_splits.h"
#include "modeler/mesh/one_chunk.h"
#include "modeler/mesh/piece_samples.h"

namespace sgm::mesh {
namespace {

constexpr int mostSplits = 3;   ///< of one edge; each leaves a quarter of what it is off
constexpr double likely = 0.5;  ///< of the tolerance: by the normals an edge is so far off that it is looked at
/// Times the tolerance: an edge so long that is off by so much, by the normals, lies along a straight surface, as of a
/// column, for simplification leaves none on others.
constexpr double longEdge = 400, farOff = 4;
constexpr double farthest = 0.3;  ///< of an edge's length: where its middle may go
/// Of an edge's length, from a crease: where the pieces beside it are looked at, step by step.
constexpr std::array besideCrease{0.15, 0.05, 0.02};
constexpr double insideTriangle = 0.5;  ///< of a triangle's height: the same, at most
constexpr double leastTurn = 0.05;      ///< sine between the pieces beside a crease
constexpr double settled = 0.25;        ///< of the way from the middle: the last step, at most
constexpr size_t edgesAtOnce = 8;       ///< that lie beside each other

/// The piece on one side of an edge.
struct EdgeSide {
    uint32_t halfEdge = 0;  ///< 3 · triangle + the corner that it begins at
    OriginId origin = 0;
    Label label = 0;
    Vec3d inward;  ///< unit, into the triangle, across the edge
    double height_m = 0;
    Vec3f normal;  ///< of the piece at `at`
};

/// An edge that may be off.
struct CurvedEdge {
    uint32_t a = 0, b = 0;
    std::array<EdgeSide, 2> sides{};
    size_t sideCount = 0;
    Vec3d middle, along;  ///< metres; unit
    double length_m = 0;
    Vec3d at;             ///< on the surface or crease, as far as it is known
    double step_m = 0;    ///< the last one there
    bool isLost = false;  ///< another piece shows beside it
    uint32_t place = 0;   ///< in the list

    Vec3d centre() const { return middle; }
    uint32_t number() const { return place; }
    bool isBorder() const { return sides[0].origin != sides[1].origin || sides[0].label != sides[1].label; }
};

/// Edges that are looked at together.
using EdgeGroup = std::span<CurvedEdge>;

/// Puts the middles of edges on the surface. One worker's.
class EdgeProber {
public:
    explicit EdgeProber(const eval::Tape& field) : tapes_(field) {}

    Box3f boxOf(const EdgeGroup& edges) const {
        Box3f box;
        for (const CurvedEdge& e : edges)
            box = hull(
                box, Box3f{e.middle.as<float>(), e.middle.as<float>()}.inflated(static_cast<float>(0.5 * e.length_m)));
        return box;
    }
    eval::LocalTapes& tapes() { return tapes_; }

    void probe(std::span<const EdgeGroup> groups, std::span<const Box3f> boxes) {
        for (const EdgeGroup& edges : groups)
            for (CurvedEdge& e : edges) e.isLost = true;  // unless a tape is there
        tapes_.visit(boxes, [&](size_t i, const eval::Tape& tape) {
            for (CurvedEdge& e : groups[i]) e.isLost = false, e.at = e.middle;
            for (const double share : besideCrease) step(groups[i], share, {&tape, {}});
        });
    }

private:
    void step(const EdgeGroup& edges, double share, const BlockTapes& tape) {
        samples_.clear();
        for (const CurvedEdge& e : edges)
            for (const EdgeSide& side : e.sides) {
                const double beside_m = e.isBorder() ? std::min(share * e.length_m, insideTriangle * side.height_m) : 0;
                samples_.add(tape, 0, (e.at + side.inward * beside_m).as<float>());
            }
        samples_.evaluate(tapes_.workspace());
        for (size_t i = 0; i < edges.size(); ++i) {
            CurvedEdge& e = edges[i];
            const auto a = planeOf(2 * i, e.sides[0], e.at), b = planeOf(2 * i + 1, e.sides[1], e.at);
            if (!a || !b) e.isLost = true;
            if (e.isLost) continue;
            const auto way = e.isBorder() ? meeting(*a, *b, e.along) : std::optional(a->normal * a->level);
            if (!way) {
                e.isLost = true;
                continue;
            }
            e.step_m = length(*way), e.at = e.at + *way;
        }
    }

    /// A tangent plane: normal · (p − at) = level.
    struct TangentPlane {
        Vec3d normal;
        double level;
    };
    /// That of the i-th sample, if it is of that side's piece, whose normal it leaves.
    std::optional<TangentPlane> planeOf(size_t i, EdgeSide& side, Vec3d at) const {
        float value = 0;
        const PiecePoint p = samples_.point(i, value);
        const Vec3d gradient = p.gradient.as<double>();
        const double slope = length(gradient);
        if (p.label != side.label || p.origin != side.origin || !(slope > 0)) return std::nullopt;
        const Vec3d normal = gradient / slope;
        side.normal = normal.as<float>();
        return TangentPlane{normal, dot(normal, p.at.as<double>() - at) - static_cast<double>(value) / slope};
    }

    /// The way to where two planes meet the one across an edge.
    static std::optional<Vec3d> meeting(const TangentPlane& a, const TangentPlane& b, Vec3d along) {
        const double turn = dot(cross(a.normal, b.normal), along);
        if (!(std::abs(turn) > leastTurn)) return std::nullopt;
        return (cross(b.normal, along) * a.level + cross(along, a.normal) * b.level) * (1 / turn);
    }

    eval::LocalTapes tapes_;
    PieceSamples samples_;
};

/// Finds the edges of a chunk that may be off.
class EdgeFinder {
public:
    explicit EdgeFinder(const EdgeSplitter& mesh) : mesh_(mesh), chunk_(mesh.chunk()) {
        findBorderVertices();
        uint64_t key = 0;
        int64_t* count = nullptr;
        for (uint32_t t = 0; t < chunk_.triangles.size(); ++t) {
            if (!count || keyOf(t) != key) key = keyOf(t), count = &bordering_[key];
            for (int k = 0; k < 3; ++k) *count += isBorder_[chunk_.triangles[t][k]] ? 1 : -1;
        }
    }

    /// Of those that changed triangles have, and all triangles of pieces that are smooth now and weren't before.
    /// `smooth` are the pieces that were, and becomes those that are.
    std::vector<CurvedEdge> find(double tolerance_m, std::unordered_set<uint64_t>& smooth) {
        std::vector<bool> isAsked(chunk_.triangles.size());
        for (const uint32_t t : mesh_.changed()) isAsked[t] = true;
        for (uint32_t t = 0; t < chunk_.triangles.size(); ++t) {
            if (!isAsked[t] && (!isSmooth(t) || smooth.contains(keyOf(t)))) continue;
            for (int k = 0; k < 3; ++k)
                if (bendOf(t, k) > likely * tolerance_m && isFollowed(t, k, tolerance_m)) add(t, k);
        }
        for (const auto& [key, corners] : bordering_)
            if (corners > 0) smooth.insert(key);
        if (edges_.empty()) return {};
        for (uint32_t t = 0; t < chunk_.triangles.size(); ++t)
            for (int k = 0; k < 3; ++k) addSide(t, k);
        std::erase_if(edges_, [](const CurvedEdge& e) { return e.sideCount != 2; });
        return std::move(edges_);
    }

private:
    static constexpr uint32_t none = field::HashIndex::none;

    /// Those around which triangles of several pieces meet.
    void findBorderVertices() {
        isBorder_.resize(chunk_.positions.size()), isEnd_.resize(chunk_.positions.size());
        std::vector<uint32_t> first(chunk_.positions.size(), none);
        for (uint32_t t = 0; t < chunk_.triangles.size(); ++t)
            for (int k = 0; k < 3; ++k) {
                uint32_t& one = first[chunk_.triangles[t][k]];
                if (one == none) one = t;
                if (chunk_.labels[t] != chunk_.labels[one] || chunk_.origins[t] != chunk_.origins[one])
                    isBorder_[chunk_.triangles[t][k]] = true;
            }
    }

    uint64_t keyOf(uint32_t t) const { return uint64_t{chunk_.origins[t]} << 32 | chunk_.labels[t]; }

    /// A piece that is simplified to strips between its borders is smooth, as an arch or a shaft: all its edges count.
    /// A rough or organic one has vertices inside, and no cells follow it; a column has some where cells of two sizes
    /// meet.
    bool isFollowed(uint32_t t, int k, double tolerance_m) const {
        const auto [a, b] = endsOf(t, k);
        const double length_m = length(chunk_.positions[a].as<double>() - chunk_.positions[b].as<double>());
        if (length_m > longEdge * tolerance_m && bendOf(t, k) > farOff * tolerance_m) return true;
        return (isBorder_[a] && isBorder_[b]) || isSmooth(t);
    }
    bool isSmooth(uint32_t t) const { return bordering_.at(keyOf(t)) > 0; }

    /// How far the middle of the edge behind a corner is from the surface, by the normals at its ends: for an arc
    /// (n_b − n_a) · (b − a) / 8.
    double bendOf(uint32_t t, int k) const {
        const Triangle& c = chunk_.triangles[t];
        const Vec3f way = chunk_.positions[c[(k + 1) % 3]] - chunk_.positions[c[k]];
        const auto& n = mesh_.normals()[t];
        const Vec3f turn = n[static_cast<size_t>((k + 1) % 3)] - n[static_cast<size_t>(k)];
        return static_cast<double>(std::abs(dot(turn, way))) / 8;
    }

    std::array<uint32_t, 2> endsOf(uint32_t t, int k) const {
        const uint32_t a = chunk_.triangles[t][k], b = chunk_.triangles[t][(k + 1) % 3];
        return {std::min(a, b), std::max(a, b)};
    }
    static uint64_t hashOf(const std::array<uint32_t, 2>& ends) {
        const uint64_t h = (uint64_t{ends[0]} << 32 | ends[1]) * 0x9e3779b97f4a7c15u;
        return h ^ (h >> 32);
    }
    uint32_t find(const std::array<uint32_t, 2>& ends) const {
        return index_.find(hashOf(ends), [&](uint32_t e) { return edges_[e].a == ends[0] && edges_[e].b == ends[1]; });
    }

    void add(uint32_t t, int k) {
        const std::array<uint32_t, 2> ends = endsOf(t, k);
        if (find(ends) != none) return;
        CurvedEdge e;
        e.a = ends[0], e.b = ends[1], e.place = static_cast<uint32_t>(edges_.size());
        const Vec3d from = chunk_.positions[e.a].as<double>(), way = chunk_.positions[e.b].as<double>() - from;
        e.middle = from + way * 0.5, e.length_m = length(way), e.along = normalized(way);
        index_.insert(hashOf(ends), e.place);
        isEnd_[e.a] = isEnd_[e.b] = true;
        edges_.push_back(e);
    }

    void addSide(uint32_t t, int k) {
        const std::array<uint32_t, 2> ends = endsOf(t, k);
        if (!isEnd_[ends[0]] || !isEnd_[ends[1]]) return;
        const uint32_t place = find(ends);
        if (place == none || edges_[place].sideCount == 2) return;
        CurvedEdge& e = edges_[place];
        const Vec3d apex = chunk_.positions[chunk_.triangles[t][(k + 2) % 3]].as<double>() - e.middle;
        const Vec3d up = apex - e.along * dot(apex, e.along);
        e.sides[e.sideCount++] = {
            3 * t + static_cast<uint32_t>(k), chunk_.origins[t], chunk_.labels[t], normalized(up), length(up), {}};
    }

    const EdgeSplitter& mesh_;
    const Chunk& chunk_;
    std::vector<bool> isBorder_;                       ///< by vertex
    std::unordered_map<uint64_t, int64_t> bordering_;  ///< by piece: corners at its borders less those inside
    std::vector<CurvedEdge> edges_;
    std::vector<bool> isEnd_;  ///< by vertex: of one of these
    field::HashIndex index_;   ///< of edges
};

/// The edges that are off by more than the tolerance, in their order.
std::vector<EdgeSplit> splitsOf(const EdgeSplitter& mesh, const eval::Tape& field, double tolerance_m,
                                std::unordered_set<uint64_t>& smooth, int threads, Progress* progress) {
    std::vector<CurvedEdge> edges = EdgeFinder(mesh).find(tolerance_m, smooth);
    eval::orderByPlace(std::span(edges));
    std::vector<EdgeGroup> groups;
    for (size_t i = 0; i < edges.size(); i += edgesAtOnce)
        groups.push_back(std::span(edges).subspan(i, std::min(edgesAtOnce, edges.size() - i)));
    eval::probeInGroups(
        std::span(groups), threads, progress, nullptr, [&] { return EdgeProber(field); },
        [](EdgeProber& prober, std::span<const EdgeGroup> some, std::span<const Box3f> boxes, size_t) {
            prober.probe(some, boxes);
        });
    std::erase_if(edges, [&](const CurvedEdge& e) {
        const double way_m = length(e.at - e.middle);
        return e.isLost || !(way_m > tolerance_m) || way_m > farthest * e.length_m || e.step_m > settled * way_m;
    });
    std::sort(edges.begin(), edges.end(), [](const CurvedEdge& x, const CurvedEdge& y) { return x.place < y.place; });
    std::vector<EdgeSplit> splits;
    for (const CurvedEdge& e : edges)
        splits.push_back(
            {{e.sides[0].halfEdge, e.sides[1].halfEdge}, e.at.as<float>(), {e.sides[0].normal, e.sides[1].normal}});
    return splits;
}

}  // namespace

Result<size_t> splitCurvedEdges(Mesh& mesh, const eval::Tape& field, double tolerance_m, int threads,
                                Progress* progress) {
    if (mesh.hasPositionsOnly()) return size_t{0};
    Chunk whole = joinChunks(mesh);
    if (whole.labels.empty()) return size_t{0};
    EdgeSplitter splitter(std::move(whole), threads, progress);
    std::unordered_set<uint64_t> smooth;  // pieces
    size_t count = 0;
    for (int round = 0; round < mostSplits; ++round) {
        const std::vector<EdgeSplit> splits = splitsOf(splitter, field, tolerance_m, smooth, threads, progress);
        if (cancelled(progress)) return cancelledError();
        const size_t split = splits.empty() ? 0 : splitter.split(splits);
        if (cancelled(progress)) return cancelledError();
        if (split == 0) break;
        count += split;
    }
    if (count > 0) {
        mesh.chunks.clear();
        mesh.chunks.push_back(splitter.take());
    }
    return count;
}

}  // namespace sgm::mesh
