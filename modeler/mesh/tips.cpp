#include "modeler/mesh/tips.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "modeler/mesh/box_finder.h"
#include "modeler/mesh/fanned_mesh.h"
#include "modeler/mesh/tip_fan.h"
#include "modeler/mesh/tip_mesh.h"
#include "modeler/mesh/wide_vertices.h"

namespace sgm::mesh {
namespace {

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

class Tips {
public:
    Tips(const Mesh& mesh, const eval::Tape& field, double cell_m, int threads, Progress* progress)
        : progress_(progress),
          mesh_(mesh, threads, progress),
          positions_(mesh_.positions()),
          surface_{positions_, mesh_.isConfined(), {}, {}, {}, field, scratch_, cell_m} {}

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
    /// Adds the planes within a few cells to those of vertices beside which too few lie on theirs.
    void addPlanesAround(std::span<WideVertex> vertices) {
        if (vertices.empty()) return;
        std::vector<Box3f> boxes;
        for (const WideVertex& at : vertices)
            boxes.push_back(cubeAround(positions_[at.vertex], around * surface_.cell_m));
        const BoxFinder finder(boxes);
        std::vector<uint32_t> found;
        for (const TipTriangle& t : mesh_.trianglesIn(finder)) {
            finder.find(boxOf(positions_, t.corners), found);
            for (const uint32_t i : found)
                for (size_t k = 0; k < 3; ++k) vertices[i].addPlane(mesh_, t, k);
        }
    }

    /// Vertices beyond which the tangent planes around them meet on the surface.
    void findCandidates() {
        std::vector<WideVertex> wide = findWideVertices(mesh_, progress_), creased;
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
        triangles_ = mesh_.trianglesIn(BoxFinder(boxes));
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

    Progress* const progress_;
    TipScratch scratch_;
    TipMesh mesh_;
    std::span<const Vec3f> positions_;  ///< by vertex of the whole mesh
    TipSurface surface_;
    std::vector<Candidate> candidates_;
    std::vector<TipTriangle> triangles_;          ///< near candidates
    std::vector<uint32_t> around_, firstAround_;  ///< see TipSurface
};

}  // namespace

Result<size_t> completeTips(Mesh& mesh, const eval::Tape& field, float cell_m, int threads, Progress* progress) {
    if (mesh.hasPositionsOnly()) return size_t{0};
    if (progress) progress->begin("tips", 7 * mesh.chunks.size());  // as many passes at most
    const std::vector<TipFan> fans = Tips(mesh, field, static_cast<double>(cell_m), threads, progress).find();
    if (cancelled(progress)) return cancelledError();
    if (!fans.empty()) mesh = withFans(mesh, fans);
    return fans.size();
}

}  // namespace sgm::mesh
