#include "grammar/pipeline/floating.h"

#include <fmt/format.h>

#include <algorithm>

#include "grammar/derive/support.h"
#include "grammar/pipeline/gaps.h"

namespace sgm::pipeline {
namespace {

/// By shape: the piece that its surface belongs to, `none` or several.
std::vector<uint32_t> piecesByShape(const Model& model, const std::vector<mesh::ConnectedComponent>& pieces) {
    std::vector<uint32_t> pieceOf(model.derivation.tree.shapes.size(), derive::none);
    for (uint32_t i = 0; i < pieces.size(); ++i)
        for (const OriginId origin : pieces[i].origins) {
            const derive::ShapeId shape = model.lowered->shapeOf[origin];
            if (shape != derive::none) pieceOf[shape] = pieceOf[shape] == derive::none ? i : derive::mixedGroups;
        }
    return pieceOf;
}

/// A piece of shapes that other pieces share is named after the one that has most of its surface.
derive::ShapeId beginOf(const Model& model, std::span<const uint32_t> pieceOf, uint32_t index,
                        const mesh::ConnectedComponent& piece) {
    const derive::ShapeId begin = derive::beginOf(model.derivation.tree, pieceOf, index);
    if (begin != derive::none) return begin;
    const derive::ShapeId owner = model.lowered->shapeOf[piece.origins.front()];
    return owner == derive::none ? 0 : owner;
}

/// Whether smaller cells would help.
bool isOfCells(FloatCause::Kind kind) {
    return kind == FloatCause::Kind::Touch || kind == FloatCause::Kind::Thin || kind == FloatCause::Kind::Fragment;
}

}  // namespace

Support supportOf(const Model& model, const mesh::Mesh& mesh, float cell_m) {
    auto pieces = mesh::connectedComponents(mesh, cell_m);
    const auto pieceOf = piecesByShape(model, pieces);
    Support support;
    support.pieces = pieces.size();
    for (uint32_t i = 0; i < pieces.size(); ++i)
        if (pieces[i].floats) support.floating.push_back({pieces[i], beginOf(model, pieceOf, i, pieces[i]), {}});
    std::stable_sort(support.floating.begin(), support.floating.end(),
                     [](const Floating& a, const Floating& b) { return a.piece.volume_m3 > b.piece.volume_m3; });
    return support;
}

std::vector<MeshWarning> floatingWarnings(const Model& model, const Support& support, float cell_m) {
    constexpr size_t most = 5;
    std::vector<MeshWarning> warnings;
    for (size_t i = 0; i < std::min(support.floating.size(), most); ++i) {
        const Floating& f = support.floating[i];
        const Vec3f at = f.piece.bounds.centre();
        const std::string cause = causeText(model, f.cause, cell_m);
        warnings.push_back({model.derivation.tree.shapes[f.shape].span,
                            {},
                            fmt::format("{} floats: {:.3g} m³ about ({:.2f}, {:.2f}, {:.2f}){}{}",
                                        derive::madeBy(model.derivation, f.shape), f.piece.volume_m3, at.x, at.y, at.z,
                                        cause.empty() ? "" : "; ", cause),
                            f.besideMissing || isOfCells(f.cause.kind)});
    }
    if (support.floating.size() > most)
        warnings.push_back({{},
                            {},
                            fmt::format("{} more pieces float", support.floating.size() - most),
                            std::all_of(warnings.begin(), warnings.end(), [](const auto& w) { return w.ofCells; })});
    return warnings;
}

}  // namespace sgm::pipeline
