#include "grammar/lower/torn_eaves.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "grammar/derive/boxes.h"
#include "grammar/derive/lift.h"
#include "grammar/derive/scope_footprint.h"
#include "grammar/lower/cutters.h"
#include "grammar/lower/presence.h"
#include "grammar/lower/scope_lines.h"
#include "grammar/lower/surface_lines.h"
#include "modeler/field/plan_parameters.h"

namespace sgm::lower {
namespace {

constexpr double leastOverhang = 0.125;           ///< cells: eaves that halved cells hold
constexpr float reachOfCell = 0.1875f;            ///< from the surface: farther away is torn
constexpr float reachOfOverhang = 0.4f;           ///< the same, where that is less
constexpr size_t fewestTorn = 3;                  ///< places
constexpr double leastTorn = 0.05;                ///< share of them, of a board
constexpr double leastTornWedge = 0.3;            ///< the same of a wedge; less is its tip, which halved cells tear too
constexpr std::array outward{0.3, 0.6, 0.9};      ///< of the overhang: where eaves are looked at
constexpr int fewestPlaces = 3, mostPlaces = 32;  ///< along an edge
constexpr double deepest = 3;                     ///< overhangs below a roof's foot: so far down eaves are looked for

/// What stands out beyond an edge of a plan.
struct Eave {
    derive::Scope scope;                           ///< x along the edge, y up, z outward
    std::vector<SurfaceLines::Bracket> crossings;  ///< of upright lines through it with the solid's own surface
};

/// What stands out of a solid over a plan, a roof's eaves or a moulding, where it stands on hills.
struct Overhang {
    OriginId part = 0;
    derive::Scope scope;
    double out_m = 0;
    bool isMoulding = false;
    bool hasBoard = false;  ///< else the eaves are wedges
    std::vector<Eave> eaves;
    size_t points = 0, away = 0;        ///< of its surface at the eaves; of them, where the mesh isn't
    std::vector<double> thicknesses_m;  ///< of the eaves where the mesh isn't
    std::vector<derive::Scope> places;  ///< the eaves that are torn somewhere

    Vec3d centre() const { return scope.centre; }
    OriginId number() const { return part; }
};

/// Finds the surface of eaves. One worker's.
class EaveProber {
public:
    EaveProber(const eval::Tape& tape, const Box3f& bounds, float cell_m)
        : tapes_(tape), surface_(bounds, cell_m), cell_m_(static_cast<double>(cell_m)) {}

    Box3f boxOf(const Overhang& overhang) const {
        Box3d box;
        for (const Eave& eave : overhang.eaves) box = hull(box, derive::boxOf(eave.scope, lineReach));
        return box.as<float>();
    }
    eval::LocalTapes& tapes() { return tapes_; }

    void probe(std::span<Overhang> overhangs, std::span<const Box3f> boxes) {
        tapes_.visit(boxes, [&](size_t i, const eval::Tape& tape) {
            for (Eave& eave : overhangs[i].eaves) {
                surface_.findOnLines(linesThrough(eave.scope), overhangs[i].part, tape, tapes_.workspace());
                eave.crossings.assign(surface_.found().begin(), surface_.found().end());
            }
        });
    }

private:
    /// Upright lines about a cell apart.
    std::span<const SurfaceLines::Line> linesThrough(const derive::Scope& eave) {
        const auto along =
            static_cast<int>(std::clamp(std::ceil(eave.size.x / cell_m_), double{fewestPlaces}, double{mostPlaces}));
        const auto shareAlong = [&](int i) { return (i + 0.535) / along; };  // in no plane of symmetry
        lines_.clear();
        for (int i = 0; i < along; ++i)
            for (const double out : outward)
                lines_.push_back(
                    {eave.point({2 * shareAlong(i) - 1, -lineReach, 2 * out - 1}), eave.axes.y, eave.size.y});
        return lines_;
    }

    eval::LocalTapes tapes_;
    SurfaceLines surface_;
    double cell_m_;
    std::vector<SurfaceLines::Line> lines_;
};

/// Counts where the mesh is away from an eave's surface.
void compare(const Eave& eave, const Presence& presence, Overhang& overhang) {
    /// What a line meets of the solid.
    struct Crossed {
        size_t points = 0, away = 0;
        double low_m = std::numeric_limits<double>::max(), high_m = std::numeric_limits<double>::lowest();
    };
    std::map<size_t, Crossed> lines;
    for (const SurfaceLines::Bracket& b : eave.crossings) {
        Crossed& line = lines[b.line];
        const double height_m = dot(b.middle() - eave.scope.centre, eave.scope.axes.y);
        ++line.points, line.away += presence.isNear(b.middle().as<float>(), overhang.part) ? 0 : 1;
        line.low_m = std::min(line.low_m, height_m), line.high_m = std::max(line.high_m, height_m);
    }
    double low_m = eave.scope.size.y, high_m = -eave.scope.size.y;
    size_t away = 0;
    for (const auto& [number, line] : lines) {
        if (line.points < 2) continue;  // it lies on a cornice, or is cut off
        overhang.points += line.points, away += line.away;
        low_m = std::min(low_m, line.low_m), high_m = std::max(high_m, line.high_m);
        if (line.away > 0) overhang.thicknesses_m.push_back(line.high_m - line.low_m);
    }
    if (away == 0) return;
    overhang.away += away;
    derive::Scope place = eave.scope;
    place.centre += place.axes.y * (0.5 * (low_m + high_m));
    place.size.y = high_m - low_m;
    overhang.places.push_back(place);
}

/// Of a parameter; 0 where the solid has none of that name.
double argumentOf(const derive::SolidValue& solid, const field::PrimitiveParameter& wanted) {
    if (!solid.primitive) return 0;
    const std::span<const field::PrimitiveParameter> row = solid.primitive->parameters;
    for (size_t i = 0; i < row.size() && i < solid.args.size(); ++i)
        if (row[i].name == wanted.name) return solid.args[i].num();
    return 0;
}

/// Boxes around what stands out beyond each edge of the plan.
std::vector<Eave> eavesOf(const derive::Scope& scope, const derive::Footprints& footprints, double out_m,
                          double drop_m) {
    std::vector<Eave> eaves;
    for (const plan::PlacedEdge& e : plan::edgesOf(derive::footprintOf(scope, footprints))) {
        const plan::Vec2 out = e.normal(), middle = (e.from + e.to) * 0.5 + out * (0.5 * out_m);
        derive::Scope eave;
        eave.centre = scope.centre + scope.axes * Vec3d{middle.x, -0.5 * drop_m, middle.z};
        eave.axes = scope.axes * Mat3{{out.z, 0, -out.x}, {0, 1, 0}, {out.x, 0, out.z}};
        eave.size = {e.length() + 2 * out_m, scope.size.y + drop_m, out_m};
        eaves.push_back({eave, {}});
    }
    return eaves;
}

std::vector<Overhang> overhangsOf(const derive::Derivation& derivation, const Model& model, double cell_m,
                                  const std::vector<ThinPart>* among) {
    std::vector<bool> isWanted(model.shapeOf.size(), !among);
    if (among)
        for (const ThinPart& part : *among) isWanted[part.part] = true;
    const std::vector<bool> cuts = cutters(derivation.tree.shapes);
    std::vector<Overhang> overhangs;
    for (OriginId part = 1; part < model.shapeOf.size(); ++part) {
        const derive::ShapeId id = model.shapeOf[part];
        if (id == derive::none || !isWanted[part] || cuts[id]) continue;
        const derive::Shape& shape = derivation.tree.shapes[id];
        if (shape.solid == derive::none) continue;
        const derive::SolidValue& solid = derivation.tree.solids[shape.solid];
        const bool isMoulding = overhangOf(solid) == 0;
        const double out_m = isMoulding ? derive::standsOut_m(solid, shape.scope.size.y) : overhangOf(solid);
        if (out_m <= (isMoulding ? 0 : leastOverhang * cell_m)) continue;
        const derive::Scope scope = derive::liftedScope(derivation, id);
        const bool hasBoard = isMoulding || argumentOf(solid, field::plan_parameters::fascia) > 0;
        const double drop_m = isMoulding ? 0 : deepest * out_m;
        overhangs.push_back({part,
                             scope,
                             out_m,
                             isMoulding,
                             hasBoard,
                             eavesOf(scope, derivation.tree.footprints, out_m, drop_m),
                             0,
                             0,
                             {},
                             {}});
    }
    return overhangs;
}

/// What the mesh lacks of eaves, or of a moulding.
std::optional<ThinPart> tornOf(Overhang& overhang, double cell_m) {
    const double share = static_cast<double>(overhang.away) / static_cast<double>(overhang.points);
    if (overhang.away < fewestTorn || share < (overhang.hasBoard ? leastTorn : leastTornWedge)) return std::nullopt;
    std::vector<double>& sizes_m = overhang.thicknesses_m;
    std::sort(sizes_m.begin(), sizes_m.end());
    const auto at = [&](double rank) {
        return sizes_m[static_cast<size_t>(rank * static_cast<double>(sizes_m.size()))];
    };
    const auto kind = overhang.isMoulding ? ThinPart::Kind::Part : ThinPart::Kind::Eaves;
    ThinPart torn{.kind = kind, .part = overhang.part, .places = std::move(overhang.places)};
    const double most_m = overhang.isMoulding ? overhang.out_m : std::numeric_limits<double>::max();
    torn.thickness_m = std::min(at(0.75), most_m), torn.cell_m = std::min({at(0.5), most_m, cell_m / 2});
    torn.missing = share;
    return torn;
}

}  // namespace

double overhangOf(const derive::SolidValue& solid) { return argumentOf(solid, field::plan_parameters::overhang); }

Result<std::vector<ThinPart>> findTornEaves(const derive::Derivation& derivation, const Model& model,
                                            const eval::Tape& tape, const mesh::Mesh& mesh, float cell_m, int threads,
                                            Progress* progress, const std::vector<ThinPart>* among) {
    std::vector<ThinPart> torn;
    if (mesh.hasPositionsOnly()) return torn;
    std::vector<Overhang> overhangs = overhangsOf(derivation, model, static_cast<double>(cell_m), among);
    if (overhangs.empty()) return torn;
    eval::orderByPlace(std::span(overhangs));
    eval::probeInGroups(
        std::span(overhangs), threads, progress, "eaves", [&] { return EaveProber(tape, model.field.bounds, cell_m); },
        [](EaveProber& prober, std::span<Overhang> some, std::span<const Box3f> boxes, size_t) {
            prober.probe(some, boxes);
        });
    if (cancelled(progress)) return cancelledError();
    std::vector<Presence::Query> queries(model.shapeOf.size());
    std::vector<Vec3f> points;
    for (const Overhang& overhang : overhangs) {
        queries[overhang.part] = {Presence::Query::Extent::NearPoints,
                                  std::min(reachOfCell * cell_m, reachOfOverhang * static_cast<float>(overhang.out_m))};
        for (const Eave& eave : overhang.eaves)
            for (const SurfaceLines::Bracket& b : eave.crossings) points.push_back(b.middle().as<float>());
    }
    const Presence presence(mesh, queries, points, cell_m, threads);
    for (Overhang& overhang : overhangs) {
        for (const Eave& eave : overhang.eaves) compare(eave, presence, overhang);
        if (auto found = tornOf(overhang, static_cast<double>(cell_m))) torn.push_back(std::move(*found));
    }
    std::sort(torn.begin(), torn.end(), [](const ThinPart& a, const ThinPart& b) { return a.part < b.part; });
    return torn;
}

}  // namespace sgm::lower
