// One scene at one resolution: ours, the dense sweep and the peers.
// Enters: a scene. Leaves: a Measurement. Assumes a calm machine; the best of a few runs counts, for noise only adds.
#pragma once

#include "modeler/mesh/mesh.h"
#include "tests/bench/dense.h"
#include "tests/bench/peers.h"
#include "tests/bench/scenes.h"

namespace sgm::bench {

struct MeasureOptions {
    int threads = 2;     ///< at least 1
    int repeats = 3;     ///< of ours, and of the dense sweep as long as it is quick
    int denseSlabs = 0;  ///< measure only so many slabs of the dense sweep and scale up; 0: all that take up to 15 s
    bool peers = true;
};

struct Measurement {
    std::string scene;
    int resolution = 0;
    size_t tapeLength = 0;  ///< instructions
    double deriveSeconds = 0, lowerSeconds = 0, compileSeconds = 0;
    double totalSeconds = 0;  ///< tape to mesh: refined positions, normals, triangles, origins
    mesh::Counts counts;      ///< stages of the best run
    uint64_t vertices = 0, triangles = 0;
    uint64_t peakBytes = 0;  ///< of the first run, above the start
    DenseResult dense;
    bool handWritten = false;  ///< the dense sweep ran the hand-written reference, not the tape
    OpenVdbResult openvdb;

    double ratio() const { return dense.seconds / totalSeconds; }
    double nsPerTriangle() const { return 1e9 * totalSeconds / static_cast<double>(std::max<uint64_t>(1, triangles)); }
    double evaluationsPerCell() const {
        return static_cast<double>(counts.pointEvaluations) /
               static_cast<double>(std::max<uint64_t>(1, counts.surfaceCells));
    }
    /// What polygonize stores: a triangle's corners and its origin.
    uint64_t polygonizedBytes() const { return triangles * (sizeof(mesh::Triangle) + sizeof(OriginId)); }
};

/// Errors as of subdivide and polygonize.
Result<Measurement> measure(const Scene& scene, int resolution, const MeasureOptions& options);

}  // namespace sgm::bench
