#include "modeler/mesh/chunk.h"

#include <algorithm>
#include <cstring>
#include <optional>

#include "modeler/core/stopwatch.h"
#include "modeler/mesh/marching_cubes.h"

namespace sgm::mesh {
namespace {

/// Vertices of several bricks are found together, where one tape is good for them, once there are so many.
constexpr size_t enoughEdges = 336;
/// A vertex of a crisp mesh lies on its piece, also where a crease near the edge misleads the first steps. Few take
/// more than two.
constexpr int leastCrispSteps = 12;

/// Place of the edge that runs along `axis` from a corner up: the edges of a cell lie close to each other.
constexpr int edgePlace(int corner, int axis) { return 3 * corner + axis; }

constexpr uint32_t codeAt(Vec3i at, int axis) {
    return codeOf(static_cast<uint32_t>(at.x), static_cast<uint32_t>(at.y), static_cast<uint32_t>(at.z),
                  static_cast<uint32_t>(axis));
}

PlacedCase placedCase(const CellCase& cell) {
    PlacedCase placed{};
    placed.triangles = cell.triangles;
    for (int i = 0; i < 3 * cell.triangles; ++i) {
        const int axis = edgeAxis(cell.edges[i]), low = edgeCorner(cell.edges[i]), row = low >> 1;
        placed.edges[i] = static_cast<int16_t>(edgePlace(cornerNumber(low & 1, row & 1, row >> 1), axis));
        placed.lanes[i] = static_cast<uint8_t>(8 * row + edgePlace(low & 1, axis));
    }
    return placed;
}

const std::array<PlacedCase, 256>& placedCases() {
    static const auto table = [] {
        std::array<PlacedCase, 256> all{};
        for (size_t c = 0; c < all.size(); ++c) all[c] = placedCase(caseTable()[c]);
        return all;
    }();
    return table;
}

/// Triangles of each case, by themselves in few lines of cache.
const std::array<uint8_t, 256>& triangleCounts() {
    static const auto table = [] {
        std::array<uint8_t, 256> all{};
        for (size_t c = 0; c < all.size(); ++c) all[c] = caseTable()[c].triangles;
        return all;
    }();
    return table;
}

/// `from` in memory of its own, as large as it is.
template <class T>
void copyTo(PageVector<T>& to, const PageVector<T>& from) {
    to.resize(from.size());
    if (!from.empty()) std::memcpy(to.data(), from.data(), from.size() * sizeof(T));
}

/// The arrays from entry n on.
EdgeArrays from(EdgeArrays e, size_t n) {
    for (float** const row : {&e.x, &e.y, &e.z, &e.dx, &e.dy, &e.dz, &e.f, &e.base, &e.span, &e.tIn, &e.fIn, &e.tOut,
                              &e.fOut, &e.t, &e.axis, &e.open})
        *row += n;
    return e;
}

/// The sides at coordinate `side` on which an edge along `axis` lies, as a mask of axes.
int sidesAt(int side, Vec3i at, int axis) {
    return ((at.x == side ? 1 : 0) | (at.y == side ? 2 : 0) | (at.z == side ? 4 : 0)) & ~(1 << axis);
}

/// Moves those cells of a brick that are in a part to the front; returns how many.
size_t keepPart(const PartOfBlock& part, Vec3i brick, std::span<SurfaceCell> cells) {
    const uint64_t cubes = part.cubes[static_cast<size_t>(brickNumber(brick))];
    const int along = brickCells / part.cubeCells;
    size_t kept = 0;
    for (const SurfaceCell& cell : cells) {
        const Vec3i at = cornerIndices(cell.corner) - brick * brickCells;
        const Vec3i cube{at.x / part.cubeCells, at.y / part.cubeCells, at.z / part.cubeCells};
        if (cubes >> (cube.x + along * (cube.y + along * cube.z)) & 1) cells[kept++] = cell;
    }
    return kept;
}

/// Whether a shortened form of a tape is all of it, so that either will do.
bool leavesNothingOut(const eval::Tape& shortened, const eval::Tape& whole) {
    return shortened.size() == whole.size() && shortened.sources().size() == whole.sources().size();
}

}  // namespace

BlockMesher::BlockMesher(const Grid& grid, const PolygonizeOptions& options)
    : grid_(grid),
      refineSteps_(static_cast<size_t>(options.surface == Surface::Crisp && options.refineSteps > 0
                                           ? std::max(options.refineSteps, leastCrispSteps)
                                           : options.refineSteps)),
      bare_(options.positionsOnly && options.surface == Surface::Cubes),
      crisp_(options.surface == Surface::Crisp ? std::make_unique<CrispBlock>(options.mergesCells) : nullptr) {
    if (crisp_) samples_.keepTapes();
    if (crisp_ && options.mergesCells) cells_.flat = std::make_unique<FlatCells>();
}

void BlockMesher::clear() {
    vertices_.positions.clear(), vertices_.normals.clear(), vertices_.origins.clear(), vertices_.labels.clear();
    bricks_.clear();
    owned_.bricks = owned_.alike = 0;
    for (auto& list : seams_.ghosts) list.clear();
    for (auto& list : seams_.shared) list.clear();
    vertices_.count = 0, cells_.count = 0, cells_.triangles = 0, vertices_.flat = false;
    cut_.waiting = 0;
}

bool BlockMesher::mesh(const Block& block, const Progress* progress, Chunk& chunk) {
    const Stopwatch sampling;
    clear();
    {
        const AddTime evaluating(fieldTime_);
        samples_.enter(block, grid_, workspace_, counts_);
    }
    for (uint64_t rest = samples_.active(); rest != 0; rest &= rest - 1) {
        if (cancelled(progress)) return false;
        const int brick = std::countr_zero(rest);
        addBrick(brick, sampled(brick), block);
    }
    if (cut_.waiting > 0) findWaiting(block.tape);
    counts_.sampleSeconds += sampling.seconds();

    const Stopwatch joining;
    chunk.block = block.index;
    copyTo(chunk.positions, vertices_.positions);
    if (!bare_) copyTo(chunk.normals, vertices_.normals);
    for (size_t i = 0; vertices_.flat && !bare_ && i < vertices_.normals.size(); ++i)
        if (vertices_.normals[i] == Vec3f{}) chunk.faceted.push_back(static_cast<uint32_t>(i));
    listSeams(chunk);
    writeTriangles(chunk);
    if (crisp_) splitAtCreases(block, chunk);
    counts_.polygonizeSeconds += joining.seconds();
    return true;
}

/// Who owns all that a tape can show; nothing where it depends on the place. Nobody asks in a bare mesh.
std::optional<OriginId> BlockMesher::onlyOwner(const eval::Tape& tape) const {
    if (bare_) return OriginId{0};
    const auto origins = tape.origins();
    if (origins[0] != 0 || origins.size() == 1) return origins[0];
    // The last instruction takes one of its operands.
    const eval::Instruction& last = tape.code().back();
    if (last.out != tape.result() || last.origins == 0) return {};
    const auto operands = origins.subspan(last.origins - 1, last.count);
    const bool same = std::all_of(operands.begin(), operands.end(), [&](OriginId o) { return o == operands[0]; });
    return same && operands[0] != 0 ? std::optional(operands[0]) : std::nullopt;
}

/// Samples the brick; returns its tape.
const eval::Tape& BlockMesher::sampled(int brick) {
    const AddTime evaluating(fieldTime_);
    return samples_.sample(brick, workspace_, counts_);
}

/// Adds the brick's cells with surface, those in the part; returns whether there are any in or out of it.
bool BlockMesher::addCells(const BrickSigns& signs, Vec3i brick, const PartOfBlock* part) {
    SurfaceCell* const cells = cells_.list.data() + cells_.count;
    const size_t found = brickLoops().cells(signs.low.data(), signs.high.data(), brickCorner(brick), blockCorners,
                                            blockCorners * blockCorners, cells);
    const size_t count = part ? keepPart(*part, brick, {cells, found}) : found;
    const uint8_t* const triangles = triangleCounts().data();
    for (size_t c = 0; c < count; ++c) cells_.triangles += triangles[cells[c].inside];
    cells_.count += count;
    counts_.surfaceCells += count;
    return found > 0;
}

/// The brick's own edges that the surface cuts, one after the other as their vertices are numbered from vertices_.count
/// on.
void BlockMesher::addOwnEdges(const BrickSigns& signs) {
    if (cut_.waiting == 0) cut_.edges.reserve(enoughEdges + 3 * brickRows * brickCorners);
    cut_.edges.size = cut_.own = brickLoops().ownEdges(signs.low.data(), signs.high.data(), cut_.edges.list.data());
}

/// Lists cut edges on low sides of the block: lower blocks own them. Their places are looked for only where that tells
/// their origin.
void BlockMesher::addGhosts(const BrickSigns& signs, Vec3i brick, std::optional<OriginId> owner) {
    const int sides = lowSidesOf(brick);
    cut_.borrowed.clear();
    for (int axis = 0; axis < 3; ++axis) {
        if ((sides & ~(1 << axis)) == 0) continue;
        forEachBit(cutsOnLowSides(signs, axis, sides), [&](int row, int i) {
            const Vec3i inBrick{i, rowJ(row), rowK(row)}, at = brick * brickCells + inBrick;
            const int edge = edgePlace(cornerNumber(at.x, at.y, at.z), axis), kind = sidesAt(0, at, axis) - 1;
            if (!owner) {
                cut_.borrowed.emplace_back(kind, seams_.ghosts[kind].size());
                cut_.edges.list[cut_.edges.size++] = codeAt(inBrick, axis);
            }
            seams_.ghosts[kind].push_back({static_cast<uint32_t>(edge), owner.value_or(0), {}});
        });
    }
    uint32_t* const codes = cut_.edges.list.data();
    std::fill(codes + cut_.edges.size, codes + wholeVectors(cut_.edges.size), 0u);
}

/// Looks up where the listed edges begin and end, behind those that wait, and numbers the brick's own.
void BlockMesher::placeEdges(Vec3i brick) {
    const Vec3i first = brick * brickCells;
    const BrickValues values = samples_.values(brickNumber(brick));
    const EdgeEnds ends{
        {samples_.coordinates(0) + first.x, samples_.coordinates(1) + first.y, samples_.coordinates(2) + first.z},
        values.corner,
        {1, values.row, values.layer},
        {1, blockCorners, blockCorners * blockCorners}};
    uint32_t* const places = cut_.edges.list.data();
    edgeLoops().place(ends, places, cut_.edges.size, from(cut_.edges.arrays, cut_.waiting), places);
    uint32_t* const number = vertices_.number.data() + edgePlace(brickCorner(brick), 0);
    for (size_t e = 0; e < cut_.own; ++e) number[places[e]] = static_cast<uint32_t>(vertices_.count + e);
    vertices_.count += static_cast<uint32_t>(cut_.own);
    if (!bare_) vertices_.origins.resize(vertices_.count);
}

/// Lists own vertices on high sides of the block for every block that meets this one there.
void BlockMesher::addShared(const BrickSigns& signs, Vec3i brick) {
    const int sides = highSidesOf(brick);
    for (int axis = 0; axis < 3; ++axis) {
        if ((sides & ~(1 << axis)) == 0) continue;
        forEachBit(cutsOnHighSides(signs, axis, sides), [&](int row, int i) {
            const Vec3i at = brick * brickCells + Vec3i{i, rowJ(row), rowK(row)};
            const uint32_t vertex = vertices_.number[edgePlace(cornerNumber(at.x, at.y, at.z), axis)];
            const int on = sidesAt(blockCells, at, axis);
            for (int kind = on; kind > 0; kind = (kind - 1) & on) seams_.shared[kind - 1].push_back(vertex);
        });
    }
}

/// Finds where the vertices on all edges lie, of which the first `own` are the next ones of the block.
void BlockMesher::findPlaces(const eval::Tape& tape, size_t own) {
    // Blocks around an edge have to agree on crisp vertices, so which search is taken can't hang on a block's tape.
    const bool expensive = !crisp_ && samples_.isExpensive() && isExpensive(tape);
    const VertexSearch search{refineSteps_, expensive, !bare_, crisp_ != nullptr, fieldTime_};
    counts_.refinementEvaluations += findVertices(tape, search, workspace_, cut_.open, cut_.edges);
    vertices_.flat = vertices_.flat || (cut_.edges.size > 0 && cut_.edges.flat > 0);
    const size_t first = vertices_.positions.size();
    vertices_.positions.resize(first + own);
    if (own == 0) return;
    const EdgeArrays& e = cut_.edges.arrays;
    edgeLoops().interleave(e.x, e.y, e.z, own, &vertices_.positions[first].x);
    if (bare_) return;
    vertices_.normals.resize(first + own);
    edgeLoops().interleave(e.dx, e.dy, e.dz, own, &vertices_.normals[first].x);
}

/// Finds the vertices that wait.
void BlockMesher::findWaiting(const eval::Tape& tape) {
    cut_.edges.size = cut_.waiting;
    findPlaces(tape, cut_.waiting);
    cut_.waiting = 0;
}

/// Asks whose surface each vertex lies on, the latest own ones and ghosts. Returns the owner of all of
/// them, where that is one.
std::optional<OriginId> BlockMesher::findOrigins(const eval::Tape& tape) {
    const size_t n = cut_.edges.size;
    if (n == 0) return {};
    found_.origins.resize(n);
    {
        const AddTime evaluating(fieldTime_);
        eval::evaluateOrigin(tape, {cut_.edges.arrays.x, cut_.edges.arrays.y, cut_.edges.arrays.z, n, true},
                             found_.origins.data(), workspace_);
    }
    std::copy_n(found_.origins.data(), cut_.own, vertices_.origins.data() + vertices_.origins.size() - cut_.own);
    for (size_t e = cut_.own; e < n; ++e) {
        const auto [kind, place] = cut_.borrowed[e - cut_.own];
        seams_.ghosts[static_cast<size_t>(kind)][place].origin = found_.origins[e];
    }
    OriginId others = 0;
    for (size_t e = 1; e < n; ++e) others |= found_.origins[e] ^ found_.origins[0];
    return others == 0 ? std::optional(found_.origins[0]) : std::nullopt;
}

/// `owner`, which all edges of the brick have, where those on its low sides that lower bricks own have it too.
std::optional<OriginId> BlockMesher::ownerAround(Vec3i brick, OriginId owner) const {
    for (int offset = 1; offset < 8; ++offset) {
        const Vec3i other = brick - Vec3i{offset & 1, offset >> 1 & 1, offset >> 2};
        if (minComponent(other) < 0) continue;
        const int number = brickNumber(other);
        if (!(owned_.bricks >> number & 1)) continue;
        if (!(owned_.alike >> number & 1) || owned_.owner[static_cast<size_t>(number)] != owner) return {};
    }
    return owner;
}

void BlockMesher::addBrick(int number, const eval::Tape& tape, const Block& block) {
    const Vec3i brick = brickAt(number);
    const BrickSigns signs(samples_.values(number));
    if (!addCells(signs, brick, block.part.get())) return;
    if (crisp_) return addCrispBrick(brick, signs, tape);
    std::optional<OriginId> owner = onlyOwner(tape);
    const bool mayWait = owner && leavesNothingOut(tape, block.tape);
    if (!mayWait && cut_.waiting > 0) findWaiting(block.tape);
    addOwnEdges(signs);
    if (lowSidesOf(brick) != 0) addGhosts(signs, brick, owner);
    placeEdges(brick);
    if (highSidesOf(brick) != 0) addShared(signs, brick);
    if (mayWait) {
        cut_.waiting += cut_.own;
        if (cut_.waiting >= enoughEdges) findWaiting(block.tape);
    } else {
        findPlaces(tape, cut_.own);
    }
    std::optional<OriginId> edgesOwner = owner;
    if (owner) {
        if (!bare_) std::fill_n(vertices_.origins.data() + vertices_.origins.size() - cut_.own, cut_.own, *owner);
    } else {
        edgesOwner = findOrigins(tape);
        if (edgesOwner) owner = ownerAround(brick, *edgesOwner);
    }
    bricks_.push_back({cells_.triangles, owner});
    owned_.bricks |= 1ull << number;
    owned_.alike |= uint64_t{edgesOwner.has_value()} << number;
    owned_.owner[static_cast<size_t>(number)] = edgesOwner.value_or(0);
}

/// Puts the lists of the seams one after the other, and numbers ghost edges by their place there.
void BlockMesher::listSeams(Chunk& chunk) {
    uint32_t ghosts = 0;
    for (int kind = 0; kind < seamKinds; ++kind) {
        chunk.ghosts.begin[kind] = ghosts;
        for (const GhostVertex& b : seams_.ghosts[kind]) {
            vertices_.number[b.edge] = ghostBit | ghosts++;
            if (!bare_) vertices_.origins.push_back(b.origin);
        }
        chunk.shared.begin[kind] = static_cast<uint32_t>(chunk.shared.vertices.size());
        chunk.shared.vertices.insert(chunk.shared.vertices.end(), seams_.shared[kind].begin(),
                                     seams_.shared[kind].end());
    }
    chunk.ghosts.vertices.resize(ghosts);
    chunk.ghosts.begin.back() = ghosts;
    chunk.shared.begin.back() = static_cast<uint32_t>(chunk.shared.vertices.size());
}

/// Joins vertices. A triangle takes the origin of most of its vertices, the lowest where all three differ.
void BlockMesher::writeTriangles(Chunk& chunk) const {
    chunk.triangles.resize(cells_.triangles);
    if (cells_.triangles == 0) return;
    brickLoops().join(cells_.list.data(), cells_.count, vertices_.number.data(), blockCorners,
                      blockCorners * blockCorners, placedCases().data(), &chunk.triangles[0].x);
    if (bare_) return;
    chunk.origins.resize(cells_.triangles);
    if (crisp_) {
        brickLoops().owners(&chunk.triangles[0].x, cells_.triangles, vertices_.origins.data(), vertices_.count,
                            chunk.origins.data());
        return;
    }
    OriginId* const origin = chunk.origins.data();
    size_t first = 0;
    for (const Brick& brick : bricks_) {
        const size_t count = brick.trianglesEnd - first;
        if (brick.owner)
            std::fill_n(origin + first, count, *brick.owner);
        else
            brickLoops().owners(&chunk.triangles[first].x, count, vertices_.origins.data(), vertices_.count,
                                origin + first);
        first = brick.trianglesEnd;
    }
}

}  // namespace sgm::mesh
