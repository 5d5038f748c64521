#include "tests/bench/city.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <map>
#include <type_traits>

#include "grammar/pipeline/bake.h"
#include "grammar/pipeline/load.h"
#include "modeler/core/random.h"
#include "tests/bench/memory.h"
#include "tests/scratch.h"

namespace sgm::bench {
namespace {

namespace fs = std::filesystem;

constexpr double townSide_m = 4500, mapSide_m = 5000;
const fs::path town = "examples/city/town.sgm";

double processorSeconds() {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

void replaceAll(std::string& text, const std::string& from, const std::string& to) {
    for (size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
        text.replace(at, from.size(), to);
}

/// The town's text for a larger side: its maps are stretched over it, so that it is as dense.
std::string textFor(const CityCase& what) {
    std::string text = contentOf(town);
    const std::string maps = fmt::format("({0:.0f}m, {0:.0f}m)", mapSide_m * what.side_m / townSide_m);
    replaceAll(text, "(5km, 5km)", maps);
    replaceAll(text, "in 400m..5km", "in 400m..60km");
    replaceAll(text, "step = 80m", "step = 80m limit = 1000000");
    replaceAll(text, "4.5km", fmt::format("{:.0f}m", what.side_m));
    if (what.isDistinct)
        for (size_t at = text.find(" variety "); at != std::string::npos; at = text.find(" variety ", at))
            text.erase(at, text.find_first_of("\n |}", at + 9) - at);
    return text;
}

double megabytesOf(const fs::path& folder) {
    double bytes = 0;
    if (!fs::exists(folder)) return 0;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_regular_file()) bytes += static_cast<double>(entry.file_size());
    return bytes / 1e6;
}

/// Files of the finest detail, and the largest of a house.
void readLibrary(const fs::path& folder, CityFigures& costs) {
    for (const auto& entry : fs::recursive_directory_iterator(folder / "lib")) {
        if (!entry.path().stem().string().ends_with("-0")) continue;
        ++costs.bakedObjects;
        const std::string text = contentOf(entry.path());
        if (text.find("\"start\":\"House\"") == std::string::npos) continue;
        costs.largestDwelling_kB = std::max(costs.largestDwelling_kB, static_cast<double>(text.size()) / 1e3);
    }
}

/// The cells that are baked: squares of sixteen by sixteen, as a worker has them one after the other, drawn by their
/// places until there are enough; at least one.
std::vector<size_t> drawn(const std::vector<tiles::Cell>& cells, double share) {
    std::map<uint64_t, std::vector<size_t>> squares;  // in a random order
    for (size_t i = 0; i < cells.size(); ++i)
        squares[combine(combine(uint64_t(cells[i].level), uint64_t(uint32_t(cells[i].x >> 4))),
                        uint64_t(uint32_t(cells[i].z >> 4)))]
            .push_back(i);
    std::vector<size_t> out;
    for (const auto& [key, square] : squares)
        if (const size_t half = square.size() / 2;
            out.empty() || static_cast<double>(out.size() + half) < share * static_cast<double>(cells.size()))
            out.insert(out.end(), square.begin(), square.end());
    std::sort(out.begin(), out.end());
    return out;
}

/// Processor time of the slower of two processes that bake a half each, at the same time; 0 where one failed.
double bakeByTwo(const pipeline::Model& model, const pipeline::BakeRequest& request) {
    std::array<pid_t, 2> workers{};
    for (size_t i = 0; i < workers.size(); ++i) {
        workers[i] = fork();
        if (workers[i] != 0) continue;
        pipeline::Context context{nullptr, 1};
        auto bake = pipeline::Bake::begin(model, request, context);
        _exit(bake.ok() && bake->run({static_cast<int>(i) + 1, 2}, context).ok() ? 0 : 1);
    }
    double slower_s = 0;
    bool isWhole = true;
    for (const pid_t worker : workers) {
        int status = 0;
        rusage used{};
        isWhole &= worker > 0 && wait4(worker, &status, 0, &used) == worker && status == 0;
        const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
        slower_s = std::max(slower_s, seconds(used.ru_utime) + seconds(used.ru_stime));
    }
    return isWhole ? slower_s : 0;
}

/// What a case costs in this process.
Result<CityFigures> measureHere(const CityCase& what) {
    CityFigures costs;
    const double start = processorSeconds();
    const PeakMemory planMemory;
    syntax::Diagnostics problems;
    const auto grammar = pipeline::load(town, textFor(what), problems);
    if (!grammar) return Error{Error::Kind::Input, "the town can't be read: " + problems.all()[0].message};
    pipeline::ModelChoice choice;
    choice.shapeBudget = 100'000'000;
    choice.secondsBudget = 3600;
    auto options = pipeline::optionsFor(*grammar, choice);
    if (!options.ok()) return options.error();
    pipeline::Context context{nullptr, 1};
    auto model = pipeline::makeModel(grammar, *options, context, pipeline::Objects::Apart);
    if (!model.ok()) return model.error();
    model->lowered = pipeline::withoutGraph(*model->lowered);
    const double model_s = processorSeconds() - start;
    const Scratch folder;
    pipeline::BakeRequest request;
    request.folder = folder.path();
    request.objectCell_m = what.objectCell_m;
    request.cell_m = what.groundCell_m;
    request.budget.shapes = choice.shapeBudget;
    auto bake = pipeline::Bake::begin(*model, request, context);
    if (!bake.ok()) return bake.error();
    costs.plan_s = processorSeconds() - start;
    costs.planMemory_MB = static_cast<double>(planMemory.bytes()) / 1e6;
    const PeakMemory bakeMemory;
    costs.places = bake->plan().places, costs.objects = bake->plan().objects, costs.cells = bake->plan().cells.size();
    const std::vector<size_t> cells = drawn(bake->plan().cells, what.share);
    const Status done = what.share < 1 ? bake->runCells(cells, context) : bake->run({1, 1}, context);
    if (!done.ok()) return done.error();
    costs.baked_s = processorSeconds() - start - costs.plan_s;
    costs.bakeMemory_MB = static_cast<double>(bakeMemory.bytes()) / 1e6;
    costs.bakedCells = cells.size();
    readLibrary(folder.path(), costs);
    if (what.isShared) {
        const Scratch shared;
        request.folder = shared.path();
        costs.twoWorkers_s = model_s + bakeByTwo(*model, request);
    }
    // Objects and cells grow each by its own count.
    const pipeline::BakeTimes& times = bake->times();
    const double all = times.objects + times.ground + times.cells;
    const double objects = costs.baked_s * times.objects / all, rest = costs.baked_s - objects;
    const double ofObjects = double(costs.objects) / double(std::max<uint64_t>(costs.bakedObjects, 1));
    const double ofCells = double(costs.cells) / double(costs.bakedCells);
    costs.objects_s = objects * ofObjects;
    costs.ground_s = costs.baked_s * times.ground / all * ofCells;
    costs.total_s = costs.plan_s + costs.objects_s + rest * ofCells;
    costs.folder_MB = megabytesOf(folder / "lib") * ofObjects + megabytesOf(folder / "cells") * ofCells;
    return costs;
}

/// Whether all of it was written.
bool writeWhole(int file, const void* bytes, size_t count) {
    const char* at = static_cast<const char*>(bytes);
    while (count > 0) {
        const ssize_t n = write(file, at, count);
        if (n <= 0) return false;
        at += n, count -= size_t(n);
    }
    return true;
}

}  // namespace

std::vector<CityCase> cityCases(double mostBuildings) {
    const auto sideFor = [](double buildings) { return townSide_m * std::sqrt(buildings / 1e4); };
    // A larger town is less dense towards its edge: 1.28 times the area holds the last of the million.
    std::vector<CityCase> cases{{"10³, variety", 1e3, sideFor(1e3), false, .3, 1, 0},
                                {"10⁴, variety", 1e4, townSide_m, false, .3, 1, 60, true},
                                {"10⁴, all distinct", 1e4, townSide_m, true, .2, .1, 450},
                                {"10⁵, variety", 1e5, sideFor(1e5), false, .3, 1, 150},
                                {"10⁶, variety", 1e6, sideFor(1.28e6), false, .3, .01, 1500, false, 4}};
    std::erase_if(cases, [&](const CityCase& c) { return c.buildings > mostBuildings; });
    return cases;
}

Result<CityCosts> measureCity(const CityCase& what) {
    std::array<int, 2> ends{};
    if (pipe(ends.data()) != 0) return Error{Error::Kind::Internal, "no pipe can be made"};
    const pid_t child = fork();
    if (child < 0) return Error{Error::Kind::Internal, "no process can be made"};
    if (child == 0) {
        const auto figures = measureHere(what);
        const std::string message = figures.ok() ? "" : figures.error().message;
        const bool isWritten = figures.ok() ? writeWhole(ends[1], &*figures, sizeof(CityFigures))
                                            : writeWhole(ends[1], message.data(), message.size());
        _exit(figures.ok() && isWritten ? 0 : 1);
    }
    close(ends[1]);
    std::string told;
    std::array<char, 4096> some{};
    for (ssize_t n = 0; (n = read(ends[0], some.data(), some.size())) > 0;) told.append(some.data(), size_t(n));
    close(ends[0]);
    int status = 0;
    waitpid(child, &status, 0);
    if (status != 0 || told.size() != sizeof(CityFigures))
        return Error{Error::Kind::Internal, told.empty() ? "the process that bakes ended early" : told};
    static_assert(std::is_trivially_copyable_v<CityFigures>);
    CityCosts costs;
    std::memcpy(static_cast<CityFigures*>(&costs), told.data(), sizeof(CityFigures));
    costs.what = what;
    return costs;
}

std::string cityHeader() {
    return fmt::format("{:20} {:>9} {:>8} {:>7} {:>7} {:>8} {:>10} {:>9} {:>10} {:>9} {:>9} {:>8}", "city", "places",
                       "objects", "cells", "baked", "plan s", "objects s", "ground s", "total s", "plan MB", "bake MB",
                       "disk MB");
}

std::string cityLine(const CityCosts& c) {
    return fmt::format(
        "{:20} {:>9} {:>8} {:>7} {:>7} {:>8.1f} {:>10.0f} {:>9.0f} {:>9.0f}{} {:>9.0f} {:>9.0f} {:>8.1f}", c.what.name,
        c.places, c.objects, c.cells, c.bakedCells, c.plan_s, c.objects_s, c.ground_s, c.total_s,
        c.what.share < 1 ? "*" : " ", c.planMemory_MB, c.bakeMemory_MB, c.folder_MB);
}

namespace {

/// Processor seconds of a million buildings that all differ: the plan of a million, and what ten thousand cost beyond
/// theirs a hundred times; 0 where either wasn't measured.
double millionDistinct(const std::vector<CityCosts>& costs) {
    const auto largest = std::max_element(costs.begin(), costs.end(),
                                          [](const CityCosts& a, const CityCosts& b) { return a.places < b.places; });
    const auto distinct =
        std::find_if(costs.begin(), costs.end(), [](const CityCosts& c) { return c.what.isDistinct; });
    if (distinct == costs.end() || largest->what.buildings < 1e6) return 0;
    return largest->plan_s +
           (distinct->total_s - distinct->plan_s) * double(largest->places) / double(distinct->places);
}

}  // namespace

std::vector<Bar> judge(const std::vector<CityCosts>& costs) {
    std::vector<Bar> bars;
    double least_MB = 0, most_MB = 0;
    for (const CityCosts& c : costs) {
        const char* how = c.what.share < 1 ? "projected from a share of the cells" : "";
        if (c.what.bar_s > 0) bars.push_back({c.what.name + ", processor s", c.what.bar_s, false, c.total_s, how});
        bars.push_back({c.what.name + ", MB beyond the plan", 400, false, std::max(c.bakeMemory_MB, 1.0), ""});
        if (c.what.isDistinct) bars.push_back({c.what.name + ", MB of disk", 1000, false, c.folder_MB, how});
        if (c.twoWorkers_s > 0)
            bars.push_back({c.what.name + ", one worker's time over the slower of two's", 1.8, true,
                            c.total_s / c.twoWorkers_s, ""});
        if (c.what.isDistinct || c.what.buildings > 1e5) continue;
        least_MB = least_MB == 0 ? c.bakeMemory_MB : std::min(least_MB, c.bakeMemory_MB);
        most_MB = std::max(most_MB, c.bakeMemory_MB);
    }
    if (least_MB < most_MB)
        bars.push_back({"MB beyond the plan, most over least of 10³ to 10⁵", 1.1, false, most_MB / least_MB, ""});
    if (const double million_s = millionDistinct(costs); million_s > 0)
        bars.push_back(
            {"10⁶, all distinct, processor s", 50'000, false, million_s, "projected from 10⁴ and the plan of 10⁶"});
    if (!costs.empty()) bars.push_back({"a dwelling's finest level, kB", 80, false, costs[0].largestDwelling_kB, ""});
    return bars;
}

}  // namespace sgm::bench
