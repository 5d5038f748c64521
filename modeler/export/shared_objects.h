// Objects that show another object's surface, moved, instead of one of their own.
// Enters: a mesh and its object tree. Leaves: who shows whose surface, and the mesh without what is shown twice.
// Assumes a tree in depth-first order, and a closed mesh.
#pragma once

#include <optional>
#include <vector>

#include "modeler/core/object_tree.h"
#include "modeler/mesh/mesh.h"

namespace sgm::exporter {

struct SharedObjects {
    /// By node: the node whose surface it shows, itself where that is its own. What shows another's surface does so
    /// with all nodes below it.
    std::vector<uint32_t> of;
    std::vector<Vec3d>
        moved;  ///< by node: how far it stands from where its parent's place would put the surface, metres
    std::vector<std::vector<OriginId>> origins;  ///< by node: those whose triangles it holds, ascending
    /// The mesh without the triangles of nodes that show another's; none where there are no such nodes.
    std::optional<mesh::Mesh> mesh;

    bool isShared(uint32_t node) const { return of[node] != node; }
    /// Whether it is the topmost one of nodes that show others' surfaces.
    bool isTop(const ObjectTree& objects, uint32_t node) const {
        return isShared(node) && !isShared(objects.nodes[node].parent);
    }
};

/// Every node shows its own surface.
SharedObjects keepOwnSurfaces(const ObjectTree& objects);

/// Finds objects of equal likeness whose surfaces touch no other object's: whole connected surfaces with the same
/// bounds to two hundredths of their diagonal and the same volume to a hundredth. The first one in the tree's order
/// keeps its surface. O(triangles + nodes).
SharedObjects shareObjects(const mesh::Mesh& mesh, const ObjectTree& objects);

}  // namespace sgm::exporter
