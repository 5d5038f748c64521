// What the programs that sgm writes for make of its files: Blender and Godot, where they are installed.
#include <map>
#include <set>

#include "tests/cli/program.h"

namespace sgm::cli {
namespace {

/// Runs a program that prints "FACTS {…}" for every file, and keeps them by the file's name.
std::map<std::string, Json> factsFrom(const std::string& command) {
    std::map<std::string, Json> facts;
    std::string printed;
    FILE* pipe = popen((command + " 2>&1").c_str(), "r");
    char buffer[4096];
    for (size_t n; (n = fread(buffer, 1, sizeof buffer, pipe)) > 0;) printed.append(buffer, n);
    pclose(pipe);
    std::istringstream lines(printed);
    for (std::string line; std::getline(lines, line);)
        if (line.starts_with("FACTS ")) {
            const Json found = Json::parse(line.substr(6));
            facts[found["file"]] = found;
        }
    EXPECT_FALSE(facts.empty()) << printed;
    return facts;
}

bool installed(const std::string& program) {
    return std::system(("command -v " + program + " > /dev/null").c_str()) == 0;
}

/// Debian's Blender runs the system's Python, and its glTF importer and our script want numpy, which the package only
/// recommends.
bool blenderWorks() {
    return installed("blender") && std::system("/usr/bin/python3 -c 'import numpy' 2> /dev/null") == 0;
}

class Importers : public Cli {
protected:
    /// The tower at 64 cells as every one of `files`.
    void build(std::initializer_list<const char*> files) {
        std::string arguments = "examples/tower.sgm --resolution 64";
        for (const char* file : files) arguments += " -o " + path(file);
        report_ = built(arguments)["mesh"];
        const auto& lo = report_["bounds"][0];
        const auto& hi = report_["bounds"][1];
        for (size_t axis = 0; axis < 3; ++axis) size_[axis] = hi[axis].get<double>() - lo[axis].get<double>();
    }

    /// What a script of tests/cli/importers prints of the `models` in the folder, once Godot's editor has imported
    /// them.
    std::map<std::string, Json> godotOn(const std::string& script, size_t models) {
        scratch_.write("project.godot", "config_version=4\n[application]\nconfig/name=\"tower\"\n");
        const std::string folder = path("");
        const std::string godot = "HOME=" + folder + " timeout 60 godot3-server --path " + folder + " ";
        // Of a model the editor writes the scene first, then the file that tells where it is, and a checksum last.
        const std::string done =
            "[ $(ls " + folder + ".import/*.md5 2> /dev/null | wc -l) = " + std::to_string(models) + " ]";
        // Godot 3.2 doesn't always end by --quit, and now and then stands still before it imports anything.
        for (int attempt = 0; attempt < 4; ++attempt) {
            const std::string import =
                "rm -rf " + folder + ".import " + folder + "*.import; " + godot +
                "--editor --quit > /dev/null 2>&1 & while kill -0 $! 2> /dev/null; do sleep .2; " + done +
                " && kill $! 2> /dev/null; done; " + done;
            if (std::system(import.c_str()) == 0) break;
        }
        fs::copy("tests/cli/importers/" + script, path(script));
        return factsFrom(godot + "-s " + script);
    }

    Json report_;
    double size_[3] = {};
};

TEST_F(Importers, BlenderSeesClosedUprightMeshes) {
    if (!blenderWorks()) GTEST_SKIP() << "blender or python3-numpy isn't installed";
    build({"tower.glb", "tower.gltf", "tower.obj", "tower.ply", "tower.stl", "tower.vdb"});
    std::string command = "blender -b --factory-startup --python tests/cli/importers/blender.py --";
    for (const char* kind : {"glb", "gltf", "obj", "ply", "stl", "vdb"}) command += " " + path("tower.") + kind;
    std::map<std::string, Json> facts = factsFrom(command);
    for (const std::string kind : {"glb", "gltf", "obj", "ply", "stl"}) {
        SCOPED_TRACE(kind);
        const Json& found = facts["tower." + kind];
        ASSERT_FALSE(found.is_null());
        EXPECT_EQ(found["triangles"], report_["triangles"]);
        EXPECT_EQ(found[kind.starts_with("gl") ? "open_welded" : "open"], 0);
        EXPECT_NEAR(found["volume"], report_["volume_m3"].get<double>(), 1e-3 * report_["volume_m3"].get<double>());
        if (kind == "stl") continue;  // holds neither
        EXPECT_EQ(found["charts"], 1);
        EXPECT_EQ(found["materials"].size(), kind == "ply" ? 0u : 5u);  // a .ply holds colours
    }
    EXPECT_EQ(facts["tower.vdb"]["grids"], Json({"level_set"}));
    // Blender's z is up; it turns what is said to be y up.
    for (const char* kind : {"glb", "gltf", "obj"})
        EXPECT_NEAR(facts[std::string("tower.") + kind]["size"][2], size_[1], 1e-3) << kind;
}

TEST_F(Importers, BlenderSeesObjectsInATree) {
    if (!blenderWorks()) GTEST_SKIP() << "blender or python3-numpy isn't installed";
    report_ = built("examples/tower.sgm --resolution 64 --objects Storey,Roof -o " + path("tower.glb") + " -o " +
                    path("tower.obj"))["mesh"];
    std::map<std::string, Json> facts =
        factsFrom("blender -b --factory-startup --python tests/cli/importers/blender.py -- --tree " +
                  path("tower.glb") + " " + path("tower.obj"));
    const Json& glb = facts["tower.glb"];
    ASSERT_EQ(glb["roots"].size(), 1u);
    const Json& tower = glb["roots"][0];
    EXPECT_EQ(tower["name"], "tower");
    EXPECT_EQ(tower["known"]["grammar"], "tower.sgm");
    EXPECT_EQ(glb["triangles"], report_["triangles"]);
    ASSERT_EQ(tower["below"].size(), 1u) << "the group of storeys";
    const Json& storey = tower["below"][0]["below"][0];
    EXPECT_EQ(storey["name"], "Storey");
    EXPECT_EQ(storey["known"]["path"], "House/group/Storey");
    EXPECT_EQ(storey["known"]["line"], 12);
    ASSERT_EQ(storey["below"].size(), 9u) << "eight more storeys and the roof";
    std::set<std::string> names;
    for (const Json& above : storey["below"]) names.insert(above["name"]);
    EXPECT_TRUE(names.contains("Storey_2") && names.contains("Storey_9") && names.contains("Roof"));
    for (const Json& above : storey["below"]) EXPECT_EQ(above["known"]["rule"], "Storey#1");
    // .obj has no tree: the whole, nine storeys and the roof stand beside each other.
    EXPECT_EQ(facts["tower.obj"]["roots"].size(), 11u);
    EXPECT_EQ(facts["tower.obj"]["triangles"], report_["triangles"]);
}

TEST_F(Importers, BlenderTakesZUpWhereAFormatDoesntSay) {
    if (!blenderWorks()) GTEST_SKIP() << "blender or python3-numpy isn't installed";
    const std::string ply = path("tower.ply"), stl = path("tower.stl");
    report_ = built("examples/tower.sgm --resolution 32 --format-option up=z -o " + ply + " -o " + stl)["mesh"];
    const double height = report_["bounds"][1][1].get<double>() - report_["bounds"][0][1].get<double>();
    for (const auto& [file, found] :
         factsFrom("blender -b --factory-startup --python tests/cli/importers/blender.py -- " + ply + " " + stl))
        EXPECT_NEAR(found["size"][2], height, 1e-3) << file;
}

TEST_F(Importers, GodotSeesEveryMaterial) {
    if (!installed("godot3-server")) GTEST_SKIP() << "godot3-server isn't installed";
    build({"tower.glb", "tower.obj"});
    const auto facts = godotOn("godot.gd", 2);
    EXPECT_EQ(facts.size(), 2u);
    for (const auto& [file, found] : facts) {
        EXPECT_EQ(found["triangles"], report_["triangles"]) << file;
        EXPECT_EQ(found["surfaces"], 5) << file;
        for (size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(found["size"][axis], size_[axis], 1e-3) << file;
    }
}

TEST_F(Importers, GodotTakesColliders) {
    if (!installed("godot3-server")) GTEST_SKIP() << "godot3-server isn't installed";
    // Godot 3.2 takes a tenth of a second for each collider.
    const std::string wall = grammar(
        "terminal stone = cube\nstart A -> stone size (4, 3, .4) - cube size 1 at centre to centre move (.5, 0, 0) + "
        "pyramid size (4, 1, .4) at +y\n");
    // Of the wall four boxes around its opening, of the pyramid six side by side, for it is no box.
    std::map<std::string, int> written{{"boxes.glb", 10}, {"convex.glb", 5}, {"mesh.glb", 1}};
    for (const std::string kind : {"boxes", "convex", "mesh"}) {
        const Outcome run = sgm("build " + wall + " --resolution 64 --collider " + kind + " -o " + path(kind + ".glb"));
        ASSERT_EQ(run.code, 0) << run.out;
        EXPECT_NE(run.out.find("\n" + std::to_string(written[kind + ".glb"]) + " collider"), std::string::npos)
            << run.out;
    }
    const auto facts = godotOn("godot_colliders.gd", 3);
    EXPECT_EQ(facts.size(), 3u);
    for (const auto& [file, found] : facts) {
        SCOPED_TRACE(file);
        EXPECT_EQ(found["meshes"], 1) << "what collides isn't seen";
        EXPECT_EQ(found["bodies"], written[file]);
        EXPECT_EQ(found[file == "mesh.glb" ? "concave" : "convex"], written[file]);
        EXPECT_EQ(found[file == "mesh.glb" ? "convex" : "concave"], 0);
        EXPECT_NEAR(found["low"], -1.5, 0.05);
        EXPECT_NEAR(found["high"], 2.5, 0.2);
    }
}

TEST_F(Importers, GodotSeesLevelsAsNamedNodes) {
    if (!installed("godot3-server")) GTEST_SKIP() << "godot3-server isn't installed";
    const Outcome run = sgm("build examples/tower.sgm --resolution 64 --lod 3 -o " + path("tower.glb"));
    ASSERT_EQ(run.code, 0) << run.out;
    const auto facts = godotOn("godot_levels.gd", 1);
    ASSERT_EQ(facts.size(), 1u);
    const Json& levels = facts.at("tower.glb")["levels"];
    ASSERT_EQ(levels.size(), 3u);
    for (const int level : {1, 2}) {
        const std::string line = "level " + std::to_string(level) + ": ";
        const size_t at = run.out.find(line);
        ASSERT_NE(at, std::string::npos) << run.out;
        EXPECT_EQ(levels["tower_LOD" + std::to_string(level)], std::stoi(run.out.substr(at + line.size())));
    }
    EXPECT_GT(levels["tower_LOD0"], levels["tower_LOD1"]);
    EXPECT_GT(levels["tower_LOD1"], levels["tower_LOD2"]);
}

}  // namespace
}  // namespace sgm::cli
