// Damaged grammars that still pass the check, grown and lowered under a small budget: no crash, no hang, and every end
// is a model or an error in words.
#include <gtest/gtest.h>

#include <cmath>

#include "grammar/lower/lower.h"
#include "tests/fuzz_keys.h"
#include "tests/rules/read.h"
#include "tests/syntax/mutate.h"

namespace sgm::lower {
namespace {

/// Grows every start of the grammar; true when one became a field.
bool grow(const std::shared_ptr<const rules::Grammar>& grammar, const std::string& what) {
    bool solid = false;
    for (uint32_t start = 0; start < grammar->starts.size(); ++start) {
        derive::Options options;
        options.start = start;
        options.budget.shapes = 2000;
        options.budget.seconds = 2;
        const auto derivation = derive::derive(grammar, options, nullptr);
        if (!derivation.ok()) {
            EXPECT_FALSE(derivation.error().message.empty()) << what;
            continue;
        }
        const auto model = lower(*derivation, nullptr);
        if (!model.ok()) {
            EXPECT_FALSE(model.error().message.empty()) << what;
            continue;
        }
        EXPECT_TRUE((*model)->field.bounds.finite() && !(*model)->field.bounds.empty()) << what;
        EXPECT_FALSE(std::isnan((*model)->field.lipschitz)) << what;
        solid = true;
    }
    return solid;
}

TEST(Fuzz, MutantsGrowOrSayWhyNot) {
    const FuzzKeys keys = fuzzKeys(4000);
    uint64_t key = keys.first, checked = 0, solid = 0;
    for (const char* const seed :
         {"examples/joints.sgm", "examples/figure1.sgm", "examples/cumulus.sgm", "tests/rules/sketch.sgm"}) {
        const syntax::Mutator mutate(rules::readText(seed));
        for (uint64_t i = 0; i < keys.count / 4; ++i) {
            const std::string text = mutate(++key);
            const rules::Checked c = rules::checked(text);
            if (!c.grammar) continue;
            ++checked;
            solid += grow(c.grammar, "mutant " + std::to_string(key) + " of " + seed + ":\n" + text);
        }
    }
    EXPECT_GT(checked, keys.count / 200);
    EXPECT_GT(solid, checked / 10);
}

}  // namespace
}  // namespace sgm::lower
