// `at each(…)`: newcomers on the sides and corners of a block and on the faces of a roof.
#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "grammar/derive/faces.h"
#include "grammar/derive/interpreter.h"
#include "grammar/derive/scope_footprint.h"
#include "modeler/core/random.h"
#include "modeler/field/roof_faces.h"
#include "modeler/plan/edge_words.h"

namespace sgm::derive {
namespace {

using rules::FaceChoice;
using Kind = FaceChoice::Kind;

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

/// Why `each` finds no face of the host.
Explanation noFace(const Derivation& derivation, ShapeId host, const FaceChoice& choice) {
    const ShapeTree& tree = derivation.tree;
    const plan::Footprint footprint = footprintOf(tree.shapes[host].scope, tree.footprints);
    const std::vector<plan::PlacedEdge> edges = plan::edgesOf(footprint);
    const bool isCalled = std::any_of(edges.begin(), edges.end(), [&](const plan::PlacedEdge& edge) {
        return plan::isEdgeCalled(footprint, edge, choice.word);
    });
    if (isCalled) {
        const auto kind = std::find_if(std::begin(rules::faceKinds), std::end(rules::faceKinds),
                                       [&](const auto& k) { return k.second == choice.kind; });
        std::vector<std::string_view> others;
        const bool isLarge = footprint.edgeCount() > field::mostRoofLineEdges;
        for (const auto& [word, other] : rules::faceKinds)
            if (!(isLarge && isLine(other)) &&
                !facesOf(tree.shapes[host].scope, tree.footprints, tree.solidOf(host), {other, choice.word}).empty())
                others.push_back(word);
        return {
            fmt::format("'{}' has no {}{}, so nothing grows here", tree.labels[tree.shapes[host].label], kind->first,
                        choice.word == "side" ? "" : fmt::format(" over edges called '{}'", choice.word)),
            others.empty() ? "name faces that it has (docs/footprints.md, 'Growing on faces')"
                           : fmt::format("there it has each of {}", fmt::join(others, ", "))};
    }
    std::vector<std::string> kinds;
    for (const auto& kind : rules::faceKinds) kinds.emplace_back(kind.first);
    Explanation explanation = noEdgeCalled(choice.word, footprint, "so nothing grows here", kinds);
    const auto& symbols = derivation.grammar->symbols;
    if (std::any_of(symbols.begin(), symbols.end(), [&](const auto& s) { return s.name == choice.word; }))
        explanation.hint = fmt::format("'on each({})' is every shape of that symbol", choice.word);
    return explanation;
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
        const std::vector<Face> faces = facesOf(scope, footprints, builder_.tree().solidOf(at), choice);
        select(builder_, e.at->span, !faces.empty(), [&] { return noFace(builder_.derivation(), at, choice); });
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
