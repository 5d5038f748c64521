// Objects of their own: which are the same, where they stand, and that the field and the instanced meshes agree.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "grammar/pipeline/grids.h"
#include "grammar/pipeline/load.h"
#include "grammar/pipeline/products.h"
#include "grammar/pipeline/scene.h"
#include "modeler/eval/evaluate.h"
#include "modeler/image/texture.h"
#include "modeler/mesh/validate.h"
#include "tests/scratch.h"

namespace sgm::pipeline {
namespace {

const std::string row = "rule Row -> split x { { ~10m: Plot }* }\n";
const std::string street = "grammar 1\nterminal grass color #86a35f\nstart Street -> size (60, 1, 10) Row\n" + row;

std::shared_ptr<const rules::Grammar> read(const std::string& text) {
    syntax::Diagnostics problems;
    auto grammar = load("street.sgm", text, problems);
    EXPECT_TRUE(grammar) << (problems.all().empty() ? "" : problems.all()[0].message);
    return grammar;
}

Result<Model> modelOf(const std::string& text, Objects objects, int threads = 2) {
    const auto grammar = read(text);
    if (!grammar) return Error{Error::Kind::Input, "unread"};
    Context context{nullptr, threads};
    return makeModel(grammar, *optionsFor(*grammar, {}), context, objects);
}

Result<MadeScene> sceneOf(const std::string& text, int threads = 2) {
    const auto model = modelOf(text, Objects::Apart, threads);
    if (!model.ok()) return model.error();
    Context context{nullptr, threads};
    return makeScene(*model, {.resolution = 24, .meshing = {.surface = mesh::Surface::Crisp}}, context);
}

std::string whyNot(const std::string& text) {
    const auto made = sceneOf(text);
    return made.ok() ? "" : made.error().message;
}

TEST(Scene, EqualPlacesAreOneObject) {
    const auto made = sceneOf(street +
                              "param high = 2m in 1m..9m\n"
                              "rule Plot -> grass, size 4 place House { high = if(here.x > 0, 5m, 3m) }\n"
                              "start House -> cube size (4, high, 4)\n");
    ASSERT_TRUE(made.ok()) << made.error().message;
    const mesh::Scene& scene = made->scene;
    ASSERT_EQ(scene.objects.size(), 2u);
    ASSERT_EQ(scene.instances.size(), 6u);
    EXPECT_EQ(scene.objects[0].name, "House");
    EXPECT_EQ(scene.objects[1].name, "House_2");
    EXPECT_EQ(scene.objects[0].values.at("param high"), "3m");
    for (const mesh::Instance& instance : scene.instances) {
        const float high = instance.part.pose.origin.x > 0 ? 5 : 3;
        EXPECT_NEAR(scene.objects[instance.object].mesh.bounds().size().y, high, 1e-4f);
        // Its lowest point stands on the scope's foot: the scope is 4 m high about y = 0.
        EXPECT_NEAR(instance.part.pose.origin.y + scene.objects[instance.object].mesh.bounds().lo.y, -2, 1e-4);
        EXPECT_EQ(instance.part.line(), 6u);
    }
}

TEST(Scene, OnlyChanceThatDecidesSomethingTellsObjectsApart) {
    const std::string plain = street + "start House -> cube size (4, 3, 4)\nrule Plot -> size 4 place House";
    EXPECT_EQ(sceneOf(plain + "\n")->scene.objects.size(), 1u);
    const std::string drawn = street + "start House -> cube size (4, 1m..9m, 4)\nrule Plot -> size 4 place House";
    EXPECT_EQ(sceneOf(drawn + "\n")->scene.objects.size(), 6u);
    const auto two = sceneOf(drawn + " variety 2\n");
    EXPECT_EQ(two->scene.objects.size(), 2u);
    EXPECT_EQ(two->scene.instances.size(), 6u);
}

TEST(Scene, TheFieldAndTheInstancedMeshesAgree) {
    const std::string text = street +
                             "rule Plot -> grass, turn 30deg size (4, 4, 4) move (0, 2.5m, 0) place House\n"
                             "start House -> stone size (4, 3, 3) : Body\nterminal stone color #c8b090\n"
                             "rule Body -> + sphere size 2 at +y displace billow(.2m, 1/m) - cube size (1, 1, 1) at +z "
                             "+ place Lamp at -z size (.2, 1, .2)\n"
                             "start Lamp -> cylinder size (.5, 2, .5)\n";
    const auto model = modelOf(text, Objects::Grafted);
    ASSERT_TRUE(model.ok()) << model.error().message;
    EXPECT_TRUE(model->derivation.objects.empty());
    Context context{nullptr, 2};
    auto whole = makeMesh(*model, gridOf(*model, 400), {.surface = mesh::Surface::Crisp}, context);
    ASSERT_TRUE(whole.ok());

    const auto apart = modelOf(text, Objects::Apart);
    auto ground = makeMesh(*apart, gridOf(*apart, 400), {.surface = mesh::Surface::Crisp}, context);
    ASSERT_TRUE(ground.ok());
    const auto made = makeScene(*apart, {.cell_m = .15, .meshing = {.surface = mesh::Surface::Crisp}}, context);
    ASSERT_TRUE(made.ok()) << made.error().message;
    EXPECT_EQ(made->scene.instances.size(), 12u);
    EXPECT_EQ(made->scene.objects.size(), 7u);  // noise has a pattern of its own in every house
    const auto flat = mesh::flatten(made->scene, ground->mesh);
    ASSERT_TRUE(flat.ok());
    const Box3f a = whole->mesh.bounds(), b = flat->mesh.bounds();
    EXPECT_LT(length(a.lo - b.lo) + length(a.hi - b.hi), .05f);
    EXPECT_EQ(length(mesh::boundsOf(made->scene, ground->mesh).size() - b.size()) < 1.5f, true);
    // The lamps reach into the house behind them by nothing, so volumes add up.
    EXPECT_NEAR(mesh::measure(flat->mesh).volume_m3, mesh::measure(whole->mesh).volume_m3,
                .005 * mesh::measure(whole->mesh).volume_m3);
    // Noise lies where the object's own does: no vertex of the instanced meshes is far from the field's surface.
    double farthest_m = 0;
    eval::Workspace workspace;
    for (const mesh::Chunk& chunk : flat->mesh.chunks)
        for (const Vec3f& p : chunk.positions) {
            float value = 0;
            eval::evaluate(model->tape, {&p.x, &p.y, &p.z, 1}, &value, workspace);
            farthest_m = std::max(farthest_m, static_cast<double>(std::abs(value)));
        }
    EXPECT_LT(farthest_m, .16);  // the lamps reach .15 m into the houses
}

TEST(Scene, ObjectsGrowInLots) {
    const auto made = sceneOf(street + "rule Plot -> footprint ell(8, 8, 3, 3) place Block on lot\n" +
                              "start Block -> extrude 5m wall\nterminal wall color #ffffff\n");
    ASSERT_TRUE(made.ok()) << made.error().message;
    ASSERT_EQ(made->scene.objects.size(), 1u);
    EXPECT_NEAR(mesh::measure(made->scene.objects[0].mesh).volume_m3, 5 * (64 - 25), .01);
}

TEST(Scene, SaysWhyAnObjectCantBe) {
    const std::string house = "start House -> cube size (4, high, 4)\nparam high = 2m in 1m..9m\n";
    EXPECT_NE(whyNot(street + house + "rule Plot -> size 4 place House { high = here.x }\n").find("street.sgm:7:"),
              std::string::npos);
    EXPECT_NE(whyNot(street + "rule Plot -> size 4 place House\nstart House -> cube size (people * 4)\n"
                              "map people = bump((0m, 0m), 100m)\n")
                  .find("the map 'people' is of the ground"),
              std::string::npos);
    EXPECT_NE(whyNot(street + "rule Plot -> size 4 place House\nstart House -> cube, size 1 place House\n")
                  .find("'House' may hold itself"),
              std::string::npos);
    EXPECT_NE(whyNot(street + house + "rule Plot -> grass - Hole size 4\nrule Hole -> place House\n")
                  .find("can't be cut with"),
              std::string::npos);
    EXPECT_NE(whyNot(street + "param n = 2 in 1..9\nstart House -> cube size (4, n, 4)\n"
                              "rule Plot -> size 4 place House { n = 1 + scope.x / 3m }\n")
                  .find("write 'round(…)'"),
              std::string::npos);
}

TEST(Scene, TooManyPlacesAreABudgetsError) {
    const auto model = modelOf(street + "rule Plot -> size 4 place House\nstart House -> cube, cube\n", Objects::Apart);
    Context context{nullptr, 1};
    SceneRequest request{.resolution = 8};
    request.budget.shapes = 5;
    const auto made = makeScene(*model, request, context);
    ASSERT_FALSE(made.ok());
    EXPECT_EQ(made.error().kind, Error::Kind::Budget);
    derive::Derivation copy = model->derivation;
    derive::Budget small;
    small.shapes = copy.tree.shapes.size() + 7;
    EXPECT_EQ(graftObjects(copy, Objects::Grafted, small, context).error().kind, Error::Kind::Budget);
}

nlohmann::json gltfOf(const std::string& text, int threads, const std::string& places, std::string& bytes) {
    const auto model = modelOf(text, Objects::Apart, threads);
    Context context{nullptr, threads};
    const auto meshed = makeMesh(*model, gridOf(*model, 48), {.surface = mesh::Surface::Crisp}, context);
    const auto made = makeScene(*model, {.resolution = 24, .meshing = {.surface = mesh::Surface::Crisp}}, context);
    exporter::ExportInput input = exportInput(*model, "street.sgm");
    input.mesh = &meshed->mesh;
    input.scene = &made->scene;
    input.provenance = &made->scene.ground;
    input.options = {{"places", places}};
    const Scratch scratch;
    const auto file = scratch / "street.gltf";
    const Status written = exporter::write(input, file);
    EXPECT_TRUE(written.ok());
    bytes = contentOf(file);
    return nlohmann::json::parse(bytes);
}

TEST(Scene, WordsThatNoObjectHasAreToldApartAndGrafted) {
    const auto told = [](const syntax::Diagnostics& found) {
        size_t count = 0;
        for (const auto& d : found.all()) count += d.message.find("no edge of this plan is called 'sides'") == 0;
        return count;
    };
    const std::string text = street +
                             "rule Plot -> grass, size 4 place House variety 3\n"
                             "start House -> cube size (4, 1m..9m, 4), size 4 faces .2m { sides: cube | top: cube }\n";
    const auto apart = sceneOf(text);
    ASSERT_TRUE(apart.ok()) << apart.error().message;
    EXPECT_EQ(told(apart->warnings), 1u);
    const auto grafted = modelOf(text, Objects::Grafted);
    ASSERT_TRUE(grafted.ok()) << grafted.error().message;
    EXPECT_EQ(told(derive::warnings(grafted->derivation)), 1u);
}

std::vector<std::string> floatsIn(const std::string& text) {
    const auto made = sceneOf("grammar 2\nterminal lawn color #7f9c58\nterminal wall color #e2d6bd\n" + text +
                              "start House -> wall size (8m, 6m, 8m)\n");
    EXPECT_TRUE(made.ok()) << made.error().message;
    std::vector<std::string> told;
    if (made.ok())
        for (const auto& d : made->warnings.all())
            if (d.message.find("float") != std::string::npos) told.push_back(d.message);
    return told;
}

const std::string lawn = "start Town -> lawn size (60m, 1m, 60m) + Lots size (40m, 1m, 10m) at +y";
const std::string lowAndHigh = "rule Low -> place House\nrule High -> place House\n";

TEST(Scene, ObjectsThatHangInTheAirAreToldOnceALine) {
    const auto told = floatsIn(lawn + " move (0, 6m, 0)\nrule Lots -> row 3 along x gap 4m { place House }\n");
    ASSERT_EQ(told.size(), 1u);
    EXPECT_EQ(told[0],
              "'Town/lawn/Lots/row/place', made by rule 'Lots#1' (street.sgm:5) and 2 more like it float: the object "
              "'House' touches nothing that stands; 6 m below is 'Town/lawn'");
    const auto one = floatsIn(lawn + "\nrule Lots -> Low + High move (0, 9m, 0)\n" + lowAndHigh);
    ASSERT_EQ(one.size(), 1u);
    EXPECT_NE(one[0].find("(street.sgm:7) floats: the object 'House'"), std::string::npos) << one[0];
    const auto within = floatsIn(lawn + "\nrule Lots -> place Pair\n" + lowAndHigh +
                                 "start Pair -> lawn size (9m, 1m, 9m) + High move (0, 9m, 0)\n");
    EXPECT_EQ(within.size(), 1u) << "an object holds it";
}

TEST(Scene, ObjectsThatStandAreNotTold) {
    EXPECT_TRUE(floatsIn(lawn + "\nrule Lots -> row 3 along x gap 4m { place House }\n").empty());
    EXPECT_TRUE(floatsIn(lawn + " move (0, -1m, 0)\nrule Lots -> place House\n").empty()) << "partly sunk";
    EXPECT_TRUE(floatsIn(lawn + "\nrule Lots -> Low + High move (0, 6m, 0)\n" + lowAndHigh).empty())
        << "on another object";
    EXPECT_TRUE(
        floatsIn("start Town -> Lots size (60m, 1m, 10m)\nrule Lots -> row 3 along x gap 4m { place House }\n").empty())
        << "nothing else is solid";
}

TEST(Scene, ObjectsShareTexturesThatAreAlike) {
    mesh::Scene scene;
    for (const float width_m : {1.f, 1.f, 2.f}) {
        auto texture = std::make_shared<image::Texture>();
        texture->width_m = width_m;
        mesh::SceneObject& object = scene.objects.emplace_back();
        Material& brick = object.provenance.materials.emplace_back();
        brick.name = "brick", brick.texture = texture;
        object.provenance.parts.emplace_back().material = 1;
    }
    mesh::shareMaterials(scene);
    std::vector<std::string> names;
    for (const mesh::SceneObject& object : scene.objects)
        names.push_back(object.provenance.materials[object.provenance.parts[1].material].name);
    EXPECT_EQ(names, (std::vector<std::string>{"brick", "brick", "brick_2"}));
}

TEST(Scene, FilesHoldEachObjectOnce) {
    const std::string text = street +
                             "terminal stone color #c8b090\n"
                             "rule Plot -> grass, turn 20deg size 4 place House variety 3\n"
                             "start House -> stone size (4, 1m..9m, 4)\n";
    std::string one, three, gpu;
    const auto nodes = gltfOf(text, 1, "nodes", one);
    EXPECT_EQ(gltfOf(text, 3, "nodes", three), nodes);
    EXPECT_EQ(one, three);
    const size_t objects = nodes["meshes"].size() - 1;
    EXPECT_LE(objects, 3u);
    EXPECT_EQ(nodes["nodes"].size(), 7u);
    EXPECT_EQ(nodes["materials"].size(), 2u);
    EXPECT_EQ(nodes["nodes"][1]["extras"]["start"], "House");
    EXPECT_EQ(nodes["nodes"][1]["extras"]["line"], 6);
    const auto q = nodes["nodes"][1]["rotation"];
    EXPECT_NEAR(2 * std::asin(q[1].get<double>()), 20 * 3.14159265 / 180, 1e-6);
    const auto instanced = gltfOf(text, 2, "gpu", gpu);
    EXPECT_EQ(instanced["nodes"].size(), 1 + objects);
    size_t places = 0;
    for (size_t i = 1; i < instanced["nodes"].size(); ++i) {
        const auto& attributes = instanced["nodes"][i]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
        places += instanced["accessors"][attributes["TRANSLATION"].get<size_t>()]["count"].get<size_t>();
    }
    EXPECT_EQ(places, 6u);
}

}  // namespace
}  // namespace sgm::pipeline
