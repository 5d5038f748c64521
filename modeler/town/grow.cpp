#include "modeler/town/grow.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <queue>

#include "modeler/core/random.h"
#include "modeler/town/curves.h"
#include "modeler/town/grower.h"
#include "modeler/town/own_streets.h"
#include "modeler/town/tensor_field.h"

namespace sgm::town {
namespace {

constexpr double degree = 0.017453292519943295;
using Unit = RoadParameter::Unit;

constexpr RoadParameter table[] = {
    {"highway", &RoadParameters::highway_m, Unit::Length, 2, 200, "2 … 200 m", "width of highways"},
    {"street", &RoadParameters::street_m, Unit::Length, 2, 200, "2 … 200 m", "width of streets"},
    {"step", &RoadParameters::step_m, Unit::Length, 20, 1000, "20 … 1000 m", "length of a piece of highway"},
    {"block", &RoadParameters::block_m, Unit::Length, 20, 1000, "20 … 1000 m", "length of a piece of street"},
    {"turn", &RoadParameters::turn, Unit::Angle, 0, 60 * degree, "0 … 60deg", "by which a piece of highway may bend"},
    {"look", &RoadParameters::look_m, Unit::Length, 20, 10000, "20 m … 10 km",
     "how far a highway looks for what it seeks"},
    {"probes", &RoadParameters::probes, Unit::Count, 1, 32, "1 … 32", "directions it looks in"},
    {"junction", &RoadParameters::junction, Unit::Count, 1, 1000, "1 … 1000", "pieces of highway between its branches"},
    {"delay", &RoadParameters::delay, Unit::Count, 0, 10000, "0 … 10000", "ticks before streets leave a highway"},
    {"snap", &RoadParameters::snap_m, Unit::Length, 1, 500, "1 … 500 m", "a road that ends nearer to another joins it"},
    {"angle", &RoadParameters::angle, Unit::Angle, 5 * degree, 80 * degree, "5 … 80deg",
     "least angle between two roads"},
    {"bridge", &RoadParameters::bridge_m, Unit::Length, 0, 5000, "0 … 5 km",
     "longest bridge, over water and where `height` has a valley; 0 for none"},
    {"tunnel", &RoadParameters::tunnel_m, Unit::Length, 0, 5000, "0 … 5 km",
     "longest tunnel through what `height` lifts; 0 for none"},
    {"spans", &RoadParameters::streetBridges, Unit::Share, 0, 1, "0 … 100%",
     "share of the streets that may have bridges and tunnels"},
    {"slope", &RoadParameters::slope, Unit::Share, 0, 10, "0 … 1000%", "steepest rise along a road"},
    {"bank", &RoadParameters::bank, Unit::Share, .05, 10, "5 … 1000%",
     "steepest rise of the ground that `height` lifts where it is cut or filled beside roads, water and buildings"},
    {"bed", &RoadParameters::bed_m, Unit::Length, 0, 200, "0 … 200 m", "depth of water in ground that `height` lifts"},
    {"axis", &RoadParameters::axis, Unit::Angle, -360 * degree, 360 * degree, "at most 360deg",
     "of the raster and the first highways, from +x towards +z"},
    {"reach", &RoadParameters::reach_m, Unit::Length, 10, 2000, "10 m … 2 km",
     "how far from water `shore` turns the roads of the field"},
    {"highwayRadius", &RoadParameters::highwayRadius_m, Unit::Length, 0, 2000, "0 … 2 km",
     "least radius of the curves in bends of highways; 0 for none"},
    {"streetRadius", &RoadParameters::streetRadius_m, Unit::Length, 0, 2000, "0 … 2 km",
     "least radius of the curves in bends of streets; 0 for none"},
    {"limit", &RoadParameters::limit, Unit::Count, 1, 1e6, "1 … 1000000", "most pieces of road"},
};

/// The end of a road that may go on.
struct Tip {
    uint64_t tick = 0, key = 0;
    uint32_t node = noIndex;
    Vec2 heading;
    RoadClass kind = RoadClass::Street;
    double sinceJunction = 0;  ///< pieces
    /// Later ones are greater.
    friend bool operator>(const Tip& a, const Tip& b) {
        return a.tick != b.tick ? a.tick > b.tick : a.key != b.key ? a.key > b.key : a.node > b.node;
    }
};

Vec2 leftOf(Vec2 heading) { return {heading.z, -heading.x}; }  // seen from above, y up

class Growth {
public:
    Growth(const RoadParameters& parameters, const Land& land, RoadGraph& graph)
        : parameters_(parameters), land_(land), graph_(graph), grower_(graph, parameters, land) {}

    Status run(Progress* progress, OwnStreetsReport& report);

private:
    Status begin(OwnStreetsReport& report);
    void pushSides(const OwnStop& stop);
    void finish(OwnStreetsReport& report);
    std::optional<Vec2> densest() const;
    Vec2 best(Vec2 from, Vec2 heading) const;
    Vec2 snapped(Vec2 from, Vec2 heading, RoadClass kind) const;
    void push(uint64_t tick, uint32_t node, Vec2 heading, RoadClass kind, double sinceJunction);
    void branch(const Tip& tip, const Built& built);
    void joinEnds();

    const RoadParameters& parameters_;
    const Land& land_;
    RoadGraph& graph_;
    Grower grower_;
    Vec2 centre_;
    std::optional<TensorField> field_;
    std::priority_queue<Tip, std::vector<Tip>, std::greater<>> tips_;
};

/// The place of the greatest pull on a grid over the area, on dry land outside parks.
std::optional<Vec2> Growth::densest() const {
    constexpr int steps = 64;
    std::optional<Vec2> found;
    double most = 0, nearest = 0;
    const Vec2 middle = (parameters_.lo + parameters_.hi) * .5;
    for (int i = 1; i < steps; ++i)
        for (int k = 1; k < steps; ++k) {
            const Vec2 size = parameters_.hi - parameters_.lo;
            const Vec2 p = parameters_.lo + Vec2{size.x * i / steps, size.z * k / steps};
            if (grower_.isWater(p) || grower_.isPark(p)) continue;
            const double pull = grower_.pullAt(p), away = dot(p - middle, p - middle);
            if (found && (pull < most || (pull == most && away >= nearest))) continue;
            found = p, most = pull, nearest = away;
        }
    return found;
}

/// The heading, within the arc a highway may bend, along which most of what it seeks lies: near ground counts more.
Vec2 Growth::best(Vec2 from, Vec2 heading) const {
    const int probes = static_cast<int>(parameters_.probes);
    if (probes < 2 || parameters_.turn <= 0) return heading;
    Vec2 found = heading;
    double most = -1;
    const double step_m = std::max(parameters_.step_m, parameters_.look_m / 64);
    // From the middle outward, so that level ground is crossed straight on.
    for (int n = 0; n < probes; ++n) {
        const int k = n % 2 ? -(n + 1) / 2 : n / 2;
        const double share = probes > 2 ? k / std::floor(probes / 2.0) : k;
        const Vec2 way = turnedBy(heading, directionAt(parameters_.turn * share));
        double sum = 0;
        for (double r = step_m; r <= parameters_.look_m; r += step_m) {
            const Vec2 p = from + way * r;
            if (grower_.isInside(p)) sum += grower_.pullAt(p) / r;
        }
        if (sum > most * (1 + 1e-9)) most = sum, found = way;
    }
    return found;
}

/// The pattern's direction nearest to the heading.
Vec2 Growth::snapped(Vec2 from, Vec2 heading, RoadClass kind) const {
    if (parameters_.pattern == Pattern::Grown) return heading;
    if (field_)
        return field_->direction(from, heading, kind == RoadClass::Highway ? parameters_.step_m : parameters_.block_m);
    Vec2 axis = directionAt(parameters_.axis);
    if (parameters_.pattern == Pattern::Radial) {
        const Vec2 out = from - centre_;
        if (dot(out, out) < 1) return heading;
        axis = unit(out);
    }
    Vec2 found = axis;
    for (const Vec2 d : {Vec2{-axis.z, axis.x}, axis * -1, Vec2{axis.z, -axis.x}})
        if (dot(d, heading) > dot(found, heading)) found = d;
    return found;
}

void Growth::push(uint64_t tick, uint32_t node, Vec2 heading, RoadClass kind, double sinceJunction) {
    const Point at = graph_.at(node);
    const auto whole = [](double v) { return static_cast<uint64_t>(static_cast<int64_t>(std::floor(v * 4096))); };
    uint64_t key = combine(parameters_.random, combine(static_cast<uint32_t>(at.x), static_cast<uint32_t>(at.z)));
    key = combine(key, combine(whole(heading.x), whole(heading.z)));
    tips_.push({tick, key, node, heading, kind, sinceJunction});
}

/// What goes on from the end of a piece (the paper's globalRules).
void Growth::branch(const Tip& tip, const Built& built) {
    const Vec2 at = graph_.metresAt(built.node), ahead = unit(at - graph_.metresAt(tip.node));
    const Vec2 left = leftOf(ahead), right = left * -1;
    const uint64_t next = tip.tick + 1;
    const bool spreads = grower_.spreadsAt(at);
    if (tip.kind == RoadClass::Highway) {
        const bool junction = tip.sinceJunction + 1 >= parameters_.junction;
        push(next, built.node, ahead, RoadClass::Highway, junction ? 0 : tip.sinceJunction + 1);
        if (!junction && !spreads) return;
        const RoadClass kind = junction ? RoadClass::Highway : RoadClass::Street;
        const uint64_t when = junction ? next : next + static_cast<uint64_t>(parameters_.delay);
        for (const Vec2 side : {left, right}) push(when, built.node, side, kind, 0);
        return;
    }
    if (!spreads) return;
    push(next, built.node, ahead, RoadClass::Street, 0);
    if (parameters_.turns != Turns::Right) push(next, built.node, left, RoadClass::Street, 0);
    if (parameters_.turns != Turns::Left) push(next, built.node, right, RoadClass::Street, 0);
}

void Growth::joinEnds() {
    for (uint32_t n = 0; n < graph_.nodes().size(); ++n)
        if (graph_.degree(n) == 1) grower_.join(n, 1.5 * parameters_.block_m);
}

/// Streets on both sides of a place along an own street; where it ends, the street itself goes on.
void Growth::pushSides(const OwnStop& stop) {
    const Vec2 at = graph_.metresAt(stop.node);
    if (graph_.degree(stop.node) == 1) {
        const uint32_t last = graph_.nodes()[stop.node].edges.front();
        push(0, stop.node, unit(graph_.along(last, stop.node)) * -1, graph_.edge(last).kind, 0);
    }
    if (!grower_.spreadsAt(at) || grower_.isWater(at)) return;
    const auto when = stop.kind == RoadClass::Highway ? static_cast<uint64_t>(parameters_.delay) : 0;
    for (const Vec2 side : {leftOf(stop.heading), leftOf(stop.heading) * -1})
        push(1 + when, stop.node, side, RoadClass::Street, 0);
}

/// The first tips: at own streets, else where the pull is greatest, and wherever `from` says.
Status Growth::begin(OwnStreetsReport& report) {
    std::vector<OwnStop> stops;
    if (land_.streets) stops = layStreets(graph_, *land_.streets, parameters_, land_, report);
    for (const OwnStop& stop : stops) pushSides(stop);
    const bool isOwn = !stops.empty();
    const auto seed = parameters_.from ? parameters_.from : isOwn ? graph_.metresAt(stops[0].node) : densest();
    const bool isLegal = seed && grower_.isInside(*seed) && !grower_.isWater(*seed) && !grower_.isPark(*seed);
    if (!isLegal && (!isOwn || parameters_.from))
        return Error{Error::Kind::Input,
                     seed ? fmt::format("no road can begin at ({:.6g}, {:.6g}): it lies in water, in a "
                                        "park or outside of the scope",
                                        seed->x, seed->z)
                          : std::string("no road can begin: all of the scope is water or park")};
    centre_ = parameters_.centre.value_or(*seed);
    if (parameters_.pattern == Pattern::Field) field_.emplace(parameters_, land_, centre_);
    if (isOwn && !parameters_.from) return Done{};
    const uint32_t first = graph_.addNode(pointAt(*seed));
    const Vec2 axis = directionAt(parameters_.axis);
    for (const Vec2 d : {axis, leftOf(axis), axis * -1, leftOf(axis) * -1}) push(0, first, d, RoadClass::Highway, 0);
    return Done{};
}

/// Treats dead ends and what hangs on nothing, and rounds bends.
void Growth::finish(OwnStreetsReport& report) {
    if (parameters_.ends == Ends::Join) joinEnds();
    if (parameters_.ends != Ends::Keep) pruneEnds(graph_);
    if (land_.streets) report.apart += keepLargestComponent(graph_);
    curveBends(graph_, parameters_, land_);
    graph_.compact();
}

Status Growth::run(Progress* progress, OwnStreetsReport& report) {
    if (const Status begun = begin(report); !begun.ok()) return begun.error();
    if (progress) progress->begin("roads", static_cast<uint64_t>(parameters_.limit));
    while (!tips_.empty()) {
        if (cancelled(progress)) return cancelledError();
        const Tip tip = tips_.top();
        tips_.pop();
        const Vec2 from = graph_.metresAt(tip.node);
        Vec2 heading = tip.kind == RoadClass::Highway && parameters_.pattern == Pattern::Grown ? best(from, tip.heading)
                                                                                               : tip.heading;
        heading = snapped(from, heading, tip.kind);
        const bool mayBridge =
            tip.kind == RoadClass::Highway || uniform(combine(tip.key, 7)) < parameters_.streetBridges;
        const auto built = grower_.extend(tip.node, heading, tip.kind, mayBridge);
        if (!built) continue;
        tick(progress);
        if (graph_.edges().size() > parameters_.limit)
            return Error{Error::Kind::Budget,
                         fmt::format("more than {:.0f} pieces of road grow here", parameters_.limit)};
        if (!built->joined) branch(tip, *built);
    }
    finish(report);
    return Done{};
}

}  // namespace

std::span<const RoadParameter> roadParameters() { return table; }

void pruneEnds(RoadGraph& graph) {
    std::vector<uint32_t> open;
    for (uint32_t n = 0; n < graph.nodes().size(); ++n)
        if (graph.degree(n) == 1) open.push_back(n);
    while (!open.empty()) {
        const uint32_t node = open.back();
        open.pop_back();
        if (graph.degree(node) != 1) continue;
        const uint32_t edge = graph.nodes()[node].edges.front(), far = graph.edge(edge).other(node);
        if (graph.edge(edge).own) continue;
        graph.remove(edge);
        if (graph.degree(far) == 1) open.push_back(far);
    }
}

Result<RoadGraph> growRoads(const RoadParameters& parameters, const Land& land, Progress* progress,
                            OwnStreetsReport* report) {
    RoadGraph graph;
    OwnStreetsReport unused;
    const Status done = Growth(parameters, land, graph).run(progress, report ? *report : unused);
    if (!done.ok()) return done.error();
    return graph;
}

}  // namespace sgm::town
