#include "modeler/mesh/tips.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "modeler/core/parallel.h"
#include "modeler/mesh/box_finder.h"
#include "modeler/mesh/fanned_mesh.h"
#include "modeler/mesh/one_chunk.h"
#include "modeler/mesh/tip_fan.h"

namespace sgm::mesh {
namespace {

constexpr uint32_t none = 0xffffffffu;
constexpr Label noLabel = 0xffffffffu;
/// The mean of the normals around a tip is shorter: as of smooth cones within 45° of their axis, and as of pyramids
/// within 30°, for along edges of 90° it is .7 or more.
constexpr float widestSmooth = 0.85f, widestCreased = 0.7f;
constexpr size_t mostOfPart = 64;     ///< candidates, and as many within a cell: a part with more is a fractal or rough
constexpr size_t mostCreased = 1024;  ///< vertices of a part, by whose creases planes are looked for farther away
constexpr double sameSide = 0.5;      ///< cosine between the ways from an apex to its vertex and to one nearer
constexpr double nearer = 0.25;       ///< of the way from a vertex to its apex: no other vertex is as near to that
// In cells:
constexpr double nearestApex = 0.05, farthestApex = 16;  ///< from the vertex below it
constexpr double nearestCorner = 0.2;                    ///< the same where creases meet
constexpr double coneSlack = 0.002;                      ///< an apex from the planes around it, without creases
constexpr double around = 3;                             ///< where planes are looked for

/// A vertex beyond which the planes around it meet.
struct Candidate {
    uint32_t vertex;
    OriginId origin;  ///< of a triangle at the vertex
    Vec3d apex;
};

/// A vertex around which normals differ a lot, or a corner that was kept in its cell.
struct WideVertex {
    uint32_t vertex;
    TangentPlanes planes;      ///< of vertices beside it that lie on them, relative to it
    TangentPlanes directions;  ///< of all, as if through it
    OriginId origin;           ///< of one of its triangles
    Label label;               ///< of one of its triangles
    bool isCorner = false;     ///< its triangles have more than two labels
    bool hasCreases = false;   ///< its triangles have several labels
    Label second = noLabel;    ///< another label of its triangles
};

class Tips {
public:
    Tips(const Mesh& mesh, const eval::Tape& field, double cell_m, int threads, Progress* progress)
        : mesh_(mesh), threads_(threads), progress_(progress), surface_{{}, isConfined_, {},       {},
                                                                        {}, field,       scratch_, cell_m} {
        size_t vertices = 0;
        uint32_t triangles = 0;
        for (const Chunk& c : mesh_.chunks) {
            firstTriangle_.push_back(triangles);
            vertices += c.positions.size(), triangles += static_cast<uint32_t>(c.triangles.size());
        }
        if (progress_) progress_->begin("tips", 5 * mesh_.chunks.size());  // as many passes at most
        positions_.resize(vertices), normals_.resize(vertices), isConfined_.resize(vertices);
        inChunks([&](size_t c) {
            const Chunk& chunk = mesh_.chunks[c];
            std::copy(chunk.positions.begin(), chunk.positions.end(), positions_.begin() + chunk.firstVertex);
            std::copy(chunk.normals.begin(), chunk.normals.end(), normals_.begin() + chunk.firstVertex);
        });
        for (const Chunk& c : mesh_.chunks)
            for (const ConfinedVertex& v : c.confined) isConfined_[c.firstVertex + v.vertex] = true;
        surface_.positions = positions_;
    }

    /// What completes tips. After cancelling some of it, or none.
    std::vector<TipFan> find() {
        if (!cancelled(progress_)) findCandidates();
        if (candidates_.empty()) return {};
        listTriangles(nearestCut);
        keep(candidates_, [&](size_t i) { return mayBeTip(surface_, candidates_[i].vertex, candidates_[i].apex); });
        if (candidates_.empty()) return {};
        listTriangles(farthestCut);
        std::vector<TipFan> fans;
        std::vector<bool> isTaken(positions_.size());
        for (const Candidate& at : candidates_) {
            if (cancelled(progress_)) return {};
            if (isTaken[at.vertex]) continue;
            auto fan = fanAt(surface_, at.vertex, at.apex);
            if (!fan) continue;
            const std::vector<uint32_t> vertices = verticesOf(*fan);
            if (std::any_of(vertices.begin(), vertices.end(), [&](uint32_t v) { return isTaken[v]; })) continue;
            for (const uint32_t v : vertices) isTaken[v] = true;
            fans.push_back(std::move(*fan));
        }
        dropCrossing(surface_, fans, progress_);
        for (TipFan& fan : fans)
            for (uint32_t& t : fan.removed) t = triangles_[t].number;
        return fans;
    }

private:
    /// Calls `work` with the number of every chunk.
    template <class Work>
    void inChunks(Work&& work) const {
        parallelFor(mesh_.chunks.size(), threads_, progress_, [&](size_t c, int) {
            work(c);
            tick(progress_);
        });
    }

    TipTriangle triangleAt(size_t c, uint32_t t) const {
        const Chunk& chunk = mesh_.chunks[c];
        const Triangle corners = chunk.inMesh(chunk.triangles[t]);
        TipTriangle at{corners,
                       {normals_[corners.x], normals_[corners.y], normals_[corners.z]},
                       firstTriangle_[c] + t,
                       chunk.origins[t],
                       chunk.labels.empty() ? 0 : chunk.labels[t],
                       0};
        for (const CornerNormal& n : cornerNormalsOf(chunk, t)) {
            at.normals[n.corner % 3] = n.normal;
            at.ownNormals |= static_cast<uint8_t>(1u << n.corner % 3);
        }
        return at;
    }

    /// The triangles of all chunks that listIn(chunk, numbers) lists, in their order.
    template <class ListIn>
    std::vector<TipTriangle> trianglesOf(ListIn&& listIn) const {
        std::vector<std::vector<TipTriangle>> found(mesh_.chunks.size());
        inChunks([&](size_t c) {
            std::vector<uint32_t> numbers;
            listIn(mesh_.chunks[c], numbers);
            for (const uint32_t t : numbers) found[c].push_back(triangleAt(c, t));
        });
        std::vector<TipTriangle> all;
        for (const auto& list : found) all.insert(all.end(), list.begin(), list.end());
        return all;
    }
    std::vector<TipTriangle> trianglesIn(const BoxFinder& finder) const {
        return trianglesOf([&](const Chunk& chunk, std::vector<uint32_t>& numbers) {
            finder.visitMeeting(
                positions_, 0, chunk.triangles.size(), [&](size_t t) { return chunk.inMesh(chunk.triangles[t]); },
                [&](size_t t, std::span<const uint32_t>) { numbers.push_back(static_cast<uint32_t>(t)); });
        });
    }

    /// Of all normals at the triangles around a vertex.
    struct Sum {
        Vec3f normals;
        float count = 0;
        bool isCreased = false;

        void add(Vec3f ofTriangle, bool hasOwnNormals) {
            normals += ofTriangle, count += 3;
            isCreased |= hasOwnNormals;
        }
        bool isWide() const {
            const float most = (isCreased ? widestCreased : widestSmooth) * count;
            return dot(normals, normals) < most * most;
        }
    };

    PageVector<Sum> sumsOfNormals() const {
        PageVector<Sum> sums;
        sums.resize(positions_.size());
        struct Addend {
            uint32_t vertex;
            Vec3f ofTriangle;
            bool hasOwnNormals;
        };
        std::vector<std::vector<Addend>> borrowed(mesh_.chunks.size());  // at vertices that other chunks own
        inChunks([&](size_t c) {
            const Chunk& chunk = mesh_.chunks[c];
            std::fill_n(sums.data() + chunk.firstVertex, chunk.positions.size(), Sum{});
            visitTriangles(chunk, [&](uint32_t t, std::span<const CornerNormal> own) {
                const Triangle& corners = chunk.triangles[t];
                std::array<Vec3f, 3> normals;
                for (size_t k = 0; k < 3; ++k) normals[k] = normals_[chunk.inMesh(corners[static_cast<int>(k)])];
                for (const CornerNormal& n : own) normals[n.corner % 3] = n.normal;
                const Vec3f sum = normals[0] + normals[1] + normals[2];
                for (int k = 0; k < 3; ++k) {
                    const uint32_t v = chunk.inMesh(corners[k]);
                    if (corners[k] & ghostBit)
                        borrowed[c].push_back({v, sum, !own.empty()});
                    else
                        sums[v].add(sum, !own.empty());
                }
            });
        });
        if (cancelled(progress_)) return {};
        for (const auto& list : borrowed)  // in the chunks' order
            for (const Addend& a : list) sums[a.vertex].add(a.ofTriangle, a.hasOwnNormals);
        return sums;
    }

    std::vector<WideVertex> findWideVertices() const {
        const PageVector<Sum> sums = sumsOfNormals();
        std::vector<WideVertex> wide;
        std::vector<uint32_t> place(positions_.size(), none);
        for (uint32_t v = 0; v < sums.size(); ++v) {
            if (!sums[v].isWide() && !(isConfined_[v] && sums[v].isCreased)) continue;
            place[v] = static_cast<uint32_t>(wide.size());
            wide.push_back({v, {}, {}, 0, noLabel});
        }
        if (wide.empty()) return wide;
        const auto listWide = [&](const Chunk& chunk, std::vector<uint32_t>& numbers) {
            for (uint32_t t = 0; t < chunk.triangles.size(); ++t) {
                const Triangle c = chunk.inMesh(chunk.triangles[t]);
                if (std::min({place[c.x], place[c.y], place[c.z]}) != none) numbers.push_back(t);
            }
        };
        for (const TipTriangle& t : trianglesOf(listWide))
            for (int k = 0; k < 3; ++k) {
                if (place[t.corners[k]] == none) continue;
                WideVertex& at = wide[place[t.corners[k]]];
                if (at.label == noLabel) at.label = t.label;
                if (at.label != t.label) {
                    at.isCorner |= at.second != noLabel && at.second != t.label;
                    if (at.second == noLabel) at.second = t.label;
                    at.hasCreases = true;
                }
                at.origin = t.origin;
                for (size_t i = 0; i < 3; ++i) {
                    at.directions.add(t.normals[i].as<double>(), {});
                    if (static_cast<int>(i) != k) addPlane(t, i, at);
                }
            }
        std::erase_if(wide, [&](const WideVertex& at) { return !sums[at.vertex].isWide() && !at.isCorner; });
        return wide;
    }

    /// Adds the tangent plane at a corner, unless its vertex is confined.
    void addPlane(const TipTriangle& t, size_t corner, WideVertex& at) const {
        const uint32_t v = t.corners[static_cast<int>(corner)];
        if (!isConfined_[v])
            at.planes.add(t.normals[corner].as<double>(), (positions_[v] - positions_[at.vertex]).as<double>());
    }

    /// Adds the planes within a few cells to those of vertices beside which too few lie on theirs.
    void addPlanesAround(std::span<WideVertex> vertices) const {
        if (vertices.empty()) return;
        std::vector<Box3f> boxes;
        for (const WideVertex& at : vertices)
            boxes.push_back(cubeAround(positions_[at.vertex], around * surface_.cell_m));
        const BoxFinder finder(boxes);
        std::vector<uint32_t> found;
        for (const TipTriangle& t : trianglesIn(finder)) {
            finder.find(boxOf(positions_, t.corners), found);
            for (const uint32_t i : found)
                for (size_t k = 0; k < 3; ++k) addPlane(t, k, vertices[i]);
        }
    }

    /// Vertices beyond which the tangent planes around them meet on the surface.
    void findCandidates() {
        std::vector<WideVertex> wide = findWideVertices(), creased;
        for (const WideVertex& at : wide)
            if (!at.planes.meeting() && at.directions.meeting()) creased.push_back(at);
        for (const Candidate& c : candidatesOf(wide)) {
            const auto at = std::lower_bound(wide.begin(), wide.end(), c.vertex,
                                             [](const WideVertex& w, uint32_t vertex) { return w.vertex < vertex; });
            if (at->hasCreases)
                creased.push_back(*at);
            else
                candidates_.push_back(c);
        }
        std::map<OriginId, size_t> counts;
        for (const WideVertex& at : creased) ++counts[at.origin];
        std::erase_if(creased, [&](const WideVertex& at) { return counts[at.origin] > mostCreased; });
        addPlanesAround(creased);
        for (const Candidate& c : candidatesOf(creased)) candidates_.push_back(c);
        keep(candidates_, [isReached = reachedApexes()](size_t i) { return !isReached[i]; });
        keepNearest();
    }

    /// Of the candidates with one apex, the two nearest to it.
    void keepNearest() {
        std::sort(candidates_.begin(), candidates_.end(), [&](const Candidate& a, const Candidate& b) {
            return std::pair(wayOf(a), a.vertex) < std::pair(wayOf(b), b.vertex);
        });
        size_t kept = 0;
        for (const Candidate& c : candidates_) {
            const auto end = candidates_.begin() + static_cast<ptrdiff_t>(kept);
            const auto hasItsApex = [&](const Candidate& k) {
                return length(k.apex - c.apex) < apexSlack * surface_.cell_m;
            };
            if (std::count_if(candidates_.begin(), end, hasItsApex) < 2) candidates_[kept++] = c;
        }
        candidates_.resize(kept);
    }

    /// The candidates among some vertices.
    std::vector<Candidate> candidatesOf(std::span<const WideVertex> vertices) {
        std::vector<Candidate> found;
        std::vector<Vec3f> apexes;
        std::map<std::pair<OriginId, bool>, size_t> counts;
        const double cell = surface_.cell_m;
        const auto countOf = [&](const Candidate& c) -> size_t& { return counts[{c.origin, wayOf(c) < cell}]; };
        for (const WideVertex& at : vertices) {
            const auto meeting = at.planes.meeting();
            const auto [slack, nearest] =
                at.hasCreases ? std::pair(apexSlack, nearestCorner) : std::pair(coneSlack, nearestApex);
            if (!meeting || meeting->error > slack * cell) continue;
            const double way = length(meeting->point);
            if (!(way > nearest * cell && way < farthestApex * cell)) continue;
            found.push_back({at.vertex, at.origin, positions_[at.vertex].as<double>() + meeting->point});
            apexes.push_back(found.back().apex.as<float>());
            ++countOf(found.back());
        }
        const std::vector<float> values = valuesAt(surface_, apexes);
        keep(found,
             [&](size_t i) { return countOf(found[i]) <= mostOfPart && std::abs(values[i]) < apexSlack * cell; });
        return found;
    }

    template <class Keep>
    static void keep(std::vector<Candidate>& candidates, Keep&& stays) {
        size_t kept = 0;
        for (size_t i = 0; i < candidates.size(); ++i)
            if (stays(i)) candidates[kept++] = candidates[i];
        candidates.resize(kept);
    }

    double wayOf(const Candidate& c) const { return length(c.apex - positions_[c.vertex].as<double>()); }

    /// By candidate: whether the mesh has vertices nearer to its apex, on its side of that, so that nothing is missing
    /// there. What stands on the tip, as a ball on a spire, lies beyond.
    std::vector<bool> reachedApexes() const {
        std::vector<bool> isReached(candidates_.size());
        if (candidates_.empty()) return isReached;
        std::vector<Box3f> boxes;
        for (const Candidate& c : candidates_) boxes.push_back(cubeAround(c.apex.as<float>(), nearer * wayOf(c)));
        const BoxFinder finder(boxes);
        std::vector<uint32_t> found;
        for (const Vec3f& p : positions_) {
            finder.find({p, p}, found);
            for (const uint32_t i : found) {
                const Vec3d own = positions_[candidates_[i].vertex].as<double>() - candidates_[i].apex,
                            way = p.as<double>() - candidates_[i].apex;
                if (dot(own, way) > sameSide * length(own) * length(way)) isReached[i] = true;
            }
        }
        return isReached;
    }

    /// The triangles near candidates, as far as what is cut off so deep may reach, and those around each vertex.
    void listTriangles(double cut) {
        std::vector<Box3f> boxes;
        for (const Candidate& c : candidates_)
            boxes.push_back(cubeAround(c.apex.as<float>(), cut * wayOf(c) + 2 * surface_.cell_m));
        triangles_ = trianglesIn(BoxFinder(boxes));
        firstAround_.assign(positions_.size() + 1, 0);
        for (const TipTriangle& t : triangles_)
            for (int k = 0; k < 3; ++k) ++firstAround_[t.corners[k]];
        uint32_t end = 0;
        for (uint32_t& first : firstAround_) first = end += first;  // each one's end; it sinks to its first below
        around_.resize(end);
        for (uint32_t t = 0; t < triangles_.size(); ++t)
            for (int k = 0; k < 3; ++k) around_[--firstAround_[triangles_[t].corners[k]]] = t;
        surface_.triangles = triangles_, surface_.around = around_, surface_.firstAround = firstAround_;
    }

    /// All vertices of what a fan replaces.
    std::vector<uint32_t> verticesOf(const TipFan& fan) const {
        std::vector<uint32_t> vertices;
        for (const uint32_t t : fan.removed) {
            const Triangle& corners = triangles_[t].corners;
            vertices.insert(vertices.end(), {corners.x, corners.y, corners.z});
        }
        return vertices;
    }

    const Mesh& mesh_;
    const int threads_;
    Progress* const progress_;
    TipScratch scratch_;
    std::vector<uint32_t> firstTriangle_;    ///< by chunk
    PageVector<Vec3f> positions_, normals_;  ///< by vertex of the whole mesh
    std::vector<bool> isConfined_;           ///< by vertex
    TipSurface surface_;
    std::vector<Candidate> candidates_;
    std::vector<TipTriangle> triangles_;          ///< near candidates
    std::vector<uint32_t> around_, firstAround_;  ///< see TipSurface
};

}  // namespace

Result<size_t> completeTips(Mesh& mesh, const eval::Tape& field, float cell_m, int threads, Progress* progress) {
    if (mesh.hasPositionsOnly()) return size_t{0};
    const std::vector<TipFan> fans = Tips(mesh, field, static_cast<double>(cell_m), threads, progress).find();
    if (cancelled(progress)) return cancelledError();
    if (!fans.empty()) mesh = withFans(mesh, fans);
    return fans.size();
}

}  // namespace sgm::mesh
