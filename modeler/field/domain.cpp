#include "modeler/field/domain.h"

#include "modeler/core/random.h"

namespace sgm::field {

namespace {

Num named(Graph& graph, uint64_t path, const char* attribute, double value) {
    return graph.slot(SlotKey{path, hashText(attribute)}, static_cast<float>(value));
}

}  // namespace

Point toLocal(Point p, const Frame& frame, uint64_t path) {
    Graph& g = p.x.graph();
    const Point q = p - Point{named(g, path, "centre.x", frame.centre.x), named(g, path, "centre.y", frame.centre.y),
                              named(g, path, "centre.z", frame.centre.z)};
    if (frame.rotation == Mat3{}) return q;
    constexpr const char* names[3][3] = {{"rotation.xx", "rotation.xy", "rotation.xz"},
                                         {"rotation.yx", "rotation.yy", "rotation.yz"},
                                         {"rotation.zx", "rotation.zy", "rotation.zz"}};
    // Rᵀq: the dot products with R's columns.
    const auto along = [&](const Vec3d& column, const char* const* name) {
        return dot(Point{named(g, path, name[0], column.x), named(g, path, name[1], column.y), named(g, path, name[2], column.z)}, q);
    };
    const Mat3& r = frame.rotation;
    return {along(r.x, names[0]), along(r.y, names[1]), along(r.z, names[2])};
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
    for (int i = 0; i < 3; ++i) size = std::max(size, std::abs(frame.centre[i]) + (std::isfinite(reach[i]) ? reach[i] : 0.0));
    return Box3d{low, high}.inflated(size * 1e-6).as<float>();
}

Point mirror(Point p, bool x, bool y, bool z) { return {x ? abs(p.x) : p.x, y ? abs(p.y) : p.y, z ? abs(p.z) : p.z}; }

Point repeat(Point p, int axis, Num period) {
    Num& c = axis == 0 ? p.x : axis == 1 ? p.y : p.z;
    const Num half = period * 0.5f;
    c = mod(c + half, period) - half;
    return p;
}

}  // namespace sgm::field
