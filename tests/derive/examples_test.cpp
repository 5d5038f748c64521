// The examples that ship derive within their budget and keep their promises.
#include "grammar/pipeline/checks.h"
#include "tests/derive/grammars.h"

namespace sgm {
namespace {

using namespace testing_;

TEST(Examples, EveryBondObeysEquation16AndSolidsHangTogether) {
    for (const char* name : {"grotto.sgm", "cumulus.sgm", "tower.sgm", "joints.sgm"}) {
        SCOPED_TRACE(name);
        const auto d = derived(fileText(std::string("examples/") + name));
        ASSERT_FALSE(d.tree.bonds().all.empty());
        for (const derive::Bond& b : d.tree.bonds().all) {
            const auto p = d.tree.joint(b.shape[0], b.joint[0]), q = d.tree.joint(b.shape[1], b.joint[1]);
            expectNear(p.point + b.shift, q.point, 1e-6);
            EXPECT_TRUE(!b.directed || dot(p.direction, q.direction) < -1 + 1e-6);
        }
        EXPECT_EQ(d.floating(), 0u);
    }
}

TEST(Examples, TheirOwnChecksPass) {
    for (const char* name : {"grotto.sgm", "cumulus.sgm", "tower.sgm", "joints.sgm", "figure1.sgm"}) {
        const auto grammar = grammarOf(fileText(std::string("examples/") + name));
        ASSERT_TRUE(grammar) << name;
        pipeline::Context context;
        const auto verdicts = pipeline::runChecks(grammar, 1, context);
        ASSERT_TRUE(verdicts.ok());
        for (const auto& v : *verdicts) EXPECT_TRUE(v.passed) << name << ": " << v.message;
    }
}

}  // namespace
}  // namespace sgm
