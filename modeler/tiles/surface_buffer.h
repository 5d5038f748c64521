// A .glb file as it grows: buffer views, accessors, and triangles packed into them.
// Enters: pieces of surface. Leaves: a Glb. Assumes that all data goes into buffer 0; packed views unpack into buffer
// 1, which has no bytes. KHR_mesh_quantization and EXT_meshopt_compression, by meshoptimizer.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "modeler/tiles/glb.h"
#include "modeler/tiles/surface.h"

namespace sgm::tiles {

/// How triangles are stored.
enum class Packing {
    None,    ///< floats, which every reader takes
    Meshopt  ///< positions on a grid of 16 bits, normals of 8 bits, compressed
};

/// A grid of 65,536 places along each axis: place q is origin + step · q. Steps are powers of two and origins multiples
/// of them, so that a float holds every place.
struct QuantizationGrid {
    Vec3d origin, step{1, 1, 1};
    Vec3<uint16_t> nearest(Vec3d p) const;
};
/// The finest grid over a box with equal steps along all axes.
QuantizationGrid gridOver(const Box3f& box);
/// The least power of two of which 65,534 reach over `extent`.
double stepOver(double extent);

/// A file's JSON and bytes as they grow.
class SurfaceBuffer {
public:
    /// `pictures` is where files of pictures lie, relative to this one: "../textures/".
    SurfaceBuffer(Packing packing, std::string pictures);

    nlohmann::ordered_json& json() { return glb_.json; }
    Packing packing() const { return packing_; }

    /// Appends bytes to buffer 0 as a view, at a multiple of `align`; its index.
    size_t addView(const void* bytes, size_t size, int target = 0, size_t align = 4);
    /// Appends an accessor over a view; its index.
    size_t addAccessor(size_t view, size_t offset, int component, size_t count, const char* type,
                       bool normalized = false);
    /// The index of a material, which is added where no other is equal.
    size_t materialOf(nlohmann::ordered_json material);
    /// A material that another file has, whose pictures lie below `folder`, with this file's textures.
    nlohmann::ordered_json adopted(const nlohmann::ordered_json& material, const Glb& from, const std::string& folder);
    /// Adds pieces as primitives, one a piece, that share their vertices; the list of primitives. With a packing
    /// positions are places of the grid, which the node with the mesh has to scale and move. `inColors`: one primitive
    /// with a colour a vertex instead, all rough alike. `packing`: another one than the file's.
    nlohmann::ordered_json addPieces(const std::vector<SurfacePiece>& pieces, const std::vector<Material>& materials,
                                     const QuantizationGrid& grid, bool inColors = false,
                                     std::optional<Packing> packing = {});
    /// What a node needs to show such positions in metres: translation and scale; empty without a packing.
    nlohmann::ordered_json placeOf(const QuantizationGrid& grid) const;
    /// Takes the views and accessors of another file, whose bytes stay there, as those of an external buffer.
    struct External {
        size_t firstView = 0, firstAccessor = 0;
    };
    External addExternal(const Glb& held, const std::string& uri);
    /// Notes an extension that readers must know, or may.
    void use(const char* extension, bool required);
    Glb finish();

private:
    struct Joined;
    size_t addPacked(const std::vector<uint8_t>& bytes, size_t stride, size_t count, const char* mode,
                     const char* filter, int target);
    nlohmann::ordered_json addJoined(const std::vector<SurfacePiece>& pieces, const std::vector<Material>& materials,
                                     const QuantizationGrid& grid, bool inColors);
    size_t addPositions(const Joined& joined, const QuantizationGrid& grid);
    size_t addNormals(const Joined& joined);
    size_t addUvs(const Joined& joined);
    size_t addTangents(const Joined& joined);
    size_t addVertices(const std::vector<uint8_t>& bytes, size_t stride, size_t count, const char* filter);
    nlohmann::ordered_json covered(const Material& material);
    size_t textureOf(const std::string& uri);
    size_t addColors(const Joined& joined, const std::vector<Material>& materials);
    size_t addIndices(const Joined& joined);

    Packing packing_;
    const std::string pictures_;
    Glb glb_;
    size_t unpacked_ = 0;                      ///< bytes of buffer 1
    std::map<std::string, size_t> materials_;  ///< by their text
    std::map<std::string, bool> extensions_;   ///< whether they are required
};

/// A material as glTF has it.
nlohmann::ordered_json asJson(const Material& material);

}  // namespace sgm::tiles
