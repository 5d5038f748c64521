// A patch to be decimated: from the mesh and back.
#include <bit>

#include "modeler/mesh/loaded_patch.h"

namespace sgm::mesh {

uint32_t LoadedPatch::localOf(uint32_t vertex) {
    if (4 * vertices.size() >= 3 * table_.size()) growTable();
    const size_t mask = table_.size() - 1;
    for (size_t at = vertex * 2654435769u & mask;; at = (at + 1) & mask) {
        if (table_[at] == none) {
            table_[at] = static_cast<uint32_t>(vertices.size());
            vertices.push_back({all_.input.mesh.positions[vertex] - origin_, vertex, none, none, 0, 0,
                                PatchVertex::Kind::Inner, false, false, pass_ > 0});
            return table_[at];
        }
        if (vertices[table_[at]].vertex == vertex) return table_[at];
    }
}

void LoadedPatch::growTable() {
    table_.assign(std::max<size_t>(1024, 2 * table_.size()), none);
    const size_t mask = table_.size() - 1;
    for (uint32_t i = 0; i < vertices.size(); ++i) {
        size_t at = vertices[i].vertex * 2654435769u & mask;
        while (table_[at] != none) at = (at + 1) & mask;
        table_[at] = i;
    }
}

void LoadedPatch::load(std::span<const uint32_t> chosen) {
    vertices.clear(), neighbours.clear();
    const size_t room = std::bit_ceil(std::max<size_t>(1024, 2 * chosen.size()));
    if (table_.size() > room) table_.resize(room);
    std::fill(table_.begin(), table_.end(), none);
    origin_ = all_.input.mesh.positions[all_.triangles[chosen[0]].corners.x];

    corners.resize(3 * chosen.size());
    triangles.regions.resize(chosen.size());
    triangles.dead.assign(chosen.size(), false);
    triangles.stamps.assign(chosen.size(), 0);
    scratch_.counts.clear();
    for (uint32_t t = 0; t < chosen.size(); ++t) {
        const SimpleTriangle& triangle = all_.triangles[chosen[t]];
        triangles.regions[t] = triangle.region;
        for (uint32_t i = 0; i < 3; ++i) {
            const uint32_t v = localOf(triangle.corners[static_cast<int>(i)]);
            corners[3 * t + i] = v;
            vertices[v].half = 3 * t + i;
            if (v == scratch_.counts.size()) scratch_.counts.push_back(0);
            ++scratch_.counts[v];
        }
    }
    vertexCount = vertices.size();
    const SurfaceRegions& regions = all_.input.regions;
    for (size_t v = 0; v < vertexCount; ++v) {
        PatchVertex& local = vertices[v];
        local.whole = scratch_.counts[v] == incident_[local.vertex];
        if (SurfaceRegions::isBorder(regions.ofVertex[local.vertex]))
            local.kind = chainPlace(static_cast<uint32_t>(v)) == Chains::none ? PatchVertex::Kind::Node
                                                                              : PatchVertex::Kind::Chain;
    }
    matchHalves();
    loadPoints(chosen);
    loadNeighbours();
}

/// Pairs of half-edges by their lower end.
void LoadedPatch::matchHalves() {
    opposite.assign(corners.size(), none);
    scratch_.begin.assign(vertexCount + 1, 0);
    const auto low = [&](uint32_t half) { return std::min(from(half), to(half)); };
    for (uint32_t h = 0; h < corners.size(); ++h) ++scratch_.begin[low(h) + 1];
    for (size_t v = 1; v < scratch_.begin.size(); ++v) scratch_.begin[v] += scratch_.begin[v - 1];
    scratch_.byLow.resize(corners.size());
    scratch_.next.assign(scratch_.begin.begin(), scratch_.begin.end() - 1);
    for (uint32_t h = 0; h < corners.size(); ++h) {
        const uint32_t v = low(h);
        for (uint32_t i = scratch_.begin[v]; i < scratch_.next[v]; ++i) {
            const uint32_t other = scratch_.byLow[i];
            if (from(other) != to(h) || to(other) != from(h)) continue;
            opposite[h] = other, opposite[other] = h;
            break;
        }
        scratch_.byLow[scratch_.next[v]++] = h;
    }
}

void LoadedPatch::loadPoints(std::span<const uint32_t> chosen) {
    triangles.firstPoint.assign(chosen.size(), none);
    for (size_t t = 0; t < chosen.size(); ++t)
        for (const uint32_t p : all_.pointsOver(chosen[t])) {
            const uint32_t local = localOf(p);
            vertices[local].next = triangles.firstPoint[t];
            triangles.firstPoint[t] = local;
        }
    pointCount = vertices.size();
}

void LoadedPatch::loadNeighbours() {
    for (size_t i = 0; i < pointCount; ++i) {
        const uint32_t vertex = vertices[i].vertex;
        vertices[i].neighbours = static_cast<uint32_t>(neighbours.size());
        for (uint32_t n = all_.neighbours.begin[vertex]; n < all_.neighbours.begin[vertex + 1]; ++n)
            neighbours.push_back(localOf(all_.neighbours.list[n]));
    }
    lastNeighbours = static_cast<uint32_t>(neighbours.size());
}

DecimatedPatch LoadedPatch::store() {
    DecimatedPatch patch;
    for (uint32_t t = 0; t < triangles.dead.size(); ++t) {
        if (triangles.dead[t]) continue;
        const auto vertex = [&](uint32_t corner) { return vertices[corners[3 * t + corner]].vertex; };
        patch.triangles.push_back({{vertex(0), vertex(1), vertex(2)}, triangles.regions[t]});
        for (uint32_t p = triangles.firstPoint[t]; p != none; p = vertices[p].next)
            patch.points.push_back(vertices[p].vertex);
        patch.pointsEnd.push_back(static_cast<uint32_t>(patch.points.size()));
    }
    for (size_t v = 0; v < vertexCount; ++v)
        if (vertices[v].whole && !isSettled(vertices[v].vertex))
            all_.settled[vertices[v].vertex] = static_cast<uint8_t>(pass_ + 1);
    return patch;
}

}  // namespace sgm::mesh
