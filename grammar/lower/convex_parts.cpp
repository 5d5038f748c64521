#include "grammar/lower/convex_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "grammar/lower/convex_solids.h"
#include "grammar/lower/scope_lines.h"

namespace sgm::lower {
namespace {

using derive::none;
using derive::Shape;
using derive::ShapeId;
using mesh::ConvexPolyhedron;
using rules::Operator;

/// What the pieces can't show, and what happens to it.
enum class Unlike { Missing, Uncut, Sharp, Plain, Morphed };
constexpr std::array<std::string_view, 5> unlikeTexts{
    "has no convex parts: left out", "cuts, and has no convex parts: its holes are closed",
    "blends into others: taken as sharp", "has noise or cladding: taken without",
    "morphs what stands: the nearer end is taken"};

/// Follows Lowering (lowering.h): the same walk, the same joins, with polyhedra instead of fields.
class Collector {
public:
    Collector(const derive::Derivation& d, const Model& model) : d_(d), tree_(d.tree) {
        world_ = model.field.bounds.as<double>();
        world_ = world_.inflated(1 + 0.1 * maxComponent(world_.size()));
    }

    Result<ConvexParts> run(Progress* progress) {
        if (progress) progress->begin("convex parts", tree_.shapes.size());
        for (ShapeId s = 0;;) {
            enter(s);
            if (progress) progress->tick();
            if (cancelled(progress)) return cancelledError();
            if (open_.back().pieces.size() > mostConvexPieces) return tooMany();
            if (tree_.shapes[s].firstChild != none) {
                s = tree_.shapes[s].firstChild;
                continue;
            }
            leave(s);
            while (s != 0 && tree_.shapes[s].nextSibling == none) leave(s = tree_.shapes[s].parent);
            if (s == 0) break;
            s = tree_.shapes[s].nextSibling;
        }
        return finished(progress);
    }

private:
    struct Note {
        ShapeId first = none;
        size_t count = 0;
    };

    void note(Unlike what, ShapeId id) {
        Note& n = notes_[static_cast<size_t>(what)];
        if (n.count++ == 0) n.first = id;
    }

    void enter(ShapeId id) {
        open_.emplace_back();
        cutting_ += tree_.shapes[id].op == Operator::Difference;
        if (tree_.shapes[id].solid == none) return;
        open_.back() =
            convexSolid(*tree_.solidOf(id), tree_.shapes[id].scope, id, world_, tree_.footprints, d_.grammar->meshes,
                        cutting_ > 0 ? field::convex::Roundness::Coarse : field::convex::Roundness::Fine);
        if (open_.back().unknown) note(cutting_ > 0 ? Unlike::Uncut : Unlike::Missing, id);
    }

    void leave(ShapeId id) {
        const auto* x = tree_.extrasOf(id);
        if (x && !open_.back().empty() && !(x->clad.empty() && x->displace.empty())) note(Unlike::Plain, id);
        if (x && !open_.back().empty() && x->relief != none && onHills_ == none) onHills_ = id;
        cutting_ -= tree_.shapes[id].op == Operator::Difference;
        if (open_.size() == 1) return;
        ConvexContent part = std::move(open_.back());
        open_.pop_back();
        join(open_.back(), id, std::move(part));
    }

    /// As Lowering::join.
    void join(ConvexContent& content, ShapeId id, ConvexContent part) {
        const Shape& s = tree_.shapes[id];
        if (s.blend_m > 0 && !part.empty()) note(Unlike::Sharp, id);
        switch (s.op) {
            case Operator::Sum:
            case Operator::None:
                return content.unite(std::move(part));
            case Operator::Difference:
                return content.subtract(part);
            case Operator::Intersection:
                if (!part.unknown) content.intersect(part);
                return;
            case Operator::Morph:
                if (part.empty()) return;
                if (!content.empty() && s.amount > 0 && s.amount < 1) note(Unlike::Morphed, id);
                if (content.empty() || s.amount >= 0.5) content = std::move(part);
        }
    }

    static Error tooMany() {
        return {Error::Kind::Budget, fmt::format("more than {} convex parts: take --collider mesh", mostConvexPieces)};
    }

    Result<ConvexParts> finished(Progress* progress) {
        if (onHills_ != none)
            return Error{Error::Kind::Input,
                         fmt::format("{}'{}' follows hills, which boxes and convex parts can't: take --collider mesh",
                                     syntax::placeText(tree_.shapes[onHills_].span), tree_.path(onHills_))};
        ConvexParts parts;
        ConvexContent& all = open_.back();
        if (all.pieces.size() > mostConvexPieces) return tooMany();
        for (size_t begin = 0, end = 0; begin < all.pieces.size(); begin = end) {
            if (cancelled(progress)) return cancelledError();
            while (end < all.pieces.size() && all.shapes[end] == all.shapes[begin]) ++end;
            std::vector<ConvexPolyhedron> ofShape(all.pieces.begin() + static_cast<std::ptrdiff_t>(begin),
                                                  all.pieces.begin() + static_cast<std::ptrdiff_t>(end));
            mesh::joinConvex(ofShape);
            for (ConvexPolyhedron& piece : ofShape) parts.pieces.push_back({std::move(piece), all.shapes[begin]});
        }
        dropHeld(parts.pieces);
        if (parts.pieces.empty())
            return Error{Error::Kind::Input, "no solid of the model has convex parts: take --collider mesh"};
        for (size_t i = 0; i < notes_.size(); ++i)
            if (const Note& n = notes_[i]; n.count > 0)
                parts.notes.push_back(fmt::format("{}'{}' {}{}", syntax::placeText(tree_.shapes[n.first].span),
                                                  tree_.path(n.first), unlikeTexts[i],
                                                  n.count > 1 ? fmt::format(" ({} shapes)", n.count) : ""));
        return parts;
    }

    /// Drops pieces that another one holds; of equal ones the first stays.
    static void dropHeld(std::vector<ConvexPiece>& pieces) {
        std::vector<bool> held(pieces.size(), false);
        for (size_t i = 0; i < pieces.size(); ++i) {
            const Box3d own = pieces[i].polyhedron.bounds();
            for (size_t j = 0; j < pieces.size() && !held[i]; ++j) {
                const Box3d other = pieces[j].polyhedron.bounds().inflated(1e-6);
                if (i == j || held[j] || !other.contains(own.lo) || !other.contains(own.hi)) continue;
                held[i] = pieces[i].polyhedron.within(pieces[j].polyhedron.faces());
            }
        }
        size_t i = 0;
        std::erase_if(pieces, [&](const ConvexPiece&) { return held[i++]; });
    }

    const derive::Derivation& d_;
    const derive::ShapeTree& tree_;
    Box3d world_;
    std::vector<ConvexContent> open_;
    int cutting_ = 0;         ///< shapes above and with the open one that are cut away
    ShapeId onHills_ = none;  ///< the first one that follows hills
    std::array<Note, unlikeTexts.size()> notes_;
};

/// The box, along these axes, that holds all of it.
Box3d boxAlong(const ConvexPolyhedron& piece, const Mat3& axes) {
    return {{-piece.support(-axes.x), -piece.support(-axes.y), -piece.support(-axes.z)},
            {piece.support(axes.x), piece.support(axes.y), piece.support(axes.z)}};
}

std::optional<ConvexPolyhedron> boxFrom(const Box3d& local, const Mat3& axes) {
    const Vec3d directions[] = {axes.x, axes.y, axes.z};
    field::ConvexPart part;
    Box3d world;
    for (int corner = 0; corner < 8; ++corner)
        world = hull(world, axes * Vec3d{corner & 1 ? local.hi.x : local.lo.x, corner & 2 ? local.hi.y : local.lo.y,
                                         corner & 4 ? local.hi.z : local.lo.z});
    for (int axis = 0; axis < 3; ++axis) {
        part.push_back({directions[axis], local.hi[axis]});
        part.push_back({-directions[axis], -local.lo[axis]});
    }
    return ConvexPolyhedron::of(part, world);
}

/// Boxes along some axes for a convex piece: one where it comes near, else those of its halves.
class BoxFitter {
public:
    BoxFitter(const Mat3& axes, std::vector<ConvexPolyhedron>& boxes) : axes_(axes), boxes_(boxes) {}

    void fit(const ConvexPolyhedron& piece, int halvings = mostHalvings) {
        const Box3d whole = boxAlong(piece, axes_);
        if (piece.volume_m3() > (1 - 1e-4) * volumeOf(whole)) return add(whole);
        const auto [box, covers] = nearest(piece, whole);
        if (covers >= nearEnough || halvings == 0 || maxComponent(whole.size()) < 2 * leastSide_m) return add(box);
        const std::vector<ConvexPolyhedron> halves = halvesOf(piece, whole);
        if (halves.empty()) return add(box);
        for (const ConvexPolyhedron& half : halves) fit(half, halvings - 1);
    }

private:
    static constexpr int mostHalvings = 3;       ///< so that a piece has eight boxes at most
    static constexpr double nearEnough = 0.9;    ///< of a piece's volume that one box covers
    static constexpr double leastSide_m = 0.25;  ///< of a box that is half of another one

    static double volumeOf(const Box3d& box) {
        const Vec3d size = box.size();
        return size.x * size.y * size.z;
    }
    /// The part of a piece at most so far along an axis, or at least.
    std::optional<ConvexPolyhedron> below(const ConvexPolyhedron& piece, int k, double end) const {
        return piece.clipped({axes_ * alongAxis(k), end});
    }
    std::optional<ConvexPolyhedron> above(const ConvexPolyhedron& piece, int k, double begin) const {
        return piece.clipped({-(axes_ * alongAxis(k)), -begin});
    }

    /// The share of a piece that lies in a box.
    double share(const ConvexPolyhedron& piece, const Box3d& box) const {
        std::optional<ConvexPolyhedron> part = piece;
        for (int k = 0; k < 3 && part; ++k) {
            part = below(*part, k, box.hi[k]);
            if (part) part = above(*part, k, box.lo[k]);
        }
        return part ? part->volume_m3() / piece.volume_m3() : 0;
    }

    /// Of the boxes of a piece's volume that its whole box leaves when it is cut off on one side, or all around an
    /// axis, the one that covers most of the piece; and how much.
    std::pair<Box3d, double> nearest(const ConvexPolyhedron& piece, const Box3d& whole) const {
        const double filled = std::min(1.0, piece.volume_m3() / volumeOf(whole));
        std::pair<Box3d, double> best{whole, -1};
        const auto offer = [&](const Box3d& box) {
            if (const double covers = share(piece, box); covers > best.second + 1e-9) best = {box, covers};
        };
        for (int k = 0; k < 3; ++k) {
            const double cut = (1 - filled) * whole.size()[k];
            Box3d low = whole, high = whole, around = whole;
            low.hi[k] -= cut;
            high.lo[k] += cut;
            for (const int other : {(k + 1) % 3, (k + 2) % 3}) {
                const double side = (1 - std::sqrt(filled)) / 2 * whole.size()[other];
                around.lo[other] += side;
                around.hi[other] -= side;
            }
            offer(low);
            offer(high);
            offer(around);
        }
        return best;
    }

    /// A piece cut in the middle of the axis along which the halves' boxes are smallest.
    std::vector<ConvexPolyhedron> halvesOf(const ConvexPolyhedron& piece, const Box3d& whole) const {
        std::vector<ConvexPolyhedron> best;
        double least = std::numeric_limits<double>::infinity();
        for (int k = 0; k < 3; ++k) {
            if (whole.size()[k] < 2 * leastSide_m) continue;
            const double middle = whole.centre()[k];
            std::vector<ConvexPolyhedron> halves;
            double volume = 0;
            for (auto& half : {below(piece, k, middle), above(piece, k, middle)}) {
                if (!half) continue;
                volume += volumeOf(boxAlong(*half, axes_));
                halves.push_back(*half);
            }
            if (!halves.empty() && volume < least) least = volume, best = std::move(halves);
        }
        return best;
    }

    void add(const Box3d& box) {
        if (auto made = boxFrom(box, axes_)) boxes_.push_back(std::move(*made));
    }

    const Mat3& axes_;
    std::vector<ConvexPolyhedron>& boxes_;
};

}  // namespace

Result<ConvexParts> convexParts(const derive::Derivation& derivation, const Model& model, Progress* progress) {
    return Collector(derivation, model).run(progress);
}

std::vector<ConvexPolyhedron> boxesOf(const derive::Derivation& derivation, const ConvexParts& parts) {
    std::vector<ConvexPolyhedron> boxes;
    for (const ConvexPiece& piece : parts.pieces)
        BoxFitter(derivation.tree.shapes[piece.shape].scope.axes, boxes).fit(piece.polyhedron);
    return boxes;
}

}  // namespace sgm::lower
