#include "tests/bench/plan_costs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>

#include "grammar/derive/derive.h"
#include "grammar/pipeline/load.h"
#include "modeler/town/blocks.h"
#include "tests/bench/memory.h"

namespace sgm::bench {
namespace {

double processorSeconds() {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// 0 … ½, with a period of 1.
double wave(double v) { return std::abs(v - std::floor(v) - .5); }

/// People about a centre every 2.5 km, a river, and a park every 1.5 km: as dense whatever the size. They cost little,
/// so that the plan is what is measured.
town::Land landOf() {
    town::Land land;
    land.pull = [](plan::Vec2 p) { return 1 - .8 * (wave(p.x / 2500) + wave(p.z / 2500)); };
    land.spread = [](plan::Vec2 p) { return wave(p.x / 2500) + wave(p.z / 2500) < .9; };
    land.water = [](plan::Vec2 p) { return std::abs(p.z - 300 - .2 * p.x) < 60; };
    land.park = [](plan::Vec2 p) { return wave(p.x / 1500) < .09 && wave(p.z / 1500) < .09; };
    return land;
}

/// A lot as a plan keeps it: its outline behind those of the others.
struct KeptLot {
    uint64_t key = 0;
    float street_m = 0;
    uint32_t first = 0, count = 0;
};

}  // namespace

std::vector<PlanCase> planCases() {
    return {{"5 km", 5000, town::Cuts::Boxes},
            {"5 km, skeleton", 5000, town::Cuts::Skeleton},
            {"10 km", 10'000, town::Cuts::Boxes},
            {"32 km", 32'000, town::Cuts::Boxes}};
}

PlanCosts measurePlan(const PlanCase& what) {
    PlanCosts costs;
    costs.what = what;
    const town::Land land = landOf();
    town::RoadParameters parameters;
    parameters.lo = {-what.side_m / 2, -what.side_m / 2}, parameters.hi = {what.side_m / 2, what.side_m / 2};
    parameters.limit = 1e6;
    const PeakMemory memory;
    double begin = processorSeconds();
    const auto lap = [&] {
        const double now = processorSeconds(), spent = now - begin;
        begin = now;
        return spent;
    };
    const auto graph = town::growRoads(parameters, land);
    if (!graph.ok()) return costs;
    costs.roads = graph->edges().size();
    costs.roads_s = lap();
    std::vector<KeptLot> kept;
    std::vector<float> outlines;
    // The clock is read once in so many faces: asking for the processor's time takes a microsecond.
    constexpr size_t batch = 64;
    const auto faces = town::facesOf(*graph);
    std::vector<town::Block> blocks;
    town::LotParameters how;
    how.cuts = what.cuts;
    for (size_t first = 0; first < faces.size(); first += batch) {
        blocks.clear();
        for (size_t f = first; f < std::min(faces.size(), first + batch); ++f)
            for (town::Block& block : town::blocksOf(*graph, parameters, faces[f], {land.water, land.park, 10}))
                blocks.push_back(std::move(block));
        costs.blocks += blocks.size();
        costs.blocks_s += lap();
        for (const town::Block& block : blocks)
            for (const town::Lot& lot : town::lotsOf(block.land, how, block.key)) {
                const auto& points = lot.land.polygons[0].outer.points;
                kept.push_back({lot.key, static_cast<float>(lot.street_m), static_cast<uint32_t>(outlines.size()),
                                static_cast<uint32_t>(points.size())});
                for (const plan::Vec2 p : points)
                    for (const double v : {p.x, p.z}) outlines.push_back(static_cast<float>(v));
            }
        costs.lots_s += lap();
    }
    costs.lots = kept.size();
    costs.bytesPerLot = static_cast<double>(memory.bytes()) / static_cast<double>(std::max<size_t>(kept.size(), 1));
    return costs;
}

Result<double> measureSlider(const std::filesystem::path& town) {
    syntax::Diagnostics problems;
    const auto grammar = pipeline::loadFile(town, problems);
    if (!grammar.ok()) return grammar.error();
    if (!*grammar) return Error{Error::Kind::Input, problems.all().empty() ? town.string() : problems.all()[0].message};
    derive::Options options;
    options.planAlone = true;
    double least = 1e9;
    for (int repeat = 0; repeat < 3; ++repeat) {
        const double begin = processorSeconds();
        const auto laid = derive::derive(*grammar, options, nullptr);
        if (!laid.ok()) return laid.error();
        least = std::min(least, processorSeconds() - begin);
    }
    return least;
}

std::string planHeader() {
    return fmt::format("{:20} {:>9} {:>8} {:>9} {:>9} {:>9} {:>9} {:>8}", "plan", "roads", "blocks", "lots", "roads s",
                       "blocks s", "lots s", "B/lot");
}

std::string planLine(const PlanCosts& c) {
    return fmt::format("{:20} {:>9} {:>8} {:>9} {:>9.3f} {:>9.3f} {:>9.3f} {:>8.0f}", c.what.name, c.roads, c.blocks,
                       c.lots, c.roads_s, c.blocks_s, c.lots_s, c.bytesPerLot);
}

std::vector<Bar> judge(const std::vector<PlanCosts>& costs) {
    std::vector<Bar> bars;
    for (const PlanCosts& c : costs) {
        if (c.what.side_m < 10'000) continue;
        const double roads = std::max(1.0, static_cast<double>(c.roads)),
                     lots = std::max(1.0, static_cast<double>(c.lots));
        bars.push_back({c.what.name + ", s for 20,000 pieces of road", .05, false, c.roads_s * 2e4 / roads, ""});
        bars.push_back({c.what.name + ", s for 10⁶ lots, roads and blocks too", 4, false,
                        (c.roads_s + c.blocks_s + c.lots_s) * 1e6 / lots, ""});
        bars.push_back({c.what.name + ", bytes a lot", 300, false, c.bytesPerLot, ""});
    }
    return bars;
}

}  // namespace sgm::bench
