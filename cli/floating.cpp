#include "cli/floating.h"

#include <fmt/format.h>

#include <cstdio>

#include "cli/gaps.h"
#include "cli/messages.h"
#include "grammar/derive/support.h"

namespace sgm::cli {
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

}  // namespace

Support supportOf(const Model& model, const mesh::Mesh& mesh, float cell_m) {
    auto pieces = mesh::connectedComponents(mesh, cell_m);
    const auto pieceOf = piecesByShape(model, pieces);
    Support support;
    support.pieces = pieces.size();
    for (uint32_t i = 0; i < pieces.size(); ++i)
        if (pieces[i].floats) support.floating.push_back({pieces[i], beginOf(model, pieceOf, i, pieces[i]), {}});
    return support;
}

void printFloating(const Model& model, const Support& support, float cell_m) {
    constexpr size_t most = 5;
    for (size_t i = 0; i < std::min(support.floating.size(), most); ++i) {
        const Floating& f = support.floating[i];
        const Vec3f at = f.piece.bounds.centre();
        const std::string cause = causeText(model, f.cause, cell_m);
        printMessage("warning: {} floats: {:.3g} m³ about ({:.2f}, {:.2f}, {:.2f}){}{}\n",
                     derive::madeBy(model.derivation, f.shape), f.piece.volume_m3, at.x, at.y, at.z,
                     cause.empty() ? "" : "; ", cause);
    }
    if (support.floating.size() > most) printMessage("warning: {} more pieces float\n", support.floating.size() - most);
}

void keepOnly(mesh::Keep keep, MeshedModel& meshed, int threads, bool quiet) {
    const mesh::Dropped dropped = mesh::keepOnly(meshed.mesh, keep, meshed.grid.cell_m, threads);
    if (!quiet && dropped.pieces + dropped.cavities > 0)
        fmt::print("left out {} piece{} of {:.4g} m³, filled {} cavit{} of {:.4g} m³\n", dropped.pieces,
                   dropped.pieces == 1 ? "" : "s", dropped.volume_m3, dropped.cavities,
                   dropped.cavities == 1 ? "y" : "ies", dropped.filled_m3);
}

}  // namespace sgm::cli
