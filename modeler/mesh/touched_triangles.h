// Triangles at vertices that move, and which way they faced before.
// Enters: a mesh with the normals of its corners, its flat form, and which vertices may move. Leaves: triangles that
// have folded over since.
#pragma once

#include <span>
#include <vector>

#include "modeler/mesh/flat_mesh.h"

namespace sgm::mesh {

/// The list, ascending. The mesh and its flat form have to stay; positions and corners of the flat form may change.
class TouchedTriangles {
public:
    static constexpr uint32_t none = 0xffffffffu;  ///< stands for a vertex that stays
    struct Touched {
        uint32_t triangle;
        int creases;              ///< a bit for each corner that lies on a crease
        Vec3d outward;            ///< unit; see outwardOf
        double before;            ///< twice its area, as far as it faced outward
        bool isNew = false;       ///< an edge of it was flipped since triangles were compared
        bool hasFlipped = false;  ///< an edge of it was flipped once
    };

    TouchedTriangles(const Mesh& mesh, const FlatMesh& flat) : mesh_(mesh), flat_(flat) {}
    /// Lists the triangles with a vertex that has a number other than `none`; O(n) in all triangles.
    void find(const PageVector<uint32_t>& moveOf);

    /// Lists one more, none of whose vertices moves. O(n) in those listed.
    void add(uint32_t triangle);

    /// Null for a triangle that isn't in the list.
    Touched* of(uint32_t triangle);
    /// Those that face away from where they faced, by more than rounding.
    std::vector<uint32_t> folded() const;
    /// Whether a triangle has no area to speak of that faces outward.
    bool isFlat(const Touched& touched) const;

    auto begin() { return touched_.begin(); }
    auto end() { return touched_.end(); }

private:
    Touched touch(uint32_t triangle, std::span<const CornerNormal> own) const;
    Vec3d outwardOf(const Touched& touched, Vec3d ofCreases) const;
    double facing(const Touched& touched) const;
    double longestSquare(uint32_t triangle) const;

    const Mesh& mesh_;
    const FlatMesh& flat_;
    std::vector<Touched> touched_;
};

}  // namespace sgm::mesh
