#include "modeler/plan/grouped_formula.h"

#include <xsimd/xsimd.hpp>

namespace sgm::plan {
namespace {

using Kind = FormulaNode::Kind;
using Lanes = BoxPair::Lanes;
using Pair = xsimd::make_sized_batch_t<double, 2>;  // of every machine, so that it needs no choice at run time

/// Lanes in registers.
struct Vectors {
    Pair bounds, centres;

    explicit Vectors(double all) : bounds(all), centres(all) {}
    explicit Vectors(const Lanes& from)
        : bounds(Pair::load_unaligned(from.data())), centres(Pair::load_unaligned(from.data() + Pair::size)) {}
    void store(Lanes& to) const {
        bounds.store_unaligned(to.data());
        centres.store_unaligned(to.data() + Pair::size);
    }
};

constexpr double leastOf(bool isMax) { return isMax ? -Box2::far : Box2::far; }

template <bool isMax>
Pair chosen(Pair a, Pair b) {
    return isMax ? xsimd::max(a, b) : xsimd::min(a, b);
}

/// The greatest or the least of `value` and these leaves.
template <bool isMax, class Leaf>
Vectors chosen(Vectors value, std::span<const Leaf> leaves, const BoxPair& boxes) {
    const Vectors x(boxes.x[0]), z(boxes.z[0]);
    for (const Leaf& leaf : leaves) {
        const Pair a(leaf.function.a), b(leaf.function.b), c(leaf.function.c);
        const Pair lowX = Pair::load_unaligned(boxes.x[leaf.x].data()),
                   lowZ = Pair::load_unaligned(boxes.z[leaf.z].data());
        value.bounds = chosen<isMax>(value.bounds, a * lowX + b * lowZ + c);
        value.centres = chosen<isMax>(value.centres, a * x.centres + b * z.centres + c);
    }
    return value;
}

}  // namespace

GroupedFormula::GroupedFormula(const Formula& formula, std::span<const Linear> leaves) {
    const std::vector<FormulaNode>& nodes = formula.nodes;
    std::vector<uint32_t> groupOf(nodes.size());
    const auto groupFor = [&](Kind kind, uint32_t parent) {
        groups_.push_back({kind != Kind::Min, parent, 0, 0});
        return static_cast<uint32_t>(groups_.size() - 1);
    };
    groupOf.back() = groupFor(nodes.back().kind, 0);
    for (size_t i = nodes.size(); i-- > 0;) {
        const uint32_t group = groupOf[i];
        if (nodes[i].kind == Kind::Edge) {
            ++groups_[group].count;
            continue;
        }
        for (const uint32_t operand : {nodes[i].first, nodes[i].second}) {
            const Kind kind = nodes[operand].kind;
            groupOf[operand] = kind == Kind::Edge || kind == nodes[i].kind ? group : groupFor(kind, group);
        }
    }
    uint32_t end = 0;  // each group begins at its end, from which its leaves go down
    for (Group& group : groups_) group.begin = end += group.count;
    leaves_.resize(end);
    for (size_t i = 0; i < nodes.size(); ++i)
        if (nodes[i].kind == Kind::Edge) {
            const Linear& leaf = leaves[nodes[i].first];
            leaves_[--groups_[groupOf[i]].begin] = {leaf, leaf.a < 0, leaf.b < 0};
        }
    values_.resize(groups_.size());
}

Lanes GroupedFormula::evaluate(const BoxPair& boxes) {
    for (size_t g = 0; g < groups_.size(); ++g) values_[g].fill(leastOf(groups_[g].isMax));
    for (size_t g = groups_.size(); g-- > 0;) {
        const Group& group = groups_[g];
        const std::span<const Leaf> own{leaves_.data() + group.begin, group.count};
        const Vectors before(values_[g]);
        const Vectors value = group.isMax ? chosen<true>(before, own, boxes) : chosen<false>(before, own, boxes);
        if (g == 0) {
            value.store(values_[0]);
            break;
        }
        Vectors above(values_[group.parent]);
        const bool isMax = groups_[group.parent].isMax;
        above.bounds = isMax ? chosen<true>(above.bounds, value.bounds) : chosen<false>(above.bounds, value.bounds);
        above.centres =
            isMax ? chosen<true>(above.centres, value.centres) : chosen<false>(above.centres, value.centres);
        above.store(values_[group.parent]);
    }
    return values_[0];
}

}  // namespace sgm::plan
