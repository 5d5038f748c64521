// A model with objects of their own: each has one mesh and stands at many places.
// Enters: meshes and poses. Leaves: what writers instance or copy. Assumes poses that turn and move, without scale or
// mirror, in the frame of the model around them.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "modeler/core/provenance.h"
#include "modeler/core/result.h"
#include "modeler/mesh/mesh.h"

namespace sgm::mesh {

/// A mesh in memory of its own size, for one that stays while others come and go: pieces of a Mesh lie in large regions
/// between what was needed to make it, and hold all of a region as long as they live.
struct PackedMesh {
    std::vector<Vec3f> positions, normals;
    std::vector<Triangle> triangles;  ///< corners count in `positions`
    std::vector<OriginId> origins;
    std::vector<Label> labels;
    std::vector<CornerNormal> cornerNormals;  ///< corners count in `triangles`
    std::vector<uint32_t> faceted;
};
PackedMesh pack(const Mesh& mesh);
/// The mesh as a single chunk.
Mesh unpack(const PackedMesh& packed);

/// An object that stands at one or more places.
struct SceneObject {
    std::string name;                           ///< distinct in its scene
    Mesh mesh;                                  ///< in the object's own frame, metres
    Provenance provenance;                      ///< of its mesh; its materials are those of the whole scene
    std::map<std::string, std::string> values;  ///< what decides it: start, seed, parameters that differ
};

/// One place where an object stands.
struct Instance {
    uint32_t object = 0;  ///< index into Scene::objects
    Part part;            ///< the shape that holds it; `pose` takes the object's frame to the model's
};

/// The objects of a model and their places; the model's own mesh is beside it.
struct Scene {
    Provenance ground;  ///< of the model's own mesh, with the materials of the whole scene
    std::vector<SceneObject> objects;
    std::vector<Instance> instances;

    bool empty() const { return instances.empty(); }
    /// Triangles of all places together.
    uint64_t triangleCount() const;
};

/// Gives all objects and the ground one list of materials: looks of equal name are one, and other looks of that name
/// are numbered.
void shareMaterials(Scene& scene);

/// The box around the model's own mesh and all places.
Box3f boundsOf(const Scene& scene, const Mesh& ground);

/// One mesh of everything, as formats that know no instances hold it, and whose its triangles are.
struct FlatScene {
    Mesh mesh;
    Provenance provenance;
};
/// A rotation as a unit quaternion (x, y, z, w), w ≥ 0.
std::array<double, 4> quaternionOf(const Mat3& axes);

/// Copies every object to all its places. Error::Budget for more than 2³¹ vertices. O(triangles of all places).
Result<FlatScene> flatten(const Scene& scene, const Mesh& ground);

}  // namespace sgm::mesh
