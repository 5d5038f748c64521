#include "grammar/pipeline/gaps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include "grammar/derive/boxes.h"
#include "grammar/pipeline/holding_cells.h"
#include "grammar/pipeline/triangle_tree.h"
#include "modeler/eval/evaluate.h"

namespace sgm::pipeline {
namespace {

constexpr size_t mostPieces = 20;

/// A connected surface of the mesh.
struct Surface {
    uint32_t id = 0;
    Box3d box;
    double sixfold_m3 = 0;  ///< negative around air
    std::vector<uint32_t> triangles;
};

/// The nearest points of a floating piece and of everything else.
struct Closest {
    double width_m = 0;
    Vec3d from, to;
    uint32_t ours = 0, theirs = 0;  ///< triangles
};

bool contains(const Box3d& a, const Box3d& b) {
    for (int i = 0; i < 3; ++i)
        if (b.lo[i] < a.lo[i] || b.hi[i] > a.hi[i]) return false;
    return true;
}

class GapFinder {
public:
    explicit GapFinder(const mesh::Mesh& mesh) : mesh_(mesh::flatten(mesh, 0)), tree_(mesh_) {
        std::vector<uint32_t> numberOf(mesh_.positions.size(), TriangleTree::mixed);
        for (uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
            uint32_t& number = numberOf[tree_.surfaceOf(t)];
            if (number == TriangleTree::mixed) {
                number = static_cast<uint32_t>(surfaces_.size());
                surfaces_.push_back({tree_.surfaceOf(t), {}, 0, {}});
            }
            Surface& s = surfaces_[number];
            const Vec3d a = tree_.corner(t, 0), b = tree_.corner(t, 1), c = tree_.corner(t, 2);
            s.box = hull(hull(hull(s.box, a), b), c);
            s.sixfold_m3 += dot(a, cross(b, c));
            s.triangles.push_back(t);
        }
    }

    OriginId originOf(uint32_t triangle) const { return mesh::FlatMesh::originOf(mesh_.keys[triangle]); }

    std::optional<Closest> find(const mesh::ConnectedComponent& piece, double cell_m, Progress* progress) const {
        const Surface* own = surfaceOf(piece);
        if (!own) return {};
        std::set<uint32_t> inside{own->id};  // its cavities aren't others
        for (const Surface& s : surfaces_)
            if (s.sixfold_m3 < 0 && own->sixfold_m3 > 0 && contains(own->box, s.box)) inside.insert(s.id);
        const auto isOther = [&](uint32_t s) { return !inside.contains(s); };
        const auto isOwn = [&](uint32_t s) { return s == own->id; };
        Nearest theirs, ours;
        Vec3d from;
        forPoints(*own, cell_m, progress, [&](Vec3d p) {
            if (theirs.squared_m2 == 0) return;
            const double before = theirs.squared_m2;
            tree_.nearest(p, isOther, theirs);
            if (theirs.squared_m2 < before) from = p;
        });
        if (!std::isfinite(theirs.squared_m2)) return {};
        // From the nearest sample to the nearest point: each side's nearest to the other's in turn.
        for (int i = 0; i < 32; ++i) {
            ours = {}, tree_.nearest(theirs.at, isOwn, ours);
            Nearest next;
            tree_.nearest(ours.at, isOther, next);
            const bool settled = next.squared_m2 > .9999 * theirs.squared_m2;
            theirs = next;
            if (settled) break;
        }
        return Closest{std::sqrt(theirs.squared_m2), ours.at, theirs.at, ours.triangle, theirs.triangle};
    }

private:
    /// The surface that fills the piece's box.
    const Surface* surfaceOf(const mesh::ConnectedComponent& piece) const {
        const Surface* best = nullptr;
        double least = std::numeric_limits<double>::infinity();
        for (const Surface& s : surfaces_) {
            double off = 0;
            for (int i = 0; i < 3; ++i)
                off += std::abs(s.box.lo[i] - static_cast<double>(piece.bounds.lo[i])) +
                       std::abs(s.box.hi[i] - static_cast<double>(piece.bounds.hi[i]));
            if (off < least) least = off, best = &s;
        }
        return best;
    }

    /// Points on the surface, a cell apart, or farther where there would be too many. Stops early when cancelled.
    template <class Visit>
    void forPoints(const Surface& surface, double cell_m, Progress* progress, Visit visit) const {
        constexpr double mostPoints = 50'000;
        const Vec3d size = surface.box.size();
        const double area = 2 * (size.x * size.y + size.y * size.z + size.z * size.x);
        const double step = std::max(cell_m, std::sqrt(area / mostPoints));
        const size_t stride = std::max<size_t>(1, surface.triangles.size() / static_cast<size_t>(mostPoints));
        const auto parts = [&](double length) { return std::clamp(std::ceil(length / step), 1.0, 256.0); };
        for (size_t i = 0; i < surface.triangles.size() && !cancelled(progress); i += stride) {
            // Rows along the longest side: a needle has one or two.
            const uint32_t t = surface.triangles[i];
            Vec3d a = tree_.corner(t, 0), b = tree_.corner(t, 1), c = tree_.corner(t, 2);
            const auto isShort = [&] { return dot(b - a, b - a) < std::max(dot(c - b, c - b), dot(a - c, a - c)); };
            for (int turn = 0; turn < 2 && isShort(); ++turn) std::swap(a, b), std::swap(b, c);
            const double base = length(b - a), height = base > 0 ? length(cross(b - a, c - a)) / base : 0;
            const double rows = parts(height);
            for (double v = 0; v <= rows; ++v) {
                const double left = 1 - v / rows, columns = parts(base * left);
                for (double u = 0; u <= columns; ++u) visit(a + (b - a) * (left * u / columns) + (c - a) * (v / rows));
            }
        }
    }

    mesh::FlatMesh mesh_;
    TriangleTree tree_;
    std::vector<Surface> surfaces_;
};

/// Follows boxes that touch from a floating piece through parts that the mesh lacks to something else.
class ThinLinks {
public:
    /// `missing` has to stay.
    ThinLinks(const Model& model, const std::vector<lower::ThinPart>& missing)
        : model_(model), shapes_(model.derivation.tree.shapes), isMissing_(shapes_.size(), false) {
        for (const lower::ThinPart& part : missing) {
            for (const derive::Scope& place : part.places) places_.push_back(derive::boxOf(place));
            if (part.kind == lower::ThinPart::Kind::Part || part.kind == lower::ThinPart::Kind::Rim)
                missing_.push_back(part);
            if (part.isShell || (part.kind == lower::ThinPart::Kind::Wall && part.face < 0)) addFragmented(part);
        }
        for (size_t i = 0; i < missing_.size(); ++i)
            if (shapeOf(i) != derive::none) isMissing_[shapeOf(i)] = true;
    }

    /// Whether something that the mesh lacks reaches from the piece's box to beyond it, and so may hold it.
    bool reachBeyond(const mesh::ConnectedComponent& piece, double cell_m) const {
        const Box3d around = boxOf(piece).inflated(cell_m);
        return std::any_of(places_.begin(), places_.end(), [&](const Box3d& place) {
            return !intersection(around, place).empty() && !contains(around, place);
        });
    }

    /// The shell, or wall beside a cut, that the piece is a fragment of; null where it is none.
    const lower::ThinPart* findWallOf(const mesh::ConnectedComponent& piece, double cell_m) const {
        const auto isOf = [&](const FragmentedWall& wall) {
            return piece.volume_m3 <= wall.most_m3 && contains(wall.box.inflated(cell_m), boxOf(piece));
        };
        const auto found = std::find_if(fragmented_.begin(), fragmented_.end(), isOf);
        return found == fragmented_.end() ? nullptr : found->part;
    }

    /// The thinnest of the missing parts that hold the piece; null where none does.
    const lower::ThinPart* find(const mesh::ConnectedComponent& piece, double cell_m) const {
        if (missing_.empty() || missing_.size() * shapes_.size() > mostPairs) return nullptr;
        // A shape of the piece may have surface elsewhere, and thin parts there don't hold this one.
        derive::Scope around;
        around.centre = piece.bounds.centre().as<double>();
        around.size = piece.bounds.size().as<double>();
        std::set<derive::ShapeId> own;
        for (const OriginId origin : piece.origins) own.insert(model_.lowered->shapeOf[origin]);
        std::vector<bool> reached(missing_.size(), false);
        std::vector<size_t> open;
        const auto reach = [&](derive::ShapeId from, bool nearPiece) {
            for (size_t i = 0; i < missing_.size(); ++i) {
                if (reached[i] || !touch(from, shapeOf(i))) continue;
                if (nearPiece && !isNear(around, missing_[i], cell_m)) continue;
                reached[i] = true;
                open.push_back(i);
            }
        };
        for (const derive::ShapeId s : own)
            if (s != derive::none && shapes_[s].solid != derive::none) reach(s, true);
        const lower::ThinPart* thinnest = nullptr;
        bool holds = false;
        while (!open.empty()) {
            const size_t i = open.back();
            open.pop_back();
            if (!thinnest || missing_[i].cell_m < thinnest->cell_m) thinnest = &missing_[i];
            for (derive::ShapeId s = 0; s < shapes_.size() && !holds; ++s)
                holds = shapes_[s].solid != derive::none && s != shapeOf(i) && !own.contains(s) && !isMissing_[s] &&
                        touch(s, shapeOf(i));
            reach(shapeOf(i), false);
        }
        return holds ? thinnest : nullptr;
    }

private:
    static constexpr size_t mostPairs = 2'000'000;

    /// A shell, or wall beside a cut, that may be there in fragments.
    struct FragmentedWall {
        const lower::ThinPart* part = nullptr;
        Box3d box;
        double most_m3 = 0;  ///< of a fragment
    };

    static Box3d boxOf(const mesh::ConnectedComponent& piece) {
        return {piece.bounds.lo.as<double>(), piece.bounds.hi.as<double>()};
    }

    void addFragmented(const lower::ThinPart& part) {
        FragmentedWall wall{&part, {}, 0};
        for (const derive::Scope& place : part.places) {
            wall.box = hull(wall.box, derive::boxOf(place));
            wall.most_m3 += place.size.x * place.size.y * place.size.z;
        }
        fragmented_.push_back(wall);
    }

    /// Whether a part comes so near to a piece: by its scope, and a shell, which is hollow, by one of its walls.
    bool isNear(const derive::Scope& piece, const lower::ThinPart& part, double cell_m) const {
        const auto isWithin = [&](const derive::Scope& s) { return derive::penetration(piece, s) >= -cell_m; };
        return part.isShell ? std::any_of(part.places.begin(), part.places.end(), isWithin)
                            : isWithin(shapes_[model_.lowered->shapeOf[part.part]].scope);
    }

    derive::ShapeId shapeOf(size_t i) const { return model_.lowered->shapeOf[missing_[i].part]; }
    bool touch(derive::ShapeId a, derive::ShapeId b) const {
        return derive::penetration(shapes_[a].scope, shapes_[b].scope) >= -derive::boxSlack_m;
    }

    const Model& model_;
    const derive::Shapes& shapes_;
    std::vector<lower::ThinPart> missing_;  ///< whole parts
    std::vector<Box3d> places_;             ///< of all
    std::vector<FragmentedWall> fragmented_;
    std::vector<bool> isMissing_;  ///< by shape
};

/// The field around a place, an eighth of a cell apart, and which of its nodes hang together.
class Surroundings {
public:
    Surroundings(const eval::Tape& tape, Vec3d middle, double cell_m)
        : low_(middle - Vec3d{2, 2, 2} * cell_m), step_m_(4 * cell_m / (side - 1)) {
        std::vector<float> x, y, z, values(nodes);
        for (int i = 0; i < nodes; ++i) {
            const Vec3f p = at(i).as<float>();
            x.push_back(p.x), y.push_back(p.y), z.push_back(p.z);
        }
        // What matters near here is a small part of a large field.
        eval::Workspace workspace;
        eval::Tape local;
        eval::FloatInterval range{};
        const Box3f box = Box3d{low_, low_ + Vec3d{4, 4, 4} * cell_m}.as<float>();
        const eval::RangeTrace trace = eval::evaluateRanges(tape, {&box, 1}, &range, workspace);
        eval::shorten(tape, trace, 0, workspace, local);
        eval::evaluate(local, {x.data(), y.data(), z.data(), nodes}, values.data(), workspace);
        for (const float v : values) solid_.push_back(v < 0);
    }

    /// Whether solid leads from about one point to about the other.
    bool joins(Vec3d from, Vec3d to) const {
        const int begin = nearestSolid(from), end = nearestSolid(to);
        if (begin < 0 || end < 0) return false;
        std::vector<bool> seen(nodes, false);
        std::vector<int> open{begin};
        seen[static_cast<size_t>(begin)] = true;
        while (!open.empty()) {
            const int node = open.back();
            open.pop_back();
            if (node == end) return true;
            for (const int stride : {1, side, side * side})
                for (const int way : {-1, 1}) {
                    const int place = node / stride % side + way, next = node + way * stride;
                    if (place < 0 || place >= side || !solid_[static_cast<size_t>(next)] ||
                        seen[static_cast<size_t>(next)])
                        continue;
                    seen[static_cast<size_t>(next)] = true;
                    open.push_back(next);
                }
        }
        return false;
    }

private:
    static constexpr int side = 33, nodes = side * side * side;

    Vec3d at(int node) const {
        const Vec3i place{node % side, node / side % side, node / side / side};
        return low_ + place.as<double>() * step_m_;
    }
    int nearestSolid(Vec3d p) const {
        int best = -1;
        double least = std::numeric_limits<double>::infinity();
        for (int i = 0; i < nodes; ++i) {
            const Vec3d off = at(i) - p;
            if (solid_[static_cast<size_t>(i)] && dot(off, off) < least) least = dot(off, off), best = i;
        }
        return best;
    }

    Vec3d low_;
    double step_m_;
    std::vector<bool> solid_;
};

/// Whether the field joins what the mesh shows apart, near its nearest points.
bool meets(const eval::Tape& tape, const Closest& closest, double cell_m) {
    if (closest.width_m > 2 * cell_m) return false;
    if (closest.width_m <= static_cast<double>(tape.tieMargin())) return true;
    const Vec3d inward = (closest.from - closest.to) * (0.5 * cell_m / closest.width_m);
    return Surroundings(tape, (closest.from + closest.to) * 0.5, cell_m)
        .joins(closest.from + inward, closest.to - inward);
}

/// The part itself, or that which it cuts: the surface of a cut is the cutter's.
OriginId cutPartOf(const Model& model, OriginId origin) {
    const std::vector<derive::ShapeId>& shapeOf = model.lowered->shapeOf;
    if (origin >= shapeOf.size() || shapeOf[origin] == derive::none) return origin;
    const derive::Shape& shape = model.derivation.tree.shapes[shapeOf[origin]];
    if (shape.op != rules::Operator::Difference || shape.parent == derive::none) return origin;
    const auto host = std::find(shapeOf.begin(), shapeOf.end(), shape.parent);
    return host == shapeOf.end() ? origin : static_cast<OriginId>(host - shapeOf.begin());
}

}  // namespace

Status findCauses(const Model& model, const mesh::Mesh& mesh, float cell_m, const std::vector<lower::ThinPart>& missing,
                  Support& support, Progress* progress) {
    if (support.floating.empty() || mesh.hasPositionsOnly()) return Done{};
    const ThinLinks links(model, missing);
    const HoldingCells holding(cell_m, missing);
    std::optional<GapFinder> gaps;
    for (size_t i = 0; i < std::min(support.floating.size(), mostPieces); ++i) {
        Floating& f = support.floating[i];
        f.besideMissing = links.reachBeyond(f.piece, static_cast<double>(cell_m));
        const lower::ThinPart* thin = links.find(f.piece, static_cast<double>(cell_m));
        const bool isFragment = !thin;
        if (isFragment) thin = links.findWallOf(f.piece, static_cast<double>(cell_m));
        if (thin) {
            f.cause.kind = isFragment ? FloatCause::Kind::Fragment : FloatCause::Kind::Thin;
            f.cause.width_m = thin->thickness_m, f.cause.cell_m = thin->cell_m, f.cause.theirs = thin->part;
            f.cause.whole_m = holding.before(thin->cell_m, thin->halvings);
            continue;
        }
        if (!gaps) gaps.emplace(mesh);
        const auto closest = gaps->find(f.piece, static_cast<double>(cell_m), progress);
        if (cancelled(progress)) return cancelledError();
        if (!closest) continue;
        const OriginId ours = cutPartOf(model, gaps->originOf(closest->ours)),
                       theirs = cutPartOf(model, gaps->originOf(closest->theirs));
        const bool touches = meets(model.tape, *closest, static_cast<double>(cell_m));
        f.cause = {touches ? FloatCause::Kind::Touch : FloatCause::Kind::Gap,
                   closest->width_m,
                   0,
                   (closest->from + closest->to) * 0.5,
                   ours,
                   theirs};
    }
    return Done{};
}

}  // namespace sgm::pipeline
