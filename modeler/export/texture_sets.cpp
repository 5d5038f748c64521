#include "modeler/export/texture_sets.h"

#include "modeler/export/formats.h"

namespace sgm::exporter {

Result<TextureSets> makeTexture(const ExportInput& input) {
    TextureSets sets;
    sets.charts = chartTexture(option(input, "uv", "scope"), *input.mesh, *input.provenance);
    const std::string_view texels = option(input, "lightmap", "none");
    if (texels == "none") return sets;
    if (option(input, "uv", "scope") == "none")
        return Error{Error::Kind::Usage, "option 'lightmap' is a second set of texture coordinates: leave out uv=none"};
    if (sets.empty()) return sets;  // nor has the mesh any triangles
    auto light =
        LightMap::make(*input.mesh, input.objects, static_cast<int>(*numberOf(texels)), input.progress, sets.charts);
    if (!light.ok()) return light.error();
    sets.light = std::move(*light);
    return sets;
}

}  // namespace sgm::exporter
