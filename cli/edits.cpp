#include "cli/edits.h"

#include <CLI/CLI.hpp>
#include <map>

#include "cli/numbers.h"
#include "modeler/mesh/edit.h"
#include "modeler/mesh/simplify.h"

namespace sgm::cli {

void addEditOptions(CLI::App& command, EditRequest& request) {
    command
        .add_option("--keep", request.keep,
                    "Which separate solids stay: all, those that stand and aren't debris, or the largest one; the "
                    "latter two fill closed cavities")
        ->check(CLI::IsMember({"all", "grounded", "largest"}))
        ->capture_default_str();
    command.add_option("--smooth", request.smooth, "Passes of Laplacian smoothing")->check(CLI::Range(0, 1000));
    auto* share = command.add_option("--simplify", request.simplify, "Simplify to at most this share of the triangles");
    share->check(between(0.001, 1));
    command
        .add_option("--tolerance", request.tolerance_m,
                    "How far simplification may move the surface: 5mm, 2cm, .01m; 0 keeps all [a crisp mesh: .01 cell]")
        ->transform(CLI::AsNumberWithUnit(std::map<std::string, double>{{"mm", .001}, {"cm", .01}, {"m", 1}}))
        ->check(between(0, 1e6))
        ->excludes(share);
}

mesh::Keep keepOf(const EditRequest& request) {
    return request.keep == "all"        ? mesh::Keep::All
           : request.keep == "grounded" ? mesh::Keep::Grounded
                                        : mesh::Keep::Largest;
}

double toleranceOf(const EditRequest& request, mesh::Surface surface, float cell_m) {
    if (request.tolerance_m) return *request.tolerance_m;
    return surface == mesh::Surface::Crisp && request.smooth == 0 ? mesh::usualTolerance(cell_m) : 0;
}

Result<mesh::Mesh> edited(mesh::Mesh mesh, const EditRequest& request, const GridRequest& grid, float cell_m,
                          Stages& stages, Progress* progress) {
    if (request.smooth > 0) {
        auto result = timed(stages, "smooth", [&] { return mesh::smooth(mesh, request.smooth, progress); });
        if (!result.ok()) return result;
        mesh = std::move(*result);
    }
    const double tolerance_m = toleranceOf(request, grid.surface, cell_m);
    if ((request.simplify < 1 || tolerance_m > 0) && mesh.triangleCount() > 0) {
        auto result = timed(stages, "simplify", [&] {
            return request.simplify < 1 ? mesh::simplifyToShare(mesh, request.simplify, grid.threads, progress)
                                        : mesh::simplify(mesh, {tolerance_m, grid.threads}, progress);
        });
        if (!result.ok()) return result;
        mesh = std::move(*result);
    }
    return mesh;
}

}  // namespace sgm::cli
