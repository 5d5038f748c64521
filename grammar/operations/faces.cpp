// faces: takes a block apart into plates along its edges, a top, a bottom and a core (the component split of CGA shape
// grammars: Müller et al., "Procedural modeling of buildings", 2006, 3.3), as solids: the plates are mitred, so that
// corners neither overlap nor gape.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "grammar/derive/parts_context.h"
#include "grammar/operations/operations.h"
#include "grammar/rules/make.h"
#include "grammar/rules/operation_checker.h"
#include "modeler/core/random.h"
#include "modeler/plan/edge_words.h"
#include "modeler/plan/edit.h"
#include "modeler/plan/plates.h"

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
constexpr double mostBend = std::numbers::pi / 2;

constexpr OperationArgument facesArguments[] = {
    {"thickness", syntax::ArgumentType::Length, "metres of the plates; 0.2m unless said", true},
    {"angle", syntax::ArgumentType::Angle,
     "sides of one part that bend by no more are one curved face; none unless said", true, "smooth"}};

std::shared_ptr<Parts> checkFaces(OperationChecker& checker, const syntax::Attribute& written) {
    auto out = std::make_shared<Parts>();
    out->span = written.span;
    out->operation = written.operation;
    checker.beginDraws("faces");
    out->args.push_back(written.args.empty()
                            ? rules::makeConstant(written.span, rules::Value::number(.2, rules::Unit::Metre))
                            : checker.expression(written.args[0], rules::Want::Length, "'faces'"));
    if (const auto value = checker.atDefaults(out->args[0]); value && !(value->num() > 0))
        checker.error(out->args[0].span, "the plates of 'faces' are thicker than 0");
    if (written.args.size() > 1) {
        out->args.push_back(checker.expression(written.args[1], rules::Want::Angle, "'smooth'"));
        const auto value = checker.atDefaults(out->args[1]);
        if (value && !(value->num() >= 0 && value->num() < mostBend))
            checker.error(out->args[1].span, "'smooth' lies between 0deg and 90deg");
    }
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
    const auto part =
        std::find_if(faces.parts.begin(), faces.parts.end(), [&](const Part& p) { return p.label == label; });
    return part == faces.parts.end() ? nullptr : &*part;
}

/// Words for what isn't at an edge.
bool isLevelWord(std::string_view word) { return word == "top" || word == "bottom" || word == "rest"; }

/// The share of a side from which on it is `shared` with what stands there.
constexpr double mostlyShared = .5;

/// The heights that side plates, and what is between top and bottom plates, fill.
struct Levels {
    double bottom_m, top_m;  ///< of the core, from the scope's middle
};

class Faces {
public:
    Faces(PartsContext& context, const Parts& faces, double thickness_m, double smooth, plan::Plates plates)
        : context_(context),
          faces_(faces),
          footprint_(context.footprint()),
          edges_(plan::edgesOf(footprint_)),
          thickness_m_(thickness_m),
          smooth_(smooth),
          plates_(std::move(plates)) {}

    bool run() {
        plan::Footprint core = std::move(plates_.core);
        const std::vector<Face> faces = facesOf();
        noteWords(faces);
        warnOfLostCore(faces);
        for (const Face& face : faces) {
            if (face.part && !runSide(face)) return false;
            if (face.part) continue;
            for (const size_t plate : face.plates) {  // no face: its outline has no name of its own
                const plan::Footprint& own = plates_.plates[plate].footprint;
                core = core.empty() ? own : plan::boolean(plan::Boolean::Union, core, own);
            }
        }
        if (core.empty()) return true;
        const Part *top = findPart(faces_, "top"), *bottom = findPart(faces_, "bottom"),
                   *rest = findPart(faces_, "rest");
        const double half = context_.scope().size.y / 2, plate_m = std::min(thickness_m_, half);
        const Levels inner{bottom ? -half + plate_m : -half, top ? half - plate_m : half};
        return (!top || runLevel(*top, core, {inner.top_m, half}, 1)) &&
               (!bottom || runLevel(*bottom, core, {-half, inner.bottom_m}, 2)) &&
               (!rest || runLevel(*rest, core, inner, 3));
    }

private:
    /// The first part whose word the edge is called by; top, bottom and rest are no words for edges.
    const Part* partOf(const PlacedEdge& edge) {
        for (const Part& part : faces_.parts) {
            if (isLevelWord(part.label)) continue;
            if (plan::isEdgeCalled(footprint_, edge, part.label)) return &part;
            if (part.label == "shared" && context_.sharedBy(plateOf(edge)) >= mostlyShared) return &part;
        }
        return nullptr;
    }

    Vec2 middleOf(const PlacedEdge& edge) const {
        return (edge.from + edge.to) * .5 - edge.normal() * (thickness_m_ / 2);
    }

    /// The scope of the plate along an edge: x from left to right seen from outside, z outward.
    Scope plateOf(const PlacedEdge& edge) const {
        const Vec2 n = edge.normal(), right{n.z, -n.x}, middle = middleOf(edge);
        const Scope& whole = context_.scope();
        Scope scope = whole;
        scope.centre = whole.centre + whole.axes * Vec3d{middle.x, 0, middle.z};
        scope.axes = whole.axes * Mat3{{right.x, 0, right.z}, {0, 1, 0}, {n.x, 0, n.z}};
        scope.size = {edge.length(), whole.size.y, thickness_m_};
        scope.footprint = derive::none;
        return scope;
    }

    /// Plates that one part gets as one.
    struct Face {
        const Part* part = nullptr;
        std::vector<size_t> plates;  ///< one after the other along the outline
        bool closed = false;         ///< the last one meets the first
    };

    /// Whether the outline goes on from one plate to the next, and bends little there.
    bool goesOn(size_t plate, size_t next) const {
        const PlacedEdge &a = edges_[plates_.plates[plate].edge], &b = edges_[plates_.plates[next].edge];
        if (plate == next || a.to != b.from) return false;
        const Vec2 da = a.to - a.from, db = b.to - b.from;
        return std::abs(std::atan2(plan::cross(da, db), plan::dot(da, db))) <= smooth_;
    }

    /// The plates in the order of the outline, smooth ones together.
    std::vector<Face> facesOf() {
        std::vector<Face> faces;
        size_t ring = 0;  // the first face of the ring
        for (size_t i = 0; i < plates_.plates.size(); ++i) {
            const PlacedEdge& edge = edges_[plates_.plates[i].edge];
            const Part* const part = partOf(edge);
            const bool first = i == 0 || edges_[plates_.plates[i - 1].edge].to != edge.from;
            if (first) ring = faces.size();
            if (smooth_ > 0 && !first && part && faces.back().part == part && goesOn(i - 1, i))
                faces.back().plates.push_back(i);
            else
                faces.push_back({part, {i}, false});
            if (smooth_ > 0 && edge.to == edges_[plates_.plates[faces[ring].plates[0]].edge].from) close(faces, ring);
        }
        return faces;
    }

    static bool has(const std::vector<Face>& faces, const Part& part) {
        return std::any_of(faces.begin(), faces.end(), [&](const Face& face) { return face.part == &part; });
    }

    /// Parts that may have no face: a party wall comes of what stands beside, which may be missing.
    static bool mayBeWithout(const Part& part) {
        return isLevelWord(part.label) || part.label == "shared" || part.label == "side";
    }

    /// Parts that no face gets are told.
    void noteWords(const std::vector<Face>& faces) const {
        for (const Part& part : faces_.parts)
            if (!mayBeWithout(part))
                context_.select(part.span, has(faces, part), [&] {
                    return derive::noEdgeLeft(part.label, footprint_, "parts", "so no face gets this part",
                                              {"top", "bottom", "shared"});
                });
    }

    /// Without 'rest' a side that no part has takes the core with it: so a block goes but for a plate. A word that no
    /// edge has is told by itself.
    void warnOfLostCore(const std::vector<Face>& faces) const {
        if (findPart(faces_, "rest")) return;
        for (const Part& part : faces_.parts)
            if (!mayBeWithout(part) && !has(faces, part)) return;
        std::vector<std::string> lost;
        for (const Face& face : faces) {
            if (face.part) continue;
            const std::string side = plan::edgeWords(footprint_, edges_[plates_.plates[face.plates[0]].edge]).front();
            if (std::find(lost.begin(), lost.end(), side) == lost.end()) lost.push_back(side);
        }
        if (lost.empty()) return;
        context_.warn(
            faces_.span,
            fmt::format("no part for {}, nor for rest: all goes but the parts that are written", fmt::join(lost, ", ")),
            "write 'rest: nil' if that is meant, or give 'rest' a shape of its own, which reaches to the "
            "sides without a part");
    }

    /// The last face of a ring may go on into its first one.
    void close(std::vector<Face>& faces, size_t ring) const {
        Face &begin = faces[ring], &end = faces.back();
        if (!end.part || end.part != begin.part || !goesOn(end.plates.back(), begin.plates[0])) return;
        if (&begin == &end) {
            begin.closed = true;
            return;
        }
        begin.plates.insert(begin.plates.begin(), end.plates.begin(), end.plates.end());
        faces.pop_back();
    }

    plan::Footprint joined(const Face& face) const {
        std::vector<plan::Plate> plates;
        for (const size_t plate : face.plates) plates.push_back(plates_.plates[plate]);
        return plan::joined(plates, face.closed);
    }

    /// Runs the part in the face's own frame: x along its chord, z outward; about the middle of what it covers.
    bool runSide(const Face& face) {
        const PlacedEdge &first = edges_[plates_.plates[face.plates[0]].edge],
                         &last = edges_[plates_.plates[face.plates.back()].edge];
        Scope scope = plateOf(first);
        Vec2 right{1, 0}, outward{0, 1}, middle = middleOf(first);
        if (!face.closed) {
            PlacedEdge chord = first;
            chord.to = last.to;
            outward = chord.normal();
            right = {outward.z, -outward.x};
        }
        plan::Footprint own = joined(face);
        const auto turn = [&](Vec2 p) { return Vec2{dot(p - middle, right), dot(p - middle, outward)}; };
        const auto eachRing = [&](auto&& visit) {
            for (plan::Polygon& polygon : own.polygons) {
                visit(polygon.outer);
                for (plan::Ring& court : polygon.courts) visit(court);
            }
        };
        eachRing([&](plan::Ring& ring) {
            std::transform(ring.points.begin(), ring.points.end(), ring.points.begin(), turn);
        });
        if (face.plates.size() > 1) {
            const plan::Box2 box = bounds(own);
            const Vec2 c = box.centre();
            eachRing([&](plan::Ring& ring) {
                for (Vec2& p : ring.points) p = p - c;
            });
            middle = middle + right * c.x + outward * c.z;
            const Scope& whole = context_.scope();
            scope.centre = whole.centre + whole.axes * Vec3d{middle.x, 0, middle.z};
            scope.axes = whole.axes * Mat3{{right.x, 0, right.z}, {0, 1, 0}, {outward.x, 0, outward.z}};
            scope.size = {box.size().x, whole.size.y, box.size().z};
        }
        const auto over = context_.over(scope, own, faces_.span);
        const uint32_t edge = plates_.plates[face.plates[0]].edge;
        return over && context_.run(*face.part->body, *over, combine(hashText("side"), edge));
    }

    bool runLevel(const Part& part, const plan::Footprint& plan, Levels levels, uint64_t key) {
        if (levels.top_m - levels.bottom_m <= leastPart_m) return true;
        const plan::Box2 box = bounds(plan);
        Scope scope = context_.scope();
        const Vec2 c = box.centre();
        scope.centre += scope.axes * Vec3d{c.x, (levels.bottom_m + levels.top_m) / 2, c.z};
        scope.size = {box.size().x, levels.top_m - levels.bottom_m, box.size().z};
        const auto over = context_.over(scope, plan::placed(plan, {1, 1}, {-c.x, -c.z}), faces_.span);
        return over && context_.run(*part.body, *over, combine(hashText("level"), key));
    }

    PartsContext& context_;
    const Parts& faces_;
    const plan::Footprint footprint_;
    const std::vector<PlacedEdge> edges_;
    const double thickness_m_, smooth_;  ///< radians that smooth sides may bend by, 0 for none
    plan::Plates plates_;
};

bool runFaces(PartsContext& context, const Parts& faces) {
    const double thickness_m = context.evaluate(faces.args[0], hashText("thickness")).num();
    if (!(thickness_m > 0)) return context.fail("the plates of 'faces' are thicker than 0", faces.args[0].span);
    const double smooth = faces.args.size() > 1 ? context.evaluate(faces.args[1], hashText("smooth")).num() : 0;
    if (!(smooth >= 0 && smooth < mostBend))
        return context.fail("'smooth' lies between 0deg and 90deg", faces.args[1].span);
    auto plates = plan::platesOf(context.footprint(), thickness_m);
    if (!plates.ok()) return context.fail(plates.error().message, faces.span);
    return Faces(context, faces, thickness_m, smooth, std::move(*plates)).run();
}

}  // namespace

constinit const Operation faces{
    .name = "faces",
    .doc =
        "Takes a block apart: plates along the edges of its footprint, called side, front (+z), back, left, right, "
        "court, shared (where another shape stood before most of it when the generation began) or by a tag; "
        "top and bottom plates; and rest, the core, which reaches to sides without a part. What has no part goes. The "
        "first word that fits an edge wins; in a plate x runs from left "
        "to right seen "
        "from outside and z outward. With 'smooth', sides of one part that bend by no more than the angle are one "
        "face. The outline of a face is called outer: 'split along outer' gives it bays that follow a curve.",
    .example =
        "footprint arc(9m, 14m, 30deg, 150deg, 24) extrude 6m faces .3m smooth 20deg { outer: split along outer { { "
        "~3m: "
        "wall }* } | side: wall | rest: nil }",
    .arguments = facesArguments,
    .phase = Operation::Phase::Content,
    .block = {.label = "side"},
    .checkParts = checkFaces,
    .run = runFaces,
};

}  // namespace sgm::operations
