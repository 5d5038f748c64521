#include "cli/report.h"

#include <sys/resource.h>

#include <nlohmann/json.hpp>

#include "cli/cave.h"
#include "modeler/core/parallel.h"

namespace sgm::cli {
namespace {

using Json = nlohmann::ordered_json;

Json fieldFigures(const Model& model, const MeshedModel& meshed) {
    const Vec3<uint64_t> corners = (meshed.grid.cells + Vec3i{1, 1, 1}).as<uint64_t>();
    return {{"nodes", model.lowered->graph.nodeCount()},
            {"tape_ops", model.tape.size()},
            {"point_evaluations", meshed.counts.pointEvaluations},
            {"refinement_evaluations", meshed.counts.refinementEvaluations},
            {"interval_evaluations", meshed.counts.intervalEvaluations},
            {"dense_points", corners.x * corners.y * corners.z},
            {"surface_cells", meshed.counts.surfaceCells}};
}

Json boundsJson(const Box3f& b) { return {{b.lo.x, b.lo.y, b.lo.z}, {b.hi.x, b.hi.y, b.hi.z}}; }

Json meshFigures(const mesh::MeshFigures& f) {
    Json figures{
        {"vertices", f.vertices}, {"triangles", f.triangles},          {"components", f.components},
        {"cavities", f.cavities}, {"boundary_edges", f.boundaryEdges}, {"nonmanifold_edges", f.nonmanifoldEdges},
        {"euler", f.euler},       {"volume_m3", f.volume_m3},          {"area_m2", f.area_m2}};
    if (!f.bounds.empty()) figures["bounds"] = boundsJson(f.bounds);
    return figures;
}

/// The objects that `place` puts, which the mesh's figures are without.
Json placedFigures(const mesh::Scene& scene) {
    return {
        {"objects", scene.objects.size()}, {"places", scene.instances.size()}, {"triangles", scene.triangleCount()}};
}

/// Why a solid floats; empty where that isn't known.
Json causeOf(const Model& model, const FloatCause& cause) {
    if (cause.kind == FloatCause::Kind::Unknown) return {};
    const auto partOf = [&](OriginId origin) {
        const Part& part = model.lowered->provenance.parts[origin];
        return Json{{"path", part.path.text()}, {"file", part.file()}, {"line", part.line()}};
    };
    if (cause.kind == FloatCause::Kind::Thin || cause.kind == FloatCause::Kind::Fragment)
        return {
            {"kind", "thin"}, {"thickness_m", cause.width_m}, {"cell_m", cause.cell_m}, {"part", partOf(cause.theirs)}};
    return {{"kind", cause.kind == FloatCause::Kind::Gap ? "gap" : "touch"},
            {"width_m", cause.width_m},
            {"at", {cause.at.x, cause.at.y, cause.at.z}},
            {"from", partOf(cause.ours)},
            {"to", partOf(cause.theirs)}};
}

/// The solids that float, why, and the shapes that made them.
Json floatingFigures(const Model& model, const Support& support) {
    const derive::Derivation& d = model.derivation;
    Json list = Json::array();
    for (const Floating& f : support.floating) {
        const derive::Shape& s = d.tree.shapes[f.shape];
        Json entry = {{"path", d.tree.path(f.shape)},
                      {"rule", s.madeBy == derive::none ? "" : d.grammar->rules[d.steps[s.madeBy].rule].name},
                      {"file", s.span.source ? s.span.source->name() : ""},
                      {"line", s.span.source ? s.span.source->place(s.span.begin).line : 0}};
        entry["triangles"] = f.piece.triangles;
        entry["volume_m3"] = f.piece.volume_m3;
        entry["bounds"] = boundsJson(f.piece.bounds);
        if (Json cause = causeOf(model, f.cause); !cause.empty()) entry["cause"] = std::move(cause);
        list.push_back(std::move(entry));
    }
    return list;
}

/// The parts that are too thin for the cells, the walls at faces of cuts, the gaps at faces of parts, the eaves
/// and the rims which the mesh lacks.
Json missingFigures(const Model& model, const std::vector<lower::ThinPart>& missing) {
    constexpr std::array kinds{"part", "wall", "gap", "eaves", "rim"};
    Json list = Json::array();
    for (const lower::ThinPart& m : missing) {
        const Part& part = model.lowered->provenance.parts[m.part];
        list.push_back({{"path", part.path.text()},
                        {"file", part.file()},
                        {"line", part.line()},
                        {"kind", kinds[static_cast<size_t>(m.kind)]},
                        {"thickness_m", m.thickness_m},
                        {"cell_m", m.cell_m},
                        {"missing", m.missing}});
    }
    return list;
}

uint64_t peakMemory_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<uint64_t>(usage.ru_maxrss) * 1024;
}

}  // namespace

std::string reportJson(const Model& model, const MeshedModel& meshed, const mesh::MeshFigures& figures,
                       const pipeline::MadeScene& made, const Support& support,
                       const std::vector<lower::ThinPart>& missing, const std::optional<volume::Cave>& cave,
                       const Stages& stages, int threads) {
    const derive::Derivation& d = model.derivation;
    Json json;
    for (const auto& [name, seconds] : stages) json["stages"][name] = seconds;
    json["shapes"] = d.tree.shapes.size();
    json["terminals"] = d.terminals();
    json["bonds"] = d.tree.bonds().all.size();
    json["rules_applied"] = {{"classic", d.classic}, {"morphic", d.morphic}};
    json["field"] = fieldFigures(model, meshed);
    json["mesh"] = meshFigures(figures);
    if (!made.scene.empty()) json["placed"] = placedFigures(made.scene);
    json["pieces"] = support.pieces;
    json["floating"] = floatingFigures(model, support);
    json["missing"] = missingFigures(model, missing);
    for (uint32_t i = 0; i < d.grammar->reports.size(); ++i) {
        derive::Reported r = d.reported(i);
        if (!made.reports.empty()) r.add(made.reports[i]);
        json["reports"][d.grammar->reports[i].name] = {
            {"count", r.count}, {"sum", r.sum}, {"least", r.least}, {"greatest", r.greatest}};
    }
    if (cave) json["cave"] = caveJson(*cave);
    json["peak_memory_bytes"] = peakMemory_bytes();
    json["threads"] = threadCount(threads);
    json["seed"] = d.seed;
    return json.dump(2) + "\n";
}

}  // namespace sgm::cli
