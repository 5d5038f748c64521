#include "modeler/mesh/vertices.h"

#include <algorithm>
#include <cmath>

namespace sgm::mesh {
namespace {

/// Residual, as a share of the difference between the bracket's ends, that one more interpolation may settle unseen: on
/// a smooth field it leaves the square of this, on a kink no more than the margin that vertices are moved by anyway.
constexpr float goodEnough = edgeMargin;

/// Lays out a lane for each cut edge: its line, and the bracket given by the samples at its ends.
void loadEdges(const Brick& brick, Vec3i blockIndex, const Grid& grid, const BlockSamples& samples, EdgeLanes& lanes) {
    lanes.resize(brick.vertices());
    for (int axis = 0; axis < 3; ++axis) lanes.axisBegin[axis] = brick.rank[axis * slabs];
    lanes.axisBegin[3] = lanes.size();

    const Vec3i first = brickAt(brick.number) * brickCells, global = blockIndex * blockCells + first;
    size_t lane = 0;
    forEachVertex(brick, [&](int axis, Vec3i c) {
        Vec3i end = c;
        ++end[axis];
        const Vec3i g = global + c, h = global + end;
        const Vec3f p = grid.corner(g.x, g.y, g.z), q = grid.corner(h.x, h.y, h.z);
        lanes.x[lane] = p.x, lanes.y[lane] = p.y, lanes.z[lane] = p.z;
        lanes.base[lane] = p[axis], lanes.span[lane] = q[axis] - p[axis];
        const bool lowInside = (brick.inside[c.y + brickCorners * c.z] >> c.x & 1) != 0;
        const float low = samples.row(first.y + c.y, first.z + c.z)[first.x + c.x];
        const float high = samples.row(first.y + end.y, first.z + end.z)[first.x + end.x];
        lanes.tIn[lane] = lowInside ? 0.0f : 1.0f, lanes.fIn[lane] = lowInside ? low : high;
        lanes.tOut[lane] = lowInside ? 1.0f : 0.0f;
        // On the grid's border the outer end counts as outside whatever the field says there.
        lanes.fOut[lane] = std::max(0.0f, lowInside ? high : low);
        ++lane;
    });
    std::fill(lanes.wIn.begin(), lanes.wIn.end(), 1.0f);
    std::fill(lanes.wOut.begin(), lanes.wOut.end(), 1.0f);
    std::fill(lanes.lastSide.begin(), lanes.lastSide.end(), 0.0f);
}

/// The line through the bracket's (weighted) ends meets zero at t; then the lanes' positions follow t.
void interpolate(EdgeLanes& lanes, bool weighted) {
    const size_t n = lanes.size();
    for (size_t i = 0; i < n; ++i) {
        const float in = weighted ? lanes.fIn[i] * lanes.wIn[i] : lanes.fIn[i];
        const float out = weighted ? lanes.fOut[i] * lanes.wOut[i] : lanes.fOut[i];
        const float t = lanes.tIn[i] + (lanes.tOut[i] - lanes.tIn[i]) * (in / (in - out));
        // The comparisons send a NaN (from infinite values) to the margin.
        const float low = t > edgeMargin ? t : edgeMargin;
        lanes.t[i] = low < 1.0f - edgeMargin ? low : 1.0f - edgeMargin;
    }
    float* const moving[3] = {lanes.x.data(), lanes.y.data(), lanes.z.data()};
    for (int axis = 0; axis < 3; ++axis)
        for (size_t i = lanes.axisBegin[axis]; i < lanes.axisBegin[axis + 1]; ++i)
            moving[axis][i] = lanes.base[i] + lanes.t[i] * lanes.span[i];
}

/// Puts the value at t in the place of the bracket's end of its sign; an end that stays twice loses half its weight.
/// Returns false once every lane is good enough.
bool narrow(EdgeLanes& lanes) {
    const size_t n = lanes.size();
    int open = 0;
    for (size_t i = 0; i < n; ++i) {
        const float t = lanes.t[i], f = lanes.f[i];
        open |= std::abs(f) > goodEnough * (lanes.fOut[i] - lanes.fIn[i]) ? 1 : 0;
        const bool inside = f < 0;
        const float side = inside ? 1.0f : -1.0f;
        const float halve = lanes.lastSide[i] == side ? 0.5f : 1.0f;
        lanes.lastSide[i] = side;
        lanes.wIn[i] = inside ? 1.0f : lanes.wIn[i] * halve;
        lanes.wOut[i] = inside ? lanes.wOut[i] * halve : 1.0f;
        lanes.tIn[i] = inside ? t : lanes.tIn[i];
        lanes.fIn[i] = inside ? f : lanes.fIn[i];
        lanes.tOut[i] = inside ? lanes.tOut[i] : t;
        lanes.fOut[i] = inside ? lanes.fOut[i] : f;
    }
    return open != 0;
}

void appendPositions(const EdgeLanes& lanes, std::vector<Vec3f>& positions) {
    const size_t n = lanes.size(), first = positions.size();
    positions.resize(first + n);
    for (size_t i = 0; i < n; ++i) positions[first + i] = {lanes.x[i], lanes.y[i], lanes.z[i]};
}

void appendNormals(const EdgeLanes& lanes, std::vector<Vec3f>& normals) {
    const size_t n = lanes.size(), first = normals.size();
    normals.resize(first + n);
    for (size_t i = 0; i < n; ++i) {
        const Vec3f g{lanes.dx[i], lanes.dy[i], lanes.dz[i]};
        const float squared = dot(g, g);
        const bool usable = squared > 1e-30f && squared < 1e30f;
        const float scale = usable ? 1.0f / std::sqrt(squared) : 0.0f;
        normals[first + i] = usable ? g * scale : Vec3f{};
    }
}

}  // namespace

void EdgeLanes::resize(size_t n) {
    for (std::vector<float>* v :
         {&x, &y, &z, &base, &span, &tIn, &fIn, &wIn, &tOut, &fOut, &wOut, &lastSide, &t, &f, &dx, &dy, &dz})
        v->resize(n);
}

void appendVertices(const Brick& brick, Vec3i blockIndex, const Grid& grid, const BlockSamples& samples,
                    int refineSteps, bool wantOrigins, eval::Workspace& workspace, EdgeLanes& lanes,
                    BlockVertices& vertices, Counts& counts) {
    loadEdges(brick, blockIndex, grid, samples, lanes);
    const size_t n = lanes.size();
    if (n == 0) return;
    const eval::Tape& tape = samples.tapes[brick.number];
    const eval::Points points{lanes.x.data(), lanes.y.data(), lanes.z.data(), n};

    interpolate(lanes, true);
    for (int step = 0; step < refineSteps; ++step) {
        eval::evaluate(tape, points, lanes.f.data(), workspace);
        counts.refinementEvaluations += n;
        const bool open = narrow(lanes);
        // The last interpolation trusts the values as they are: nobody looks at the result again.
        interpolate(lanes, open && step + 1 < refineSteps);
        if (!open) break;
    }
    if (wantOrigins) vertices.origins.resize(vertices.origins.size() + n);
    eval::evaluateGradient(tape, points, lanes.f.data(), lanes.dx.data(), lanes.dy.data(), lanes.dz.data(), workspace,
                           wantOrigins ? vertices.origins.data() + vertices.origins.size() - n : nullptr);

    appendPositions(lanes, vertices.positions);
    appendNormals(lanes, vertices.normals);
}

}  // namespace sgm::mesh
