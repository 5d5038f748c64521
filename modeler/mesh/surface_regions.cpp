#include "modeler/mesh/surface_regions.h"

#include "modeler/core/parallel.h"

namespace sgm::mesh {
namespace {

constexpr uint32_t none = 0xffffffffu;
constexpr uint64_t noKey = ~uint64_t{0};

/// One side of an edge with both ends on borders.
struct HalfEdge {
    uint32_t a, b, triangle;
};

/// What one part of the mesh leaves to be done when all are through.
struct Leftover {
    std::vector<uint32_t> foreign;  ///< triangles with vertices of other parts
    PageVector<HalfEdge> edges;
};

class RegionFinder {
public:
    RegionFinder(const FlatMesh& mesh, int threads) : mesh_(mesh), threads_(threads), leftovers_(mesh.parts.size()) {}

    Result<SurfaceRegions> find() {
        findBorderVertices();
        joinAroundVertices();
        if (!joinAcrossEdges())
            return Error{Error::Kind::Input, "the mesh isn't closed, or more than two triangles share an edge"};
        number();
        return std::move(found_);
    }

private:
    template <class Body>
    void forParts(Body&& body) {
        parallelFor(mesh_.parts.size(), threads_, nullptr, [&](size_t i, int) { body(mesh_.parts[i], leftovers_[i]); });
    }
    static bool owns(const FlatMesh::Part& part, uint32_t v) { return v - part.firstVertex < part.vertices; }

    /// Vertices whose triangles differ in key become none in `labels_`' stead: `border_`.
    void findBorderVertices() {
        keyOf_.resize(mesh_.positions.size());
        border_.resize(mesh_.positions.size());
        const auto note = [this](uint32_t v, uint64_t key) {
            if (keyOf_[v] == noKey)
                keyOf_[v] = key;
            else if (keyOf_[v] != key)
                border_[v] = 1;
        };
        forParts([&](const FlatMesh::Part& part, Leftover& leftover) {
            std::fill_n(keyOf_.begin() + part.firstVertex, part.vertices, noKey);
            std::fill_n(border_.begin() + part.firstVertex, part.vertices, uint8_t{0});
            for (uint32_t t = part.firstTriangle; t < part.firstTriangle + part.triangles; ++t) {
                const Triangle& corners = mesh_.triangles[t];
                bool foreign = false;
                for (int i = 0; i < 3; ++i) {
                    if (owns(part, corners[i]))
                        note(corners[i], mesh_.keys[t]);
                    else
                        foreign = true;
                }
                if (foreign) leftover.foreign.push_back(t);
            }
        });
        for (size_t i = 0; i < leftovers_.size(); ++i)
            for (const uint32_t t : leftovers_[i].foreign)
                for (int k = 0; k < 3; ++k)
                    if (!owns(mesh_.parts[i], mesh_.triangles[t][k])) note(mesh_.triangles[t][k], mesh_.keys[t]);
    }

    uint32_t root(uint32_t t) {
        while (parent_[t] != t) t = parent_[t] = parent_[parent_[t]];
        return t;
    }
    void join(uint32_t a, uint32_t b) {
        a = root(a), b = root(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

    /// All triangles around a vertex off the borders are one region: a label is the triangle that gave it first.
    void joinAroundVertices() {
        parent_.resize(mesh_.triangles.size());
        label_.resize(mesh_.positions.size());
        forParts([&](const FlatMesh::Part& part, Leftover& leftover) {
            std::fill_n(label_.begin() + part.firstVertex, part.vertices, none);
            leftover.edges.reserve(part.triangles);
            for (uint32_t t = part.firstTriangle; t < part.firstTriangle + part.triangles; ++t)
                joinCorners(t, part, leftover);
        });
        for (size_t i = 0; i < leftovers_.size(); ++i)
            for (const uint32_t t : leftovers_[i].foreign)
                for (int k = 0; k < 3; ++k) {
                    const uint32_t v = mesh_.triangles[t][k];
                    if (owns(mesh_.parts[i], v) || border_[v]) continue;
                    if (label_[v] == none)
                        label_[v] = t;
                    else
                        join(label_[v], t);
                }
    }

    void joinCorners(uint32_t t, const FlatMesh::Part& part, Leftover& leftover) {
        const Triangle& corners = mesh_.triangles[t];
        uint32_t lowest = none;
        bool differ = false, onBorder[3];
        for (int i = 0; i < 3; ++i) {
            const uint32_t v = corners[i];
            onBorder[i] = border_[v] != 0;
            if (onBorder[i] || !owns(part, v)) continue;
            const uint32_t label = label_[v];
            if (label == none) continue;
            differ |= lowest != none && label != lowest;
            lowest = std::min(lowest, label);
        }
        if (lowest == none) lowest = t;
        parent_[t] = lowest;
        for (int i = 0; i < 3; ++i) {
            const uint32_t v = corners[i];
            if (onBorder[i] && onBorder[(i + 1) % 3]) leftover.edges.push_back({v, corners[(i + 1) % 3], t});
            if (onBorder[i] || !owns(part, v)) continue;
            if (differ && label_[v] != none) join(label_[v], lowest);
            label_[v] = lowest;
        }
    }

    /// Matches the sides of edges whose ends are both on borders; false where a side has no partner or several.
    bool joinAcrossEdges() {
        for (uint32_t v = 0; v < border_.size(); ++v)
            if (border_[v]) {
                label_[v] = static_cast<uint32_t>(found_.borderVertices.size());
                found_.borderVertices.push_back(v);
            }
        // Sides by the lower end, as in a counting sort.
        std::vector<uint32_t> end(found_.borderVertices.size() + 1);
        for (const Leftover& l : leftovers_)
            for (const HalfEdge& e : l.edges) ++end[label_[std::min(e.a, e.b)] + 1];
        for (size_t i = 1; i < end.size(); ++i) end[i] += end[i - 1];
        PageVector<HalfEdge> sides;
        sides.resize(end.back());
        found_.borders.reserve(end.back() / 2);
        std::vector<uint32_t> next(end.begin(), end.end() - 1);
        for (const Leftover& l : leftovers_)
            for (const HalfEdge& e : l.edges) sides[next[label_[std::min(e.a, e.b)]]++] = e;
        for (size_t i = 0; i + 1 < end.size(); ++i)
            if (!joinAtVertex(sides.data() + end[i], sides.data() + end[i + 1])) return false;
        return true;
    }

    bool joinAtVertex(const HalfEdge* begin, const HalfEdge* end) {
        for (const HalfEdge* e = begin; e != end; ++e) {
            const HalfEdge* twin = nullptr;
            for (const HalfEdge* other = begin; other != end; ++other) {
                if (other == e) continue;
                if (other->a == e->a && other->b == e->b) return false;
                if (other->a != e->b || other->b != e->a) continue;
                if (twin) return false;
                twin = other;
            }
            if (!twin) return false;
            if (twin < e) continue;
            if (mesh_.keys[e->triangle] == mesh_.keys[twin->triangle])
                join(e->triangle, twin->triangle);
            else
                found_.borders.push_back({e->a, e->b, e->triangle, twin->triangle});
        }
        return true;
    }

    /// Regions in the order of their first triangles, which are the roots.
    void number() {
        found_.ofTriangle.resize(mesh_.triangles.size());
        for (uint32_t t = 0; t < parent_.size(); ++t) {
            const uint32_t first = root(t);
            if (first == t) {
                found_.ofTriangle[t] = static_cast<uint32_t>(found_.keys.size());
                found_.keys.push_back(mesh_.keys[t]);
            } else {
                found_.ofTriangle[t] = found_.ofTriangle[first];
            }
        }
        for (BorderEdge& e : found_.borders) e.left = found_.ofTriangle[e.left], e.right = found_.ofTriangle[e.right];
        found_.ofVertex = std::move(label_);
        forParts([&](const FlatMesh::Part& part, Leftover&) {
            for (uint32_t v = part.firstVertex; v < part.firstVertex + part.vertices; ++v) {
                uint32_t& region = found_.ofVertex[v];
                if (border_[v])
                    region |= SurfaceRegions::borderBit;
                else if (region != none)
                    region = found_.ofTriangle[region];
            }
        });
    }

    const FlatMesh& mesh_;
    const int threads_;
    std::vector<Leftover> leftovers_;
    PageVector<uint64_t> keyOf_;
    PageVector<uint8_t> border_;
    PageVector<uint32_t> label_;   ///< by vertex: a triangle of its region; at last the place among border vertices
    PageVector<uint32_t> parent_;  ///< by triangle
    SurfaceRegions found_;
};

}  // namespace

Result<SurfaceRegions> findRegions(const FlatMesh& mesh, int threads) {
    if (std::max(mesh.positions.size(), mesh.triangles.size()) >= SurfaceRegions::borderBit)
        return Error{Error::Kind::Budget,
                     "a mesh of more than 2^31 vertices or triangles can't be simplified: choose larger cells"};
    for (const Triangle& t : mesh.triangles)
        if (std::max({t.x, t.y, t.z}) >= mesh.positions.size())
            return Error{Error::Kind::Input, "a triangle of the mesh names a vertex that isn't there"};
    return RegionFinder(mesh, threads).find();
}

}  // namespace sgm::mesh
