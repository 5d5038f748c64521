// `at each(…)`: newcomers on the sides and corners of a block and on the faces of a roof.
#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "grammar/derive/interpreter.h"
#include "grammar/derive/scope_footprint.h"
#include "modeler/core/random.h"
#include "modeler/field/roof_faces.h"
#include "modeler/plan/edge_words.h"

namespace sgm::derive {
namespace {

using field::RoofFace;
using plan::Vec2;
using rules::FaceChoice;
using Kind = FaceChoice::Kind;

constexpr double unknown_m = 1;  ///< the extent of a face where it has none

/// A face of a shape: a box about its middle, z outward, x from left to right seen from outside.
struct Face {
    Scope scope;
    Vec3d direction;  ///< zero where the newcomer's centre comes to it
    uint64_t key = 0;
};

Face faceAt(const Scope& whole, Vec2 at, double y_m, Vec2 outward, Vec3d size_m) {
    Face face;
    face.scope.centre = whole.centre + whole.axes * Vec3d{at.x, y_m, at.z};
    face.scope.axes = whole.axes * Mat3{{outward.z, 0, -outward.x}, {0, 1, 0}, {outward.x, 0, outward.z}};
    for (int i = 0; i < 3; ++i) face.scope.size[i] = size_m[i] > 1e-6 ? size_m[i] : unknown_m;
    face.direction = face.scope.axes.z;
    return face;
}

std::vector<Face> sidesOf(const Scope& scope, const plan::Footprint& footprint, const std::string& word) {
    std::vector<Face> faces;
    const std::vector<plan::PlacedEdge> edges = plan::edgesOf(footprint);
    for (size_t i = 0; i < edges.size(); ++i) {
        if (!plan::isEdgeCalled(footprint, edges[i], word)) continue;
        faces.push_back(faceAt(scope, (edges[i].from + edges[i].to) * .5, 0, edges[i].normal(),
                               {edges[i].length(), scope.size.y, 0}));
        faces.back().key = i;
    }
    return faces;
}

/// Corners that stand out: z along their bisector.
std::vector<Face> cornersOf(const Scope& scope, const plan::Footprint& footprint, const std::string& word) {
    constexpr double leastTurn = 0.01745;  // 1 degree
    std::vector<Face> faces;
    const std::vector<plan::PlacedEdge> edges = plan::edgesOf(footprint);
    for (size_t i = 0; i < edges.size(); ++i) {
        const bool isLast = i + 1 == edges.size() || edges[i + 1].index == 0;
        const plan::PlacedEdge &e = edges[i], &after = edges[isLast ? i - e.index : i + 1];
        const Vec2 m = e.normal(), n = after.normal();
        if (cross(m, n) < leastTurn) continue;
        if (!plan::isEdgeCalled(footprint, e, word) && !plan::isEdgeCalled(footprint, after, word)) continue;
        const Vec2 middle = m + n;
        faces.push_back(faceAt(scope, e.to, 0, middle * (1 / length(middle)), {0, scope.size.y, 0}));
        faces.back().key = i;
    }
    return faces;
}

RoofFace::Kind roofKind(Kind kind) {
    return kind == Kind::Eave    ? RoofFace::Kind::Eave
           : kind == Kind::Gable ? RoofFace::Kind::Gable
           : kind == Kind::Apex  ? RoofFace::Kind::Apex
                                 : RoofFace::Kind::Slope;
}

/// The plan below a roof.
struct RoofPlan {
    plan::Footprint footprint;
    std::vector<plan::PlacedEdge> edges;
    plan::Formula formula;
    bool isCalled(uint32_t edge, const std::string& word) const {
        return plan::isEdgeCalled(footprint, edges[edge], word);
    }
};
std::optional<RoofPlan> planBelow(const Scope& scope, const Footprints& footprints) {
    plan::Footprint footprint = footprintOf(scope, footprints);
    auto formula = plan::monotoneFormula(footprint);
    if (!formula.ok()) return std::nullopt;
    std::vector<plan::PlacedEdge> edges = plan::edgesOf(footprint);
    return RoofPlan{std::move(footprint), std::move(edges), std::move(*formula)};
}

std::vector<Face> facesOfRoof(const Scope& scope, const Footprints& footprints, const SolidValue& solid,
                              const FaceChoice& choice) {
    const auto below = planBelow(scope, footprints);
    if (!below) return {};
    std::vector<Face> faces;
    for (const RoofFace& roof :
         field::roofFaces(*solid.primitive, below->footprint, below->formula, argumentNumbers(solid), scope.size.y)) {
        if (roof.kind != roofKind(choice.kind)) continue;
        if (roof.kind != RoofFace::Kind::Apex && !below->isCalled(roof.edge, choice.word)) continue;
        Face face = faceAt(scope, roof.at, roof.height_m - scope.size.y / 2, roof.outward,
                           {roof.width_m, roof.rise_m, roof.run_m});
        if (roof.kind == RoofFace::Kind::Slope) face.direction = {};
        if (roof.kind == RoofFace::Kind::Apex) face.direction = scope.axes.y;
        face.key = roof.edge;
        faces.push_back(face);
    }
    return faces;
}

bool isLine(Kind kind) { return kind == Kind::Ridge || kind == Kind::Hip || kind == Kind::Valley; }

field::RoofLine::Kind lineKind(Kind kind) {
    return kind == Kind::Hip      ? field::RoofLine::Kind::Hip
           : kind == Kind::Valley ? field::RoofLine::Kind::Valley
                                  : field::RoofLine::Kind::Ridge;
}

/// Lines where slopes meet: x uphill along them, y up, z level.
std::vector<Face> linesOfRoof(const Scope& scope, const Footprints& footprints, const SolidValue& solid,
                              const FaceChoice& choice) {
    const auto below = planBelow(scope, footprints);
    if (!below) return {};
    std::vector<Face> faces;
    for (const field::RoofLine& line :
         field::roofLines(*solid.primitive, below->footprint, below->formula, argumentNumbers(solid))) {
        if (line.kind != lineKind(choice.kind)) continue;
        if (!below->isCalled(line.edges[0], choice.word) && !below->isCalled(line.edges[1], choice.word)) continue;
        const Vec3d x = normalized(Vec3d{line.along.x * line.run_m, line.rise_m, line.along.z * line.run_m});
        const Vec3d z{-line.along.z, 0, line.along.x};
        Face face;
        face.scope.centre = scope.centre + scope.axes * Vec3d{line.at.x, line.height_m - scope.size.y / 2, line.at.z};
        face.scope.axes = scope.axes * Mat3{x, cross(z, x), z};
        face.scope.size = {std::hypot(line.run_m, line.rise_m), unknown_m, unknown_m};
        face.key = combine(combine(line.edges[0], line.edges[1]), static_cast<uint64_t>(faces.size()));
        faces.push_back(face);
    }
    return faces;
}

bool hasRoof(const SolidValue* solid) { return solid && solid->primitive && field::isRoof(*solid->primitive); }

/// The host where it is a roof, else the roofs that stand in what the operators join so far; a failure where there is
/// none.
std::vector<ShapeId> roofsOf(TreeBuilder& builder, ShapeId host, ShapeId node, const rules::JointChoice& at) {
    const ShapeTree& tree = builder.tree();
    if (hasRoof(tree.solidOf(host))) return {host};
    if (builder.recording()) builder.recording()->readsWorld();
    std::vector<ShapeId> roofs;
    for (ShapeId s = node; s != none; s = tree.next(s, node))
        if (hasRoof(tree.solidOf(s)) && tree.shapes[s].op != rules::Operator::Difference) roofs.push_back(s);
    if (roofs.empty())
        builder.monitor().fail(Error::Kind::Input,
                               "no roof stands here whose faces 'each' could name: write it behind the roof, as in "
                               "'hipRoof(35deg) + Dormer at each(slope)'",
                               at.span);
    return roofs;
}

}  // namespace

bool Interpreter::placeOnFaces(ShapeId host, const rules::Element& e, Frame& frame, const Target& target,
                               uint64_t key) {
    const FaceChoice& choice = *e.at->each;
    const bool ofBlock = choice.kind == Kind::Side || choice.kind == Kind::Corner;
    std::vector<ShapeId> hosts{host};
    if (!ofBlock) hosts = roofsOf(builder_, host, target.node, *e.at);
    for (const ShapeId at : hosts) {
        const Scope scope = builder_.tree().shapes[at].scope;
        const Footprints& footprints = builder_.tree().footprints;
        if (isLine(choice.kind) && footprintOf(scope, footprints).edgeCount() > field::mostRoofLineEdges) {
            builder_.monitor().fail(Error::Kind::Input,
                                    fmt::format("ridges, hips and valleys are known of roofs over at most {} edges",
                                                field::mostRoofLineEdges),
                                    e.at->span);
            return false;
        }
        const std::vector<Face> faces =
            choice.kind == Kind::Side     ? sidesOf(scope, footprintOf(scope, footprints), choice.word)
            : choice.kind == Kind::Corner ? cornersOf(scope, footprintOf(scope, footprints), choice.word)
            : isLine(choice.kind)         ? linesOfRoof(scope, footprints, *builder_.tree().solidOf(at), choice)
                                          : facesOfRoof(scope, footprints, *builder_.tree().solidOf(at), choice);
        const uint64_t ofHost = at == host ? key : combine(key, builder_.tree().shapes[at].key);
        for (const Face& face : faces) {
            Attachment attachment{at, centreJoint, {}, frame.place};
            attachment.joint = {"each", face.scope.centre, face.direction};
            attachment.place.key = combine(combine(ofHost, hashText("each")), face.key);
            attachment.place.scope = face.scope;
            attachment.place.valuesAt = builder_.tree().shapes[at].valuesAt;
            attachment.place.host = at;
            if (!builder_.monitor().work() || !join(e, frame, target, attachment)) return false;
        }
    }
    return !builder_.monitor().failed();
}

}  // namespace sgm::derive
