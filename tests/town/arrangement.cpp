#include "tests/town/arrangement.h"

#include <CGAL/Arr_segment_traits_2.h>
#include <CGAL/Arrangement_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polygon_set_2.h>
#include <CGAL/Polygon_with_holes_2.h>

namespace sgm::town::test {

ArrangementCounts arrangementOf(const std::vector<std::array<int32_t, 4>>& segments) {
    using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
    using Traits = CGAL::Arr_segment_traits_2<Kernel>;
    std::vector<Traits::Curve_2> curves;
    curves.reserve(segments.size());
    for (const auto& s : segments) curves.emplace_back(Kernel::Point_2(s[0], s[1]), Kernel::Point_2(s[2], s[3]));
    CGAL::Arrangement_2<Traits> arrangement;
    CGAL::insert(arrangement, curves.begin(), curves.end());
    return {arrangement.number_of_vertices(), arrangement.number_of_edges(),
            arrangement.number_of_faces() - arrangement.number_of_unbounded_faces()};
}

double overlapOf(const std::vector<std::vector<std::array<double, 2>>>& outlines) {
    using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
    using Polygon = CGAL::Polygon_2<Kernel>;
    std::vector<Polygon> polygons;
    Kernel::FT sum = 0, whole = 0;
    for (const auto& outline : outlines) {
        Polygon& polygon = polygons.emplace_back();
        for (const auto& p : outline) polygon.push_back({p[0], p[1]});
        if (polygon.is_clockwise_oriented()) polygon.reverse_orientation();
        sum += polygon.area();
    }
    CGAL::Polygon_set_2<Kernel> set;
    set.join(polygons.begin(), polygons.end());
    std::vector<CGAL::Polygon_with_holes_2<Kernel>> parts;
    set.polygons_with_holes(std::back_inserter(parts));
    for (const auto& part : parts) {
        whole += part.outer_boundary().area();
        for (auto hole = part.holes_begin(); hole != part.holes_end(); ++hole) whole += hole->area();  // negative
    }
    return CGAL::to_double(sum - whole);
}

}  // namespace sgm::town::test
