#include "tests/bench/report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace sgm::bench {
namespace {

using nlohmann::ordered_json;

ordered_json stagesOf(const Measurement& m) {
    return {{"derive_seconds", m.deriveSeconds},   {"lower_seconds", m.lowerSeconds},
            {"compile_seconds", m.compileSeconds}, {"subdivide_seconds", m.counts.subdivideSeconds},
            {"sample_seconds", m.fieldSeconds},    {"polygonize_seconds", m.meshSeconds()}};
}

ordered_json sweepOf(const DenseResult& d) {
    return {{"seconds", d.seconds},
            {"evaluate_seconds", d.evaluateSeconds},
            {"polygonize_seconds", d.polygonizeSeconds},
            {"triangles", d.triangles},
            {"scaled_up", d.scaled}};
}

ordered_json peersOf(const Measurement& m) {
    ordered_json peers = ordered_json::object();
    if (m.openvdb.triangles > 0)
        peers["openvdb"] = {{"sample_seconds", m.openvdb.sampleSeconds},
                            {"mesh_seconds", m.openvdb.meshSeconds},
                            {"by_hand_seconds", m.openvdbByHandSeconds()},
                            {"triangles", m.openvdb.triangles}};
    if (m.vtk.seconds > 0)
        peers["vtk_flying_edges"] = {{"mesh_seconds", m.vtk.seconds}, {"triangles", m.vtk.triangles}};
    return peers;
}

ordered_json sceneOf(const Measurement& m, const Limits& limits) {
    ordered_json scene = {{"scene", m.scene},
                          {"resolution", m.resolution},
                          {"cells", {m.cells.x, m.cells.y, m.cells.z}},
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
                          {"least_sample_seconds", m.leastFieldSeconds},
                          {"sample_over_least", m.fieldOverLeast()},
                          {"polygonize_over_write", polygonizeOverWrite(m, limits)},
                          {"swept_by", m.handWritten ? "hand-written loops" : "tape"},
                          {"dense", sweepOf(m.dense)},
                          {"fused", sweepOf(m.fused)},
                          {"fused_over_bounds_alone", sweepOf(m.tight)},
                          {"peers", peersOf(m)}};
    if (m.oneThreadSeconds > 0) scene["one_thread_seconds"] = m.oneThreadSeconds;
    return scene;
}

}  // namespace

double polygonizeOverWrite(const Measurement& m, const Limits& limits) {
    const double floor = static_cast<double>(m.meshBytes()) / (1e9 * limits.freshWriteGBs);
    return floor > 0 ? m.meshSeconds() / floor : 0;
}

std::string limitsLine(const Limits& limits, int threads) {
    return fmt::format(
        "{} threads, {}: {:.0f} Gflop/s fused, write {:.1f} GB/s, fresh pages {:.1f} GB/s, copy {:.1f} GB/s", threads,
        instructionSet(), limits.fusedGflops, limits.writeGBs, limits.freshWriteGBs, limits.copyGBs);
}

std::string tableHeader() {
    return fmt::format(
        "{:12} {:>4} {:>6} | {:>7} {:>7} {:>7} {:>7} {:>5} {:>5} | {:5} {:>7} {:>7} | {:>7} {:>7} | {:>7} {:>7} | "
        "{:>7} {:>7} {:>7} {:>7} | "
        "{:>7} | {:>8} {:>6} {:>6} {:>5}",
        "scene", "res", "tape", "total", "descend", "sample", "join", "s/op", "j/wr", "by", "dense", "ratio", "fused",
        "ratio", "tight", "ratio", "vdb smp", "vdb msh", "ratio", "by hand", "vtk", "triangle", "ns/tri", "ev/cel",
        "B/tri");
}

std::string tableRow(const Measurement& m, const Limits& limits) {
    const auto seconds = [](double s) { return s > 0 ? fmt::format("{:.4f}", s) : std::string("–"); };
    const auto ratio = [&](double s) { return s > 0 ? fmt::format("{:.1f}x", s / m.totalSeconds) : std::string("–"); };
    const auto sweep = [&](const DenseResult& d) {
        return (d.scaled ? "~" : "") + (d.seconds > 0 ? fmt::format("{:.3f}", d.seconds) : std::string("–"));
    };
    return fmt::format(
        "{:12} {:>4} {:>6} | {:>7.4f} {:>7.4f} {:>7.4f} {:>7.4f} {:>5.1f} {:>5.1f} | {:5} {:>7} {:>7} | {:>7} {:>7} | "
        "{:>7} {:>7} | "
        "{:>7} {:>7} {:>7} {:>7} | {:>7} | {:>8} {:>6.1f} {:>6.2f} {:>5.0f}",
        m.scene, m.resolution, m.tapeLength, m.totalSeconds, m.counts.subdivideSeconds, m.fieldSeconds, m.meshSeconds(),
        m.fieldOverLeast(), polygonizeOverWrite(m, limits), m.handWritten ? "hand" : "tape", sweep(m.dense),
        ratio(m.dense.seconds), sweep(m.fused), ratio(m.fused.seconds), sweep(m.tight), ratio(m.tight.seconds),
        seconds(m.openvdb.sampleSeconds), seconds(m.openvdb.meshSeconds), ratio(m.openvdbSeconds()),
        ratio(m.openvdbByHandSeconds()), seconds(m.vtk.seconds), m.triangles, m.nsPerTriangle(), m.evaluationsPerCell(),
        m.bytesPerTriangle());
}

std::string dragLine(const DragResult& d) {
    const auto stages = [](const BuildSeconds& s) {
        return fmt::format("{:.4f} s (derive {:.4f}, lower {:.4f}, compile {:.4f}, mesh {:.4f}, of it descent {:.4f})",
                           s.total(), s.derive, s.lower, s.compile, s.mesh, s.descend);
    };
    return fmt::format("  {} dragged: {}, {} of {} blocks; full {}: a share of {:.3f}", d.parameter, stages(d.drag),
                       d.blocksMade, d.blocksMade + d.blocksKept, stages(d.full), d.share());
}

std::string toJson(const Measured& measured, const Limits& limits, int threads) {
    ordered_json scenes = ordered_json::array(), drags = ordered_json::array(), bars = ordered_json::array();
    for (const Measurement& m : measured.scenes) scenes.push_back(sceneOf(m, limits));
    for (const DragResult& d : measured.drags)
        drags.push_back({{"scene", d.scene},
                         {"resolution", d.resolution},
                         {"parameter", d.parameter},
                         {"full_seconds", d.full.total()},
                         {"drag_seconds", d.drag.total()},
                         {"share", d.share()},
                         {"blocks_made", d.blocksMade},
                         {"blocks_kept", d.blocksKept}});
    for (const Bar& b : measured.bars)
        if (b.measured > 0)
            bars.push_back({{"what", b.what},
                            {b.atLeast ? "at_least" : "at_most", b.aim},
                            {"measured", b.measured},
                            {"reached", b.reached()},
                            {"remark", b.remark}});
    const ordered_json all = {{"threads", threads},
                              {"limits",
                               {{"instruction_set", instructionSet()},
                                {"fused_gflops", limits.fusedGflops},
                                {"write_gb_per_second", limits.writeGBs},
                                {"fresh_write_gb_per_second", limits.freshWriteGBs},
                                {"copy_gb_per_second", limits.copyGBs}}},
                              {"scenes", scenes},
                              {"drags", drags},
                              {"bars", bars}};
    return all.dump(2) + "\n";
}

}  // namespace sgm::bench
