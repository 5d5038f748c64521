// The layering rules for includes: no upward include, no cycle, heavy headers only in .cpp files.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

struct Include {
    std::string from, to;
};

std::vector<Include> includesUnder(const std::vector<std::string>& folders) {
    std::vector<Include> found;
    const std::regex pattern("^\\s*#\\s*include\\s*([\"<])([^\">]+)[\">]");
    for (const std::string& folder : folders)
        for (const auto& entry : fs::recursive_directory_iterator(folder)) {
            const std::string extension = entry.path().extension();
            if (extension != ".h" && extension != ".cpp") continue;
            std::ifstream file(entry.path());
            for (std::string line; std::getline(file, line);) {
                std::smatch match;
                if (std::regex_search(line, match, pattern)) found.push_back({entry.path().string(), match[2]});
            }
        }
    return found;
}

/// "modeler/eval/tape.h" → "modeler/eval"; cli is one module.
std::string moduleOf(const std::string& path) {
    const size_t first = path.find('/');
    const std::string top = path.substr(0, first);
    return top == "cli" ? top : path.substr(0, path.find('/', first + 1));
}

const std::vector<std::string> folders{"modeler", "grammar", "viewer", "cli"};

/// The modules as the build adds them, bottom to top: a module may see those before it.
std::vector<std::string> modulesOfTheBuild() {
    std::vector<std::string> modules;
    std::istringstream names(SGM_MODULES);
    for (std::string name; std::getline(names, name, ',');) modules.push_back(name);
    modules.push_back("cli");
    return modules;
}

TEST(Layering, NoUpwardInclude) {
    std::map<std::string, size_t> level;
    const std::vector<std::string> order = modulesOfTheBuild();
    for (size_t i = 0; i < order.size(); ++i) level[order[i]] = i;
    size_t seen = 0;
    for (const Include& include : includesUnder(folders)) {
        const std::string from = moduleOf(include.from), to = moduleOf(include.to);
        if (from == to || include.to == "viewer/window/app.h")
            continue;  // the header that the window's program includes
        if (std::find(folders.begin(), folders.end(), include.to.substr(0, include.to.find('/'))) == folders.end())
            continue;
        ASSERT_TRUE(level.count(to)) << include.to << " is in no module";
        ASSERT_TRUE(level.count(from)) << include.from << " is in no module";
        EXPECT_LE(level[to], level[from]) << include.from << " includes " << include.to;
        ++seen;
    }
    EXPECT_GT(seen, 50u) << "run from the repository root";
}

TEST(Layering, NoCycleAmongHeaders) {
    std::map<std::string, std::vector<std::string>> graph;
    for (const Include& include : includesUnder(folders))
        if (include.from.ends_with(".h")) graph[include.from].push_back(include.to);
    std::set<std::string> done;
    for (const auto& [start, unused] : graph) {
        // Depth-first by hand; `path` holds the chain from the start with the next child to try.
        std::vector<std::pair<std::string, size_t>> path{{start, 0}};
        std::set<std::string> onPath{start};
        while (!path.empty()) {
            auto& [node, next] = path.back();
            const auto it = graph.find(node);
            if (done.count(node) || it == graph.end() || next == it->second.size()) {
                done.insert(node);
                onPath.erase(node);
                path.pop_back();
                continue;
            }
            const std::string child = it->second[next++];
            ASSERT_FALSE(onPath.count(child)) << "include cycle through " << child;
            onPath.insert(child);
            path.emplace_back(child, 0);
        }
    }
}

/// Three headers show a package's own types: the half-edge mesh to users of the library, the grid to the volume module,
/// exact points to the two files that triangulate planar regions.
const std::set<std::string> heavyDoors{"modeler/mesh/openmesh.h", "modeler/mesh/plane_points.h",
                                       "modeler/volume/volume_impl.h"};

TEST(Layering, HeavyHeadersStayInSources) {
    for (const Include& include : includesUnder(folders)) {
        const bool heavy = include.to.starts_with("CGAL/") || include.to.starts_with("openvdb/") ||
                           include.to.starts_with("OpenMesh/") || include.to.starts_with("polyclipping/") ||
                           include.to.starts_with("CLI/") || heavyDoors.count(include.to);
        const bool allowed = include.from.ends_with(".cpp") || heavyDoors.count(include.from);
        EXPECT_TRUE(!heavy || allowed) << include.from << " includes " << include.to;
    }
}

/// The window's packages stay in its folder, so that pictures need no display; and what a document is knows no window.
TEST(Layering, OnlyTheWindowKnowsWindows) {
    for (const Include& include : includesUnder(folders)) {
        const bool window = include.from.starts_with("viewer/window/");
        EXPECT_TRUE(window || (!include.to.starts_with("GLFW/") && !include.to.starts_with("imgui")))
            << include.from << " includes " << include.to;
        const bool door = include.to == "viewer/window/app.h";
        EXPECT_TRUE(window || door || !include.to.starts_with("viewer/window/"))
            << include.from << " includes " << include.to;
    }
}

TEST(Layering, OnlyCliAndViewerPrint) {
    const std::regex prints("std::cout|std::cerr|\\bf?printf\\(|fmt::print");
    for (const std::string& folder : {std::string("modeler"), std::string("grammar")})
        for (const auto& entry : fs::recursive_directory_iterator(folder)) {
            if (!entry.is_regular_file()) continue;
            std::ifstream file(entry.path());
            for (std::string line; std::getline(file, line);)
                EXPECT_FALSE(std::regex_search(line, prints)) << entry.path() << ": " << line;
        }
}

}  // namespace
