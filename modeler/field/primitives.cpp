#include "modeler/field/primitives.h"

#include <algorithm>
#include <array>

#include "modeler/core/conventions.h"
#include "modeler/field/solids.h"

namespace sgm::field {

namespace {

using Kind = ParameterKind;

constexpr PrimitiveParameter torusParameters[] = {
    {"tube", Kind::Share, 0.25, 0.02, 0.5,
     "radius of the tube as a share of the outer radius; the tube is as high as the scope"},
};
constexpr PrimitiveParameter roofParameters[] = {
    {"round", Kind::Share, 0, 0, 1, "0 is the pyramid's sides, 1 an ellipsoid over the same foot"},
};

/// The fractal itself: what `kifs` and `ornament` begin with.
constexpr PrimitiveParameter fractalParameters[] = {
    {"center", Kind::Vector, 1, 0.05, 2,
     "centre of scaling; its largest component reaches the scope's faces. All 1: the Menger sponge"},
    {"scale", Kind::Share, 3, 1.2, 6, "scale of a pass: 3 is the sponge, 3.5 sparse"},
    {"fold", Kind::Rotation, 0, -pi, pi,
     "rotation R2 after the folds; useful: y -20 ... 25, z 0 ... 35, x -35 ... 15 degrees"},
    {"turn", Kind::Rotation, 0, -pi, pi, "rotation R1 before the folds; about y 7 degrees crumbles, 45 is octagonal"},
    {"passes", Kind::Count, 5, 1, 12, "passes of the loop: each adds details one scale smaller"},
    {"terminal", Kind::Choice, 0, 0, 1, "what the last copies are: balls as in the paper, or crisper cubes",
     "ball|cube"},
};
template <size_t N>
constexpr std::array<PrimitiveParameter, std::size(fractalParameters) + N> fractalAnd(const PrimitiveParameter (&more)[N]) {
    std::array<PrimitiveParameter, std::size(fractalParameters) + N> all{};
    std::copy(std::begin(fractalParameters), std::end(fractalParameters), all.begin());
    std::copy(std::begin(more), std::end(more), all.begin() + std::size(fractalParameters));
    return all;
}

constexpr auto kifsParameters = fractalAnd({
    {"form", Kind::Choice, 0, 0, 1,
     "last fold: continuous, or with the jump the paper prints (no distance bound when turned)", "continuous|jump"},
    {"bailout", Kind::Share, 0, 0, 1e6,
     "squared radius (4 at least) beyond which passes stop; 0 never. No distance bound"},
});
constexpr auto ornamentParameters = fractalAnd({
    {"bay", Kind::Length, 4, 0.05, 1000, "period along the walls (w)"},
    {"storey", Kind::Length, 3, 0.05, 1000, "height of a storey (h)"},
    {"mirror", Kind::Vector, 0.25, 0, 1,
     "r of the three folds in half a bay: each mirrors it about itself and beyond twice itself counts the facade id up"},
    {"zoom", Kind::PerId, 1.5, -20, 20, "scale of the fractal's coordinates in the parts of facade id 0, 1, 2, 3"},
    {"pan", Kind::PerId, 0.5, -20, 20, "shift of the fractal's coordinates there; nearer 0 is deeper in the fractal"},
    {"rise", Kind::Share, 1, 0.05, 4, "how far up the fractal a storey reaches (s_y)"},
    {"wall", Kind::Length, 0.4, 0.001, 100, "between the outer and the inner shell, where it clads a solid"},
    {"top", Kind::Length, 0.1, 0, 100, "the same below the top, at most as much as the wall"},
    {"fit", Kind::Choice, 0, 0, 1,
     "whole: bays and storeys as long as divides the scope, from its corner; free: as said, bays from its middle",
     "whole|free"},
    {"round", Kind::Length, 0, 0, 10000, "> 0: bays run along the circle of this radius about y (eqs. 5, 6)"},
    {"core", Kind::Length, 0, 0, 10000, "round: radius inside which nothing is carved; 0 is half of round"},
    {"along", Kind::Length, 0, 0, 10000, "round: metres of facade to a radian (s_theta); 0 is round, true to length"},
    {"across", Kind::Share, 1, 0.05, 20, "round: scale across the wall (s_r)"},
    {"swing", Kind::Angle, 0, -2 * pi, 2 * pi, "round: turns the bays about y (c_theta); they begin towards +z"},
});

constexpr PrimitiveParameter meshParameters[] = {
    {"file", Kind::File, 0, 0, 0, "a closed mesh (.obj, .ply, .stl, .off) in the grammar's own folder"},
};

constexpr PrimitiveJoint apex[] = {{"apex", {0, 1, 0}, {0, 1, 0}}};
constexpr PrimitiveJoint ridge[] = {{"ridge", {0, 1, 0}, {0, 1, 0}}};

constexpr Primitive table[] = {
    {"cube", "Box: the whole scope. An exact distance.", {}, solids::cube, true, {}, false, convex::cube},
    {"sphere", "Ball filling the scope; an ellipsoid when the scope isn't a cube.", {}, solids::ellipsoid, true, {}, false,
     convex::ellipsoid},
    {"ellipsoid", "Ellipsoid filling the scope, its axes along the scope's.", {}, solids::ellipsoid, true, {}, false,
     convex::ellipsoid},
    {"torus", "Ring about y.", torusParameters, solids::torus, true, {}, false, convex::torus},
    {"cylinder", "Cylinder along y over the ellipse of the scope's x and z.", {}, solids::cylinder, true, {}, false,
     convex::cylinder},
    {"cone",
     "Cone along y: foot on the scope's bottom face, apex in the middle of the top.",
     {},
     solids::cone,
     true,
     apex,
     false,
     convex::cone},
    {"pyramid",
     "Pyramid over the scope's bottom face, apex in the middle of the top.",
     {},
     solids::pyramid,
     true,
     apex,
     false,
     convex::pyramid},
    {"prism", "Triangular prism along z: a gable over the scope's bottom face.", {}, solids::prism, true, ridge, false,
     convex::prism},
    {"wedge", "Ramp: the scope below the plane from its upper -x edge to its lower +x edge.", {}, solids::wedge,
     true, {}, false, convex::wedge},
    {"capsule", "Segment along y with round ends of the scope's least half-size.", {}, solids::capsule,
     true, {}, false, convex::capsule},
    {"roof", "Pyramid sides morphed to an ellipsoid, cut at the foot (the scope's bottom face).", roofParameters,
     solids::roof, true, apex, true},
    {"kifs", "Kaleidoscopic fractal filling the scope and cut by it (McGraw, algorithm 1).", kifsParameters,
     solids::kifs},
    {"mesh", "Mesh from a file, stretched to fill the scope; sampled 128 times along its longest side.", meshParameters,
     solids::mesh},
    {"ornament",
     "Storeys and mirrored bays of a fractal filling the scope (McGraw, eq. 4, algorithm 2). What `clad` dresses with.",
     ornamentParameters, solids::ornament},
    {"halfspace",
     "Everything below the scope's middle plane y = 0. Unbounded: may only cut.",
     {},
     solids::halfspace,
     false,
     {},
     false,
     convex::halfspace},
};

}  // namespace

std::span<const Primitive> primitives() { return table; }

const Primitive* findPrimitive(std::string_view name) {
    for (const Primitive& row : table)
        if (row.name == name) return &row;
    return nullptr;
}

}  // namespace sgm::field
