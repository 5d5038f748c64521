// An element's attributes, evaluated, and what the `apply` of an operation works with.
// Enters: checked attributes and where they stand. Leaves: numbers for the newcomer. Assumes attributes of phase Scope
// are applied before the others, which may ask for the newcomer's size.
#pragma once

#include <compare>
#include <optional>
#include <string>

#include "grammar/derive/expressions.h"

namespace sgm::derive {

/// Pictures that cover a shape, by place in Grammar::images + 1, 0 for none.
struct PlacedTexture {
    uint32_t color = 0, normals = 0, roughness = 0;
    float width_m = 1, height_m = 1;  ///< of a tile
    bool fits = false;                ///< whole numbers of tiles fill what they cover
    auto operator<=>(const PlacedTexture&) const = default;
};

/// How a newcomer looks.
struct EvaluatedLook {
    std::optional<Vec3f> color;            ///< linear RGB
    const rules::Expr* colorBy = nullptr;  ///< what gave the colour
    std::optional<float> rough, metal;
    std::optional<PlacedTexture> texture;
    std::optional<uint32_t> material;  ///< what `of` names, index into Grammar::materials or none
};

/// What an element's attributes say of its newcomer, or of the matched shape where no shape stands beside them.
struct EvaluatedAttributes : EvaluatedLook {
    Scope scope;    ///< size and axes; the centre comes from the mating
    Vec3d moved_m;  ///< added to where it is placed, in the object's frame
    Vec3d grown_m;  ///< added as well where no joint places it: keeps the foot of a scope that became higher
    double overlap = 0, amount = 0.5, blend_m = 0;
    struct Span {
        Vec3d from_m, to_m;  ///< about the centre of the scope it is measured against, in its axes
        syntax::SourceSpan at;
    };
    std::optional<Span> span;  ///< between which points the newcomer's y runs
    Extras extras;
    bool ownsFootprint = false;                  ///< the element set the scope's footprint itself
    bool vanishes = false;                       ///< nothing is left of the footprint: no shape is made
    std::optional<syntax::SourceSpan> sizeSpan;  ///< of the attribute that set the size
};

struct AttributeContext {
    const Place& place;  ///< its scope is what sizes and moves are measured against
    EvaluatedAttributes& out;

    rules::Value evaluate(const rules::Expr& expr) const { return derive::evaluate(expr, place); }
    double number(const rules::Expr& expr) const { return derive::number(expr, place); }
    /// As derive::numberWithin() where the attribute stands.
    double numberWithin(const rules::Expr& expr, double lo, double hi, std::string_view name) const {
        return derive::numberWithin(expr, place, lo, hi, name);
    }
    Vector vector(const rules::Expr& expr, bool eachDraws) const { return derive::vector(expr, place, eachDraws); }
    /// Three lengths in metres; shares are of the scope's size.
    Vec3d metres(const Vector& v) const;
    Vec3d metres(const rules::Expr& expr, bool eachDraws) const { return metres(vector(expr, eachDraws)); }
    SolidValue solid(const rules::Solid& solid) const { return evaluateSolid(solid, place); }
    /// The footprint of the newcomer's scope, metres about its centre; the rectangle where it has none.
    plan::Footprint footprint() const;
    /// Gives the newcomer's scope a footprint (metres about its centre), whose bounding box it becomes along x and z,
    /// in its place. An empty one lets the newcomer vanish; one that isn't sound is an error located at `span`.
    void setFootprint(plan::Footprint footprint, syntax::SourceSpan span);
    /// Says whether anything is left of the footprint: else the newcomer vanishes, which is told where it always does.
    void leave(bool anything, syntax::SourceSpan span);
    const rules::Grammar& grammar() const;
    /// Ends the derivation with an error located at `span`.
    void fail(const std::string& what, syntax::SourceSpan span) const;
};

}  // namespace sgm::derive
