// faces: takes a block apart into plates along its edges, a top, a bottom and a core (the component split of CGA shape
// grammars: Müller et al., "Procedural modeling of buildings", 2006, 3.3), as solids: the plates are mitred, so that corners
// neither overlap nor gape.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "grammar/derive/parts_context.h"
#include "grammar/operations/operations.h"
#include "grammar/operations/plan_edges.h"
#include "grammar/rules/make.h"
#include "grammar/rules/operation_checker.h"
#include "modeler/core/random.h"
#include "modeler/plan/edit.h"

namespace sgm::operations {
namespace {

using derive::PartsContext;
using derive::Scope;
using plan::PlacedEdge;
using plan::Vec2;
using rules::OperationChecker;
using rules::Parts;
using syntax::Operation;
using syntax::OperationArgument;
using Part = Parts::Part;

constexpr double leastPart_m = 1e-6;

constexpr OperationArgument facesArguments[] = {
    {"thickness", syntax::ArgumentType::Length, "metres of the plates; 0.2m unless said", true}};

std::shared_ptr<Parts> checkFaces(OperationChecker& checker, const syntax::Attribute& written) {
    auto out = std::make_shared<Parts>();
    out->span = written.span;
    out->operation = written.operation;
    checker.beginDraws("faces");
    out->args.push_back(written.args.empty() ? rules::makeConstant(written.span, rules::Value::number(.2, rules::Unit::Metre))
                                             : checker.expression(written.args[0], rules::Want::Length, "'faces'"));
    if (const auto value = checker.atDefaults(out->args[0]); value && !(value->num() > 0))
        checker.error(out->args[0].span, "the plates of 'faces' are thicker than 0");
    for (const syntax::Case& c : written.cases) {
        Part part;
        part.span = c.span;
        const bool isWord = !c.tag.empty() || (c.label && c.label->kind == syntax::Expr::Kind::Name);
        if (c.repeated || !isWord) {
            checker.error(c.span, "a part of 'faces' begins with a word for its edges",
                          "write 'side: …', 'front: …', 'court: …', 'top: …', 'rest: …' or a tag");
            continue;
        }
        part.label = c.tag.empty() ? c.label->text : c.tag.text;
        part.body = c.body ? checker.body(*c.body) : std::make_shared<const rules::Body>();
        if (part.body->grows)
            checker.error(part.body->span, "a part begins with a shape: nothing stands in it yet that could grow",
                          "leave the operator out");
        out->parts.push_back(std::move(part));
    }
    return out;
}

const Part* findPart(const Parts& faces, std::string_view label) {
    const auto part = std::find_if(faces.parts.begin(), faces.parts.end(), [&](const Part& p) { return p.label == label; });
    return part == faces.parts.end() ? nullptr : &*part;
}

/// The first part whose word the edge is called by; top, bottom and rest are no words for edges.
const Part* partOf(const Parts& faces, const plan::Footprint& footprint, const PlacedEdge& edge) {
    for (const Part& part : faces.parts)
        if (part.label != "top" && part.label != "bottom" && part.label != "rest" && isEdgeCalled(footprint, edge, part.label))
            return &part;
    return nullptr;
}

/// How far along its edge, from a corner inward, the inner end of a plate `depth` thick lies, whose neighbour is
/// `neighbourDepth` thick: negative at a reflex corner. `along` and `neighbour` are unit directions away from the corner.
double mitre(Vec2 along, Vec2 inward, Vec2 neighbourInward, double depth, double neighbourDepth) {
    const double slope = dot(along, neighbourInward);
    constexpr double straight = .05;  // nearly one line: the plate ends square to it
    if (std::abs(slope) < straight) return 0;
    return (neighbourDepth - depth * dot(inward, neighbourInward)) / slope;
}

/// A plate: the trapezoid between an edge and its inset, in the plan.
struct Plate {
    Vec2 from, to;            ///< the edge
    double atFrom, atTo;      ///< how far along the edge its inner corners lie from either end
    double depth;
};

std::vector<Vec2> outlineOf(const Plate& plate, double length) {
    // In the face's own plan: x from `to` (left, seen from outside) to `from`, z outward, about the middle of the plate.
    const double half = length / 2, z = plate.depth / 2;
    double left = -half + plate.atTo, right = half - plate.atFrom;
    if (right - left > leastPart_m) return {{-half, z}, {left, -z}, {right, -z}, {half, z}};
    // The mitres meet before the plate's full depth.
    const double depth = plate.depth * length / (plate.atFrom + plate.atTo);
    const double middle = -half + plate.atTo * depth / plate.depth;
    return {{-half, z}, {middle, z - depth}, {half, z}};
}

/// The heights that side plates, and what is between top and bottom plates, fill.
struct Levels {
    double bottom_m, top_m;  ///< of the core, from the scope's middle
};

class Faces {
public:
    Faces(PartsContext& context, const Parts& faces, double thickness_m)
        : context_(context), faces_(faces), footprint_(context.footprint()), edges_(plan::edgesOf(footprint_)), thickness_m_(thickness_m) {
        for (const PlacedEdge& edge : edges_) parts_.push_back(partOf(faces, footprint_, edge));
    }

    bool run() {
        for (size_t i = 0; i < edges_.size(); ++i)
            if (parts_[i] && !runSide(i)) return false;
        const Part *top = findPart(faces_, "top"), *bottom = findPart(faces_, "bottom"), *rest = findPart(faces_, "rest");
        if (!top && !bottom && !rest) return true;
        const plan::Footprint core = coreOf();
        if (core.empty()) return true;
        const double half = context_.scope().size.y / 2, plate = std::min(thickness_m_, half);
        const Levels inner{bottom ? -half + plate : -half, top ? half - plate : half};
        return (!top || runLevel(*top, core, {inner.top_m, half}, 1)) && (!bottom || runLevel(*bottom, core, {-half, inner.bottom_m}, 2)) &&
               (!rest || runLevel(*rest, core, inner, 3));
    }

private:
    double depthOf(size_t edge) const { return parts_[edge] ? thickness_m_ : 0; }

    size_t neighbour(size_t edge, bool after) const {
        const PlacedEdge& e = edges_[edge];
        const plan::Polygon& polygon = footprint_.polygons[e.polygon];
        const size_t n = e.ring == 0 ? polygon.outer.size() : polygon.courts[e.ring - 1].size();
        const size_t first = edge - e.index;
        return first + (e.index + (after ? 1 : n - 1)) % n;
    }

    bool runSide(size_t i) {
        const PlacedEdge& edge = edges_[i];
        const double length = edge.length();
        if (length <= leastPart_m) return true;
        const Vec2 n = edge.normal(), inward{-n.x, -n.z}, along = (edge.to - edge.from) * (1 / length);
        const auto end = [&](bool after) {
            const size_t other = neighbour(i, after);
            const Vec2 m = edges_[other].normal();
            const double at = mitre(after ? Vec2{-along.x, -along.z} : along, inward, {-m.x, -m.z}, thickness_m_, depthOf(other));
            return std::clamp(at, -4 * thickness_m_, 4 * thickness_m_);
        };
        const Plate plate{edge.from, edge.to, end(false), end(true), thickness_m_};
        const Scope& whole = context_.scope();
        Scope part = whole;
        const Vec2 middle = (edge.from + edge.to) * .5 + inward * (thickness_m_ / 2);
        part.centre = whole.centre + whole.axes * Vec3d{middle.x, 0, middle.z};
        part.axes = whole.axes * Mat3{{n.z, 0, -n.x}, {0, 1, 0}, {n.x, 0, n.z}};
        part.size = {length, whole.size.y, thickness_m_};
        part.footprint = derive::none;
        const auto over = context_.over(part, plan::footprintOf(plan::polygonOf(outlineOf(plate, length))), faces_.span);
        return over && context_.run(*parts_[i]->body, *over, combine(hashText("side"), i));
    }

    /// What the plates leave of the plan.
    plan::Footprint coreOf() const {
        std::vector<double> distances;
        for (size_t i = 0; i < edges_.size(); ++i) distances.push_back(depthOf(i));
        const bool any = std::any_of(distances.begin(), distances.end(), [](double d) { return d > 0; });
        return any ? plan::setback(footprint_, distances) : footprint_;
    }

    bool runLevel(const Part& part, const plan::Footprint& plan, Levels levels, uint64_t key) {
        if (levels.top_m - levels.bottom_m <= leastPart_m) return true;
        const plan::Box2 box = bounds(plan);
        Scope scope = context_.scope();
        const plan::Vec2 c = box.centre();
        scope.centre += scope.axes * Vec3d{c.x, (levels.bottom_m + levels.top_m) / 2, c.z};
        scope.size = {box.size().x, levels.top_m - levels.bottom_m, box.size().z};
        const auto over = context_.over(scope, plan::placed(plan, {1, 1}, {-c.x, -c.z}), faces_.span);
        return over && context_.run(*part.body, *over, combine(hashText("level"), key));
    }

    PartsContext& context_;
    const Parts& faces_;
    const plan::Footprint footprint_;
    const std::vector<PlacedEdge> edges_;
    const double thickness_m_;
    std::vector<const Part*> parts_;  ///< by edge; null: the core goes up to it
};

bool runFaces(PartsContext& context, const Parts& faces) {
    const double thickness_m = context.evaluate(faces.args[0], hashText("thickness")).num();
    if (!(thickness_m > 0)) return context.fail("the plates of 'faces' are thicker than 0", faces.args[0].span);
    return Faces(context, faces, thickness_m).run();
}

}  // namespace

constinit const Operation faces{
    .name = "faces",
    .doc = "Takes a block apart: plates along the edges of its footprint, called side, front (+z), back, left, right, court or by a tag; "
           "top and bottom plates; and rest, the core. The first word that fits an edge wins; in a plate x runs from left to right seen "
           "from outside and z outward.",
    .example = "footprint ell(16, 12, 5, 6) extrude 6m faces .3m { front: split x { ~1: wall } | side: wall | rest: nil }",
    .arguments = facesArguments,
    .phase = Operation::Phase::Content,
    .blockLabel = "side",
    .checkParts = checkFaces,
    .run = runFaces,
};

}  // namespace sgm::operations
