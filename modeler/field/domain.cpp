#include "modeler/field/domain.h"

#include <array>

#include "modeler/core/random.h"
#include "modeler/field/ops.h"
#include "modeler/field/solids.h"

namespace sgm::field {

namespace {

using solids::boxDistance;

NodeRef named(Graph& graph, uint64_t path, uint64_t attribute, double value) {
    return graph.slot(SlotKey{path, attribute}, static_cast<float>(value));
}

NodeRef& component(Point& p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

/// Exact distance to a box whose numbers are slots.
NodeRef distanceTo(const Box3f& box, Point p) {
    Graph& g = p.x.graph();
    const Vec3f centre = box.centre(), half = box.size() * 0.5f;
    const auto slots = [&g](Vec3f v) { return Point{g.slot(v.x), g.slot(v.y), g.slot(v.z)}; };
    return boxDistance(p - slots(centre), slots(half));
}

}  // namespace

Point turned(Point p, const Mat3& r, uint64_t rotationPath) {
    Graph& g = p.x.graph();
    // Every shape comes here: its names are hashed once for all.
    constexpr uint64_t names[3][3] = {{hashText("rotation.xx"), hashText("rotation.xy"), hashText("rotation.xz")},
                                      {hashText("rotation.yx"), hashText("rotation.yy"), hashText("rotation.yz")},
                                      {hashText("rotation.zx"), hashText("rotation.zy"), hashText("rotation.zz")}};
    // Shapes with equal axes share these slots. -0 equals 0, so zeros are written as +0, whichever shape writes them.
    const auto entry = [&](uint64_t name, double value) { return named(g, rotationPath, name, value + 0.0); };
    const auto along = [&](const Vec3d& column, const uint64_t* name) {
        for (int axis = 0; axis < 3; ++axis)
            if (std::abs(column[axis]) == 1) return column[axis] > 0 ? component(p, axis) : -component(p, axis);
        return dot(Point{entry(name[0], column.x), entry(name[1], column.y), entry(name[2], column.z)}, p);
    };
    return {along(r.x, names[0]), along(r.y, names[1]), along(r.z, names[2])};
}

Point toLocal(Point p, const Frame& frame, uint64_t path, uint64_t rotationPath) {
    constexpr std::array centreNames{hashText("centre.x"), hashText("centre.y"), hashText("centre.z")};
    const Vec3f c = (frame.rotation.transposed() * frame.centre).as<float>();
    const auto [x, y, z] = p.x.graph().slots(path, centreNames, std::array{c.x, c.y, c.z});
    return turned(p, frame.rotation, rotationPath) - Point{x, y, z};
}

Box3f toWorld(const Box3f& local, const Frame& frame) {
    if (local.empty()) return local;
    const bool turned = frame.rotation != Mat3{};
    if (turned && !local.finite()) return Box3f::everything();
    const Vec3d lo = local.lo.as<double>(), hi = local.hi.as<double>();
    Vec3d low = lo + frame.centre, high = hi + frame.centre, reach = max(-lo, hi);
    if (turned) {
        const Vec3d middle = frame.rotation * ((lo + hi) * 0.5) + frame.centre, half = (hi - lo) * 0.5;
        const auto positive = [](Vec3d v) { return Vec3d{std::abs(v.x), std::abs(v.y), std::abs(v.z)}; };
        const Mat3& r = frame.rotation;
        const Vec3d extent = positive(r.x) * half.x + positive(r.y) * half.y + positive(r.z) * half.z;
        low = middle - extent;
        high = middle + extent;
    }
    // toLocal rounds each coordinate by a few ulps of the largest number it meets.
    double size = 0;
    for (int i = 0; i < 3; ++i)
        size = std::max(size, std::abs(frame.centre[i]) + (std::isfinite(reach[i]) ? reach[i] : 0.0));
    return Box3d{low, high}.inflated(size * 1e-6).as<float>();
}

NodeRef substitute(NodeRef value, Point p) {
    Graph& g = value.graph();
    std::vector<bool> used(value.id() + 1, false);
    used[value.id()] = true;
    for (NodeId id = value.id() + 1; id-- > 0;)  // operands come before what is made of them
        if (used[id])
            for (const Operand& o : g.operands(id)) used[o.node] = true;
    std::vector<NodeId> now(value.id() + 1);
    std::vector<Operand> operands;
    for (NodeId id = 0; id <= value.id(); ++id) {
        if (!used[id]) continue;
        now[id] = id;
        const Node node = g.node(id);
        if (node.op == codeOf<ops::Input>) now[id] = (node.data == 0 ? p.x : node.data == 1 ? p.y : p.z).id();
        operands.assign(g.operands(id).begin(), g.operands(id).end());
        for (Operand& o : operands) o.node = now[o.node];
        if (!operands.empty()) now[id] = g.apply(node.op, operands, node.data).id();
    }
    return {&g, now[value.id()]};
}

Point mirror(Point p, bool x, bool y, bool z) { return {x ? abs(p.x) : p.x, y ? abs(p.y) : p.y, z ? abs(p.z) : p.z}; }

Box3f mirrored(const Box3f& bounds, bool x, bool y, bool z) {
    Box3f box = bounds;
    const bool flags[] = {x, y, z};
    for (int i = 0; i < 3; ++i) {
        if (!flags[i]) continue;
        if (box.hi[i] < 0) return {};  // |x| never gets there
        box.lo[i] = -box.hi[i];
    }
    return box;
}

Point repeat(Point p, int axis, NodeRef period) {
    NodeRef& c = component(p, axis);
    const NodeRef half = period * 0.5f;
    c = mod(c + half, period) - half;
    return p;
}

Field repeated(Point p, int axis, NodeRef period, double periodValue, int count,
               const std::function<Field(Point)>& solid) {
    Graph& g = p.x.graph();
    const NodeRef last = g.slot(static_cast<float>(count - 1));
    // Copy j stands at (j − last/2) · period; the two nearest are ⌊u⌋ and ⌊u⌋ + 1.
    const NodeRef u = floor(component(p, axis) / period + last * 0.5f);
    const auto copy = [&](NodeRef index) {
        Point q = p;
        NodeRef& c = component(q, axis);
        c = c - (min(max(index, 0.0f), last) - last * 0.5f) * period;
        Field f = solid(q);
        f.value = max(f.value, abs(c) - period * 0.5f);
        return f;
    };
    const Field first = copy(u), second = copy(u + 1.0f);

    Box3f bounds = first.bounds;
    const auto half = static_cast<float>(periodValue * 0.5),
               reach = static_cast<float>(periodValue * 0.5 * (count - 1));
    bounds.lo[axis] = std::max(bounds.lo[axis], -half) - reach;
    bounds.hi[axis] = std::min(bounds.hi[axis], half) + reach;
    if (bounds.empty()) bounds = {};
    // A cut is an intersection (see combine.cpp).
    const bool cut = first.bounds.lo[axis] < -half || first.bounds.hi[axis] > half;
    const float growth = first.growth * (cut ? 0.70710f : 1.0f);
    // Any third copy is at least half a period away, and no nearer than the bounds.
    const bool known = bounds.finite();
    const NodeRef away = known ? max(period * 0.5f, distanceTo(bounds, p)) : period * 0.5f;
    const NodeRef cap = away * g.slot(growth);
    return {min(min(first.value, second.value), cap), bounds, std::max(first.lipschitz, 1.0f), known ? growth : 0};
}

}  // namespace sgm::field
