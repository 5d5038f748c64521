// The values of a map over a rectangle of the ground, for views that show it.
// Enters: a derivation, whose parameters count. Leaves: numbers in rows. Assumes nothing of the shapes.
#pragma once

#include <string>
#include <vector>

#include "grammar/derive/derive.h"
#include "modeler/plan/polygon.h"

namespace sgm::derive {

/// Values at the middles of equal rectangles, row after row from low z on, columns from low x on.
struct MapLayer {
    std::string name;
    plan::Box2 area;  ///< metres
    uint32_t columns = 0, rows = 0;
    std::vector<float> values;       ///< numbers in the map's own unit; of words, their places in `words`
    std::vector<std::string> words;  ///< the classes that occur, in the order of their first place; empty for numbers
    float least = 0, most = 0;       ///< of the values
};

/// Evaluates a map (index into Grammar::maps) at `columns` × `rows` places. Error::Input where its formula fails.
/// O(places) times what one value costs.
Result<MapLayer> mapLayer(const Derivation& derivation, uint32_t map, const plan::Box2& area, uint32_t columns,
                          uint32_t rows);

}  // namespace sgm::derive
