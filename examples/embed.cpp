// The library in 30 lines: a grammar in a string becomes a closed mesh in a file.
#include <cstdio>

#include "grammar/lower/lower.h"
#include "grammar/operations/operations.h"
#include "grammar/rules/check.h"
#include "modeler/export/exporter.h"
#include "modeler/mesh/polygonize.h"

int main() {
    using namespace sgm;
    const auto source = std::make_shared<const syntax::Source>(
        "embed.sgm", "grammar 1\nstart A -> cube size 2 : B\nrule B -> + sphere at +y to centre blend .3m\n");
    syntax::Diagnostics problems;
    const auto grammar = rules::load(source, operations::table(), {}, problems);
    for (const auto& problem : problems.all()) std::fputs(syntax::render(problem).c_str(), stderr);
    if (!grammar) return 1;

    const auto derivation = derive::derive(grammar, {}, nullptr);
    if (!derivation.ok()) return 1;
    const auto model = lower::lower(*derivation, nullptr);
    if (!model.ok()) return 1;
    const auto& [graph, field, provenance, shapes] = **model;
    const eval::Tape tape = eval::compile(graph, field, graph.constants());

    const mesh::Grid grid = mesh::gridFor(field.bounds, mesh::cellFor(field.bounds, 96));
    mesh::Counts counts;
    const auto blocks = mesh::subdivide(tape, grid, 0, nullptr, counts);
    if (!blocks.ok()) return 1;
    const auto mesh = mesh::polygonize(*blocks, grid, {}, nullptr, counts);
    if (!mesh.ok()) return 1;
    std::printf("%zu triangles from %llu field evaluations\n", mesh->triangleCount(),
                static_cast<unsigned long long>(counts.pointEvaluations));
    exporter::ExportInput input;
    input.mesh = &*mesh;
    input.provenance = &provenance;
    return exporter::write(input, "embed.glb").ok() ? 0 : 1;
}
