#include "modeler/mesh/edge_splits.h"

#include <algorithm>
#include <numeric>

#include "modeler/mesh/one_chunk.h"
#include "modeler/mesh/wrong_meetings.h"

namespace sgm::mesh {
namespace {

constexpr uint32_t noSplit = 0xffffffffu;
constexpr double leastFacing = 0.7;  ///< cosine between a triangle that comes and the normals at its corners
constexpr std::array unsplit{noSplit, noSplit, noSplit};

Vec3d directionOf(std::span<const Vec3f> positions, const Triangle& t) {
    const Vec3d p = positions[t.x].as<double>();
    return cross(positions[t.y].as<double>() - p, positions[t.z].as<double>() - p);
}

/// The least cosine between a triangle's direction and the normals at its corners.
double facingOf(Vec3d direction, const std::array<Vec3f, 3>& normals) {
    const Vec3d face = normalized(direction);
    return std::min(
        {dot(face, normals[0].as<double>()), dot(face, normals[1].as<double>()), dot(face, normals[2].as<double>())});
}

}  // namespace

EdgeSplitter::EdgeSplitter(Chunk chunk, int threads, Progress* progress)
    : chunk_(std::move(chunk)), threads_(threads), progress_(progress) {
    listNormals();
    changed_.resize(chunk_.triangles.size());
    std::iota(changed_.begin(), changed_.end(), 0u);
}

void EdgeSplitter::listNormals() {
    normals_.clear();
    visitTriangles(chunk_, [&](uint32_t t, std::span<const CornerNormal> own) {
        const Triangle& c = chunk_.triangles[t];
        normals_.push_back({chunk_.normals[c.x], chunk_.normals[c.y], chunk_.normals[c.z]});
        for (const CornerNormal& n : own) normals_.back()[n.corner % 3] = n.normal;
    });
}

size_t EdgeSplitter::split(std::span<const EdgeSplit> splits) {
    const auto firstVertex = static_cast<uint32_t>(chunk_.positions.size());
    for (const EdgeSplit& s : splits) chunk_.positions.push_back(s.at), chunk_.normals.push_back(s.normals[0]);
    isLeftOut_.assign(splits.size(), false);
    for (;;) {
        const std::vector<Part> parts = partsOf(splits, firstVertex);
        const bool again = leaveOutFaulty(parts);
        if (cancelled(progress_)) return 0;
        if (again) continue;
        replaceTriangles(parts);
        return static_cast<size_t>(std::count(isLeftOut_.begin(), isLeftOut_.end(), false));
    }
}

Chunk EdgeSplitter::take() {
    dropUnusedVertices(chunk_);
    return std::move(chunk_);
}

/// What the triangles beside split edges become. The i-th split's vertex is `firstVertex` + i.
std::vector<EdgeSplitter::Part> EdgeSplitter::partsOf(std::span<const EdgeSplit> splits, uint32_t firstVertex) {
    splitsOf_.assign(chunk_.triangles.size(), unsplit);
    for (uint32_t i = 0; i < splits.size(); ++i) {
        if (isLeftOut_[i]) continue;
        for (const uint32_t edge : splits[i].halfEdges) splitsOf_[edge / 3][edge % 3] = i;
    }
    std::vector<Part> parts;
    for (uint32_t t = 0; t < chunk_.triangles.size(); ++t) {
        if (splitsOf_[t] == unsplit) continue;
        std::array<Corner, 6> corners{};  // the triangle's own, then those on its edges
        for (size_t k = 0; k < 3; ++k) {
            corners[k] = {chunk_.triangles[t][static_cast<int>(k)], normals_[t][k]};
            const uint32_t i = splitsOf_[t][k];
            if (i != noSplit)
                corners[3 + k] = {firstVertex + i, splits[i].normals[splits[i].halfEdges[0] / 3 == t ? 0 : 1]};
        }
        addParts(t, corners, parts);
    }
    return parts;
}

void EdgeSplitter::addParts(uint32_t t, const std::array<Corner, 6>& corners, std::vector<Part>& parts) const {
    const auto add = [&](const Corner& a, const Corner& b, const Corner& c) {
        parts.push_back({{a.vertex, b.vertex, c.vertex}, {a.normal, b.normal, c.normal}, t});
    };
    const auto isSplit = [&](size_t k) { return splitsOf_[t][k] != noSplit; };
    const auto distance = [&](const Corner& a, const Corner& b) {
        return length(chunk_.positions[a.vertex] - chunk_.positions[b.vertex]);
    };
    const size_t count = size_t{isSplit(0)} + size_t{isSplit(1)} + size_t{isSplit(2)};
    if (count == 3) {
        for (size_t k = 0; k < 3; ++k) add(corners[k], corners[3 + k], corners[3 + (k + 2) % 3]);
        add(corners[3], corners[4], corners[5]);
        return;
    }
    // Turned so that the first edge is split, and of two the next one as well.
    size_t k = 0;
    while (!isSplit(k) || (count == 2 && !isSplit((k + 1) % 3))) ++k;
    const Corner &a = corners[k], &b = corners[(k + 1) % 3], &c = corners[(k + 2) % 3], &ab = corners[3 + k];
    if (count == 1) {
        add(a, ab, c), add(ab, b, c);
        return;
    }
    const Corner& bc = corners[3 + (k + 1) % 3];
    add(ab, b, bc);
    if (distance(a, bc) < distance(ab, c))
        add(a, ab, bc), add(a, bc, c);
    else
        add(a, ab, c), add(ab, bc, c);
}

/// Leaves out splits whose parts are at fault; false where there are none.
bool EdgeSplitter::leaveOutFaulty(std::span<const Part> parts) {
    std::vector<Triangle> all;
    std::vector<uint32_t> from, changed, faulty;
    for (uint32_t t = 0; t < chunk_.triangles.size(); ++t)
        if (splitsOf_[t] == unsplit) all.push_back(chunk_.triangles[t]), from.push_back(t);
    for (const Part& part : parts) {
        if (isFolded(part)) faulty.push_back(part.from);
        changed.push_back(static_cast<uint32_t>(all.size()));
        all.push_back(part.corners), from.push_back(part.from);
    }
    for (const auto& pair : findWrongMeetings(chunk_.positions, all, changed, threads_, progress_))
        for (const uint32_t t : pair) faulty.push_back(from[t]);
    bool leavesOut = false;
    for (const uint32_t t : faulty)
        for (const uint32_t i : splitsOf_[t])
            if (i != noSplit && !isLeftOut_[i]) isLeftOut_[i] = true, leavesOut = true;
    return leavesOut;
}

bool EdgeSplitter::isFolded(const Part& part) const {
    const Vec3d own = directionOf(chunk_.positions, part.corners),
                before = directionOf(chunk_.positions, chunk_.triangles[part.from]);
    if (!(dot(own, before) > 0)) return true;
    const double least = std::min(leastFacing, facingOf(before, normals_[part.from]));
    return facingOf(own, part.normals) < least;
}

/// Puts parts in the place of what they come of.
void EdgeSplitter::replaceTriangles(std::span<const Part> parts) {
    Chunk made;
    std::vector<std::array<Vec3f, 3>> normals;
    changed_.clear();
    const auto add = [&](const Triangle& corners, const std::array<Vec3f, 3>& own, uint32_t from) {
        const auto t = static_cast<uint32_t>(made.triangles.size());
        made.triangles.push_back(corners);
        made.origins.push_back(chunk_.origins[from]);
        made.labels.push_back(chunk_.labels[from]);
        normals.push_back(own);
        for (uint32_t k = 0; k < 3; ++k)
            if (!(own[k] == chunk_.normals[corners[static_cast<int>(k)]]))
                made.cornerNormals.push_back({3 * t + k, own[k]});
    };
    size_t next = 0;
    for (uint32_t t = 0; t < chunk_.triangles.size(); ++t) {
        if (next == parts.size() || parts[next].from != t) add(chunk_.triangles[t], normals_[t], t);
        for (; next < parts.size() && parts[next].from == t; ++next) {
            changed_.push_back(static_cast<uint32_t>(made.triangles.size()));
            add(parts[next].corners, parts[next].normals, t);
        }
    }
    chunk_.triangles = std::move(made.triangles), chunk_.origins = std::move(made.origins);
    chunk_.labels = std::move(made.labels), chunk_.cornerNormals = std::move(made.cornerNormals);
    normals_ = std::move(normals);
}

}  // namespace sgm::mesh
