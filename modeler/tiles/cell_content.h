// What a cell's file holds: its piece of the ground, and instances of objects whose bytes lie in the library.
// Enters: a mesh, places, files of the library. Leaves: a .glb with EXT_mesh_gpu_instancing. Assumes a library written
// by our own exporter, whose files stay as they are.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "modeler/core/provenance.h"
#include "modeler/core/result.h"
#include "modeler/mesh/scene.h"
#include "modeler/tiles/cell.h"
#include "modeler/tiles/glb.h"

namespace sgm::tiles {

/// Triangles of one material, without anything shared between triangles that don't lie in one plane.
struct GroundPiece {
    uint32_t material = 0;  ///< index into the provenance's materials
    std::vector<Vec3f> positions, normals;
    std::vector<uint32_t> indices;  ///< three a triangle
};

/// A place of an object in a cell.
struct CellPlace {
    Pose pose;  ///< from the object's frame to the model's
    Part part;  ///< the shape that holds it
};
/// The places of one object in a cell, and where the library holds it.
struct CellObject {
    std::string file;  ///< of the library, relative to the cell's file
    std::filesystem::path path;
    std::map<std::string, std::string> values;
    std::vector<CellPlace> places;
};

/// A cell's content in metres about `centre`.
struct CellContent {
    Vec3d centre;
    std::vector<GroundPiece> ground;
    std::vector<Material> materials;  ///< of the ground
    std::vector<CellObject> objects;
};

/// What is told of a cell for the tileset and the manifest.
struct CellFigures {
    std::array<double, 6> bounds{};  ///< metres about the cell's centre: least x, y, z, greatest x, y, z
    uint64_t triangles = 0;          ///< drawn, those of every place
    uint64_t instances = 0;
    bool empty() const { return triangles == 0; }
};

/// Simplifies the ground's triangles that belong to a cell, which `indices` name in `mesh`, within `error_m`; vertices
/// on the cell's border, and those between materials, stay. Positions become those about `centre`.
std::vector<GroundPiece> groundPieces(const mesh::PackedMesh& mesh, const std::vector<uint32_t>& triangles,
                                      const Provenance& provenance, Vec3d centre, float error_m);

/// What is known of the library's files, each read once; their bytes aren't kept.
class Library {
public:
    /// Error::Input for a file that can't be read.
    Result<const Glb*> open(const std::filesystem::path& path);

private:
    std::map<std::filesystem::path, Glb> known_;
};

/// Writes the cell, all or nothing; no file for a cell without triangles. Error::Input where the library lacks an
/// object.
Result<CellFigures> writeCell(const CellContent& content, Library& library, const std::filesystem::path& path);

}  // namespace sgm::tiles
