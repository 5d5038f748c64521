#include "viewer/render/cells.h"

#include <array>

#include "modeler/core/parallel.h"
#include "modeler/eval/evaluate.h"
#include "modeler/field/ops.h"

namespace sgm::render {
namespace {

/// A tape this short isn't worth another cut.
constexpr size_t shortTape = 12;
/// One this long is worth it wherever there may be surface.
constexpr size_t longTape = 40;

/// A cell to be cut: where it is, and its tape.
struct Pending {
    uint32_t word;  ///< place in CellTree::nodes that will point to it
    Vec3f low;
    eval::Tape tape;
};

/// The 64 children of one cell.
struct Children {
    std::array<CellState, 64> states;
    std::array<Vec3f, 64> lows;
    std::array<eval::FloatInterval, 64> ranges;
    std::vector<eval::Tape> tapes;  ///< of the near ones, in order
};

/// States and tapes of the children of `cell`, each of `edge`.
Children childrenOf(const Pending& cell, float edge, float margin, eval::Workspace& workspace) {
    Children children;
    std::array<Box3f, 64> boxes;
    std::array<eval::FloatInterval, 64>& ranges = children.ranges;
    for (int i = 0; i < 64; ++i) {
        const Vec3f step{static_cast<float>(i & 3), static_cast<float>(i >> 2 & 3), static_cast<float>(i >> 4)};
        const Vec3f low = cell.low + step * edge;
        children.lows[size_t(i)] = low;
        boxes[size_t(i)] = Box3f{low, low + Vec3f{edge, edge, edge}}.inflated(edge / 32);
    }
    const eval::RangeTrace trace = evaluateRanges(cell.tape, {boxes.data(), boxes.size()}, ranges.data(), workspace);
    for (size_t i = 0; i < 64; ++i) {
        children.states[i] = ranges[i].lo > margin    ? CellState::Outside
                             : ranges[i].hi < -margin ? CellState::Inside
                                                      : CellState::Near;
        if (children.states[i] == CellState::Near) children.tapes.push_back(shorten(cell.tape, trace, i, workspace));
    }
    return children;
}

}  // namespace

/// A greatest of parts may be small between them; so may a least of parts, seen from the other side of a sign.
uint8_t doubtsOf(const eval::Tape& tape) {
    using field::ops::Owner;
    std::vector<bool> owned(tape.registerCount(), false);
    bool greatest = false, least = false, turned = false;
    for (const eval::Instruction& in : tape.code()) {
        const field::OpTraits& row = field::traits(in.op);
        const eval::Source direct[] = {in.a, in.b};
        const eval::Source* const sources = row.arity == field::ops::variadic ? tape.sources().data() + in.a : direct;
        uint32_t count = 0;
        bool last = false;
        for (uint32_t k = row.firstPrunable; k < in.count; ++k) {
            last = (in.origins && tape.origins()[in.origins - 1 + k] != 0) ||
                   (!eval::isConstant(sources[k]) && owned[sources[k]]);
            count += last;
        }
        greatest |= row.owner == Owner::Greatest && count > 1;
        least |= row.owner == Owner::Least && count > 1;
        turned |= last && row.fallsWithLast;
        owned[in.out] = count > 0;
    }
    return static_cast<uint8_t>((greatest || (least && turned) ? DoubtfulOutside : 0) |
                                (greatest || least ? DoubtfulInside : 0));
}

uint32_t CellTree::find(Vec3f p) const {
    Vec3f q = (p - low) / edge * 4.0f;
    uint32_t node = 0;
    for (;;) {
        uint32_t child = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const float k = std::clamp(std::floor(q[axis]), 0.0f, 3.0f);
            q[axis] = (q[axis] - k) * 4.0f;
            child |= static_cast<uint32_t>(k) << (2 * axis);
        }
        const uint32_t word = nodes[size_t(node) * 64 + child];
        if (stateOf(word) != CellState::Node) return word;
        node = indexOf(word);
    }
}

Result<CellTree> cutIntoCells(const eval::Tape& tape, const Box3f& bounds, float margin, int threads,
                              Progress* progress, int levels) {
    const int usual = std::min(levels, CellTree::depth);
    CellTree tree;
    tree.edge = maxComponent(bounds.size()) * 1.001f;
    tree.low = bounds.centre() - Vec3f{tree.edge, tree.edge, tree.edge} * 0.5f;
    tree.margin = margin;
    std::vector<eval::Workspace> workspaces(size_t(threadCount(threads)));
    std::vector<Pending> pending;
    pending.push_back({0, tree.low, tape});
    float edge = tree.edge;
    for (int level = 0; level < levels && !pending.empty(); ++level) {
        edge /= 4;
        if (progress) progress->begin("cells", pending.size());
        std::vector<Children> children(pending.size());
        parallelFor(pending.size(), threads, progress, [&](size_t i, int worker) {
            children[i] = childrenOf(pending[i], edge, margin, workspaces[size_t(worker)]);
            if (progress) progress->tick();
        });
        if (cancelled(progress)) return Error{Error::Kind::Cancelled, "cancelled"};
        std::vector<Pending> next;
        for (size_t i = 0; i < pending.size(); ++i) {
            const auto node = static_cast<uint32_t>(tree.nodes.size() / 64);
            if (node > 0) tree.nodes[pending[i].word] = uint32_t(CellState::Node) << 30 | node;
            size_t taken = 0;
            for (size_t c = 0; c < 64; ++c) {
                const CellState state = children[i].states[c];
                uint32_t index = 0;
                if (state == CellState::Near) {
                    eval::Tape& shortened = children[i].tapes[taken++];
                    index = static_cast<uint32_t>(tree.tapes.size());
                    const eval::FloatInterval range = children[i].ranges[c];
                    const bool deeper = level + 1 < usual ? shortened.size() > shortTape
                                                          : level + 1 < levels && shortened.size() > longTape &&
                                                                range.lo <= 0 && range.hi >= 0;
                    if (deeper)
                        next.push_back(
                            {static_cast<uint32_t>(tree.nodes.size()), children[i].lows[c], std::move(shortened)});
                    else {
                        tree.tapes.push_back(std::move(shortened));
                        tree.ranges.push_back(range);
                        tree.doubts.push_back(doubtsOf(tree.tapes.back()));
                    }
                }
                tree.nodes.push_back(uint32_t(state) << 30 | index);
            }
        }
        pending = std::move(next);
    }
    return tree;
}

}  // namespace sgm::render
