// The primitive table: every solid a grammar can name.
// Enters: local coordinates in metres about the scope's centre, half-sizes and parameters as graph numbers.
// Leaves: a Field that fills the scope. Assumes half-sizes > 0. Formulas: SG-M III-E with the errata in docs/papers.md.
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "modeler/field/convex.h"
#include "modeler/field/field.h"

namespace sgm::field {

/// How a primitive parameter is read and shown.
/// PerId: four numbers, one for each facade id; one number serves all. Point: two lengths.
enum class ParameterKind { Share, Length, Angle, Count, Vector, Rotation, Choice, File, PerId, Point };

/// One typed parameter of a primitive.
struct PrimitiveParameter {
    std::string_view name;
    ParameterKind kind;
    double fallback;  ///< in metres, radians or plain numbers; every component of a vector
    double lo, hi;    ///< inclusive range
    std::string_view doc;
    std::string_view choices{};  ///< for Choice: names separated by '|'; the value is the index
    bool optional = false;       ///< may be left out: then `fallback` says so, and the row reads it as nothing
    bool isThickness = false;    ///< of a wall or shell that is thinner than the scope, metres; 0 for none
};

/// A value with the node(s) that carry it (slots, or expressions over them) and its present number(s) for bounds.
/// A Share/Length/Angle/Count/Choice uses [0]; a Point two; a Vector three; PerId four; a Rotation nine (matrix by
/// columns, world from local); a File what was read from it.
struct Argument {
    NodeRef node[9];
    double value[9]{};
    SampledGridPtr grid;
};

class PlanField;

/// What a primitive is built from.
struct PrimitiveInput {
    Point p;                              ///< position in the solid's frame, metres, origin at the scope's centre
    Point half;                           ///< half-size of the scope along x, y, z, metres
    Vec3d halfValue;                      ///< the same, present numbers
    std::span<const Argument> arguments;  ///< one per row parameter, in row order
    const PlanField* plan = nullptr;      ///< the scope's footprint about its centre, metres; null: the rectangle
    uint64_t path = 0;                    ///< keys the slots of a row over a footprint
};

/// A joint a solid offers besides the shared ones, in shares of the half-size.
struct PrimitiveJoint {
    std::string_view name;
    Vec3d at;      ///< −1 … 1 of the half-size
    Vec3d facing;  ///< unit direction; zero meets any other
};

/// What a row does with the footprint of its scope (modeler/plan).
enum class PlanUse : uint8_t {
    None,       ///< fills the scope, whatever its footprint
    Fills,      ///< stands over the footprint and fills the scope's height
    OwnHeight,  ///< stands over the footprint, as high as its parameters make it (heightOver)
};

/// One row.
struct Primitive {
    std::string_view name;
    std::string_view doc;
    std::span<const PrimitiveParameter> parameters;
    Field (*build)(const PrimitiveInput&);
    bool bounded = true;  ///< false: fills half of space, may only cut
    std::span<const PrimitiveJoint> joints{};
    bool morphs = false;                    ///< its first parameter is the share of a morph
    convex::PartsOf convexParts = nullptr;  ///< null where it has none, or where they must be found from its field
    PlanUse plan = PlanUse::None;
    bool hasFlatFaces = true;  ///< its surface is made of planes
};

/// The table, in the order of docs/reference.md.
std::span<const Primitive> primitives();
/// The row called `name`, or null.
const Primitive* findPrimitive(std::string_view name);

}  // namespace sgm::field
