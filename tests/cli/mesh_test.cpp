// Meshes from files, through the whole program.
#include "tests/cli/program.h"

namespace sgm::cli {
namespace {

class Meshes : public Cli {};

TEST_F(Meshes, WhatWasExportedIsTheSameSolidAgain) {
    const Json was =
        built(grammar("start A -> cube size (3, 2, 1) - sphere size (1, 1, 2) + sphere size 1 move (0, 1, 0)\n") +
              " --resolution 96 -o " + path("first.obj"))["mesh"];
    const double height = was["bounds"][1][1].get<double>() - was["bounds"][0][1].get<double>();
    const Json again = built(grammar("start A -> mesh(\"first.obj\") size (3, " + std::to_string(height) + ", 1)\n") +
                             " --resolution 96")["mesh"];
    ASSERT_FALSE(again.is_null());
    EXPECT_NEAR(again["volume_m3"].get<double>(), was["volume_m3"].get<double>(), 0.02);
    EXPECT_EQ(again["boundary_edges"], 0);
    EXPECT_EQ(again["euler"], was["euler"]);
}

TEST_F(Meshes, SayWhereTheFileIsNamedAndWhatToMend) {
    const std::string missing = grammar("start A -> mesh(\"nowhere.obj\")\n");
    for (const std::string& command : {"check " + missing, "build -q " + missing + " -o " + path("x.glb")}) {
        const Outcome run = sgm(command);
        EXPECT_EQ(run.code, 1) << command;
        EXPECT_NE(run.out.find("test.sgm:2:17: error: can't use \"nowhere.obj\""), std::string::npos) << run.out;
    }
    std::ofstream(path("open.obj")) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\n";
    const Outcome open = sgm("check " + grammar("start A -> mesh(\"open.obj\")\n"));
    EXPECT_EQ(open.code, 1);
    EXPECT_NE(open.out.find("is open near"), std::string::npos) << open.out;
    EXPECT_NE(open.out.find("close its holes"), std::string::npos);
    EXPECT_EQ(sgm("check " + grammar("start A -> mesh(\"../secret.obj\")\n")).code, 1);
}

TEST_F(Meshes, ThatHoldNothingAreToldWithTheCell) {
    for (const char* body : {"cube size (1000, 1, .001)", "sphere - cube size 4"})
        for (const char* ending : {".ply", ".vdb"}) {
            const Outcome run = sgm("build -q " + grammar(std::string("start A -> ") + body + "\n") + " -o " +
                                    path(std::string("x") + ending));
            EXPECT_EQ(run.code, 1) << body;
            EXPECT_NE(run.out.find("no surface at cells of"), std::string::npos) << run.out;
            EXPECT_FALSE(fs::exists(path(std::string("x") + ending)));
        }
}

TEST_F(Meshes, StreamedFilesHaveTheSameBytes) {
    const std::string file = grammar("start A -> torus size (3, 1, 3) + sphere size 2 move (0, 1, 0)\n");
    for (const char* ending : {".ply", ".stl", ".off"}) {
        const std::string whole = path(std::string("whole") + ending),
                          streamed = path(std::string("streamed") + ending);
        // What is streamed isn't simplified.
        ASSERT_EQ(sgm("build -q " + file + " --resolution 100 --tolerance 0 -o " + whole).code, 0);
        const Outcome run = sgm("build -q " + file + " --resolution 100 --stream -o " + streamed);
        ASSERT_EQ(run.code, 0) << run.out;
        EXPECT_EQ(read(streamed), read(whole)) << ending;
    }
    for (const std::string& refused :
         {" -o " + path("a.glb"), " -o " + path("a.ply") + " -o " + path("b.stl"),
          " -o " + path("a.ply") + " --smooth 2", " -o " + path("a.ply") + " --report " + path("r.json")}) {
        const Outcome run = sgm("build -q " + file + " --stream" + refused);
        EXPECT_EQ(run.code, 2) << refused;
        EXPECT_NE(run.out.find("--stream"), std::string::npos) << run.out;
    }
}

TEST_F(Meshes, OfTheShapeAloneHaveTheSameBytesWhateverElseIsAsked) {
    // Quiet, such a build keeps no normals and no origins; with a report or another file it does.
    const std::string file = grammar("start A -> torus size (3, 1, 3) + sphere size .8 move (0, 3, 0)\n");
    for (const char* keep : {"", " --keep largest --flip-normals"}) {
        const std::string common = file + " --resolution 60 --format-option attributes=none" + keep;
        ASSERT_EQ(
            sgm("build -q " + common + " -o " + path("q.ply") + " -o " + path("q.stl") + " -o " + path("q.off")).code,
            0);
        ASSERT_EQ(
            sgm("build " + common + " -o " + path("s.ply") + " -o " + path("s.stl") + " -o " + path("s.off")).code, 0);
        ASSERT_EQ(
            sgm("build -q " + common + " -o " + path("g.ply") + " -o " + path("g.glb") + " --report " + path("r.json"))
                .code,
            0);
        for (const char* ending : {".ply", ".stl", ".off"})
            EXPECT_EQ(read(path("q") + ending), read(path("s") + ending)) << ending << keep;
        EXPECT_EQ(read(path("g.ply")), read(path("q.ply"))) << keep;
    }
    for (const char* edit : {" --smooth 1", " --simplify .5", " --validate", " --cave"})
        EXPECT_EQ(sgm("build -q " + file + " --resolution 40 -o " + path("e.stl") + edit).code, 0) << edit;
}

TEST_F(Meshes, ObjectsOfPlaceAreInTheReport) {
    const std::string file = grammar(
        "start Row -> size (60, 4, 6) split x { { 6m: place House }* }\n"
        "start House -> cube size (3, 3, 3)\n");
    ASSERT_EQ(sgm("build -q " + file + " --resolution 32 -o " + path("a.stl") + " --report " + path("r.json")).code, 0);
    const Json report = Json::parse(read(path("r.json")));
    EXPECT_EQ(report["placed"], (Json{{"objects", 1}, {"places", 10}, {"triangles", 120}}));
    EXPECT_EQ(report["mesh"]["triangles"], 0);
    EXPECT_FALSE(report["mesh"].contains("bounds")) << "of nothing";
}

TEST_F(Meshes, AreDividedIntoObjectsOfSymbols) {
    const std::string file = grammar(
        "start A -> cube size 2 : Wall\nrule Wall -> cube size 2 + Post at +y + Post at +x\n"
        "rule Post -> cube size .5\n");
    const std::string out = path("a.gltf");
    ASSERT_EQ(sgm("build -q " + file + " --resolution 32 --objects Post --format-option instances=no -o " + out).code,
              0);
    const Json gltf = Json::parse(read(out));
    std::vector<std::string> names;
    for (const Json& node : gltf["nodes"]) names.push_back(node["name"]);
    EXPECT_EQ(names, (std::vector<std::string>{"test", "Wall", "cube", "Post", "Post_2"}));
    const Json& second = gltf["nodes"][4]["extras"];
    EXPECT_EQ(second["path"], "A/Wall/cube/Post[2]");
    EXPECT_EQ(second["line"], 3);
    EXPECT_EQ(second["rule"], "Wall#1");
    EXPECT_EQ(gltf["meshes"].size(), 3u);
    // Objects don't change what they divide.
    ASSERT_EQ(sgm("build -q " + file + " --resolution 32 -o " + path("b.gltf")).code, 0);
    const auto triangles = [](const Json& model) {
        size_t count = 0;
        for (const Json& mesh : model["meshes"])
            for (const Json& p : mesh["primitives"])
                count += model["accessors"][p["indices"].get<size_t>()]["count"].get<size_t>() / 3;
        return count;
    };
    EXPECT_EQ(triangles(gltf), triangles(Json::parse(read(path("b.gltf")))));
}

TEST_F(Meshes, OfEqualObjectsAreWrittenOnce) {
    const std::string file = grammar(
        "start Street -> cube size .5 for k in 1..6 { + House at +x to centre move (k * 3.717, .3 * k, .111 * k) }\n"
        "rule House -> cube size (2, 3, 2) - cube size (.8, 1, .5) at +z to centre + prism size (2.2, 1, 2.2) at +y\n");
    ASSERT_EQ(sgm("build -q " + file + " --resolution 128 --objects House -o " + path("a.gltf")).code, 0);
    const Json gltf = Json::parse(read(path("a.gltf")));
    EXPECT_EQ(gltf["meshes"].size(), 2u) << "the first stone and one house";
    size_t houses = 0;
    for (const Json& node : gltf["nodes"])
        if (node["name"].get<std::string>().starts_with("House")) {
            EXPECT_EQ(node["mesh"], 1);
            const double k = static_cast<double>(houses++);
            if (k == 0) continue;
            EXPECT_NEAR(node["translation"][0].get<double>(), 3.717 * k, 1e-9);
            EXPECT_NEAR(node["translation"][2].get<double>(), .111 * k, 1e-9);
        }
    EXPECT_EQ(houses, 6u);
}

TEST_F(Meshes, RefuseObjectsThatNobodyHolds) {
    const std::string file = grammar("start A -> cube size 2 : Wall\n");
    const std::pair<std::string, std::string> refused[] = {
        {"--objects Wal -o " + path("a.glb"), "no shape is called 'Wal' (did you mean 'Wall'?); there are A, "},
        {"--objects Wall, -o " + path("a.glb"), "--objects: objects 'Wall,': write none, material, shape"},
        {"--objects Wall -o " + path("a.stl"),
         "--objects Wall: objects go into .glb .gltf .obj .usda .html, and no such file is asked for"},
        {"--format-option instances=no -o " + path("a.glb"), "instances=no is about objects: add --objects"},
        {"--objects Wall --collider boxes --format-option engine=unreal -o " + path("a.glb"),
         "Unreal takes colliders by the name of one mesh"}};
    for (const auto& [arguments, message] : refused) {
        const Outcome run = sgm("build " + file + " --resolution 16 " + arguments);
        EXPECT_EQ(run.code, 2) << arguments;
        EXPECT_NE(run.out.find(message), std::string::npos) << run.out;
        EXPECT_FALSE(fs::exists(path("a.glb")));
    }
}

}  // namespace
}  // namespace sgm::cli
