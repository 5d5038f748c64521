// The functions of doors.h for a program that loads OpenVDB when it first calls one of them.
#include <dlfcn.h>

#include <utility>

#include "modeler/volume/doors.h"

namespace sgm::volume {
namespace {

constexpr const char* moduleName = "sgm_volumes.so";

/// The table. Error::Internal where the module or OpenVDB isn't to be found.
Result<const Doors*> load() {
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe").parent_path();
    for (const auto& path : {program / moduleName, program.parent_path() / "lib/sgm" / moduleName}) {
        if (!std::filesystem::exists(path)) continue;
        void* const module = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
        const void* const doors = module ? dlsym(module, "sgm_volume_doors") : nullptr;
        if (!doors) return Error{Error::Kind::Internal, std::string("volumes: ") + dlerror()};
        return static_cast<const Doors*>(doors);
    }
    return Error{Error::Kind::Internal, std::string("volumes: ") + moduleName + " is neither beside " + program.string() + "/sgm nor in lib/sgm"};
}

/// Loaded once and for good.
const Result<const Doors*>& doors() {
    static const Result<const Doors*> loaded = load();
    return loaded;
}

/// What `door` leads to.
template <auto door, class Outcome, class... Arguments>
Outcome through(Arguments&&... arguments) {
    if (!doors().ok()) return doors().error();
    return ((*doors())->*door)(std::forward<Arguments>(arguments)...);
}

}  // namespace

Result<Air> airOf(const Volume& level, bool hollow, Progress* progress) { return through<&Doors::airOf, Result<Air>>(level, hollow, progress); }

Result<Dense> dense(const Volume& volume, int border) { return through<&Doors::dense, Result<Dense>>(volume, border); }

Status fillVdb(const std::vector<NamedVolume>& volumes, const std::filesystem::path& file, const std::filesystem::path& target,
               const VdbOptions& options, const Progress* progress) {
    return through<&Doors::fillVdb, Status>(volumes, file, target, options, progress);
}

Result<Volume> fog(const Volume& levelSet, const FogOptions& options, const Progress* progress) {
    return through<&Doors::fog, Result<Volume>>(levelSet, options, progress);
}

Status keepOnly(Volume& level, mesh::Keep keep, float slack_m, Progress* progress) {
    return through<&Doors::keepOnly, Status>(level, keep, slack_m, progress);
}

Result<Volume> renormalize(const Volume& level, int threads, Progress* progress) {
    return through<&Doors::renormalize, Result<Volume>>(level, threads, progress);
}

Result<Volume> sample(const std::vector<mesh::Block>& blocks, const eval::Tape& whole, const mesh::Grid& grid, int halfWidth, int threads,
                      Progress* progress) {
    return through<&Doors::sample, Result<Volume>>(blocks, whole, grid, halfWidth, threads, progress);
}

}  // namespace sgm::volume
