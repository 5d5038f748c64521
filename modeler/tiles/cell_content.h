// What the files of a baked city hold: an object of the library, or a cell with its piece of the ground and instances
// of objects whose bytes lie in the library.
// Enters: pieces of surface, places, files of the library. Leaves: .glb files, a cell's with EXT_mesh_gpu_instancing
// and a table of its places. Assumes a library written here, whose files stay as they are.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "modeler/core/result.h"
#include "modeler/tiles/cell.h"
#include "modeler/tiles/surface_buffer.h"

namespace sgm::tiles {

/// A place of an object in a cell.
struct CellPlace {
    const Part* part;  ///< the shape that holds it; its pose takes the object's frame to the model's
};
/// The places of one object in a cell, and where the library holds it.
struct CellObject {
    std::string file;  ///< of the library, relative to the cell's file
    std::filesystem::path path;
    std::map<std::string, std::string> values;
    std::vector<CellPlace> places;
};

/// A place whose object is shown as a box.
struct CellBox {
    const Part* part;  ///< as CellPlace has it
    std::string kind;  ///< name of the object
    Material material;
    Vec3d centre, half;  ///< metres, in the object's frame
    Mat3 axes;           ///< of the box: object from local
};

/// A cell's content in metres about `centre`.
struct CellContent {
    Vec3d centre;
    Packing packing = Packing::Meshopt;
    bool asNodes = false;  ///< a node a place, which every reader takes, instead of instances; without the table
    std::string pictures = "../../lib/textures/";  ///< where those of the ground's materials lie, from the cell's file
    std::vector<SurfacePiece> ground;
    QuantizationGrid groundGrid;      ///< the same places as those of the neighbours' grids on the common border
    std::vector<Material> materials;  ///< of the ground
    std::vector<CellObject> objects;
    std::vector<CellBox> boxes;
};

/// What is told of a cell for the tileset and the manifest.
struct CellFigures {
    std::array<double, 6> bounds{};  ///< metres about the cell's centre: least x, y, z, greatest x, y, z
    uint64_t triangles = 0;          ///< drawn, those of every place
    uint64_t instances = 0;
    bool empty() const { return triangles == 0; }
};

/// An object for the library.
struct LibraryObject {
    std::string name;
    std::map<std::string, std::string> values;
    std::vector<SurfacePiece> pieces;
    std::vector<Material> materials;
    bool inColors = false;  ///< one primitive with a colour a vertex
};
/// Writes it, all or nothing, and its pictures into the folder "textures" beside that of the file.
Status writeObject(const LibraryObject& object, Packing packing, const std::filesystem::path& path);

/// What is known of the library's files; their bytes aren't kept. The files that were opened last stay known, so that
/// it takes the same memory for a library of any size.
class Library {
public:
    struct Entry {
        std::string name;           ///< of the object
        std::vector<uint8_t> json;  ///< what cells take over of the file's, as CBOR, which is smaller
        uint64_t bytesAt = 0;       ///< where the binary chunk begins in the file
        uint64_t fileBytes = 0;     ///< of the file
        QuantizationGrid grid;
        Box3d box;  ///< metres
        uint64_t triangles = 0;
        /// The file without its bytes, O(its primitives).
        Glb file() const;
    };
    /// Valid until the next call. Error::Input for a file that can't be read.
    Result<const Entry*> open(const std::filesystem::path& path);

private:
    using Entries = std::map<std::filesystem::path, Entry>;
    static constexpr size_t mostRecent = 1024;
    Entries recent_, older_;  ///< a full list of recent ones takes the place of the older ones
};

/// Writes the cell, all or nothing; no file for a cell without triangles. Error::Input where the library lacks an
/// object.
Result<CellFigures> writeCell(const CellContent& content, Library& library, const std::filesystem::path& path);

}  // namespace sgm::tiles
