// The nearest triangle of a mesh to a point.
// Enters: a flat mesh. Leaves: nearest points, among the surfaces that the caller accepts. Assumes that the mesh
// outlives the tree.
#pragma once

#include <algorithm>
#include <limits>
#include <numeric>
#include <vector>

#include "modeler/mesh/components.h"
#include "modeler/mesh/flat_mesh.h"

namespace sgm::pipeline {

/// The point of the triangle a b c that is nearest to p (Ericson, "Real-Time Collision Detection", 2005, 5.1.5).
inline Vec3d closestPoint(Vec3d p, Vec3d a, Vec3d b, Vec3d c) {
    const Vec3d ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
    const double d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp),
                 d6 = dot(ac, cp);
    if (d1 <= 0 && d2 <= 0) return a;
    if (d3 >= 0 && d4 <= d3) return b;
    if (d6 >= 0 && d5 <= d6) return c;
    const double va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + ab * (d1 / (d1 - d3));
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + ac * (d2 / (d2 - d6));
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
    const double sum = va + vb + vc;
    return sum > 0 ? a + ab * (vb / sum) + ac * (vc / sum) : a;
}

/// The nearest point found so far.
struct Nearest {
    double squared_m2 = std::numeric_limits<double>::infinity();
    uint32_t triangle = 0;
    Vec3d at;
};

/// A tree of boxes over a mesh's triangles, each of which belongs to a connected surface.
class TriangleTree {
public:
    /// No surface: of a box that holds several.
    static constexpr uint32_t mixed = 0xffffffffu;

    explicit TriangleTree(const mesh::FlatMesh& mesh)
        : mesh_(mesh), order_(mesh.triangles.size()), surfaces_(mesh.triangles.size()) {
        mesh::Components surfaces(mesh.positions.size());
        for (const mesh::Triangle& t : mesh.triangles) surfaces.join(surfaces.join(t.x, t.y), t.z);
        for (uint32_t i = 0; i < surfaces_.size(); ++i) surfaces_[i] = surfaces.find(mesh.triangles[i].x);
        std::iota(order_.begin(), order_.end(), 0u);
        if (!order_.empty()) build(0, static_cast<uint32_t>(order_.size()));
    }

    uint32_t surfaceOf(uint32_t triangle) const { return surfaces_[triangle]; }
    Vec3d corner(uint32_t triangle, int k) const {
        const mesh::Triangle& t = mesh_.triangles[triangle];
        return mesh_.positions[k == 0 ? t.x : k == 1 ? t.y : t.z].as<double>();
    }

    /// Lowers `found` to the triangle nearest to p among those of the surfaces that `accept` takes.
    template <class Accept>
    void nearest(Vec3d p, Accept accept, Nearest& found) const {
        uint32_t stack[96];
        size_t top = 0;
        stack[top++] = 0;
        while (top > 0) {
            const Node& node = nodes_[stack[--top]];
            if (!(away(node.box, p) < found.squared_m2) || (node.surface != mixed && !accept(node.surface))) continue;
            if (node.right == 0) {
                for (uint32_t i = node.begin; i < node.end; ++i) consider(p, order_[i], accept, found);
                continue;
            }
            const uint32_t left = static_cast<uint32_t>(&node - nodes_.data()) + 1;
            const bool leftFirst = away(nodes_[left].box, p) < away(nodes_[node.right].box, p);
            stack[top++] = leftFirst ? node.right : left;
            stack[top++] = leftFirst ? left : node.right;
        }
    }

private:
    struct Node {
        Box3d box;
        uint32_t begin = 0, end = 0;
        uint32_t right = 0;  ///< 0: a leaf; the left child follows its parent
        uint32_t surface = mixed;
    };

    template <class Accept>
    void consider(Vec3d p, uint32_t triangle, Accept accept, Nearest& found) const {
        if (!accept(surfaces_[triangle])) return;
        const Vec3d at = closestPoint(p, corner(triangle, 0), corner(triangle, 1), corner(triangle, 2));
        const double squared = dot(p - at, p - at);
        if (squared < found.squared_m2) found = {squared, triangle, at};
    }

    static double away(const Box3d& box, Vec3d p) {
        double sum = 0;
        for (int i = 0; i < 3; ++i) {
            const double d = std::max({0.0, box.lo[i] - p[i], p[i] - box.hi[i]});
            sum += d * d;
        }
        return sum;
    }

    uint32_t build(uint32_t begin, uint32_t end) {
        constexpr uint32_t leaf = 8;
        const auto id = static_cast<uint32_t>(nodes_.size());
        Node node{{}, begin, end, 0, surfaces_[order_[begin]]};
        for (uint32_t i = begin; i < end; ++i) {
            for (int k = 0; k < 3; ++k) node.box = hull(node.box, corner(order_[i], k));
            if (surfaces_[order_[i]] != node.surface) node.surface = mixed;
        }
        nodes_.push_back(node);
        if (end - begin <= leaf) return id;
        const Vec3d size = node.box.size();
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const auto middle = [&](uint32_t t) { return corner(t, 0)[axis] + corner(t, 1)[axis] + corner(t, 2)[axis]; };
        const uint32_t half = begin + (end - begin) / 2;
        std::nth_element(order_.begin() + begin, order_.begin() + half, order_.begin() + end,
                         [&](uint32_t a, uint32_t b) {
                             const double m = middle(a), n = middle(b);
                             return m != n ? m < n : a < b;
                         });
        build(begin, half);
        const uint32_t right = build(half, end);
        nodes_[id].right = right;
        return id;
    }

    const mesh::FlatMesh& mesh_;
    std::vector<uint32_t> order_, surfaces_;
    std::vector<Node> nodes_;
};

}  // namespace sgm::pipeline
