#include "grammar/derive/faces.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "grammar/derive/expressions.h"
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

/// The corners of a rectangle about a point, `right` and `up` of half its extent.
std::array<Vec3d, 4> cornersOf(Vec3d middle, Vec3d right, Vec3d up) {
    return {middle - right - up, middle + right - up, middle + right + up, middle - right + up};
}

std::string kindName(RoofFace::Kind kind) {
    return kind == RoofFace::Kind::Slope ? "slope" : kind == RoofFace::Kind::Eave ? "eave" : "gable";
}

/// The face of a roof on which a point about the scope's centre lies.
std::optional<NamedFace> faceOfRoof(const Scope& scope, const Footprints& footprints, const SolidValue& solid,
                                    Vec3d at) {
    const auto below = planBelow(scope, footprints);
    if (!below) return std::nullopt;
    const double foot_m = scope.size.y / 2;
    const auto roof = field::roofFaceAt(*solid.primitive, below->footprint, below->formula, argumentNumbers(solid),
                                        scope.size.y, {at.x, at.z}, at.y + foot_m);
    if (!roof) return std::nullopt;
    NamedFace named{kindName(roof->kind), {}, {}};
    if (roof->edge < below->edges.size()) named.words = plan::edgeWords(below->footprint, below->edges[roof->edge]);
    for (size_t i = 0; i < 4; ++i)
        named.corners[i] = scope.centre + scope.axes * (roof->corners[i] - Vec3d{0, foot_m, 0});
    return named;
}

/// The side, top or bottom of a block on which a point about the scope's centre lies.
std::optional<NamedFace> faceOfBlock(const Scope& scope, const Footprints& footprints, Vec3d at) {
    const double tolerance_m = 1e-3 * std::max({scope.size.x, scope.size.y, scope.size.z}) + 5e-3;
    const Vec3d half = scope.half();
    for (const double side : {1.0, -1.0})
        if (std::abs(at.y - side * half.y) < tolerance_m)
            return NamedFace{side > 0 ? "top" : "bottom",
                             {},
                             cornersOf(scope.point({0, side, 0}), scope.axes.x * half.x, scope.axes.z * half.z)};
    const plan::Footprint footprint = footprintOf(scope, footprints);
    std::optional<NamedFace> nearest;
    double least_m = tolerance_m;
    for (const plan::PlacedEdge& edge : plan::edgesOf(footprint)) {
        const double away_m = plan::distanceTo(edge, {at.x, at.z});
        if (away_m >= least_m) continue;
        least_m = away_m;
        const Vec2 middle = (edge.from + edge.to) * .5, along = (edge.to - edge.from) * .5;
        nearest = NamedFace{"side", plan::edgeWords(footprint, edge),
                            cornersOf(scope.centre + scope.axes * Vec3d{middle.x, 0, middle.z},
                                      scope.axes * Vec3d{along.x, 0, along.z}, scope.axes.y * half.y)};
    }
    return nearest;
}

}  // namespace

bool isLine(FaceChoice::Kind kind) { return kind == Kind::Ridge || kind == Kind::Hip || kind == Kind::Valley; }

std::vector<Face> facesOf(const Scope& scope, const Footprints& footprints, const SolidValue* solid,
                          const FaceChoice& choice) {
    if (choice.kind == Kind::Side) return sidesOf(scope, footprintOf(scope, footprints), choice.word);
    if (choice.kind == Kind::Corner) return cornersOf(scope, footprintOf(scope, footprints), choice.word);
    if (!solid || !solid->primitive) return {};
    return isLine(choice.kind) ? linesOfRoof(scope, footprints, *solid, choice)
                               : facesOfRoof(scope, footprints, *solid, choice);
}

std::optional<NamedFace> namedFaceAt(const ShapeTree& tree, ShapeId shape, Vec3d point) {
    const SolidValue* solid = tree.solidOf(shape);
    if (!solid || !solid->primitive) return std::nullopt;
    const Scope& scope = tree.shapes[shape].scope;
    const Vec3d at = scope.axes.transposed() * (point - scope.centre);
    if (field::isRoof(*solid->primitive)) return faceOfRoof(scope, tree.footprints, *solid, at);
    if (!solid->primitive->hasFlatFaces) return std::nullopt;
    return faceOfBlock(scope, tree.footprints, at);
}

}  // namespace sgm::derive
