// What a block's chunk has more with a crisp surface: labels, creases and the seams inside faces.
#include <algorithm>

#include "modeler/mesh/chunk.h"

namespace sgm::mesh {

/// A brick of a crisp surface: every vertex has a label.
void BlockMesher::addCrispBrick(Vec3i brick, const BrickSigns& signs, const eval::Tape& tape) {
    addOwnEdges(signs);
    cut_.borrowed.clear();
    if (lowSidesOf(brick) != 0) addGhosts(signs, brick, {});
    placeEdges(brick);
    if (highSidesOf(brick) != 0) addShared(signs, brick);
    findPlaces(tape, cut_.own);
    findLabels(tape);
}

/// Asks for the piece of surface that each vertex lies on, the latest own ones and ghosts.
void BlockMesher::findLabels(const eval::Tape& tape) {
    const size_t n = cut_.edges.size;
    vertices_.labels.resize(vertices_.count);
    if (n == 0) return;
    found_.origins.resize(n), found_.labels.resize(n);
    const EdgeArrays& e = cut_.edges.arrays;
    {
        const AddTime evaluating(fieldTime_);
        eval::evaluateLabels(tape, {e.x, e.y, e.z, n, true}, found_.labels.data(), found_.origins.data(), workspace_);
    }
    for (size_t i = 0; i < n; ++i) found_.labels[i] = labelOf(found_.labels[i], found_.origins[i]);
    std::copy_n(found_.origins.data(), cut_.own, vertices_.origins.data() + vertices_.origins.size() - cut_.own);
    std::copy_n(found_.labels.data(), cut_.own, vertices_.labels.data() + vertices_.labels.size() - cut_.own);
    for (size_t i = cut_.own; i < n; ++i) {
        const auto [kind, place] = cut_.borrowed[i - cut_.own];
        GhostVertex& ghosts = seams_.ghosts[static_cast<size_t>(kind)][place];
        ghosts.origin = found_.origins[i];
        ghosts.point = {{e.x[i], e.y[i], e.z[i]}, {e.dx[i], e.dy[i], e.dz[i]}, found_.labels[i], found_.origins[i]};
    }
}

void BlockMesher::splitAtCreases(const Block& block, Chunk& chunk) {
    for (const auto& list : seams_.ghosts)
        for (const GhostVertex& b : list) {
            vertices_.positions.push_back(b.point.at);
            vertices_.normals.push_back(b.point.gradient);
            vertices_.labels.push_back(b.point.label);
        }
    std::array<BrickTape, bricksPerBlock> tapes{};
    for (uint64_t rest = samples_.active(); rest != 0; rest &= rest - 1) {
        const int brick = std::countr_zero(rest);
        tapes[static_cast<size_t>(brick)] = {&samples_.tapeOf(brick), samples_.boxOf(brick)};
    }
    BlockSurface surface{&block,
                         {&block.tape, tapes},
                         &grid_,
                         {cells_.list.data(), cells_.count},
                         vertices_.number.data(),
                         vertices_.count,
                         vertices_.positions,
                         vertices_.normals,
                         vertices_.labels,
                         vertices_.origins,
                         chunk.triangles};
    if (cells_.flat) {
        cells_.flat->takeOut(surface, cells_.list, cells_.count, chunk.triangles, chunk.origins);
        surface.cells = {cells_.list.data(), cells_.count}, surface.triangles = chunk.triangles;
    }
    {
        const AddTime evaluating(fieldTime_);
        counts_.refinementEvaluations += crisp_->run(surface, workspace_);
    }
    if (crisp_->hasCreases()) {
        takeSplit(chunk);
    } else {
        chunk.labels.resize(chunk.triangles.size());
        for (size_t t = 0; t < chunk.triangles.size(); ++t)
            chunk.labels[t] = vertices_.labels[surface.placeOf(chunk.triangles[t].x)];
    }
    if (!cells_.flat) return;
    for (const Triangle& t : cells_.flat->fans()) {
        const uint32_t place = surface.placeOf(t.x);
        chunk.triangles.push_back(t);
        chunk.labels.push_back(vertices_.labels[place]);
        chunk.origins.push_back(vertices_.origins[place]);
    }
}

/// Replaces what marching cubes has made by what is split at creases.
void BlockMesher::takeSplit(Chunk& chunk) const {
    const PieceTriangles& split = crisp_->triangles();
    crisp_->takeNormalsOfPieces(chunk.normals);
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
