#include "grammar/rules/color.h"

#include <algorithm>
#include <cmath>

namespace sgm::rules {

double linearFromSrgb(double srgb) { return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4); }

Vec3d linearFromHex(uint32_t rrggbb) {
    const auto component = [&](int shift) { return linearFromSrgb(((rrggbb >> shift) & 0xff) / 255.0); };
    return {component(16), component(8), component(0)};
}

uint32_t hexFromLinear(Vec3d linear) {
    const auto byte = [](double v) {
        v = std::clamp(v, 0.0, 1.0);
        const double srgb = v <= 0.0031308 ? v * 12.92 : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
        return static_cast<uint32_t>(std::lround(srgb * 255));
    };
    return byte(linear.x) << 16 | byte(linear.y) << 8 | byte(linear.z);
}

}  // namespace sgm::rules
