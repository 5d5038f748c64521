// Where textures begin: the scopes and outlines of shapes that are laid.
#include <algorithm>
#include <unordered_map>

#include "grammar/derive/lift.h"
#include "grammar/lower/lower.h"
#include "modeler/image/texture_frame.h"

namespace sgm::lower {
namespace {

using derive::none;
using derive::ShapeId;

/// The sides of all rings about the scope's centre, each to the right as seen from outside.
void addSides(image::TextureFrame& frame, const plan::Footprint& footprint, Vec3d half) {
    const auto local = [&](plan::Vec2 p) { return Vec3d{p.x + half.x, 0, p.z - half.z}; };
    std::vector<image::TextureSide> ring;
    double at_m = 0;
    const auto close = [&] {
        for (image::TextureSide& side : ring) side.round_m = at_m;
        frame.sides.insert(frame.sides.end(), ring.begin(), ring.end());
        ring.clear();
        at_m = 0;
    };
    // Seen from outside, edges run to the left.
    std::vector<plan::PlacedEdge> edges = plan::edgesOf(footprint);
    std::reverse(edges.begin(), edges.end());
    for (size_t i = 0; i < edges.size(); ++i) {
        const plan::PlacedEdge& edge = edges[i];
        if (i > 0 && (edge.ring != edges[i - 1].ring || edge.polygon != edges[i - 1].polygon)) close();
        const double length_m = edge.length();
        if (!(length_m > 0)) continue;
        const Vec3d from = local(edge.to);
        ring.push_back({from, (local(edge.from) - from) / length_m, length_m, at_m, 0});
        at_m += length_m;
    }
    close();
}

std::shared_ptr<const image::TextureFrame> frameOf(const derive::ShapeTree& tree, const derive::Scope& scope) {
    auto frame = std::make_shared<image::TextureFrame>();
    const Vec3d half = scope.half();
    frame->origin = scope.point({-1, -1, 1});
    frame->axes = scope.axes;
    frame->size_m = scope.size;
    if (scope.footprint != none)
        addSides(*frame, tree.footprints.inMetres(scope.footprint, half), half);
    else
        addSides(*frame,
                 plan::footprintOf(
                     plan::polygonOf({{-half.x, half.z}, {-half.x, -half.z}, {half.x, -half.z}, {half.x, half.z}})),
                 half);
    return frame;
}

}  // namespace

void layTextures(const derive::Derivation& derivation, Model& model) {
    const derive::ShapeTree& tree = derivation.tree;
    Provenance& provenance = model.provenance;
    const auto& materials = provenance.materials;
    if (std::none_of(materials.begin(), materials.end(), [](const Material& m) { return m.texture != nullptr; }))
        return;
    std::unordered_map<ShapeId, std::shared_ptr<const image::TextureFrame>> frames;
    for (size_t i = 1; i < provenance.parts.size(); ++i) {
        Part& part = provenance.parts[i];
        const image::Texture* texture = materials[part.material].texture.get();
        if (!texture || model.shapeOf[i] == none) continue;
        ShapeId laid = model.shapeOf[i];
        const derive::Extras* extras = nullptr;
        for (; laid != none; laid = tree.shapes[laid].parent)
            if ((extras = tree.extrasOf(laid)) && extras->laid) break;
        if (laid == none) {
            part.textureFrame = nullptr;
            if (!texture->fits) continue;
            laid = model.shapeOf[i], extras = nullptr;
        }
        auto& frame = frames[laid];
        if (!frame)
            frame =
                frameOf(tree, extras && extras->laidScope ? *extras->laidScope : derive::liftedScope(derivation, laid));
        part.textureFrame = frame;
    }
    if (provenance.parts.size() > 1) provenance.parts[0].textureFrame = provenance.parts[1].textureFrame;
}

}  // namespace sgm::lower
