#include "tests/bench/gallery.h"

#include <fmt/format.h>

#include <fstream>
#include <sstream>

namespace sgm::bench {
namespace {

struct Entry {
    std::string family, name, file;
    uint64_t seed = 1;
};

double goalOf(const std::string& family) {
    return family == "cave" ? 0.05 : family == "cloud" ? 0.15 : family == "building" ? 0.3 : 0;
}

/// "family | name | file options": of the options the seed alone changes what is meshed.
Entry entryOf(const std::string& line) {
    Entry entry;
    std::istringstream words(line);
    std::string bar, word;
    words >> entry.family >> bar >> entry.name >> bar >> entry.file;
    while (words >> word && word != "|")
        if (word == "--seed") words >> entry.seed;
    return entry;
}

Result<std::string> rowOf(const Entry& entry, MeasureOptions options) {
    auto grammar = loadGrammar({entry.name, entry.file, ""});
    if (!grammar.ok()) return grammar.error();
    grammar->options.seed = entry.seed;
    grammar->noise = false;
    const auto scene = makeScene(*grammar, options.running);
    if (!scene.ok()) return scene.error();
    options.dense = options.peers = false;
    const auto m = measure(*scene, 256, options);
    if (!m.ok()) return m.error();
    const double goal = goalOf(entry.family);
    return fmt::format("| {} | {} | {} | {:.4f} | {} | {} |\n", entry.name, m->triangles, m->tapeLength,
                       m->totalSeconds, goal, m->totalSeconds <= goal ? "reached" : "missed");
}

}  // namespace

Result<std::string> galleryTimes(const std::string& list, const MeasureOptions& options) {
    std::ifstream file(list);
    if (!file) return Error{Error::Kind::Input, "can't read " + list};
    std::string page = fmt::format(
        "## Field to mesh\n\nSeconds from field to mesh at 256 cells on {} threads, without noise, as `bench "
        "--gallery` measured them; the goal is "
        "a tenth of the paper's fastest time for the family.\n\n| object | triangles | instructions | seconds | goal | "
        "|\n|---|---|---|---|---|---|\n",
        options.running.threads);
    for (std::string line; std::getline(file, line);) {
        const Entry entry = entryOf(line);
        if (line.starts_with("#") || goalOf(entry.family) == 0) continue;
        const auto row = rowOf(entry, options);
        if (!row.ok()) return Error{row.error().kind, fmt::format("{}: {}", entry.name, row.error().message)};
        page += *row;
    }
    return page;
}

}  // namespace sgm::bench
