#include "tests/bench/dense.h"

#include <cstring>

#include "modeler/core/parallel.h"
#include "modeler/mesh/marching_cubes.h"
#include "modeler/mesh/mesh.h"
#include "tests/bench/stopwatch.h"

namespace sgm::bench {
namespace {

constexpr int slabLayers = 32;
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

/// Samples of one plane, which of them are inside, and the vertices on its edges.
struct Plane {
    std::vector<float> values;
    std::vector<uint8_t> inside;         ///< 1 or 0
    std::vector<uint32_t> xEdge, yEdge;  ///< vertex on the edge that starts at a corner; only set where one is

    explicit Plane(size_t corners) : values(corners), inside(corners), xEdge(corners), yEdge(corners) {}
};

/// A slab of layers on its way to triangles.
class Slab {
public:
    Slab(const Sampler& sampler, const mesh::Grid& grid, int worker)
        : sampler_(sampler),
          grid_(grid),
          worker_(worker),
          n_(grid.cells + Vec3i{1, 1, 1}),
          lower_(corners()),
          upper_(corners()),
          zEdge_(corners()),
          row_(static_cast<size_t>(n_.x) + 8) {}

    /// Layers [first, last) of cells.
    void run(int first, int last) {
        evaluate(first);
        for (int k = first; k < last; ++k) {
            std::swap(lower_, upper_);
            evaluate(k + 1);
            const Stopwatch joining;
            if (k == first) addPlaneVertices(lower_, k);
            addPlaneVertices(upper_, k + 1);
            addUprightVertices(k);
            for (int j = 0; j < grid_.cells.y; ++j) joinRow(j);
            polygonizeSeconds += joining.seconds();
        }
    }

    double evaluateSeconds = 0, polygonizeSeconds = 0;
    std::vector<Vec3f> positions;
    std::vector<mesh::Triangle> triangles;

private:
    size_t corners() const { return static_cast<size_t>(n_.x) * static_cast<size_t>(n_.y); }
    size_t at(int i, int j) const {
        return static_cast<size_t>(j) * static_cast<size_t>(n_.x) + static_cast<size_t>(i);
    }

    /// Samples plane `k` into the upper one.
    void evaluate(int k) {
        const Stopwatch sampling;
        const int rows = std::max(1, pointsAtOnce / n_.x);
        const size_t room = at(0, rows);
        x_.resize(room), y_.resize(room), z_.assign(room, grid_.corner(0, 0, k).z);
        for (int j = 0; j < rows; ++j)
            for (int i = 0; i < n_.x; ++i) x_[at(i, j)] = grid_.corner(i, 0, 0).x;
        for (int j0 = 0; j0 < n_.y; j0 += rows) {
            const int count = std::min(rows, n_.y - j0);
            for (int j = 0; j < count; ++j) std::fill_n(y_.data() + at(0, j), n_.x, grid_.corner(0, j0 + j, 0).y);
            sampler_({x_.data(), y_.data(), z_.data(), at(0, count)}, upper_.values.data() + at(0, j0), worker_);
        }
        for (size_t c = 0; c < upper_.values.size(); ++c) upper_.inside[c] = upper_.values[c] < 0 ? 1 : 0;
        evaluateSeconds += sampling.seconds();
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
            const float* v = plane.values.data() + at(0, j);
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

    const Sampler& sampler_;
    const mesh::Grid& grid_;
    int worker_;
    Vec3i n_;  ///< corners
    Plane lower_, upper_;
    std::vector<uint32_t> zEdge_;
    std::vector<uint8_t> row_;
    std::vector<float> x_, y_, z_;
};

}  // namespace

DenseResult sweepDense(const Sampler& sampler, const mesh::Grid& grid, int threads, int maxSlabs) {
    DenseResult result;
    result.slabs = (grid.cells.z + slabLayers - 1) / slabLayers;
    result.slabsMeasured = maxSlabs > 0 ? std::min(maxSlabs, result.slabs) : result.slabs;
    const int workers = threadCount(threads);
    std::vector<DenseResult> parts(static_cast<size_t>(result.slabsMeasured));
    std::vector<std::vector<Vec3f>> positions(parts.size());
    std::vector<std::vector<mesh::Triangle>> triangles(parts.size());

    const Stopwatch whole;
    parallelFor(parts.size(), threads, nullptr, [&](size_t s, int worker) {
        const int slab = static_cast<int>((2 * s + 1) * static_cast<size_t>(result.slabs) / (2 * parts.size()));
        Slab work(sampler, grid, worker);
        work.run(slab * slabLayers, std::min((slab + 1) * slabLayers, grid.cells.z));
        parts[s].evaluateSeconds = work.evaluateSeconds;
        parts[s].polygonizeSeconds = work.polygonizeSeconds;
        positions[s] = std::move(work.positions);
        triangles[s] = std::move(work.triangles);
    });
    const double scale = static_cast<double>(result.slabs) / result.slabsMeasured;
    result.seconds = whole.seconds() * scale;
    uint64_t count = 0;
    for (size_t s = 0; s < parts.size(); ++s) {
        result.evaluateSeconds += parts[s].evaluateSeconds * scale / workers;
        result.polygonizeSeconds += parts[s].polygonizeSeconds * scale / workers;
        count += triangles[s].size();
    }
    result.triangles = static_cast<uint64_t>(static_cast<double>(count) * scale);
    return result;
}

}  // namespace sgm::bench
