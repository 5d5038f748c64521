// bench: field → mesh beside a dense sweep of the same tape with the same SIMD, measured in one run.
// The sweep only evaluates the corners of every cell; it makes no triangles, so the ratio flatters it.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <fstream>
#include <sstream>

#include "grammar/lower/lower.h"
#include "grammar/rules/check.h"
#include "modeler/core/parallel.h"
#include "modeler/eval/evaluate.h"
#include "modeler/mesh/polygonize.h"

namespace {

using namespace sgm;

double secondsNow() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

struct Scene {
    derive::Derivation derivation;
    std::unique_ptr<lower::Model> model;
    eval::Tape tape;
};

syntax::SourcePtr readSource(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return file ? std::make_shared<const syntax::Source>(path, text.str()) : nullptr;
}

Result<Scene> loadScene(const std::string& path) {
    const auto source = readSource(path);
    if (!source) return Error{Error::Kind::Input, "can't read " + path};
    syntax::Diagnostics diagnostics;
    const rules::Loader loader = [](const std::string& name, const syntax::Source&, std::string& why) {
        why = "not found";
        return readSource("grammar/" + name);
    };
    auto grammar = rules::load(source, loader, diagnostics);
    if (!grammar) return Error{Error::Kind::Input, syntax::render(diagnostics.all().front())};
    auto derivation = derive::derive(grammar, {}, nullptr);
    if (!derivation.ok()) return derivation.error();
    auto model = lower::lower(*derivation, nullptr);
    if (!model.ok()) return model.error();
    eval::Tape tape = eval::compile((*model)->graph, (*model)->field, (*model)->graph.constants());
    return Scene{std::move(*derivation), std::move(*model), std::move(tape)};
}

/// Seconds to evaluate the tape at every corner of the grid, slab by slab, each slab a row of points at a time.
double denseSweep(const Scene& scene, const mesh::Grid& grid, int threads) {
    const double start = secondsNow();
    const Vec3i n = grid.cells + Vec3i{1, 1, 1};
    std::vector<eval::Workspace> workspaces(static_cast<size_t>(threadCount(threads)));
    parallelFor(static_cast<size_t>(n.z), threads, nullptr, [&](size_t k, int worker) {
        std::vector<float> x(n.x), y(n.x), z(n.x), out(n.x);
        for (int j = 0; j < n.y; ++j) {
            for (int i = 0; i < n.x; ++i) {
                const Vec3f p = grid.corner(i, j, static_cast<int>(k));
                x[i] = p.x, y[i] = p.y, z[i] = p.z;
            }
            eval::evaluate(scene.tape, {x.data(), y.data(), z.data(), static_cast<size_t>(n.x)}, out.data(), workspaces[worker]);
        }
    });
    return secondsNow() - start;
}

struct Row {
    double mesh_s = 0, dense_s = 0;
    mesh::Counts counts;
    size_t triangles = 0;
};

Result<Row> measure(const Scene& scene, int resolution, int threads, int repeats) {
    const Box3f bounds = scene.model->field.bounds;
    const mesh::Grid grid = mesh::gridFor(bounds, mesh::cellFor(bounds, resolution));
    Row best;
    best.mesh_s = 1e30;
    for (int r = 0; r < repeats; ++r) {  // the best of a few: the machine's noise only ever adds
        mesh::Counts counts;
        const double start = secondsNow();
        const auto blocks = mesh::subdivide(scene.tape, grid, threads, nullptr, counts);
        if (!blocks.ok()) return blocks.error();
        const auto mesh = mesh::polygonize(*blocks, grid, {.threads = threads}, nullptr, counts);
        if (!mesh.ok()) return mesh.error();
        best.mesh_s = std::min(best.mesh_s, secondsNow() - start);
        best.counts = counts;
        best.triangles = mesh->triangleCount();
    }
    best.dense_s = denseSweep(scene, grid, threads);
    return best;
}

}  // namespace

int main(int argc, char** argv) {
    std::vector<std::string> files;
    std::vector<int> resolutions;
    int threads = 2, repeats = 3;
    CLI::App app{"bench: field to mesh against a dense SIMD sweep of the same tape"};
    app.add_option("FILE", files, "Grammars (default: the examples)");
    app.add_option("--resolution", resolutions, "Cells along the longest side; may be given again");
    app.add_option("--threads", threads, "Threads")->capture_default_str();
    app.add_option("--repeats", repeats, "Runs of ours; the best counts")->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    if (files.empty()) files = {"examples/grotto.sgm", "examples/cumulus.sgm", "examples/tower.sgm"};
    if (resolutions.empty()) resolutions = {256, 512};

    fmt::print("{:24} {:>5} {:>8} {:>10} {:>10} {:>7} {:>12} {:>10} {:>12}\n", "scene", "res", "tape", "mesh s", "dense s", "ratio", "evals/cell",
               "triangles", "ns/triangle");
    for (const std::string& file : files) {
        const auto scene = loadScene(file);
        if (!scene.ok()) {
            fmt::print(stderr, "{}\n", scene.error().message);
            return 1;
        }
        for (const int resolution : resolutions) {
            const auto row = measure(*scene, resolution, threads, repeats);
            if (!row.ok()) {
                fmt::print(stderr, "{}: {}\n", file, row.error().message);
                return 1;
            }
            fmt::print("{:24} {:>5} {:>8} {:>10.4f} {:>10.4f} {:>6.1f}x {:>12.2f} {:>10} {:>12.1f}\n", file, resolution, scene->tape.size(), row->mesh_s,
                       row->dense_s, row->dense_s / row->mesh_s,
                       static_cast<double>(row->counts.pointEvaluations) / static_cast<double>(std::max<uint64_t>(1, row->counts.surfaceCells)),
                       row->triangles, 1e9 * row->mesh_s / static_cast<double>(std::max<size_t>(1, row->triangles)));
        }
    }
    return 0;
}
