// A walk over the parameters of examples: after every step the mesh made of what was kept and what changed has the same
// bytes as one from the start.
#include "modeler/mesh/rebuild.h"

#include "grammar/lower/lower.h"
#include "modeler/core/random.h"
#include "tests/derive/grammars.h"
#include "tests/mesh/mesh_bytes.h"

namespace sgm {
namespace {

using namespace testing_;

/// A value somewhere in the parameter's range; where it has none, one of the choices or the other truth.
rules::Value drawn(const rules::Param& param, const rules::Value& now, uint64_t key) {
    rules::Value value = now;
    for (size_t i = 0; param.lo && i < param.value.count; ++i) {
        const double n = uniform(combine(key, i), param.lo->n[i], param.hi->n[i]);
        value.n[i] = param.value.integer ? std::round(n) : n;
    }
    if (!param.choices.empty()) value.text = param.choices[pick(key, param.choices.size())];
    if (param.value.kind == rules::Value::Kind::Bool) value.n[0] = 1 - now.n[0];
    return value;
}

/// Null where the values don't make a model (a budget is passed, nothing solid is left).
std::unique_ptr<lower::Model> modelOf(const std::shared_ptr<const rules::Grammar>& grammar,
                                      const derive::Options& options) {
    const auto derivation = derive::derive(grammar, options, nullptr);
    if (!derivation.ok()) return nullptr;
    auto model = lower::lower(*derivation, nullptr);
    return model.ok() ? std::move(*model) : nullptr;
}

class Walk : public testing::TestWithParam<const char*> {};

TEST_P(Walk, KeepsTheBytes) {
    const auto grammar = grammarOf(fileText(GetParam()));
    ASSERT_TRUE(grammar && !grammar->params.empty());
    derive::Options options;
    options.budget.shapes = 3000;
    for (const rules::Param& p : grammar->params) options.params.push_back(p.value);

    mesh::Rebuild rebuild({.threads = 2});
    mesh::Grid grid;
    float cell_m = 0;
    size_t kept = 0;
    uint64_t key = hashText(GetParam());
    for (int step = 0; step < 8; ++step, key = mix(key)) {
        if (step > 0 && step != 4) {  // once nothing changes
            const size_t which = pick(key, grammar->params.size());
            options.params[which] = drawn(grammar->params[which], options.params[which], combine(key, which));
        }
        const auto model = modelOf(grammar, options);
        if (!model) continue;
        if (cell_m == 0) cell_m = mesh::cellFor(model->field.bounds, 40);
        grid = mesh::gridToKeep(grid, model->field.bounds, cell_m, 1);
        const eval::Tape tape = eval::compile(model->graph, model->field, model->graph.constants());

        mesh::Counts counts;
        const auto again = rebuild.update(tape, grid, nullptr, counts);
        ASSERT_TRUE(again.ok()) << again.error().message;
        kept += rebuild.blocksKept();
        const auto blocks = mesh::subdivide(tape, grid, 2, nullptr, counts);
        ASSERT_TRUE(blocks.ok());
        const auto whole = mesh::polygonize(*blocks, grid, {.threads = 2}, nullptr, counts);
        ASSERT_TRUE(whole.ok());
        ASSERT_EQ(mesh::bytesOf(**again), mesh::bytesOf(*whole)) << "step " << step;
    }
    EXPECT_GT(kept, 0u);
}

INSTANTIATE_TEST_SUITE_P(Examples, Walk,
                         testing::Values("examples/tower.sgm", "examples/grotto.sgm", "examples/cumulus.sgm",
                                         "examples/buildings/hall.sgm", "examples/caves/branching.sgm"));

}  // namespace
}  // namespace sgm
