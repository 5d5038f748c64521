#include "grammar/lower/thin_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>

#include "grammar/derive/boxes.h"
#include "grammar/derive/lift.h"
#include "grammar/lower/presence.h"
#include "grammar/lower/scope_lines.h"
#include "modeler/core/parallel.h"
#include "modeler/eval/evaluate.h"

namespace sgm::lower {
namespace {

constexpr int fewestSteps = 16, mostSteps = 128;  ///< between the samples on a line
constexpr int halvings = 6;                       ///< of a step around a crossing
constexpr int fewestCrossings = 3;                ///< of a part that isn't buried
constexpr double leastMissing = 0.1;              ///< share of the surface that a part in the list lacks
constexpr double mostlyFree = 0.9;                ///< of the lines through a plate meet both its faces
constexpr double leastMissingArea = 0.2;          ///< share of a plate's area, which is known less well
constexpr double leaningWall = 1.42;              ///< cells that hold a wall of any plan or a shell are thinner by this
constexpr size_t partsPerGroup = 64;              ///< of a parallel loop
constexpr size_t partsPerTape = 8;                ///< that are shortened from one tape
constexpr double probed = 1.1 * lineReach;        ///< of a scope: where its part is looked for

/// Points as the evaluation takes them.
struct Rows {
    std::vector<float> x, y, z;
    void clear() { x.clear(), y.clear(), z.clear(); }
    void add(Vec3f p) { x.push_back(p.x), y.push_back(p.y), z.push_back(p.z); }
    Vec3f operator[](size_t i) const { return {x[i], y[i], z[i]}; }
    eval::Points points() const { return {x.data(), y.data(), z.data(), x.size()}; }
};

/// A thin part, and the share of its surface that the mesh lacks; 0 where it is buried.
struct Candidate {
    OriginId part = 0;
    const derive::Scope* scope = nullptr;
    double wall_m = 0;  ///< thickness of its walls or shell, where these are what is thin; else 0
    double missing = 0;
    bool isWhole = false;  ///< told by the mesh alone
    int plateAxis = -1;    ///< across it, where the scope is thin along one axis alone
    double facing_m2 = 0;  ///< of a plate: what its triangles in the mesh cover, seen across it
};

/// The one axis along which a scope is thin; −1 for bars and for what is thin all over.
int plateAxis(const derive::Scope& scope, double cell_m) {
    int found = -1;
    for (int axis = 0; axis < 3; ++axis) {
        if (!(scope.size[axis] < cell_m || scope.size[axis] == minComponent(scope.size))) continue;
        if (found >= 0) return -1;
        found = axis;
    }
    return found;
}

/// Both faces of a plate.
double facesOf(const derive::Scope& scope, int axis) {
    return 2 * scope.size[(axis + 1) % 3] * scope.size[(axis + 2) % 3];
}

/// Sets `facing_m2` of all plates.
void measureFacing(const mesh::Mesh& mesh, std::span<Candidate> parts, size_t partCount) {
    std::vector<Candidate*> of(partCount, nullptr);
    for (Candidate& c : parts)
        if (c.plateAxis >= 0) of[c.part] = &c;
    std::vector<const Vec3f*> positions;
    positions.reserve(mesh.vertexCount());
    for (const mesh::Chunk& c : mesh.chunks)
        for (const Vec3f& p : c.positions) positions.push_back(&p);
    for (const mesh::Chunk& c : mesh.chunks)
        for (size_t t = 0; t < c.origins.size(); ++t) {
            Candidate* const plate = of[c.origins[t]];
            if (!plate) continue;
            const mesh::Triangle corners = c.inMesh(c.triangles[t]);
            const Vec3f p = *positions[corners[0]];
            const Vec3d twice = cross(*positions[corners[1]] - p, *positions[corners[2]] - p).as<double>();
            Vec3d across{};
            across[plate->plateAxis] = 1;
            plate->facing_m2 += 0.5 * std::abs(dot(twice, plate->scope->axes * across));
        }
}

/// Orders parts so that halves of the list, and halves of these, lie beside each other. O(n log² n).
void orderByPlace(std::span<Candidate> parts) {
    if (parts.size() <= partsPerTape) return;
    Box3d box;
    for (const Candidate& c : parts) box = hull(box, c.scope->centre);
    const Vec3d size = box.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const auto middle = parts.begin() + static_cast<ptrdiff_t>(parts.size() / 2);
    std::nth_element(parts.begin(), middle, parts.end(), [&](const Candidate& a, const Candidate& b) {
        return std::pair(a.scope->centre[axis], a.part) < std::pair(b.scope->centre[axis], b.part);
    });
    orderByPlace(parts.first(parts.size() / 2));
    orderByPlace(parts.subspan(parts.size() / 2));
}

/// One worker's.
class Prober {
public:
    Prober(const eval::Tape& tape, const Presence& presence, float cell_m)
        : tape_(tape), presence_(presence), cell_m_(static_cast<double>(cell_m)) {}

    /// Looks for at most partsPerGroup parts that lie beside each other. The tape is shortened to all, to some of them
    /// and to each: ranges of boxes side by side cost little more than one.
    void probe(std::span<Candidate> parts) {
        const Box3f all = boxAround(parts);
        shortenTo(tape_, {&all, 1}, {&group_, 1});
        if (group_.isEmpty) return;
        std::array<Box3f, partsPerGroup / partsPerTape> boxes;
        const size_t count = (parts.size() + partsPerTape - 1) / partsPerTape;
        const auto some = [&](size_t k) {
            return parts.subspan(k * partsPerTape, std::min(partsPerTape, parts.size() - k * partsPerTape));
        };
        for (size_t k = 0; k < count; ++k) boxes[k] = boxAround(some(k));
        shortenTo(group_.tape, {boxes.data(), count}, some_);
        for (size_t k = 0; k < count; ++k)
            if (!some_[k].isEmpty) probeEach(some(k), some_[k].tape);
    }

private:
    /// A tape for a box.
    struct Local {
        eval::Tape tape;
        bool isEmpty = true;  ///< no surface may be there
    };

    static Box3f boxAround(std::span<const Candidate> parts) {
        Box3f box;
        for (const Candidate& c : parts) box = hull(box, boxOf(*c.scope, probed).as<float>());
        return box;
    }

    void probeEach(std::span<Candidate> parts, const eval::Tape& tape) {
        std::array<Box3f, partsPerTape> boxes;
        for (size_t i = 0; i < parts.size(); ++i) boxes[i] = boxOf(*parts[i].scope, probed).as<float>();
        shortenTo(tape, {boxes.data(), parts.size()}, each_);
        for (size_t i = 0; i < parts.size(); ++i)
            if (!each_[i].isEmpty) parts[i].missing = missing(parts[i], each_[i].tape);
    }

    double missing(const Candidate& candidate, const eval::Tape& tape) {
        const OriginId part = candidate.part;
        findCrossings(candidate, tape);
        if (inside_.empty()) return 0;
        // Where another part's surface is the same, a mesh may have it as that part's.
        owners_.resize(middles_.x.size()), tied_.resize(owners_.size()), labels_.resize(owners_.size());
        eval::evaluateOrigin(tape, middles_.points(), owners_.data(), workspace_);
        eval::evaluateLabels(tape, middles_.points(), labels_.data(), tied_.data(), workspace_);
        int met = 0, lacks = 0;
        for (size_t i = 0; i < owners_.size(); ++i) {
            if (owners_[i] != part || tied_[i] != part) continue;
            ++met, lacks += !presence_.isNear(middles_[i], part);
        }
        if (met < fewestCrossings) return 0;
        return std::max(static_cast<double>(lacks) / met, missingOfPlate(candidate, met));
    }

    /// What the mesh lacks of a plate that stands free, by area: of a turned one it may show posts, which lie so near
    /// to each other that there are triangles everywhere. 0 for other parts.
    double missingOfPlate(const Candidate& candidate, int met) const {
        if (candidate.plateAxis < 0) return 0;
        int lines = 0;
        eachLine(*candidate.scope, cell_m_, [&](Vec3d, int) { return ++lines, true; });
        const double free = met / (2.0 * lines);
        const double lacks = 1 - candidate.facing_m2 / (free * facesOf(*candidate.scope, candidate.plateAxis));
        return free < mostlyFree || lacks < leastMissingArea ? 0 : lacks;
    }

    /// Leaves in `to` what matters in each box.
    void shortenTo(const eval::Tape& from, std::span<const Box3f> boxes, std::span<Local> to) {
        std::array<eval::FloatInterval, partsPerGroup> ranges;
        const eval::RangeTrace trace =
            eval::evaluateRanges(from, {boxes.data(), boxes.size()}, ranges.data(), workspace_);
        for (size_t i = 0; i < boxes.size(); ++i) {
            to[i].isEmpty = ranges[i].lo > 0 || ranges[i].hi < 0;
            if (!to[i].isEmpty) eval::shorten(from, trace, i, workspace_, to[i].tape);
        }
    }

    /// Where lines through the scope along its thin axes cross the field's surface.
    void findCrossings(const Candidate& candidate, const eval::Tape& tape) {
        const derive::Scope& scope = *candidate.scope;
        const double wall_m = candidate.wall_m;
        const int steps = wall_m > 0 ? static_cast<int>(std::clamp(std::ceil(2 * scope.size.y / wall_m),
                                                                   double{fewestSteps}, double{mostSteps}))
                                     : fewestSteps;
        rows_.clear();
        const auto add = [&](Vec3d share, int axis) {
            for (int s = 0; s <= steps; ++s) {
                share[axis] = lineReach * (2.0 * s / steps - 1);
                rows_.add(scope.point(share).as<float>());
            }
            return true;
        };
        if (wall_m > 0)
            eachUprightLine(scope, wall_m, [&](Vec3d share) { add(share, 1); });
        else
            eachLine(scope, cell_m_, add);
        evaluate(rows_, tape);
        inside_.clear(), outside_.clear();
        for (size_t i = 0; i + 1 < values_.size(); ++i) {
            if ((i + 1) % static_cast<size_t>(steps + 1) == 0 || (values_[i] < 0) == (values_[i + 1] < 0)) continue;
            inside_.push_back(rows_[values_[i] < 0 ? i : i + 1]), outside_.push_back(rows_[values_[i] < 0 ? i + 1 : i]);
        }
        for (int halving = 0; halving < halvings && !inside_.empty(); ++halving) {
            middles_.clear();
            for (size_t i = 0; i < inside_.size(); ++i) middles_.add((inside_[i] + outside_[i]) * 0.5f);
            evaluate(middles_, tape);
            for (size_t i = 0; i < inside_.size(); ++i) (values_[i] < 0 ? inside_ : outside_)[i] = middles_[i];
        }
    }
    void evaluate(const Rows& rows, const eval::Tape& tape) {
        values_.resize(rows.x.size());
        eval::evaluate(tape, rows.points(), values_.data(), workspace_);
    }

    const eval::Tape& tape_;
    const Presence& presence_;
    const double cell_m_;
    Local group_;
    std::array<Local, partsPerGroup / partsPerTape> some_;
    std::array<Local, partsPerTape> each_;
    eval::Workspace workspace_;
    Rows rows_, middles_;
    std::vector<float> values_;
    std::vector<OriginId> owners_, tied_;  ///< at the middles; where several tie, the first of them in `tied_`
    std::vector<uint32_t> labels_;
    std::vector<Vec3f> inside_, outside_;
};

/// The largest cells that hold a thin scope. Along the axes a sample lies in whatever is as thick as a cell; what is
/// turned needs more.
double cellThatHolds(const derive::Scope& scope) {
    double least = minComponent(scope.size);
    double most = 1;
    for (int axis = 0; axis < 3; ++axis) {
        if (scope.size[axis] > 1.01 * least) continue;
        const Vec3d d = scope.axes * Vec3d{axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0, axis == 2 ? 1.0 : 0.0};
        most = std::max(most, std::abs(d.x) + std::abs(d.y) + std::abs(d.z));
    }
    return least / most;
}

/// The least thickness of walls and shells that a solid's parameters say, metres; infinite where they say none.
double wallOf(const derive::SolidValue& solid) {
    double least = INFINITY;
    if (!solid.primitive) return least;
    const std::span<const field::PrimitiveParameter> row = solid.primitive->parameters;
    for (size_t i = 0; i < row.size() && i < solid.args.size(); ++i)
        if (row[i].isThickness && solid.args[i].num() > 0) least = std::min(least, solid.args[i].num());
    return least;
}

}  // namespace

Result<std::vector<ThinPart>> findMissingParts(const derive::Derivation& derivation, const Model& model,
                                               const eval::Tape& tape, const mesh::Mesh& mesh, float cell_m,
                                               int threads, Progress* progress, const std::vector<ThinPart>* among) {
    const auto cell = static_cast<double>(cell_m);
    std::vector<Candidate> thin;
    std::deque<derive::Scope> scopes;  // where they stand on hills; a deque, for references stay
    std::vector<bool> isThin(model.shapeOf.size());
    const auto look = [&](OriginId part) {
        if (model.shapeOf[part] == derive::none) return;
        const derive::Shape& shape = derivation.tree.shapes[model.shapeOf[part]];
        if (shape.solid == derive::none) return;
        const bool isFlat = cellThatHolds(shape.scope) < cell;
        const double wall_m = isFlat ? 0 : wallOf(derivation.tree.solids[shape.solid]);
        if (!isFlat && !(wall_m / leaningWall < cell)) return;
        scopes.push_back(derive::liftedScope(derivation, model.shapeOf[part]));
        thin.push_back({part, &scopes.back(), wall_m});
        if (isFlat) thin.back().plateAxis = plateAxis(scopes.back(), cell);
        isThin[part] = true;
    };
    if (among)
        for (const ThinPart& part : *among) look(part.part);
    else
        for (OriginId part = 1; part < model.shapeOf.size(); ++part) look(part);
    if (thin.empty() || mesh.hasPositionsOnly()) return std::vector<ThinPart>{};
    const Presence presence(mesh, isThin, cell_m);
    measureFacing(mesh, thin, model.shapeOf.size());
    parallelFor(thin.size(), threads, nullptr, [&](size_t i, int) {
        const derive::Scope& scope = *thin[i].scope;
        const int axis = thin[i].plateAxis;
        const bool covers = axis < 0 || thin[i].facing_m2 >= (1 - leastMissingArea) * facesOf(scope, axis);
        thin[i].isWhole = thin[i].wall_m == 0 && covers && presence.isWhole(scope, thin[i].part, cell);
    });
    std::erase_if(thin, [](const Candidate& c) { return c.isWhole; });
    orderByPlace(thin);
    std::vector<Prober> probers;
    probers.reserve(static_cast<size_t>(threadCount(threads)));
    for (int w = 0; w < threadCount(threads); ++w) probers.emplace_back(tape, presence, cell_m);
    if (progress) progress->begin("thin parts", thin.size());
    const size_t groups = (thin.size() + partsPerGroup - 1) / partsPerGroup;
    parallelFor(groups, threads, progress, [&](size_t group, int worker) {
        const std::span<Candidate> all(thin);
        const auto of =
            all.subspan(group * partsPerGroup, std::min(partsPerGroup, thin.size() - group * partsPerGroup));
        probers[static_cast<size_t>(worker)].probe(of);
        for (size_t i = 0; i < of.size(); ++i) tick(progress);
    });
    if (cancelled(progress)) return cancelledError();
    std::sort(thin.begin(), thin.end(), [](const Candidate& a, const Candidate& b) { return a.part < b.part; });
    std::vector<ThinPart> found;
    for (const Candidate& c : thin) {
        if (!(c.missing > leastMissing)) continue;
        const bool wall = c.wall_m > 0;
        found.push_back({c.part, wall ? c.wall_m : minComponent(c.scope->size),
                         wall ? c.wall_m / leaningWall : cellThatHolds(*c.scope), c.missing});
    }
    return found;
}

}  // namespace sgm::lower
