#include "grammar/pipeline/floating.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>

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

/// Floating pieces that one line of a grammar made.
struct FloatingLine {
    const Floating* largest = nullptr;
    size_t pieces = 0;
    double volume_m3 = 0;
    bool ofCells = false;  ///< smaller cells would help with all of them
};

/// Those of most volume first. Pieces that smaller cells would help with are told apart from others.
std::vector<FloatingLine> floatingLines(const Model& model, const Support& support) {
    using Key = std::tuple<const syntax::Source*, uint32_t, bool>;
    std::map<Key, size_t> placeOf;
    std::vector<FloatingLine> lines;
    for (const Floating& f : support.floating) {
        const syntax::SourceSpan& span = model.derivation.tree.shapes[f.shape].span;
        const uint32_t line = span.source ? span.source->place(span.begin).line : 0;
        const bool ofCells = f.besideMissing || isOfCells(f.cause.kind);
        const auto [at, isNew] = placeOf.try_emplace({span.source, line, ofCells}, lines.size());
        if (isNew) lines.push_back({&f, 0, 0, ofCells});
        ++lines[at->second].pieces, lines[at->second].volume_m3 += f.piece.volume_m3;
    }
    std::stable_sort(lines.begin(), lines.end(),
                     [](const FloatingLine& a, const FloatingLine& b) { return a.volume_m3 > b.volume_m3; });
    return lines;
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
    const std::vector<FloatingLine> lines = floatingLines(model, support);
    std::vector<MeshWarning> warnings;
    size_t left = 0;
    bool areOfCells = true;
    for (const FloatingLine& line : lines) {
        areOfCells = areOfCells && line.ofCells;
        if (warnings.size() == most) {
            left += line.pieces;
            continue;
        }
        const Floating& f = *line.largest;
        const Vec3f at = f.piece.bounds.centre();
        const std::string cause = causeText(model, f.cause, cell_m);
        std::string text = fmt::format("{} floats: {:.3g} m³ about ({:.2f}, {:.2f}, {:.2f}){}{}",
                                       derive::madeBy(model.derivation, f.shape), f.piece.volume_m3, at.x, at.y, at.z,
                                       cause.empty() ? "" : "; ", cause);
        if (line.pieces > 1)
            text += fmt::format("; {} more piece{} of this line, {:.3g} m³ in all, float{} too", line.pieces - 1,
                                line.pieces == 2 ? "" : "s", line.volume_m3 - f.piece.volume_m3,
                                line.pieces == 2 ? "s" : "");
        warnings.push_back({model.derivation.tree.shapes[f.shape].span, {}, std::move(text), line.ofCells});
    }
    if (left > 0)
        warnings.push_back({{},
                            {},
                            fmt::format("{} more piece{} float{}", left, left == 1 ? "" : "s", left == 1 ? "s" : ""),
                            areOfCells});
    return warnings;
}

}  // namespace sgm::pipeline
