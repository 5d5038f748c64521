// Baked folders: the same bytes however the work is shared, instances that add up, files for other programs.
#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "modeler/tiles/deliver.h"
#include "modeler/tiles/read_back.h"
#include "tests/scratch.h"
#include "tests/tiles/baked.h"

namespace sgm::pipeline {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const std::string text = R"(grammar 1
terminal lawn color #86a35f
terminal road color #5b5e62
terminal stone color #c8b090
param high = 6m in 3m..30m
start Town -> size (150, 4, 150) (Ground, split x { { ~25m: Row }* })
rule Ground -> lawn - sphere size (60, 20, 60) move (20, 8, -10) + road size (150, 1.2, 9) move (0, 2m, 0) turn (0deg, 20deg, 0deg)
rule Row -> split z { { ~25m: Plot }* }
rule Plot -> move (0, 6m, 0) size (9, 8, 9) turn (0deg..90deg) place House { high = choose { 1: 6m | 1: 12m } } variety 2
start House -> stone size (8, high, 6) - cube size (1, 2, 9) at -y to centre
)";

/// Ground that ends 14 m higher on its hill than beside it.
const std::string hills = R"(grammar 2
map hill = 14m * bump((10m, 6m), 85m)
roads Net { height = hill spread = false }
terminal lawn color #86a35f
start Town -> size (180m, 40m, 180m) network Net { ground: extrude 20m lawn }
)";

std::map<std::string, std::string> filesOf(const fs::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_regular_file()) files[fs::relative(entry.path(), folder)] = contentOf(entry.path());
    return files;
}

TEST(Bake, HasTheSameBytesHoweverTheWorkIsShared) {
    Baked baked(text);
    const Scratch one, seven;
    baked.run(one.path(), {1, 1}, 2);
    EXPECT_TRUE(baked.missing.empty());
    for (const int task : {4, 1, 7, 2}) baked.run(seven.path(), {task, 7});
    EXPECT_EQ(baked.missing, (std::vector<int>{3, 5, 6}));
    // A cell whose note is gone, as after a kill, is made again.
    fs::remove(tiles::noteFile(seven.path(), baked.plan.cells[0]));
    for (const int task : {1, 3, 5, 6}) baked.run(seven.path(), {task, 7});
    EXPECT_TRUE(baked.missing.empty());
    baked.merge(one.path());
    baked.merge(seven.path());
    const auto a = filesOf(one.path()), b = filesOf(seven.path());
    ASSERT_EQ(a.size(), b.size());
    EXPECT_GT(a.size(), 20u);
    for (const auto& [name, bytes] : a) EXPECT_TRUE(b.contains(name) && b.at(name) == bytes) << name;
}

/// The height of the highest sample of all height maps, metres.
double highestOf(const Scratch& folder) {
    const json heights = json::parse(folder.read("heights/heights.json"));
    uint16_t highest = 0;
    for (const json& file : heights["files"]) {
        const std::string raw = folder.read("heights/" + file["name"].get<std::string>() + ".r16");
        EXPECT_EQ(raw.size(), 2 * file["samples"].get<size_t>() * file["samples"].get<size_t>());
        for (size_t i = 0; i < raw.size(); i += 2) {
            uint16_t v = 0;
            std::memcpy(&v, raw.data() + i, 2);
            highest = std::max(highest, v);
        }
    }
    return heights["height_of_0_m"].get<double>() + highest * heights["metres_a_step"].get<double>();
}

TEST(Bake, HillsAreAsHighAsTheyShould) {
    Baked baked(hills);
    const Scratch folder;
    baked.run(folder.path(), {1, 1}, 2);
    baked.merge(folder.path());
    const Status done = tiles::deliver(folder.path(), tiles::Delivery::Heights, nullptr);
    ASSERT_TRUE(done.ok()) << done.error().message;
    EXPECT_NEAR(highestOf(folder), 14, .1);
}

TEST(Bake, TellsWhoPutWhatWhere) {
    Baked baked(text);
    const Scratch folder;
    baked.run(folder.path(), {1, 1}, 2);
    tiles::Library library;
    std::set<std::string> paths;
    for (const tiles::Cell& cell : baked.plan.cells) {
        if (cell.level != 0) continue;
        const auto read = tiles::readCell(tiles::contentFile(folder.path(), cell), library);
        if (!read.ok()) continue;  // nothing is there
        for (const tiles::CellObject& object : read->content.objects) {
            EXPECT_EQ(object.values.at("start"), "House");
            const auto shape = tiles::readObject(object.path);
            ASSERT_TRUE(shape.ok());
            for (const tiles::CellPlace& place : object.places) {
                EXPECT_TRUE(paths.insert(place.part->path.text()).second) << place.part->path.text();
                EXPECT_TRUE(place.part->rule().starts_with("Plot")) << place.part->rule();
                EXPECT_EQ(place.part->file(), "town.sgm");
                EXPECT_EQ(place.part->line(), 9u);
                // It stands in its cell, on the slab, and reaches up from there.
                const Vec3d at = place.part->pose.origin;
                EXPECT_LE(std::max(std::abs(at.x), std::abs(at.z)), 32.0);
                const Box3f box = tiles::boundsOf(shape->pieces);
                EXPECT_NEAR(static_cast<double>(box.hi.x - box.lo.x), 8, .05);
                EXPECT_NEAR(static_cast<double>(box.hi.z - box.lo.z), 6, .05);
            }
        }
    }
    EXPECT_EQ(paths.size(), 36u);
}

TEST(Bake, GivesPlainFilesUsdAndHeightsOfTheSameGround) {
    Baked baked(text);
    const Scratch folder;
    baked.run(folder.path(), {1, 1}, 2);
    baked.merge(folder.path());
    const json placed = json::parse(folder.read("tileset.json"))["root"]["transform"];
    ASSERT_EQ(placed.size(), 16u);
    ASSERT_TRUE(tiles::merge(folder.path(), std::nullopt, false).ok());
    EXPECT_EQ(json::parse(folder.read("tileset.json"))["root"]["transform"], placed) << "a later merge leaves it there";
    for (const auto delivery : {tiles::Delivery::Blender, tiles::Delivery::Usd, tiles::Delivery::Heights}) {
        const Status done = tiles::deliver(folder.path(), delivery, nullptr);
        ASSERT_TRUE(done.ok()) << done.error().message;
    }
    size_t nodes = 0, payloads = 0, instances = 0;
    for (const auto& [name, bytes] : filesOf(folder.path())) {
        if (name.starts_with("blender/cells/")) {
            const auto glb = tiles::readGlb(folder / name);
            ASSERT_TRUE(glb.ok());
            EXPECT_FALSE(glb->json.contains("extensionsRequired")) << name;
            for (const auto& node : glb->json["nodes"]) nodes += node.contains("extras");
        }
        if (name.starts_with("usd/cells/")) {
            ++payloads;
            for (size_t at = bytes.find("primvars:line = ["); at != std::string::npos && bytes[at] != ']'; ++at)
                instances += bytes[at] == ',' || bytes[at] == '[';
        }
    }
    EXPECT_EQ(nodes, 36u);
    EXPECT_EQ(instances, 36u);
    const std::string stage = folder.read("usd/city.usda");
    size_t found = 0;
    for (size_t at = stage.find("prepend payload"); at != std::string::npos; at = stage.find("prepend payload", at + 1))
        ++found;
    EXPECT_EQ(found, payloads);
    // The slab's top lies at 2 m where nothing was cut, sampled at its own vertices and between them.
    EXPECT_NEAR(highestOf(folder), 2.6, .02) << "the road's top";
}

TEST(Bake, ShowsEveryPlaceOnceALevel) {
    Baked baked(text);
    const Scratch folder;
    baked.run(folder.path(), {1, 1}, 2);
    baked.merge(folder.path());
    const json manifest = json::parse(folder.read("manifest.json")), tileset = json::parse(folder.read("tileset.json"));
    EXPECT_EQ(manifest["instances"], 36);
    EXPECT_EQ(manifest["places"], 36);
    std::map<int, size_t> byLevel;
    for (const auto& [name, cell] : manifest["cells"].items())
        byLevel[tiles::cellNamed(name)->level] += cell["instances"].get<size_t>();
    for (int level = 0; level < 3; ++level) EXPECT_EQ(byLevel[level], 36u) << level;
    // Every cell with content hangs in the tree once.
    std::set<std::string> hung;
    const std::function<void(const json&)> walk = [&](const json& tile) {
        if (tile.contains("content")) {
            EXPECT_TRUE(hung.insert(tile["content"]["uri"]).second);
        }
        if (tile.contains("children"))
            for (const json& child : tile["children"]) {
                EXPECT_LE(child["geometricError"], tile["geometricError"]);
                walk(child);
            }
    };
    walk(tileset["root"]);
    EXPECT_EQ(hung.size(), manifest["cells"].size());
}

TEST(Bake, RefusesAFolderOfAnotherModelAndADamagedCell) {
    Baked baked(text);
    const Scratch folder;
    baked.run(folder.path(), {1, 1});
    const auto content = tiles::contentFile(folder.path(), baked.plan.cells[0]);
    std::ofstream(content, std::ios::app) << "x";
    const Status damaged = tiles::merge(folder.path(), {}, true);
    ASSERT_FALSE(damaged.ok());
    EXPECT_NE(damaged.error().message.find("isn't as it was baked"), std::string::npos);
    tiles::BakePlan other = baked.plan;
    other.model = "another";
    const Status refused = tiles::keepPlan(other, folder.path());
    ASSERT_FALSE(refused.ok());
    EXPECT_NE(refused.error().message.find("another model"), std::string::npos);
    fs::remove(tiles::noteFile(folder.path(), baked.plan.cells[1]));
    EXPECT_FALSE(tiles::merge(folder.path(), {}, false).ok());
}

}  // namespace
}  // namespace sgm::pipeline
