#include "viewer/document/letters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sgm::document {
namespace {

const derive::LettersRead* readOf(const BuiltModel& shown, uint32_t lsystem) {
    for (const derive::LettersRead& read : shown.model.derivation.letters)
        if (read.lsystem == lsystem) return &read;
    return nullptr;
}

derive::Place placeOf(const BuiltModel& shown, const derive::LettersRead& read) {
    const derive::Derivation& derivation = shown.model.derivation;
    derive::Place place;
    place.tree = &derivation.tree;
    place.params = derivation.params;
    place.scope = read.scope;
    place.key = read.key;
    if (read.valuesAt < derivation.tree.shapes.size()) place.valuesAt = read.valuesAt;
    return place;
}

bool draws(char letter) { return letter == 'F' || letter == 'G'; }

}  // namespace

std::vector<uint32_t> lettersRead(const BuiltModel& shown) {
    std::vector<uint32_t> known;
    for (const derive::LettersRead& read : shown.model.derivation.letters) known.push_back(read.lsystem);
    return known;
}

Result<LettersShown> lettersAfter(const BuiltModel& shown, uint32_t lsystem, uint32_t passes) {
    const derive::LettersRead* read = readOf(shown, lsystem);
    if (!read) return Error{Error::Kind::Input, "the model reads no such lsystem"};
    const rules::Lsystem& rules = shown.grammar->lsystems[lsystem];
    const derive::Place place = placeOf(shown, *read);
    LettersShown out;
    out.lsystem = lsystem;
    out.all = static_cast<uint32_t>(std::clamp(std::floor(derive::number(rules.passes, place)), 0.0, 1e6));
    out.passes = std::min(passes, out.all);
    auto letters = derive::rewritten(rules, place, out.passes);
    if (!letters.ok()) return letters.error();
    out.letters = std::move(*letters);
    for (const derive::TurtleStep& step : derive::walk(rules, out.letters, place, read->rises, read->width_m)) {
        if (!draws(step.letter)) continue;
        const auto drawn = [&](Vec3d p) { return DrawnPoint{p.x, read->rises ? p.y : -p.z}; };
        out.steps.push_back({step.at, drawn(step.from), drawn(step.to)});
    }
    return out;
}

std::string textOf(const derive::Letters& letters, size_t begin, size_t count) {
    std::string text;
    const size_t end = std::min(letters.text.size(), begin + count);
    for (size_t i = begin; i < end; ++i) {
        text += letters.text[i];
        const std::span<const double> numbers = letters.of(i);
        for (size_t k = 0; k < numbers.size(); ++k) text += fmt::format("{}{:.4g}", k ? ", " : "(", numbers[k]);
        if (!numbers.empty()) text += ')';
    }
    return text;
}

}  // namespace sgm::document
