// What a block's chunk has more with a crisp surface: labels, creases and the seams inside faces.
#include <algorithm>

#include "modeler/mesh/chunk.h"

namespace sgm::mesh {

/// A brick of a crisp surface: every vertex has a label.
void BlockMesher::addCrispBrick(Vec3i brick, const BrickSigns& signs, const eval::Tape& tape) {
    addOwnEdges(signs);
    borrowedPlaces_.clear();
    if (lowSidesOf(brick) != 0) addGhosts(signs, brick, {});
    placeEdges(brick);
    if (highSidesOf(brick) != 0) addShared(signs, brick);
    findPlaces(tape, ownEdges_);
    findLabels(tape);
}

/// Asks for the piece of surface that each vertex lies on, the latest own ones and ghosts.
void BlockMesher::findLabels(const eval::Tape& tape) {
    const size_t n = edges_.size;
    labels_.resize(vertices_);
    if (n == 0) return;
    found_.resize(n), foundLabels_.resize(n);
    const EdgeArrays& e = edges_.arrays;
    {
        const AddTime evaluating(fieldTime_);
        eval::evaluateLabels(tape, {e.x, e.y, e.z, n, true}, foundLabels_.data(), found_.data(), workspace_);
    }
    for (size_t i = 0; i < n; ++i) foundLabels_[i] = labelOf(foundLabels_[i], found_[i]);
    std::copy_n(found_.data(), ownEdges_, origins_.data() + origins_.size() - ownEdges_);
    std::copy_n(foundLabels_.data(), ownEdges_, labels_.data() + labels_.size() - ownEdges_);
    for (size_t i = ownEdges_; i < n; ++i) {
        const auto [kind, place] = borrowedPlaces_[i - ownEdges_];
        GhostVertex& ghosts = ghosts_[static_cast<size_t>(kind)][place];
        ghosts.origin = found_[i];
        ghosts.point = {{e.x[i], e.y[i], e.z[i]}, {e.dx[i], e.dy[i], e.dz[i]}, foundLabels_[i], found_[i]};
    }
}

void BlockMesher::splitAtCreases(const Block& block, Chunk& chunk) {
    for (const auto& list : ghosts_)
        for (const GhostVertex& b : list) {
            positions_.push_back(b.point.at);
            normals_.push_back(b.point.gradient);
            labels_.push_back(b.point.label);
        }
    std::array<BrickTape, bricksPerBlock> tapes{};
    for (uint64_t rest = samples_.active(); rest != 0; rest &= rest - 1) {
        const int brick = std::countr_zero(rest);
        tapes[static_cast<size_t>(brick)] = {&samples_.tapeOf(brick), samples_.boxOf(brick)};
    }
    const BlockSurface surface{&block,         {&block.tape, tapes},
                               &grid_,         {cells_.data(), cellCount_},
                               number_.data(), vertices_,
                               positions_,     normals_,
                               labels_,        origins_,
                               chunk.triangles};
    {
        const AddTime evaluating(fieldTime_);
        counts_.refinementEvaluations += crisp_->run(surface, workspace_);
    }
    const PieceTriangles& split = crisp_->triangles();
    if (!crisp_->hasCreases()) {
        chunk.labels.resize(triangles_);
        for (size_t t = 0; t < triangles_; ++t) chunk.labels[t] = labels_[surface.placeOf(chunk.triangles[t].x)];
        return;
    }
    chunk.triangles.assign(split.triangles.begin(), split.triangles.end());
    chunk.labels.assign(split.labels.begin(), split.labels.end());
    chunk.origins.assign(split.origins.begin(), split.origins.end());
    chunk.positions.insert(chunk.positions.end(), split.positions.begin(), split.positions.end());
    chunk.normals.insert(chunk.normals.end(), split.normals.begin(), split.normals.end());
    chunk.cornerNormals = split.cornerNormals;
    chunk.confined = split.confined;
    listFaceSeams(chunk);
}

/// Appends vertices inside cell faces to the lists of the seams.
void BlockMesher::listFaceSeams(Chunk& chunk) const {
    for (int axis = 0; axis < 3; ++axis) {
        const auto end = static_cast<size_t>(edgeSeamKinds + axis + 1);
        chunk.ghosts.vertices.resize(chunk.ghosts.vertices.size() + crisp_->ghosts(axis));
        chunk.ghosts.begin[end] = static_cast<uint32_t>(chunk.ghosts.vertices.size());
        const auto& shared = crisp_->shared(axis);
        chunk.shared.vertices.insert(chunk.shared.vertices.end(), shared.begin(), shared.end());
        chunk.shared.begin[end] = static_cast<uint32_t>(chunk.shared.vertices.size());
    }
}

}  // namespace sgm::mesh
