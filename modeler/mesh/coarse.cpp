#include "modeler/mesh/coarse.h"

#include <algorithm>

namespace sgm::mesh {
namespace {

/// Every second corner of a brick, by `sampledBelow`.
const SampleRows& coarseRows(uint8_t below, int along) {
    static const auto table = [along] {
        std::array<SampleRows, 256> all;
        for (int b = 0; b < 256; ++b) all[b].list(Vec3i{1, 1, 1} * coarseCorners, static_cast<uint8_t>(b), along);
        return all;
    }();
    return table[below];
}

/// Bits of corners by row, as in Between.
using CornerBits = std::array<uint16_t, brickCorners * brickCorners>;

/// All but those on the low sides that `below` names.
CornerBits allBut(uint8_t below) {
    CornerBits bits{};
    for (int k = 0; k < brickCorners; ++k)
        for (int j = 0; j < brickCorners; ++j) {
            const int low = (j == 0 ? 2 : 0) | (k == 0 ? 4 : 0);
            const int some = below >> (low | 1) & 1 ? 0x1fe : 0x1ff;
            bits[j + brickCorners * k] = static_cast<uint16_t>(below >> low & 1 ? 0 : some);
        }
    return bits;
}

/// Leaves out the corners that lower bricks have.
void leaveOut(uint8_t below, Between& between) {
    static const auto table = [] {
        std::array<CornerBits, 256> all;
        for (int b = 0; b < 256; ++b) all[b] = allBut(static_cast<uint8_t>(b));
        return all;
    }();
    const CornerBits& bits = table[below];
    for (size_t row = 0; row < bits.size(); ++row) between.needed[row] &= bits[row];
}

/// Leaves out the corners beyond `last`.
void cutOff(Vec3i last, Between& between) {
    const int along = (2 << std::min(last.x, brickCells)) - 1;
    for (int k = 0; k < brickCorners; ++k)
        for (int j = 0; j < brickCorners; ++j) {
            uint16_t& row = between.needed[j + brickCorners * k];
            row = static_cast<uint16_t>(j > last.y || k > last.z ? 0 : row & along);
        }
}

}  // namespace

const CoarseLoops& coarseLoops() {
#if defined(SGM_X86_KERNELS)
    static const CoarseLoops& best = eval::bestIsa() == eval::Isa::Avx512 ? avx512::coarseLoops
                                     : eval::bestIsa() == eval::Isa::Avx2 ? avx2::coarseLoops
                                                                          : portable::coarseLoops;
    return best;
#else
    return portable::coarseLoops;
#endif
}

uint64_t CoarseSamples::enter(const Block& block, uint64_t bricks, const CornerCoordinates& coordinates, float cell_m,
                              eval::Workspace& workspace, Counts& counts) {
    if (bricks == 0) return 0;
    for (int axis = 0; axis < 3; ++axis)
        for (int i = 0; i < along; ++i) coordinates_[axis][i] = coordinates[axis][2 * i];
    counts.pointEvaluations += ask(block.tape, bricks, workspace);
    const float unit = block.tape.lipschitz() * cell_m;
    const FarFrom far{farEdge * unit, farFace * unit, farMiddle * unit};
    uint64_t found = 0;
    for (uint64_t rest = bricks; rest != 0; rest &= rest - 1) {
        const int brick = std::countr_zero(rest);
        const float* const values = values_.data() + corner(brickAt(brick));
        if (coarseLoops().find(values, row, layer, far, between_[brick])) found |= 1ull << brick;
    }
    return found;
}

/// Evaluates every second corner of the bricks, as many bricks at a time as there is room for; returns how many
/// corners.
size_t CoarseSamples::ask(const eval::Tape& tape, uint64_t bricks, eval::Workspace& workspace) {
    const BrickLoops& loops = brickLoops();
    size_t all = 0;
    for (uint64_t rest = bricks; rest != 0;) {
        size_t points = 0;
        const uint64_t first = rest;
        for (; rest != 0; rest &= rest - 1) {
            const int brick = std::countr_zero(rest);
            const SampleRows& rows = coarseRows(sampledBelow(bricks, brick), along);
            if (points + rows.points > enough) break;
            const Vec3i low = brickAt(brick) * (coarseCorners - 1);
            loops.gather(rows.rows.data(), rows.count, &coordinates_[0][low.x], &coordinates_[1][low.y],
                         &coordinates_[2][low.z], points_.x.data() + points, points_.y.data() + points,
                         points_.z.data() + points);
            points += rows.points;
        }
        points_.evaluate(tape, points, f_.data(), workspace);
        const float* f = f_.data();
        for (uint64_t done = first & ~rest; done != 0; done &= done - 1) {
            const int brick = std::countr_zero(done);
            const SampleRows& rows = coarseRows(sampledBelow(bricks, brick), along);
            loops.scatter(rows.rows.data(), rows.count, f, values_.data() + corner(brickAt(brick)));
            f += rows.points;
        }
        all += points;
    }
    return all;
}

void CoarseSamples::sample(uint64_t bricks, uint64_t active, const eval::Tape& tape,
                           const CornerCoordinates& coordinates, Vec3i last, float* values, eval::Workspace& workspace,
                           Counts& counts) {
    constexpr size_t rowStride = blockCorners, layerStride = blockCorners * blockCorners;
    const CoarseLoops& loops = coarseLoops();
    std::array<size_t, bricksPerBlock> asked;  // corners of a brick
    uint64_t waiting = 0;
    size_t n = 0;
    const auto evaluate = [&] {
        if (n > 0) points_.evaluate(tape, n, f_.data(), workspace);
        const float* f = f_.data();
        for (; waiting != 0; waiting &= waiting - 1) {
            const int brick = std::countr_zero(waiting);
            loops.scatter(between_[brick], f, values + brickCorner(brickAt(brick)), rowStride, layerStride);
            f += asked[brick];
        }
        counts.pointEvaluations += n;
        n = 0;
    };
    for (uint64_t rest = bricks; rest != 0; rest &= rest - 1) {
        const int brick = std::countr_zero(rest);
        const Vec3i at = brickAt(brick), first = at * brickCells;
        Between& between = between_[brick];
        loops.fill(values_.data() + corner(at), row, layer, between, values + brickCorner(at), rowStride, layerStride);
        leaveOut(sampledBelow(active, brick), between);
        if (minComponent(last - first) < brickCells) cutOff(last - first, between);
        asked[brick] =
            loops.gather(between, &coordinates[0][first.x], &coordinates[1][first.y], &coordinates[2][first.z],
                         points_.x.data() + n, points_.y.data() + n, points_.z.data() + n);
        waiting |= 1ull << brick;
        n += asked[brick];
        if (n >= enough) evaluate();
    }
    evaluate();
}

}  // namespace sgm::mesh
