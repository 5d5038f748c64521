#include "grammar/derive/shapes.h"

#include <bit>
#include <stdexcept>

#include "modeler/core/random.h"

namespace sgm::derive {
namespace {

constexpr uint32_t mostJoinings = 1u << 29;

/// Cheaper than `combine`, for tables that compare values anyway.
uint64_t mixedWith(uint64_t hash, uint64_t word) { return std::rotl((hash ^ word) * 0x9e3779b97f4a7c15ull, 29); }

uint64_t mixedWith(uint64_t hash, Vec3d v) {
    for (int i = 0; i < 3; ++i) hash = mixedWith(hash, std::bit_cast<uint64_t>(v[i]));
    return hash;
}

uint64_t pairOf(uint32_t a, uint32_t b) { return uint64_t{a} << 32 | b; }

}  // namespace

uint64_t BitwiseEqual::hashOf(const Mat3& axes) {
    return mix(mixedWith(mixedWith(mixedWith(1, axes.x), axes.y), axes.z));
}

uint64_t BitwiseEqual::hashOf(const ShapeKind& kind) {
    uint64_t hash = mixedWith(1, pairOf(kind.symbol, kind.label));
    hash = mixedWith(hash, pairOf(kind.jointSet, kind.material));
    hash = mixedWith(hash, kind.chainRule);
    hash = mixedWith(hash, reinterpret_cast<uintptr_t>(kind.span.source));
    return mix(mixedWith(hash, pairOf(kind.span.begin, kind.span.end)));
}

uint64_t BitwiseEqual::hashOf(const Joining& joining) {
    return mix(mixedWith(std::bit_cast<uint64_t>(joining.amount), std::bit_cast<uint64_t>(joining.blend_m)));
}

bool BitwiseEqual::isSame(const ShapeKind& a, const ShapeKind& b) {
    return a.symbol == b.symbol && a.label == b.label && a.jointSet == b.jointSet && a.material == b.material &&
           a.chainRule == b.chainRule && a.span.source == b.span.source && a.span.begin == b.span.begin &&
           a.span.end == b.span.end;
}

uint32_t Shapes::indexOf(Joining joining) {
    const uint32_t index = joinings_.put(joining, 0);
    if (index >= mostJoinings) throw std::length_error("too many different blends");
    return index;
}

void Shapes::push_back(const Shape& s) {
    ShapeRecord r{};
    r.key = s.key;
    r.centre = s.scope.centre;
    r.size = s.scope.size;
    r.axes = axes_.put(s.scope.axes, s.parent < size() ? records_[s.parent].axes : 0);
    r.footprint = s.scope.footprint;
    r.parent = s.parent;
    r.firstChild = s.firstChild;
    r.lastChild = s.lastChild;
    r.nextSibling = s.nextSibling;
    r.occurrence = s.occurrence;
    r.depth = s.depth;
    r.live = s.live;
    r.dead = s.dead;
    r.sharesPlace = s.sharesPlace;
    r.meetsNobody = s.meetsNobody;
    r.solid = s.solid;
    r.extras = s.extras;
    r.valuesAt = s.valuesAt;
    r.madeBy = s.madeBy;
    r.kind = kinds_.put({s.symbol, s.label, s.jointSet, s.material, s.chainRule, s.span});
    r.joining = indexOf({s.amount, s.blend_m});
    r.op = static_cast<uint32_t>(s.op);
    records_.push_back(r);
}

void Shapes::setScope(ShapeId id, const Scope& scope) {
    ShapeRecord& r = records_[id];
    r.centre = scope.centre;
    r.size = scope.size;
    r.axes = axes_.put(scope.axes, r.axes);
    r.footprint = scope.footprint;
}

void Shapes::setJoining(ShapeId id, Joining joining) { records_[id].joining = indexOf(joining); }

void Shapes::shrink() {
    constexpr size_t slack = 1024;  // values that a small tree may leave behind
    const auto isFull = [&](const auto& table) { return table.size() > 2 * size() + slack; };
    if (isFull(axes_)) {
        ValueTable<Mat3, BitwiseEqual> used;
        for (ShapeRecord& r : records_) r.axes = used.put(axes_[r.axes]);
        axes_ = std::move(used);
    }
    if (isFull(joinings_)) {
        ValueTable<Joining, BitwiseEqual> used;
        for (ShapeRecord& r : records_) r.joining = used.put(joinings_[r.joining]);
        joinings_ = std::move(used);
    }
    records_.shrink();
    axes_.shrink();
    kinds_.shrink();
    joinings_.shrink();
}

uint64_t Shapes::memory() const {
    return records_.capacity() * sizeof(ShapeRecord) + axes_.memory() + kinds_.memory() + joinings_.memory();
}

}  // namespace sgm::derive
