// Expressions against a shape: its scope, inherited values, locals, chain position and random stream.
// Enters: a checked Expr and where it stands. Leaves: values. Assumes kinds as `check` left them.
// A range draws by key = hash(shape's key, attribute, component): a pure function, so order and neighbours can't
// matter.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "grammar/derive/shape_tree.h"

namespace sgm::derive {

class TreeBuilder;

/// Where an expression stands.
struct Place {
    const ShapeTree* tree = nullptr;
    std::span<const rules::Value> params;
    std::span<const uint64_t> counts;               ///< derived shapes by symbol, for count(Name)
    std::span<const rules::Value> locals;           ///< `for` variables and the i of `repeat`
    Scope scope;                                    ///< the matched scope
    ShapeId valuesAt = none;                        ///< nearest shape with `with` values
    uint64_t key = 0;                               ///< the stream that draws
    double ramp = 0;                                ///< position in the chain, 0 first … 1 last
    TreeBuilder* builder = nullptr;                 ///< told of values that nothing above the shape sets; may be null
    const std::vector<uint64_t>* series = nullptr;  ///< by local that counts: the stream of its repetition
    const Vec3d* extents_m = nullptr;               ///< what shares of a mixed size are of; null: the scope's size
    ShapeId host = none;                            ///< the shape whose joints are named; none: the scope's faces alone
};

/// Any expression but a Figure.
rules::Value evaluate(const rules::Expr& expr, const Place& place);
/// The first component as a plain number; much cheaper than `evaluate` for arithmetic.
double number(const rules::Expr& expr, const Place& place);
inline bool holds(const rules::Expr& expr, const Place& place) { return number(expr, place) != 0; }
/// A whole number: a range of integers draws one of them, both ends included; anything else is rounded down.
double wholeNumber(const rules::Expr& expr, const Place& place);

/// What a choice says that has nothing to choose from.
inline constexpr std::string_view allZero = "all weights are 0, so nothing can be drawn";
/// Draws by weight at the turn that the local `counter` counts, with regard to the turns before it: another than in the
/// last one (Distinct), or each once before any comes again (Shuffled). An index, or `none` when all weights are 0.
/// O(1) for turns in order; a function of the stream, the weights and the turn alone.
uint32_t drawInSeries(std::span<const double> weights, rules::Series series, uint32_t counter, uint64_t draw,
                      const Place& place, syntax::SourceSpan span);
/// Draws among weights (those below 0 count as 0) by the stream `key`: an index, or `none` when all are 0.
uint32_t drawByWeight(std::span<const double> weights, uint64_t key);

/// A solid with its numbers bound.
SolidValue evaluateSolid(const rules::Solid& solid, const Place& place);
/// The numbers of a primitive's arguments within their ranges, without nodes: for what is asked before lowering.
std::vector<field::Argument> argumentNumbers(const SolidValue& solid);

/// Three components with their units.
struct Vector {
    Vec3d n;
    rules::Unit unit[3];
};
/// One number counts for every axis; with `eachDraws`, a range of numbers draws every component by itself.
Vector vector(const rules::Expr& expr, const Place& place, bool eachDraws);

/// The first component, or the nearest of `lo` and `hi` where it lies beyond them: the derivation then warns of `name`,
/// as "'blend'", at the expression.
double numberWithin(const rules::Expr& expr, const Place& place, double lo, double hi, std::string_view name);

/// The rotation that an angle (about y), three angles (x, then y, then z) or a rotation means.
Mat3 rotation(const rules::Value& value);

/// The name among inherited values of what a file says of an outline: one that no `with` can set.
std::string propertyName(std::string_view property);

}  // namespace sgm::derive
