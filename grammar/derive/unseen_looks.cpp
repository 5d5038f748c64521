// Looks of groups that nothing in them has.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "grammar/derive/derive.h"
#include "grammar/rules/traverse.h"

namespace sgm::derive {
namespace {

using rules::Operator;
using Place = std::tuple<const syntax::Source*, uint32_t, uint32_t>;

Place placeOf(const syntax::SourceSpan& span) { return {span.source, span.begin, span.end}; }

/// The look that an element gives to what is in it.
struct GroupLook {
    syntax::SourceSpan span;
    bool isTaken = false;
    std::vector<std::string> others;  ///< what has a look of its own instead, in tree order
};

/// By the places of their elements: looks said of groups, parts and shapes with rules.
std::map<Place, GroupLook> groupLooks(const rules::Grammar& grammar) {
    std::map<Place, GroupLook> looks;
    constexpr std::string_view names[] = {"color", "rough", "metal", "of"};
    const auto visit = [&](const rules::Element& e) {
        const rules::SymbolId symbol = e.content.symbol();
        if (e.content.empty() || e.content.solid() || (symbol != rules::none && grammar.symbols[symbol].terminal))
            return;
        for (const rules::Attribute& a : e.attributes)
            if (std::find(std::begin(names), std::end(names), a.operation->name) != std::end(names))
                looks.try_emplace(placeOf(e.span), GroupLook{a.span, false, {}});
    };
    for (const rules::Start& start : grammar.starts) rules::forEachElement(start.body, visit);
    for (const rules::Rule& rule : grammar.rules) {
        rules::forEachElement(rule.body, visit);
        if (rule.finally_) rules::forEachElement(*rule.finally_, visit);
    }
    return looks;
}

/// Finds what takes the look of what it stands in, as `lower` gives looks to solids.
class LookTakers {
public:
    LookTakers(const ShapeTree& tree, std::map<Place, GroupLook>& looks)
        : tree_(tree),
          looks_(looks),
          giver_(tree.shapes.size(), none),
          group_(tree.shapes.size(), none),
          isSeen_(tree.shapes.size(), false) {}

    void run() {
        for (ShapeId s = tree_.shapes.empty() ? none : 0; s != none; s = tree_.next(s)) {
            const Shape shape = tree_.shapes[s];
            // A cutter without a look has that of what it cuts.
            const bool hasNoGiver = shape.parent == none || shape.op == Operator::Difference;
            giver_[s] = shape.material != none ? s : hasNoGiver ? none : giver_[shape.parent];
            group_[s] = lookOf(giver_[s] == s ? s : none) ? s : shape.parent == none ? none : group_[shape.parent];
            const Extras* extras = tree_.extrasOf(s);
            const bool isUnclear =
                shape.op == Operator::Morph || (extras && (!extras->clad.empty() || extras->object != none));
            if (isUnclear) take(s), take(shape.parent);
            if (shape.solid != none) take(s), noteOwners(s);
        }
    }

private:
    GroupLook* lookOf(ShapeId giver) {
        const auto at = giver == none ? looks_.end() : looks_.find(placeOf(tree_.shapes[giver].span));
        return at == looks_.end() ? nullptr : &at->second;
    }

    void take(ShapeId s) {
        if (GroupLook* look = lookOf(s == none ? none : giver_[s])) look->isTaken = true;
    }

    /// Tells the looks around a solid that what is in them has another.
    void noteOwners(ShapeId s) {
        for (ShapeId owner = giver_[s]; owner != none && !isSeen_[owner];) {
            isSeen_[owner] = true;
            const ShapeId parent = tree_.shapes[owner].parent;
            const ShapeId around = parent == none ? none : group_[parent];
            if (GroupLook* look = lookOf(around)) {
                const std::string& label = tree_.labels[tree_.shapes[owner].label];
                if (std::find(look->others.begin(), look->others.end(), label) == look->others.end())
                    look->others.push_back(label);
            }
            owner = around;
        }
    }

    const ShapeTree& tree_;
    std::map<Place, GroupLook>& looks_;
    std::vector<ShapeId> giver_;  ///< by shape: which gives it its look, itself or one above
    std::vector<ShapeId> group_;  ///< by shape: the nearest with a look of `looks_`, itself or one above
    std::vector<bool> isSeen_;
};

}  // namespace

syntax::Diagnostics unseenLooks(const Derivation& derivation) {
    syntax::Diagnostics warnings;
    auto looks = groupLooks(*derivation.grammar);
    if (looks.empty() || derivation.planAlone) return warnings;
    LookTakers(derivation.tree, looks).run();
    constexpr size_t mostNamed = 4;
    for (auto& [place, look] : looks) {
        if (look.isTaken || look.others.empty()) continue;
        const bool isMore = look.others.size() > mostNamed;
        look.others.resize(std::min(look.others.size(), mostNamed));
        warnings.warning(look.span,
                         fmt::format("nothing has this look: all in it have looks of their own: '{}'{}",
                                     fmt::join(look.others, "', '"), isMore ? " …" : ""),
                         "say the look on these, or use a solid without one, such as 'cube'");
    }
    return warnings;
}

}  // namespace sgm::derive
