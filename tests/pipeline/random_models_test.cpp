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

/// A crisp mesh of the grammar's first start on so many threads; an error in words where there is none.
Result<MeshedModel> meshed(const std::shared_ptr<const rules::Grammar>& grammar, int threads) {
    Context context;
    context.threads = threads;
    derive::Options options;
    options.budget.shapes = 3000;
    const auto model = makeModel(grammar, options, context);
    if (!model.ok()) return model.error();
    mesh::PolygonizeOptions meshing;
    meshing.surface = mesh::Surface::Crisp;
    const char* cells = std::getenv("SGM_FUZZ_CELLS");
    return makeMesh(*model, gridOf(*model, cells ? std::atoi(cells) : 24), meshing, context);
}

size_t faultsOf(const mesh::Mesh& mesh) {
    const mesh::FlatMesh flat = mesh::flatten(mesh, 1);
    std::vector<mesh::SimpleTriangle> triangles;
    for (const mesh::Triangle& t : flat.triangles) triangles.push_back({t, 0});
    return mesh::FaultFinder({flat.positions.data(), flat.positions.size()}, 1, nullptr).find(triangles).size();
}

TEST(RandomModels, AreClosedWithoutCrossingsAndTheSameOnAnyThreads) {
    const FuzzKeys keys = fuzzKeys(60);
    size_t made = 0;
    for (uint64_t key = keys.first; key < keys.end(); ++key) {
        const std::string text = RandomGrammar(mix(key + 1)).text();
        SCOPED_TRACE("key " + std::to_string(key) + "\n" + text);
        const auto grammar = grammarOf(text);
        ASSERT_TRUE(grammar);
        const auto one = meshed(grammar, 1), three = meshed(grammar, 3);
        ASSERT_EQ(one.ok(), three.ok());
        if (!one.ok()) {
            ASSERT_EQ(one.error().message, three.error().message);
            ASSERT_FALSE(one.error().message.empty());
            continue;
        }
        ASSERT_EQ(mesh::bytesOf(one->mesh), mesh::bytesOf(three->mesh));
        if (one->mesh.triangleCount() == 0) continue;  // nothing is left, or too thin for the cells
        ++made;
        const mesh::MeshFigures figures = mesh::measure(one->mesh);
        ASSERT_EQ(figures.boundaryEdges, 0u);
        ASSERT_EQ(figures.nonmanifoldEdges, 0u);
        ASSERT_GT(figures.volume_m3, 0);
        ASSERT_EQ(faultsOf(one->mesh), 0u);
    }
    EXPECT_GT(made, keys.count / 2);
}

}  // namespace
}  // namespace sgm::pipeline
