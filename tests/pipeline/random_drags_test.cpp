// Numbers of grammars by chance become parameters, which are dragged: every step gives what a build from the start
// gives.
#include "tests/fuzz_keys.h"
#include "tests/pipeline/followed.h"
#include "tests/pipeline/random_grammar.h"

namespace sgm::pipeline {
namespace {

constexpr const char* digits = "0123456789.";

/// The text with up to `most` of its numbers with a fraction as parameters from half to one and a half of their value.
std::string withParameters(const std::string& text, uint64_t key, size_t most) {
    std::string params, body;
    size_t at = text.find('\n', text.find("use ")) + 1, made = 0;
    const std::string head = text.substr(0, at);
    while (at < text.size()) {
        const size_t from = text.find_first_of("0123456789", at);
        if (from == std::string::npos) break;
        size_t to = text.find_first_not_of(digits, from);
        const std::string number = text.substr(from, to - from);
        const size_t unitEnd = text.find_first_not_of("%abcdefghijklmnopqrstuvwxyz", to);
        std::string unit = text.substr(to, unitEnd - to);
        if (unit != "m" && unit != "%" && unit != "deg") unit.clear();
        body += text.substr(at, from - at);
        at = to + unit.size();
        key = mix(key);
        // A minus before a parameter is an operator, which a vector takes as well as a sign.
        if (made == most || number.find('.') == std::string::npos || pick(key, 3) != 0) {
            body += number + unit;
            continue;
        }
        const double value = std::strtod(number.c_str(), nullptr);
        const std::string name = "p" + std::to_string(made++);
        const auto said = [&](double share) { return std::to_string(value * share) + unit; };
        params += "param " + name + " = " + said(1) + " in " + said(.5) + ".." + said(1.5) + "\n";
        body += name;
    }
    return head + params + body + text.substr(at);
}

TEST(RandomDrags, GiveWhatABuildFromTheStartGives) {
    constexpr size_t steps = 6;
    const FuzzKeys keys = fuzzKeys(40 * steps);
    size_t dragged = 0;
    for (uint64_t model = keys.first / steps; model < keys.end() / steps; ++model) {
        const std::string text = withParameters(RandomGrammar(mix(model + 1)).text(), model, 5);
        SCOPED_TRACE("key " + std::to_string(model * steps) + "\n" + text);
        const auto grammar = grammarOf(text);
        ASSERT_TRUE(grammar);
        if (grammar->params.empty()) continue;
        ++dragged;
        derive::Options options = defaults(*grammar);
        options.budget.shapes = 3000;
        Followed followed(grammar, 24, model % 8 == 0 ? mesh::Surface::Crisp : mesh::Surface::Cubes);
        uint64_t key = mix(model);
        for (size_t step = 0; step < steps; ++step, key = mix(key)) {
            const size_t which = pick(key, grammar->params.size());
            SCOPED_TRACE("step " + std::to_string(step) + ", " + grammar->params[which].name);
            if (step > 0)
                options.params[which] = drawn(grammar->params[which], options.params[which], combine(key, which));
            followed.expectSame(options);
            if (testing::Test::HasFailure()) return;
        }
    }
    EXPECT_GT(dragged, keys.count / steps / 2);
}

}  // namespace
}  // namespace sgm::pipeline
