#include "grammar/lower/torn_rims.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

#include "grammar/derive/boxes.h"
#include "grammar/derive/lift.h"
#include "grammar/lower/cutters.h"
#include "grammar/lower/mesh_positions.h"
#include "grammar/lower/presence.h"
#include "grammar/lower/scope_lines.h"
#include "grammar/lower/surface_lines.h"

namespace sgm::lower {
namespace {

constexpr SurfaceLines::Density density{16, 384};
constexpr double stripCells = 2;      ///< as wide as a strip may be that cells tear
constexpr float awayCells = 0.1875f;  ///< from the surface: so far away is torn
constexpr size_t fewestAway = 3;      ///< places
constexpr double leastAway = 0.05;    ///< share of them

/// How wide the narrowest smooth piece of each part of those asked for is about in a mesh, metres: its area over half
/// the length of its creases. Infinite for what blends into others all around, 0 of parts that the mesh doesn't show.
std::vector<double> widthsOf(const mesh::Mesh& mesh, const std::vector<bool>& isAsked) {
    struct Piece {
        double area_m2 = 0, border_m = 0;
    };
    const std::vector<const Vec3f*> positions = positionsOf(mesh);
    const auto visit = [&](auto&& use) {
        for (const mesh::Chunk& c : mesh.chunks)
            for (size_t t = 0; t < c.origins.size(); ++t)
                use(c.inMesh(c.triangles[t]), c.origins[t], c.labels.empty() ? 0 : c.labels[t]);
    };
    constexpr uint64_t unasked = ~uint64_t{0};
    std::vector<uint64_t> labels(positions.size(), unasked);  // at vertices of parts that are asked for
    visit([&](const mesh::Triangle& corners, OriginId part, mesh::Label label) {
        if (!isAsked[part]) return;
        for (int k = 0; k < 3; ++k) labels[corners[k]] = label;
    });
    std::vector<bool> isBorder(positions.size());
    visit([&](const mesh::Triangle& corners, OriginId, mesh::Label label) {
        for (int k = 0; k < 3; ++k)
            if (labels[corners[k]] != unasked && labels[corners[k]] != label) isBorder[corners[k]] = true;
    });
    std::unordered_map<uint64_t, Piece> pieces;
    Piece* last = nullptr;
    uint64_t lastKey = 0;
    visit([&](const mesh::Triangle& corners, OriginId part, mesh::Label label) {
        if (!isAsked[part]) return;
        const uint64_t key = uint64_t{part} << 32 | label;
        if (!last || key != lastKey) last = &pieces[key], lastKey = key;  // neighbours mostly are of one piece
        Piece& piece = *last;
        std::array<Vec3d, 3> p;
        for (size_t k = 0; k < 3; ++k) p[k] = positions[corners[static_cast<int>(k)]]->as<double>();
        piece.area_m2 += 0.5 * length(cross(p[1] - p[0], p[2] - p[0]));
        for (int k = 0; k < 3; ++k)
            if (isBorder[corners[k]] && isBorder[corners[(k + 1) % 3]])
                piece.border_m += length(p[static_cast<size_t>((k + 1) % 3)] - p[static_cast<size_t>(k)]);
    });
    std::vector<double> widths_m(isAsked.size());
    for (const auto& [key, piece] : pieces) {
        double& width_m = widths_m[key >> 32];
        const double own_m = 2 * piece.area_m2 / piece.border_m;
        width_m = width_m > 0 ? std::min(width_m, own_m) : own_m;
    }
    return widths_m;
}

/// By shape: whether it, or one that holds it, blends into what stands: no crease is around it.
std::vector<bool> blendedShapes(const derive::Shapes& shapes) {
    std::vector<bool> blends(shapes.size());
    for (derive::ShapeId s = 0; s < shapes.size(); ++s)
        blends[s] = shapes[s].blend_m > 0 || (shapes[s].parent != derive::none && blends[shapes[s].parent]);
    return blends;
}

/// A part that may be torn.
struct Rim {
    OriginId part = 0;
    derive::Scope scope;
    bool isBox = false;
    double width_m = 0;
    std::vector<Vec3d> points;  ///< of its surface
    size_t away = 0;            ///< of them, where the mesh isn't
    double spacing_m = 0;       ///< of them, at most

    Vec3d centre() const { return scope.centre; }
    OriginId number() const { return part; }
};

/// One worker's.
class RimProber {
public:
    RimProber(const eval::Tape& tape, const Box3f& bounds, const Presence& presence, float cell_m)
        : tapes_(tape), surface_(bounds, cell_m), presence_(presence) {}

    Box3f boxOf(const Rim& rim) const { return derive::boxOf(rim.scope, lineReach).as<float>(); }
    eval::LocalTapes& tapes() { return tapes_; }

    void probe(std::span<Rim> rims, std::span<const Box3f> boxes) {
        tapes_.visit(boxes, [&](size_t i, const eval::Tape& tape) {
            Rim& rim = rims[i];
            rim.spacing_m = rim.isBox ? surface_.findOnFaces(rim.scope, rim.part, density, tape, tapes_.workspace())
                                      : surface_.find(rim.scope, rim.part, density, tape, tapes_.workspace());
            for (const SurfaceLines::Bracket& b : surface_.found()) {
                rim.points.push_back(b.middle());
                if (!presence_.isNear(b.middle().as<float>(), rim.part)) ++rim.away;
            }
        });
    }

private:
    eval::LocalTapes tapes_;
    SurfaceLines surface_;
    const Presence& presence_;
};

/// Blocks, round parts and what stands over a plan, of which the mesh shows strips.
std::vector<Rim> rimsOf(const derive::Derivation& derivation, const Model& model, const mesh::Mesh& mesh, double cell_m,
                        const std::vector<ThinPart>* among) {
    std::vector<bool> isWanted(model.shapeOf.size(), !among);
    if (among)
        for (const ThinPart& part : *among) isWanted[part.part] = true;
    const std::vector<bool> cuts = cutters(derivation.tree.shapes), blends = blendedShapes(derivation.tree.shapes);
    std::vector<bool> isAsked(model.shapeOf.size()), areBoxes(model.shapeOf.size());
    bool anyAsked = false;
    for (OriginId part = 1; part < model.shapeOf.size(); ++part) {
        const derive::ShapeId id = model.shapeOf[part];
        if (id == derive::none || !isWanted[part] || cuts[id] || blends[id]) continue;
        const derive::Shape& shape = derivation.tree.shapes[id];
        if (shape.solid == derive::none || cellThatHolds(shape.scope) < cell_m) continue;
        const derive::SolidValue& solid = derivation.tree.solids[shape.solid];
        areBoxes[part] = isBox(solid, shape.scope);
        if (!solid.primitive) continue;
        const bool hasPlan = solid.primitive->plan != field::PlanUse::None;
        if (solid.primitive->hasFlatFaces && !areBoxes[part] && !hasPlan) continue;
        isAsked[part] = anyAsked = true;
    }
    std::vector<Rim> rims;
    if (!anyAsked) return rims;
    const std::vector<double> widths_m = widthsOf(mesh, isAsked);
    for (OriginId part = 1; part < model.shapeOf.size(); ++part)
        if (isAsked[part] && widths_m[part] < stripCells * cell_m)
            rims.push_back(
                {part, derive::liftedScope(derivation, model.shapeOf[part]), areBoxes[part], widths_m[part], {}, 0, 0});
    return rims;
}

}  // namespace

Result<std::vector<ThinPart>> findTornRims(const derive::Derivation& derivation, const Model& model,
                                           const eval::Tape& tape, const mesh::Mesh& mesh, float cell_m, int threads,
                                           Progress* progress, const std::vector<ThinPart>* among) {
    std::vector<ThinPart> torn;
    if (mesh.hasPositionsOnly()) return torn;
    std::vector<Rim> rims = rimsOf(derivation, model, mesh, static_cast<double>(cell_m), among);
    if (rims.empty()) return torn;
    std::vector<Presence::Query> queries(model.shapeOf.size());
    for (const Rim& rim : rims) queries[rim.part] = {Presence::Query::Extent::All, awayCells * cell_m};
    const Presence presence(mesh, queries, {}, cell_m, threads);
    eval::orderByPlace(std::span(rims));
    eval::probeInGroups(
        std::span(rims), threads, progress, "rims",
        [&] { return RimProber(tape, model.field.bounds, presence, cell_m); },
        [](RimProber& prober, std::span<Rim> some, std::span<const Box3f> boxes, size_t) {
            prober.probe(some, boxes);
        });
    if (cancelled(progress)) return cancelledError();
    for (const Rim& rim : rims) {
        if (rim.away < fewestAway) continue;
        const double share = static_cast<double>(rim.away) / static_cast<double>(rim.points.size());
        if (share < leastAway) continue;
        ThinPart part{.kind = ThinPart::Kind::Rim, .part = rim.part, .places = {}};
        part.thickness_m = rim.width_m, part.cell_m = static_cast<double>(cell_m) / 2, part.missing = share;
        const double edge_m = std::min(rim.spacing_m, static_cast<double>(cell_m));
        for (const Vec3d& at : rim.points) part.places.push_back({at, rim.scope.axes, {edge_m, edge_m, edge_m}});
        torn.push_back(std::move(part));
    }
    std::sort(torn.begin(), torn.end(), [](const ThinPart& a, const ThinPart& b) { return a.part < b.part; });
    return torn;
}

}  // namespace sgm::lower
