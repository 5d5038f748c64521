#include "tests/town/arrangement.h"

#include <CGAL/Arr_segment_traits_2.h>
#include <CGAL/Arrangement_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>

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

}  // namespace sgm::town::test
