// The objects that a surface is divided into: a tree of nodes, and which of them holds the triangles of which origin.
// Enters: what a shape tree knows. Leaves: a plain table for writers of files. Assumes parents before their children.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "modeler/core/provenance.h"
#include "modeler/core/vec.h"

namespace sgm {

/// A number, a text or a vector that a file says of an object.
using ObjectValue = std::variant<double, std::string, Vec3d>;

/// One node: an object with triangles of its own, a group of objects, or both.
struct ObjectNode {
    std::string name;     ///< distinct in its tree
    uint32_t parent = 0;  ///< index into ObjectTree::nodes; the root is its own parent
    std::string path;     ///< of its shape in the shape tree
    std::string symbol;   ///< of its shape
    std::string rule;     ///< the rule application that made it, "" for the start
    std::string file;     ///< grammar file
    uint32_t line = 0;    ///< 1-based line of the text that made it
    std::vector<std::pair<std::string, ObjectValue>> values;  ///< size of its scope, values that it sets
    /// Equal for nodes that moving puts onto each other, with all that is below them; 0: like no other.
    uint64_t likeness = 0;
    Vec3d centre = {};  ///< of its shape's scope, metres
};

/// Nodes in depth-first order; nodes[0] is the root and holds what no other node does.
struct ObjectTree {
    std::vector<ObjectNode> nodes;
    std::vector<uint32_t> ofOrigin;  ///< by OriginId: the node that holds its triangles

    /// The node that holds the triangles of `origin`; the root for an unknown one.
    uint32_t nodeOf(OriginId origin) const { return origin < ofOrigin.size() ? ofOrigin[origin] : 0; }
};

}  // namespace sgm
