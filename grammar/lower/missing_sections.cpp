#include "grammar/lower/missing_sections.h"

#include <algorithm>
#include <array>

#include "grammar/lower/scope_lines.h"

namespace sgm::lower {
namespace {

constexpr size_t fewestLinesAcross = 3;  ///< of a section that counts
constexpr double leastOfLines = 0.1;     ///< share of them that the mesh lacks

/// Boxes around those of boxes, one a line, that lie near each other: no more than two spacings of the lines apart
/// along the axes across theirs.
void gather(std::span<Box3d> boxes, int axis, double spacing_m, std::vector<Box3d>& gathered) {
    for (const int along : {(axis + 1) % 3, (axis + 2) % 3}) {
        std::sort(boxes.begin(), boxes.end(),
                  [&](const Box3d& a, const Box3d& b) { return a.lo[along] < b.lo[along]; });
        for (size_t i = 1; i < boxes.size(); ++i) {
            if (boxes[i].lo[along] - boxes[i - 1].hi[along] <= 2 * spacing_m) continue;
            gather(boxes.first(i), axis, spacing_m, gathered);
            gather(boxes.subspan(i), axis, spacing_m, gathered);
            return;
        }
    }
    Box3d all;
    for (const Box3d& box : boxes) all = hull(all, box);
    gathered.push_back(all);
}

}  // namespace

std::optional<ThinPart> missingAt(const ThinSection& section, const Presence& presence, double cell_m) {
    if (section.lines.size() < fewestLinesAcross) return std::nullopt;
    const int axis = section.face / 2;
    const Mat3 local = section.scope.axes.transposed();
    const Vec3f along = (section.scope.axes * alongAxis(axis)).as<float>();
    std::vector<double> thicknesses_m;
    std::vector<Box3d> boxes, gathered;
    for (const ThinSection::Line& line : section.lines) {
        // Of a gap that is filled the rims are still there, beside its lines.
        const auto isNear = [&](const ThinSection::Crossing& c) { return presence.isNearAlong(c.at, along, c.owner); };
        if (isNear(line.ends[0]) || isNear(line.ends[1])) continue;
        thicknesses_m.push_back(line.thickness_m);
        Box3d box;
        for (const auto& end : line.ends) box = hull(box, local * (end.at.as<double>() - section.scope.centre));
        boxes.push_back(box);
    }
    const double missing = static_cast<double>(boxes.size()) / static_cast<double>(section.lines.size());
    if (!(missing > leastOfLines)) return std::nullopt;
    const auto middle = thicknesses_m.begin() + static_cast<ptrdiff_t>(thicknesses_m.size() / 2);
    std::nth_element(thicknesses_m.begin(), middle, thicknesses_m.end());
    ThinPart lacked{section.isGap ? ThinPart::Kind::Gap : ThinPart::Kind::Wall,
                    section.part,
                    section.face,
                    *middle,
                    std::min(*middle * turnOf(section.scope, axis), cell_m / 2),
                    missing,
                    {}};
    gather(boxes, axis, section.spacing_m, gathered);
    for (const Box3d& box : gathered) {
        derive::Scope place{section.scope.centre + section.scope.axes * box.centre(), section.scope.axes, box.size()};
        place.size[(axis + 1) % 3] += section.spacing_m, place.size[(axis + 2) % 3] += section.spacing_m;
        lacked.places.push_back(place);
    }
    return lacked;
}

}  // namespace sgm::lower
