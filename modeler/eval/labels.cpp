#include "modeler/eval/labels.h"

#include <cmath>

namespace sgm::eval {
namespace {

namespace ops = field::ops;
using ops::Owner;
using ops::Pieces;

/// A name made of two, never 0; the order counts.
constexpr uint32_t join(uint32_t a, uint32_t b) {
    uint32_t h = (a ^ 0x9e3779b9u) * 0x85ebca6bu;
    h = (h ^ (h >> 15) ^ b) * 0xc2b2ae35u;
    return (h ^ (h >> 13)) | 1u;
}

/// The name of two operands together: one alone keeps its own.
constexpr uint32_t joinIfBoth(uint32_t a, uint32_t b) { return a == b || b == 0 ? a : a == 0 ? b : join(a, b); }

}  // namespace

LabelPass::LabelPass(const Tape& tape, Workspace::Impl& workspace, size_t planes)
    : tape_(tape), planes_(planes), names_(workspace.registerNames) {
    const size_t room = 3 * maxBlock * tape.registerCount();
    if (workspace.nameRows.size() < room) workspace.nameRows.resize(room);
    rows_ = workspace.nameRows.data();
    names_.assign(tape.registerCount(), {});
    for (uint32_t axis = 0; axis < 3; ++axis)
        if (tape.chosenInputs() >> axis & 1) names_[axis].label.one = axis + 1;
}

LabelPass::Operand LabelPass::operand(const Instruction& in, const Source* sources, uint32_t k,
                                      const StepContext& c) const {
    const Source s = sources[k];
    const OriginId own = in.origins ? tape_.origins()[in.origins - 1 + k] : 0;
    if (isConstant(s)) return {nullptr, c.constants[indexOf(s)], {{}, {nullptr, own}}};
    Operand result{eval::placeOf(c, s, planes_, 0), 0, names_[s]};
    if (own != 0) result.names.origin = {nullptr, own};
    return result;
}

bool LabelPass::isUnnamed(const Instruction& in, const Source* sources) const {
    return in.origins == 0 && std::all_of(sources, sources + in.count, [&](Source s) {
               return isConstant(s) || (names_[s].label.none() && names_[s].origin.none());
           });
}

/// One name where all n of a row are equal.
Names LabelPass::settled(uint32_t* row, size_t n) {
    uint32_t others = 0;
    for (size_t i = 1; i < n; ++i) others |= row[i] ^ row[0];
    return others == 0 ? Names{nullptr, row[0]} : Names{row, 0};
}

/// The names of an operand in another row, for its own may be taken by another value.
Names LabelPass::copied(const Names& names, size_t n, uint32_t* to) {
    if (!names.row) return names;
    std::copy_n(names.row, n, to);
    return settled(to, n);
}

/// The label of a value from its operands': with the piece's name, where an op chooses from it.
Names LabelPass::ofPiece(const Instruction& in, Names label, size_t n) {
    const auto named = [&](uint32_t l) { return l == 0 ? in.piece : join(in.piece, l); };
    if (in.piece == 0) return label;
    if (!label.row) return {nullptr, named(label.one)};
    uint32_t* const row = labelRow(in.out);
    for (size_t i = 0; i < n; ++i) row[i] = named(label.row[i]);
    return settled(row, n);
}

/// The operand that a minimum or maximum takes. A number has no label: it makes no piece.
void LabelPass::choose(const Instruction& in, const Source* sources, const StepContext& c, bool least) {
    const Operand o[] = {operand(in, sources, 0, c), operand(in, sources, 1, c)};
    const size_t n = c.count;
    const float margin = tape_.tieMargin();
    uint32_t* const second = takesSecond_.data();
    const auto compare = [&](auto a, auto b) {
        for (size_t i = 0; i < n; ++i) second[i] = (least ? b(i) < a(i) - margin : b(i) > a(i) + margin) ? ~0u : 0u;
    };
    const auto row = [](const Operand& of) { return [p = of.values](size_t i) { return p[i]; }; };
    const auto number = [](const Operand& of) { return [v = of.constant](size_t) { return v; }; };
    if (o[0].values && o[1].values)
        compare(row(o[0]), row(o[1]));
    else if (o[0].values)
        compare(row(o[0]), number(o[1]));
    else if (o[1].values)
        compare(number(o[0]), row(o[1]));
    else
        compare(number(o[0]), number(o[1]));
    const Names &first = o[0].names.pinched, &other = o[1].names.pinched;
    if (least && !first.none())
        for (size_t i = 0; i < n; ++i)
            if (o[1].at(i) < o[0].at(i) + margin && (first.at(i) & ~other.at(i)) != 0) second[i] = ~0u;
    Names pinches = taken(first, other, second, n, pinchedRow(in.out));
    if (!least && field::traits(in.op).selects && o[0].values && o[1].values)
        pinches = pinched(o[0], o[1], pinches, n, pinchedRow(in.out));
    names_[in.out] = {taken(o[0].names.label, o[1].names.label, second, n, labelRow(in.out)),
                      taken(o[0].names.origin, o[1].names.origin, second, n, originRow(in.out)), pinches};
}

/// What is pinched, and where two operands of a maximum are each other's negative besides.
Names LabelPass::pinched(const Operand& a, const Operand& b, const Names& known, size_t n, uint32_t* to) const {
    const float margin = tape_.tieMargin();
    std::array<uint32_t, maxBlock> found;
    uint32_t any = 0;
    for (size_t i = 0; i < n; ++i) any |= found[i] = std::abs(a.values[i] + b.values[i]) < margin ? ~0u : 0u;
    if (any == 0) return known;
    for (size_t i = 0; i < n; ++i) to[i] = found[i] | known.at(i);
    return settled(to, n);
}

void LabelPass::choose(const Instruction& in, const StepContext& c, const Choice& choice) {
    const Source sources[] = {in.a, in.b};
    const bool first = (choice.points & ~choice.names) != 0, second = (choice.points & choice.names) != 0;
    const PieceNames of[] = {first ? operand(in, sources, 0, c).names : PieceNames{},
                             second ? operand(in, sources, 1, c).names : PieceNames{}};
    const size_t n = c.count;
    if (!first || !second) {
        const PieceNames& all = of[first ? 0 : 1];
        names_[in.out] = {copied(all.label, n, labelRow(in.out)), copied(all.origin, n, originRow(in.out))};
        return;
    }
    std::array<uint32_t, maxBlock> takesSecond;
    spreadBits(choice.names, n, takesSecond.data());
    names_[in.out] = {taken(of[0].label, of[1].label, takesSecond.data(), n, labelRow(in.out)),
                      taken(of[0].origin, of[1].origin, takesSecond.data(), n, originRow(in.out))};
}

/// Of each point one of two names; `takesSecond` is all bits or none. In `to` where they differ.
Names LabelPass::taken(const Names& first, const Names& second, const uint32_t* takesSecond, size_t n, uint32_t* to) {
    if (!first.row && !second.row && first.one == second.one) return first;
    const auto take = [&](auto a, auto b) {
        for (size_t i = 0; i < n; ++i) to[i] = (b(i) & takesSecond[i]) | (a(i) & ~takesSecond[i]);
    };
    const auto ofRow = [](const Names& of) { return [p = of.row](size_t i) { return p[i]; }; };
    const auto ofOne = [](const Names& of) { return [v = of.one](size_t) { return v; }; };
    if (first.row && second.row)
        take(ofRow(first), ofRow(second));
    else if (first.row)
        take(ofRow(first), ofOne(second));
    else if (second.row)
        take(ofOne(first), ofRow(second));
    else
        take(ofOne(first), ofOne(second));
    return settled(to, n);
}

/// One piece with all that it joins; a field with edges of its own keeps them where no other counts.
void LabelPass::blend(const Instruction& in, const Source* sources, const StepContext& c) {
    const Operand radius = operand(in, sources, 0, c);
    const size_t n = c.count;
    uint32_t* const labels = labelRow(in.out);
    uint32_t* const origins = originRow(in.out);
    std::array<uint32_t, maxBlock> label{}, origin{};
    std::array<float, maxBlock> best, next;  // the two least values
    for (uint32_t k = 1; k < in.count; ++k) {
        const Operand o = operand(in, sources, k, c);
        for (size_t i = 0; i < n; ++i) {
            const float v = o.at(i);
            if (k == 1 || v < best[i]) {
                next[i] = k == 1 ? std::numeric_limits<float>::infinity() : best[i];
                best[i] = v, label[i] = o.names.label.at(i), origin[i] = o.names.origin.at(i);
            } else {
                next[i] = std::min(next[i], v);
            }
        }
    }
    for (size_t i = 0; i < n; ++i) labels[i] = next[i] - best[i] < radius.at(i) ? in.piece : label[i];
    std::copy_n(origin.data(), n, origins);
    names_[in.out] = {settled(labels, n), settled(origins, n)};
}

/// The face of a box that is nearest.
void LabelPass::nameFaces(const Instruction& in, const Source* sources, const StepContext& c) {
    using Box = ops::Box;
    std::array<Operand, Box::operandCount> o;
    for (uint32_t k = 0; k < Box::operandCount; ++k) o[k] = operand(in, sources, k, c);
    const size_t n = c.count;
    const Names of = combined(in, sources, c), origin = firstOrigin(in, sources, c);
    // By face: up and down along x, y and z. Names that differ from point to point are joined afterwards.
    std::array<uint32_t, 6> names;
    for (uint32_t f = 0; f < names.size(); ++f) {
        const uint32_t label = join(f + 1, of.one);
        names[f] = of.row ? f + 1 : in.piece == 0 ? label : join(in.piece, label);
    }
    uint32_t* const labels = labelRow(in.out);
    std::array<uint32_t, maxBlock> nearest;
    const auto nameBy = [&, names](auto position, auto number) {
        for (size_t i = 0; i < n; ++i) {
            const float dx = position(0, i) - number(3, i), dy = position(1, i) - number(4, i),
                        dz = position(2, i) - number(5, i);
            const float x = std::abs(dx) - number(6, i), y = std::abs(dy) - number(7, i),
                        z = std::abs(dz) - number(8, i);
            const uint32_t nx = dx < 0 ? names[1] : names[0], ny = dy < 0 ? names[3] : names[2],
                           nz = dz < 0 ? names[5] : names[4];
            const uint32_t nxy = y > x ? ny : nx;
            const float xy = y > x ? y : x;
            nearest[i] = z > xy ? nz : nxy;
        }
    };
    bool usual = true;  // rows of positions, numbers else
    for (uint32_t k = 0; k < Box::operandCount; ++k) usual = usual && (o[k].values != nullptr) == (k < Box::centreAt);
    if (usual) {
        std::array<float, Box::operandCount> numbers;
        for (uint32_t k = 0; k < Box::operandCount; ++k) numbers[k] = o[k].constant;
        nameBy([at = std::array{o[0].values, o[1].values, o[2].values}](size_t k, size_t i) { return at[k][i]; },
               [numbers](size_t k, size_t) { return numbers[k]; });
    } else {
        nameBy([&](size_t k, size_t i) { return o[k].at(i); }, [&](size_t k, size_t i) { return o[k].at(i); });
    }
    if (of.row) {
        for (size_t i = 0; i < n; ++i) labels[i] = join(nearest[i], of.row[i]);
        names_[in.out] = {ofPiece(in, settled(labels, n), n), origin};
        return;
    }
    std::copy_n(nearest.data(), n, labels);
    names_[in.out] = {settled(labels, n), origin};
}

/// The two sides of a fold.
void LabelPass::nameSides(const Instruction& in, const Source* sources, const StepContext& c) {
    const Operand a = operand(in, sources, 0, c);
    const Names of = combined(in, sources, c), origin = firstOrigin(in, sources, c);
    uint32_t* const labels = labelRow(in.out);
    for (size_t i = 0; i < c.count; ++i) labels[i] = join(of.at(i), a.at(i) < 0 ? 2 : 1);
    names_[in.out] = {ofPiece(in, settled(labels, c.count), c.count), origin};
}

/// Where either form has an edge, so has what lies between.
void LabelPass::morph(const Instruction& in, const Source* sources, const StepContext& c) {
    const Operand o[] = {operand(in, sources, 0, c), operand(in, sources, 1, c), operand(in, sources, 2, c)};
    const size_t n = c.count;
    uint32_t* const labels = labelRow(in.out);
    uint32_t* const origins = originRow(in.out);
    for (size_t i = 0; i < n; ++i) {
        const uint32_t a = o[0].names.label.at(i), b = o[1].names.label.at(i);
        const uint32_t origin = o[o[2].at(i) > 0.5f ? 1 : 0].names.origin.at(i);
        labels[i] = a == 0 && b == 0 ? 0 : join(a, b);
        origins[i] = origin;
    }
    names_[in.out] = {ofPiece(in, settled(labels, n), n), settled(origins, n)};
}

/// The labels of all operands together; in labelRow(in.out) where they differ from point to point.
Names LabelPass::combined(const Instruction& in, const Source* sources, const StepContext& c) {
    uint32_t one = 0;
    bool rows = false;
    for (uint32_t k = 0; k < in.count; ++k) {
        if (isConstant(sources[k])) continue;
        const Names& label = names_[sources[k]].label;
        rows = rows || label.row;
        one = joinIfBoth(one, label.one);
    }
    if (!rows) return {nullptr, one};
    std::array<uint32_t, maxBlock> all;
    std::fill_n(all.data(), c.count, 0u);
    for (uint32_t k = 0; k < in.count; ++k) {
        if (isConstant(sources[k])) continue;
        const Names& label = names_[sources[k]].label;
        if (label.none()) continue;
        for (size_t i = 0; i < c.count; ++i) all[i] = joinIfBoth(all[i], label.at(i));
    }
    uint32_t* const row = labelRow(in.out);
    std::copy_n(all.data(), c.count, row);
    return {row, 0};
}

/// The origin of the first operand that has one; in originRow(in.out) where it differs from point to point.
Names LabelPass::firstOrigin(const Instruction& in, const Source* sources, const StepContext& c) {
    const auto originOf = [&](uint32_t k) { return operand(in, sources, k, c).names.origin; };
    for (uint32_t k = 0; k < in.count; ++k) {
        const Names first = originOf(k);
        if (first.none()) continue;
        if (!first.row) return first;
        std::array<uint32_t, maxBlock> all;
        std::copy_n(first.row, c.count, all.data());
        for (uint32_t other = k + 1; other < in.count; ++other) {
            const Names next = originOf(other);
            if (next.none()) continue;
            for (size_t i = 0; i < c.count; ++i)
                if (all[i] == 0) all[i] = next.at(i);
        }
        uint32_t* const row = originRow(in.out);
        std::copy_n(all.data(), c.count, row);
        return {row, 0};
    }
    return {};
}

void LabelPass::operator()(const Instruction& in, const StepContext& c) {
    const field::OpTraits& row = field::traits(in.op);
    const Source direct[] = {in.a, in.b};
    const Source* const sources = row.arity == ops::variadic ? c.sources + in.a : direct;
    if (row.pieces == Pieces::Faces) {
        nameFaces(in, sources, c);
    } else if (row.pieces == Pieces::Sides) {
        nameSides(in, sources, c);
    } else if (isUnnamed(in, sources)) {
        names_[in.out] = {row.selects ? Names{} : ofPiece(in, {}, c.count), {}};
    } else if (row.selects) {
        choose(in, sources, c, row.owner == Owner::Least);
    } else if (row.hasSides) {
        choose(in, sources, c, false);
        names_[in.out].label = ofPiece(in, names_[in.out].label, c.count);
    } else if (row.pieces == Pieces::Joined) {
        blend(in, sources, c);
    } else if (row.pieces == Pieces::OfNearer) {
        morph(in, sources, c);
    } else {
        const Names origin = firstOrigin(in, sources, c);
        const Names label = row.pieces == Pieces::Forgotten ? Names{} : combined(in, sources, c);
        names_[in.out] = {ofPiece(in, label, c.count), origin};
    }
}

void LabelPass::store(uint32_t* labels, OriginId* origins, size_t n) const {
    const Source s = tape_.result();
    const PieceNames names = isConstant(s) ? PieceNames{} : names_[s];
    const OriginId own = tape_.origins()[0];
    for (size_t i = 0; i < n; ++i) {
        labels[i] = names.label.at(i);
        origins[i] = own != 0 ? own : names.origin.at(i);
    }
}

}  // namespace sgm::eval
