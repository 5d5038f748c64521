#include "cli/levels.h"

#include <fmt/format.h>

namespace sgm::cli {

std::string levelTable(const std::vector<mesh::LevelOfDetail>& levels, size_t finest) {
    std::string table;
    for (size_t i = 0; i < levels.size(); ++i) {
        const mesh::LevelOfDetail& level = levels[i];
        const size_t triangles = level.mesh.triangleCount();
        const std::string how = level.cell_m > 0 ? fmt::format("cells of {:.3g} m", level.cell_m)
                                                 : fmt::format("within {:.3g} m", level.tolerance_m);
        table += fmt::format("level {}: {} triangles, {}, up to 1/{:.0f} of the picture's height\n", i + 1, triangles,
                             how, 1 / level.coverage);
        if (triangles >= (i == 0 ? finest : levels[i - 1].mesh.triangleCount()))
            table += fmt::format("level {} has no fewer triangles than level {}: take fewer levels\n", i + 1, i);
    }
    return table;
}

}  // namespace sgm::cli
