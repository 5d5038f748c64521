// Colours as they are written (#rrggbb, sRGB) and as materials carry them (linear RGB).
// Enters: 0xrrggbb or shares of it. Leaves: linear RGB, 0 … 1, and back. Assumes the curve of IEC 61966-2-1 (sRGB).
#pragma once

#include <cstdint>

#include "modeler/core/vec.h"

namespace sgm::rules {

/// One sRGB component, 0 … 1, as linear light.
double linearFromSrgb(double srgb);
Vec3d linearFromHex(uint32_t rrggbb);
/// The nearest #rrggbb; components outside 0 … 1 are clamped.
uint32_t hexFromLinear(Vec3d linear);

}  // namespace sgm::rules
