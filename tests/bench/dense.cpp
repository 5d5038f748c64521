#include "tests/bench/dense.h"

#include <cstring>

#include "modeler/core/parallel.h"
#include "modeler/mesh/marching_cubes.h"
#include "modeler/mesh/mesh.h"

namespace sgm::bench {
namespace {

constexpr int slabLayers = 32;
constexpr int thinLayers = 8;       ///< of a part that stands for the whole
constexpr int pointsAtOnce = 2048;  ///< their coordinates stay in cache

/// Calls body(i, byte) for every byte that is neither 0 nor 255, eight at a time where all are alike.
/// `bytes` is readable up to the next multiple of eight, with zeros past `n`.
template <class Body>
void forEachMixed(const uint8_t* bytes, int n, Body&& body) {
    for (int i = 0; i < n; i += 8) {
        uint64_t word;
        std::memcpy(&word, bytes + i, sizeof word);
        if (word == 0 || word == ~uint64_t{0}) continue;
        for (int k = i; k < std::min(i + 8, n); ++k)
            if (bytes[k] != 0 && bytes[k] != 255) body(k, bytes[k]);
    }
}

/// Samples planes of a grid, a few rows at a time, for one worker.
class PlaneSampler {
public:
    PlaneSampler(const Sampler& sampler, const mesh::Grid& grid, int worker)
        : sampler_(sampler), grid_(grid), worker_(worker) {}

    /// All corners of plane `k`, x fastest.
    void sample(int k, float* out) {
        const int nx = grid_.cells.x + 1, ny = grid_.cells.y + 1, rows = std::max(1, pointsAtOnce / nx);
        const auto at = [&](int i, int j) {
            return static_cast<size_t>(j) * static_cast<size_t>(nx) + static_cast<size_t>(i);
        };
        const size_t room = at(0, rows);
        x_.resize(room), y_.resize(room), z_.assign(room, grid_.corner(0, 0, k).z);
        for (int j = 0; j < rows; ++j)
            for (int i = 0; i < nx; ++i) x_[at(i, j)] = grid_.corner(i, 0, 0).x;
        for (int j0 = 0; j0 < ny; j0 += rows) {
            const int count = std::min(rows, ny - j0);
            for (int j = 0; j < count; ++j) std::fill_n(y_.data() + at(0, j), nx, grid_.corner(0, j0 + j, 0).y);
            sampler_({x_.data(), y_.data(), z_.data(), at(0, count)}, out + at(0, j0), worker_);
        }
    }

private:
    const Sampler& sampler_;
    const mesh::Grid& grid_;
    int worker_;
    std::vector<float> x_, y_, z_;
};

/// Samples of one plane, which of them are inside, and the vertices on its edges.
struct Plane {
    const float* values = nullptr;
    std::vector<uint8_t> inside;         ///< 1 or 0
    std::vector<uint32_t> xEdge, yEdge;  ///< vertex on the edge that starts at a corner; only set where one is

    explicit Plane(size_t corners) : inside(corners), xEdge(corners), yEdge(corners) {}
};

/// A slab of layers on its way to triangles.
class Slab {
public:
    explicit Slab(const mesh::Grid& grid)
        : grid_(grid),
          n_(grid.cells + Vec3i{1, 1, 1}),
          lower_(corners()),
          upper_(corners()),
          zEdge_(corners()),
          row_(static_cast<size_t>(n_.x) + 8) {}

    /// Layers [first, last) of cells; plane(k) gives the samples of plane k, valid until the next but one is asked for.
    template <class PlaneOf>
    void run(int first, int last, PlaneOf&& plane) {
        enter(plane(first));
        for (int k = first; k < last; ++k) {
            std::swap(lower_, upper_);
            enter(plane(k + 1));
            if (k == first) addPlaneVertices(lower_, k);
            addPlaneVertices(upper_, k + 1);
            addUprightVertices(k);
            for (int j = 0; j < grid_.cells.y; ++j) joinRow(j);
        }
    }

    std::vector<Vec3f> positions;
    std::vector<mesh::Triangle> triangles;

private:
    size_t corners() const { return static_cast<size_t>(n_.x) * static_cast<size_t>(n_.y); }
    size_t at(int i, int j) const {
        return static_cast<size_t>(j) * static_cast<size_t>(n_.x) + static_cast<size_t>(i);
    }

    void enter(const float* values) {
        upper_.values = values;
        for (size_t c = 0; c < upper_.inside.size(); ++c) upper_.inside[c] = values[c] < 0 ? 1 : 0;
    }

    /// Where the line between two samples of different sign crosses zero; both at corners of the grid.
    uint32_t addVertex(Vec3i corner, int axis, float a, float b) {
        Vec3f p = grid_.corner(corner.x, corner.y, corner.z);
        p[axis] += grid_.cell_m * (a / (a - b));
        positions.push_back(p);
        return static_cast<uint32_t>(positions.size() - 1);
    }

    void addPlaneVertices(Plane& plane, int k) {
        for (int j = 0; j < n_.y; ++j) {
            const float* v = plane.values + at(0, j);
            const uint8_t* in = plane.inside.data() + at(0, j);
            for (int i = 0; i + 1 < n_.x; ++i) row_[i] = in[i] ^ in[i + 1];
            forEachMixed(row_.data(), n_.x - 1, [&](int i, uint8_t) {
                plane.xEdge[at(i, j)] = addVertex({i, j, k}, 0, v[i], v[i + 1]);
            });
            if (j + 1 == n_.y) break;
            for (int i = 0; i < n_.x; ++i) row_[i] = in[i] ^ in[i + n_.x];
            forEachMixed(row_.data(), n_.x, [&](int i, uint8_t) {
                plane.yEdge[at(i, j)] = addVertex({i, j, k}, 1, v[i], v[i + n_.x]);
            });
        }
    }

    /// Vertices between the two planes.
    void addUprightVertices(int k) {
        for (int j = 0; j < n_.y; ++j) {
            const size_t first = at(0, j);
            for (int i = 0; i < n_.x; ++i) row_[i] = lower_.inside[first + i] ^ upper_.inside[first + i];
            forEachMixed(row_.data(), n_.x, [&](int i, uint8_t) {
                zEdge_[first + i] = addVertex({i, j, k}, 2, lower_.values[first + i], upper_.values[first + i]);
            });
        }
    }

    uint32_t vertexOn(int edge, int i, int j) const {
        const int corner = mesh::edgeCorner(edge);
        const size_t c = at(i + (corner & 1), j + (corner >> 1 & 1));
        const Plane& plane = (corner >> 2 & 1) != 0 ? upper_ : lower_;
        const int axis = mesh::edgeAxis(edge);
        return axis == 0 ? plane.xEdge[c] : axis == 1 ? plane.yEdge[c] : zEdge_[c];
    }

    /// The triangles of a row of cells.
    void joinRow(int j) {
        const uint8_t* a = lower_.inside.data() + at(0, j);
        const uint8_t* b = a + n_.x;
        const uint8_t* c = upper_.inside.data() + at(0, j);
        const uint8_t* d = c + n_.x;
        for (int i = 0; i + 1 < n_.x; ++i)
            row_[i] = static_cast<uint8_t>(a[i] | a[i + 1] << 1 | b[i] << 2 | b[i + 1] << 3 | c[i] << 4 |
                                           c[i + 1] << 5 | d[i] << 6 | d[i + 1] << 7);
        row_[n_.x - 1] = 0;
        forEachMixed(row_.data(), n_.x - 1, [&](int i, uint8_t mask) {
            const mesh::CellCase& cell = mesh::caseTable()[mask];
            for (int t = 0; t < cell.triangles; ++t)
                triangles.push_back({vertexOn(cell.edges[3 * t], i, j), vertexOn(cell.edges[3 * t + 1], i, j),
                                     vertexOn(cell.edges[3 * t + 2], i, j)});
        });
    }

    const mesh::Grid& grid_;
    Vec3i n_;  ///< corners
    Plane lower_, upper_;
    std::vector<uint32_t> zEdge_;
    std::vector<uint8_t> row_;
};

/// Layers [first, last) that are swept as one task, and what that took and gave.
struct Part {
    int first = 0, last = 0;
    double evaluateSeconds = 0, polygonizeSeconds = 0;
    std::vector<Vec3f> positions = {};
    std::vector<mesh::Triangle> triangles = {};

    void take(Slab& slab) { positions = std::move(slab.positions), triangles = std::move(slab.triangles); }
};

std::vector<Part> partsOf(int layers, int threads, bool inPart) {
    std::vector<Part> parts;
    if (!inPart) {
        for (int k = 0; k < layers; k += slabLayers)
            parts.push_back({.first = k, .last = std::min(k + slabLayers, layers)});
        return parts;
    }
    for (int t = 0; t < threads; ++t) {
        const int middle = (2 * t + 1) * layers / (2 * threads);
        parts.push_back(
            {.first = std::max(0, middle - thinLayers / 2), .last = std::min(layers, middle + thinLayers / 2)});
    }
    return parts;
}

/// Each part samples its planes into two buffers of its own and joins them at once.
void sweepFused(const Sampler& sampler, const mesh::Grid& grid, Running running, std::vector<Part>& parts) {
    const size_t planeSize = static_cast<size_t>(grid.cells.x + 1) * static_cast<size_t>(grid.cells.y + 1);
    parallelFor(parts.size(), running.threads, nullptr, [&](size_t i, int worker) {
        const Stopwatch whole(running.clock);
        Part& part = parts[i];
        PlaneSampler planes(sampler, grid, worker);
        std::vector<float> buffers(2 * planeSize);
        Slab slab(grid);
        slab.run(part.first, part.last, [&](int k) {
            const Stopwatch sampling(running.clock);
            float* const buffer = buffers.data() + static_cast<size_t>(k & 1) * planeSize;
            planes.sample(k, buffer);
            part.evaluateSeconds += sampling.seconds();
            return buffer;
        });
        part.polygonizeSeconds = whole.seconds() - part.evaluateSeconds;
        part.take(slab);
    });
}

/// First all samples into memory, then marching cubes over them. Gives the memory; parts that don't meet lie a plane
/// apart.
std::shared_ptr<float[]> sweepStored(const Sampler& sampler, const mesh::Grid& grid, Running running, bool inPart,
                                     std::vector<Part>& parts) {
    const size_t planeSize = static_cast<size_t>(grid.cells.x + 1) * static_cast<size_t>(grid.cells.y + 1);
    struct Place {
        int k;
        size_t part;
    };
    std::vector<Place> planes;                // in memory's order
    std::vector<size_t> begin(parts.size());  // first plane of each part
    for (size_t i = 0; i < parts.size(); ++i) {
        if (inPart && i > 0) planes.push_back({parts[i - 1].last, i - 1});
        begin[i] = planes.size();
        for (int k = parts[i].first; k < parts[i].last; ++k) planes.push_back({k, i});
    }
    planes.push_back({parts.back().last, parts.size() - 1});
    std::shared_ptr<float[]> values(new float[planes.size() * planeSize]);  // not cleared: every value is written
    std::vector<double> seconds(planes.size());
    parallelFor(planes.size(), running.threads, nullptr, [&](size_t p, int worker) {
        const Stopwatch sampling(running.clock);
        PlaneSampler(sampler, grid, worker).sample(planes[p].k, values.get() + p * planeSize);
        seconds[p] = sampling.seconds();
    });
    for (size_t p = 0; p < planes.size(); ++p) parts[planes[p].part].evaluateSeconds += seconds[p];
    parallelFor(parts.size(), running.threads, nullptr, [&](size_t i, int) {
        const Stopwatch joining(running.clock);
        Slab slab(grid);
        slab.run(parts[i].first, parts[i].last, [&](int k) {
            return values.get() + (begin[i] + static_cast<size_t>(k - parts[i].first)) * planeSize;
        });
        parts[i].take(slab);
        parts[i].polygonizeSeconds = joining.seconds();
    });
    return values;
}

}  // namespace

DenseResult sweepDense(Sweep kind, const Sampler& sampler, const mesh::Grid& grid, Running running, bool inPart) {
    const int workers = running.threads;
    std::vector<Part> parts = partsOf(grid.cells.z, workers, inPart);
    DenseResult result;
    const Stopwatch whole(running);
    if (kind == Sweep::Fused)
        sweepFused(sampler, grid, running, parts);
    else
        result.values = sweepStored(sampler, grid, running, inPart, parts);
    result.seconds = whole.seconds();
    int layers = 0;
    for (const Part& part : parts) {
        layers += part.last - part.first;
        result.evaluateSeconds += part.evaluateSeconds / workers;
        result.polygonizeSeconds += part.polygonizeSeconds / workers;
        result.triangles += part.triangles.size();
    }
    result.scaled = inPart;
    if (!inPart) return result;
    // A part evaluates a plane more than it has layers.
    const double scale = static_cast<double>(grid.cells.z) / layers;
    const double planes = static_cast<double>(grid.cells.z + 1) / (layers + static_cast<int>(parts.size()));
    result.evaluateSeconds *= planes, result.polygonizeSeconds *= scale;
    result.seconds = result.evaluateSeconds + result.polygonizeSeconds;
    result.triangles = static_cast<uint64_t>(static_cast<double>(result.triangles) * scale);
    result.values.reset();
    return result;
}

}  // namespace sgm::bench
