// The library in 20 lines: a grammar in a string becomes a closed mesh in a file.
#include <cstdio>

#include "grammar/pipeline/grids.h"
#include "grammar/pipeline/load.h"
#include "grammar/pipeline/products.h"

int main() {
    using namespace sgm;
    syntax::Diagnostics problems;
    const auto grammar = pipeline::load(
        "embed.sgm", "grammar 1\nstart A -> cube size 2 : B\nrule B -> + sphere at +y to centre blend .3m\n", problems);
    for (const auto& problem : problems.all()) std::fputs(syntax::render(problem).c_str(), stderr);
    if (!grammar) return 1;

    pipeline::Context context;
    const auto model = pipeline::makeModel(grammar, *pipeline::optionsFor(*grammar, {}), context);
    if (!model.ok()) return 1;
    const auto meshed =
        pipeline::makeMesh(*model, pipeline::gridOf(*model, 96), {.surface = mesh::Surface::Crisp}, context);
    if (!meshed.ok()) return 1;
    std::printf("%zu triangles\n", meshed->mesh.triangleCount());
    for (const auto& [stage, seconds] : context.stages) std::printf("%-10s %.4f s\n", stage.c_str(), seconds);
    return pipeline::writeMesh(*model, meshed->mesh, "embed.glb", context).ok() ? 0 : 1;
}
