#include "grammar/lower/thin_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "grammar/derive/boxes.h"
#include "grammar/derive/lift.h"
#include "grammar/lower/face_points.h"
#include "grammar/lower/mesh_positions.h"
#include "grammar/lower/missing_sections.h"
#include "grammar/lower/presence.h"
#include "grammar/lower/scope_lines.h"
#include "grammar/lower/thin_sections.h"
#include "grammar/lower/thin_walls.h"
#include "modeler/core/parallel.h"
#include "modeler/eval/evaluate.h"
#include "modeler/eval/local_tapes.h"

namespace sgm::lower {
namespace {

constexpr int steps = 16;                  ///< between the samples on a line
constexpr int halvings = 6;                ///< of a step around a crossing
constexpr size_t fewestCrossings = 3;      ///< of a part that isn't buried
constexpr double leastMissing = 0.04;      ///< share of the surface that a part in the list lacks
constexpr double leastOfBounded = 0.02;    ///< the same where halving ended at the bound of triangles
constexpr double mostlyFree = 0.9;         ///< of the lines through a plate meet both its faces
constexpr double leastMissingArea = 0.01;  ///< share of the area of a plate that stands free
constexpr double leastFacing = 0.7;        ///< cosine between a plate's faces and what isn't a torn edge
constexpr double unsureArea = 4;           ///< more of that for each share of the lines that meet no face of the plate
constexpr double mostUnsure = 0.25;        ///< at most
constexpr double leastOfFaces = 0.03;      ///< the same of faces that are covered in part
constexpr double leastExposed = 0.05;      ///< share of a bounded part's faces that has to be its surface
constexpr double besideFace = 0.04;        ///< of half an extent: where either side of a face is looked at, at most
constexpr double besideCells = 0.1;        ///< cells: the same
constexpr FacePoints roughly{16, 64}, closely{256, 1024}, atBorders{1024, 8192, 0.25, true};
constexpr double leastRoughly = 0.7;        ///< share of a face that has to be free to be looked at closely
constexpr float reachCells = 0.4375f;       ///< a part's mesh is so near to where the field has its surface
constexpr float tornShare = 0.08f;          ///< of a round part's thickness: its mesh is so near
constexpr double roundCells = 2;            ///< the thickness from which cells follow a round part
constexpr float leastReachCells = 0.055f;   ///< however thin it is
constexpr double leastAcross = 0.0625;      ///< cells: a plate that moves by less across them lies along the grid
constexpr double probed = 1.1 * lineReach;  ///< of a scope: where its part is looked for

/// A thin part, and the share of its surface that the mesh lacks; 0 where it is buried.
struct Candidate {
    OriginId part = 0;
    derive::Scope scope;
    double missing = 0;
    bool isBox = false;      ///< its faces are those of its scope
    bool isBounded = false;  ///< cells around it are larger than it needs
    bool isPresent = false;  ///< along every line through the scope, by the mesh alone
    bool isWhole = false;    ///< told by the mesh alone
    int plateAxis = -1;      ///< across it, where the scope is thin along one axis alone
    /// What its triangles in the mesh cover, seen along axes of the scope.
    std::array<double, 3> facing_m2{};

    Vec3d centre() const { return scope.centre; }
    OriginId number() const { return part; }
};

/// The one axis along which a scope is thin; −1 for bars and for what is thin all over.
int plateAxis(const derive::Scope& scope, double cell_m) {
    int found = -1;
    for (int axis = 0; axis < 3; ++axis) {
        if (!isThinAlong(scope, axis, cell_m)) continue;
        if (found >= 0) return -1;
        found = axis;
    }
    return found;
}

/// Whether a plate lies across layers of cells, so that the mesh may have it in some of them alone.
bool isTurned(const Candidate& plate, double cell_m) {
    const int axis = plate.plateAxis;
    const Vec3d across = plate.scope.axes * alongAxis(axis);
    const double along = std::max({std::abs(across.x), std::abs(across.y), std::abs(across.z)});
    const double longest_m = std::hypot(plate.scope.size[(axis + 1) % 3], plate.scope.size[(axis + 2) % 3]);
    return longest_m * std::sqrt(std::max(0.0, 1 - along * along)) > leastAcross * cell_m;
}

/// Both faces of a plate.
double facesOf(const derive::Scope& scope, int axis) {
    return 2 * scope.size[(axis + 1) % 3] * scope.size[(axis + 2) % 3];
}

/// Sets `facing_m2` of all plates.
void measureFacing(const mesh::Mesh& mesh, std::span<Candidate> parts, size_t partCount) {
    std::vector<Candidate*> of(partCount, nullptr);
    for (Candidate& c : parts)
        if (c.plateAxis >= 0 || c.isBox) of[c.part] = &c;
    const std::vector<const Vec3f*> positions = positionsOf(mesh);
    for (const mesh::Chunk& c : mesh.chunks)
        for (size_t t = 0; t < c.origins.size(); ++t) {
            Candidate* const part = of[c.origins[t]];
            if (!part) continue;
            const mesh::Triangle corners = c.inMesh(c.triangles[t]);
            const Vec3f p = *positions[corners[0]];
            const Vec3d twice = cross(*positions[corners[1]] - p, *positions[corners[2]] - p).as<double>();
            for (int axis = 0; axis < 3; ++axis) {
                const double across = std::abs(dot(twice, part->scope.axes * alongAxis(axis)));
                if (across > leastFacing * length(twice)) part->facing_m2[static_cast<size_t>(axis)] += 0.5 * across;
            }
        }
}

/// One worker's.
class Prober {
public:
    Prober(const eval::Tape& tape, const Presence& presence, float cell_m)
        : tapes_(tape), presence_(presence), cell_m_(static_cast<double>(cell_m)) {}

    /// Looks for at most eval::LocalTapes::mostBoxes parts that lie beside each other.
    void probe(std::span<Candidate> parts, std::span<const Box3f> boxes) {
        tapes_.visit(boxes, [&](size_t i, const eval::Tape& tape) { parts[i].missing = missing(parts[i], tape); });
    }

    /// What eachLine passes: no more, for what else is near makes the shortened tape longer.
    Box3f boxOf(const Candidate& candidate) const {
        derive::Scope scope = candidate.scope;
        for (int axis = 0; axis < 3; ++axis)
            if (candidate.isBox || isThinAlong(candidate.scope, axis, cell_m_)) scope.size[axis] *= probed;
        return derive::boxOf(scope).as<float>();
    }
    eval::LocalTapes& tapes() { return tapes_; }

private:
    double missing(const Candidate& candidate, const eval::Tape& tape) {
        const OriginId part = candidate.part;
        const double ofFaces = candidate.isBox ? missingOfFaces(candidate, tape) : 0;
        if (candidate.isPresent) return ofFaces;
        findCrossings(candidate, tape);
        if (inside_.empty()) return ofFaces;
        const std::vector<OriginId>& owners = owners_.at(middles_, tape, tapes_.workspace());
        size_t met = 0, lacks = 0;
        for (size_t i = 0; i < owners.size(); ++i) {
            if (owners[i] != part) continue;
            ++met, lacks += presence_.isNear(middles_[i], part) ? 0 : 1;
        }
        if (met < fewestCrossings) return ofFaces;
        const double ofLines = static_cast<double>(lacks) / static_cast<double>(met);
        return std::max(ofLines > (candidate.isBounded ? leastOfBounded : leastMissing) ? ofLines : 0,
                        candidate.isBox ? ofFaces : missingOfPlate(candidate, met));
    }

    /// What the mesh lacks of a box's faces that are mostly free, by area: the strips of a bar that stand out of a pane
    /// are so near to other triangles of it that these don't tell.
    double missingOfFaces(const Candidate& candidate, const eval::Tape& tape) {
        double most = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const double covered = candidate.facing_m2[static_cast<size_t>(axis)] / facesOf(candidate.scope, axis);
            if (covered >= 1 - leastMissingArea) continue;
            if (candidate.isBounded) {  // where the mesh is tells more of a part with openings than its area does
                const double exposed = exposedShare(candidate, axis, tape, closely), lacks = awayShare(candidate.part);
                if (exposed >= leastExposed && lacks >= leastOfBounded) most = std::max(most, lacks);
                continue;
            }
            if (exposedShare(candidate, axis, tape, roughly) < leastRoughly) continue;
            // Points that lie closer see what of the borders is buried, as of a door in its frame.
            if (lackedOfFace(candidate, axis, covered, tape, closely) > 0)
                most = std::max(most, lackedOfFace(candidate, axis, covered, tape, atBorders));
        }
        return most;
    }

    /// The share of a face that is free, but not covered; 0 where too little of it is free, or nearly all is covered.
    double lackedOfFace(const Candidate& candidate, int axis, double covered, const eval::Tape& tape,
                        const FacePoints& points) {
        const double exposed = exposedShare(candidate, axis, tape, points), lacks = 1 - covered / exposed;
        return exposed >= mostlyFree && lacks >= (exposed < 1 ? leastOfFaces : leastMissingArea) ? lacks : 0;
    }

    /// The share of both faces across an axis that is the part's own surface.
    double exposedShare(const Candidate& candidate, int axis, const eval::Tape& tape, const FacePoints& points) {
        const derive::Scope& scope = candidate.scope;
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        const auto [alongU, alongV] = points.counts(scope, u, v, cell_m_);
        const double beside = std::min(besideFace, 2 * besideCells * cell_m_ / scope.size[axis]);
        rows_.clear(), middles_.clear();
        for (const double side : {-1.0, 1.0})
            for (int j = 0; j < alongV; ++j)
                for (int i = 0; i < alongU; ++i) {
                    Vec3d share{};
                    share[u] = points.place(i, alongU), share[v] = points.place(j, alongV);
                    share[axis] = side;
                    middles_.add(scope.point(share).as<float>());
                    for (const double way : {-beside, beside}) {
                        share[axis] = side * (1 + way);
                        rows_.add(scope.point(share).as<float>());
                    }
                }
        evaluate(rows_, tape);
        const std::vector<OriginId>& owners = owners_.at(middles_, tape, tapes_.workspace());
        exposed_.clear();
        for (size_t i = 0; i < owners.size(); ++i)
            if (values_[2 * i] < 0 && values_[2 * i + 1] >= 0 && owners[i] == candidate.part)
                exposed_.push_back(middles_[i]);
        return static_cast<double>(exposed_.size()) / static_cast<double>(owners.size());
    }

    /// The share of what exposedShare() found last that the mesh isn't near.
    double awayShare(OriginId part) const {
        const auto isAway = [&](Vec3f p) { return !presence_.isNear(p, part); };
        const auto away = std::count_if(exposed_.begin(), exposed_.end(), isAway);
        return static_cast<double>(away) / static_cast<double>(exposed_.size());
    }

    /// What the mesh lacks of a plate that stands free, by area: of a turned one it may show posts, which lie so near
    /// to each other that there are triangles everywhere. 0 for other parts.
    double missingOfPlate(const Candidate& candidate, size_t met) const {
        if (candidate.plateAxis < 0) return 0;
        int lines = 0;
        eachLine(candidate.scope, cell_m_, [&](Vec3d, int) { return ++lines, true; });
        const double free = static_cast<double>(met) / (2.0 * lines);
        const double lacks = 1 - candidate.facing_m2[static_cast<size_t>(candidate.plateAxis)] /
                                     (free * facesOf(candidate.scope, candidate.plateAxis));
        const double least = std::min(leastMissingArea + unsureArea * (1 - std::min(free, 1.0)), mostUnsure);
        return free < mostlyFree || lacks < least ? 0 : lacks;
    }

    /// Where lines through the scope along its thin axes cross the field's surface.
    void findCrossings(const Candidate& candidate, const eval::Tape& tape) {
        const derive::Scope& scope = candidate.scope;
        rows_.clear();
        const auto add = [&](Vec3d share, int axis) {
            for (int s = 0; s <= steps; ++s) {
                share[axis] = lineReach * (2.0 * s / steps - 1);
                rows_.add(scope.point(share).as<float>());
            }
            return true;
        };
        eachLine(scope, cell_m_, add);
        evaluate(rows_, tape);
        inside_.clear(), outside_.clear();
        for (size_t i = 0; i + 1 < values_.size(); ++i) {
            if ((i + 1) % size_t{steps + 1} == 0 || (values_[i] < 0) == (values_[i + 1] < 0)) continue;
            inside_.push_back(rows_[values_[i] < 0 ? i : i + 1]), outside_.push_back(rows_[values_[i] < 0 ? i + 1 : i]);
        }
        for (int halving = 0; halving < halvings && !inside_.empty(); ++halving) {
            middles_.clear();
            for (size_t i = 0; i < inside_.size(); ++i) middles_.add((inside_[i] + outside_[i]) * 0.5f);
            evaluate(middles_, tape);
            for (size_t i = 0; i < inside_.size(); ++i) (values_[i] < 0 ? inside_ : outside_)[i] = middles_[i];
        }
    }
    void evaluate(const eval::PointList& rows, const eval::Tape& tape) {
        values_.resize(rows.size());
        eval::evaluate(tape, rows.points(), values_.data(), tapes_.workspace());
    }

    eval::LocalTapes tapes_;
    const Presence& presence_;
    double cell_m_;
    eval::PointList rows_, middles_;
    std::vector<float> values_;
    eval::SurfaceOwners owners_;
    std::vector<Vec3f> inside_, outside_, exposed_;
};

/// The parts that cells of `held_m` don't hold, where they stand on hills; `cell` is the mesh's.
std::vector<Candidate> thinParts(const derive::Derivation& derivation, const Model& model, double held_m, double cell,
                                 const std::vector<ThinPart>* among) {
    std::vector<bool> isWanted(model.shapeOf.size(), !among), areBounded(model.shapeOf.size());
    if (among)
        for (const ThinPart& part : *among)
            if (part.kind == ThinPart::Kind::Part) isWanted[part.part] = true, areBounded[part.part] = part.isBounded;
    std::vector<Candidate> thin;
    for (OriginId part = 1; part < model.shapeOf.size(); ++part) {
        if (model.shapeOf[part] == derive::none || !isWanted[part]) continue;
        const derive::Shape& shape = derivation.tree.shapes[model.shapeOf[part]];
        if (shape.solid == derive::none) continue;
        if (!(cellThatHolds(shape.scope) < held_m)) continue;
        thin.push_back({.part = part, .scope = derive::liftedScope(derivation, model.shapeOf[part])});
        thin.back().plateAxis = plateAxis(thin.back().scope, cell);
        thin.back().isBounded = areBounded[part];
        thin.back().isBox = isBox(derivation.tree.solids[shape.solid], shape.scope);
    }
    return thin;
}

/// Measures what the mesh lacks of each part; leaves out those that it shows whole.
void probeParts(std::vector<Candidate>& thin, const eval::Tape& tape, const Presence& presence, float cell_m,
                int threads, Progress* progress) {
    parallelFor(thin.size(), threads, nullptr, [&](size_t i, int) {
        Candidate& part = thin[i];
        bool covers = true;
        for (int axis = 0; axis < 3; ++axis)
            if (part.isBox || axis == part.plateAxis)
                covers = covers && part.facing_m2[static_cast<size_t>(axis)] >=
                                       (1 - leastMissingArea) * facesOf(part.scope, axis);
        part.isPresent = presence.isWhole(part.scope, part.part, static_cast<double>(cell_m)) && (covers || part.isBox);
        part.isWhole = part.isPresent && covers;
    });
    std::erase_if(thin, [](const Candidate& c) { return c.isWhole; });
    eval::orderByPlace(std::span(thin));
    eval::probeInGroups(
        std::span(thin), threads, progress, "thin parts", [&] { return Prober(tape, presence, cell_m); },
        [](Prober& prober, std::span<Candidate> some, std::span<const Box3f> boxes, size_t) {
            prober.probe(some, boxes);
        });
}

/// Knows where the mesh has the parts, and what is at the sections.
Presence presenceOf(const mesh::Mesh& mesh, std::span<const Candidate> thin, std::span<const ThinSection> sections,
                    size_t partCount, float cell_m, int threads) {
    using Extent = Presence::Query::Extent;
    std::vector<Presence::Query> queries(partCount);
    const float reach_m = reachCells * cell_m;
    std::vector<Vec3f> points;
    for (const ThinSection& section : sections)
        for (const ThinSection::Line& line : section.lines)
            for (const ThinSection::Crossing& end : line.ends) {
                queries[end.owner] = {Extent::NearPoints, reach_m};
                points.push_back(end.at);
            }
    for (const Candidate& c : thin) queries[c.part] = {Extent::All, reach_m};
    return Presence(mesh, queries, points, cell_m, threads);
}

std::vector<ThinPart> lackedOf(std::span<const Candidate> thin) {
    std::vector<ThinPart> found;
    for (const Candidate& c : thin) {
        if (!(c.missing > 0)) continue;
        found.push_back({.part = c.part, .missing = c.missing, .places = {c.scope}});
        found.back().thickness_m = minComponent(c.scope.size), found.back().cell_m = cellThatHolds(c.scope);
    }
    return found;
}

}  // namespace

Result<std::vector<ThinPart>> findTornParts(const derive::Derivation& derivation, const Model& model,
                                            const eval::Tape& tape, const mesh::Mesh& mesh, float cell_m, int threads,
                                            Progress* progress, const std::vector<ThinPart>* among) {
    const auto cell = static_cast<double>(cell_m);
    std::vector<Candidate> thin = thinParts(derivation, model, roundCells * cell, cell, among);
    std::erase_if(thin, [&](const Candidate& c) {
        // Of plates along the grid the mesh has each whole, or not at all.
        if (c.isBox) return !(cellThatHolds(c.scope) < cell) || (c.plateAxis >= 0 && !isTurned(c, cell));
        const derive::SolidValue& solid = derivation.tree.solids[derivation.tree.shapes[model.shapeOf[c.part]].solid];
        return !solid.primitive || solid.primitive->plan != field::PlanUse::None;
    });
    if (thin.empty() || mesh.hasPositionsOnly()) return std::vector<ThinPart>{};
    std::vector<Presence::Query> queries(model.shapeOf.size());
    for (const Candidate& c : thin)
        queries[c.part] = {Presence::Query::Extent::All,
                           std::clamp(tornShare * static_cast<float>(minComponent(c.scope.size)),
                                      leastReachCells * cell_m, reachCells * cell_m)};
    const Presence presence(mesh, queries, {}, cell_m, threads);
    measureFacing(mesh, thin, model.shapeOf.size());
    probeParts(thin, tape, presence, cell_m, threads, progress);
    if (cancelled(progress)) return cancelledError();
    return lackedOf(thin);
}

Result<std::vector<ThinPart>> findMissingParts(const derive::Derivation& derivation, const Model& model,
                                               const eval::Tape& tape, const mesh::Mesh& mesh, float cell_m,
                                               int threads, Progress* progress, const std::vector<ThinPart>* among) {
    if (mesh.hasPositionsOnly()) return std::vector<ThinPart>{};
    const auto cell = static_cast<double>(cell_m);
    std::vector<Candidate> thin = thinParts(derivation, model, cell, cell, among);
    const auto sections = findThinSections(derivation, model, tape, cell_m, threads, progress, among);
    if (!sections.ok()) return sections.error();
    auto walls = findMissingWalls(derivation, model, tape, mesh, cell_m, threads, progress, among);
    if (!walls.ok() || (thin.empty() && sections->empty())) return walls;
    const Presence presence = presenceOf(mesh, thin, *sections, model.shapeOf.size(), cell_m, threads);
    measureFacing(mesh, thin, model.shapeOf.size());
    probeParts(thin, tape, presence, cell_m, threads, progress);
    if (cancelled(progress)) return cancelledError();
    std::vector<ThinPart> found = lackedOf(thin);
    std::erase_if(found, [&](const ThinPart& whole) {  // its walls are thinner
        const auto wall = std::lower_bound(walls->begin(), walls->end(), whole.part,
                                           [](const ThinPart& w, OriginId part) { return w.part < part; });
        return wall != walls->end() && wall->part == whole.part && wall->isShell;
    });
    std::move(walls->begin(), walls->end(), std::back_inserter(found));
    for (const ThinSection& section : *sections)
        if (auto lacked = missingAt(section, presence, cell)) found.push_back(std::move(*lacked));
    std::sort(found.begin(), found.end(), [](const ThinPart& a, const ThinPart& b) {
        return std::pair(a.part, a.face) < std::pair(b.part, b.face);
    });
    return found;
}

}  // namespace sgm::lower
