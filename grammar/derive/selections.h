// Places of the text that pick something out of each shape they meet: edges by a word, faces, what a setback leaves.
// Enters: at each shape, whether such a place picked anything. Leaves: a warning for every place that never did.
#pragma once

#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "grammar/rules/grammar.h"
#include "grammar/syntax/source.h"
#include "modeler/plan/polygon.h"

namespace sgm::derive {

struct ShapeTree;

/// What a warning says, and what to do.
struct Explanation {
    std::string message, hint;
    uint32_t symbol = rules::none;  ///< it holds only where a shape of this symbol stands in the end
};

/// Says that no edge of the plan is called `word`, and what comes of that; with the nearest of the words that there
/// are, or all: those of the language, of `others` and of the plan's tags.
Explanation noEdgeCalled(std::string_view word, const plan::Footprint& footprint, std::string_view therefore,
                         const std::vector<std::string>& others = {});

/// Says why no edge of the plan is left for `word`: `takers` before it, such as "parts", take all that are called so;
/// or as noEdgeCalled, where none is.
Explanation noEdgeLeft(std::string_view word, const plan::Footprint& footprint, std::string_view takers,
                       std::string_view therefore, const std::vector<std::string>& others = {});

class Selections {
public:
    /// The place picked something; O(1).
    void found(syntax::SourceSpan at);
    /// The place picked nothing at this shape. What it then says is kept from the first time; O(1).
    void missed(syntax::SourceSpan at, const Explanation& otherwise);
    /// Whether the place was met before, so that another `missed` changes nothing.
    bool knows(syntax::SourceSpan at) const { return indexOf_.contains(keyOf(at)); }
    /// Takes over what another derivation of the same grammar noted: a place that picked something in one of them has.
    void add(const Selections& other);
    /// A warning for every place that never picked anything, in the order in which they were first met. What holds for
    /// shapes of a symbol alone is told where `tree` has one.
    syntax::Diagnostics warnings(const ShapeTree* tree = nullptr) const;

private:
    struct Selection {
        syntax::SourceSpan at;
        bool found = false;
        Explanation otherwise;
    };
    struct Key {
        const void* source;
        uint32_t begin, end;
        bool operator==(const Key&) const = default;
    };
    struct KeyHash {
        size_t operator()(const Key& key) const;
    };
    static Key keyOf(syntax::SourceSpan at) { return {at.source, at.begin, at.end}; }
    Selection& of(syntax::SourceSpan at);

    std::vector<Selection> all_;
    std::unordered_map<Key, uint32_t, KeyHash> indexOf_;
};

}  // namespace sgm::derive
