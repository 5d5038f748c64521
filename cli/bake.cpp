// sgm bake and sgm merge: a city cell by cell, by as many processes as there are.
#include "grammar/pipeline/bake.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>

#include "cli/commands.h"
#include "cli/numbers.h"
#include "cli/requests.h"
#include "cli/watch.h"
#include "modeler/core/stopwatch.h"

namespace sgm::cli {
namespace {

struct BakeOptions {
    ModelRequest model;
    pipeline::BakeRequest bake;
    std::string folder, tile = "1/1";
    int missing = 0, threads = 0;
    bool quiet = false;
};

Status bakeTask(BakeOptions& options) {
    const auto share = tiles::parseShare(options.tile);
    if (!share)
        return Error{Error::Kind::Usage, fmt::format("--tile {}: write I/N, task I of N, as 3/64", options.tile)};
    Watch watch(options.quiet || options.missing > 0);
    Context context{watch.progress(), options.threads};
    const auto model = makeModel(options.model, context, pipeline::Objects::Apart);
    if (!model.ok()) return model.error();
    options.bake.folder = options.folder;
    options.bake.budget.shapes = options.model.shapeBudget;
    options.bake.budget.seconds = options.model.secondsBudget;
    auto bake = pipeline::Bake::begin(*model, options.bake, context);
    if (!bake.ok()) return bake.error();
    if (options.missing > 0) {
        fmt::print("{}\n", tiles::arrayNotation(bake->missing(options.missing)));
        return Done{};
    }
    const Stopwatch time;
    uint64_t cells = 0, instances = 0, triangles = 0;
    const Status done = bake->run(*share, context, [&](const tiles::Cell&, const tiles::CellFigures& figures) {
        ++cells, instances += figures.instances, triangles += figures.triangles;
    });
    if (!done.ok()) return done;
    if (!options.quiet)
        fmt::print("task {}: {} of {} cells made, {} objects placed, {} triangles; {:.2f} s\n", options.tile, cells,
                   share->range(bake->plan().cells.size()).second - share->range(bake->plan().cells.size()).first,
                   instances, triangles, time.seconds());
    return Done{};
}

struct MergeOptions {
    std::string folder, at;
    bool verify = false, quiet = false;
};

Status mergeCells(const MergeOptions& options) {
    std::optional<tiles::EarthPlace> at;
    if (!options.at.empty()) {
        int used = 0;
        at.emplace();
        if (std::sscanf(options.at.c_str(), "%lf,%lf%n", &at->latitude_deg, &at->longitude_deg, &used) != 2 ||
            used != static_cast<int>(options.at.size()) || !(std::abs(at->latitude_deg) <= 90) ||
            !(std::abs(at->longitude_deg) <= 180))
            return Error{Error::Kind::Usage,
                         fmt::format("--at {}: write LATITUDE,LONGITUDE in degrees, as 52.52,13.405", options.at)};
    }
    const Status merged = tiles::merge(options.folder, at, options.verify);
    if (merged.ok() && !options.quiet) fmt::print("wrote {0}/tileset.json\nwrote {0}/manifest.json\n", options.folder);
    return merged;
}

}  // namespace

void addBake(CLI::App& app, int& exitCode) {
    CLI::App* command = app.add_subcommand("bake", "Make a city cell by cell, by any number of processes");
    auto options = std::make_shared<BakeOptions>();
    addModelOptions(*command, options->model);
    command->add_option("-o,--output", options->folder, "Folder of cells and library; what is done already stays")
        ->required();
    command->add_option("--tile", options->tile, "Which share of the cells to make, I/N")->capture_default_str();
    command
        ->add_option("--missing", options->missing,
                     "Make nothing; print which of so many tasks aren't done, as 3,7,12-15, for job arrays")
        ->check(CLI::Range(1, 1'000'000));
    command->add_option("--side", options->bake.side_m, "Side of the finest cells, metres")
        ->check(between(1, 1e5))
        ->capture_default_str();
    command
        ->add_option("--cell", options->bake.cell_m,
                     "Edge of a cell of the ground's grid, metres; the side is a multiple of 32 of them")
        ->check(between(1e-3, 1e4))
        ->capture_default_str();
    command->add_option("--object-cell", options->bake.objectCell_m, "The same of objects that `place` puts")
        ->check(between(1e-3, 1e4))
        ->capture_default_str();
    command
        ->add_option("--levels", options->bake.levels,
                     "Levels of detail, each over cells twice as wide: objects, coarser ones, then their boxes")
        ->check(CLI::Range(1, 8))
        ->capture_default_str();
    command->add_option("--threads", options->threads, "Threads; 0 = all")->check(CLI::Range(0, 1024));
    command->add_flag("-q,--quiet", options->quiet, "Say nothing but errors");
    command->footer(
        "Examples:\n  sgm bake examples/city/town.sgm -o city && sgm merge city\n"
        "  sgm bake town.sgm -o city --tile 3/64 --threads 1\n  sgm bake town.sgm -o city --missing 64");
    command->callback([options, &exitCode] {
        const Status done = bakeTask(*options);
        exitCode = done.ok() ? 0 : fail(done.error());
    });
}

void addMerge(CLI::App& app, int& exitCode) {
    CLI::App* command = app.add_subcommand("merge", "Write the tileset and manifest of a baked folder (3D Tiles 1.1)");
    auto options = std::make_shared<MergeOptions>();
    command->add_option("FOLDER", options->folder, "What `sgm bake` wrote")->required();
    command->add_option("--at", options->at, "Where the model's origin lies on Earth: LATITUDE,LONGITUDE in degrees");
    command->add_flag("--verify", options->verify, "Read every cell and compare it with its digest");
    command->add_flag("-q,--quiet", options->quiet, "Say nothing but errors");
    command->footer("Example:\n  sgm merge city --at 52.52,13.405");
    command->callback([options, &exitCode] {
        const Status done = mergeCells(*options);
        exitCode = done.ok() ? 0 : fail(done.error());
    });
}

}  // namespace sgm::cli
