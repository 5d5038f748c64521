#include "modeler/mesh/release.h"

#include <algorithm>
#include <array>
#include <optional>
#include <span>

#include "modeler/mesh/edge_flips.h"
#include "modeler/mesh/meeting_point.h"
#include "modeler/mesh/wrong_meetings.h"

namespace sgm::mesh {
namespace {

constexpr float sameDirection = 0.99f;  ///< cosine between the triangles beside an edge that may be flipped
constexpr int mostFlips = 6;            ///< of edges at one vertex
constexpr int mostExchanges = 6;        ///< of a vertex
/// Of the way between two vertices that are exchanged: how far each ends up from its middle.
constexpr float exchangedShare = 0.125f;

class Release {
public:
    Release(const Mesh& mesh, FlatMesh& flat) : mesh_(mesh), flat_(flat), touched_(mesh, flat) {}

    size_t run(int threads, const Progress* progress) {
        findVertices();
        if (moves_.empty()) return 0;
        const size_t confined = moves_.size();
        touched_.find(moveOf_);
        addNeighbours();
        touched_.find(moveOf_);
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
    using Touched = TouchedTriangles::Touched;
    static constexpr uint32_t none = TouchedTriangles::none;

    void findVertices() {
        moveOf_.assign(flat_.positions.size(), none);
        for (const Chunk& chunk : mesh_.chunks)
            for (const ConfinedVertex& confined : chunk.confined) {
                const uint32_t v = chunk.firstVertex + confined.vertex;
                moveOf_[v] = static_cast<uint32_t>(moves_.size());
                moves_.push_back({v, flat_.positions[v], confined.place});
            }
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

    /// The plane of a piece at a vertex.
    struct PieceAt : PlaneAt {
        uint64_t key;  ///< of its triangles, as FlatMesh::keys
        bool isInner;  ///< the point is no vertex of a crease
    };

    /// Vertices that three and more pieces share go to where the pieces' planes meet: what was kept in a face knows two
    /// of them.
    void placeJunctions() {
        std::vector<std::vector<PieceAt>> planes(moves_.size());
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
                    const PieceAt plane{{touched.outward, point.as<double>()}, key, !(touched.creases >> k & 1)};
                    if (known == planes[m].end())
                        known = planes[m].insert(known, plane);
                    else if (plane.isInner && !known->isInner)  // that lies on the surface as it is
                        *known = plane;
                }
            }
        }
        for (size_t m = 0; m < moves_.size(); ++m)
            if (planes[m].size() >= 3)
                moves_[m].place =
                    meetingPoint(std::vector<PlaneAt>(planes[m].begin(), planes[m].end()), moves_[m].place);
    }

    /// Neighbours on a crease that changed places are exchanged, a few times at most; else a vertex goes between its
    /// neighbours on the crease; what still folds over moves back.
    void unfold() {
        for (auto folded = touched_.folded(); !folded.empty(); folded = touched_.folded()) {
            ++round_;
            std::vector<uint32_t> rest;
            for (const uint32_t t : folded) {
                const Triangle corners = flat_.triangles[t];
                bool done = false;
                for (int i = 0; i < 3; ++i) done |= exchange(corners[i], corners[(i + 1) % 3]);
                done = done || flipEdges(t) || flipOpposite(t);
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

    /// The triangle of the same piece beyond the edge from `a` to `b` of `t`; null where it is another one's.
    Touched* beyond(const Touched& t, uint32_t a, uint32_t b) {
        const uint32_t m = moveOf_[a] != none ? moveOf_[a] : moveOf_[b];
        if (m == none) return nullptr;
        for (const uint32_t s : trianglesOf_[m])
            for (int i = 0; i < 3; ++i)
                if (flat_.triangles[s][i] == b && flat_.triangles[s][(i + 1) % 3] == a &&
                    flat_.keys[s] == flat_.keys[t.triangle])
                    return touched_.of(s);
        return nullptr;
    }

    /// Whether two vertices have an edge, one of which may move; true where neither may.
    bool haveEdge(uint32_t v, uint32_t w) const {
        if (moveOf_[v] == none) std::swap(v, w);
        if (moveOf_[v] == none) return true;
        const auto holdsOther = [&](uint32_t t) {
            const Triangle& c = flat_.triangles[t];
            return c.x == w || c.y == w || c.z == w;
        };
        const std::vector<uint32_t>& around = trianglesOf_[moveOf_[v]];
        return std::any_of(around.begin(), around.end(), holdsOther);
    }

    bool isBack(uint32_t v) const { return moveOf_[v] != none && !moves_[moveOf_[v]].moved; }

    void setCorner(uint32_t triangle, int corner, uint32_t vertex) {
        uint32_t& v = flat_.triangles[triangle][corner];
        if (moveOf_[v] != none) std::erase(trianglesOf_[moveOf_[v]], triangle);
        if (moveOf_[vertex] != none) trianglesOf_[moveOf_[vertex]].push_back(triangle);
        v = vertex;
    }

    /// Flips edges at a vertex of a folded triangle, where no triangle folds over then:
    /// a vertex that went to the other side of a corner has others before it. Once a triangle.
    bool flipEdges(uint32_t triangle) {
        const Triangle corners = flat_.triangles[triangle];
        for (int i = 0; i < 3; ++i)
            for (int k = 1; k < 3; ++k) {
                EdgeFlips flips;
                if (flipAround(triangle, corners[i], corners[(i + k) % 3], flips)) return keep(std::move(flips));
                restore(flips);
            }
        return false;
    }

    /// Exchanges the edge of a folded triangle through which its only vertex that moves went, as a corner of three
    /// pieces goes to another cell.
    bool flipOpposite(uint32_t triangle) {
        const Triangle corners = flat_.triangles[triangle];
        const int i = moveOf_[corners[0]] != none ? 0 : moveOf_[corners[1]] != none ? 1 : 2;
        if (moveOf_[corners[i]] == none || isBack(corners[i])) return false;
        const uint32_t v = corners[i], a = corners[(i + 1) % 3], b = corners[(i + 2) % 3];
        if (moveOf_[a] != none || moveOf_[b] != none) return false;
        if (!beyond_) beyond_.emplace(flat_, touched_, moveOf_);
        const uint32_t s = beyond_->triangleWith(b, a);
        if (s == none || flat_.keys[s] != flat_.keys[triangle]) return false;
        if (!touched_.of(s)) touched_.add(s);
        const int from = placeIn(s, b);
        const uint32_t w = flat_.triangles[s][(from + 2) % 3];
        if (flat_.triangles[s][from] != b || flat_.triangles[s][(from + 1) % 3] != a || haveEdge(v, w)) return false;
        Touched &own = *touched_.of(triangle), &other = *touched_.of(s);
        EdgeFlips flips;
        if (dot(own.outward, other.outward) < sameDirection || !flips.add(own, flat_) || !flips.add(other, flat_))
            return false;
        setCorner(triangle, (i + 2) % 3, w), setCorner(s, (from + 1) % 3, v);
        if (!touched_.isFlat(own) && !touched_.isFlat(other)) return keep(std::move(flips));
        restore(flips);
        return false;
    }

    bool keep(EdgeFlips flips) {
        for (const EdgeFlips::Side& side : flips.sides) {
            Touched& touched = *touched_.of(side.triangle);
            touched.hasFlipped = touched.isNew = true;
            touched.before = 0;
        }
        flips_.push_back(std::move(flips));
        return true;
    }

    /// Takes edges of `pivot` to the third corner of a triangle away, one after the other, and gives `end` the other
    /// diagonals, until the triangle faces outward. False where it never does; some edges may be flipped then.
    bool flipAround(uint32_t triangle, uint32_t pivot, uint32_t end, EdgeFlips& flips) {
        for (int step = 0; step < mostFlips; ++step) {
            const int at = placeIn(triangle, pivot), to = placeIn(triangle, end), third = 3 - at - to;
            const uint32_t apex = flat_.triangles[triangle][third];
            Touched& t = *touched_.of(triangle);
            const bool leaves = third == (at + 1) % 3;  // the edge runs from the pivot to the apex
            Touched* const s = leaves ? beyond(t, pivot, apex) : beyond(t, apex, pivot);
            if (!s || dot(t.outward, s->outward) < sameDirection) return false;
            const int own = placeIn(s->triangle, pivot);
            const uint32_t other = flat_.triangles[s->triangle][3 - own - placeIn(s->triangle, apex)];
            if (haveEdge(end, other) || isBack(pivot) || isBack(end) || isBack(apex) || isBack(other)) return false;
            if (!flips.add(t, flat_) || !flips.add(*s, flat_)) return false;
            setCorner(triangle, third, other), setCorner(s->triangle, own, end);
            if (touched_.isFlat(*s)) return false;
            if (!touched_.isFlat(t)) return true;
        }
        return false;
    }

    int placeIn(uint32_t triangle, uint32_t vertex) const {
        const Triangle& c = flat_.triangles[triangle];
        return c.x == vertex ? 0 : c.y == vertex ? 1 : 2;
    }

    void restore(const EdgeFlips& flips) {
        for (const EdgeFlips::Side& side : flips.sides) {
            for (int i = 0; i < 3; ++i)
                if (flat_.triangles[side.triangle][i] != side.corners[i]) setCorner(side.triangle, i, side.corners[i]);
            touched_.of(side.triangle)->before = side.before;
        }
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

    /// Whether a corner of a triangle isn't where it was at first, or when triangles were compared last.
    bool hasMovedFrom(Vec3f Move::*place, const Triangle& t) const {
        for (int i = 0; i < 3; ++i)
            if (const uint32_t m = moveOf_[t[i]]; m != none && flat_.positions[t[i]] != moves_[m].*place) return true;
        return false;
    }

    /// Triangles that meet others wrongly, one of them with a vertex that has moved since this was asked last, or with
    /// another edge. Those that are as at first meet no others like that.
    std::vector<uint32_t> crossingTriangles(int threads, const Progress* progress) {
        std::vector<uint32_t> changed, crossing;
        for (Touched& touched : touched_) {
            if (!touched.isNew && !hasMovedFrom(&Move::compared, flat_.triangles[touched.triangle])) continue;
            changed.push_back(touched.triangle);
            touched.isNew = false;
        }
        for (Move& move : moves_) move.compared = flat_.positions[move.vertex];
        const auto isElsewhere = [&](uint32_t t) {
            const Touched* const touched = touched_.of(t);
            return (touched && touched->hasFlipped) || hasMovedFrom(&Move::before, flat_.triangles[t]);
        };
        for (const auto& pair : findWrongMeetings(flat_.positions, flat_.triangles, changed, threads, progress))
            if (std::any_of(pair.begin(), pair.end(), isElsewhere))
                crossing.insert(crossing.end(), pair.begin(), pair.end());
        std::sort(crossing.begin(), crossing.end());
        crossing.erase(std::unique(crossing.begin(), crossing.end()), crossing.end());
        return crossing;
    }

    /// Moves the vertices of some triangles back, and flips edges between them back. Whether there were any.
    bool revert(const std::vector<uint32_t>& triangles) {
        bool some = false;
        for (const uint32_t t : triangles) some |= revertCorners(flat_.triangles[t]);
        for (bool again = true; again; some |= again) {
            again = false;
            for (EdgeFlips& flips : flips_) {
                const auto isHeld = [&](const EdgeFlips::Side& side) {
                    return !isBack(side.corners.x) && !isBack(side.corners.y) && !isBack(side.corners.z) &&
                           std::find(triangles.begin(), triangles.end(), side.triangle) == triangles.end();
                };
                if (flips.undone || std::all_of(flips.sides.begin(), flips.sides.end(), isHeld)) continue;
                restore(flips);
                for (const EdgeFlips::Side& side : flips.sides) {
                    revertCorners(side.corners);
                    touched_.of(side.triangle)->isNew = true;
                }
                flips.undone = again = true;
            }
        }
        return some;
    }

    bool revertCorners(const Triangle& corners) {
        bool some = false;
        for (int i = 0; i < 3; ++i) {
            const uint32_t m = moveOf_[corners[i]];
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
    TouchedTriangles touched_;
    std::vector<std::vector<uint64_t>> keysOf_;       ///< by move, ascending
    std::vector<std::vector<uint32_t>> trianglesOf_;  ///< by move
    std::vector<EdgeFlips> flips_;
    std::optional<EdgesBeyond> beyond_;  ///< once asked for
    int round_ = 0;
};

}  // namespace

size_t releaseConfined(const Mesh& mesh, FlatMesh& flat, int threads, const Progress* progress) {
    return Release(mesh, flat).run(threads, progress);
}

}  // namespace sgm::mesh
