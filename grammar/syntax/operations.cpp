#include "grammar/syntax/operations.h"

#include <algorithm>

namespace sgm::syntax {

std::string_view describe(ArgumentType type) {
    switch (type) {
        case ArgumentType::Number:
            return "a number";
        case ArgumentType::Length:
            return "a length";
        case ArgumentType::Angle:
        case ArgumentType::Rotation:
            return "an angle";
        case ArgumentType::Size:
            return "a size";
        case ArgumentType::Vector:
            return "a number or (x, y, z)";
        case ArgumentType::Color:
            return "a colour";
        case ArgumentType::Joint:
            return "a joint";
        case ArgumentType::Shape:
            return "'last', 'any(…)' or 'each(…)'";
        case ArgumentType::Noise:
            return "'billow(…)' or 'fbm(…)'";
        case ArgumentType::Solid:
            return "a solid";
        case ArgumentType::Axis:
            return "an axis, x, y or z";
        case ArgumentType::Name:
            return "a word";
        case ArgumentType::Start:
            return "the name of a start";
        case ArgumentType::Plan:
            return "a plan such as 'ell(16, 12, 5, 6)'";
        case ArgumentType::Symbol:
            return "the name of a shape";
        case ArgumentType::Material:
            return "a material";
        case ArgumentType::Cut:
            return "an axis, 'along' and a word for edges, or 'area' and an axis";
        case ArgumentType::Point:
            return "a point (x, y, z) or a joint";
        case ArgumentType::File:
            return "the name of a file in quotes";
    }
    return "a value";
}

const Operation* OperationTable::find(std::string_view name) const {
    const auto row = std::find_if(rows_.begin(), rows_.end(), [&](const Operation* o) { return o->name == name; });
    return row == rows_.end() ? nullptr : *row;
}

}  // namespace sgm::syntax
