// A patch to be decimated: from the mesh and back.
#include <bit>

#include "modeler/mesh/decimate_job.h"

namespace sgm::mesh {

uint32_t DecimationJob::localOf(uint32_t vertex) {
    if (4 * locals_.size() >= 3 * table_.size()) growTable();
    const size_t mask = table_.size() - 1;
    for (size_t at = vertex * 2654435769u & mask;; at = (at + 1) & mask) {
        if (table_[at] == none) {
            table_[at] = static_cast<uint32_t>(locals_.size());
            locals_.push_back({all_.input.mesh.positions[vertex] - origin_, vertex, none, none, 0, 0, Kind::Inner,
                               false, false, pass_ > 0});
            return table_[at];
        }
        if (locals_[table_[at]].vertex == vertex) return table_[at];
    }
}

void DecimationJob::growTable() {
    table_.assign(std::max<size_t>(1024, 2 * table_.size()), none);
    const size_t mask = table_.size() - 1;
    for (uint32_t i = 0; i < locals_.size(); ++i) {
        size_t at = locals_[i].vertex * 2654435769u & mask;
        while (table_[at] != none) at = (at + 1) & mask;
        table_[at] = i;
    }
}

void DecimationJob::load(std::span<const uint32_t> triangles) {
    locals_.clear(), neighbours_.clear(), unlinked_.clear();
    const size_t room = std::bit_ceil(std::max<size_t>(1024, 2 * triangles.size()));
    if (table_.size() > room) table_.resize(room);
    std::fill(table_.begin(), table_.end(), none);
    origin_ = all_.input.mesh.positions[all_.triangles[triangles[0]].corners.x];
    stamp_ = 0;

    corners_.resize(3 * triangles.size());
    regions_.resize(triangles.size());
    dead_.assign(triangles.size(), false);
    triangleStamps_.assign(triangles.size(), 0);
    counts_.clear();
    for (uint32_t t = 0; t < triangles.size(); ++t) {
        const SimpleTriangle& triangle = all_.triangles[triangles[t]];
        regions_[t] = triangle.region;
        for (uint32_t i = 0; i < 3; ++i) {
            const uint32_t v = localOf(triangle.corners[static_cast<int>(i)]);
            corners_[3 * t + i] = v;
            locals_[v].half = 3 * t + i;
            if (v == counts_.size()) counts_.push_back(0);
            ++counts_[v];
        }
    }
    vertexCount_ = locals_.size();
    const SurfaceRegions& regions = all_.input.regions;
    for (size_t v = 0; v < vertexCount_; ++v) {
        Local& local = locals_[v];
        local.whole = counts_[v] == incident_[local.vertex];
        if (SurfaceRegions::isBorder(regions.ofVertex[local.vertex]))
            local.kind = chainPlace(static_cast<uint32_t>(v)) == Chains::none ? Kind::Node : Kind::Chain;
    }
    matchHalves();
    loadPoints(triangles);
    loadNeighbours();
}

/// Pairs of half-edges by their lower end.
void DecimationJob::matchHalves() {
    opposite_.assign(corners_.size(), none);
    begin_.assign(vertexCount_ + 1, 0);
    const auto low = [&](uint32_t half) { return std::min(from(half), to(half)); };
    for (uint32_t h = 0; h < corners_.size(); ++h) ++begin_[low(h) + 1];
    for (size_t v = 1; v < begin_.size(); ++v) begin_[v] += begin_[v - 1];
    byLow_.resize(corners_.size());
    next_.assign(begin_.begin(), begin_.end() - 1);
    for (uint32_t h = 0; h < corners_.size(); ++h) {
        const uint32_t v = low(h);
        for (uint32_t i = begin_[v]; i < next_[v]; ++i) {
            const uint32_t other = byLow_[i];
            if (from(other) != to(h) || to(other) != from(h)) continue;
            opposite_[h] = other, opposite_[other] = h;
            break;
        }
        byLow_[next_[v]++] = h;
    }
}

void DecimationJob::loadPoints(std::span<const uint32_t> triangles) {
    firstPoint_.assign(triangles.size(), none);
    for (size_t t = 0; t < triangles.size(); ++t)
        for (const uint32_t p : all_.pointsOver(triangles[t])) {
            const uint32_t local = localOf(p);
            locals_[local].next = firstPoint_[t];
            firstPoint_[t] = local;
        }
    pointCount_ = locals_.size();
}

void DecimationJob::loadNeighbours() {
    for (size_t i = 0; i < pointCount_; ++i) {
        const uint32_t vertex = locals_[i].vertex;
        locals_[i].neighbours = static_cast<uint32_t>(neighbours_.size());
        for (uint32_t n = all_.neighboursBegin[vertex]; n < all_.neighboursBegin[vertex + 1]; ++n)
            neighbours_.push_back(localOf(all_.neighbours[n]));
    }
    lastNeighbours_ = static_cast<uint32_t>(neighbours_.size());
}

DecimatedPatch DecimationJob::store() {
    DecimatedPatch patch;
    for (uint32_t t = 0; t < dead_.size(); ++t) {
        if (dead_[t]) continue;
        const auto vertex = [&](uint32_t corner) { return locals_[corners_[3 * t + corner]].vertex; };
        patch.triangles.push_back({{vertex(0), vertex(1), vertex(2)}, regions_[t]});
        for (uint32_t p = firstPoint_[t]; p != none; p = locals_[p].next) patch.points.push_back(locals_[p].vertex);
        patch.pointsEnd.push_back(static_cast<uint32_t>(patch.points.size()));
    }
    patch.unlinked = unlinked_;
    for (size_t v = 0; v < vertexCount_; ++v)
        if (locals_[v].whole && !isSettled(locals_[v].vertex))
            all_.settled[locals_[v].vertex] = static_cast<uint8_t>(pass_ + 1);
    return patch;
}

}  // namespace sgm::mesh
