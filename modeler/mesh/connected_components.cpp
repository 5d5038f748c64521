#include "modeler/mesh/connected_components.h"

#include <algorithm>
#include <cassert>

#include "modeler/mesh/component_parts.h"

namespace sgm::mesh {
namespace {

using namespace detail;

/// Of the greatest solid: where less stands on the ground, it is debris below a model that hangs as a whole, as clouds
/// do.
constexpr double leastSupport = 0.01;

bool isSmaller(const ConnectedComponent& a, const ConnectedComponent& b) { return a.volume_m3 < b.volume_m3; }

void classifySupport(std::vector<ConnectedComponent>& pieces, float slack_m) {
    if (pieces.empty()) return;
    float ground = pieces[0].bounds.lo.y;
    for (const ConnectedComponent& p : pieces) ground = std::min(ground, p.bounds.lo.y);
    double standing_m3 = 0;
    for (ConnectedComponent& p : pieces) {
        p.floats = p.bounds.lo.y > ground + slack_m;
        if (!p.floats) standing_m3 += p.volume_m3;
    }
    const auto greatest = std::max_element(pieces.begin(), pieces.end(), isSmaller);
    if (standing_m3 < leastSupport * greatest->volume_m3) greatest->floats = false;
}

/// Leaves the entries i for which stays(i) says so, `left` of them.
template <class T, class Stays>
void compact(PageVector<T>& list, size_t left, Stays stays) {
    T* const entries = list.data();
    for (size_t i = 0, n = 0; i < list.size(); ++i) {
        entries[n] = entries[i];
        n += stays(i);
    }
    list.resize(left);
}

/// Keeps the entries that stay, under the numbers that renamed(entry) gives them, none where they don't.
template <class Renamed>
void renumber(SeamList& list, Renamed renamed) {
    uint32_t n = 0;
    for (size_t kind = 0; kind < seamKinds; ++kind) {
        const uint32_t from = list.begin[kind], to = list.begin[kind + 1];
        list.begin[kind] = n;
        for (uint32_t i = from; i < to; ++i)
            if (const uint32_t vertex = renamed(i); vertex != none) list.vertices[n++] = vertex;
    }
    list.begin[seamKinds] = n;
    list.vertices.resize(n);
}

/// Drops surfaces that don't stay, chunk by chunk, with vertices that have no triangle.
class Dropper {
public:
    Dropper(Mesh& mesh, const Surfaces& surfaces, const std::vector<bool>& pieceStays)
        : mesh_(mesh), surfaces_(surfaces), owners_(mesh.chunks), partStays_(surfaces.pieceOf.size()) {
        for (size_t part = 0; part < partStays_.size(); ++part) partStays_[part] = pieceStays[surfaces.pieceOf[part]];
    }

    /// Drops what is gone of chunk c. What is left of the borders keeps its order in both chunks; its ghosts are to
    /// be named, and all chunks are to be numbered.
    void drop(size_t c) {
        if (allStays(surfaces_.parts[c])) return;
        const uint32_t left = findCorners(c);
        Chunk& chunk = mesh_.chunks[c];
        const uint32_t own = ownCount(chunk);
        const uint32_t* const corner = corner_.data();
        dropTriangles(chunk);
        const auto stays = [&](size_t v) { return corner[v] != none; };
        if (!chunk.normals.empty()) compact(chunk.normals, left, stays);
        compact(chunk.positions, left, stays);
        renumber(chunk.shared, [&](uint32_t i) { return corner[chunk.shared.vertices[i]]; });
        renumber(chunk.ghosts, [&](uint32_t i) { return corner[own + i]; });
        std::erase_if(chunk.faceted, [&](uint32_t v) { return !stays(v); });
        for (uint32_t& v : chunk.faceted) v = corner[v];
        std::erase_if(chunk.confined, [&](const ConfinedVertex& v) { return !stays(v.vertex); });
        for (ConfinedVertex& v : chunk.confined) v.vertex = corner[v.vertex];
    }

private:
    bool stays(uint32_t part) const { return part != none && partStays_[part] != 0; }
    bool allStays(const Parts& parts) const {
        const auto first = partStays_.begin() + parts.first;
        return std::all_of(first, first + static_cast<ptrdiff_t>(parts.sums.size()),
                           [](uint8_t stays) { return stays != 0; }) &&
               std::find(parts.of.begin(), parts.of.end(), none) == parts.of.end();
    }
    /// What becomes of the corners of chunk c, by place; returns how many vertices of its own are left.
    uint32_t findCorners(size_t c) {
        const Chunk& chunk = mesh_.chunks[c];
        const Parts& parts = surfaces_.parts[c];
        const uint32_t own = ownCount(chunk);
        corner_.resize(placeCount(chunk));
        uint32_t next = 0, ghosts = ghostBit;
        for (uint32_t v = 0; v < own; ++v) {
            const bool left = stays(parts.at(v));
            corner_[v] = left ? next : none;
            next += left;
        }
        for (size_t i = 0; i < chunk.ghosts.vertices.size(); ++i) {
            const bool left = stays(partOfBorrowed(c, i));
            corner_[own + i] = left ? ghosts : none;
            ghosts += left;
        }
        return next;
    }
    /// The part of a ghost: its owner's, where no triangle of the chunk uses it.
    uint32_t partOfBorrowed(size_t c, size_t i) {
        const Chunk& chunk = mesh_.chunks[c];
        const uint32_t part = surfaces_.parts[c].at(chunk.positions.size() + i), vertex = chunk.ghosts.vertices[i];
        if (part != none) return part;
        const size_t owner = owners_.of(vertex);
        return surfaces_.parts[owner].at(vertex - mesh_.chunks[owner].firstVertex);
    }
    void dropTriangles(Chunk& chunk) const {
        const uint32_t own = ownCount(chunk);
        const uint32_t* const corner = corner_.data();
        const bool hasOrigins = !chunk.origins.empty(), hasLabels = !chunk.labels.empty();
        const std::vector<CornerNormal>& hard = chunk.cornerNormals;
        size_t left = 0, leftHard = 0, h = 0;
        for (size_t i = 0; i < chunk.triangles.size(); ++i) {
            const Triangle t = placesOf(chunk.triangles[i], own);
            const bool stays = corner[t.x] != none;
            chunk.triangles[left] = {corner[t.x], corner[t.y], corner[t.z]};
            if (hasOrigins) chunk.origins[left] = chunk.origins[i];
            if (hasLabels) chunk.labels[left] = chunk.labels[i];
            for (; h < hard.size() && hard[h].corner / 3 == i; ++h)
                if (stays)
                    chunk.cornerNormals[leftHard++] = {static_cast<uint32_t>(3 * left) + hard[h].corner % 3,
                                                       hard[h].normal};
            left += stays;
        }
        chunk.triangles.resize(left);
        chunk.cornerNormals.resize(leftHard);
        if (hasOrigins) chunk.origins.resize(left);
        if (hasLabels) chunk.labels.resize(left);
    }

    Mesh& mesh_;
    const Surfaces& surfaces_;
    Owners owners_;
    std::vector<uint8_t> partStays_;
    PageVector<uint32_t> corner_;  ///< of the chunk in work, by place: what a corner becomes, or none
};

/// Drops the surfaces that don't stay, with vertices that have no triangle; the borders between chunks follow.
void keepSurfaces(Mesh& mesh, const Surfaces& surfaces, const std::vector<bool>& pieceStays) {
    Dropper dropper(mesh, surfaces, pieceStays);
    for (size_t c = 0; c < mesh.chunks.size(); ++c) dropper.drop(c);
    [[maybe_unused]] const Status numbered = Numbering{}.add(mesh.chunks);
    assert(numbered);  // there are fewer than before
    for (Chunk& chunk : mesh.chunks) numberGhosts(mesh.chunks, chunk);
    std::erase_if(mesh.chunks, [](const Chunk& c) { return c.positions.empty() && c.triangles.empty(); });
}

}  // namespace

std::vector<ConnectedComponent> connectedComponents(const Mesh& mesh, float slack_m, int threads) {
    Surfaces surfaces = surfacesOf(mesh, threads);
    findOwners(mesh, surfaces);
    std::vector<ConnectedComponent> found = std::move(surfaces.pieces);
    std::erase_if(found, [](const ConnectedComponent& p) { return p.volume_m3 <= 0; });
    classifySupport(found, slack_m);
    return found;
}

std::vector<bool> selectKept(std::vector<ConnectedComponent> solids, Keep keep, float slack_m) {
    std::vector<bool> stays(solids.size(), keep == Keep::All);
    if (keep == Keep::All || solids.empty()) return stays;
    classifySupport(solids, slack_m);
    const auto greatest = std::max_element(solids.begin(), solids.end(), isSmaller);
    for (size_t i = 0; i < solids.size(); ++i)
        stays[i] = keep == Keep::Grounded && !solids[i].floats && solids[i].volume_m3 >= 1e-3 * greatest->volume_m3;
    if (std::find(stays.begin(), stays.end(), true) == stays.end())
        stays[static_cast<size_t>(greatest - solids.begin())] = true;
    return stays;
}

Dropped keepOnly(Mesh& mesh, Keep keep, float slack_m, int threads) {
    Dropped dropped;
    if (keep == Keep::All || mesh.triangleCount() == 0) return dropped;
    const Surfaces surfaces = surfacesOf(mesh, threads);
    std::vector<ConnectedComponent> solids;
    std::vector<size_t> solidOf(surfaces.pieces.size(), surfaces.pieces.size());
    for (size_t i = 0; i < surfaces.pieces.size(); ++i)
        if (surfaces.pieces[i].volume_m3 > 0) {
            solidOf[i] = solids.size();
            solids.push_back(surfaces.pieces[i]);
        }
    const std::vector<bool> solidStays = selectKept(solids, keep, slack_m);
    std::vector<bool> pieceStays(surfaces.pieces.size(), false);
    for (size_t i = 0; i < surfaces.pieces.size(); ++i) {
        if (solidOf[i] == surfaces.pieces.size()) {
            ++dropped.cavities;
            dropped.filled_m3 -= surfaces.pieces[i].volume_m3;
        } else if (solidStays[solidOf[i]]) {
            pieceStays[i] = true;
        } else {
            ++dropped.pieces;
            dropped.volume_m3 += surfaces.pieces[i].volume_m3;
        }
    }
    if (dropped.pieces + dropped.cavities > 0) keepSurfaces(mesh, surfaces, pieceStays);
    return dropped;
}

}  // namespace sgm::mesh
