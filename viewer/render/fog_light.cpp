#include "viewer/render/fog_light.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "modeler/core/parallel.h"
#include "modeler/core/random.h"

namespace sgm::render {
namespace {

using volume::Dense;

/// A slice of the grid's array and the steps within it.
struct Slicing {
    int axis, u, v;
    std::array<size_t, 3> stride;
    size_t at(int slice, int i, int j) const {
        return size_t(slice) * stride[size_t(axis)] + size_t(i) * stride[size_t(u)] + size_t(j) * stride[size_t(v)];
    }
};

/// Where a ray crosses the slice before: the lower corner of four voxels and their weights.
struct Crossing {
    int du, dv;
    std::array<float, 4> weights;
};

Crossing crossingOf(float u, float v) {
    const float fu = std::floor(u), fv = std::floor(v), a = u - fu, b = v - fv;
    return {static_cast<int>(fu), static_cast<int>(fv), {(1 - a) * (1 - b), a * (1 - b), (1 - a) * b, a * b}};
}

uint16_t word(float share) { return static_cast<uint16_t>(std::lround(std::clamp(share, 0.0f, 1.0f) * 65535)); }

/// Chebyshev distance in bricks to the next brick with fog: a pass over all bricks for each brick of distance.
void spread(std::vector<uint8_t>& distance, Vec3i count) {
    const std::array<size_t, 3> stride{1, size_t(count.x), size_t(count.x) * size_t(count.y)};
    for (bool changed = true; changed;) {
        changed = false;
        const std::vector<uint8_t> before = distance;
        for (int z = 0; z < count.z; ++z)
            for (int y = 0; y < count.y; ++y)
                for (int x = 0; x < count.x; ++x) {
                    const size_t here = size_t(x) + size_t(y) * stride[1] + size_t(z) * stride[2];
                    if (before[here] == 0) continue;
                    int least = before[here];
                    for (int k = 0; k < 27; ++k) {
                        const int nx = x + k % 3 - 1, ny = y + k / 3 % 3 - 1, nz = z + k / 9 - 1;
                        if (nx < 0 || ny < 0 || nz < 0 || nx >= count.x || ny >= count.y || nz >= count.z) continue;
                        const size_t there = size_t(nx) + size_t(ny) * stride[1] + size_t(nz) * stride[2];
                        least = std::min(least, before[there] + 1);
                    }
                    if (least < before[here]) {
                        distance[here] = static_cast<uint8_t>(least);
                        changed = true;
                    }
                }
    }
}

void findBricks(const Dense& grid, FogTexels& texels) {
    constexpr int edge = FogTexels::brickEdge;
    texels.brickCount = {(grid.count.x + edge - 1) / edge, (grid.count.y + edge - 1) / edge,
                         (grid.count.z + edge - 1) / edge};
    const Vec3i n = texels.brickCount;
    texels.bricks.assign(size_t(n.x) * size_t(n.y) * size_t(n.z), 255);
    // Interpolation reaches one voxel on, so a voxel counts for the bricks of its neighbours too.
    for (int z = 0; z < grid.count.z; ++z)
        for (int y = 0; y < grid.count.y; ++y)
            for (int x = 0; x < grid.count.x; ++x) {
                if (!(grid.values[grid.index(x, y, z)] > 0)) continue;
                for (int k = 0; k < 8; ++k) {
                    const int bx = std::clamp(x + (k & 1 ? 1 : -1), 0, grid.count.x - 1) / edge,
                              by = std::clamp(y + (k & 2 ? 1 : -1), 0, grid.count.y - 1) / edge,
                              bz = std::clamp(z + (k & 4 ? 1 : -1), 0, grid.count.z - 1) / edge;
                    texels.bricks[(size_t(bz) * size_t(n.y) + size_t(by)) * size_t(n.x) + size_t(bx)] = 0;
                }
            }
    spread(texels.bricks, n);
}

/// Up and four to the sides, or their mirror images; with the weights of a cosine.
std::array<Vec3f, 5> skyDirections(float up) {
    std::array<Vec3f, 5> directions{Vec3f{0, up, 0}};
    for (int i = 0; i < 4; ++i) {
        const float angle = 0.6f + 1.5707963f * static_cast<float>(i);
        directions[size_t(i) + 1] = normalized(Vec3f{std::cos(angle), 0.55f * up, std::sin(angle)});
    }
    return directions;
}

}  // namespace

std::vector<float> opticalDepth(const Dense& grid, Vec3f towardsLight, int threads) {
    Slicing s{0, 1, 2, {1, size_t(grid.count.x), size_t(grid.count.x) * size_t(grid.count.y)}};
    for (int a = 1; a < 3; ++a)
        if (std::abs(towardsLight[a]) > std::abs(towardsLight[s.axis])) s.axis = a;
    s.u = (s.axis + 1) % 3;
    s.v = (s.axis + 2) % 3;
    const float along = std::abs(towardsLight[s.axis]);
    const Crossing cross = crossingOf(towardsLight[s.u] / along, towardsLight[s.v] / along);
    const float half = 0.5f * grid.voxel_m / along;
    const int slices = grid.count[s.axis], us = grid.count[s.u], vs = grid.count[s.v];
    const bool fromEnd = towardsLight[s.axis] > 0;
    std::vector<float> depth(grid.values.size(), 0.0f);
    for (int k = 1; k < slices; ++k) {
        const int slice = fromEnd ? slices - 1 - k : k, before = fromEnd ? slice + 1 : slice - 1;
        parallelFor(size_t(vs), threads, nullptr, [&](size_t row, int) {
            const int j = static_cast<int>(row);
            for (int i = 0; i < us; ++i) {
                float tau = 0, value = 0;
                for (int c = 0; c < 4; ++c) {
                    const int pi = i + cross.du + (c & 1), pj = j + cross.dv + (c >> 1);
                    if (pi < 0 || pj < 0 || pi >= us || pj >= vs) continue;
                    const size_t from = s.at(before, pi, pj);
                    tau += cross.weights[size_t(c)] * depth[from];
                    value += cross.weights[size_t(c)] * grid.values[from];
                }
                const size_t here = s.at(slice, i, j);
                depth[here] = tau + half * (value + grid.values[here]);
            }
        });
    }
    return depth;
}

Result<FogTexels> lightFog(const Dense& grid, float extinction_per_m, float thin, Vec3f towardsSun, int threads,
                           Progress* progress) {
    // Light from all around diffuses: it fades by a share of what a ray does.
    constexpr float diffusion = 0.22f;
    if (progress) progress->begin("light", 11);
    FogTexels texels;
    findBricks(grid, texels);
    texels.rgba.assign(grid.values.size() * 4, 0);
    Dense thinned = grid;
    for (float& value : thinned.values) value = std::max(0.0f, value - thin) / (1 - thin) * extinction_per_m;
    const std::vector<float> sun = opticalDepth(thinned, towardsSun, threads);
    tick(progress);
    for (size_t i = 0; i < sun.size(); ++i) {
        texels.rgba[4 * i] = word(grid.values[i]);
        texels.rgba[4 * i + 1] = word(std::sqrt(sun[i] / FogTexels::mostSunDepth));
    }
    for (const float up : {1.0f, -1.0f}) {
        std::vector<float> seen(grid.values.size(), 0.0f);
        for (const Vec3f& direction : skyDirections(up)) {
            if (cancelled(progress)) return cancelledError();
            const std::vector<float> depth = opticalDepth(thinned, direction, threads);
            for (size_t i = 0; i < seen.size(); ++i) seen[i] += 0.2f * std::exp(-diffusion * depth[i]);
            tick(progress);
        }
        for (size_t i = 0; i < seen.size(); ++i) texels.rgba[4 * i + (up > 0 ? 2 : 3)] = word(seen[i]);
    }
    return texels;
}

std::vector<uint8_t> billows(int edge) {
    std::vector<float> sums(size_t(edge) * size_t(edge) * size_t(edge), 0.0f);
    float weight = 1, weights = 0;
    for (int cells = 4, octave = 0; octave < 3; ++octave, cells *= 2, weight *= 0.5f) {
        weights += weight;
        std::vector<Vec3f> points;
        for (int i = 0; i < cells * cells * cells; ++i) {
            const auto draw = [&](uint64_t axis) {
                return static_cast<float>(uniform(combine(combine(uint64_t(octave), axis), uint64_t(i)), 0, 1));
            };
            points.push_back({draw(1), draw(2), draw(3)});
        }
        const float scale = static_cast<float>(cells) / static_cast<float>(edge);
        parallelFor(size_t(edge), 0, nullptr, [&](size_t z, int) {
            for (int y = 0; y < edge; ++y)
                for (int x = 0; x < edge; ++x) {
                    const Vec3f p = Vec3f{float(x) + 0.5f, float(y) + 0.5f, float(z) + 0.5f} * scale;
                    const Vec3i cell{int(p.x), int(p.y), int(p.z)};
                    float nearest = 1;
                    for (int k = 0; k < 27; ++k) {
                        const Vec3i to = cell + Vec3i{k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1};
                        const auto wrap = [&](int a) { return size_t((a + cells) % cells); };
                        const Vec3f& jitter =
                            points[(wrap(to.z) * size_t(cells) + wrap(to.y)) * size_t(cells) + wrap(to.x)];
                        const Vec3f d = to.as<float>() + jitter - p;
                        nearest = std::min(nearest, dot(d, d));
                    }
                    sums[(z * size_t(edge) + size_t(y)) * size_t(edge) + size_t(x)] +=
                        weight * (1 - std::sqrt(nearest));
                }
        });
    }
    std::vector<uint8_t> bytes;
    for (const float sum : sums)
        bytes.push_back(static_cast<uint8_t>(std::lround(255 * std::clamp(sum / weights, 0.0f, 1.0f))));
    return bytes;
}

}  // namespace sgm::render
