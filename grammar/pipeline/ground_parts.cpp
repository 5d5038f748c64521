#include "grammar/pipeline/ground_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "modeler/eval/evaluate.h"
#include "modeler/eval/region_cuts.h"

namespace sgm::pipeline {
namespace {

constexpr size_t mostLines = 8, partsOfLine = 16;

/// Thin parts of one line of the grammar.
struct LineOfGround {
    double thickness_m = 0;  ///< of the thinnest
    std::vector<OriginId> parts{};
    double open_m2 = 0, shown_m2 = 0;  ///< of those that are looked at
};

double thicknessOf(const derive::Scope& scope) { return std::min({scope.size.x, scope.size.y, scope.size.z}); }

/// A cell of which two fit into a thickness and a power of two of blocks into the side.
double cellThatHolds(double thickness_m, double side_m) {
    const double blocks = side_m / mesh::blockCells / (thickness_m / 2);
    return side_m / mesh::blockCells / std::exp2(std::max(0.0, std::ceil(std::log2(blocks))));
}

/// Area of a triangle from above; 0 where it faces down.
double areaFromAbove(Vec3f a, Vec3f b, Vec3f c) {
    return std::max(0.0, static_cast<double>(cross(b - a, c - a).y) / 2);
}

}  // namespace

void GroundParts::add(const tiles::Cell& cell, const mesh::PackedMesh& mesh, std::span<const uint32_t> triangles) {
    cells_.insert(cell);
    shown_m2_.resize(model_.lowered->shapeOf.size());
    for (const uint32_t t : triangles) {
        const auto& [a, b, c] = mesh.triangles[t];
        const OriginId part = mesh.origins[t];
        if (part < shown_m2_.size())
            shown_m2_[part] += areaFromAbove(mesh.positions[a], mesh.positions[b], mesh.positions[c]);
    }
}

/// How much of the part's top is surface within the cells, m² from above, by samples.
double GroundParts::openArea(OriginId part) const {
    const derive::Scope& scope = model_.derivation.tree.shapes[model_.lowered->shapeOf[part]].scope;
    constexpr int across = 12;
    const double off = .25 * thicknessOf(scope);
    std::vector<float> x, y, z;
    Box3f box;
    for (int i = 0; i < across * across; ++i) {
        const Vec3d at{(i % across + .5) / across - .5, .5, (i / across + .5) / across - .5};
        const Vec3d top = scope.centre + scope.axes * (at * scope.size);
        if (!cells_.contains(tiles::cellAt(top.x, top.z, side_m_))) continue;
        for (const double side : {-off, off}) {
            const Vec3f p = (top + scope.axes.y * side).as<float>();
            x.push_back(p.x), y.push_back(p.y), z.push_back(p.z);
            box.lo = min(box.lo, p), box.hi = max(box.hi, p);
        }
    }
    if (x.empty()) return 0;
    eval::Workspace workspace;
    const eval::Tape tape = eval::shortenTo(model_.tape, box, workspace);
    std::vector<float> value(x.size());
    eval::evaluate(tape, {x.data(), y.data(), z.data(), x.size()}, value.data(), workspace);
    int open = 0;
    for (size_t i = 0; i < value.size(); i += 2) open += value[i] < 0 && value[i + 1] > 0;
    return scope.size.x * scope.size.z * std::max(0.0, scope.axes.y.y) * open / (across * across);
}

std::vector<MeshWarning> GroundParts::warnings(double pitch_m) const {
    using Place = std::tuple<std::string, uint32_t, std::string>;
    std::map<Place, LineOfGround> lines;
    for (OriginId part = 1; part < shown_m2_.size(); ++part) {
        const derive::ShapeId shape = model_.lowered->shapeOf[part];
        if (shape == derive::none) continue;
        const double thickness_m = thicknessOf(model_.derivation.tree.shapes[shape].scope);
        if (!(thickness_m > 0 && thickness_m < pitch_m)) continue;
        const Part& made = model_.lowered->provenance.parts[part];
        LineOfGround& line = lines[{made.file(), made.line(), made.symbol()}];
        line.thickness_m = line.parts.empty() ? thickness_m : std::min(line.thickness_m, thickness_m);
        line.parts.push_back(part);
    }
    std::vector<std::pair<const Place*, const LineOfGround*>> lacking;
    for (auto& [place, line] : lines) {
        for (size_t i = 0; i < std::min(line.parts.size(), partsOfLine); ++i)
            line.open_m2 += openArea(line.parts[i]), line.shown_m2 += shown_m2_[line.parts[i]];
        if (line.shown_m2 < line.open_m2 / 2) lacking.emplace_back(&place, &line);
    }
    std::stable_sort(lacking.begin(), lacking.end(),
                     [](const auto& a, const auto& b) { return a.second->open_m2 > b.second->open_m2; });
    std::vector<MeshWarning> warnings;
    for (const auto& [place, line] : lacking) {
        const auto& [file, number, symbol] = *place;
        const derive::ShapeId shape = model_.lowered->shapeOf[line->parts[0]];
        const double share = line->shown_m2 / line->open_m2;
        warnings.push_back(
            {model_.derivation.tree.shapes[shape].span, fmt::format("{}:{}: ", file, number),
             fmt::format("{} of '{}' shows in the ground: it is {:.3g} m thick, and the ground's cells are {:g} m: "
                         "--cell {:g} holds it",
                         share < .005 ? "nothing" : fmt::format("about {:.0f} %", 100 * share), symbol,
                         line->thickness_m, pitch_m, cellThatHolds(line->thickness_m, side_m_)),
             true});
        if (warnings.size() == mostLines) break;
    }
    return warnings;
}

}  // namespace sgm::pipeline
