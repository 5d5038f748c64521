#include "tests/bench/meshes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "cli/requests.h"
#include "grammar/lower/solid_tree.h"
#include "grammar/pipeline/mesh_edits.h"
#include "grammar/pipeline/products.h"
#include "modeler/eval/evaluate.h"
#include "modeler/export/exporter.h"

namespace sgm::bench {
namespace {

namespace fs = std::filesystem;

constexpr const char* folder = "build/exact";
constexpr int countSides = 128;  ///< for counts of triangles

struct MeshScene {
    std::string_view name, file;
    std::string_view setting;  ///< that makes it a solid tree
};
constexpr MeshScene table[] = {
    {"tower", "examples/tower.sgm", "peak=0"},
    {"palace", "examples/buildings/palace.sgm", "peak=0"},
    {"apartment", "examples/buildings/apartment.sgm", ""},
    {"cloister", "examples/buildings/cloister.sgm", ""},
    {"hall", "examples/buildings/hall.sgm", "peak=0"},
    {"terrace", "examples/buildings/terrace.sgm", ""},
};

MeshScene sceneOf(const std::string& name) {
    for (const MeshScene& s : table)
        if (s.name == name) return s;
    return {name, name, ""};
}

/// A model with its exact counterpart.
struct Prepared {
    std::string name;
    cli::ModelRequest request;
    cli::Model model;
    uint64_t exactTriangles = 0;
    double ownersDiffer = 0, border_m = 0;
    std::optional<exact::ExactModel> exact;
};

Status writeTree(const Prepared& p, const fs::path& path) {
    const auto tree = lower::solidTree(p.model.derivation, *p.model.lowered, nullptr);
    if (!tree.ok()) return tree.error();
    exporter::ExportInput input = pipeline::exportInput(p.model, p.request.file);
    input.solids = &*tree;
    return exporter::write(input, path);
}

/// The share of the exact surface, by area, that the field gives to a part of another look, at the middles of the
/// triangles of the model with owners: more than a little would tell that borders are not what they should be.
double ownersDiffer(const exact::ExactModel& clean, const exact::ExactModel& first, const cli::Model& field) {
    const Provenance& provenance = field.lowered->provenance;
    const std::vector<uint32_t> looks = exact::looksOf(provenance);
    const exact::TriangleTree surface(clean.points, clean.triangles);
    eval::Workspace workspace;
    double area = 0, differs = 0;
    for (size_t i = 0; i < first.triangles.size(); ++i) {
        const exact::Corners& t = first.triangles[i];
        const Vec3d a = first.points[t.x], b = first.points[t.y], c = first.points[t.z], middle = (a + b + c) / 3.0;
        if (surface.distance(middle) > 1e-5) continue;  // a film
        const Vec3f p = middle.as<float>();
        OriginId owner = 0;
        eval::evaluateOrigin(field.tape, {&p.x, &p.y, &p.z, 1}, &owner, workspace);
        const double here = length(cross(b - a, c - a)) / 2;
        area += here;
        if (looks[provenance.parts[owner].material] != looks[provenance.parts[first.origins[i]].material])
            differs += here;
    }
    return area > 0 ? differs / area : 0;
}

Result<Prepared> prepare(const MeshScene& scene, const MeshesOptions& options, bool judged) {
    Prepared p;
    p.name = scene.name;
    p.request.file = scene.file;
    if (!scene.setting.empty()) p.request.settings.emplace_back(scene.setting);
    cli::Context context;
    auto model = cli::makeModel(p.request, context);
    if (!model.ok()) return model.error();
    p.model = std::move(*model);
    if (!judged) return p;
    std::error_code ignored;
    fs::create_directories(folder, ignored);
    const fs::path tree = fs::path(folder) / (fs::path(p.name).stem().string() + ".csg.json");
    if (const Status s = writeTree(p, tree); !s.ok()) return s.error();
    const auto counted = exact::exactModel(tree, countSides, exact::Owners::Either, folder);
    if (!counted.ok()) return counted.error();
    const auto first = exact::exactModel(tree, countSides, exact::Owners::First, folder);
    if (!first.ok()) return first.error();
    auto exact = exact::exactModel(tree, options.sides, exact::Owners::Either, folder);
    if (!exact.ok()) return exact.error();
    p.exactTriangles = counted->triangles.size();
    p.border_m = exact::lengthOf(exact::findBorders(*counted, *first, p.model.lowered->provenance));
    p.ownersDiffer = ownersDiffer(*counted, *first, p.model);
    // What an inscribed prism lacks shrinks with the square of its sides.
    const double ratio = static_cast<double>(options.sides) / countSides;
    exact->volume_m3 += (exact->volume_m3 - counted->volume_m3) / (ratio * ratio - 1);
    p.exact = std::move(*exact);
    return p;
}

uint64_t glbBytes(const Prepared& p, const mesh::Mesh& mesh) {
    exporter::ExportInput input = pipeline::exportInput(p.model, p.request.file);
    input.mesh = &mesh;
    const fs::path file = fs::path(folder) / "measured.glb";
    std::error_code error;
    fs::create_directories(folder, error);
    if (!exporter::write(input, file).ok()) return 0;
    const uint64_t bytes = fs::file_size(file, error);
    fs::remove(file, error);
    return bytes;
}

Result<MeshRow> measureRow(const Prepared& p, int resolution, const MeshesOptions& options) {
    MeshRow row{p.name, resolution, 0, p.exactTriangles, 0, 0, 0, 0, p.ownersDiffer, p.border_m, std::nullopt};
    std::optional<cli::MeshedModel> made;
    const auto least = [&](double& sum, double seconds, int i) { sum = i == 0 ? seconds : std::min(sum, seconds); };
    struct Way {
        mesh::Surface surface;
        int halvings;
        double& seconds;
    };
    for (const Way& way : {Way{mesh::Surface::Cubes, 0, row.cubesSeconds},
                           Way{mesh::Surface::Crisp, 0, row.crispSeconds}, Way{mesh::Surface::Crisp, 3, row.seconds}})
        for (int i = 0; i < std::max(1, options.repeats); ++i) {
            const cli::GridRequest grid{.resolution = resolution,
                                        .surface = way.surface,
                                        .halvings = way.halvings,
                                        .threads = options.running.threads};
            cli::Context context{nullptr, grid.threads};
            const Stopwatch watch(options.running);
            auto meshed = cli::makeMesh(p.model, grid, context);
            if (!meshed.ok()) return meshed.error();
            if (way.halvings > 0) {  // as `sgm build` does
                auto simple = pipeline::edited(std::move(meshed->mesh), {},
                                               {p.model.tape, way.surface, meshed->grid.cell_m}, context);
                if (!simple.ok()) return simple.error();
                meshed->mesh = std::move(*simple);
            }
            least(way.seconds, watch.seconds(), i);
            made = std::move(*meshed);
        }
    row.triangles = made->mesh.triangleCount();
    row.glbBytes = glbBytes(p, made->mesh);
    if (p.exact)
        row.quality = exact::measureQuality(made->mesh, p.model.lowered->provenance, *p.exact,
                                            static_cast<double>(made->grid.cell_m), options.crossings);
    return row;
}

nlohmann::ordered_json jsonOf(const exact::Spread& s) {
    return {{"mean_cells", s.mean}, {"p99_cells", s.p99}, {"most_cells", s.most}, {"count", s.count}};
}

nlohmann::ordered_json jsonOf(const MeshRow& row) {
    nlohmann::ordered_json json{
        {"scene", row.scene},       {"resolution", row.resolution},      {"triangles", row.triangles},
        {"seconds", row.seconds},   {"crisp_seconds", row.crispSeconds}, {"marching_cubes_seconds", row.cubesSeconds},
        {"glb_bytes", row.glbBytes}};
    if (!row.quality) return json;
    const exact::Quality& q = *row.quality;
    json["exact_triangles"] = row.exactTriangles;
    json["cell_m"] = q.cell_m;
    json["thick_share"] = q.thickShare;
    json["owners_differ"] = row.ownersDiffer;
    json["crease"] = jsonOf(q.crease);
    json["every_crease"] = jsonOf(q.everyCrease);
    json["every_corner"] = jsonOf(q.everyCorner);
    json["stray"] = jsonOf(q.stray);
    json["corner"] = jsonOf(q.corner);
    json["border_m"] = q.border_m;
    json["exact_border_m"] = row.exactBorder_m;
    json["border_ratio"] = row.borderRatio();
    json["volume_error"] = q.volumeError;
    json["boundary_edges"] = q.boundaryEdges;
    json["nonmanifold_edges"] = q.nonmanifoldEdges;
    if (q.crossings) json["crossing_pairs"] = *q.crossings;
    return json;
}

}  // namespace

std::string meshesHeader() {
    return "| model | cells | triangles | of exact | crease, cells: mean | p99 | stray | p99 | corner | borders | "
           "volume "
           "| open, non-manifold edges | crossing pairs | seconds | crisp, whole of cubes | .glb MB |\n"
           "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|";
}

std::string meshesRow(const MeshRow& row) {
    const double mb = static_cast<double>(row.glbBytes) / 1e6, ofCubes = row.seconds / row.cubesSeconds;
    const double crispOfCubes = row.crispSeconds / row.cubesSeconds;
    if (!row.quality)
        return fmt::format(
            "| {} | {} | {} | – | – | – | – | – | – | – | – | – | – | {:.3f} | {:.2f}, {:.2f} | {:.2f} |", row.scene,
            row.resolution, row.triangles, row.seconds, crispOfCubes, ofCubes, mb);
    const exact::Quality& q = *row.quality;
    return fmt::format(
        "| {} | {} | {} | {:.2f} | {:.4f} | {:.3f} | {:.4f} | {:.3f} | {:.4f} | {:.4f} | {:+.5f} % | {}, {} | {} | "
        "{:.3f} | "
        "{:.2f}, {:.2f} | {:.2f} |",
        row.scene, row.resolution, row.triangles,
        static_cast<double>(row.triangles) / static_cast<double>(row.exactTriangles), q.crease.mean, q.crease.p99,
        q.stray.mean, q.stray.p99, q.corner.mean, row.borderRatio(), 100 * q.volumeError, q.boundaryEdges,
        q.nonmanifoldEdges, q.crossings ? fmt::format("{}", *q.crossings) : "–", row.seconds, crispOfCubes, ofCubes,
        mb);
}

std::string meshesJson(const std::vector<MeshRow>& rows, const MeshesOptions& options) {
    nlohmann::ordered_json json{{"threads", options.running.threads}, {"sides", options.sides}};
    json["meshes"] = nlohmann::ordered_json::array();
    for (const MeshRow& row : rows) json["meshes"].push_back(jsonOf(row));
    return json.dump(2) + "\n";
}

Result<std::vector<MeshRow>> measureMeshes(const MeshesOptions& options) {
    std::vector<std::string> scenes = options.scenes;
    if (scenes.empty())
        for (const MeshScene& s : table) scenes.emplace_back(s.name);
    const std::vector<int> resolutions = options.resolutions.empty() ? std::vector{128, 256, 512} : options.resolutions;
    const std::string missing = exact::missingJudge();
    if (!missing.empty()) fmt::print("No exact models, so nothing but triangles, times and sizes: {}\n\n", missing);
    fmt::print("{}\n", meshesHeader());
    std::vector<MeshRow> rows;
    for (const std::string& name : scenes) {
        const auto prepared = prepare(sceneOf(name), options, missing.empty());
        if (!prepared.ok()) return Error{prepared.error().kind, fmt::format("{}: {}", name, prepared.error().message)};
        for (const int resolution : resolutions) {
            const auto row = measureRow(*prepared, resolution, options);
            if (!row.ok()) return Error{row.error().kind, fmt::format("{}: {}", name, row.error().message)};
            fmt::print("{}\n", meshesRow(*row));
            std::fflush(stdout);
            rows.push_back(*row);
        }
    }
    return rows;
}

}  // namespace sgm::bench
