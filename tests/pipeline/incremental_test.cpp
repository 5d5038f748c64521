// Walks over the parameters of grammars: after every step tree, field, parts and mesh of what was kept and what changed
// are those of a build from the start, byte for byte.
#include "grammar/pipeline/incremental.h"

#include "tests/derive/same.h"
#include "tests/fuzz_keys.h"
#include "tests/mesh/mesh_bytes.h"

namespace sgm::pipeline {
namespace {

using namespace testing_;

auto told(const Part& p) { return std::tuple(p.path.text(), p.source(), p.material, p.pose); }

/// A model followed through options, on one lattice.
class Followed {
public:
    Followed(std::shared_ptr<const rules::Grammar> grammar, int resolution)
        : grammar_(std::move(grammar)), resolution_(resolution) {}

    /// Brings the pipeline there, and compares with a build from the start; where that fails, so must the pipeline.
    void expectSame(const derive::Options& options) {
        const auto derivation = derive::derive(grammar_, options, nullptr);
        auto model = derivation.ok() ? lower::lower(*derivation, nullptr) : derivation.error();
        Context context;
        const Status done = pipeline.to(grammar_, options, context);
        ASSERT_EQ(done.ok(), model.ok());
        if (!done.ok()) {
            EXPECT_EQ(done.error().message, model.error().message);
            return;
        }
        testing_::expectSame(pipeline.derivation(), *derivation);
        const auto &parts = pipeline.model().provenance.parts, &wholeParts = (*model)->provenance.parts;
        ASSERT_TRUE(std::equal(parts.begin(), parts.end(), wholeParts.begin(), wholeParts.end(),
                               [](const Part& a, const Part& b) { return told(a) == told(b); }));
        EXPECT_EQ(pipeline.model().shapeOf, (*model)->shapeOf);
        const eval::Tape tape = eval::compile((*model)->graph, (*model)->field, (*model)->graph.constants());
        ASSERT_EQ(eval::fingerprint(pipeline.tape()), eval::fingerprint(tape));
        EXPECT_EQ(pipeline.tape().lipschitz(), tape.lipschitz());
        EXPECT_EQ(pipeline.model().field.bounds, (*model)->field.bounds);
        expectSameMesh(tape, (*model)->field.bounds);
    }

    IncrementalPipeline pipeline{{.threads = 2}};
    size_t blocksKept = 0, followed = 0;

private:
    void expectSameMesh(const eval::Tape& tape, const Box3f& bounds) {
        if (cell_m_ == 0) cell_m_ = mesh::cellFor(bounds, resolution_);
        grid_ = mesh::gridToKeep(grid_, bounds, cell_m_, 1);
        mesh::Counts counts;
        const auto again = pipeline.mesh(grid_, nullptr, counts);
        ASSERT_TRUE(again.ok()) << again.error().message;
        blocksKept += pipeline.rebuild().blocksKept();
        followed += pipeline.followed();
        const auto blocks = mesh::subdivide(tape, grid_, 2, nullptr, counts);
        ASSERT_TRUE(blocks.ok());
        const auto whole = mesh::polygonize(*blocks, grid_, {.threads = 2}, nullptr, counts);
        ASSERT_TRUE(whole.ok());
        ASSERT_EQ(mesh::bytesOf(**again), mesh::bytesOf(*whole));
    }

    std::shared_ptr<const rules::Grammar> grammar_;
    int resolution_;
    mesh::Grid grid_;
    float cell_m_ = 0;
};

derive::Options defaults(const rules::Grammar& grammar, uint32_t start = 0) {
    derive::Options options;
    options.start = start;
    for (const rules::Param& p : grammar.params) options.params.push_back(p.value);
    return options;
}

class Walk : public testing::TestWithParam<const char*> {};

TEST_P(Walk, KeepsTheBytes) {
    const auto grammar = grammarOf(fileText(GetParam()));
    ASSERT_TRUE(grammar && !grammar->params.empty());
    derive::Options options = defaults(*grammar);
    options.budget.shapes = 3000;
    Followed followed(grammar, 40);
    uint64_t key = hashText(GetParam());
    for (int step = 0; step < 10; ++step, key = mix(key)) {
        const size_t which = pick(key, grammar->params.size());
        SCOPED_TRACE("step " + std::to_string(step) + ", " + grammar->params[which].name);
        if (step > 0 && step != 4)
            options.params[which] = drawn(grammar->params[which], options.params[which], combine(key, which));
        if (step == 8) options.seed = 7;
        followed.expectSame(options);
        if (testing::Test::HasFatalFailure()) return;
    }
    // Every parameter of the L-system's house moves all of its walls.
    const bool movesAll = std::string(GetParam()) == "examples/buildings/lsystem.sgm";
    EXPECT_TRUE(followed.blocksKept > 0 || movesAll);
    EXPECT_TRUE(followed.followed > 0 || movesAll);
}

INSTANTIATE_TEST_SUITE_P(Examples, Walk,
                         testing::Values("examples/tower.sgm", "examples/grotto.sgm", "examples/cumulus.sgm",
                                         "examples/buildings/hall.sgm", "examples/caves/branching.sgm",
                                         "tests/bench/scenes/buildings.sgm", "examples/morphs.sgm",
                                         "examples/buildings/terrace.sgm", "examples/buildings/villa.sgm",
                                         "examples/buildings/lsystem.sgm"));

/// 200 buildings, of which one is dragged, then all.
TEST(District, OneBuildingIsDragged) {
    const auto grammar = grammarOf(fileText("tests/bench/scenes/buildings.sgm"));
    ASSERT_TRUE(grammar);
    derive::Options options = defaults(*grammar, 2);
    Followed district(grammar, 100);
    district.expectSame(options);
    const size_t all = district.pipeline.rebuild().blocksMade();
    for (const double height : {3.05, 3.3, 2.9, 4.1}) {
        options.params[1].n[0] = height;
        district.expectSame(options);
        EXPECT_TRUE(district.pipeline.followed()) << height;
        EXPECT_LT(district.pipeline.rebuild().blocksMade(), all / 2);
    }
    options.params[0].n[0] = 3.2;
    district.expectSame(options);
    options.params[1].n[0] = 3.2;  // as high as the others
    district.expectSame(options);
}

/// Parts that cut, blend, mirror each other's surface, shrink to a morph's end or to nothing special (0, 1).
constexpr const char* mixed =
    "grammar 1\n"
    "param a = .4 in 0..1\nparam b = 1m in 0m..2m\nparam c = 1.5m in .5m..3m\nparam t = 20deg in 0deg..45deg\nparam n "
    "= 2 in 1..4\n"
    "param melt = .2m in 0m..1m\nparam rough = .05m in 0m..0.2m\nparam paint = #ff0000\n"
    "terminal red = cube color paint\n"
    "start All -> Row, Melted move (0, 0, 8m), Noisy move (0, 0, -8m)\n"
    "rule Row -> for k in 1..6 { Box with high = if(k == 3, c, 2m) move (3m * k, 0, 0) }\n"
    "rule Box -> cube size (2, high, 2) - sphere size 1 at +y to centre move (0, b - 1m, 0)\n"
    "rule Melted -> cube size (3, c, 3) + sphere size 2 at +y to centre blend melt morph sphere size 3 by a\n"
    "rule Noisy -> red size (c, 2, 2) turn t, group\n"
    "rule Turned repeat n -> + cube size 1 at +y : Turned\n";

TEST(Mixed, EveryParameterKeepsTheBytes) {
    std::string text = mixed;
    text.replace(text.find(", group\n"), 8, ", Pile move (4m, 0, 0) displace billow(rough, 2/m)\n");
    text += "rule Pile -> cube : Turned\n";
    const auto grammar = grammarOf(text);
    ASSERT_TRUE(grammar);
    derive::Options options = defaults(*grammar);
    Followed followed(grammar, 60);
    const FuzzKeys keys = fuzzKeys(48);
    uint64_t key = 5 + keys.first;
    for (size_t step = 0; step < keys.count; ++step, key = mix(key)) {
        const size_t which = step % grammar->params.size();
        SCOPED_TRACE("step " + std::to_string(step) + ", " + grammar->params[which].name);
        rules::Value& value = options.params[which];
        const rules::Param& param = grammar->params[which];
        const double end = pick(key, 6);
        if (step > 0 && param.lo && end < 2)
            value.n[0] = end == 0 ? param.lo->n[0] : param.hi->n[0];
        else if (step > 0 && param.lo)
            value = drawn(param, value, key);
        else if (step > 0)
            value.n[1] = uniform(key);
        followed.expectSame(options);
        if (testing::Test::HasFatalFailure()) return;
    }
    EXPECT_GT(followed.followed, 12u);
    EXPECT_GT(followed.blocksKept, 0u);
}

TEST(Pipeline, AfterAnErrorItStartsAfresh) {
    const auto grammar = grammarOf(
        "grammar 1\nparam n = 2 in 0..9\nparam w = 1m in .1m..2m\nstart A -> for k in 1..3 when k <= n { cube size w "
        "move (2m * k, 0, 0) }\n");
    ASSERT_TRUE(grammar);
    derive::Options options = defaults(*grammar);
    Followed followed(grammar, 30);
    followed.expectSame(options);
    options.params[0].n[0] = 0;  // nothing solid
    followed.expectSame(options);
    options.params[0].n[0] = 2;
    followed.expectSame(options);
    options.params[1].n[0] = 1.5;
    Progress progress;
    progress.cancel();
    mesh::Counts counts;
    Context context;
    ASSERT_TRUE(followed.pipeline.to(grammar, options, context).ok());
    EXPECT_FALSE(followed.pipeline.mesh({{-2, -2, -2}, .1f, {100, 40, 40}}, &progress, counts).ok());
    followed.expectSame(options);
    options.params[1].n[0] = 1.25;  // a step without a mesh between two with one
    ASSERT_TRUE(followed.pipeline.to(grammar, options, context).ok());
    options.params[1].n[0] = .75;
    followed.expectSame(options);
    EXPECT_TRUE(followed.pipeline.followed());
}

}  // namespace
}  // namespace sgm::pipeline
