// skeleton.h in a build without CGAL; the language refuses `lots skeleton(…)` there.
#include "modeler/town/skeleton.h"

namespace sgm::town {

std::vector<std::vector<plan::Vec2>> skeletonFaces(const plan::Polygon&) { return {}; }

}  // namespace sgm::town
