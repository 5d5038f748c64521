#include "grammar/lower/thin_walls.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <span>

#include "grammar/derive/boxes.h"
#include "grammar/derive/lift.h"
#include "grammar/lower/cutters.h"
#include "grammar/lower/met_segments.h"
#include "grammar/lower/scope_lines.h"
#include "grammar/lower/surface_lines.h"
#include "grammar/lower/torn_eaves.h"
#include "modeler/eval/local_tapes.h"
#include "modeler/field/convex.h"

namespace sgm::lower {
namespace {

constexpr SurfaceLines::Density first{16, 384},
    close{128, 8192};              ///< close where walls are too thin: strips may be lost
constexpr double leastThin = 0.1;  ///< share of a shell's surface that is too thin
/// In cells, from the surface into the solid.
constexpr std::array depths{0.03, 0.1, 0.2, 0.35, 0.5, 0.75, 1.0, 1.25, 1.5, 1.75};

constexpr double thinnerWall = 0.7;   ///< of the whole: so thin is a wall of a part that is thin as a whole
constexpr double leaningWall = 1.42;  ///< times a cell: a thicker wall is held as a rule
constexpr double beyondWall = 0.5;    ///< cells beyond both surfaces of a wall within which a mesh has it

constexpr size_t fewestMissing = 3;     ///< lines across a wall that the mesh lacks: a hole in it is seen
constexpr double leastOfCut = 0.05;     ///< share of the surface of a cut that walls are missing from
constexpr double leastOfShell = 0.004;  ///< the same of a shell
constexpr double leastOfWedge = 0.7;    ///< of a shell's thickness: less is a wedge at its end
constexpr size_t mostPlaces = 100000;   ///< that are told one by one; of further parts their scope is
/// Times the median: what half of the walls' thicknesses differ by at most. Where two cuts touch or two faces meet in
/// an edge the solid has any thickness down to none, which no cells hold.
constexpr double mostSpread = 0.8;

/// A part with surface beside which the solid may be thin, where it stands on hills.
struct WalledPart {
    OriginId part = 0;
    derive::Scope scope;
    double shell_m = 0;  ///< thickness that its parameters say; 0 for a cut

    Vec3d centre() const { return scope.centre; }
    OriginId number() const { return part; }
};

/// Across a wall, from the part's surface to the next one.
struct WallLine {
    Vec3d from, inward;
    double thickness_m = 0;
};

struct ThinWalls {
    WalledPart of;
    double spacing_m = 0;  ///< of the lines, at most
    size_t points = 0;     ///< of the part's surface that were looked at
    std::vector<WallLine> lines;
    std::vector<WallLine> close;  ///< of a closer look, which decides instead
    size_t closePoints = 0;

    const std::vector<WallLine>& deciding() const { return closePoints > 0 ? close : lines; }
    double decidingPoints() const { return static_cast<double>(closePoints > 0 ? closePoints : points); }
};

/// Axes of which z lies along a unit vector.
Mat3 axesAlong(Vec3d z) {
    const Vec3d x = normalized(cross(std::abs(z.y) < 0.7 ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0}, z));
    return {x, cross(z, x), z};
}

/// One worker's.
class WallProber {
public:
    WallProber(const eval::Tape& tape, const Box3f& bounds, float cell_m)
        : tapes_(tape), surface_(bounds, cell_m), cell_m_(static_cast<double>(cell_m)) {}

    Box3f boxOf(const WalledPart& part) const {
        return derive::boxOf(part.scope, lineReach).inflated((depths.back() + 1) * cell_m_).as<float>();
    }
    eval::LocalTapes& tapes() { return tapes_; }

    void probe(std::span<const WalledPart> parts, std::span<const Box3f> boxes, std::vector<ThinWalls>& found) {
        tapes_.visit(boxes, [&](size_t i, const eval::Tape& tape) { probePart(parts[i], tape, found); });
    }

private:
    void probePart(const WalledPart& part, const eval::Tape& tape, std::vector<ThinWalls>& found) {
        ThinWalls walls = wallsOf(part, tape, first);
        if (part.shell_m > 0 && walls.spacing_m > cell_m_ &&
            static_cast<double>(walls.lines.size()) > leastThin * static_cast<double>(walls.points)) {
            ThinWalls closer = wallsOf(part, tape, close);
            walls.close = std::move(closer.lines), walls.closePoints = closer.points;
        }
        if (!walls.lines.empty()) found.push_back(std::move(walls));
    }

    ThinWalls wallsOf(const WalledPart& part, const eval::Tape& tape, const SurfaceLines::Density& density) {
        ThinWalls walls{part, 0, 0, {}, {}, 0};
        walls.spacing_m = surface_.find(part.scope, part.part, density, tape, tapes_.workspace());
        walls.points = surface_.found().size();
        if (walls.points > 0) measure(tape, walls.lines);
        return walls;
    }

    /// Goes from the surface straight into the solid.
    void measure(const eval::Tape& tape, std::vector<WallLine>& lines) {
        points_.clear();
        for (const SurfaceLines::Bracket& b : surface_.found()) points_.add(b.middle().as<float>());
        const size_t count = surface_.found().size();
        std::vector<float> dx(count), dy(count), dz(count);
        values_.resize(count);
        eval::evaluateGradient(tape, points_.points(), values_.data(), dx.data(), dy.data(), dz.data(),
                               tapes_.workspace());
        std::vector<Vec3d> from, inward;
        for (size_t i = 0; i < count; ++i) {
            const Vec3d out = normalized(Vec3d{dx[i], dy[i], dz[i]});
            if (out != Vec3d{}) from.push_back(surface_.found()[i].middle()), inward.push_back(-out);
        }
        points_.clear();
        for (size_t i = 0; i < from.size(); ++i)
            for (const double depth : depths) points_.add((from[i] + inward[i] * (depth * cell_m_)).as<float>());
        evaluate(tape);
        std::vector<SurfaceLines::Bracket> beyond;
        std::vector<size_t> of;
        for (size_t i = 0; i < from.size(); ++i) {
            const float* const values = values_.data() + i * depths.size();
            // In seams of parts that touch the field is 0 again.
            const auto* const out =
                std::find_if(values, values + depths.size(), [&](float value) { return value > tape.tieMargin(); });
            const auto k = static_cast<size_t>(out - values);
            if (k == depths.size()) continue;
            const double before = k == 0 ? 0 : depths[k - 1];
            beyond.push_back({from[i] + inward[i] * (before * cell_m_), from[i] + inward[i] * (depths[k] * cell_m_)});
            of.push_back(i);
        }
        surface_.halve(beyond, tape, tapes_.workspace());
        for (size_t i = 0; i < beyond.size(); ++i) {
            const Vec3d at = from[of[i]], n = inward[of[i]];
            const double thickness_m = dot(beyond[i].middle() - at, n);
            if (thickness_m * turnOf(n) < cell_m_) lines.push_back({at, n, thickness_m});
        }
    }

    void evaluate(const eval::Tape& tape) {
        values_.resize(points_.size());
        eval::evaluate(tape, points_.points(), values_.data(), tapes_.workspace());
    }

    eval::LocalTapes tapes_;
    SurfaceLines surface_;
    double cell_m_;
    eval::PointList points_;
    std::vector<float> values_;
};

/// The least thickness of walls and shells that a solid's parameters say, metres; infinite where they say none.
double wallOf(const derive::SolidValue& solid) {
    double least = INFINITY;
    if (!solid.primitive) return least;
    const std::span<const field::PrimitiveParameter> row = solid.primitive->parameters;
    for (size_t i = 0; i < row.size() && i < solid.args.size(); ++i)
        if (row[i].isThickness && solid.args[i].num() > 0) least = std::min(least, solid.args[i].num());
    return least;
}

/// A scope around all of a solid: eaves and gutters stand out of it, eaves down too where the roof is steep.
derive::Scope around(derive::Scope scope, const derive::SolidValue& solid) {
    const double out_m = derive::standsOut_m(solid, scope.size.y);
    scope.size += {2 * out_m, 4 * overhangOf(solid), 2 * out_m};
    return scope;
}

std::vector<WalledPart> walledParts(const derive::Derivation& derivation, const Model& model, double cell_m,
                                    const std::vector<ThinPart>* among) {
    std::vector<bool> isWanted(model.shapeOf.size(), !among);
    if (among)
        for (const ThinPart& part : *among)
            if (part.face < 0) isWanted[part.part] = true;
    const std::vector<bool> cuts = cutters(derivation.tree.shapes);
    std::vector<WalledPart> walled;
    for (OriginId part = 1; part < model.shapeOf.size(); ++part) {
        const derive::ShapeId id = model.shapeOf[part];
        if (id == derive::none || !isWanted[part]) continue;
        const derive::Shape& shape = derivation.tree.shapes[id];
        if (shape.solid == derive::none) continue;
        const derive::SolidValue& solid = derivation.tree.solids[shape.solid];
        const double wall_m = wallOf(solid);
        // What is thin as a whole is looked for likewise, but otherwise (findMissingParts): a parapet on it is thinner.
        if (cellThatHolds(shape.scope) < cell_m && !(wall_m < thinnerWall * minComponent(shape.scope.size))) continue;
        const bool isShell = wall_m / leaningWall < cell_m;
        if (!isShell && (!cuts[id] || isBox(solid, shape.scope))) continue;
        walled.push_back({part, around(derive::liftedScope(derivation, id), solid), isShell ? wall_m : 0});
    }
    return walled;
}

/// What the mesh lacks of walls, where `isMet` says of each line whether it has any. It may lack them between lines
/// too: all of them are in its places.
ThinPart missingOf(const ThinWalls& walls, std::span<const uint8_t> isMet, double cell_m, size_t placesBefore) {
    const bool isShell = walls.of.shell_m > 0;
    ThinPart missing{
        .kind = isShell ? ThinPart::Kind::Part : ThinPart::Kind::Wall, .part = walls.of.part, .places = {}};
    std::vector<double> thicknesses_m, cells_m;
    size_t atWedges = 0;
    for (const WallLine& line : walls.lines)
        missing.places.push_back({line.from + line.inward * (0.5 * line.thickness_m),
                                  axesAlong(line.inward),
                                  {walls.spacing_m, walls.spacing_m, line.thickness_m}});
    for (size_t i = 0; i < walls.deciding().size(); ++i) {
        if (isMet[i]) continue;
        const WallLine& line = walls.deciding()[i];
        if (line.thickness_m < leastOfWedge * walls.of.shell_m) ++atWedges;
        thicknesses_m.push_back(line.thickness_m), cells_m.push_back(line.thickness_m * turnOf(line.inward));
    }
    const auto lacked = static_cast<double>(thicknesses_m.size());
    if (thicknesses_m.size() < fewestMissing || lacked < (isShell ? leastOfShell : leastOfCut) * walls.decidingPoints())
        return {};
    std::sort(thicknesses_m.begin(), thicknesses_m.end()), std::sort(cells_m.begin(), cells_m.end());
    const auto at = [](const std::vector<double>& sorted, double share) {
        return sorted[static_cast<size_t>(share * static_cast<double>(sorted.size() - 1))];
    };
    missing.thickness_m = at(thicknesses_m, 0.5);
    if (!isShell && at(thicknesses_m, 0.75) - at(thicknesses_m, 0.25) > mostSpread * missing.thickness_m) return {};
    if (isShell) missing.thickness_m = walls.of.shell_m, missing.isShell = true;
    missing.missing = lacked / (isShell ? walls.decidingPoints() : static_cast<double>(walls.lines.size()));
    // A shell comes to nothing where it ends in a wedge: cells are halved there, but some of its tip is always missing.
    if (isShell) missing.missing -= static_cast<double>(atWedges) / walls.decidingPoints();
    if (isShell && missing.missing < leastOfShell) missing.missing = 0;
    missing.cell_m = std::min(std::max(at(cells_m, 0.1), 0.5 * walls.of.shell_m), cell_m / 2);
    if (placesBefore > mostPlaces) missing.places = {walls.of.scope};
    return missing;
}

}  // namespace

Result<std::vector<ThinPart>> findMissingWalls(const derive::Derivation& derivation, const Model& model,
                                               const eval::Tape& tape, const mesh::Mesh& mesh, float cell_m,
                                               int threads, Progress* progress, const std::vector<ThinPart>* among) {
    const auto cell = static_cast<double>(cell_m);
    std::vector<WalledPart> parts = walledParts(derivation, model, cell, among);
    eval::orderByPlace(std::span(parts));
    std::vector<std::vector<ThinWalls>> found((parts.size() + eval::LocalTapes::mostBoxes - 1) /
                                              eval::LocalTapes::mostBoxes);
    eval::probeInGroups(
        std::span(parts), threads, progress, "thin walls", [&] { return WallProber(tape, model.field.bounds, cell_m); },
        [&](WallProber& prober, std::span<const WalledPart> some, std::span<const Box3f> boxes, size_t group) {
            prober.probe(some, boxes, found[group]);
        });
    if (cancelled(progress)) return cancelledError();
    std::vector<std::array<Vec3f, 2>> across;
    for (const std::vector<ThinWalls>& some : found)
        for (const ThinWalls& walls : some)
            for (const WallLine& line : walls.deciding())
                across.push_back({(line.from - line.inward * (beyondWall * cell)).as<float>(),
                                  (line.from + line.inward * (line.thickness_m + beyondWall * cell)).as<float>()});
    const std::vector<uint8_t> isMet = segmentsThatMeet(mesh, across, progress);
    if (cancelled(progress)) return cancelledError();
    std::vector<ThinPart> all;
    size_t places = 0;
    std::span<const uint8_t> rest = isMet;
    for (const std::vector<ThinWalls>& some : found)
        for (const ThinWalls& walls : some) {
            ThinPart missing = missingOf(walls, rest.first(walls.deciding().size()), cell, places);
            places += missing.places.size();
            if (!missing.places.empty()) all.push_back(std::move(missing));
            rest = rest.subspan(walls.deciding().size());
        }
    std::sort(all.begin(), all.end(), [](const ThinPart& a, const ThinPart& b) { return a.part < b.part; });
    return all;
}

}  // namespace sgm::lower
