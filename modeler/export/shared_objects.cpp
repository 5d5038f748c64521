#include "modeler/export/shared_objects.h"

#include <cmath>
#include <unordered_map>

#include "modeler/mesh/components.h"
#include "modeler/mesh/corners.h"

namespace sgm::exporter {
namespace {

using mesh::noIndex;

/// What is known of some whole connected surfaces.
struct Figures {
    size_t surfaces = 0;
    double volume_m3 = 0;
    Box3d bounds;

    void add(const Figures& other) {
        surfaces += other.surfaces;
        volume_m3 += other.volume_m3;
        bounds = hull(bounds, other.bounds);
    }
};

/// Whether one moved by `offset` is the other, to the bounds that shareObjects names.
bool agree(const Figures& a, const Figures& b, Vec3d offset) {
    constexpr double shareOfDiagonal = 0.02, shareOfVolume = 0.01;
    const double slack = shareOfDiagonal * length(a.bounds.size());
    const Vec3d lo = b.bounds.lo - a.bounds.lo - offset, hi = b.bounds.hi - a.bounds.hi - offset;
    for (int i = 0; i < 3; ++i)
        if (std::abs(lo[i]) > slack || std::abs(hi[i]) > slack) return false;
    return std::abs(a.volume_m3 - b.volume_m3) <= shareOfVolume * std::abs(a.volume_m3);
}

/// Which surfaces each node's triangles are of, and with which other nodes it shares them.
class NodeSurfaces {
public:
    NodeSurfaces(const mesh::Mesh& mesh, const ObjectTree& objects) : nodes_(objects.nodes) {
        const std::vector<mesh::Triangle> triangles = mesh::gatherTriangles(mesh);
        const mesh::SurfaceLabels labels = mesh::labelSurfaces(mesh.vertexCount(), [&](auto label) {
            for (const mesh::Triangle& t : triangles) label(t);
        });
        std::vector<Vec3f> positions;
        positions.reserve(mesh.vertexCount());
        for (const mesh::Chunk& c : mesh.chunks)
            positions.insert(positions.end(), c.positions.begin(), c.positions.end());
        reachOfSurface_.resize(labels.count);
        std::vector<Figures> figures(labels.count);
        size_t i = 0;
        for (const mesh::Chunk& c : mesh.chunks)
            for (const OriginId origin : c.origins) {
                const mesh::Triangle& t = triangles[i++];
                const uint32_t surface = labels.of[t.x];
                reachOfSurface_[surface].add(objects.nodeOf(origin));
                Figures& f = figures[surface];
                const Vec3d a = positions[t.x].as<double>(), b = positions[t.y].as<double>(),
                            d = positions[t.z].as<double>();
                f.surfaces = 1;
                f.volume_m3 += dot(a, cross(b, d)) / 6;
                for (const Vec3d& p : {a, b, d}) f.bounds = hull(f.bounds, p);
            }
        addUp(mesh, objects, triangles, labels, figures);
    }

    /// Whether the surfaces of the node and those below it are theirs alone, and there are some.
    bool isFree(uint32_t node) const {
        return figures_[node].surfaces > 0 && reach_[node].first >= node && reach_[node].last < end_[node];
    }
    /// Of all surfaces of a free node and those below it.
    const Figures& figures(uint32_t node) const { return figures_[node]; }
    /// After the last node below it.
    uint32_t end(uint32_t node) const { return end_[node]; }

private:
    struct Reach {
        uint32_t first = noIndex, last = 0;
        void add(uint32_t node) { first = std::min(first, node), last = std::max(last, node); }
    };

    void addUp(const mesh::Mesh& mesh, const ObjectTree& objects, const std::vector<mesh::Triangle>& triangles,
               const mesh::SurfaceLabels& labels, const std::vector<Figures>& figures) {
        reach_.resize(nodes_.size());
        figures_.resize(nodes_.size());
        end_.resize(nodes_.size());
        size_t i = 0;
        for (const mesh::Chunk& c : mesh.chunks)
            for (const OriginId origin : c.origins) {
                const Reach& reach = reachOfSurface_[labels.of[triangles[i++].x]];
                Reach& own = reach_[objects.nodeOf(origin)];
                own.add(reach.first), own.add(reach.last);
            }
        // A surface counts for its first node, which is below every node that it is below of.
        for (size_t s = 0; s < figures.size(); ++s)
            if (reachOfSurface_[s].first != noIndex) figures_[reachOfSurface_[s].first].add(figures[s]);
        for (uint32_t n = static_cast<uint32_t>(nodes_.size()); n-- > 0;) {
            end_[n] = std::max(end_[n], n + 1);
            if (n == 0) break;
            const uint32_t parent = nodes_[n].parent;
            end_[parent] = std::max(end_[parent], end_[n]);
            figures_[parent].add(figures_[n]);
            if (reach_[n].first != noIndex) reach_[parent].add(reach_[n].first), reach_[parent].add(reach_[n].last);
        }
    }

    const std::vector<ObjectNode>& nodes_;
    std::vector<Reach> reachOfSurface_;
    std::vector<Reach> reach_;      ///< by node: of all surfaces that it and those below it have triangles of
    std::vector<Figures> figures_;  ///< by node, with those below it
    std::vector<uint32_t> end_;
};

/// The mesh without the triangles that `isDropped(origin)`, and without vertices that no other triangle has.
template <class IsDropped>
mesh::Mesh reduced(const mesh::Mesh& mesh, IsDropped isDropped) {
    mesh::Mesh out;
    mesh::Chunk& to = out.chunks.emplace_back();
    std::vector<uint32_t> number(mesh.vertexCount(), noIndex);
    std::vector<std::pair<const mesh::Chunk*, uint32_t>> vertices(mesh.vertexCount());
    for (const mesh::Chunk& c : mesh.chunks)
        for (uint32_t v = 0; v < c.positions.size(); ++v) vertices[c.firstVertex + v] = {&c, v};
    for (const mesh::Chunk& c : mesh.chunks) {
        size_t own = 0;  // of the chunk's corner normals
        for (uint32_t i = 0; i < c.triangles.size(); ++i) {
            const bool dropped = isDropped(c.origins[i]);
            for (; own < c.cornerNormals.size() && c.cornerNormals[own].corner < 3 * (i + 1); ++own) {
                const mesh::CornerNormal& n = c.cornerNormals[own];
                const auto first = static_cast<uint32_t>(3 * to.triangles.size());
                if (!dropped) to.cornerNormals.push_back({first + n.corner % 3, n.normal});
            }
            if (dropped) continue;
            mesh::Triangle t = c.inMesh(c.triangles[i]);
            for (int k = 0; k < 3; ++k) {
                uint32_t& v = number[t[k]];
                if (v == noIndex) {
                    const auto [chunk, at] = vertices[t[k]];
                    v = static_cast<uint32_t>(to.positions.size());
                    to.positions.push_back(chunk->positions[at]);
                    to.normals.push_back(chunk->normals[at]);
                }
                t[k] = v;
            }
            to.triangles.push_back(t);
            to.origins.push_back(c.origins[i]);
            if (!c.labels.empty()) to.labels.push_back(c.labels[i]);
        }
    }
    return out;
}

}  // namespace

SharedObjects keepOwnSurfaces(const ObjectTree& objects) {
    SharedObjects own;
    own.origins.resize(objects.nodes.size());
    for (OriginId o = 0; o < objects.ofOrigin.size(); ++o) own.origins[objects.ofOrigin[o]].push_back(o);
    for (uint32_t i = 0; i < objects.nodes.size(); ++i) own.of.push_back(i);
    own.moved.resize(objects.nodes.size());
    return own;
}

SharedObjects shareObjects(const mesh::Mesh& mesh, const ObjectTree& objects) {
    const auto& nodes = objects.nodes;
    SharedObjects shared = keepOwnSurfaces(objects);
    const NodeSurfaces surfaces(mesh, objects);
    const auto matches = [&](uint32_t a, uint32_t b) {
        if (surfaces.end(a) - a != surfaces.end(b) - b) return false;
        for (uint32_t k = 0; k < surfaces.end(a) - a; ++k)
            if (nodes[a + k].symbol != nodes[b + k].symbol ||
                shared.origins[a + k].size() != shared.origins[b + k].size())
                return false;
        return agree(surfaces.figures(a), surfaces.figures(b), nodes[b].centre - nodes[a].centre);
    };
    std::unordered_map<uint64_t, uint32_t> first;  // free node of a likeness
    bool any = false;
    for (uint32_t i = 1; i < nodes.size(); ++i) {
        if (nodes[i].likeness == 0 || !surfaces.isFree(i)) continue;
        const auto [at, fresh] = first.try_emplace(nodes[i].likeness, i);
        if (fresh || !matches(at->second, i)) continue;
        // Below it stand the like of what stands below the other, which may be moved and shared itself.
        for (uint32_t k = 0; k < surfaces.end(i) - i; ++k) {
            shared.of[i + k] = shared.of[at->second + k];
            shared.moved[i + k] = shared.moved[at->second + k];
        }
        shared.moved[i] = nodes[i].centre - nodes[at->second].centre;
        any = true;
        i = surfaces.end(i) - 1;
    }
    if (any) shared.mesh = reduced(mesh, [&](OriginId o) { return shared.isShared(objects.nodeOf(o)); });
    return shared;
}

}  // namespace sgm::exporter
