#include "modeler/mesh/release.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <span>

#include "modeler/core/parallel.h"
#include "modeler/mesh/box_finder.h"
#include "modeler/mesh/exact_meeting.h"

namespace sgm::mesh {
namespace {

/// Of the square of a triangle's longest edge: how far its area may face away, for rounding.
constexpr double foldedShare = 1e-6;
constexpr double settledShare = 0.02;  ///< of the distance of its neighbours: a corner this near to its planes stays
constexpr double leastSine = 0.05;     ///< between planes that meet in a point
constexpr size_t trianglesPerStep = 1 << 13;  ///< of a parallel loop
constexpr int mostExchanges = 6;              ///< of a vertex
/// Of the way between two vertices that are exchanged: how far each ends up from its middle.
constexpr float exchangedShare = 0.125f;

class Release {
public:
    Release(const Mesh& mesh, FlatMesh& flat) : mesh_(mesh), flat_(flat) {}

    size_t run(int threads, const Progress* progress) {
        findVertices();
        if (moves_.empty()) return 0;
        const size_t confined = moves_.size();
        findTriangles();
        addNeighbours();
        findTriangles();
        findAround();
        placeJunctions();
        for (const Move& move : moves_) flat_.positions[move.vertex] = move.place;
        do {
            unfold();
        } while (!cancelled(progress) && revert(crossingTriangles(threads, progress)));
        const auto end = moves_.begin() + static_cast<ptrdiff_t>(confined);
        return static_cast<size_t>(std::count_if(moves_.begin(), end, [](const Move& m) { return m.moved; }));
    }

private:
    struct Move {
        uint32_t vertex;
        Vec3f before, place;
        bool moved = true;
        int exchanges = 0, exchangedIn = 0;  ///< how often, and in which round last
        int centredIn = 0;                   ///< in which round, or 0
        Vec3f compared = before;             ///< its place when triangles were compared last
    };
    /// A triangle with a vertex that moves.
    struct Touched {
        uint32_t triangle;
        int creases;    ///< a bit for each corner that lies on a crease
        Vec3d outward;  ///< the sum of its corners' normals, of those at creases
        double before;  ///< twice its area, as far as it faced outward
    };
    static constexpr uint32_t none = 0xffffffffu;

    void findVertices() {
        moveOf_.assign(flat_.positions.size(), none);
        for (const Chunk& chunk : mesh_.chunks)
            for (const ConfinedVertex& confined : chunk.confined) {
                const uint32_t v = chunk.firstVertex + confined.vertex;
                moveOf_[v] = static_cast<uint32_t>(moves_.size());
                moves_.push_back({v, flat_.positions[v], confined.place});
            }
    }

    double facing(const Touched& touched) const {
        const Triangle& t = flat_.triangles[touched.triangle];
        const Vec3d a = flat_.positions[t.x].as<double>();
        return dot(cross(flat_.positions[t.y].as<double>() - a, flat_.positions[t.z].as<double>() - a),
                   touched.outward);
    }

    /// The other vertices of creases beside those that move: they may be exchanged with them.
    void addNeighbours() {
        for (const Touched& touched : touched_)
            for (int i = 0; i < 3; ++i) {
                const uint32_t v = flat_.triangles[touched.triangle][i];
                if (!(touched.creases >> i & 1) || moveOf_[v] != none) continue;
                moveOf_[v] = static_cast<uint32_t>(moves_.size());
                moves_.push_back({v, flat_.positions[v], flat_.positions[v]});
            }
    }

    /// The triangles and pieces around each vertex that may move.
    void findAround() {
        keysOf_.resize(moves_.size()), trianglesOf_.resize(moves_.size());
        for (const Touched& touched : touched_)
            for (int i = 0; i < 3; ++i)
                if (const uint32_t m = moveOf_[flat_.triangles[touched.triangle][i]]; m != none) {
                    keysOf_[m].push_back(flat_.keys[touched.triangle]);
                    trianglesOf_[m].push_back(touched.triangle);
                }
        for (auto& keys : keysOf_) {
            std::sort(keys.begin(), keys.end());
            keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
        }
    }

    /// A plane at a vertex.
    struct PlaneAt {
        uint64_t key;  ///< of its triangles, as FlatMesh::keys
        Vec3d normal, point;
        bool isInner;  ///< the point is no vertex of a crease
    };

    /// Vertices that three and more pieces share go to where the pieces' planes meet: what was kept in a face knows two
    /// of them.
    void placeJunctions() {
        std::vector<std::vector<PlaneAt>> planes(moves_.size());
        for (const Touched& touched : touched_) {
            const Triangle& t = flat_.triangles[touched.triangle];
            const uint64_t key = flat_.keys[touched.triangle];
            for (int i = 0; i < 3; ++i) {
                const uint32_t m = moveOf_[t[i]];
                if (m == none || keysOf_[m].size() < 3) continue;
                auto known = std::find_if(planes[m].begin(), planes[m].end(), [&](auto& p) { return p.key == key; });
                for (const int k : {(i + 1) % 3, (i + 2) % 3}) {
                    const uint32_t other = moveOf_[t[k]];
                    const Vec3f point = other == none ? flat_.positions[t[k]] : moves_[other].place;
                    const PlaneAt plane{key, touched.outward, point.as<double>(), !(touched.creases >> k & 1)};
                    if (known == planes[m].end())
                        known = planes[m].insert(known, plane);
                    else if (plane.isInner && !known->isInner)  // that lies on the surface as it is
                        *known = plane;
                }
            }
        }
        for (size_t m = 0; m < moves_.size(); ++m)
            if (planes[m].size() >= 3) moves_[m].place = meetingOf(planes[m], moves_[m].place);
    }

    /// The point of up to three planes nearest to `near`; `near` where they meet far from it.
    static Vec3f meetingOf(std::span<const PlaneAt> planes, Vec3f near) {
        const Vec3d from = near.as<double>();
        std::array<Vec3d, 3> basis{};
        std::array<double, 3> ways{};
        size_t n = 0;
        double size = 0;
        for (const PlaneAt& plane : planes) {
            if (n == 3) break;
            Vec3d direction = plane.normal;
            double way = dot(plane.normal, plane.point - from);
            for (size_t i = 0; i < n; ++i) {
                const double share = dot(plane.normal, basis[i]);
                direction -= basis[i] * share;
                way -= share * ways[i];
            }
            size = std::max(size, length(plane.point - from));
            const double rest = length(direction);
            if (!(rest > leastSine)) continue;
            basis[n] = direction * (1 / rest);
            ways[n++] = way / rest;
        }
        Vec3d found = from;
        for (size_t i = 0; i < n; ++i) found += basis[i] * ways[i];
        const double way = length(found - from);
        return way > settledShare * size && way <= size ? found.as<float>() : near;
    }

    void findTriangles() {
        touched_.clear();
        for (size_t i = 0; i < mesh_.chunks.size(); ++i) {
            const std::vector<CornerNormal>& normals = mesh_.chunks[i].cornerNormals;
            auto normal = normals.begin();
            for (uint32_t t = 0; t < flat_.parts[i].triangles; ++t) {
                const Triangle& corners = flat_.triangles[flat_.parts[i].firstTriangle + t];
                Touched touched{flat_.parts[i].firstTriangle + t, 0, {}, 0};
                for (; normal != normals.end() && normal->corner / 3 == t; ++normal)
                    touched.outward += normal->normal.as<double>(), touched.creases |= 1 << normal->corner % 3;
                if (moveOf_[corners.x] == none && moveOf_[corners.y] == none && moveOf_[corners.z] == none) continue;
                touched.outward = normalized(touched.outward);
                touched.before = facing(touched);
                touched_.push_back(touched);
            }
        }
    }

    /// Neighbours on a crease that changed places are exchanged, a few times at most; else a vertex goes between its
    /// neighbours on the crease; what still folds over moves back.
    void unfold() {
        for (auto folded = foldedTriangles(); !folded.empty(); folded = foldedTriangles()) {
            ++round_;
            std::vector<uint32_t> rest;
            for (const uint32_t t : folded) {
                const Triangle& corners = flat_.triangles[t];
                bool done = false;
                for (int i = 0; i < 3; ++i) done |= exchange(corners[i], corners[(i + 1) % 3]);
                for (int i = 0; i < 3 && !done; ++i) done |= centre(corners[i]);
                if (!done) rest.push_back(t);
            }
            if (!revert(rest) && rest.size() == folded.size()) return;
        }
    }

    /// Exchanges two vertices of one crease; a vertex beyond the corner that ends its crease goes to the other side of
    /// it. Whether that was done in this round.
    bool exchange(uint32_t v, uint32_t w) {
        if (moveOf_[v] == none || moveOf_[w] == none) return false;
        const bool vIsCorner = keysOf_[moveOf_[v]].size() > 2, wIsCorner = keysOf_[moveOf_[w]].size() > 2;
        if (vIsCorner && wIsCorner) return false;
        if (vIsCorner) return exchange(w, v);
        Move &a = moves_[moveOf_[v]], &b = moves_[moveOf_[w]];
        if (!wIsCorner && keysOf_[moveOf_[v]] != keysOf_[moveOf_[w]]) return false;
        if (a.exchangedIn == round_ && (wIsCorner || b.exchangedIn == round_)) return true;
        if (!a.moved || !b.moved || a.exchanges >= mostExchanges) return false;
        Vec3f &p = flat_.positions[v], &q = flat_.positions[w];
        if (wIsCorner && !isBeyond(v, w)) return false;
        ++a.exchanges;
        a.exchangedIn = round_;
        if (wIsCorner) {
            p = q + (q - p) * exchangedShare;
            return true;
        }
        if (b.exchanges >= mostExchanges) return false;
        const Vec3f middle = (p + q) * 0.5f, half = (q - p) * exchangedShare;
        p = middle + half, q = middle - half;
        ++b.exchanges;
        b.exchangedIn = round_;
        return true;
    }

    /// The vertices with which one that moves has an edge between two pieces.
    std::vector<uint32_t> creaseNeighbours(uint32_t v) const {
        std::vector<std::pair<uint32_t, uint64_t>> spokes;  // neighbour and key of a triangle at it
        for (const uint32_t t : trianglesOf_[moveOf_[v]])
            for (int i = 0; i < 3; ++i)
                if (flat_.triangles[t][i] != v) spokes.emplace_back(flat_.triangles[t][i], flat_.keys[t]);
        std::sort(spokes.begin(), spokes.end());
        std::vector<uint32_t> beside;
        for (size_t i = 1; i < spokes.size(); ++i)
            if (spokes[i].first == spokes[i - 1].first && spokes[i].second != spokes[i - 1].second)
                beside.push_back(spokes[i].first);
        return beside;
    }

    /// Whether a vertex of a crease lies on the far side of the corner that ends it.
    bool isBeyond(uint32_t v, uint32_t corner) const {
        const Vec3f at = flat_.positions[corner], way = flat_.positions[v] - at;
        const std::vector<uint32_t> beside = creaseNeighbours(v);
        return std::any_of(beside.begin(), beside.end(),
                           [&](uint32_t w) { return w != corner && dot(flat_.positions[w] - at, way) < 0; });
    }

    /// Moves a vertex between its neighbours on the crease, once; whether that was done in this round.
    bool centre(uint32_t v) {
        if (moveOf_[v] == none || keysOf_[moveOf_[v]].size() != 2) return false;
        Move& move = moves_[moveOf_[v]];
        if (move.centredIn != 0 || !move.moved) return move.centredIn == round_;
        const std::vector<uint32_t> beside = creaseNeighbours(v);
        if (beside.size() != 2) return false;
        flat_.positions[v] = (flat_.positions[beside[0]] + flat_.positions[beside[1]]) * 0.5f;
        move.centredIn = round_;
        return true;
    }

    std::vector<uint32_t> foldedTriangles() const {
        std::vector<uint32_t> folded;
        for (const Touched& touched : touched_) {
            const double now = facing(touched);
            if (now < touched.before && now < -foldedShare * longestSquare(touched.triangle))
                folded.push_back(touched.triangle);
        }
        return folded;
    }

    double longestSquare(uint32_t triangle) const {
        const Triangle& t = flat_.triangles[triangle];
        double most = 0;
        for (int i = 0; i < 3; ++i) {
            const Vec3d d = (flat_.positions[t[(i + 1) % 3]] - flat_.positions[t[i]]).as<double>();
            most = std::max(most, dot(d, d));
        }
        return most;
    }

    /// Whether a corner of a triangle isn't where it was at first, or when triangles were compared last.
    bool hasMovedFrom(Vec3f Move::*place, const Triangle& t) const {
        for (int i = 0; i < 3; ++i)
            if (const uint32_t m = moveOf_[t[i]]; m != none && flat_.positions[t[i]] != moves_[m].*place) return true;
        return false;
    }

    /// Triangles that meet others wrongly, one of them with a vertex that has moved since this was asked last. Those of
    /// whose vertices none is elsewhere than at first meet no others like that.
    std::vector<uint32_t> crossingTriangles(int threads, const Progress* progress) {
        std::vector<uint32_t> changed;
        std::vector<Box3f> boxes;
        for (const Touched& touched : touched_) {
            const Triangle& t = flat_.triangles[touched.triangle];
            if (!hasMovedFrom(&Move::compared, t)) continue;
            changed.push_back(touched.triangle);
            boxes.push_back(boxOf(flat_.positions, t));
        }
        for (Move& move : moves_) move.compared = flat_.positions[move.vertex];
        std::vector<uint8_t> isChanged(flat_.triangles.size());
        for (const uint32_t t : changed) isChanged[t] = 1;
        const auto isElsewhere = [&](uint32_t t) { return hasMovedFrom(&Move::before, flat_.triangles[t]); };
        const BoxFinder finder(boxes);
        std::mutex mutex;
        std::vector<uint32_t> crossing;
        const size_t steps = (flat_.triangles.size() + trianglesPerStep - 1) / trianglesPerStep;
        parallelFor(steps, threads, progress, [&](size_t step, int) {
            std::vector<uint32_t> found, beside;
            const size_t end = std::min(flat_.triangles.size(), (step + 1) * trianglesPerStep);
            for (size_t t = step * trianglesPerStep; t < end; ++t) {
                finder.find(boxOf(flat_.positions, flat_.triangles[t]), beside);
                for (const uint32_t b : beside) {
                    const uint32_t other = changed[b];
                    if (isChanged[t] && other <= t) continue;  // compared from the other one's side, or the same
                    if (!(isElsewhere(other) || isElsewhere(static_cast<uint32_t>(t)))) continue;
                    if (meetWrongly(flat_.positions, flat_.triangles[t], flat_.triangles[other]))
                        found.insert(found.end(), {static_cast<uint32_t>(t), other});
                }
            }
            if (found.empty()) return;
            const std::lock_guard lock(mutex);
            crossing.insert(crossing.end(), found.begin(), found.end());
        });
        std::sort(crossing.begin(), crossing.end());
        crossing.erase(std::unique(crossing.begin(), crossing.end()), crossing.end());
        return crossing;
    }

    /// Moves the vertices of some triangles back. Whether there were any.
    bool revert(const std::vector<uint32_t>& triangles) {
        bool some = false;
        for (const uint32_t t : triangles)
            for (int i = 0; i < 3; ++i) {
                const uint32_t m = moveOf_[flat_.triangles[t][i]];
                if (m == none || !moves_[m].moved) continue;
                moves_[m].moved = false;
                flat_.positions[moves_[m].vertex] = moves_[m].before;
                some = true;
            }
        return some;
    }

    const Mesh& mesh_;
    FlatMesh& flat_;
    std::vector<Move> moves_;
    PageVector<uint32_t> moveOf_;  ///< by vertex
    std::vector<Touched> touched_;
    std::vector<std::vector<uint64_t>> keysOf_;       ///< by move, ascending
    std::vector<std::vector<uint32_t>> trianglesOf_;  ///< by move
    int round_ = 0;
};

}  // namespace

size_t releaseConfined(const Mesh& mesh, FlatMesh& flat, int threads, const Progress* progress) {
    return Release(mesh, flat).run(threads, progress);
}

}  // namespace sgm::mesh
