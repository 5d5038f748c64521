#include "modeler/mesh/decimate_fan.h"

#include <bit>

namespace sgm::mesh {
namespace {

constexpr float needle = 1e-3f;  ///< doubled area by the square of the longest side

}  // namespace

bool Fan::set(std::span<const Vec3f> corners, Vec3f normal, float leastFacing, float tolerance) {
    const int n = static_cast<int>(corners.size());
    apex_ = corners[0], normal_ = normal, last_ = n - 2;
    for (int i = 1; i < n; ++i) arms_[i] = corners[i] - apex_;
    for (int i = 1; i <= last_; ++i) {
        const Vec3f across = cross(arms_[i], arms_[i + 1]), edge = arms_[i + 1] - arms_[i];
        const float up = dot(across, normal), squared = dot(across, across);
        const float longest = std::max({dot(arms_[i], arms_[i]), dot(arms_[i + 1], arms_[i + 1]), dot(edge, edge)});
        if (!(up > 0) || up * up < leastFacing * leastFacing * squared || up < needle * longest) return false;
        planes_[i] = across / up;
        outer_[i] = normalized(cross(edge, normal));
        reach_[i] = dot(outer_[i], arms_[i]);
    }
    box_ = {};
    for (const Vec3f& corner : corners) box_ = hull(box_, corner);
    box_ = box_.inflated(2 * tolerance);
    for (int i = 1; i <= last_ + 1; ++i) sides_[i] = normalized(cross(normal, arms_[i]));
    return true;
}

bool Fan::crossesWithin(Vec3f a, Vec3f b, uint32_t between, float tolerance) const {
    const Vec3f fromA = a - apex_, fromB = b - apex_;
    for (; between != 0; between &= between - 1) {
        const int i = std::countr_zero(between);
        const float leftA = dot(sides_[i], fromA), leftB = dot(sides_[i], fromB);
        const Vec3f at = fromA + (fromB - fromA) * (leftA / (leftA - leftB));
        const float rise = dot(arms_[i], normal_);
        const Vec3f level = arms_[i] - normal_ * rise;
        const float along = dot(at, level), length = dot(level, level);
        if (!(along >= 0 && along <= length)) continue;
        if (!(std::abs(dot(at, normal_) - along / length * rise) <= tolerance)) return false;
    }
    return true;
}

}  // namespace sgm::mesh
