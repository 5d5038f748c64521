// The shapes of a tree, held compactly and read as values.
// Enters: shapes, one after the other. Leaves: each as it was put, or changed since. Assumes that most shapes share
// their axes, their blends and what their elements give them with others. A shape takes 112 bytes instead of 232.
#pragma once

#include <cstddef>
#include <cstring>
#include <iterator>

#include "grammar/derive/bonds.h"
#include "grammar/derive/value_table.h"
#include "grammar/rules/grammar.h"
#include "modeler/core/page_array.h"
#include "modeler/core/vec.h"

namespace sgm::derive {

/// An oriented box: centre, axes, size in metres; and what it holds of the plan.
struct Scope {
    Vec3d centre;
    Mat3 axes;                  ///< world from local
    Vec3d size{1, 1, 1};        ///< metres, > 0
    uint32_t footprint = none;  ///< index into ShapeTree::footprints; none: the whole rectangle

    Vec3d half() const { return size * 0.5; }
    /// The point at `shares` (−1 … 1) of the half-size.
    Vec3d point(Vec3d shares) const { return centre + axes * (shares * half()); }
    friend bool operator==(const Scope&, const Scope&) = default;
};

/// Where a shape stands in the tree.
struct ShapeLinks {
    ShapeId parent = none;
    ShapeId firstChild = none, lastChild = none, nextSibling = none;  ///< children in joining order
    uint32_t occurrence = 0;  ///< 1 for the first child of this label under its parent; 0: not yet counted
    uint32_t depth = 0;       ///< 0 at the root; at most Shapes::mostDepth
};

/// What a shape holds and looks like.
struct ShapeContent {
    uint32_t solid = none;                       ///< index into ShapeTree::solids
    uint32_t material = none;                    ///< index into Derivation::materials; none inherits
    uint32_t extras = none;                      ///< index into ShapeTree::extras
    rules::Operator op = rules::Operator::None;  ///< how it joins what its parent holds so far; None: as its content
    double amount = 0.5;                         ///< for op Morph: a (`by`)
    double blend_m = 0;                          ///< blends into what stands with this radius
};

/// A node of the shape tree. Its field is its own solid combined with its children in order.
struct Shape : ShapeLinks, ShapeContent {
    uint64_t key = 0;  ///< hash(parent's key, rule, label, ordinal, repeat index): its random stream
    rules::SymbolId symbol = rules::none;  ///< none for an anonymous solid or group
    uint32_t label = 0;                    ///< index into ShapeTree::labels: symbol or primitive name
    ShapeId valuesAt = none;               ///< nearest shape, itself or above, that sets values by `with`
    uint32_t jointSet = 0;                 ///< index into ShapeTree::namedJoints
    uint32_t madeBy = none;                ///< step that made it; none for the start
    uint32_t chainRule = none;  ///< the `repeat` rule whose chain it is a link of: starts no such chain itself
    bool live = false;          ///< rules may still rewrite it
    bool dead = false;          ///< replaced; swept away before `derive` returns
    bool sharesPlace = false;   ///< its joints are those of its parent, whose scope it fills
    bool meetsNobody = false;   ///< its faces bond with none that they coincide with
    Scope scope;
    syntax::SourceSpan span;  ///< the text that made it
};

/// What the shapes of an element have in common, as of Shape.
struct ShapeKind {
    rules::SymbolId symbol = rules::none;
    uint32_t label = 0, jointSet = 0, material = none, chainRule = none;
    syntax::SourceSpan span;
};

/// How a shape joins what stands, as of ShapeContent.
struct Joining {
    double amount = ShapeContent{}.amount, blend_m = ShapeContent{}.blend_m;
};

/// Equality of values bit for bit, so that reading a shape gives what was stored.
struct BitwiseEqual {
    static uint64_t hashOf(const Mat3& axes);
    static uint64_t hashOf(const ShapeKind& kind);
    static uint64_t hashOf(const Joining& joining);
    static bool isSame(const Mat3& a, const Mat3& b) { return std::memcmp(&a, &b, sizeof a) == 0; }
    static bool isSame(const ShapeKind& a, const ShapeKind& b);
    static bool isSame(const Joining& a, const Joining& b) { return std::memcmp(&a, &b, sizeof a) == 0; }
};

/// Where a shape stands and what has become of it, as of ShapeLinks and Shape.
struct RecordedLinks {
    ShapeId parent, firstChild, lastChild, nextSibling;
    uint32_t occurrence;
    uint32_t depth : 28;
    bool live : 1, dead : 1, sharesPlace : 1, meetsNobody : 1;
};

/// What is stored of a shape itself. Values that many shapes share stand in tables.
struct ShapeRecord : RecordedLinks {
    uint64_t key;
    Vec3d centre, size;
    uint32_t axes;  ///< index into the table of axes
    uint32_t footprint, solid, extras;
    ShapeId valuesAt;
    uint32_t madeBy;
    uint32_t kind;          ///< index into the table of kinds
    uint32_t joining : 29;  ///< index into the table of joinings
    uint32_t op : 3;        ///< a rules::Operator
};
static_assert(sizeof(ShapeRecord) == 112);
static_assert(static_cast<uint32_t>(rules::Operator::Morph) < 8, "ShapeRecord::op has three bits");

/// The shapes of a tree by their ids: records of their own, and tables of the values that many share.
class Shapes {
public:
    static constexpr uint32_t mostDepth = (1u << 28) - 1;

    size_t size() const { return records_.size(); }
    bool empty() const { return records_.empty(); }
    /// A shape as a value. The call is inlined, so that members that are not read cost nothing.
    [[gnu::always_inline]] Shape operator[](size_t id) const;
    Shape back() const { return (*this)[size() - 1]; }
    Scope scopeOf(ShapeId id) const {
        const ShapeRecord& r = records_[id];
        return {r.centre, axes_[r.axes], r.size, r.footprint};
    }
    const Mat3& axesOf(ShapeId id) const { return axes_[records_[id].axes]; }
    bool haveSameAxes(ShapeId a, ShapeId b) const {
        const uint32_t of = records_[a].axes, other = records_[b].axes;
        return of == other || axes_[of] == axes_[other];
    }
    const ShapeRecord& record(ShapeId id) const { return records_[id]; }
    /// To be changed in place: links, flags and indices of lists of the tree.
    ShapeRecord& record(ShapeId id) { return records_[id]; }

    /// O(1). Throws std::bad_alloc, and std::length_error beyond 2^29 different amounts and blends.
    void push_back(const Shape& shape);
    void setScope(ShapeId id, const Scope& scope);
    void setJoining(ShapeId id, Joining joining);
    /// Drops the shapes from `size` on.
    void truncate(size_t size) { records_.truncate(size); }
    /// Gives back memory that isn't used, and drops from the tables what no shape has any more where that is most.
    void shrink();
    /// Bytes.
    uint64_t memory() const;

    /// Gives shapes as values.
    class Iterator {
    public:
        using iterator_category = std::input_iterator_tag;
        using value_type = Shape;
        using difference_type = ptrdiff_t;
        using pointer = void;
        using reference = Shape;
        Iterator() = default;
        Iterator(const Shapes& shapes, size_t at) : shapes_(&shapes), at_(at) {}
        Shape operator*() const { return (*shapes_)[at_]; }
        Iterator& operator++() { return ++at_, *this; }
        Iterator operator++(int) { return {*shapes_, at_++}; }
        friend ptrdiff_t operator-(Iterator a, Iterator b) { return static_cast<ptrdiff_t>(a.at_ - b.at_); }
        friend bool operator==(Iterator a, Iterator b) { return a.at_ == b.at_; }

    private:
        const Shapes* shapes_ = nullptr;
        size_t at_ = 0;
    };
    Iterator begin() const { return {*this, 0}; }
    Iterator end() const { return {*this, size()}; }

private:
    uint32_t indexOf(Joining joining);

    PageArray<ShapeRecord> records_;
    ValueTable<Mat3, BitwiseEqual> axes_;
    ValueTable<ShapeKind, BitwiseEqual> kinds_;
    ValueTable<Joining, BitwiseEqual> joinings_;
};

inline Shape Shapes::operator[](size_t id) const {
    const ShapeRecord& r = records_[id];
    const ShapeKind& kind = kinds_[r.kind];
    const Joining& joining = joinings_[r.joining];
    Shape s;
    s.parent = r.parent;
    s.firstChild = r.firstChild;
    s.lastChild = r.lastChild;
    s.nextSibling = r.nextSibling;
    s.occurrence = r.occurrence;
    s.depth = r.depth;
    s.solid = r.solid;
    s.material = kind.material;
    s.extras = r.extras;
    s.op = static_cast<rules::Operator>(r.op);
    s.amount = joining.amount;
    s.blend_m = joining.blend_m;
    s.key = r.key;
    s.symbol = kind.symbol;
    s.label = kind.label;
    s.valuesAt = r.valuesAt;
    s.jointSet = kind.jointSet;
    s.madeBy = r.madeBy;
    s.chainRule = kind.chainRule;
    s.live = r.live;
    s.dead = r.dead;
    s.sharesPlace = r.sharesPlace;
    s.meetsNobody = r.meetsNobody;
    s.scope.centre = r.centre;
    s.scope.axes = axes_[r.axes];
    s.scope.size = r.size;
    s.scope.footprint = r.footprint;
    s.span = kind.span;
    return s;
}

}  // namespace sgm::derive
