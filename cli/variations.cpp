#include "cli/variations.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "modeler/core/random.h"
#include "viewer/document/param_rows.h"

namespace sgm::cli {

std::vector<viewer::edits::NamedValue> variation(const rules::Grammar& grammar, const viewer::ModelChoice& choice,
                                                 const std::set<std::string>& locked, double spread, uint64_t seed) {
    const auto options = viewer::optionsFor(grammar, choice);
    if (!options.ok()) return {};
    viewer::Choice panel;
    panel.start = choice.start;
    panel.style = choice.style;
    panel.locked = locked;
    const std::vector<viewer::ParamRow> now = viewer::paramRows(grammar, *options, panel);
    std::vector<viewer::ParamRow> rows = viewer::rerolled(now, seed);
    std::vector<viewer::edits::NamedValue> values;
    for (size_t i = 0; i < rows.size(); ++i) {
        viewer::ParamRow& row = rows[i];
        if (row.locked) continue;
        if (row.lo.empty()) {  // a word or a switch
            if (uniform(combine(combine(seed, hashText(row.name)), 7), 0, 1) >= spread) row = now[i];
        } else {
            for (size_t k = 0; k < row.number.size(); ++k) {
                const double v = now[i].number[k] + spread * (row.number[k] - now[i].number[k]);
                row.number[k] = row.kind == viewer::ParamRow::Kind::Integer ? std::round(v) : v;
            }
        }
        const std::string text = viewer::valueText(row);
        if (text != viewer::valueText(now[i])) values.push_back({row.name, text});
    }
    return values;
}

namespace {

/// Share of the surface on its sixteen largest planes.
double shareOnFewPlanes(const mesh::Mesh& mesh, float cell_m) {
    constexpr size_t few = 16;
    std::map<std::array<int, 4>, double> areas;
    double all = 0;
    const Vec3f middle = mesh.bounds().centre();
    std::vector<Vec3f> at;
    for (const mesh::Chunk& c : mesh.chunks) at.insert(at.end(), c.positions.begin(), c.positions.end());
    for (const mesh::Chunk& c : mesh.chunks)
        for (const mesh::Triangle& local : c.triangles) {
            const mesh::Triangle t = c.inMesh(local);
            const Vec3f n = cross(at[t.y] - at[t.x], at[t.z] - at[t.x]);
            const float size = length(n);
            if (size <= 0) continue;
            const auto step = [](float v, float by) { return static_cast<int>(std::lround(v / by)); };
            const float along = dot(n, at[t.x] - middle) / size;
            areas[{step(n.x / size, 0.1f), step(n.y / size, 0.1f), step(n.z / size, 0.1f), step(along, cell_m)}] += size;
            all += size;
        }
    std::vector<double> largest;
    for (const auto& entry : areas) largest.push_back(entry.second);
    std::sort(largest.begin(), largest.end(), std::greater<>());
    double sum = 0;
    for (size_t i = 0; i < std::min(few, largest.size()); ++i) sum += largest[i];
    return all > 0 ? sum / all : 1;
}

}  // namespace

std::optional<std::string> degenerate(const mesh::Mesh& mesh, float cell_m) {
    const std::vector<mesh::Piece> pieces = mesh::pieces(mesh, cell_m);
    if (pieces.empty()) return "empty";
    double all = 0, greatest = 0, floating = 0;
    for (const mesh::Piece& p : pieces) {
        all += p.volume_m3;
        greatest = std::max(greatest, p.volume_m3);
        if (p.floats) floating += p.volume_m3;
    }
    if (greatest < 0.5 * all && pieces.size() > 8) return "dust";
    if (floating > 0.05 * all) return "floating";
    if (shareOnFewPlanes(mesh, cell_m) > 0.97) return "featureless";
    return std::nullopt;
}

}  // namespace sgm::cli
