// bench: field to mesh beside dense sweeps, OpenVDB, VTK and the limits of the machine, all measured in one run.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>

#include "modeler/core/parallel.h"
#include "tests/bench/city.h"
#include "tests/bench/derivation.h"
#include "tests/bench/gallery.h"
#include "tests/bench/kifs.h"
#include "tests/bench/meshes.h"
#include "tests/bench/pictures.h"
#include "tests/bench/plan_costs.h"
#include "tests/bench/report.h"

namespace {

using namespace sgm;
using namespace sgm::bench;

struct Request {
    std::vector<std::string> files, scenes;
    std::vector<int> resolutions;
    MeasureOptions measure;
    std::string json, drag, gallery;
    bool bars = false, cpu = false, noPeers = false, noDense = false, kifs = false, pictures = false;
    bool meshes = false, crossings = false, city = false, plan = false, derive = false;
    double buildings = 1e6;
    std::string only;
    int sides = MeshesOptions{}.sides;
};

void addOptions(CLI::App& app, Request& request) {
    app.add_option("FILE", request.files, "Grammars to measure besides the scenes named");
    app.add_option("--scene", request.scenes,
                   "S1 … S10, a variant (S2-csg-4), an example (grotto); may be given again");
    app.add_option("--resolution", request.resolutions,
                   "Cells along the longest side (default 256); may be given again")
        ->check(CLI::Range(2, 8192));
    app.add_option("--threads", request.measure.running.threads, "Threads (0: all)")
        ->check(CLI::Range(0, 1024))
        ->capture_default_str();
    app.add_option("--repeats", request.measure.repeats, "Rounds; of every contestant the best run counts")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    app.add_flag(
        "--cpu", request.cpu,
        "Count the processor's time over the threads instead of the wall's: for machines busy with other work");
    app.add_flag("--bars", request.bars,
                 "Judge the bars of docs/performance.md; all their scenes and resolutions, unless some are given");
    app.add_option(
        "--drag", request.drag,
        "Drag this parameter of the scenes: a build that keeps what the change doesn't reach, beside a full one");
    app.add_option("--gallery", request.gallery,
                   "Measure the objects of this list (docs/gallery.txt) instead, and print the page's section");
    app.add_flag("--kifs", request.kifs, "Measure the folding of fractals and what the shells of facades save instead");
    app.add_flag("--pictures", request.pictures,
                 "Measure pictures of fields at 640 x 640 instead, and judge what the window asks of itself");
    auto* city =
        app.add_flag("--city", request.city,
                     "Measure what baking cities costs instead; what takes long is projected from a share of it");
    app.add_option("--buildings", request.buildings, "Leave larger cities out of --city")
        ->needs(city)
        ->check(CLI::Range(1e3, 1e6))
        ->capture_default_str();
    app.add_option("--only", request.only, "Measure those cities of --city whose name has this in it")->needs(city);
    app.add_flag("--plan", request.plan, "Measure what the plans of cities cost instead: roads, blocks and lots");
    app.add_flag("--derive", request.derive,
                 "Measure what comes before the tape instead: derivation, lowering, plans of files, L-systems");
    auto* meshes =
        app.add_flag("--meshes", request.meshes,
                     "Hold meshes of buildings against exact solid geometry instead (needs node and manifold-3d)");
    app.add_flag("--crossings", request.crossings, "Let CGAL count the crossing pairs of triangles of --meshes")
        ->needs(meshes);
    app.add_option("--sides", request.sides, "Sides of round solids in the exact models of --meshes, a multiple of 4")
        ->needs(meshes)
        ->check(CLI::Range(132, 65536))
        ->capture_default_str();
    app.add_flag("--no-dense", request.noDense, "Leave the dense sweeps out");
    app.add_flag("--no-peers", request.noPeers, "Leave OpenVDB and VTK out");
    app.add_option("--json", request.json, "Write all figures to this file");
}

/// The scenes asked for; the examples and the quick ones of S1 … S10 where none are.
Result<std::vector<SceneEntry>> chooseScenes(const Request& request) {
    std::vector<std::string> names = request.scenes;
    if (names.empty() && request.files.empty())
        names = request.bars
                    ? std::vector<std::string>{"S1", "S2-csg-4", "S2-folded-4", "S3", "S4", "S5",
                                               "S6", "S7",       "S8",          "S9", "S10"}
                    : std::vector<std::string>{"grotto", "cumulus", "tower", "S1", "S3", "S4", "S5", "S6", "S7"};
    std::vector<SceneEntry> chosen;
    for (const std::string& name : names) {
        const auto found = findScenes(name);
        if (found.empty()) return Error{Error::Kind::Usage, "no scene is called '" + name + "'"};
        chosen.insert(chosen.end(), found.begin(), found.end());
    }
    for (const std::string& file : request.files) chosen.push_back({file, file, ""});
    return chosen;
}

/// The parameter to drag in a scene, "" for none.
std::string dragged(const Request& request, std::string_view scene) {
    return request.drag.empty() && request.bars && scene == "S10" ? "corner" : request.drag;
}

Status measureAll(const Request& request, const std::vector<SceneEntry>& scenes, const Limits& limits, Measured& out) {
    for (const SceneEntry& entry : scenes) {
        const auto grammar = loadGrammar(entry);
        if (!grammar.ok()) return grammar.error();
        const auto scene = makeScene(*grammar, request.measure.running);
        if (!scene.ok()) return scene.error();
        for (const int resolution : request.resolutions) {
            MeasureOptions options = request.measure;
            options.oneThread = request.bars && resolution == 512 && options.running.threads > 1;
            const auto m = measure(*scene, resolution, options);
            if (!m.ok()) return Error{m.error().kind, fmt::format("{}: {}", entry.name, m.error().message)};
            fmt::print("{}\n", tableRow(*m, limits));
            std::fflush(stdout);
            out.scenes.push_back(*m);
            const std::string parameter = dragged(request, entry.name);
            if (parameter.empty()) continue;
            const auto drag = measureDrag(*grammar, parameter, resolution, options.repeats, options.running);
            if (!drag.ok()) return Error{drag.error().kind, fmt::format("{}: {}", entry.name, drag.error().message)};
            fmt::print("{}\n", dragLine(*drag));
            std::fflush(stdout);
            out.drags.push_back(*drag);
        }
    }
    return Done{};
}

/// What the bars ask of memory alone: ours, once.
constexpr std::pair<const char*, int> largeRuns[] = {{"S3", 1024}, {"S5", 2048}};

Status measureLarge(Request request, const Limits& limits, Measured& out) {
    request.measure.dense = request.measure.peers = false;
    request.measure.repeats = 1;
    for (const auto& [name, resolution] : largeRuns) {
        request.resolutions = {resolution};
        const auto entries = findScenes(name);
        if (Status status = measureAll(request, {entries.begin(), entries.end()}, limits, out); !status) return status;
    }
    return Done{};
}

Status writeFile(const std::string& path, const std::string& text) {
    std::ofstream file(path, std::ios::binary);
    file << text;
    file.close();
    if (!file) return Error{Error::Kind::Input, "can't write " + path};
    return Done{};
}

/// The table of --meshes.
Status runMeshes(const Request& request) {
    if (request.sides % 4 != 0) return Error{Error::Kind::Usage, "--sides is a multiple of 4"};
    MeshesOptions options{request.scenes,          request.resolutions, request.sides,
                          request.measure.repeats, request.crossings,   request.measure.running};
    options.scenes.insert(options.scenes.end(), request.files.begin(), request.files.end());
    const auto rows = measureMeshes(options);
    if (!rows.ok()) return rows.error();
    return request.json.empty() ? Status(Done{}) : writeFile(request.json, meshesJson(*rows, options));
}

/// The table of --city.
Status runCity(double mostBuildings, const std::string& only) {
    fmt::print("{}\n", cityHeader());
    std::fflush(stdout);
    std::vector<CityCosts> all;
    for (const CityCase& what : cityCases(mostBuildings)) {
        if (what.name.find(only) == std::string::npos) continue;
        const auto costs = measureCity(what);
        if (!costs.ok()) return costs.error();
        fmt::print("{}\n", cityLine(*costs));
        std::fflush(stdout);
        all.push_back(*costs);
    }
    fmt::print("* projected from the cells that were baked\n");
    for (const Bar& bar : judge(all)) fmt::print("{}\n", barLine(bar));
    return Done{};
}

/// The table of --plan.
void runPlan() {
    fmt::print("{}\n", planHeader());
    std::vector<PlanCosts> all;
    for (const PlanCase& what : planCases()) {
        all.push_back(measurePlan(what));
        fmt::print("{}\n", planLine(all.back()));
        std::fflush(stdout);
    }
    std::vector<Bar> bars = judge(all);
    if (const auto slider_s = measureSlider("examples/city/town.sgm"); slider_s.ok())
        bars.push_back({"examples/city/town.sgm, s from a slider to its plan", .1, false, *slider_s, ""});
    for (const Bar& bar : bars) fmt::print("{}\n", barLine(bar));
}

/// The table of --derive.
Status runDerive() {
    const auto bars = measureDerivation();
    if (!bars.ok()) return bars.error();
    for (const Bar& bar : *bars) fmt::print("{}\n", barLine(bar));
    return Done{};
}

int fail(const Error& error) {
    fmt::print(stderr, "{}\n", error.message);
    return error.kind == Error::Kind::Usage ? 2 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    Request request;
    CLI::App app{"bench: field to mesh beside dense SIMD sweeps, OpenVDB, VTK and the machine's limits"};
    addOptions(app, request);
    CLI11_PARSE(app, argc, argv);
    if (request.cpu) request.measure.running.clock = Clock::Processor;
    request.measure.running.threads = threadCount(request.measure.running.threads);
    if (request.meshes) {
        const Status done = runMeshes(request);
        return done.ok() ? 0 : fail(done.error());
    }
    if (request.plan) {
        runPlan();
        return 0;
    }
    if (request.derive) {
        const Status done = runDerive();
        return done.ok() ? 0 : fail(done.error());
    }
    if (request.city) {
        const Status done = runCity(request.buildings, request.only);
        return done.ok() ? 0 : fail(done.error());
    }
    const bool everything = request.bars && request.resolutions.empty() && request.scenes.empty();
    if (request.resolutions.empty())
        request.resolutions = request.bars ? std::vector<int>{64, 256, 512} : std::vector<int>{256};
    request.measure.peers = !request.noPeers;
    request.measure.dense = !request.noDense;

    if (!request.gallery.empty() || request.kifs) {
        const auto section =
            request.kifs ? kifsTables(request.measure.running.clock) : galleryTimes(request.gallery, request.measure);
        if (!section.ok()) return fail(section.error());
        fmt::print("{}", *section);
        return 0;
    }
    if (request.pictures) {
        const auto pictures = measurePictures(request.measure.repeats, request.measure.running);
        if (!pictures.ok()) return fail(pictures.error());
        fmt::print("{}\n", pictureTable(*pictures));
        for (const Bar& bar : judge(*pictures)) fmt::print("{}\n", barLine(bar));
        return 0;
    }
    const auto scenes = chooseScenes(request);
    if (!scenes.ok()) return fail(scenes.error());
    const Limits limits = measureLimits(request.measure.running);
    fmt::print("{}\n{}\n", limitsLine(limits, request.measure.running.threads), tableHeader());
    Measured measured;
    if (Status status = measureAll(request, *scenes, limits, measured); !status) return fail(status.error());
    if (everything)
        if (Status status = measureLarge(request, limits, measured); !status) return fail(status.error());
    if (request.bars) {
        measured.bars = judge(measured.scenes, measured.drags, limits);
        fmt::print("\n");
        for (const Bar& bar : measured.bars) fmt::print("{}\n", barLine(bar));
    }
    if (request.json.empty()) return 0;
    const Status written = writeFile(request.json, toJson(measured, limits, request.measure.running.threads));
    return written.ok() ? 0 : fail(written.error());
}
