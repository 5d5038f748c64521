#include "tests/bench/derivation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>

#include "grammar/derive/lsystem.h"
#include "grammar/lower/lower.h"
#include "grammar/pipeline/grids.h"
#include "grammar/pipeline/load.h"
#include "grammar/pipeline/meshing.h"
#include "grammar/rules/params.h"
#include "modeler/core/conventions.h"
#include "modeler/eval/tape.h"
#include "tests/bench/stopwatch.h"
#include "tests/scratch.h"

namespace sgm::bench {
namespace {

constexpr int resolution = 512;
constexpr double fullTurn = 2 * pi;
constexpr size_t buildings = 10'000, edges = 16;
using Asks = WallCase::Asks;

std::vector<WallCase> wallCases() {
    return {{"60 thousand", 180, 146, Asks::Nothing, 0, true},
            {"60 thousand, few ask", 180, 146, Asks::Few, 0, false},
            {"60 thousand, all ask", 180, 146, Asks::All, 0, false},
            {"60 thousand, turned", 180, 146, Asks::Nothing, 30, true},
            {"1.25 million", 816, 660, Asks::Nothing, 0, false},
            {"1.25 million, few ask", 816, 660, Asks::Few, 0, false},
            {"1.25 million, all ask", 816, 660, Asks::All, 0, false}};
}

std::string textOf(const WallCase& what) {
    std::string text = fmt::format(
        "grammar 2\n"
        "terminal stone color #8c8474\nterminal plaster color #d8cdb8\n"
        "terminal frame color #f0efe8\nterminal glass color #4f6a78\n"
        "start Wall -> Front size ({}m, {}m, .5m) turn {}deg\n"
        "rule Front -> split y {{ 4m: Shops | {{ ~3.2m: Row }}* | .6m: stone }}\n"
        "rule Shops -> split x {{ {{ ~5m: Shop }}* }}\n"
        "rule Shop -> split x {{ .5m: stone | ~1: Gate | .5m: stone }}\n"
        "rule Gate -> split y {{ ~1: glass | .8m: stone }}\n"
        "rule Row -> split x {{ {{ ~2.4m: Tile }}* }}\n"
        "rule Tile -> split x {{ .6m: plaster | ~1: Bay | .6m: plaster }}\n"
        "rule Bay -> split y {{ .9m: plaster | ~1: Window | .5m: plaster }}\n"
        "rule Window -> split x {{ .07m: frame | ~1: Panes | .07m: frame }}\n"
        "rule Panes -> split y {{ .07m: frame | ~1: Pane | .07m: frame }}\n",
        what.width_m, what.height_m, what.turn_deg);
    constexpr const char* asking = "glass + frame size (100%, .1m, .1m) at +z\n";
    if (what.asks != Asks::All) text += "rule Pane weight 99 -> glass\n";
    if (what.asks == Asks::All) text += fmt::format("rule Pane -> {}", asking);
    if (what.asks == Asks::Few) text += fmt::format("rule Pane weight 1 -> {}", asking);
    return text;
}

Result<std::shared_ptr<const rules::Grammar>> grammarOf(const std::filesystem::path& name, const std::string& text) {
    syntax::Diagnostics problems;
    auto grammar = pipeline::load(name, text, problems);
    if (!grammar) return Error{Error::Kind::Input, problems.all()[0].message};
    return grammar;
}

derive::Options optionsOf(const rules::Grammar& grammar) {
    derive::Options options;
    options.params = rules::valuesOf(grammar, 0);
    options.budget.shapes = 20'000'000;
    return options;
}

/// Calls `run`, whose result is an error or not, some times; the least time, by the processor for what one thread does.
/// What `clear` takes away isn't counted.
template <class Run, class Clear = void (*)()>
Result<double> least(
    int repeats, Run&& run, Clear&& clear = [] {}, Clock clock = Clock::Processor) {
    double seconds = 1e9;
    for (int i = 0; i < repeats; ++i) {
        clear();
        const Stopwatch watch(clock);
        if (const auto done = run(); !done.ok()) return done.error();
        seconds = std::min(seconds, watch.seconds());
    }
    return seconds;
}

/// Of the crisp mesh without halved cells, as makeMesh makes it.
Result<double> meshTime(const pipeline::Model& model, float cell_m, int repeats) {
    const mesh::PolygonizeOptions options{.surface = mesh::Surface::Crisp, .halvings = 0};
    return least(repeats, [&]() -> Status {
        pipeline::Context context{nullptr, 1, {}};
        const mesh::Grid grid = pipeline::gridOver(model, {.cell_m = static_cast<double>(cell_m)}, options.surface);
        const auto made = pipeline::makeMesh(model, grid, options, context);
        return made.ok() ? Status(Done{}) : made.error();
    });
}

Result<WallCosts> measureWall(const WallCase& what) {
    WallCosts costs;
    costs.what = what;
    const auto grammar = grammarOf("wall.sgm", textOf(what));
    if (!grammar.ok()) return grammar.error();
    const int repeats = what.width_m > 200 ? 3 : 9;
    std::optional<derive::Derivation> derivation;
    const auto derive = [&]() -> Status {
        auto d = derive::derive(*grammar, optionsOf(**grammar), nullptr);
        if (!d.ok()) return d.error();
        derivation = std::move(*d);
        return Done{};
    };
    const auto derived = least(repeats, derive, [&] { derivation.reset(); });
    if (!derived.ok()) return derived.error();
    costs.derive_s = *derived;
    costs.shapes = derivation->tree.shapes.size();
    costs.terminals = derivation->terminals();
    costs.bytesPerShape = static_cast<double>(derivation->memory()) / static_cast<double>(costs.shapes);
    std::unique_ptr<lower::Model> model;
    const auto lowerOn = [&](int threads) {
        return [&, threads]() -> Status {
            auto m = lower::lower(*derivation, nullptr, threads);
            if (!m.ok()) return m.error();
            model = std::move(*m);
            return Done{};
        };
    };
    const auto clear = [&] { model.reset(); };
    const auto lowered = least(repeats, lowerOn(1), clear), shared = least(repeats, lowerOn(0), clear, Clock::Wall);
    if (!lowered.ok()) return lowered.error();
    costs.lower_s = *lowered;
    costs.lowerShared_s = *shared;
    std::optional<eval::Tape> tape;
    costs.compile_s = *least(repeats, [&]() -> Status {
        tape = eval::compile(model->graph, model->field, model->graph.constants(), 1);
        return Done{};
    });
    costs.tape = tape->size();
    if (!what.isMeshed) return costs;
    const pipeline::Model whole{std::move(*derivation), std::move(model), std::move(*tape)};
    const auto meshed = meshTime(whole, static_cast<float>(what.width_m / resolution), 3);
    if (!meshed.ok()) return meshed.error();
    costs.mesh_s = *meshed;
    return costs;
}

/// Outlines of 16 edges, each another, in rows.
std::string outlinesText() {
    std::string text = "{\"type\": \"FeatureCollection\", \"features\": [\n";
    for (size_t i = 0; i < buildings; ++i) {
        text += fmt::format(
            "{}{{\"type\": \"Feature\", \"properties\": {{\"height\": {}}}, \"geometry\": {{\"type\": \"Polygon\", "
            "\"coordinates\": [[",
            i ? ",\n" : "", 6 + i % 7);
        const auto row = i / 100;
        for (size_t k = 0; k <= edges; ++k) {
            const double angle = fullTurn * static_cast<double>(k % edges) / edges,
                         radius = 7 + double((i + k * k) % 5) / 3;
            text += fmt::format("{}[{:.2f}, {:.2f}]", k ? ", " : "", double(i % 100) * 25 + radius * std::cos(angle),
                                25 * double(row) + radius * std::sin(angle));
        }
        text += "]]}}";
    }
    return text + "]}\n";
}

constexpr const char* buildingsText =
    "grammar 2\n"
    "terminal plaster color #d8cdb8\n"
    "start Town -> for k in 1..outlines(\"town.geojson\") { Plot footprint file(\"town.geojson\", k) }\n"
    "rule Plot -> extrude (value(\"height\", 8m)) House\n"
    "rule House -> plaster + hipRoof(35deg, overhang: .4m) color #a4503a at +y\n";

/// Time by the wall, on all threads, from the text of a grammar and a file of outlines to the tape.
Result<double> measureBuildings() {
    const Scratch scratch;
    scratch.write("town.geojson", outlinesText());
    const auto build = [&]() -> Status {
        const auto grammar = grammarOf(scratch / "town.sgm", buildingsText);
        if (!grammar.ok()) return grammar.error();
        const auto d = derive::derive(*grammar, optionsOf(**grammar), nullptr);
        if (!d.ok()) return d.error();
        const auto model = lower::lower(*d, nullptr);
        if (!model.ok()) return model.error();
        const auto tape = eval::compile((*model)->graph, (*model)->field, (*model)->graph.constants());
        if (d->terminals() == 2 * buildings && tape.size() > 0) return Done{};
        return Error{Error::Kind::Internal, fmt::format("{} terminals", d->terminals())};
    };
    return least(
        5, build, [] {}, Clock::Wall);
}

/// Processor time of 20 passes, each of which doubles the letters.
Result<double> measureLetters() {
    const auto grammar = grammarOf("letters.sgm",
                                   "grammar 2\nlsystem Long passes 20 angle 90deg step 1m\n  axiom \"F\"\n"
                                   "  F -> \"FG\"\n  G -> \"FG\"\nstart S -> footprint Long extrude 1m\n");
    if (!grammar.ok()) return grammar.error();
    const std::vector<rules::Value> params = rules::valuesOf(**grammar, 0);
    return least(5, [&]() -> Status {
        derive::Place place;
        place.params = params;
        const auto letters = derive::rewritten((*grammar)->lsystems[0], place);
        if (!letters.ok()) return letters.error();
        if (letters->text.size() >= 1'000'000) return Done{};
        return Error{Error::Kind::Internal, fmt::format("{} letters", letters->text.size())};
    });
}

std::string header() {
    return fmt::format("{:22} {:>9} {:>9} {:>9} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>7}", "wall", "shapes",
                       "terminals", "tape", "derive s", "M/s", "lower s", "shared", "compile", "mesh s", "B/shape");
}

std::string lineOf(const WallCosts& c) {
    return fmt::format("{:22} {:>9} {:>9} {:>9} {:>8.4f} {:>8.3f} {:>8.4f} {:>8.4f} {:>8.4f} {:>8.4f} {:>7.0f}",
                       c.what.name, c.shapes, c.terminals, c.tape, c.derive_s, 1e-6 * c.shapesPerSecond(), c.lower_s,
                       c.lowerShared_s, c.compile_s, c.mesh_s, c.bytesPerShape);
}

/// Of three walls alike but for how many ask, and the first one's rate.
void judgeAsking(const WallCosts* walls, double rate, std::vector<Bar>& bars) {
    const std::string& name = walls[0].what.name;
    bars.push_back({name + ", shapes a second, none asks", rate, true, walls[0].shapesPerSecond(), ""});
    constexpr double few = 1.3, all = 2;
    for (int i = 1; i <= 2; ++i)
        bars.push_back({walls[i].what.name + ": time a shape / none asks", i == 1 ? few : all, false,
                        walls[0].shapesPerSecond() / walls[i].shapesPerSecond(), ""});
    bars.push_back({name + ", bytes a shape of tree", 128, false, walls[0].bytesPerShape, ""});
    const auto terminals = static_cast<double>(walls[0].terminals);
    bars.push_back({name + ", terminals lowered a second", 1.5e6, true,
                    terminals / std::min(walls[0].lower_s, walls[0].lowerShared_s), ""});
}

}  // namespace

Result<std::vector<Bar>> measureDerivation() {
    fmt::print("{}\n", header());
    std::vector<WallCosts> walls;
    for (const WallCase& what : wallCases()) {
        const auto costs = measureWall(what);
        if (!costs.ok()) return costs.error();
        walls.push_back(*costs);
        fmt::print("{}\n", lineOf(*costs));
        std::fflush(stdout);
    }
    std::vector<Bar> bars;
    judgeAsking(&walls[0], 2.5e6, bars);
    judgeAsking(&walls[4], 1.7e6, bars);
    const WallCosts &straight = walls[0], &turned = walls[3];
    const auto total = [](const WallCosts& c) { return c.derive_s + c.lower_s + c.compile_s + c.mesh_s; };
    bars.push_back({"turned / straight, instructions", 1.3, false,
                    static_cast<double>(turned.tape) / static_cast<double>(straight.tape), ""});
    bars.push_back({"turned / straight, time to the tape", 1.3, false,
                    (total(turned) - turned.mesh_s) / (total(straight) - straight.mesh_s), ""});
    bars.push_back({fmt::format("turned / straight, time to the mesh at {}", resolution), 1.3, false,
                    total(turned) / total(straight), ""});
    const auto town = measureBuildings();
    if (!town.ok()) return town.error();
    bars.push_back({fmt::format("{} buildings of a file, text to tape, s", buildings), .5, false, *town, ""});
    const auto letters = measureLetters();
    if (!letters.ok()) return letters.error();
    bars.push_back({"an L-system of a million letters, s", .1, false, *letters, ""});
    return bars;
}

}  // namespace sgm::bench
