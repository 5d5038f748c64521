#include "cli/variations.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "grammar/derive/support.h"
#include "modeler/core/random.h"
#include "viewer/document/param_rows.h"

namespace sgm::cli {

std::vector<document::edits::NamedValue> variation(const rules::Grammar& grammar, const pipeline::ModelChoice& choice,
                                                   const std::set<std::string>& locked, double spread, uint64_t seed) {
    const auto options = pipeline::optionsFor(grammar, choice);
    if (!options.ok()) return {};
    document::Choice panel;
    panel.start = choice.start;
    panel.style = choice.style;
    panel.locked = locked;
    const std::vector<document::ParamRow> now = document::paramRows(grammar, *options, panel);
    std::vector<document::ParamRow> rows = document::rerolled(now, seed);
    std::vector<document::edits::NamedValue> values;
    for (size_t i = 0; i < rows.size(); ++i) {
        document::ParamRow& row = rows[i];
        if (row.locked) continue;
        if (row.lo.empty()) {  // a word or a switch
            if (uniform(combine(combine(seed, hashText(row.name)), 7), 0, 1) >= spread) row = now[i];
        } else {
            for (size_t k = 0; k < row.number.size(); ++k) {
                const double v = now[i].number[k] + spread * (row.number[k] - now[i].number[k]);
                row.number[k] = row.kind == document::ParamRow::Kind::Integer ? std::round(v) : v;
            }
        }
        const std::string text = document::valueText(row);
        if (text != document::valueText(now[i])) values.push_back({row.name, text});
    }
    return values;
}

bool canVary(const rules::Grammar& grammar, const pipeline::ModelChoice& choice, const std::set<std::string>& locked) {
    const auto options = pipeline::optionsFor(grammar, choice);
    if (!options.ok()) return true;  // told elsewhere
    document::Choice panel;
    panel.start = choice.start;
    panel.style = choice.style;
    panel.locked = locked;
    using Kind = document::ParamRow::Kind;
    return std::ranges::any_of(document::paramRows(grammar, *options, panel), [](const document::ParamRow& row) {
        return !row.locked && (row.kind == Kind::Truth || !row.choices.empty() || !row.lo.empty());
    });
}

namespace {

struct Plane {
    Vec3d normal;  ///< times the area
    double along = 0, area = 0;
    bool holds(Vec3d p, double slack) const { return std::abs(dot(normal, p) - along) < slack * area; }
};

/// The planes with most of the surface.
std::vector<Plane> largestPlanes(const mesh::Mesh& mesh, const std::vector<Vec3f>& at, float cell_m, size_t few) {
    std::map<std::array<int, 4>, Plane> planes;
    for (const mesh::Chunk& c : mesh.chunks)
        for (const mesh::Triangle& local : c.triangles) {
            const mesh::Triangle t = c.inMesh(local);
            const Vec3d p = at[t.x].as<double>(), n = cross(at[t.y].as<double>() - p, at[t.z].as<double>() - p);
            const double size = length(n);
            if (size <= 0) continue;
            const auto step = [](double v, double by) { return static_cast<int>(std::lround(v / by)); };
            Plane& plane = planes[{step(n.x / size, 0.1), step(n.y / size, 0.1), step(n.z / size, 0.1),
                                   step(dot(n, p) / size, cell_m)}];
            plane.normal += n, plane.along += dot(n, p), plane.area += size;
        }
    std::vector<Plane> sorted;
    for (const auto& entry : planes) sorted.push_back(entry.second);
    std::sort(sorted.begin(), sorted.end(), [](const Plane& a, const Plane& b) { return a.area > b.area; });
    sorted.resize(std::min(few, sorted.size()));
    return sorted;
}

/// Share of the surface whose corners lie on the two dozen largest planes. Where cells cut an edge off, the corners of
/// the cut do: so coarse meshes and fine ones are judged alike.
double shareOnFewPlanes(const mesh::Mesh& mesh, float cell_m) {
    std::vector<Vec3f> at;
    const Vec3f middle = mesh.bounds().centre();
    for (const mesh::Chunk& c : mesh.chunks)
        for (const Vec3f& p : c.positions) at.push_back(p - middle);
    const std::vector<Plane> planes = largestPlanes(mesh, at, cell_m, 24);
    std::vector<bool> plain;
    for (const Vec3f& p : at)
        plain.push_back(std::any_of(planes.begin(), planes.end(),
                                    [&](const Plane& q) { return q.holds(p.as<double>(), 0.1 * cell_m); }));
    double all = 0, plainArea = 0;
    for (const mesh::Chunk& c : mesh.chunks)
        for (const mesh::Triangle& local : c.triangles) {
            const mesh::Triangle t = c.inMesh(local);
            const double size = length(cross(at[t.y] - at[t.x], at[t.z] - at[t.x]));
            all += size;
            if (plain[t.x] && plain[t.y] && plain[t.z]) plainArea += size;
        }
    return all > 0 ? plainArea / all : 1;
}

}  // namespace

std::optional<std::string> degenerate(const mesh::Mesh& mesh, float cell_m) {
    const std::vector<mesh::ConnectedComponent> pieces = mesh::connectedComponents(mesh, cell_m);
    if (pieces.empty()) return "empty";
    double all = 0, greatest = 0, floating = 0;
    for (const mesh::ConnectedComponent& p : pieces) {
        all += p.volume_m3;
        greatest = std::max(greatest, p.volume_m3);
        if (p.floats) floating += p.volume_m3;
    }
    if (greatest < 0.5 * all && pieces.size() > 8) return "dust";
    if (floating > 0.05 * all) return "floating";
    if (shareOnFewPlanes(mesh, cell_m) > 0.97) return std::string(featureless);
    return std::nullopt;
}

bool mayFloat(const derive::Derivation& derivation) {
    constexpr double littleShare = 0.01;  // of the volume; boxes may be larger than what is in them
    const derive::ShapeTree& tree = derivation.tree;
    const std::vector<uint32_t> groupOf = derive::touchingGroups(tree);
    const std::vector<bool> floats = derive::floatingGroups(tree, groupOf);
    double all = 0, floating = 0;
    for (derive::ShapeId s = 0; s < groupOf.size(); ++s) {
        if (groupOf[s] == derive::none) continue;
        const Vec3d size = tree.shapes[s].scope.size;
        const double volume = size.x * size.y * size.z;
        all += volume;
        if (floats[groupOf[s]]) floating += volume;
    }
    return floating > littleShare * all;
}

}  // namespace sgm::cli
