#include "grammar/derive/selections.h"

#include <fmt/format.h>

#include <algorithm>

#include "grammar/derive/shape_tree.h"
#include "grammar/rules/words.h"
#include "modeler/core/random.h"
#include "modeler/plan/edge_words.h"

namespace sgm::derive {

Explanation noEdgeCalled(std::string_view word, const plan::Footprint& footprint, std::string_view therefore,
                         const std::vector<std::string>& others) {
    std::string message = fmt::format("no edge of this plan is called '{}', {}", word, therefore);
    const auto add = [](std::vector<std::string>& words, std::string one) {
        if (std::find(words.begin(), words.end(), one) == words.end()) words.push_back(std::move(one));
    };
    std::vector<std::string> own;
    for (const plan::PlacedEdge& edge : plan::edgesOf(footprint))
        for (std::string& name : plan::edgeWords(footprint, edge)) add(own, std::move(name));
    if (plan::isCommonEdgeWord(word))
        return {std::move(message), fmt::format("besides side, its edges are called {}", fmt::join(own, ", "))};
    std::vector<std::string> words(std::begin(plan::commonEdgeWords), std::end(plan::commonEdgeWords));
    for (const std::string& other : others) add(words, other);
    for (std::string& name : own) add(words, std::move(name));
    std::string hint = rules::nearestHint(word, words);
    const bool hasTop = std::find(words.begin(), words.end(), "top") != words.end();
    if (hint.empty() && word == "roof" && hasTop) hint = "did you mean 'top'?";
    if (hint.empty()) hint = fmt::format("the words here are {}", fmt::join(words, ", "));
    return {std::move(message), std::move(hint)};
}

Explanation noEdgeLeft(std::string_view word, const plan::Footprint& footprint, std::string_view takers,
                       std::string_view therefore, const std::vector<std::string>& others) {
    const std::vector<plan::PlacedEdge> edges = plan::edgesOf(footprint);
    if (std::none_of(edges.begin(), edges.end(),
                     [&](const plan::PlacedEdge& edge) { return plan::isEdgeCalled(footprint, edge, word); }))
        return noEdgeCalled(word, footprint, therefore, others);
    return {fmt::format("{} before this one take all edges called '{}'", takers, word),
            "write it before them: the first word that fits an edge wins"};
}

size_t Selections::KeyHash::operator()(const Key& key) const {
    return combine(reinterpret_cast<uintptr_t>(key.source), uint64_t(key.begin) << 32 | key.end);
}

Selections::Selection& Selections::of(syntax::SourceSpan at) {
    const auto [place, isNew] = indexOf_.try_emplace(keyOf(at), static_cast<uint32_t>(all_.size()));
    if (isNew) all_.push_back({at, false, {}});
    return all_[place->second];
}

void Selections::found(syntax::SourceSpan at) { of(at).found = true; }

void Selections::missed(syntax::SourceSpan at, const Explanation& otherwise) {
    Selection& selection = of(at);
    if (selection.otherwise.message.empty()) selection.otherwise = otherwise;
}

void Selections::add(const Selections& other) {
    for (const Selection& s : other.all_) {
        if (s.found) found(s.at);
        if (!s.otherwise.message.empty()) missed(s.at, s.otherwise);
    }
}

syntax::Diagnostics Selections::warnings(const ShapeTree* tree) const {
    const auto holds = [&](uint32_t symbol) {
        if (symbol == rules::none) return true;
        for (ShapeId s = tree && !tree->shapes.empty() ? 0 : none; s != none; s = tree->next(s))
            if (tree->shapes[s].symbol == symbol) return true;
        return false;
    };
    syntax::Diagnostics warnings;
    for (const Selection& s : all_)
        if (!s.found && holds(s.otherwise.symbol)) warnings.warning(s.at, s.otherwise.message, s.otherwise.hint);
    return warnings;
}

}  // namespace sgm::derive
