// Blocks and roofs over the footprint of their scope (modeler/field/footprint.h, roofs.h).
#include <algorithm>
#include <cmath>
#include <vector>

#include "modeler/core/random.h"
#include "modeler/field/combine.h"
#include "modeler/field/footprint.h"
#include "modeler/field/plan_of.h"
#include "modeler/field/plan_solids.h"
#include "modeler/field/roofs.h"
#include "modeler/field/solids.h"
#include "modeler/plan/reflex.h"

namespace sgm::field {
namespace {

Quantity quantity(const Argument& a) { return {a.node[0], a.value[0]}; }
Quantity number(const PrimitiveInput& in, double value) { return fixed(in.p.x.graph(), value); }

Quantity bottom(const PrimitiveInput& in) { return {-in.half.y, -in.halfValue.y}; }
Quantity top(const PrimitiveInput& in) { return {in.half.y, in.halfValue.y}; }
Quantity height(const PrimitiveInput& in) { return {2.0f * in.half.y, 2 * in.halfValue.y}; }

RoofFoot footOf(const PrimitiveInput& in, Quantity overhang, Quantity fascia) {
    return {bottom(in), overhang, fascia, combine(in.path, hashText("roof"))};
}
RoofFoot footAt(const PrimitiveInput& in, size_t overhang) {
    return footOf(in, quantity(in.arguments[overhang]), quantity(in.arguments[overhang + 1]));
}

/// The height of the scope above the board at the eaves.
Quantity aboveFascia(const PrimitiveInput& in) {
    const Quantity fascia = quantity(in.arguments[1]);
    return {max(2.0f * in.half.y - fascia.node, 1e-3f), std::max(2 * in.halfValue.y - fascia.value, 1e-3)};
}

/// The upper slope of a broken roof, no steeper than the lower one.
Quantity upperOf(const Argument& lower, const Argument& upper) {
    return {min(lower.node[0], upper.node[0]), std::min(lower.value[0], upper.value[0])};
}

/// Where the numbers of a roof stand among its arguments.
struct Cover {
    size_t pitch, overhang, fascia, thickness;
};

/// A roof, or where it has a thickness only what lies less than that below its slopes: open to the rooms under it.
template <class Build>
Field covered(const PrimitiveInput& in, Cover at, const Build& build) {
    const PlanOf plan(in);
    const Quantity overhang = quantity(in.arguments[at.overhang]), fascia = quantity(in.arguments[at.fascia]);
    const Field whole = build(*plan, footOf(in, overhang, fascia));
    const Quantity thickness = quantity(in.arguments[at.thickness]), pitch = quantity(in.arguments[at.pitch]);
    if (thickness.value <= 0) return whole;
    // The rooms reach beyond the eaves, so that the slopes alone are left.
    Graph& graph = in.p.x.graph();
    const double beyond = 1 + overhang.value, down = thickness.value / std::cos(pitch.value);
    RoofFoot rooms = footOf(in, {overhang.node + 1.0f, beyond}, fixed(graph, 0));
    rooms.eaves = {rooms.eaves.node + fascia.node - thickness.node / cos(pitch.node),
                   rooms.eaves.value + fascia.value - down};
    rooms.path = combine(in.path, hashText("rooms"));
    return difference({whole, 0}, {build(*plan, rooms), 0});
}

/// Gables as the argument says.
std::vector<uint32_t> endsOf(const PlanField& plan, const Argument& choice) {
    return gablesOf(plan.footprint(), plan.formula(), static_cast<GableEnds>(static_cast<int>(choice.value[0])));
}

}  // namespace

std::vector<uint32_t> gablesOf(const plan::Footprint& footprint, const plan::Formula& formula, GableEnds ends) {
    if (ends == GableEnds::Auto) return plan::gableEnds(footprint, formula);
    const std::vector<bool> reflex = plan::edgesAtReflexCorners(footprint);
    const std::vector<plan::PlacedEdge> edges = plan::edgesOf(footprint);
    std::vector<uint32_t> found;
    for (uint32_t i = 0; i < edges.size(); ++i) {
        const plan::Facing facing = plan::facingOf(edges[i].normal());
        const bool alongX = facing == plan::Facing::Left || facing == plan::Facing::Right;
        if (!reflex[i] && (ends == GableEnds::All || alongX == (ends == GableEnds::X))) found.push_back(i);
    }
    if (found.size() == edges.size()) return plan::gableEnds(footprint, formula);  // nothing would slope
    return found;
}

double heightOver(const Primitive& row, const std::shared_ptr<const PlanNumbers>& numbers,
                  std::span<const Argument> arguments) {
    Graph graph;
    std::vector<Argument> own(arguments.begin(), arguments.end());
    for (Argument& a : own)
        for (int i = 0; i < 9; ++i) a.node[i] = graph.literal(static_cast<float>(a.value[i]));
    const PlanField plan(numbers, graph);
    const NodeRef half = graph.literal(0.5f);
    const Field f = row.build({graph.position(), {half, half, half}, {.5, .5, .5}, own, &plan, 0});
    return f.bounds.empty() ? 0 : std::max(0.0, static_cast<double>(f.bounds.hi.y) + .5);
}

namespace solids {

Field block(const PrimitiveInput& in) {
    if (!in.plan) return cube(in);
    return field::prism(*in.plan, bottom(in), top(in), combine(in.path, hashText("block")));
}

Field hipRoof(const PrimitiveInput& in) {
    return covered(in, {0, 1, 2, 3}, [&](const PlanField& plan, const RoofFoot& foot) {
        return field::hipRoof(plan, foot, quantity(in.arguments[0]));
    });
}

Field gableRoof(const PrimitiveInput& in) {
    return covered(in, {0, 1, 2, 3}, [&](const PlanField& plan, const RoofFoot& foot) {
        return field::gableRoof(plan, foot, quantity(in.arguments[0]), endsOf(plan, in.arguments[4]));
    });
}

Field halfHipRoof(const PrimitiveInput& in) {
    const auto& a = in.arguments;
    return covered(in, {0, 1, 2, 3}, [&](const PlanField& plan, const RoofFoot& foot) {
        return field::halfHipRoof(plan, foot, quantity(a[0]), endsOf(plan, a[4]), quantity(a[5]));
    });
}

Field mansardRoof(const PrimitiveInput& in) {
    const auto& a = in.arguments;
    return covered(in, {2, 3, 4, 5}, [&](const PlanField& plan, const RoofFoot& foot) {
        return field::mansardRoof(plan, foot, quantity(a[0]), quantity(a[1]), upperOf(a[0], a[2]));
    });
}

Field gambrelRoof(const PrimitiveInput& in) {
    const auto& a = in.arguments;
    return covered(in, {2, 3, 4, 5}, [&](const PlanField& plan, const RoofFoot& foot) {
        return field::gambrelRoof(plan, foot, quantity(a[0]), quantity(a[1]), upperOf(a[0], a[2]), endsOf(plan, a[6]));
    });
}

Field saltboxRoof(const PrimitiveInput& in) {
    const auto& a = in.arguments;
    return covered(in, {0, 2, 3, 4}, [&](const PlanField& plan, const RoofFoot& foot) {
        return field::saltboxRoof(plan, foot, quantity(a[0]), quantity(a[1]), {0, 1}, endsOf(plan, a[5]));
    });
}

Field shedRoof(const PrimitiveInput& in) {
    constexpr plan::Vec2 ways[] = {{0, -1}, {0, 1}, {-1, 0}, {1, 0}};
    const auto to = std::min<size_t>(static_cast<size_t>(in.arguments[4].value[0]), 3);
    return covered(in, {0, 1, 2, 3}, [&](const PlanField& plan, const RoofFoot& foot) {
        return field::shedRoof(plan, foot, quantity(in.arguments[0]), ways[to]);
    });
}

Field butterflyRoof(const PrimitiveInput& in) {
    const plan::Vec2 valley = in.arguments[4].value[0] < .5 ? plan::Vec2{1, 0} : plan::Vec2{0, 1};
    std::vector<Argument> arguments(in.arguments.begin(), in.arguments.end());
    const Quantity pitch = quantity(arguments[0]), thickness = quantity(arguments[3]);
    if (thickness.value > 0) {  // its slopes stand so high over the foot that there is room for it under the valley
        Argument& fascia = arguments[2];
        fascia.node[0] = max(fascia.node[0], thickness.node / cos(pitch.node));
        fascia.value[0] = std::max(fascia.value[0], thickness.value / std::cos(pitch.value));
    }
    PrimitiveInput raised = in;
    raised.arguments = arguments;
    return covered(raised, {0, 1, 2, 3}, [&](const PlanField& plan, const RoofFoot& foot) {
        return field::butterflyRoof(plan, foot, quantity(in.arguments[0]), valley);
    });
}

Field flatRoof(const PrimitiveInput& in) {
    const auto& a = in.arguments;
    return field::flatRoof(*PlanOf(in), footOf(in, number(in, 0), number(in, 0)), quantity(a[0]), quantity(a[1]),
                           quantity(a[2]));
}

Field pyramidRoof(const PrimitiveInput& in) { return field::pyramidRoof(*PlanOf(in), footAt(in, 0), height(in)); }

Field domeRoof(const PrimitiveInput& in) {
    return field::domeRoof(*PlanOf(in), footAt(in, 0), aboveFascia(in), number(in, 0));
}

Field bellRoof(const PrimitiveInput& in) {
    return field::bellRoof(*PlanOf(in), footAt(in, 0), aboveFascia(in), number(in, 0));
}

}  // namespace solids

}  // namespace sgm::field
