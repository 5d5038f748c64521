// The functions of plugin_functions.h for a program that loads OpenVDB when it first calls one of them.
#include <utility>

#include "modeler/volume/plugin_functions.h"

namespace sgm::volume {
namespace {

/// Loaded once and for good.
const Result<const PluginFunctions*>& functions() {
    static const Result<const PluginFunctions*> loaded = loadPlugin();
    return loaded;
}

/// The function that `function` names.
template <auto function, class Outcome, class... Arguments>
Outcome through(Arguments&&... arguments) {
    if (!functions().ok()) return functions().error();
    return ((*functions())->*function)(std::forward<Arguments>(arguments)...);
}

}  // namespace

Status load() { return functions().ok() ? Status(Done{}) : functions().error(); }

Result<Air> airOf(const Volume& level, bool hollow, Progress* progress) {
    return through<&PluginFunctions::airOf, Result<Air>>(level, hollow, progress);
}

Result<Dense> dense(const Volume& volume, int border) {
    return through<&PluginFunctions::dense, Result<Dense>>(volume, border);
}

Status fillVdb(const std::vector<NamedVolume>& volumes, const std::filesystem::path& file,
               const std::filesystem::path& target, const VdbOptions& options, const Progress* progress) {
    return through<&PluginFunctions::fillVdb, Status>(volumes, file, target, options, progress);
}

Result<Volume> fog(const Volume& levelSet, const FogOptions& options, const Progress* progress) {
    return through<&PluginFunctions::fog, Result<Volume>>(levelSet, options, progress);
}

Status keepOnly(Volume& level, mesh::Keep keep, float slack_m, Progress* progress) {
    return through<&PluginFunctions::keepOnly, Status>(level, keep, slack_m, progress);
}

Result<Volume> renormalize(const Volume& level, int threads, Progress* progress) {
    return through<&PluginFunctions::renormalize, Result<Volume>>(level, threads, progress);
}

Result<Volume> sample(const std::vector<mesh::Block>& blocks, const eval::Tape& whole, const mesh::Grid& grid,
                      int halfWidth, int threads, Progress* progress) {
    return through<&PluginFunctions::sample, Result<Volume>>(blocks, whole, grid, halfWidth, threads, progress);
}

}  // namespace sgm::volume
