// A small town for tests, and what a derivation made of it.
// Enters: grammars and derivations. Leaves: solids by terminal, counts by layer. Assumes nothing.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "modeler/plan/edit.h"
#include "tests/derive/grammars.h"
#include "tests/rules/read.h"

namespace sgm::testing_ {

using derive::Derivation;
using derive::Shape;

inline const std::string head = R"(grammar 1
map people = bump((-40m, -30m), 400m)
map bank = here.z - 80m - .2 * here.x
roads Net {
  pull = people  spread = people > .2
  water = bank > -12m and bank < 12m  park = bump((-110m, -120m), 50m) > 0
  highway = 14m  street = 9m  block = 60m  step = 60m  junction = 4
}
terminal asphalt, deck, lawn, sea, grove, wall, yard
)";
inline const std::string start = "start Town -> size (500, 10, 500) network Net { ";

inline std::map<std::string, std::vector<Shape>> solidsOf(const Derivation& d) {
    std::map<std::string, std::vector<Shape>> found;
    for (const Shape& s : d.tree.shapes)
        if (s.solid != derive::none) found[d.tree.labels[s.label]].push_back(s);
    return found;
}

inline std::map<std::string, size_t> layersOf(const Derivation& d) {
    std::map<std::string, size_t> count;
    for (const auto& f : d.plan.features) ++count[f.layer];
    return count;
}

inline double areaOf(const Derivation& d, const Shape& s) {
    if (s.scope.footprint == derive::none) return s.scope.size.x * s.scope.size.z;
    return area(d.tree.footprints.inMetres(s.scope.footprint, s.scope.half()));
}

inline std::string messagesOf(const std::string& text) { return rules::checkedBody(text).messages(); }

}  // namespace sgm::testing_
