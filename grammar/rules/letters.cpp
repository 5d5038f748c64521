#include "grammar/rules/letters.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace sgm::rules {

std::set<std::pair<char, size_t>> lettersOf(const Lsystem& lsystem) {
    std::set<std::pair<char, size_t>> letters;
    std::vector<std::pair<char, size_t>> open;
    const auto add = [&](const std::vector<Lsystem::Module>& modules) {
        for (const Lsystem::Module& m : modules)
            if (letters.emplace(m.letter, m.args.size()).second) open.emplace_back(m.letter, m.args.size());
    };
    add(lsystem.axiom);
    while (!open.empty()) {
        const auto [letter, numbers] = open.back();
        open.pop_back();
        for (const Lsystem::Production& p : lsystem.productions)
            if (p.letter == letter && p.parameters == numbers) add(p.modules);
    }
    return letters;
}

bool holdsLetter(const std::set<std::pair<char, size_t>>& letters, char letter) {
    const auto first = letters.lower_bound({letter, 0});
    return first != letters.end() && first->first == letter;
}

void warnOfUnusedProductions(const Lsystem& lsystem, syntax::Diagnostics& diagnostics) {
    const auto letters = lettersOf(lsystem);
    const auto plural = [](size_t n) { return fmt::format("{} number{}", n, n == 1 ? "" : "s"); };
    for (const Lsystem::Production& p : lsystem.productions) {
        if (letters.contains({p.letter, p.parameters})) continue;
        if (!holdsLetter(letters, p.letter))
            diagnostics.warning(
                p.span,
                fmt::format("no '{}' ever stands in '{}', so this production is never applied", p.letter, lsystem.name),
                "write the letter into the axiom or into a production that is applied");
        else
            diagnostics.warning(
                p.span,
                fmt::format("'{}' never has {} in '{}', so this production is never applied", p.letter,
                            plural(p.parameters), lsystem.name),
                fmt::format("it stands there with {}", plural(letters.lower_bound({p.letter, 0})->second)));
    }
}

}  // namespace sgm::rules
