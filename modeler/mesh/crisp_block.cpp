#include "modeler/mesh/crisp_block.h"

#include <algorithm>

#include "modeler/mesh/marching_cubes.h"

namespace sgm::mesh {
namespace {

constexpr int edgePlace(Vec3i corner, int axis) { return 3 * cornerNumber(corner.x, corner.y, corner.z) + axis; }
constexpr Vec3i offset(int corner) { return {corner & 1, corner >> 1 & 1, corner >> 2}; }

/// The brick of the cell at a corner of its block.
size_t brickOf(Vec3i low) {
    return static_cast<size_t>(brickNumber({low.x / brickCells, low.y / brickCells, low.z / brickCells}));
}

/// An edge's number among the four of a face: along u or v, at the low or high end of the other.
int codeInFace(int edge, int axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3, along = edgeAxis(edge), other = along == u ? v : u;
    return (along == u ? 0 : 2) + (edgeCorner(edge) >> other & 1);
}

/// Whether two segments run through the face of a cell: corners alternate around it.
bool isAmbiguous(int inside, int axis, int side) {
    const int u = 1 << (axis + 1) % 3, v = 1 << (axis + 2) % 3, base = side << axis;
    const auto in = [&](int corner) { return inside >> corner & 1; };
    return in(base) == in(base | u | v) && in(base | u) == in(base | v) && in(base) != in(base | u);
}

}  // namespace

/// Cells whose vertices lie on several pieces.
void CrispBlock::findMixedCells() {
    mixed_.clear();
    const uint32_t* const labels = surface_->labels.data();
    const auto labelOf = [&](uint32_t corner) { return labels[surface_->placeOf(corner)]; };
    size_t t = 0;
    for (uint32_t c = 0; c < surface_->cells.size(); ++c) {
        const size_t first = t, end = first + caseTable()[surface_->cells[c].inside].triangles;
        bool mixed = false;
        for (; t < end; ++t) {
            const Triangle& triangle = surface_->triangles[t];
            const uint32_t label = labelOf(triangle.x);
            mixed = mixed || label != labelOf(triangle.y) || label != labelOf(triangle.z);
        }
        if (mixed) mixed_.push_back({c, static_cast<uint32_t>(first), static_cast<uint32_t>(end)});
    }
}

/// The place of the vertex on an edge of the cell at `low`.
uint32_t CrispBlock::placeAt(Vec3i low, int edge) const { return surface_->placeOf(surface_->vertexOf(low, edge)); }

const CellLoops& CrispBlock::loopsOfCell(const MixedCell& mixed) {
    const int inside = surface_->cells[mixed.cell].inside;
    if (mixed.joined == 0) return loopTable()[static_cast<size_t>(inside)];
    return loops_.joined = loopsOf(inside, mixed.joined);
}

/// Where two segments of a face would both lead from one piece to another, the field amid the face says whether they
/// part its inside corners, as marching cubes has it, or its outside corners.
uint64_t CrispBlock::joinFaces(eval::Workspace& workspace) {
    std::vector<float> x, y, z;
    std::vector<size_t> faces;                       // places in segmentAt_
    std::vector<std::pair<size_t, uint32_t>> asked;  // mixed cell and face, number
    for (size_t m = 0; m < mixed_.size(); ++m) {
        const SurfaceCell& cell = surface_->cells[mixed_[m].cell];
        const Vec3i low = cornerIndices(cell.corner);
        for (int face = 0; face < 6; ++face) {
            const int axis = face / 2;
            if (!isAmbiguous(cell.inside, axis, face % 2)) continue;
            std::array<uint32_t, 4> places{};  // of its vertices, by code
            for (int e = 0; e < edgesPerCell; ++e)
                if (edgeAxis(e) != axis && (edgeCorner(e) >> axis & 1) == face % 2)
                    places[static_cast<size_t>(codeInFace(e, axis))] = placeAt(low, e);
            // Only where a segment of marching cubes has two labels is the neighbour mixed too.
            const int base = (face % 2) << axis;
            const bool diagonal = (cell.inside >> base & 1) != 0;  // inside corners are those at both low or high ends
            const auto differ = [&](size_t p, size_t q) {
                return surface_->labels[places[p]] != surface_->labels[places[q]];
            };
            if (diagonal ? !differ(0, 2) && !differ(1, 3) : !differ(0, 3) && !differ(1, 2)) continue;
            const auto key = static_cast<size_t>(4 * edgePlace(low + stepAlong(axis) * (face % 2), axis));
            if (segmentAt_[key] == 0) {
                Vec3f sum{};
                for (const uint32_t p : places) sum += surface_->positions[p];
                sum *= 0.25f;
                x.push_back(sum.x), y.push_back(sum.y), z.push_back(sum.z);
                faces.push_back(key);
                segmentAt_[key] = static_cast<uint32_t>(faces.size());
            }
            asked.emplace_back(6 * m + static_cast<size_t>(face), segmentAt_[key] - 1);
        }
    }
    for (const size_t key : faces) segmentAt_[key] = 0;
    std::vector<float> f(x.size());
    if (!x.empty())
        eval::evaluate(surface_->block->tape, {x.data(), y.data(), z.data(), x.size()}, f.data(), workspace);
    for (const auto& [at, number] : asked)
        if (f[number] < 0) mixed_[at / 6].joined |= 1 << at % 6;
    return x.size();
}

/// The segment of a side of a loop whose ends have different labels, and whether the loop runs along it backward.
int32_t CrispBlock::segmentOf(const SurfaceCell& cell, const CellLoop& loop, int side) {
    const Vec3i low = cornerIndices(cell.corner);
    const int edges[] = {loop.edges[static_cast<size_t>(side)],
                         loop.edges[static_cast<size_t>((side + 1) % loop.size)]};
    const uint32_t place[] = {placeAt(low, edges[0]), placeAt(low, edges[1])};
    if (surface_->labels[place[0]] == surface_->labels[place[1]]) return -1;
    const int face = loop.faces[static_cast<size_t>(side)], axis = face / 2;
    const int codes[] = {codeInFace(edges[0], axis), codeInFace(edges[1], axis)};
    const int reversed = codes[0] > codes[1] ? 1 : 0;
    const Vec3i corner = low + stepAlong(axis) * (face % 2);
    uint32_t& known = segmentAt_[static_cast<size_t>(4 * edgePlace(corner, axis) + std::min(codes[0], codes[1]))];
    if (known == 0) {
        FaceSegment segment;
        segment.face = first_ + corner, segment.axis = axis;
        segment.alone = !isAmbiguous(cell.inside, axis, face % 2);
        segment.brick = brickOf(low);
        segments_.list.push_back(segment);
        segments_.ends.push_back({place[reversed], place[1 ^ reversed]});
        segments_.codes.push_back(static_cast<uint8_t>(std::min(codes[0], codes[1])));
        known = static_cast<uint32_t>(segments_.list.size());
    }
    return 2 * static_cast<int32_t>(known - 1) + reversed;
}

/// Lists the segments of the mixed cells' loops, after those that are listed.
void CrispBlock::findSegments() {
    loops_.sides.clear();
    for (const MixedCell& mixed : mixed_) {
        if (mixed.isInRun) continue;
        const SurfaceCell& cell = surface_->cells[mixed.cell];
        const CellLoops& loops = loopsOfCell(mixed);
        for (int l = 0; l < loops.count; ++l)
            for (int side = 0; side < loops.loops[l].size; ++side)
                loops_.sides.push_back(segmentOf(cell, loops.loops[l], side));
    }
    findSegmentsOfRuns();
}

/// What is found next is listed as new segments.
void CrispBlock::forgetPlaces() {
    for (size_t s = 0; s < segments_.list.size(); ++s)
        segmentAt_[static_cast<size_t>(4 * edgePlace(segments_.list[s].face - first_, segments_.list[s].axis) +
                                       segments_.codes[s])] = 0;
}

/// The segments in the faces between runs and the cells before and after them, which have found them.
void CrispBlock::findSegmentsOfRuns() {
    segments_.ofRuns.clear();
    if (!runs_) return;
    for (const StraightRun& run : runs_->all()) {
        const int code = std::min(codeInFace(run.edges[0], run.axis), codeInFace(run.edges[1], run.axis));
        const auto segmentAt = [&](int k) {
            const Vec3i corner = run.low + stepAlong(run.axis) * k;
            return segmentAt_[static_cast<size_t>(4 * edgePlace(corner, run.axis) + code)] - 1;
        };
        segments_.ofRuns.push_back({segmentAt(0), segmentAt(run.cells)});
    }
}

/// Looks at the pieces once at each vertex that ends a segment from `first` on. Returns at how many.
uint64_t CrispBlock::evaluateEnds(size_t first, eval::Workspace& workspace) {
    samples_.clear();
    const size_t known = points_.list.size();
    for (size_t s = first; s < segments_.list.size(); ++s)
        for (const uint32_t p : segments_.ends[s]) {
            if (points_.of[p] != 0) continue;
            samples_.add(surface_->tapes, segments_.list[s].brick, surface_->positions[p]);
            points_.list.push_back({{}, {}, surface_->labels[p], surface_->origins[p]});
            points_.of[p] = static_cast<uint32_t>(points_.list.size());
        }
    samples_.evaluate(workspace);
    points_.values.resize(points_.list.size());
    for (size_t i = 0; i < samples_.size(); ++i) {
        const PiecePoint found = samples_.point(i, points_.values[known + i]);
        points_.list[known + i].at = found.at, points_.list[known + i].gradient = found.gradient;
    }
    for (size_t s = first; s < segments_.list.size(); ++s)
        for (size_t end = 0; end < 2; ++end) {
            const size_t i = points_.of[segments_.ends[s][end]] - 1;
            segments_.list[s].ends[end] = points_.list[i], segments_.list[s].values[end] = points_.values[i];
        }
    return samples_.size();
}

void CrispBlock::takeNormalsOfPieces(PageVector<Vec3f>& normals) const {
    for (uint32_t p = 0; p < surface_->own; ++p)
        if (const uint32_t point = points_.of[p]; point != 0)
            if (const Vec3f n = normalized(points_.list[point - 1].gradient); n != Vec3f{}) normals[p] = n;
}

/// The piece at a vertex of a mixed cell.
const PiecePoint& CrispBlock::pointAt(uint32_t place) {
    if (points_.of[place] == 0) {
        points_.list.push_back(
            {surface_->positions[place], surface_->normals[place], surface_->labels[place], surface_->origins[place]});
        points_.of[place] = static_cast<uint32_t>(points_.list.size());
    }
    return points_.list[points_.of[place] - 1];
}

/// Numbers breaks: own ones after the block's other vertices, those on its low sides as ghosts after the others.
/// On sides they come in order of place.
void CrispBlock::numberBreaks() {
    segments_.breakVertex.assign(creases_.breaks().size(), 0);
    std::array<std::vector<std::pair<uint32_t, uint32_t>>, 3> low, high;
    uint32_t own = surface_->own;
    for (uint32_t s = 0; s < segments_.list.size(); ++s) {
        const FaceSegment& segment = segments_.list[s];
        const Vec3i at = segment.face - first_;
        const auto axis = static_cast<size_t>(segment.axis);
        const auto key = static_cast<uint32_t>(4 * edgePlace(at - stepAlong(segment.axis) * at[segment.axis], 0) +
                                               segments_.codes[s]);
        if (at[segment.axis] == 0) {
            low[axis].emplace_back(key, s);
            continue;
        }
        if (at[segment.axis] == blockCells) high[axis].emplace_back(key, s);
        for (uint32_t b = 0; b < segment.breaks; ++b) segments_.breakVertex[segment.firstBreak + b] = own++;
    }
    auto ghosts = static_cast<uint32_t>(surface_->positions.size()) - surface_->own;
    for (size_t axis = 0; axis < 3; ++axis) {
        std::sort(low[axis].begin(), low[axis].end());
        std::sort(high[axis].begin(), high[axis].end());
        const uint32_t before = ghosts;
        for (const auto& [key, s] : low[axis])
            for (uint32_t b = 0; b < segments_.list[s].breaks; ++b)
                segments_.breakVertex[segments_.list[s].firstBreak + b] = ghostBit | ghosts++;
        border_.ghostCount[axis] = ghosts - before;
        border_.shared[axis].clear();
        for (const auto& [key, s] : high[axis])
            for (uint32_t b = 0; b < segments_.list[s].breaks; ++b)
                border_.shared[axis].push_back(segments_.breakVertex[segments_.list[s].firstBreak + b]);
    }
    out_.positions.resize(own - surface_->own), out_.normals.resize(own - surface_->own);
    for (size_t b = 0; b < segments_.breakVertex.size(); ++b) {
        if (segments_.breakVertex[b] & ghostBit) continue;
        const Break& at = creases_.breaks()[b];
        const Vec3f n = normalized(normalized(at.sides[0].gradient) + normalized(at.sides[1].gradient));
        out_.positions[segments_.breakVertex[b] - surface_->own] = at.at;
        if (at.crossing != at.at) out_.confined.push_back({segments_.breakVertex[b], at.crossing});
        out_.normals[segments_.breakVertex[b] - surface_->own] = n == Vec3f{} ? Vec3f{0, 1, 0} : n;
    }
}

/// A loop with the breaks on its sides.
void CrispBlock::addNodes(const SurfaceCell& cell, const CellLoop& loop, size_t& side) {
    nodes_.clear();
    const Vec3i low = cornerIndices(cell.corner);
    for (int i = 0; i < loop.size; ++i, ++side) {
        const int edge = loop.edges[static_cast<size_t>(i)];
        const uint32_t vertex = surface_->number[edgePlace(low + offset(edgeCorner(edge)), edgeAxis(edge))];
        const uint32_t place = surface_->placeOf(vertex);
        const PiecePoint& own = pointAt(place);
        LoopNode node{vertex, own.at, own.label, own.origin};
        node.sides = {&own, &own};
        const int32_t known = loops_.sides[side];
        nodes_.push_back(node);
        if (known < 0) continue;
        const FaceSegment& segment = segments_.list[static_cast<size_t>(known / 2)];
        const bool reversed = known % 2 != 0;
        for (uint32_t k = 0; k < segment.breaks; ++k) {
            const uint32_t b = segment.firstBreak + (reversed ? segment.breaks - 1 - k : k);
            const Break& at = creases_.breaks()[b];
            LoopNode& point = nodes_.emplace_back();
            point.vertex = segments_.breakVertex[b], point.at = at.at;
            point.sides = {&at.sides[reversed ? 1 : 0], &at.sides[reversed ? 0 : 1]};
            point.label = point.sides[1]->label, point.origin = point.sides[1]->origin;
            point.isBreak = true;
            point.crossing = &at.crossing;
            point.face = static_cast<int8_t>(loop.faces[static_cast<size_t>(i)]);
        }
    }
}

void CrispBlock::splitCells() {
    pieces_.clear();
    size_t side = 0;
    for (const MixedCell& mixed : mixed_) {
        if (mixed.isInRun) continue;
        const SurfaceCell& cell = surface_->cells[mixed.cell];
        const CellLoops& loops = loopsOfCell(mixed);
        for (int l = 0; l < loops.count; ++l) {
            addNodes(cell, loops.loops[l], side);
            pieces_.addLoop(first_ + cornerIndices(cell.corner), brickOf(cornerIndices(cell.corner)), nodes_);
        }
        pieces_.endCell();
    }
}

/// Triangles of cells that are one piece each.
void CrispBlock::copyTriangles(size_t first, size_t end) {
    out_.triangles.insert(out_.triangles.end(), surface_->triangles.begin() + static_cast<ptrdiff_t>(first),
                          surface_->triangles.begin() + static_cast<ptrdiff_t>(end));
    for (size_t t = first; t < end; ++t) {
        const uint32_t place = surface_->placeOf(surface_->triangles[t].x);
        out_.labels.push_back(surface_->labels[place]);
        out_.origins.push_back(surface_->origins[place]);
    }
}

/// The end of a run, once breaks have numbers.
RunEnd CrispBlock::endOf(size_t run, size_t end) const {
    const uint32_t b = segments_.list[segments_.ofRuns[run][end]].firstBreak;
    return {&creases_.breaks()[b], segments_.breakVertex[b]};
}

void CrispBlock::assemble() {
    const PieceTriangles& pieces = split_.pieces;
    size_t copied = 0, first = 0, normal = 0, next = 0;
    for (const MixedCell& mixed : mixed_) {
        copyTriangles(copied, mixed.firstTriangle);
        copied = mixed.endTriangle;
        if (mixed.isInRun) continue;
        const uint32_t end = split_.cellEnds[next++];
        const auto base = static_cast<uint32_t>(out_.triangles.size() - first);
        for (; first < end; ++first) {
            out_.triangles.push_back(pieces.triangles[first]);
            out_.labels.push_back(pieces.labels[first]);
            out_.origins.push_back(pieces.origins[first]);
        }
        for (; normal < pieces.cornerNormals.size() && pieces.cornerNormals[normal].corner < 3 * end; ++normal)
            out_.cornerNormals.push_back(
                {pieces.cornerNormals[normal].corner + 3 * base, pieces.cornerNormals[normal].normal});
    }
    copyTriangles(copied, surface_->triangles.size());
    for (size_t r = 0; r < segments_.ofRuns.size(); ++r) runs_->fill(runs_->all()[r], {endOf(r, 0), endOf(r, 1)}, out_);
    out_.positions.insert(out_.positions.end(), pieces.positions.begin(), pieces.positions.end());
    out_.normals.insert(out_.normals.end(), pieces.normals.begin(), pieces.normals.end());
    out_.confined.insert(out_.confined.end(), pieces.confined.begin(), pieces.confined.end());
    std::sort(out_.confined.begin(), out_.confined.end(),
              [](const ConfinedVertex& a, const ConfinedVertex& b) { return a.vertex < b.vertex; });
}

/// Finds the breaks on the loops of mixed cells in no run, as far as they aren't known.
uint64_t CrispBlock::findBreaks(eval::Workspace& workspace) {
    const size_t first = segments_.list.size();
    findSegments();
    const uint64_t evaluations = evaluateEnds(first, workspace);
    return evaluations + creases_.solve(surface_->tapes, *surface_->grid, workspace, segments_.list, first);
}

/// Leaves out runs between whose ends the crease isn't straight, or has other pieces beside it. Whether there were any.
bool CrispBlock::leaveOutBent() {
    if (!runs_) return false;
    return runs_->leaveOut(mixed_, [&](size_t r) {
        std::array<const Break*, 2> ends{};
        for (size_t end = 0; end < 2; ++end) {
            const FaceSegment& segment = segments_.list[segments_.ofRuns[r][end]];
            if (segment.breaks != 1) return false;
            ends[end] = &creases_.breaks()[segment.firstBreak];
        }
        return runs_->isStraight(runs_->all()[r], ends);
    });
}

uint64_t CrispBlock::run(const BlockSurface& surface, eval::Workspace& workspace) {
    surface_ = &surface;
    first_ = surface.block->index * blockCells;
    out_.clear(), split_.pieces.clear();
    for (auto& list : border_.shared) list.clear();
    border_.ghostCount = {};
    findMixedCells();
    if (mixed_.empty()) return 0;
    if (runs_) runs_->find(surface, mixed_);
    uint64_t evaluations = joinFaces(workspace);
    segments_.list.clear(), segments_.ends.clear(), segments_.codes.clear();
    points_.clear(surface.positions.size());
    evaluations += findBreaks(workspace);
    if (leaveOutBent()) evaluations += findBreaks(workspace);
    forgetPlaces();
    numberBreaks();
    splitCells();
    const auto corners = surface.own + static_cast<uint32_t>(out_.positions.size());
    evaluations += pieces_.placeCorners(surface.tapes, *surface.grid, workspace, corners);
    pieces_.triangulate(split_.pieces, split_.cellEnds);
    assemble();
    return evaluations;
}

}  // namespace sgm::mesh
