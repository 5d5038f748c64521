// What hangs together: union-find with path halving, and the connected surfaces of a mesh.
// Enters: n things and the pairs that belong together, or triangles. Leaves: the lowest member of each group; the surface of
// each vertex.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

#include "modeler/core/vec.h"

namespace sgm::mesh {

class Components {
public:
    explicit Components(size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0u); }
    /// The lowest member of v's group.
    uint32_t find(uint32_t v) {
        while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
        return v;
    }
    /// The lowest member of the group of both.
    uint32_t join(uint32_t a, uint32_t b) {
        a = find(a), b = find(b);
        return parent_[std::max(a, b)] = std::min(a, b);
    }
    /// One more, alone in its group.
    uint32_t add() {
        parent_.push_back(static_cast<uint32_t>(parent_.size()));
        return parent_.back();
    }
    size_t size() const { return parent_.size(); }

private:
    std::vector<uint32_t> parent_;
};

/// Which connected surface each vertex of a mesh is on.
struct SurfaceLabels {
    static constexpr uint32_t none = 0xffffffffu;  ///< the vertex has no triangle
    std::vector<uint32_t> of;                      ///< by vertex: 0 … count − 1, in the order of the surfaces' first triangles
    std::vector<uint32_t> numbers;                 ///< by the label that a triangle was given: the same
    uint32_t count = 0;
};

/// Labels vertices as pixels are (Rosenfeld and Pfaltz, "Sequential Operations in Digital Picture Processing", 1966): a triangle
/// hands on the label that it finds, and labels that meet are one. There are far fewer labels than vertices.
/// `forTriangles(f)` calls f with every triangle, corners counted in the whole mesh; f returns its label.
template <class ForTriangles>
SurfaceLabels labelSurfaces(size_t vertices, ForTriangles forTriangles) {
    constexpr uint32_t none = SurfaceLabels::none;
    SurfaceLabels found{std::vector<uint32_t>(vertices, none), {}};
    std::vector<uint32_t>& of = found.of;
    Components labels(0);
    forTriangles([&](const Vec3<uint32_t>& t) {
        const uint32_t a = of[t.x], b = of[t.y], c = of[t.z];
        uint32_t label = std::min({a, b, c});
        const auto differs = [&](uint32_t other) { return (other != label) & (other != none); };
        if (label == none) label = labels.add();
        else if (differs(a) | differs(b) | differs(c))
            for (const uint32_t met : {a, b, c})
                if (met != none) label = labels.join(label, met);
        of[t.x] = of[t.y] = of[t.z] = label;
        return label;
    });
    std::vector<uint32_t>& numbers = found.numbers;
    numbers.resize(labels.size());
    for (uint32_t label = 0; label < labels.size(); ++label) {
        const uint32_t lowest = labels.find(label);
        numbers[label] = lowest == label ? found.count++ : numbers[lowest];
    }
    for (uint32_t& v : of)
        if (v != none) v = numbers[v];
    return found;
}

}  // namespace sgm::mesh
