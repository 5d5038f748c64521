// Damaged grammars: no crash, every span inside the file, no parse longer than 50 ms; what still parses keeps its
// meaning when it is formatted.
#include <gtest/gtest.h>

#include <algorithm>

#include "grammar/operations/operations.h"
#include "grammar/syntax/parser.h"
#include "grammar/syntax/printer.h"
#include "tests/cpu_time.h"
#include "tests/fuzz_keys.h"
#include "tests/syntax/dump.h"
#include "tests/syntax/mutate.h"
#include "tests/syntax/read.h"

namespace sgm::syntax {
namespace {

/// What is wrong with how `text` was parsed and formatted, in words; empty when nothing is. Counts texts without
/// problems.
std::string judge(const std::string& text, size_t& parsed) {
    const SourcePtr source = makeSource(text);
    Diagnostics diagnostics;
    Ast ast;
    const double most = boundSeconds(.05);
    const double seconds = leastSeconds(most, [&] {
        diagnostics = {};
        ast = parse(source, operations::table(), diagnostics);
    });
    if (seconds > most) return "parsing took " + std::to_string(1e3 * seconds) + " ms";
    for (const Diagnostic& d : diagnostics.all()) {
        if (d.span.source != source.get() || d.span.begin > d.span.end || d.span.end > text.size())
            return "a problem outside the file: " + d.message;
        if (d.message.empty() || render(d).empty()) return "a problem without words";
    }
    const Dump dump(ast);
    if (diagnostics.hasErrors() || !dump.badSpan().empty()) return dump.badSpan();

    ++parsed;
    const SourcePtr once = makeSource(format(*source, operations::table()));
    Diagnostics again;
    if (Dump(parse(once, operations::table(), again)).text() != dump.text())
        return "formatting changed the meaning\n" + renderAll(again);
    return format(*once, operations::table()) == once->text() ? "" : "formatting twice is not formatting once";
}

TEST(Fuzz, MutantsNeitherCrashNorMisplaceSpansNorLoseMeaning) {
    const Mutator mutants[] = {Mutator(std::string(readSource("tests/syntax/sketch.sgm")->text())),
                               Mutator(std::string(readSource("examples/city/town.sgm")->text())),
                               Mutator(std::string(readSource("examples/buildings/lsystem.sgm")->text())),
                               Mutator(std::string(readSource("grammar/std/kifs.sgm")->text()))};
    const FuzzKeys keys = fuzzKeys(20000);
    size_t parsed = 0;
    for (uint64_t key = keys.first; key < keys.end(); ++key) {
        const std::string wrong = judge(mutants[key % std::size(mutants)](key), parsed);
        ASSERT_EQ(wrong, "") << "mutant " << key;
    }
    EXPECT_GT(parsed, 100u);
}

TEST(Fuzz, ArbitraryBytesAreRefusedInPlace) {
    size_t parsed = 0;
    for (uint64_t key = 0; key < 300; ++key) {
        std::string bytes = "grammar 1\n";
        for (uint64_t i = 0; i < 400; ++i) bytes += static_cast<char>(pick(combine(key, i), 256));
        ASSERT_EQ(judge(bytes, parsed), "") << "key " << key;
    }
}

TEST(Fuzz, LongInputTakesLinearTime) {
    size_t parsed = 0;
    for (const char* unit :
         {"param a = 1\n", "rule A -> cube + +\n", "(", "\xff ", "{ ", "\"\n", "rule A -> a[", "+ a "}) {
        std::string text = "grammar 1\nrule A -> ";
        while (text.size() < 60000) text += unit;
        EXPECT_EQ(judge(text, parsed), "") << unit;
    }
}

}  // namespace
}  // namespace sgm::syntax
