// Differences that remove nothing.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "grammar/derive/boxes.h"
#include "grammar/derive/derive.h"

namespace sgm::derive {
namespace {

using rules::Operator;

/// Pairs of boxes that are compared for one element: then it counts as one that cuts.
constexpr size_t mostPairs = 200'000;

/// What is known of the cutters that one element made.
struct Cutter {
    ShapeId shape = none;  ///< the first
    bool beside = false;   ///< something stands before one of them, and none reaches it
    bool cuts = false;
    size_t pairs = 0;
};

class Cutters {
public:
    explicit Cutters(const Derivation& d) : tree_(d.tree) {
        for (ShapeId s = 0; s < tree_.shapes.size(); ++s)
            if (tree_.shapes[s].op == Operator::Difference && tree_.shapes[s].span.source) examine(s);
    }

    const auto& found() const { return found_; }
    /// The name of what the cutter joins.
    const std::string& hostOf(const Cutter& c) const {
        return tree_.labels[tree_.shapes[tree_.shapes[c.shape].parent].label];
    }

private:
    void examine(ShapeId id) {
        const Shape& s = tree_.shapes[id];
        Cutter& cutter =
            found_.try_emplace({s.span.begin, s.span.end, s.span.source}, Cutter{id, false, false, 0}).first->second;
        if (cutter.cuts) return;
        cutting_.clear(), standing_.clear();
        bool unclear = !gather(id, cutting_);
        if (tree_.shapes[s.parent].solid != none) standing_.push_back(s.parent);
        unclear = unclear || changesShape(s.parent);
        for (ShapeId c = tree_.shapes[s.parent].firstChild; c != id && c != none; c = tree_.shapes[c].nextSibling)
            if (tree_.shapes[c].op != Operator::Difference) unclear = !gather(c, standing_) || unclear;
        cutter.beside = cutter.beside || !standing_.empty();
        cutter.pairs += cutting_.size() * standing_.size();
        // What cuts nothing because it is itself empty, and what noise or ornament makes larger than its box, isn't
        // judged.
        cutter.cuts = unclear || cutting_.empty() || cutter.pairs > mostPairs || meet();
    }

    /// Adds the solids of a subtree that add to it to `list`; false where one reaches beyond its box.
    bool gather(ShapeId top, std::vector<ShapeId>& list) const {
        bool exact = true;
        for (ShapeId s = top; s != none;) {
            const bool cuts = s != top && tree_.shapes[s].op == Operator::Difference;
            if (!cuts) {
                if (tree_.shapes[s].solid != none) list.push_back(s);
                exact = exact && !changesShape(s);
            }
            s = tree_.next(s, top, cuts);
        }
        return exact;
    }

    bool changesShape(ShapeId s) const {
        const Extras* x = tree_.extrasOf(s);
        const SolidValue* solid = tree_.solidOf(s);
        return (x && !(x->displace.empty() && x->clad.empty() && x->relief == none)) || (solid && isUnbounded(*solid));
    }

    static bool isUnbounded(const SolidValue& solid) {
        return (solid.primitive && !solid.primitive->bounded) ||
               std::any_of(solid.parts.begin(), solid.parts.end(), isUnbounded);
    }

    bool meet() const {
        for (const ShapeId a : cutting_)
            for (const ShapeId b : standing_)
                if (penetration(outerScope(tree_, a), outerScope(tree_, b)) >
                    1e-9 * maxComponent(tree_.shapes[b].scope.size))
                    return true;  // rounding
        return false;
    }

    const ShapeTree& tree_;
    std::map<std::tuple<uint32_t, uint32_t, const syntax::Source*>, Cutter> found_;
    std::vector<ShapeId> cutting_, standing_;
};

}  // namespace

syntax::Diagnostics uncut(const Derivation& derivation) {
    syntax::Diagnostics warnings;
    const Cutters cutters(derivation);
    for (const auto& [place, cutter] : cutters.found()) {
        if (cutter.cuts) continue;
        const std::string& host = cutters.hostOf(cutter);
        if (cutter.beside)
            warnings.warning(derivation.tree.shapes[cutter.shape].span,
                             fmt::format("this cuts nothing: it lies beside '{}'", host),
                             "move it into what it shall cut ('at', 'move'), or make it larger");
        else
            warnings.warning(derivation.tree.shapes[cutter.shape].span,
                             fmt::format("this cuts nothing: '{}' holds no solid before it", host),
                             "'-' cuts what stands in the same body; to cut a wall from a part of its front, write "
                             "'through Wall' after the cutter");
    }
    return warnings;
}

}  // namespace sgm::derive
