#include "modeler/mesh/read.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "modeler/core/lower_case.h"
#include "modeler/core/regular_file.h"
#include "modeler/mesh/read_formats.h"

namespace sgm::mesh {
namespace {

constexpr uint64_t mostFile_bytes = 1ull << 30;
/// Corners and edges are counted in 32 bits.
constexpr size_t mostTriangles = 200'000'000;

struct Format {
    std::string_view ending;
    Status (*read)(std::string_view bytes, TriangleSoup& soup, const Progress* progress);  ///< null: glTF
};
constexpr Format formats[] = {{".obj", readObj}, {".ply", readPly}, {".stl", readStl},
                              {".off", readOff}, {".glb", nullptr}, {".gltf", nullptr}};

Error about(const std::filesystem::path& path, const Error& error) {
    if (error.kind == Error::Kind::Cancelled) return error;
    return {error.kind, fmt::format("'{}' {}", path.string(), error.message)};
}

/// Reads files in the folder of `path` and below, after links are resolved, and nothing else; `named` gets their paths.
ReadBeside filesBeside(const std::filesystem::path& path, std::vector<std::filesystem::path>* named,
                       const Progress* progress) {
    return [=, folder = path.parent_path()](const std::string& name) -> Result<std::string> {
        const auto control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
        std::error_code failed;
        const auto root = std::filesystem::weakly_canonical(folder.empty() ? "." : folder, failed);
        const auto within = std::filesystem::weakly_canonical(root / name, failed).lexically_relative(root);
        if (failed || std::any_of(name.begin(), name.end(), control) || within.empty() || *within.begin() == ".." ||
            std::filesystem::path(name).is_absolute())
            return Error{Error::Kind::Input, "a mesh may only use files in its own folder"};
        if (named) named->push_back(folder / within);
        return readRegularFile(root / within, mostFile_bytes, progress);
    };
}

}  // namespace

Status checkSoup(const TriangleSoup& soup) {
    const auto finite = [](const Vec3d& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); };
    if (!std::all_of(soup.positions.begin(), soup.positions.end(), finite))
        return Error{Error::Kind::Input, "has a coordinate that is no number"};
    if (soup.triangles.empty()) return Error{Error::Kind::Input, "holds no triangles: it is damaged or cut short"};
    if (soup.triangles.size() > mostTriangles)
        return Error{Error::Kind::Budget, fmt::format("holds more than {} triangles: simplify it", mostTriangles)};
    const auto known = [&](const Triangle& t) { return std::max({t.x, t.y, t.z}) < soup.positions.size(); };
    if (!std::all_of(soup.triangles.begin(), soup.triangles.end(), known))
        return Error{Error::Kind::Input, fmt::format("is damaged: a face has a corner that is none of its {} vertices",
                                                     soup.positions.size())};
    return Done{};
}

Error damaged(uint64_t line, std::string_view why) {
    return {Error::Kind::Input,
            line == 0 ? fmt::format("is damaged: {}", why) : fmt::format("is damaged, line {}: {}", line, why)};
}

Result<TriangleSoup> readMesh(const std::filesystem::path& path, const Progress* progress,
                              std::vector<std::filesystem::path>* named) {
    const std::string ending = lowerCase(path.extension().string());
    const auto* format =
        std::find_if(std::begin(formats), std::end(formats), [&](const Format& f) { return f.ending == ending; });
    if (format == std::end(formats))
        return about(path,
                     {Error::Kind::Input, "is no mesh that can be read: save it as .obj, .ply, .stl, .off or .glb"});
    const Result<std::string> bytes = readRegularFile(path, mostFile_bytes, progress);
    if (!bytes.ok()) {
        Error error = bytes.error();
        if (error.kind != Error::Kind::Cancelled) error.message = "can't be read: " + error.message;
        return about(path, error);
    }
    TriangleSoup soup;
    const Status read = format->read ? format->read(*bytes, soup, progress)
                                     : readGltf(*bytes, filesBeside(path, named, progress), soup, progress);
    if (!read.ok()) return about(path, read.error());
    if (const Status sound = checkSoup(soup); !sound.ok()) return about(path, sound.error());
    return soup;
}

}  // namespace sgm::mesh
