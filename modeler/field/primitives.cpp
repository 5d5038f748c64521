#include "modeler/field/primitives.h"

#include <algorithm>
#include <array>

#include "modeler/core/conventions.h"
#include "modeler/field/plan_parameters.h"
#include "modeler/field/plan_solids.h"
#include "modeler/field/solids.h"

namespace sgm::field {

/// The field of each row, defined in solid*.cpp and facade.cpp; `in.arguments` are read in the row's order.
namespace solids {
Field ellipsoid(const PrimitiveInput& in);  ///< also the sphere: a true distance when the half-sizes are equal
Field torus(const PrimitiveInput& in);      ///< (tube)
Field cylinder(const PrimitiveInput& in);
Field cone(const PrimitiveInput& in);
Field capsule(const PrimitiveInput& in);
Field pyramid(const PrimitiveInput& in);
Field prism(const PrimitiveInput& in);
Field wedge(const PrimitiveInput& in);
Field roof(const PrimitiveInput& in);  ///< (round)
Field halfspace(const PrimitiveInput& in);
Field kifs(const PrimitiveInput& in);      ///< (center, scale, fold, turn, passes, terminal, form, bailout)
Field ornament(const PrimitiveInput& in);  ///< (FacadeParameter, modeler/field/facade.h)
Field mesh(const PrimitiveInput& in);      ///< (file)
Field block(const PrimitiveInput& in);
Field taperBlock(const PrimitiveInput& in);
Field shellBlock(const PrimitiveInput& in);
Field moulding(const PrimitiveInput& in);
Field corniceMoulding(const PrimitiveInput& in);
Field plinthMoulding(const PrimitiveInput& in);
Field stringMoulding(const PrimitiveInput& in);
Field sillMoulding(const PrimitiveInput& in);
Field gutterMoulding(const PrimitiveInput& in);
Field hipRoof(const PrimitiveInput& in);
Field gableRoof(const PrimitiveInput& in);      ///< …, ends
Field halfHipRoof(const PrimitiveInput& in);    ///< …, ends, share
Field mansardRoof(const PrimitiveInput& in);    ///< lower, height, upper, overhang, fascia, cover
Field gambrelRoof(const PrimitiveInput& in);    ///< the same, ends
Field saltboxRoof(const PrimitiveInput& in);    ///< front, back, overhang, fascia, cover, ends
Field shedRoof(const PrimitiveInput& in);       ///< …, to
Field butterflyRoof(const PrimitiveInput& in);  ///< …, valley
Field flatRoof(const PrimitiveInput& in);       ///< slab, parapet, thickness
Field pyramidRoof(const PrimitiveInput& in);    ///< overhang, fascia
Field domeRoof(const PrimitiveInput& in);       ///< overhang
Field bellRoof(const PrimitiveInput& in);       ///< overhang, fascia
}  // namespace solids

namespace {

using namespace plan_parameters;

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
constexpr std::array<PrimitiveParameter, std::size(fractalParameters) + N> fractalAnd(
    const PrimitiveParameter (&more)[N]) {
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
     "r of the three folds in half a bay: each mirrors it about itself and beyond twice itself counts the facade id "
     "up"},
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
    {"file", Kind::File, 0, 0, 0, "a closed mesh (.obj, .ply, .stl, .off, .glb, .gltf) in the grammar's own folder"},
};

constexpr PrimitiveJoint apex[] = {{"apex", {0, 1, 0}, {0, 1, 0}}};
constexpr PrimitiveJoint ridge[] = {{"ridge", {0, 1, 0}, {0, 1, 0}}};

constexpr Primitive curved(Primitive row) {
    row.hasFlatFaces = false;
    return row;
}

constexpr Primitive table[] = {
    {"cube", "Box: the whole scope. An exact distance.", {}, solids::cube, true, {}, false, convex::cube},
    curved({"sphere",
            "Ball filling the scope; an ellipsoid when the scope isn't a cube.",
            {},
            solids::ellipsoid,
            true,
            {},
            false,
            convex::ellipsoid}),
    curved({"ellipsoid",
            "Ellipsoid filling the scope, its axes along the scope's.",
            {},
            solids::ellipsoid,
            true,
            {},
            false,
            convex::ellipsoid}),
    curved({"torus", "Ring about y.", torusParameters, solids::torus, true, {}, false, convex::torus}),
    curved({"cylinder",
            "Cylinder along y over the ellipse of the scope's x and z.",
            {},
            solids::cylinder,
            true,
            {},
            false,
            convex::cylinder}),
    curved({"cone",
            "Cone along y: foot on the scope's bottom face, apex in the middle of the top.",
            {},
            solids::cone,
            true,
            apex,
            false,
            convex::cone}),
    {"pyramid",
     "Pyramid over the scope's bottom face, apex in the middle of the top.",
     {},
     solids::pyramid,
     true,
     apex,
     false,
     convex::pyramid},
    {"prism",
     "Triangular prism along z: a gable over the scope's bottom face.",
     {},
     solids::prism,
     true,
     ridge,
     false,
     convex::prism},
    {"wedge",
     "Ramp: the scope below the plane from its upper -x edge to its lower +x edge.",
     {},
     solids::wedge,
     true,
     {},
     false,
     convex::wedge},
    curved({"capsule",
            "Segment along y with round ends of the scope's least half-size.",
            {},
            solids::capsule,
            true,
            {},
            false,
            convex::capsule}),
    curved({"roof", "Pyramid sides morphed to an ellipsoid, cut at the foot (the scope's bottom face).", roofParameters,
            solids::roof, true, apex, true}),
    curved({"kifs", "Kaleidoscopic fractal filling the scope and cut by it (McGraw, algorithm 1).", kifsParameters,
            solids::kifs}),
    curved({"mesh", "Mesh from a file, stretched to fill the scope; sampled 128 times along its longest side.",
            meshParameters, solids::mesh}),
    curved({"ornament",
            "Storeys and mirrored bays of a fractal filling the scope (McGraw, eq. 4, algorithm 2). What `clad` "
            "dresses with.",
            ornamentParameters, solids::ornament}),
    {"block",
     "Prism over the footprint, or the whole scope where it has none. What a terminal without a solid is.",
     {},
     solids::block,
     true,
     {},
     false,
     convex::cube,
     PlanUse::Fills},
    {"taperBlock",
     "Block whose sides lean; the footprint is that of its foot.",
     taperParameters,
     solids::taperBlock,
     true,
     {},
     false,
     nullptr,
     PlanUse::Fills},
    {"shellBlock",
     "Block with a room inside: walls along the outline, a floor and maybe a ceiling.",
     shellParameters,
     solids::shellBlock,
     true,
     {},
     false,
     nullptr,
     PlanUse::Fills},
    {"moulding",
     "A profile of up to twelve points swept along the outline, mitred at every corner, courts included.",
     mouldingParameters,
     solids::moulding,
     true,
     {},
     false,
     nullptr,
     PlanUse::OwnHeight},
    {"corniceMoulding",
     "Cornice along the outline, as high as the scope and widest at its top.",
     corniceParameters,
     solids::corniceMoulding,
     true,
     {},
     false,
     nullptr,
     PlanUse::Fills},
    {"plinthMoulding",
     "Plinth along the outline, as high as the scope.",
     plinthParameters,
     solids::plinthMoulding,
     true,
     {},
     false,
     nullptr,
     PlanUse::Fills},
    {"stringMoulding",
     "String course along the outline, as high as the scope.",
     stringParameters,
     solids::stringMoulding,
     true,
     {},
     false,
     nullptr,
     PlanUse::Fills},
    {"sillMoulding",
     "Sill along the outline: its top falls outward.",
     stringParameters,
     solids::sillMoulding,
     true,
     {},
     false,
     nullptr,
     PlanUse::Fills},
    {"gutterMoulding",
     "Half-round gutter along the outline, open at its top.",
     gutterParameters,
     solids::gutterMoulding,
     true,
     {},
     false,
     nullptr,
     PlanUse::Fills},
    {"hipRoof",
     "Roof with a plane over every edge of the footprint.",
     hipParameters,
     solids::hipRoof,
     true,
     {},
     false,
     nullptr,
     PlanUse::OwnHeight},
    {"gableRoof",
     "Roof whose end walls go up to the ridge.",
     gableParameters,
     solids::gableRoof,
     true,
     {},
     false,
     nullptr,
     PlanUse::OwnHeight},
    {"halfHipRoof",
     "Gable roof whose points are hipped.",
     halfHipParameters,
     solids::halfHipRoof,
     true,
     {},
     false,
     nullptr,
     PlanUse::OwnHeight},
    {"mansardRoof",
     "Steep planes over every edge, flatter ones above.",
     mansardParameters,
     solids::mansardRoof,
     true,
     {},
     false,
     nullptr,
     PlanUse::OwnHeight},
    {"gambrelRoof",
     "A mansard roof between gables.",
     gambrelParameters,
     solids::gambrelRoof,
     true,
     {},
     false,
     nullptr,
     PlanUse::OwnHeight},
    {"saltboxRoof",
     "Gable roof with a pitch of its own toward the front (+z).",
     saltboxParameters,
     solids::saltboxRoof,
     true,
     {},
     false,
     nullptr,
     PlanUse::OwnHeight},
    {"shedRoof",
     "One plane over the whole footprint.",
     shedParameters,
     solids::shedRoof,
     true,
     {},
     false,
     nullptr,
     PlanUse::OwnHeight},
    {"butterflyRoof",
     "Two planes that fall to a valley in the middle.",
     butterflyParameters,
     solids::butterflyRoof,
     true,
     {},
     false,
     nullptr,
     PlanUse::OwnHeight},
    {"flatRoof",
     "A slab with a parapet round it.",
     flatParameters,
     solids::flatRoof,
     true,
     {},
     false,
     nullptr,
     PlanUse::OwnHeight},
    {"pyramidRoof",
     "Planes from every edge to the point at the scope's top over the centre of mass; where an edge looks away from "
     "it, planes of one pitch.",
     pyramidRoofParameters, solids::pyramidRoof, true, apex, false, nullptr, PlanUse::Fills},
    curved({"domeRoof", "Quarter ellipses over every edge: a dome as high as the scope.", curvedRoofParameters,
            solids::domeRoof, true, apex, false, nullptr, PlanUse::Fills}),
    curved({"bellRoof", "As the dome, with a hollow foot.", curvedRoofParameters, solids::bellRoof, true, apex, false,
            nullptr, PlanUse::Fills}),
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
