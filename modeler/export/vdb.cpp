// OpenVDB (.vdb): the level set, the fog made from it, or both, by the module that owns them. Renderers look for a
// float grid called "density" of the class fog volume; programs that offset, smooth or advect take the level set's
// values for distances.
#include <optional>

#include "modeler/export/fog_options.h"
#include "modeler/export/formats.h"
#include "modeler/volume/renormalize.h"

namespace sgm::exporter {
volume::FogOptions fogOptionsOf(const ExportOptions& options) {
    volume::FogOptions fog;
    const auto read = [&](std::string_view name, double& value) {
        const auto given = options.find(name);
        if (given == options.end()) return;
        if (const auto number = numberOf(given->second)) value = *number;
    };
    read("density", fog.density);
    read("edge", fog.edge_m);
    read("wisps", fog.wisps);
    read("billow", fog.billow);
    read("lump", fog.lump_m);
    return fog;
}

static Status writeVdb(const ExportInput& input, const Path& temporary, const Path& target) {
    const std::string_view grids = option(input, "grids", "levelset");
    std::vector<volume::NamedVolume> volumes;
    std::optional<volume::Volume> exact;
    if (grids.find("levelset") != grids.npos) {
        if (option(input, "distance", "exact") == "exact") {
            auto renormalized = volume::renormalize(*input.volume, 0, input.progress);
            if (!renormalized.ok()) return renormalized.error();
            exact = std::move(*renormalized);
        }
        volumes.push_back({exact ? *exact : *input.volume, std::string(option(input, "grid", "level_set"))});
    }
    std::optional<volume::Volume> density;
    if (grids.find("fog") != grids.npos) {
        auto fog = volume::fog(*input.volume, fogOptionsOf(input.options), input.progress);
        if (!fog.ok()) return fog.error();
        density = std::move(*fog);
        volumes.push_back({*density, "density"});
    }
    return volume::fillVdb(volumes, temporary, target, {option(input, "half", "no") == "yes", input.extras},
                           input.progress);
}

static constexpr ExportOption vdbOptions[] = {
    {"grids", "levelset", "levelset|fog|levelset,fog", "which grids the file holds; the fog's is called density"},
    {"grid", "level_set", "", "name of the level set's grid", 0, 0, "levelset"},
    {"distance", "exact", "exact|raw",
     "level set: distances to the isosurface, or the field's own values, which are steeper or flatter in places", 0, 0,
     "levelset"},
    {"half", "no", "no|yes", "16-bit floats: about a third smaller, three digits"},
    {"density", "1", "", "fog: density deep inside", 1e-6, 1e6, "fog"},
    {"edge", "0", "", "fog: metres of depth over which it thickens to that; 0: three voxels", 0, 1e5, "fog"},
    {"wisps", "0", "", "fog: how far noise eats into the edge", 0, 0.95, "fog"},
    {"billow", "0", "", "fog: how much noise thins the inside, which is then stored voxel by voxel", 0, 1, "fog"},
    {"lump", "0", "", "fog: metres of the largest lumps of noise; 0: an eighth of the least extent", 0, 1e5, "fog"},
};

constinit const Exporter vdbFormat{
    .extension = ".vdb",
    .doc = "OpenVDB: a narrow-band level set, fog for renderers, or both; voxels in metres",
    .wantsVolume = true,
    .options = vdbOptions,
    .takesPositionsOnly = saysPositionsOnly,
    .write = writeVdb,
    .stream = nullptr,
    .needs = Package::OpenVdb,
};

}  // namespace sgm::exporter
