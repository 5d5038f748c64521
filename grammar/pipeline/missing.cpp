#include "grammar/pipeline/missing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "grammar/lower/solids.h"
#include "grammar/pipeline/buried.h"
#include "grammar/pipeline/gaps.h"
#include "grammar/pipeline/grids.h"
#include "grammar/pipeline/holding_cells.h"
#include "modeler/mesh/region.h"

namespace sgm::pipeline {
namespace {

constexpr size_t mostTold = 5;             ///< lines
constexpr double leastDetail_cells = 0.5;  ///< of an ornament: narrower ones show in part

/// The parts of one line of a grammar, or the walls or gaps at their faces.
struct Line {
    std::string symbol;
    size_t parts = 0;
    double thickness_m = 0, cell_m = 0;  ///< of the thinnest
    double missing = 0;                  ///< the sum of their shares
    double lost_m3 = 0;                  ///< about what the mesh lacks of them
    bool atFaces = false;                ///< of boxes
    int halvings = 0;                    ///< of cells around them that are allowed
    bool isBounded = false;              ///< halving ended at the bound of triangles
    syntax::SourceSpan span{};           ///< of the first one's shape
};

/// By file, line and kind.
using Lines = std::map<std::tuple<std::string, uint32_t, lower::ThinPart::Kind>, Line>;

/// About so much of a part, wall or gap is missing, m³.
double lostVolume(const lower::ThinPart& part) {
    double volume_m3 = 0;
    for (const derive::Scope& place : part.places) {
        const double least_m = minComponent(place.size);
        volume_m3 += place.size.x * place.size.y * place.size.z * std::min(part.thickness_m / least_m, 1.0);
    }
    return part.missing * volume_m3;
}

Lines linesOf(const Model& model, const std::vector<lower::ThinPart>& missing) {
    Lines lines;
    for (const lower::ThinPart& m : missing) {
        const Part& part = model.lowered->provenance.parts[m.part];
        Line& line = lines[{part.file(), part.line(), m.kind}];
        if (line.parts++ == 0) {
            const derive::ShapeId shape = model.lowered->shapeOf[m.part];
            line = {part.symbol(), 1, m.thickness_m, m.cell_m, 0, 0, m.face >= 0, m.halvings, false, {}};
            if (shape != derive::none) line.span = model.derivation.tree.shapes[shape].span;
        }
        line.thickness_m = std::min(line.thickness_m, m.thickness_m), line.cell_m = std::min(line.cell_m, m.cell_m);
        line.lost_m3 += lostVolume(m);
        line.missing += m.missing, line.isBounded |= m.isBounded;
    }
    return lines;
}

/// Those of which most is missing first.
std::vector<const Lines::value_type*> byLoss(const Lines& lines) {
    std::vector<const Lines::value_type*> ordered;
    for (const Lines::value_type& line : lines) ordered.push_back(&line);
    std::stable_sort(ordered.begin(), ordered.end(),
                     [](const auto* a, const auto* b) { return a->second.lost_m3 > b->second.lost_m3; });
    return ordered;
}

/// An ornament on a line of a grammar whose details are narrower than half a cell.
struct Ornament {
    std::string name;
    field::FacadeDetail detail{};  ///< of the shape with the narrowest
    syntax::SourceSpan span{};

    /// How many passes such cells hold.
    int held(double cell_m) const {
        const double lost = std::log(leastDetail_cells * cell_m / detail.width_m) / std::log(detail.scale);
        return std::max(0, detail.passes - static_cast<int>(std::ceil(lost - 1e-9)));
    }
};

/// By file and line.
std::map<std::pair<std::string, uint32_t>, Ornament> fineOrnaments(const derive::ShapeTree& tree, double cell_m) {
    std::map<std::pair<std::string, uint32_t>, Ornament> lines;
    for (derive::ShapeId s = 0; s < tree.shapes.size(); ++s) {
        const auto detail = lower::facadeDetailOf(tree, s);
        if (!detail || detail->width_m >= leastDetail_cells * cell_m * (1 - 1e-6)) continue;
        const syntax::SourceSpan span = tree.shapes[s].span;
        if (!span.source) continue;
        Ornament& line = lines[{span.source->name(), span.source->place(span.begin).line}];
        if (!line.span.source || detail->width_m < line.detail.width_m)
            line = {tree.extrasOf(s)->clad[0].name, *detail, span};
    }
    return lines;
}

/// "a 'cube' of 0.05 m", "gaps of 0.1 m at 3 faces of 'cube'", "the eaves of 0.1 m of a 'hip'".
std::string nameOf(const Line& line, lower::ThinPart::Kind kind) {
    const bool one = line.parts == 1;
    const std::string count = one ? "a" : std::to_string(line.parts);
    if (kind == lower::ThinPart::Kind::Part)
        return fmt::format("{} '{}' of {:.3g} m", count, line.symbol, line.thickness_m);
    if (kind == lower::ThinPart::Kind::Rim) return fmt::format("what shows of {} '{}'", count, line.symbol);
    if (kind == lower::ThinPart::Kind::Eaves)
        return fmt::format("the eaves of {:.3g} m of {} '{}'", line.thickness_m, count, line.symbol);
    const std::string where = line.atFaces ? fmt::format("at {} face{} of", count, one ? "" : "s")
                              : one        ? "beside"
                                           : "beside " + count;
    return fmt::format("{}{}{} of {:.3g} m {} '{}'", one ? "a " : "",
                       kind == lower::ThinPart::Kind::Wall ? "wall" : "gap", one ? "" : "s", line.thickness_m, where,
                       line.symbol);
}

bool isNamedAsOne(const Line& line, lower::ThinPart::Kind kind) {
    using Kind = lower::ThinPart::Kind;
    return kind == Kind::Rim || (line.parts == 1 && kind != Kind::Eaves);
}

}  // namespace

Result<std::vector<lower::ThinPart>> findMissingParts(const Model& model, const MeshedModel& meshed, int threads,
                                                      Progress* progress) {
    if (meshed.missing) return *meshed.missing;
    auto missing = lower::findMissingParts(model.derivation, *model.lowered, model.tape, meshed.mesh,
                                           meshed.grid.cell_m, threads, progress);
    if (missing.ok()) std::erase_if(*missing, [](const lower::ThinPart& part) { return !(part.missing > 0); });
    return missing;
}

std::vector<MeshWarning> missingWarnings(const Model& model, const mesh::Grid& grid,
                                         const std::vector<lower::ThinPart>& missing, const std::string& object) {
    const Lines lines = linesOf(model, missing);
    const HoldingCells holding(grid.cell_m, missing);
    const std::string whose = object.empty() ? "the mesh's cells" : fmt::format("the cells of '{}'", object);
    const auto remedy = [&](double cell_m) {
        if (!object.empty()) return fmt::format("--object-cell {:g}", withTwoDigits(cell_m));
        return optionForCells(model.lowered->field.bounds, cell_m);
    };
    const Box3f& bounds = model.lowered->field.bounds;
    const auto farthest_m = static_cast<double>(std::max(maxComponent(bounds.hi), -minComponent(bounds.lo)));
    const double least_m = static_cast<double>(mesh::leastCellAt(1)) * farthest_m;
    const auto whereNear = [&](double cell_m) -> std::string {
        if (!(cell_m < least_m)) return {};
        return fmt::format(
            ", nearer to the origin than {:.0f} m: single precision can't hold such cells {:.0f} m from it",
            withTwoDigits(cell_m / static_cast<double>(mesh::leastCellAt(1))), farthest_m);
    };
    std::vector<MeshWarning> warnings;
    std::set<std::pair<std::string, uint32_t>> others;
    for (const Lines::value_type* const placed : byLoss(lines)) {
        const Line& line = placed->second;
        const auto& [file, number, kind] = placed->first;
        if (warnings.size() == mostTold) {
            others.emplace(file, number);
            continue;
        }
        const bool one = isNamedAsOne(line, kind);
        warnings.push_back(
            {line.span, fmt::format("{}:{}: ", file, number),
             fmt::format("{} {} too thin for {} of {:.3g} m and lack{} {:.0f} % of the surface{}: {} holds {}{}",
                         nameOf(line, kind), one ? "is" : "are", whose, grid.cell_m, one ? "s" : "",
                         100 * line.missing / static_cast<double>(line.parts),
                         line.isBounded ? ", for halving them often enough takes too many triangles" : "",
                         remedy(holding.before(line.cell_m, line.halvings)), one ? "it" : "them",
                         whereNear(line.cell_m)),
             true});
    }
    size_t ornaments = 0;
    for (const auto& [place, line] : fineOrnaments(model.derivation.tree, grid.cell_m)) {
        if (ornaments++ == mostTold) break;
        warnings.push_back(
            {line.span, fmt::format("{}:{}: ", place.first, place.second),
             fmt::format(
                 "{} of {:.3g} m hold {} of {} passes of the ornament{}, whose last details are {:.3g} m wide: {} "
                 "holds all",
                 whose, grid.cell_m, line.held(grid.cell_m), line.detail.passes,
                 line.name.empty() ? "" : fmt::format(" '{}'", line.name), line.detail.width_m,
                 remedy(line.detail.width_m / leastDetail_cells)),
             true});
    }
    if (!others.empty())
        warnings.push_back({{},
                            {},
                            fmt::format("parts of {} more line{} are too thin for these cells", others.size(),
                                        others.size() == 1 ? "" : "s"),
                            true});
    return warnings;
}

Result<std::vector<MeshWarning>> meshWarnings(const Model& model, const MeshedModel& meshed, Context& context) {
    const auto missing = findMissingParts(model, meshed, context.threads, context.progress);
    if (!missing.ok()) return missing.error();
    return meshWarnings(model, meshed.mesh, meshed.grid, *missing, context);
}

Result<std::vector<MeshWarning>> meshWarnings(const Model& model, const mesh::Mesh& mesh, const mesh::Grid& grid,
                                              const std::vector<lower::ThinPart>& missing, Context& context) {
    Support support = supportOf(model, mesh, grid.cell_m);
    if (const Status s = findCauses(model, mesh, grid.cell_m, missing, support, context.progress); !s.ok())
        return s.error();
    auto buried = buriedWarnings(model, mesh, context);
    if (!buried.ok()) return buried;
    std::vector<MeshWarning> warnings = floatingWarnings(model, support, grid.cell_m);
    for (MeshWarning& hidden : *buried) warnings.push_back(std::move(hidden));
    for (MeshWarning& thin : missingWarnings(model, grid, missing)) warnings.push_back(std::move(thin));
    return warnings;
}

}  // namespace sgm::pipeline
