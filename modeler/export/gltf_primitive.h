// What packers of glTF share: a primitive's attributes as plain lists, and the grid that positions are rounded to.
// Enters: a model with floats in buffer 0. Leaves: lists, whole numbers. Assumes triangle lists with 32-bit indices.
#pragma once

#include <tiny_gltf.h>

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "modeler/core/result.h"
#include "modeler/core/vec.h"

namespace sgm::exporter {

/// An attribute whose bytes packers keep, such as colours.
struct RawAttribute {
    int componentType = 0, type = 0;
    bool normalized = false;
    size_t elementBytes = 0;
    std::vector<unsigned char> bytes;  ///< elements one after another, without padding
};

/// The attributes of a primitive, each with an element a vertex, and its triangles' corners.
struct PrimitiveData {
    std::vector<Vec3f> positions, normals;
    std::map<std::string, std::vector<std::array<float, 2>>> textureCoordinates;  ///< by the attribute's name
    std::map<std::string, RawAttribute> others;                                   ///< by the attribute's name
    std::vector<uint32_t> indices;                                                ///< three a triangle
};

/// Whether a mesh is one that is seen: all its primitives have normals. Colliders have none; packers leave them exact.
bool isSurface(const tinygltf::Mesh& mesh);

/// Reads what a primitive's accessors hold. Error::Input for a POSITION, NORMAL or TEXCOORD_n of another type than
/// float.
Result<PrimitiveData> readPrimitive(const tinygltf::Model& model, const tinygltf::Primitive& primitive);

/// The primitives of one mesh with the box around them.
struct MeshData {
    std::vector<PrimitiveData> primitives;
    Box3f bounds;
};
/// Reads all primitives of a mesh; errors as readPrimitive's.
Result<MeshData> readMesh(const tinygltf::Model& model, const tinygltf::Mesh& mesh);

/// The data of a model that is being packed: taken out of it, so that accessors and views are numbered anew.
class TakenData {
public:
    /// Adds a view with the bytes of an old one; answers its number.
    using AddView = std::function<int(const tinygltf::BufferView& old, std::span<const unsigned char> bytes)>;

    /// Leaves the model's buffer 0 empty, without accessors and views.
    explicit TakenData(tinygltf::Model& model);
    /// Adds a primitive's accessors as they were; their views by `addView`, each once.
    void keep(tinygltf::Primitive& primitive, const AddView& addView);

private:
    int keep(int accessor, const AddView& addView);

    tinygltf::Model& model_;
    std::vector<unsigned char> bytes_;
    std::vector<tinygltf::BufferView> views_;
    std::vector<tinygltf::Accessor> accessors_;
    std::map<int, int> kept_;  ///< the new number of an old view
};

/// Appends an accessor and returns its number.
int addAccessor(tinygltf::Model& model, const tinygltf::Accessor& accessor);

/// Whole multiples of a power of two, so that rounding to them and back is exact: points of equal position stay equal
/// in whatever primitive or mesh they lie.
struct QuantizationGrid {
    double step = 1;

    /// The multiple next to `v`, halves away from 0.
    int64_t nearest(double v) const;
    /// The greatest multiple that is not above `v`.
    int64_t below(double v) const;
};

/// The finest grid of which `extent` spans at most 65,534 steps, so that 16 bits count from one end to the other
/// wherever the ends lie. Steps of 1 where there is no extent.
QuantizationGrid gridOver(double extent);

/// `p` in steps from the point `origin`, which is in steps, too.
inline Vec3<int64_t> stepsFrom(const QuantizationGrid& grid, Vec3<int64_t> origin, Vec3f p) {
    const Vec3d at = p.as<double>();
    return Vec3<int64_t>{grid.nearest(at.x), grid.nearest(at.y), grid.nearest(at.z)} - origin;
}
/// The lower corner of a box in steps, rounded down.
inline Vec3<int64_t> originOf(const QuantizationGrid& grid, const Box3f& box) {
    const Vec3d lo = box.lo.as<double>();
    return {grid.below(lo.x), grid.below(lo.y), grid.below(lo.z)};
}

}  // namespace sgm::exporter
