// Grammars by chance become meshes: closed, oriented, without crossings, and the same bytes on one thread and on three.
#include "grammar/pipeline/grids.h"
#include "grammar/pipeline/mesh_edits.h"
#include "grammar/pipeline/meshing.h"
#include "grammar/pipeline/model.h"
#include "modeler/mesh/faults.h"
#include "modeler/mesh/flat_mesh.h"
#include "modeler/mesh/validate.h"
#include "tests/derive/grammars.h"
#include "tests/fuzz_keys.h"
#include "tests/mesh/mesh_bytes.h"
#include "tests/pipeline/random_grammar.h"

namespace sgm::pipeline {
namespace {

using namespace testing_;

/// A crisp mesh of the grammar's first start, of `cells` along its longest side, on so many threads; an error in words
/// where there is none.
Result<MeshedModel> meshed(const std::shared_ptr<const rules::Grammar>& grammar, int cells, int threads) {
    Context context;
    context.threads = threads;
    derive::Options options;
    options.budget.shapes = 3000;
    const auto model = makeModel(grammar, options, context);
    if (!model.ok()) return model.error();
    mesh::PolygonizeOptions meshing;
    meshing.surface = mesh::Surface::Crisp;
    return makeMesh(*model, gridOf(*model, cells), meshing, context);
}

size_t faultsOf(const mesh::Mesh& mesh) {
    const mesh::FlatMesh flat = mesh::flatten(mesh, 1);
    std::vector<mesh::SimpleTriangle> triangles;
    for (const mesh::Triangle& t : flat.triangles) triangles.push_back({t, 0});
    return mesh::FaultFinder({flat.positions.data(), flat.positions.size()}, 1, nullptr).find(triangles).size();
}

void expectSound(const mesh::Mesh& mesh) {
    const mesh::MeshFigures figures = mesh::measure(mesh);
    ASSERT_EQ(figures.boundaryEdges, 0u);
    ASSERT_EQ(figures.nonmanifoldEdges, 0u);
    ASSERT_GT(figures.volume_m3, 0);
    ASSERT_EQ(faultsOf(mesh), 0u);
}

TEST(RandomModels, AreClosedWithoutCrossingsAndTheSameOnAnyThreads) {
    const FuzzKeys keys = fuzzKeys(60);
    const char* given = std::getenv("SGM_FUZZ_CELLS");
    const int cells = given ? std::atoi(given) : 24;
    size_t made = 0;
    for (uint64_t key = keys.first; key < keys.end(); ++key) {
        const std::string text = RandomGrammar(mix(key + 1)).text();
        SCOPED_TRACE("key " + std::to_string(key) + "\n" + text);
        const auto grammar = grammarOf(text);
        ASSERT_TRUE(grammar);
        const auto one = meshed(grammar, cells, 1), three = meshed(grammar, cells, 3);
        ASSERT_EQ(one.ok(), three.ok());
        if (!one.ok()) {
            ASSERT_EQ(one.error().message, three.error().message);
            ASSERT_FALSE(one.error().message.empty());
            continue;
        }
        ASSERT_EQ(mesh::bytesOf(one->mesh), mesh::bytesOf(three->mesh));
        if (one->mesh.triangleCount() == 0) continue;  // nothing is left, or too thin for the cells
        ++made;
        ASSERT_NO_FATAL_FAILURE(expectSound(one->mesh));
    }
    EXPECT_GT(made, keys.count / 2);
}

// Number 100,217: fans around the middles of two surfaces that pass one cell crossed.
TEST(RandomModels, OfTwoSurfacesCloseTogetherInOneCellDontCross) {
    const auto grammar = grammarOf(
        "grammar 2\nuse \"std/kifs.sgm\"\nstart A -> size (7.25, 8.25, 8.25) around 3 radius 1.25m { B }\n"
        "rule B -> (torus size (4.25, 3.75, 2.25) & roof(.3) size 25.5% turn (-89.25deg, -8.75deg, 0deg) "
        "clad palazzo)\n");
    ASSERT_TRUE(grammar);
    const auto made = meshed(grammar, 32, 2);
    ASSERT_TRUE(made.ok());
    expectSound(made->mesh);
}

}  // namespace
}  // namespace sgm::pipeline
