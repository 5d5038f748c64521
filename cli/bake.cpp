// sgm bake and sgm merge: a city cell by cell, by as many processes as there are.
#include "grammar/pipeline/bake.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <map>

#include "cli/commands.h"
#include "cli/requests.h"
#include "cli/validators.h"
#include "cli/watch.h"
#include "modeler/core/stopwatch.h"
#include "modeler/tiles/deliver.h"

namespace sgm::cli {
namespace {

namespace fs = std::filesystem;

struct BakeOptions {
    ModelRequest model;
    pipeline::BakeRequest bake;
    std::string folder, tile = "1/1", pack = "meshopt";
    int missing = 0, threads = 0;
    bool quiet = false;
};

/// What a task did and when: a line a cell in journal/I-N.jsonl of the folder, and words for those who wait. It is no
/// part of the result, so that nothing depends on what can't be written there.
class Journal {
public:
    Journal(const BakeOptions& options, size_t cells) : options_(options), cells_(cells) {
        std::error_code ignored;
        const fs::path folder = fs::path(options.folder) / "journal";
        fs::create_directories(folder, ignored);
        std::string name = options.tile;
        std::replace(name.begin(), name.end(), '/', '-');
        file_.open(folder / (name + ".jsonl"), std::ios::app);
        std::array<char, 256> host{};
        gethostname(host.data(), host.size() - 1);
        write(fmt::format(R"("task":"{}","host":"{}","process":{},"cells":{})", options.tile, host.data(), getpid(),
                          cells));
    }

    void note(const tiles::Cell& cell, const tiles::CellFigures& figures) {
        ++made_, instances_ += figures.instances, triangles_ += figures.triangles;
        write(fmt::format(R"("cell":"{}","seconds":{:.3f},"instances":{},"triangles":{})", cell.name(), time_.seconds(),
                          figures.instances, figures.triangles));
        // A terminal has a line that is kept up to date; a job's log gets one every half a minute.
        if (options_.quiet || isatty(STDERR_FILENO) || time_.seconds() - told_ < 30) return;
        told_ = time_.seconds();
        const double left = told_ / static_cast<double>(made_) * static_cast<double>(cells_ - made_);
        fmt::print("task {}: {} of {} cells, {:.0f} s, about {:.0f} s left\n", options_.tile, made_, cells_, told_,
                   left);
        std::fflush(stdout);
    }

    void close(const Status& done, const pipeline::BakeTimes& times) {
        rusage used{};
        getrusage(RUSAGE_SELF, &used);
        const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
        const double cpu = seconds(used.ru_utime) + seconds(used.ru_stime);
        write(fmt::format(R"("done":{},"made":{},"seconds":{:.3f},"processor_s":{:.3f},"memory_MB":{})", done.ok(),
                          made_, time_.seconds(), cpu, used.ru_maxrss / 1024));
        if (!done.ok() || options_.quiet) return;
        fmt::print(
            "task {}: {} of {} cells made, {} objects placed, {} triangles; {:.2f} s (objects {:.1f}, ground "
            "{:.1f}, files {:.1f}), {:.1f} s of processor time, {} MB\n",
            options_.tile, made_, cells_, instances_, triangles_, time_.seconds(), times.objects, times.ground,
            times.cells, cpu, used.ru_maxrss / 1024);
    }

private:
    void write(const std::string& facts) {
        file_ << fmt::format("{{\"time\":{},{}}}\n", std::time(nullptr), facts) << std::flush;
    }

    const BakeOptions& options_;
    const size_t cells_;
    std::ofstream file_;
    const Stopwatch time_;
    double told_ = 0;
    uint64_t made_ = 0, instances_ = 0, triangles_ = 0;
};

Status bakeTask(BakeOptions& options) {
    const auto share = tiles::parseShare(options.tile);
    if (!share)
        return Error{
            Error::Kind::Usage,
            fmt::format("--tile {}: write I/N, task I of N, as 3/64: I is 1 … N, and N 1 … 1000000", options.tile)};
    Watch watch(options.quiet || options.missing > 0);
    Context context{watch.progress(), options.threads};
    auto model = makeModel(options.model, context, pipeline::Objects::Apart);
    if (!model.ok()) return model.error();
    model->lowered = pipeline::withoutGraph(*model->lowered);
    options.bake.folder = options.folder;
    options.bake.packing = options.pack == "none" ? tiles::Packing::None : tiles::Packing::Meshopt;
    options.bake.seeksThinParts = !options.quiet;
    options.bake.budget.shapes = options.model.shapeBudget;
    options.bake.budget.seconds = options.model.secondsBudget;
    auto bake = pipeline::Bake::begin(*model, options.bake, context);
    if (!bake.ok()) return bake.error();
    if (options.missing > 0) {
        if (const Status s = tiles::checkPlan(bake->plan(), options.folder); !s.ok()) return s;
        fmt::print("{}\n", tiles::arrayNotation(bake->missing(options.missing)));
        return Done{};
    }
    const auto [begin, end] = share->range(bake->plan().cells.size());
    Journal journal(options, end - begin);
    const Status done = bake->run(*share, context, [&](const tiles::Cell& cell, const tiles::CellFigures& figures) {
        journal.note(cell, figures);
    });
    journal.close(done, bake->times());
    if (!options.quiet) printMeshWarnings(bake->warnings());
    return done;
}

const std::map<std::string, tiles::Delivery> deliveries{
    {"blender", tiles::Delivery::Blender}, {"usd", tiles::Delivery::Usd}, {"heights", tiles::Delivery::Heights}};

struct MergeOptions {
    std::string folder, at, format;
    bool verify = false, quiet = false, progressLines = false;
};

Status mergeCells(const MergeOptions& options) {
    std::optional<tiles::EarthPlace> at;
    if (!options.at.empty()) {
        int used = 0;
        at.emplace();
        if (std::sscanf(options.at.c_str(), "%lf,%lf%n", &at->latitude_deg, &at->longitude_deg, &used) != 2 ||
            used != static_cast<int>(options.at.size()) || !(std::abs(at->latitude_deg) <= 90) ||
            !(std::abs(at->longitude_deg) <= 180))
            return Error{Error::Kind::Usage, fmt::format("--at {}: write LATITUDE,LONGITUDE in degrees, as "
                                                         "52.52,13.405: latitudes are -90 … 90, longitudes -180 … 180",
                                                         options.at)};
    }
    const Status merged = tiles::merge(options.folder, at, options.verify);
    if (!merged.ok()) return merged;
    if (!options.quiet && options.verify) fmt::print("verified: every cell is as its digest says\n");
    if (!options.quiet)
        fmt::print("wrote {0}/tileset.json\nwrote {0}/manifest.json\nwrote {0}/index.html\n", options.folder);
    if (options.format.empty()) return Done{};
    Watch watch(options.progressLines ? ProgressDisplay::Lines
                : options.quiet       ? ProgressDisplay::None
                                      : ProgressDisplay::Terminal);
    const Status made = tiles::deliver(options.folder, deliveries.at(options.format), watch.progress());
    if (made.ok() && !options.quiet) fmt::print("wrote {}/{}/\n", options.folder, options.format);
    return made;
}

}  // namespace

void addBake(CLI::App& app, int& exitCode) {
    CLI::App* command = app.add_subcommand("bake", "Make a city cell by cell, by any number of processes");
    auto options = std::make_shared<BakeOptions>();
    addModelOptions(*command, options->model);
    command->add_option("-o,--output", options->folder, "Folder of cells and library; what is done stays")->required();
    command->add_option("--tile", options->tile, "Which share of the cells to make, I/N")->capture_default_str();
    command
        ->add_option("--missing", options->missing,
                     "Make nothing; print which of so many tasks aren't done, as 3,7,12-15, for job arrays")
        ->check(wholeNumber(1, 1'000'000));
    command->add_option("--side", options->bake.side_m, "Side of the finest cells, metres")
        ->check(between(1, 1e5))
        ->capture_default_str();
    command
        ->add_option("--cell", options->bake.cell_m,
                     "Edge of a cell of the ground's grid, metres; the side is a multiple of 32 of them")
        ->check(between(1e-3, 1e4))
        ->capture_default_str();
    command
        ->add_option("--object-cell", options->bake.objectCell_m,
                     "Edge of a cell of the grid of each object that `place` puts, metres")
        ->check(between(1e-3, 1e4))
        ->capture_default_str();
    command
        ->add_option(
            "--pack", options->pack,
            "How triangles are stored: meshopt (EXT_meshopt_compression over 16-bit positions) or none (floats)")
        ->check(oneOf({"meshopt", "none"}))
        ->capture_default_str();
    command
        ->add_option("--levels", options->bake.levels,
                     "Levels of detail, each over cells twice as wide: objects, coarser ones, then their boxes")
        ->check(wholeNumber(1, 8))
        ->capture_default_str();
    command->add_option("--threads", options->threads, "Threads; 0 = all")->check(wholeNumber(0, 1024));
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
    command->add_option(
        "--at", options->at,
        "Where the model's origin lies on Earth: LATITUDE,LONGITUDE in degrees [where an earlier merge put it]");
    command
        ->add_option("--for", options->format,
                     "Write the finest cells for other programs too: plain glTF for Blender, USD, height maps")
        ->check(oneOf({"blender", "usd", "heights"}));
    command->add_flag("--verify", options->verify, "Read every cell and compare it with its digest");
    command->add_flag("-q,--quiet", options->quiet, "Say nothing but errors");
    command->add_flag("--progress", options->progressLines,
                      "Say how far `--for` is as lines `progress: STAGE PERCENT`");
    command->footer("Example:\n  sgm merge city --at 52.52,13.405");
    command->callback([options, &exitCode] {
        const Status done = mergeCells(*options);
        exitCode = done.ok() ? 0 : fail(done.error());
    });
}

}  // namespace sgm::cli
