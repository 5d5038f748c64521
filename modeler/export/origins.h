// Which origins a mesh that is to be written has, and which nodes of an object tree.
// Enters: a PatchedMesh, an ObjectTree. Leaves: lists in ascending order.
#pragma once

#include "modeler/export/surface.h"

namespace sgm::exporter {

/// The origins of a mesh's triangles that the provenance has parts for, ascending.
std::vector<OriginId> originsOf(const mesh::Mesh& mesh, const Provenance& provenance);

/// "Cave/Cell, rule grow, a.sgm:12": a part on one line.
std::string originText(const Part& part);

/// Which nodes hold triangles or stand above one that does; `holds` says which hold some.
std::vector<bool> nodesAbove(const ObjectTree& objects, std::vector<bool> holds);

/// Calls visit(origin, first triangle, count) for each run of triangles of one origin in a patch.
template <class Visit>
void forOriginRuns(const PatchedMesh& patched, const Patch& patch, Visit visit) {
    const uint32_t end = patch.firstTriangle + patch.triangleCount;
    for (uint32_t first = patch.firstTriangle, t = first; t < end; first = t) {
        while (t < end && patched.origins[t] == patched.origins[first]) ++t;
        visit(patched.origins[first], first, t - first);
    }
}

}  // namespace sgm::exporter
