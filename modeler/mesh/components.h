// What hangs together: union-find with path halving, and the connected surfaces of a mesh.
// Enters: n things and the pairs that belong together, or triangles. Leaves: the lowest member of each group; the
// surface of each vertex.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

#include "modeler/core/pages.h"
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
    void clear() { parent_.clear(); }

private:
    std::vector<uint32_t> parent_;
};

/// Which connected surface each vertex of a mesh is on.
struct SurfaceLabels {
    static constexpr uint32_t none = 0xffffffffu;  ///< the vertex has no triangle
    PageVector<uint32_t> of;        ///< by vertex: 0 … count − 1, in the order of the surfaces' first triangles
    std::vector<uint32_t> numbers;  ///< by the label that a triangle was given: the same
    uint32_t count = 0;
};

/// Labels vertices as pixels are (Rosenfeld and Pfaltz, "Sequential Operations in Digital Picture Processing", 1966): a
/// triangle passes on the label that it finds, and labels that meet are one. There are far fewer labels than vertices.
class Labeller {
public:
    /// Forgets all; for so many vertices.
    void begin(size_t vertices) {
        of_.assign(vertices, none);
        labels_.clear();
    }
    /// The label of a triangle and its corners, of fewer than 2³¹ that were given out so far.
    uint32_t label(const Vec3<uint32_t>& t) {
        uint32_t &x = of_[t.x], &y = of_[t.y], &z = of_[t.z];
        const uint32_t a = x, b = y, c = z;
        // The lowest label, for which none is the greatest number, and the highest one, for which it is the least.
        uint32_t low = a < b ? a : b;
        low = low < c ? low : c;
        int32_t high = signedOf(a) > signedOf(b) ? signedOf(a) : signedOf(b);
        high = high > signedOf(c) ? high : signedOf(c);
        if ((static_cast<uint32_t>(high) != low) | (low == none)) [[unlikely]]
            low = met(a, b, c);
        return x = y = z = low;
    }
    /// What was found; begin anew then.
    SurfaceLabels found() {
        SurfaceLabels found{std::move(of_), std::vector<uint32_t>(labels_.size())};
        for (uint32_t label = 0; label < labels_.size(); ++label) {
            const uint32_t lowest = labels_.find(label);
            found.numbers[label] = lowest == label ? found.count++ : found.numbers[lowest];
        }
        for (uint32_t& v : found.of)
            if (v != none) v = found.numbers[v];
        return found;
    }

private:
    static constexpr uint32_t none = SurfaceLabels::none;
    static constexpr int32_t signedOf(uint32_t label) { return static_cast<int32_t>(label); }

    /// What they are from now on, a new label where all are none.
    [[gnu::noinline]] uint32_t met(uint32_t a, uint32_t b, uint32_t c) {
        uint32_t label = std::min({a, b, c});
        if (label == none) return labels_.add();
        for (const uint32_t l : {a, b, c})
            if (l != none) label = labels_.join(label, l);
        return label;
    }

    PageVector<uint32_t> of_;
    Components labels_{0};
};

/// `forTriangles(f)` calls f with every triangle, corners counted in the whole mesh; f returns its label.
template <class ForTriangles>
SurfaceLabels labelSurfaces(size_t vertices, ForTriangles forTriangles) {
    Labeller labels;
    labels.begin(vertices);
    forTriangles([&](const Vec3<uint32_t>& t) { return labels.label(t); });
    return labels.found();
}

}  // namespace sgm::mesh
