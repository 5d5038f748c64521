#include "cli/levels.h"

#include <fmt/format.h>

#include "modeler/mesh/edit.h"

namespace sgm::cli {

Result<std::vector<mesh::LevelOfDetail>> makeLevels(const LevelRequest& request, const Model& model,
                                                    const mesh::Mesh& finest, Progress* progress) {
    const int threads = request.meshing.threads;
    const auto meshAt = [&](float cell_m) -> Result<mesh::Mesh> {
        Stages stages;
        const mesh::Grid grid = mesh::gridFor(model.lowered->field.bounds, cell_m);
        auto meshed = makeMesh(model, grid, request.meshing, stages, progress);
        if (!meshed.ok()) return meshed.error();
        mesh::keepOnly(meshed->mesh, request.keep, cell_m, threads);
        if (request.inward) mesh::turnInsideOut(meshed->mesh);
        return std::move(meshed->mesh);
    };
    return mesh::makeLevels(finest, {request.count - 1, threads, request.cell_m, meshAt}, progress);
}

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
