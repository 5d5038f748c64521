// The conventions every module keeps. Nothing enters or leaves here; other headers refer to this page.
//
// Sign       f < 0 inside, f = 0 on the surface (counted as outside by the mesher), f > 0 outside.
// Booleans   sum = min, intersection = max, difference = max(a, -b)  (SG-M eq. 13, with the sign of definition 4).
// Space      metres, Y up, right-handed. Angles are degrees in grammar text and radians in code.
// Precision  a field is evaluated in float32 in its object's own frame; placement is double.
// Names      carry space and unit where they could be mistaken: `worldFromLocal`, `radius_m`, `cell_m`.
// Axes       the order is +x -x +y -y +z -z everywhere (`axes`); `sides` is +x -x +z -z.
#pragma once

namespace sgm {

inline constexpr double pi = 3.14159265358979323846;

/// Radians of `degrees`.
constexpr double radians(double degrees) { return degrees * pi / 180.0; }

/// Degrees of `radians_`.
constexpr double degrees(double radians_) { return radians_ * 180.0 / pi; }

}  // namespace sgm
