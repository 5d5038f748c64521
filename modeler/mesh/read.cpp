#include "modeler/mesh/read.h"

#include <fmt/format.h>

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>

#include "modeler/mesh/openmesh.h"

namespace sgm::mesh {
namespace {

/// OpenMesh complains to a stream of its own of what we say ourselves.
class Quiet {
public:
    Quiet() {
        omerr().disable();
        omlog().disable();
    }
    ~Quiet() {
        omerr().enable();
        omlog().enable();
    }
};

Error unreadable(const std::filesystem::path& path, const std::string& why) {
    return {Error::Kind::Input, fmt::format("'{}' {}", path.string(), why)};
}

/// True where the file's head promises more things than the file has bytes: OpenMesh would believe it.
bool promisesTooMuch(const std::filesystem::path& path, const std::string& ending) {
    std::error_code failed;
    const auto bytes = static_cast<double>(std::filesystem::file_size(path, failed));
    std::ifstream file(path, std::ios::binary);
    if (ending == ".stl") {
        char head[84] = {};
        uint32_t triangles = 0;
        file.read(head, sizeof head);
        std::memcpy(&triangles, head + 80, sizeof triangles);
        const bool isText = std::memcmp(head, "solid", 5) == 0;
        return !isText && 84 + 50.0 * triangles > bytes;
    }
    double most = 0, count = 0;
    int lines = 0;
    std::string word, element;
    for (std::string line; lines++ < 1000 && std::getline(file, line) && !line.starts_with("end_header");) {
        std::istringstream words(line);
        if (ending == ".ply" && words >> word >> element >> count && word == "element") most = std::max(most, count);
        if (ending == ".off" && lines <= 2 && words >> count) most = std::max(most, count);
    }
    return most > bytes;
}

std::string lowerCase(std::string text) {
    for (char& c : text) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c + ('a' - 'A') : c);
    return text;
}

}  // namespace

Result<Mesh> readMesh(const std::filesystem::path& path) {
    constexpr const char* known[] = {".obj", ".ply", ".stl", ".off"};
    const std::string ending = lowerCase(path.extension().string());
    if (std::find(std::begin(known), std::end(known), ending) == std::end(known))
        return unreadable(path, "is no mesh that can be read: save it as .obj, .ply, .stl or .off");
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored)) return unreadable(path, "is a folder, not a mesh");
    if (!std::ifstream(path))
        return unreadable(path, fmt::format("can't be read: {}", std::strerror(errno ? errno : EIO)));

    if (promisesTooMuch(path, ending)) return unreadable(path, "is damaged or cut short");
    HalfEdgeMesh read;
    OpenMesh::IO::Options options;
    bool good = false;
    try {
        const Quiet quiet;
        good = OpenMesh::IO::read_mesh(read, path.string(), options);
    } catch (const std::exception&) {  // a count in the file that no memory holds
    }
    if (!good || read.n_faces() == 0) return unreadable(path, "holds no triangles: it is damaged or cut short");
    Mesh mesh = fromOpenMesh(read, false);
    const auto finite = [](const Vec3f& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); };
    const auto& positions = mesh.chunks[0].positions;
    if (!std::all_of(positions.begin(), positions.end(), finite))
        return unreadable(path, "has a coordinate that is no number");
    return mesh;
}

}  // namespace sgm::mesh
