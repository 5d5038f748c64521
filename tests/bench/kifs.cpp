#include "tests/bench/kifs.h"

#include <fmt/format.h>

#include <cmath>

#include "modeler/core/random.h"
#include "modeler/eval/tally.h"
#include "modeler/field/facade_op.h"
#include "modeler/field/ops.h"
#include "modeler/mesh/polygonize.h"
#include "modeler/mesh/subdivide.h"

namespace sgm::bench {
namespace {

/// Places in a box, in caches near the processor.
struct Batch {
    std::vector<float> x, y, z, out;
    Batch(const Box3f& box, size_t n) : out(n) {
        for (size_t i = 0; i < n; ++i) {
            const auto draw = [&](int axis) {
                return static_cast<float>(uniform(combine(i, static_cast<uint64_t>(axis)), box.lo[axis], box.hi[axis]));
            };
            x.push_back(draw(0)), y.push_back(draw(1)), z.push_back(draw(2));
        }
    }
    eval::Points points() const { return {x.data(), y.data(), z.data(), x.size()}; }
};

/// Seconds of one call each, the least of a few rounds in which both take turns.
template <class A, class B>
std::pair<double, double> leastOf(Clock clock, const A& a, const B& b) {
    constexpr int rounds = 30, calls = 20;
    double least[2] = {1e30, 1e30};
    for (int round = 0; round < rounds; ++round) {
        const Stopwatch forA(clock);
        for (int i = 0; i < calls; ++i) a();
        least[0] = std::min(least[0], forA.seconds() / calls);
        const Stopwatch forB(clock);
        for (int i = 0; i < calls; ++i) b();
        least[1] = std::min(least[1], forB.seconds() / calls);
    }
    return {least[0], least[1]};
}

Result<std::string> foldingRow(const SceneEntry& entry, Clock clock) {
    const auto grammar = loadGrammar(entry);
    if (!grammar.ok()) return grammar.error();
    const auto scene = makeScene(*grammar, {.threads = 1, .clock = clock});
    if (!scene.ok()) return scene.error();
    if (!scene->reference || !scene->reference->fractal)
        return Error{Error::Kind::Internal, fmt::format("{}: no fractal", entry.name)};
    Batch batch(scene->model->field.bounds, 4096);
    const Fractal& fractal = *scene->reference->fractal;
    eval::Workspace workspace;
    eval::evaluate(scene->tape, batch.points(), batch.out.data(), workspace);
    const std::vector<float> ours = batch.out;
    if (!foldByHand(fractal, batch.points(), batch.out.data()))
        return Error{Error::Kind::Input, "--kifs: this processor has no AVX-512 to compare with"};
    for (size_t i = 0; i < ours.size(); ++i)
        if (std::abs(ours[i] - batch.out[i]) > 1e-4f)
            return Error{Error::Kind::Internal, fmt::format("{}: the loop computes something else", entry.name)};
    const auto [tape, hand] = leastOf(
        clock, [&] { eval::evaluate(scene->tape, batch.points(), batch.out.data(), workspace); },
        [&] { foldByHand(fractal, batch.points(), batch.out.data()); });
    const int folds = fractal.passes;
    const auto rate = [&](double seconds) { return 1e-6 * 4096 * folds / seconds; };
    return fmt::format("| {} | {} | {:.0f} | {:.0f} | {:.2f} |\n", entry.name, folds, rate(tape), rate(hand),
                       hand / tape);
}

/// The shells of a facade, and from where on they decide.
struct Shells {
    eval::Tape outer, inner;
    float most = 0, deepest = 0;
};

Shells shellsOf(const lower::Model& model) {
    using field::ops::Facade;
    const field::Graph& graph = model.graph;
    for (field::NodeId id = 0; id < graph.nodeCount(); ++id) {
        if (graph.node(id).op != field::codeOf<Facade>) continue;
        const auto operands = graph.operands(id);
        const auto tapeOf = [&](size_t operand) {
            field::Field shell = model.field;
            shell.value = field::NodeRef(const_cast<field::Graph*>(&graph), operands[operand].node);
            return eval::compile(graph, shell, graph.constants());
        };
        const auto number = [&](size_t operand) { return graph.constants()[graph.node(operands[operand].node).data]; };
        return {tapeOf(Facade::outer), tapeOf(Facade::inner), number(Facade::most), number(Facade::deepest)};
    }
    return {};
}

/// Places, and how many of them a shell decides; the same for runs of sixteen, as a vector takes them.
struct Decided {
    uint64_t places = 0, alone = 0, together = 0;
};

/// Over the corners of a block.
void count(const Shells& shells, const mesh::Grid& grid, Vec3i block, eval::Workspace& workspace, Decided& into) {
    constexpr int n = mesh::blockCells, vector = 16;
    std::vector<float> x, y, z, outer, inner;
    for (int k = 0; k < n; ++k)
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) {
                const Vec3f p = grid.corner(block.x * n + i, block.y * n + j, block.z * n + k);
                x.push_back(p.x), y.push_back(p.y), z.push_back(p.z);
            }
    outer.resize(x.size()), inner.resize(x.size());
    const eval::Points points{x.data(), y.data(), z.data(), x.size()};
    eval::evaluate(shells.outer, points, outer.data(), workspace);
    eval::evaluate(shells.inner, points, inner.data(), workspace);
    for (size_t first = 0; first < x.size(); first += vector) {
        uint64_t here = 0;
        for (size_t i = first; i < first + vector; ++i) here += outer[i] >= shells.most || inner[i] <= -shells.deepest;
        into.places += vector, into.alone += here, into.together += here == vector ? vector : 0;
    }
}

uint64_t foldedPoints(const eval::Tally& tally) {
    uint64_t points = 0;
    for (const auto& [operation, n] : tally)
        if (operation.op == field::codeOf<field::ops::Facade> && operation.asked == eval::EvaluationKind::Value)
            points += n;
    return points;
}

Result<std::string> shellRow(const SceneEntry& entry) {
    const auto grammar = loadGrammar(entry);
    if (!grammar.ok()) return grammar.error();
    const auto scene = makeScene(*grammar, {.threads = 1});
    if (!scene.ok()) return scene.error();
    const Box3f& bounds = scene->model->field.bounds;
    const mesh::Grid grid = mesh::gridFor(bounds, mesh::cellFor(bounds, 256));
    mesh::Counts counts;
    const auto blocks = mesh::subdivide(scene->tape, grid, 2, nullptr, counts);
    if (!blocks.ok()) return blocks.error();
    eval::Tally tally;
    const auto mesh = mesh::polygonize(*blocks, grid, {.threads = 2, .tally = &tally}, nullptr, counts);
    if (!mesh.ok()) return mesh.error();

    const Shells shells = shellsOf(*scene->model);
    eval::Workspace workspace;
    Decided everywhere, sampled;
    const auto along = [](int cells) { return (cells + mesh::blockCells) / mesh::blockCells; };
    for (int k = 0; k < along(grid.cells.z); ++k)
        for (int j = 0; j < along(grid.cells.y); ++j)
            for (int i = 0; i < along(grid.cells.x); ++i) count(shells, grid, {i, j, k}, workspace, everywhere);
    for (const mesh::Block& b : *blocks) count(shells, grid, b.index, workspace, sampled);
    const auto percent = [](uint64_t part, uint64_t whole) {
        return 100.0 * static_cast<double>(part) / static_cast<double>(whole);
    };
    const uint64_t asked = counts.pointEvaluations + counts.refinementEvaluations;
    return fmt::format("| {} | {:.0f} % | {:.0f} % | {:.0f} % | {:.0f} % | {:.0f} % |\n", entry.start,
                       percent(everywhere.alone, everywhere.places), percent(everywhere.together, everywhere.places),
                       percent(sampled.together, sampled.places), percent(asked, everywhere.places),
                       percent(foldedPoints(tally), everywhere.places));
}

constexpr const char* facades = "tests/bench/scenes/facades.sgm";
constexpr SceneEntry shelled[] = {{"facades", facades, "Palazzo"}, {"facades", facades, "Tracery"},
                                  {"facades", facades, "Loggia"},  {"facades", facades, "Grid"},
                                  {"facades", facades, "Court"},   {"facades", facades, "Arena"}};

}  // namespace

Result<std::string> kifsTables(Clock clock) {
    std::string text = "| fractal | folds | million folds/s, tape | AVX-512 by hand | share |\n|---|---|---|---|---|\n";
    for (const char* name : {"S2-folded-3", "S2-folded-4", "S9"})
        for (const SceneEntry& entry : findScenes(name)) {
            const auto row = foldingRow(entry, clock);
            if (!row.ok()) return row;
            text += *row;
        }
    text +=
        "\n| facade at 256 | a shell decides | whole vectors | in blocks with surface | mesher asks | of it folded "
        "|\n|---|---|---|---|---|---|\n";
    for (const SceneEntry& entry : shelled) {
        const auto row = shellRow(entry);
        if (!row.ok()) return row;
        text += *row;
    }
    return text;
}

}  // namespace sgm::bench
