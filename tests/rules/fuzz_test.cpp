// Damaged grammars through parse and check: no crash, every span inside its file, each fast.
#include <gtest/gtest.h>

#include "tests/cpu_time.h"
#include "tests/fuzz_keys.h"
#include "tests/rules/read.h"
#include "tests/syntax/mutate.h"

namespace sgm::rules {
namespace {

void expectInside(const syntax::SourceSpan& span, const syntax::Source& source, const std::string& message) {
    ASSERT_EQ(span.source, &source) << message;
    ASSERT_LE(span.begin, span.end) << message;
    ASSERT_LE(span.end, source.text().size()) << message;
}

TEST(Fuzz, MutantsAreJudgedQuicklyAndInPlace) {
    const char* const seeds[] = {"tests/rules/sketch.sgm", "tests/syntax/sketch.sgm",        "examples/figure1.sgm",
                                 "examples/tower.sgm",     "examples/buildings/lsystem.sgm", "examples/city/town.sgm"};
    const FuzzKeys keys = fuzzKeys(6000);
    const uint64_t mutants = keys.count;
    uint64_t key = keys.first, sound = 0;
    double slowest = 0;
    for (const char* const seed : seeds) {
        const syntax::Mutator mutate(readText(seed));
        for (uint64_t i = 0; i < mutants / std::size(seeds); ++i) {
            const std::string text = mutate(++key);
            Checked c;
            const double taken_s = leastSeconds(boundSeconds(.05), [&] { c = checked(text); });
            slowest = std::max(slowest, taken_s);
            ASSERT_LT(taken_s, boundSeconds(.05)) << "mutant " << key << " of " << seed;
            for (const auto& d : c.diagnostics.all()) {
                expectInside(d.span, *c.source, d.message);
                ASSERT_FALSE(syntax::render(d).empty());
            }
            ASSERT_EQ(c.grammar == nullptr, c.diagnostics.hasErrors()) << "mutant " << key;
            sound += c.grammar != nullptr;
        }
    }
    EXPECT_GT(sound, mutants / 200) << "some mutants must reach the end of the check";
    RecordProperty("slowest_ms", static_cast<int>(slowest * 1000));
    RecordProperty("sound", static_cast<int>(sound));
}

TEST(Fuzz, SolidsThatDoubleAreRefused) {
    std::string text = "terminal t0 = morph(cube, sphere, .5)\n";
    for (int i = 1; i < 60; ++i) {
        const std::string last = "t" + std::to_string(i - 1);
        text.append("terminal t")
            .append(std::to_string(i))
            .append(" = morph(" + last)
            .append(", " + last)
            .append(", .5)\n");
    }
    const double before = secondsOf(threadClock());
    const Checked c = checkedBody(text + "start S -> t59\n");
    EXPECT_LT(secondsOf(threadClock()) - before, boundSeconds(1));
    EXPECT_NE(c.messages().find("a solid has at most 1000 parts"), std::string::npos);
}

}  // namespace
}  // namespace sgm::rules
