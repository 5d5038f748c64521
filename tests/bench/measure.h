// One scene at one resolution: ours, the dense sweeps and the peers, in turns.
// Enters: a scene. Leaves: a Measurement. Assumes a calm machine; the best of a few rounds counts, for noise only adds,
// and all take part in every round, so that a busy stretch of time slows them alike.
#pragma once

#include "modeler/mesh/mesh.h"
#include "tests/bench/dense.h"
#include "tests/bench/peers.h"
#include "tests/bench/scenes.h"
#include "tests/bench/vtk.h"

namespace sgm::bench {

struct MeasureOptions {
    Running running;
    int repeats = 3;  ///< rounds; who has used up `patience_s` sits the rest out
    bool dense = true, peers = true;
    bool oneThread = false;  ///< ours on one thread too
};

struct Measurement {
    std::string scene;
    int resolution = 0;
    Vec3i cells;            ///< a cube for all but `tight`
    size_t tapeLength = 0;  ///< instructions
    double deriveSeconds = 0, lowerSeconds = 0, compileSeconds = 0;
    double totalSeconds = 0;      ///< tape to mesh: refined positions, normals, triangles, origins
    double oneThreadSeconds = 0;  ///< the same on one thread; 0 where not asked for
    mesh::Counts counts;          ///< stages of the best run
    double fieldSeconds = 0;      ///< of its sampleSeconds, by the share measured apart: evaluating the field
    double leastFieldSeconds =
        0;  ///< of the field's operations alone, from register to register, shared by the threads
    uint64_t vertices = 0, triangles = 0;
    uint64_t peakBytes = 0;    ///< of the first run, above the start
    DenseResult dense;         ///< every sample of the cube in memory, then marching cubes
    DenseResult fused;         ///< the cube, plane by plane
    DenseResult tight;         ///< the bounds alone, plane by plane: the least that a sweep can do
    bool handWritten = false;  ///< the sweeps ran the hand-written reference, not the tape
    OpenVdbResult openvdb;
    VtkResult vtk;

    double ratio() const { return dense.seconds / totalSeconds; }
    double nsPerTriangle() const { return 1e9 * totalSeconds / static_cast<double>(std::max<uint64_t>(1, triangles)); }
    double evaluationsPerCell() const {
        return static_cast<double>(counts.pointEvaluations) /
               static_cast<double>(std::max<uint64_t>(1, counts.surfaceCells));
    }
    double bytesPerTriangle() const {
        return static_cast<double>(peakBytes) / static_cast<double>(std::max<uint64_t>(1, triangles));
    }
    /// Evaluating the field over the least time of its operations.
    double fieldOverLeast() const { return leastFieldSeconds > 0 ? fieldSeconds / leastFieldSeconds : 0; }
    /// All that makes a mesh of the field's values: cells, edges, steps to the surface, vertices, seams, triangles.
    double meshSeconds() const { return counts.sampleSeconds - fieldSeconds + counts.polygonizeSeconds; }
    /// What it stores: a triangle's corners and its origin, a vertex's place and its normal.
    uint64_t meshBytes() const {
        return triangles * (sizeof(mesh::Triangle) + sizeof(OriginId)) + vertices * 2 * sizeof(Vec3f);
    }
    double openvdbSeconds() const { return openvdb.sampleSeconds + openvdb.meshSeconds; }
    /// volumeToMesh after the sweeps' own loop over the blocks that aren't skipped, at its rate over the cube.
    double openvdbByHandSeconds() const {
        const double corners = static_cast<double>(cells.x + 1) * (cells.y + 1) * (cells.z + 1);
        const double sampled =
            static_cast<double>(openvdb.blocks) * mesh::blockCells * mesh::blockCells * mesh::blockCells;
        return dense.evaluateSeconds > 0 ? dense.evaluateSeconds * sampled / corners + openvdb.meshSeconds : 0;
    }
};

/// Errors as of subdivide and polygonize.
Result<Measurement> measure(const Scene& scene, int resolution, const MeasureOptions& options);

}  // namespace sgm::bench
