// Maps: values that depend on the place in the plan.
// Enters: a map and a place in metres. Leaves: a number or a word. Assumes checked maps.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "grammar/rules/value.h"
#include "modeler/town/raster.h"

namespace sgm::rules {

/// A picture laid over the ground.
struct MapPicture {
    town::RasterPtr raster;
    plan::Vec2 over_m{1, 1};  ///< its extent along x and z, about 0
    Value black = Value::number(0), white = Value::number(1);
    /// Of a map of classes: a colour's number in `words`; `otherwise` for what is like none of them, where it was said.
    struct Class {
        std::array<uint8_t, 3> color;
        uint32_t word = 0;
    };
    std::vector<Class> classes;
    std::vector<std::string> words;
    std::optional<uint32_t> otherwise;
};

/// The value at (x, z): between pixels for numbers; the word of the nearest colour (with `else`: within 12 of 255) for
/// classes.
Value valueAt(const MapPicture& picture, plan::Vec2 p);
/// The word at (x, z) of a map of classes, without the making of a value.
const std::string& wordAt(const MapPicture& picture, plan::Vec2 p);

}  // namespace sgm::rules
