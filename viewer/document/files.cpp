#include "viewer/document/files.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>

#include "modeler/core/atomic_file.h"
#include "modeler/mesh/distances.h"

namespace sgm::viewer {
namespace fs = std::filesystem;

namespace {

/// The standard library stands beside the installed program, or in the tree it was built from.
fs::path standardLibrary() {
    std::error_code ignored;
    const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
    const fs::path installed = program.parent_path().parent_path() / "share/sgm/std";
    return fs::is_directory(installed, ignored) ? installed : fs::path(SGM_STANDARD_LIBRARY);
}

bool leadsOutside(const fs::path& relative) {
    if (relative.is_absolute()) return true;
    for (const fs::path& part : relative.lexically_normal())
        if (part == "..") return true;
    return false;
}

/// Where a name that stands in `from` lies, or nothing with `why` set.
std::optional<fs::path> pathOf(const std::string& name, const syntax::Source& from, std::string& why) {
    const fs::path wanted(name);
    if (leadsOutside(wanted)) {
        why = "a grammar may only use files in its own folder or in std/";
        return {};
    }
    return name.starts_with("std/") ? standardLibrary() / name.substr(4) : fs::path(from.name()).parent_path() / wanted;
}

/// Meshes read so far. A text is checked again at every edit, and distances take a good part of a second.
class Meshes {
public:
    Result<field::SampledGridPtr> operator()(const fs::path& path) {
        std::error_code failed;
        const auto time = fs::last_write_time(path, failed);
        Read& read = known_[path.string()];
        if (!failed && read.grid && read.time == time) return read.grid;
        auto grid = mesh::readDistances(path);
        read = {time, grid.ok() ? *grid : nullptr};
        return grid;
    }

private:
    struct Read {
        fs::file_time_type time;
        field::SampledGridPtr grid;
    };
    std::map<std::string, Read> known_;
};

}  // namespace

Result<syntax::SourcePtr> readSource(const fs::path& path) {
    std::error_code ignored;
    if (fs::is_directory(path, ignored))
        return Error{Error::Kind::Input, fmt::format("'{}' is a folder, not a grammar file", path.string())};
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    if (file) text << file.rdbuf();
    if (!file)
        return Error{Error::Kind::Input,
                     fmt::format("can't read '{}': {}", path.string(), std::strerror(errno ? errno : EIO))};
    return std::make_shared<const syntax::Source>(path.string(), text.str());
}

rules::Loader fileLoader() {
    rules::Loader loader([](const std::string& name, const syntax::Source& from, std::string& why) -> syntax::SourcePtr {
        const auto path = pathOf(name, from, why);
        if (!path) return nullptr;
        Result<syntax::SourcePtr> source = readSource(*path);
        if (source.ok()) return *source;
        why = source.error().message;
        return nullptr;
    });
    loader.mesh = [meshes = Meshes()](const std::string& name, const syntax::Source& from, std::string& why) mutable -> field::SampledGridPtr {
        const auto path = pathOf(name, from, why);
        if (!path) return nullptr;
        const auto grid = meshes(*path);
        if (grid.ok()) return *grid;
        why = grid.error().message;
        return nullptr;
    };
    return loader;
}

Status writeText(const fs::path& path, const std::string& text) {
    return replaceFile(path, [&](const fs::path& temporary) -> Status {
        std::ofstream file(temporary, std::ios::binary);
        file << text;
        file.close();
        return file ? Status(Done{}) : Status(writeError(path, errno ? errno : EIO));
    });
}

}  // namespace sgm::viewer
