#include "cli/fog_picture.h"

#include <fmt/format.h>

#include <algorithm>

#include "modeler/core/packages.h"
#include "modeler/export/fog_options.h"
#include "modeler/volume/volume.h"
#include "viewer/render/fog_scene.h"

namespace sgm::cli {

Status checkFog() {
    return isBuiltWith(Package::OpenVdb) ? volume::load() : missingPackage(Package::OpenVdb, "--view fog");
}

Result<exporter::ExportOptions> fogOptions(const std::vector<std::string>& words) {
    exporter::ExportOptions options;
    for (const std::string& text : words) {
        const size_t equals = text.find('=');
        const std::string name = text.substr(0, equals);
        constexpr std::string_view known[] = {"density", "edge", "wisps", "billow", "lump"};
        if (equals == text.npos || std::ranges::find(known, name) == std::end(known))
            return Error{
                Error::Kind::Usage,
                fmt::format("--format-option {}: pictures of fog take density, edge, wisps, billow and lump, as "
                            "wisps=.6",
                            text)};
        options[name] = text.substr(equals + 1);
    }
    if (options.empty()) return options;
    exporter::ExportOptions ofFile = options;
    ofFile["grids"] = "fog";
    if (const Status s = exporter::checkOptions(*exporter::findExporter(".vdb"), ofFile); !s.ok()) return s.error();
    return options;
}

Result<render::FogPainter> fogPainter(const Model& model, const Box3f& bounds, const GridRequest& cells,
                                      const std::vector<std::string>& words, double extinction_per_m,
                                      Progress* progress) {
    const mesh::Grid grid = gridOver(bounds, cells);
    const auto of = [&]() -> Result<std::pair<volume::Dense, render::FogLook>> {
        if (words.empty()) {
            auto usual = render::fogGrid(model.tape, grid, bounds, cells.threads, progress);
            if (!usual.ok()) return usual.error();
            const render::FogLook look = render::usualFog(*usual);
            return std::pair{std::move(usual->dense), look};
        }
        const volume::FogOptions options = exporter::fogOptionsOf(*fogOptions(words));
        auto asked = render::fogGrid(model.tape, grid, options, cells.threads, progress);
        if (!asked.ok()) return asked.error();
        render::FogLook look{.extinction_per_m = static_cast<float>(180 * options.density) / length(bounds.size())};
        look.wisps = 0;
        return std::pair{std::move(*asked), look};
    };
    auto fog = of();
    if (!fog.ok()) return fog.error();
    auto& [dense, look] = *fog;
    if (extinction_per_m > 0) look.extinction_per_m = static_cast<float>(extinction_per_m);
    return render::FogPainter::create(dense, bounds, look, cells.threads, progress);
}

}  // namespace sgm::cli
