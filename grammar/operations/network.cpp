// network: a split of the ground by roads that grow over maps (modeler/town; paper A, "Algorithmic Architecture", 2010,
// 3).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "grammar/derive/parts_context.h"
#include "grammar/operations/network_terrain.h"
#include "grammar/operations/operations.h"
#include "grammar/operations/plan_parts.h"
#include "grammar/rules/roads.h"
#include "grammar/rules/words.h"
#include "modeler/core/random.h"
#include "modeler/plan/cut.h"
#include "modeler/plan/validate.h"
#include "modeler/town/blocks.h"
#include "modeler/town/outline.h"
#include "modeler/town/own_streets.h"

namespace sgm::operations {
namespace {

using derive::PartsContext;
using derive::Scope;
using plan::Vec2;
using rules::OperationChecker;
using rules::Parts;
using syntax::Operation;
using syntax::OperationArgument;
using town::RoadGraph;

constexpr std::string_view partWords[] = {"ground", "bore",     "water",  "park",   "highway",
                                          "street", "crossing", "bridge", "tunnel", "block"};
constexpr double mostSide_m = 50'000;
constexpr double mostCells = 512;  // along a side of the lattice that outlines of water and parks are sought on

constexpr OperationArgument networkArguments[] = {{"roads", syntax::ArgumentType::Name, "the name of roads"}};

std::shared_ptr<Parts> checkNetwork(OperationChecker& checker, const syntax::Attribute& written) {
    auto out = std::make_shared<Parts>();
    out->span = written.span;
    out->operation = written.operation;
    if (!written.args.empty()) {
        const syntax::Expr& name = written.args[0];
        const auto index = checker.names().findRoads(name.text);
        std::vector<std::string> known;
        for (const rules::Roads& r : checker.grammar().roads) known.push_back(r.name);
        if (!index && name.kind != syntax::Expr::Kind::Error)
            checker.unknownName(name.span, name.text, fmt::format("there are no roads called '{}'", name.text),
                                known.empty() ? fmt::format("write 'roads {} {{ }}' above", name.text)
                                              : rules::nearestHint(name.text, known));
        out->index = index.value_or(rules::none);
    }
    out->parts = checkWordParts(checker, written, partWords);
    return out;
}

/// The maps of `roads` as functions of places about the centre of a scope.
class MapsInScope {
public:
    MapsInScope(PartsContext& context, const rules::Roads& roads)
        : roads_(roads), place_(context.place()), scope_(context.scope()) {}

    town::Land land() {
        town::Land land;
        if (roads_.pull) land.pull = [this](Vec2 p) { return number(*roads_.pull, p); };
        if (roads_.spread) land.spread = [this](Vec2 p) { return number(*roads_.spread, p) != 0; };
        if (roads_.water) land.water = [this](Vec2 p) { return number(*roads_.water, p) != 0; };
        if (roads_.park) land.park = [this](Vec2 p) { return number(*roads_.park, p) != 0; };
        if (roads_.height) land.height = [this](Vec2 p) { return number(*roads_.height, p); };
        const std::pair<const std::optional<rules::Expr>*, std::function<double(Vec2)>*> weights[] = {
            {&roads_.grid, &land.grid},
            {&roads_.rings, &land.rings},
            {&roads_.shore, &land.shore},
            {&roads_.contours, &land.contours}};
        for (const auto& [expr, weight] : weights)
            if (*expr) *weight = [this, expr = &**expr](Vec2 p) { return number(*expr, p); };
        land.streets = roads_.streets.get();
        return land;
    }

private:
    double number(const rules::Expr& expr, Vec2 p) {
        place_.scope.centre = scope_.centre + scope_.axes * Vec3d{p.x, 0, p.z};
        const double v = derive::number(expr, place_);
        return std::isfinite(v) ? v : 0;
    }

    const rules::Roads& roads_;
    derive::Place place_;
    const Scope scope_;
};

class Network {
public:
    Network(PartsContext& context, const Parts& parts)
        : context_(context),
          parts_(parts),
          roads_(context.grammar().roads[parts.index]),
          maps_(context, roads_),
          land_(maps_.land()),
          terrain_(context, roads_) {}

    bool run() {
        if (!evaluateParameters()) return false;
        warnOfUncovered(context_, roads_);
        if (!terrain_.survey(parameters_, land_)) return false;
        town::OwnStreetsReport own;
        auto grown = town::growRoads(parameters_, land_, context_.progress(), &own);
        if (!grown.ok()) return context_.fail(grown.error(), parts_.span);
        if (roads_.streets && !judgeOwn(own)) return false;
        if (grown->edges().empty()) warnOfNoRoad();
        terrain_.grade(*grown, parameters_);
        const auto once = [&](std::function<bool(Vec2)> holds) {
            return town::remembered(std::move(holds), parameters_.lo, parameters_.hi, cellOf());
        };
        const town::LandCuts cuts{once(land_.water), once(land_.park), cellOf()};
        return runGround() && runBores(*grown) && runOutline("water", cuts.water) && runOutline("park", cuts.park) &&
               runRoads(*grown) && runBlocks(*grown, cuts);
    }

private:
    rules::Value evaluated(const rules::Expr& expr) { return context_.evaluate(expr, hashText("roads")); }

    bool evaluateParameters() {
        const Vec3d half = context_.scope().half();
        if (std::max(half.x, half.z) > mostSide_m)
            return context_.fail(fmt::format("a network is at most {} km wide", 2 * mostSide_m / 1000), parts_.span);
        parameters_.lo = {-half.x, -half.z}, parameters_.hi = {half.x, half.z};
        parameters_.random = combine(context_.key(), hashText("roads"));
        for (const auto& [row, expr] : roads_.numbers) {
            const double v = evaluated(expr).num();
            if (!(v >= row->lo && v <= row->hi))
                return context_.fail(fmt::format("'{}' is {:.6g}, but must be {}", row->name, v, row->range),
                                     expr.span);
            parameters_.*row->field = v;
        }
        const auto wordAt = [&](const std::optional<rules::Expr>& expr, std::string_view name) -> size_t {
            if (!expr) return 0;
            for (const rules::RoadWord& row : rules::roadWords())
                if (row.name == name)
                    return static_cast<size_t>(std::find(row.words.begin(), row.words.end(), evaluated(*expr).text) -
                                               row.words.begin());
            return 0;
        };
        parameters_.pattern = static_cast<town::Pattern>(wordAt(roads_.pattern, "pattern"));
        parameters_.turns = static_cast<town::Turns>(wordAt(roads_.turns, "turns"));
        parameters_.ends = static_cast<town::Ends>(wordAt(roads_.ends, "ends"));
        parameters_.from = pointOf(roads_.from);
        parameters_.centre = pointOf(roads_.centre);
        return true;
    }

    /// A place of the object's frame in that of the scope.
    std::optional<Vec2> pointOf(const std::optional<rules::Expr>& expr) {
        if (!expr) return std::nullopt;
        const rules::Value v = evaluated(*expr);
        const Scope& scope = context_.scope();
        const Vec3d at = scope.axes.transposed() * (Vec3d{v.n[0], scope.centre.y, v.n[1]} - scope.centre);
        return Vec2{at.x, at.z};
    }

    /// What became of the streets of a file: none at all is an error, some are a warning.
    bool judgeOwn(const town::OwnStreetsReport& own) {
        const town::OwnStreets& streets = *roads_.streets;
        const Vec2 size = parameters_.hi - parameters_.lo, extent = streets.box.size();
        if (own.laid == 0)
            return context_.fail(
                fmt::format(
                    "no street of {} lies in the network's {:.6g} x {:.6g} m: they cover {:.6g} x {:.6g} m from "
                    "({:.6g}, {:.6g}) to ({:.6g}, {:.6g}). Make the scope larger, or move the lines: degrees lie about "
                    "their "
                    "middle, metres as they are",
                    streets.name, size.x, size.z, extent.x, extent.z, streets.box.lo.x, streets.box.lo.z,
                    streets.box.hi.x, streets.box.hi.z),
                roads_.streetsSpan);
        if (own.refused > 0)
            context_.warn(roads_.streetsSpan,
                          fmt::format("{} pieces of {} were left out: they would touch others between crossings",
                                      own.refused, streets.name),
                          "let lines end where they meet, and draw each street once");
        if (own.apart > 0)
            context_.warn(
                roads_.streetsSpan,
                fmt::format("{} pieces of {} were left out: no road joins them to the others", own.apart, streets.name),
                "draw a street to them, or let roads grow there ('spread')");
        return true;
    }

    void warnOfNoRoad() {
        if (const std::string hill = terrain_.obstacle(parameters_, land_); !hill.empty())
            context_.warn(roads_.height->span, hill, "raise 'slope', or let the heights vary less");
        else
            context_.warn(parts_.span, "no road grows here",
                          "let 'pull' and 'spread' hold somewhere, or make the scope larger");
    }

    bool runGround() {
        const Parts::Part* part = findPart(parts_, "ground");
        return !part || context_.derivation().planAlone ||
               runPart(*part->body, "ground", context_.scope(), hashText("ground"));
    }

    /// What of a road's area lies in the scope: where its middle runs along the border, half of the road is beyond it.
    plan::Footprint withinScope(plan::Footprint area) const {
        plan::Box2 box;
        for (const plan::Polygon& polygon : area.polygons)
            for (const Vec2 p : polygon.outer.points) box.add(p);
        const Vec2 lo = parameters_.lo, hi = parameters_.hi;
        if (box.lo.x < lo.x || box.hi.x > hi.x) area = plan::between(area, 0, lo.x, hi.x);
        if (box.lo.z < lo.z || box.hi.z > hi.z) area = plan::between(area, 1, lo.z, hi.z);
        return area;
    }

    /// What tunnels take out of the ground.
    bool runBores(const RoadGraph& graph) {
        const Parts::Part* part = findPart(parts_, "bore");
        if (!part) return true;
        for (const town::RoadSurface& surface : town::surfacesOf(graph, parameters_)) {
            if (surface.edge == town::noIndex || !graph.edge(surface.edge).tunnel) continue;
            const Vec2 front = town::unit(surface.to - surface.from);
            const town::Point at = town::pointAt((surface.from + surface.to) * .5);
            const uint64_t key = combine(static_cast<uint32_t>(at.x), static_cast<uint32_t>(at.z));
            const plan::Footprint area = withinScope(surface.area);
            if (!area.polygons.empty() && !context_.cutting([&] { return runOver(part, "bore", area, front, key); }))
                return false;
        }
        return true;
    }

    /// Runs a body on the hills, where there are some.
    bool runPart(const rules::Body& body, const std::string& layer, const Scope& scope, uint64_t key) {
        const uint32_t relief = terrain_.reliefOf(layer);
        return relief == derive::none ? context_.run(body, scope, key) : context_.runOn(relief, body, scope, key);
    }

    /// Runs the part's body over an area in metres about the scope's centre, in an upright box around it whose z axis
    /// is `front` there.
    bool runOver(const Parts::Part* part, const std::string& layer, const plan::Footprint& area, Vec2 front,
                 uint64_t key) {
        if (layer != "bore") context_.draw(layer, context_.scope(), area, key);
        if (!part || (context_.derivation().planAlone && layer != "block")) return true;
        const Vec2 right{front.z, -front.x};
        plan::Footprint own = area;
        plan::Box2 box;
        const auto turn = [&](plan::Ring& ring) {
            for (Vec2& p : ring.points) p = {dot(p, right), dot(p, front)}, box.add(p);
        };
        for (plan::Polygon& polygon : own.polygons) {
            turn(polygon.outer);
            for (plan::Ring& court : polygon.courts) turn(court);
        }
        const Vec2 middle = box.centre(), at = right * middle.x + front * middle.z;
        Scope scope = context_.scope();
        scope.centre += scope.axes * Vec3d{at.x, 0, at.z};
        scope.axes = scope.axes * Mat3{{right.x, 0, right.z}, {0, 1, 0}, {front.x, 0, front.z}};
        scope.size = {box.size().x, scope.size.y, box.size().z};
        scope.footprint = derive::none;
        const double boxArea = box.size().x * box.size().z, filled = plan::area(own);
        if (layer == "block" || filled < boxArea * (1 - 1e-6)) {  // a block's edges have words
            const auto over = context_.over(scope, plan::placed(own, {1, 1}, middle * -1), parts_.span);
            if (!over) return false;
            scope = *over;
        }
        return runPart(*part->body, layer, scope, combine(hashText(layer), key));
    }

    bool runOutline(const std::string& layer, const std::function<bool(Vec2)>& holds) {
        if (!holds) return true;
        const Vec2 size = parameters_.hi - parameters_.lo;
        const double cell_m = std::max(cellOf(), std::max(size.x, size.z) / mostCells);
        const plan::Footprint found = town::outlineOf(holds, parameters_.lo, parameters_.hi, cell_m, layer);
        for (size_t i = 0; i < found.polygons.size(); ++i) {
            const plan::Footprint one{{found.polygons[i]}, found.tags};
            if (!runOver(findPart(parts_, layer), layer, one, {0, 1}, i + 1)) return false;
        }
        return true;
    }

    /// A quarter of a street's block, at most 10 m.
    double cellOf() const { return std::clamp(parameters_.block_m / 8, 2.0, 10.0); }

    bool runRoads(const RoadGraph& graph) {
        for (const town::RoadSurface& surface : town::surfacesOf(graph, parameters_)) {
            const bool crossing = surface.edge == town::noIndex;
            const town::RoadEdge edge = crossing ? town::RoadEdge{} : graph.edge(surface.edge);
            const std::string layer = crossing                                ? "crossing"
                                      : edge.bridge                           ? "bridge"
                                      : edge.tunnel                           ? "tunnel"
                                      : edge.kind == town::RoadClass::Highway ? "highway"
                                                                              : "street";
            const town::Point at = crossing ? graph.at(surface.node) : town::pointAt((surface.from + surface.to) * .5);
            const uint64_t key = combine(static_cast<uint32_t>(at.x), static_cast<uint32_t>(at.z));
            const Vec2 front = crossing ? Vec2{0, 1} : town::unit(surface.to - surface.from);
            const plan::Footprint area = withinScope(surface.area);
            if (!area.polygons.empty() && !runOver(findPart(parts_, layer), layer, area, front, key)) return false;
        }
        return true;
    }

    bool runBlocks(const RoadGraph& graph, const town::LandCuts& cuts) {
        for (const town::Face& face : town::facesOf(graph)) {
            if (cancelled(context_.progress())) return context_.fail(cancelledError(), parts_.span);
            for (const town::Block& block : town::blocksOf(graph, parameters_, face, cuts))
                if (!runOver(findPart(parts_, "block"), "block", block.land, {0, 1}, block.key)) return false;
        }
        return true;
    }

    PartsContext& context_;
    const Parts& parts_;
    const rules::Roads& roads_;
    MapsInScope maps_;
    town::Land land_;
    NetworkTerrain terrain_;
    town::RoadParameters parameters_;
};

bool runNetwork(PartsContext& context, const Parts& parts) {
    context.startsOver();
    return Network(context, parts).run();
}

}  // namespace

constinit const Operation network{
    .name = "network",
    .doc =
        "Splits the ground by roads that grow over maps: ground is the whole scope; highway, street and bridge are "
        "stretches of "
        "road with z along them, crossing lies between them; water and park are where the roads' maps say so; block is "
        "what roads enclose, its edges tagged street, highway, bridge, water or park. With the roads' height all of it "
        "follows the hills; tunnel is a stretch of road under them, and bore is taken out of the ground along it.",
    .example = "size (400, 4, 400) network Net { street: asphalt | crossing: asphalt | block: lawn }",
    .arguments = networkArguments,
    .phase = Operation::Phase::Content,
    .block = {.label = "block"},
    .checkParts = checkNetwork,
    .run = runNetwork,
};

}  // namespace sgm::operations
