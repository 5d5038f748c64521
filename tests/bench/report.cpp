#include "tests/bench/report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace sgm::bench {
namespace {

using nlohmann::ordered_json;

/// How many times longer polygonize took than its output needs at the measured bandwidth to fresh pages.
double polygonizeOverWrite(const Measurement& m, const Limits& limits) {
    const double floor = static_cast<double>(m.polygonizedBytes()) / (1e9 * limits.freshWriteGBs);
    return floor > 0 ? m.counts.polygonizeSeconds / floor : 0;
}

/// What was swept; with a ~ where it was scaled up from a part.
std::string denseLabel(const Measurement& m) {
    return std::string(m.handWritten ? "hand" : "tape") + (m.dense.slabsMeasured < m.dense.slabs ? "~" : "");
}

ordered_json stagesOf(const Measurement& m) {
    return {{"derive_seconds", m.deriveSeconds},        {"lower_seconds", m.lowerSeconds},
            {"compile_seconds", m.compileSeconds},      {"subdivide_seconds", m.counts.subdivideSeconds},
            {"sample_seconds", m.counts.sampleSeconds}, {"polygonize_seconds", m.counts.polygonizeSeconds}};
}

ordered_json denseOf(const DenseResult& d, bool handWritten) {
    return {{"evaluate_seconds", d.evaluateSeconds},
            {"polygonize_seconds", d.polygonizeSeconds},
            {"triangles", d.triangles},
            {"slabs", d.slabs},
            {"slabs_measured", d.slabsMeasured},
            {"evaluator", handWritten ? "hand-written" : "tape"}};
}

ordered_json sceneOf(const Measurement& m, const Limits& limits) {
    ordered_json scene = {{"scene", m.scene},
                          {"resolution", m.resolution},
                          {"tape_length", m.tapeLength},
                          {"total_seconds", m.totalSeconds},
                          {"dense_seconds", m.dense.seconds},
                          {"dense_over_total", m.ratio()},
                          {"stages", stagesOf(m)},
                          {"vertices", m.vertices},
                          {"triangles", m.triangles},
                          {"ns_per_triangle", m.nsPerTriangle()},
                          {"surface_cells", m.counts.surfaceCells},
                          {"point_evaluations_per_surface_cell", m.evaluationsPerCell()},
                          {"interval_evaluations", m.counts.intervalEvaluations},
                          {"refinement_evaluations", m.counts.refinementEvaluations},
                          {"peak_bytes", m.peakBytes},
                          {"polygonize_over_write", polygonizeOverWrite(m, limits)},
                          {"dense", denseOf(m.dense, m.handWritten)},
                          {"peers", ordered_json::object()}};
    if (m.openvdb.triangles > 0)
        scene["peers"]["openvdb"] = {{"sample_seconds", m.openvdb.sampleSeconds},
                                     {"mesh_seconds", m.openvdb.meshSeconds},
                                     {"triangles", m.openvdb.triangles}};
    return scene;
}

}  // namespace

std::string limitsLine(const Limits& limits, int threads) {
    return fmt::format(
        "{} threads, {}: {:.0f} Gflop/s fused, write {:.1f} GB/s, fresh pages {:.1f} GB/s, copy {:.1f} GB/s", threads,
        instructionSet(), limits.fusedGflops, limits.writeGBs, limits.freshWriteGBs, limits.copyGBs);
}

std::string tableHeader() {
    return fmt::format(
        "{:12} {:>5} {:>6} | {:>8} {:>8} {:>8} {:>8} | {:>8} {:5} {:>7} | {:>8} {:>8} {:>7} | {:>9} {:>6} {:>6} {:>6} "
        "{:>5}",
        "scene", "res", "tape", "total", "descend", "sample", "join", "dense", "of", "ratio", "vdb smp", "vdb mesh",
        "ratio", "triangles", "ns/tri", "ev/cel", "B/tri", "j/wr");
}

std::string tableRow(const Measurement& m, const Limits& limits) {
    return fmt::format(
        "{:12} {:>5} {:>6} | {:>8.4f} {:>8.4f} {:>8.4f} {:>8.4f} | {:>8.3f} {:5} {:>6.1f}x | {:>8.4f} {:>8.4f} "
        "{:>6.1f}x | "
        "{:>9} {:>6.1f} {:>6.2f} {:>6.0f} {:>5.1f}",
        m.scene, m.resolution, m.tapeLength, m.totalSeconds, m.counts.subdivideSeconds, m.counts.sampleSeconds,
        m.counts.polygonizeSeconds, m.dense.seconds, denseLabel(m), m.ratio(), m.openvdb.sampleSeconds,
        m.openvdb.meshSeconds, (m.openvdb.sampleSeconds + m.openvdb.meshSeconds) / m.totalSeconds, m.triangles,
        m.nsPerTriangle(), m.evaluationsPerCell(),
        static_cast<double>(m.peakBytes) / static_cast<double>(std::max<uint64_t>(1, m.triangles)),
        polygonizeOverWrite(m, limits));
}

std::string toJson(const std::vector<Measurement>& measurements, const Limits& limits, int threads) {
    ordered_json scenes = ordered_json::array();
    for (const Measurement& m : measurements) scenes.push_back(sceneOf(m, limits));
    const ordered_json all = {{"threads", threads},
                              {"limits",
                               {{"instruction_set", instructionSet()},
                                {"fused_gflops", limits.fusedGflops},
                                {"write_gb_per_second", limits.writeGBs},
                                {"fresh_write_gb_per_second", limits.freshWriteGBs},
                                {"copy_gb_per_second", limits.copyGBs}}},
                              {"scenes", scenes}};
    return all.dump(2) + "\n";
}

}  // namespace sgm::bench
