#include "modeler/mesh/chunk.h"

#include <algorithm>
#include <cstring>
#include <optional>

#include "modeler/core/stopwatch.h"
#include "modeler/mesh/marching_cubes.h"

namespace sgm::mesh {
namespace {

/// A borrowed vertex's slot: its place in the list of its kind of seam, and above that the kind.
constexpr int placeBits = 24;
constexpr uint32_t placeMask = (1u << placeBits) - 1;

/// Way from a corner's number to that of the next one along an axis.
constexpr std::array<int, 3> stride{1, blockCorners, blockCorners* blockCorners};

/// Place of the edge that runs along `axis` from a corner up: the edges of a cell lie close to each other.
constexpr int edgePlace(int corner, int axis) { return 3 * corner + axis; }

/// The cases with the places of a triangle's edges, counted from that of the cell's low corner.
struct PlacedCase {
    std::array<int16_t, 15> edges;
    uint16_t triangles;
};

const std::array<PlacedCase, 256>& placedCases() {
    static const auto table = [] {
        std::array<PlacedCase, 256> all{};
        for (size_t c = 0; c < all.size(); ++c) {
            const CellCase& cell = caseTable()[c];
            all[c].triangles = cell.triangles;
            for (int i = 0; i < 3 * cell.triangles; ++i) {
                const int e = cell.edges[i], low = edgeCorner(e);
                all[c].edges[i] =
                    static_cast<int16_t>(edgePlace(cornerNumber(low & 1, low >> 1 & 1, low >> 2), edgeAxis(e)));
            }
        }
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

OriginId majority(OriginId a, OriginId b, OriginId c) {
    if (a == b || a == c) return a;
    return b == c ? b : std::min({a, b, c});
}

/// Where a brick's rows begin, counted from its low corner.
struct RowPlace {
    uint16_t corner;
    uint8_t j, k;
};
constexpr auto rowPlaces = [] {
    std::array<RowPlace, brickRows> places{};
    for (int row = 0; row < brickRows; ++row)
        places[row] = {static_cast<uint16_t>(cornerNumber(0, rowJ(row), rowK(row))), static_cast<uint8_t>(rowJ(row)),
                       static_cast<uint8_t>(rowK(row))};
    return places;
}();

/// Whether a coordinate in the block lies on the low side (1), on the high side (8) or between (0): shifted by the axis
/// these make two masks of axes.
constexpr auto sideOf = [] {
    std::array<uint8_t, blockCorners> sides{};
    sides.front() = 1, sides.back() = 8;
    return sides;
}();

/// Who owns all that a tape can show; nothing where it depends on the place.
std::optional<OriginId> onlyOwner(const eval::Tape& tape) {
    const auto origins = tape.origins();
    if (origins[0] != 0 || origins.size() == 1) return origins[0];
    // The last instruction takes one of its operands.
    const eval::Instruction& last = tape.code().back();
    if (last.out != tape.result() || last.origins == 0) return {};
    const auto operands = origins.subspan(last.origins - 1, last.count);
    const bool same = std::all_of(operands.begin(), operands.end(), [&](OriginId o) { return o == operands[0]; });
    return same && operands[0] != 0 ? std::optional(operands[0]) : std::nullopt;
}

}  // namespace

void BlockMesher::clear() {
    positions_.clear(), normals_.clear(), origins_.clear(), borrowedOrigins_.clear();
    bricks_.clear();
    for (auto& list : borrowed_) list.clear();
    for (auto& list : lent_) list.clear();
    vertices_ = 0, cellCount_ = 0, triangles_ = 0, flat_ = false;
}

bool BlockMesher::mesh(const Block& block, const Progress* progress, Chunk& chunk) {
    const Stopwatch sampling;
    clear();
    samples_.enter(block, grid_, workspace_, counts_);
    for (uint64_t rest = samples_.active(); rest != 0; rest &= rest - 1) {
        if (cancelled(progress)) return false;
        const int brick = std::countr_zero(rest);
        addBrick(brick, samples_.sample(brick, workspace_, counts_));
    }
    counts_.sampleSeconds += sampling.seconds();

    const Stopwatch joining;
    chunk.block = block.index;
    copyTo(chunk.positions, positions_);
    copyTo(chunk.normals, normals_);
    for (size_t i = 0; flat_ && i < normals_.size(); ++i)
        if (normals_[i] == Vec3f{}) chunk.faceted.push_back(static_cast<uint32_t>(i));
    listSeams(chunk);
    writeTriangles(chunk);
    counts_.polygonizeSeconds += joining.seconds();
    return true;
}

/// Numbers a vertex on the block's border. On low sides (a mask of axes) a lower block owns it: its slot holds the kind
/// of seam and the place in that list. Else it is lent to every block that meets this one there.
uint32_t BlockMesher::borderVertex(int edge, int lowSides, int highSides, OriginId owner) {
    if (lowSides != 0) {
        std::vector<Borrowed>& list = borrowed_[lowSides - 1];
        list.push_back({static_cast<uint32_t>(edge), owner});
        return borrowedBit | static_cast<uint32_t>(lowSides - 1) << placeBits | static_cast<uint32_t>(list.size() - 1);
    }
    for (int kind = highSides; kind > 0; kind = (kind - 1) & highSides) lent_[kind - 1].push_back(vertices_);
    return vertices_++;
}

/// The brick's cut edges along one axis, numbered. Those that other blocks own are looked for only where their origin
/// is asked. `n` counts entries.
template <int axis>
void BlockMesher::addEdges(const BitRows& inside, Vec3i brick, std::optional<OriginId> owner, size_t& n) {
    const Vec3i first = brick * brickCells;
    const int lowSides = (brick.x == 0 ? 1 : 0) | (brick.y == 0 ? 2 : 0) | (brick.z == 0 ? 4 : 0);
    const int brickFirst = brickCorner(brick);
    const float* const values = samples_.values();
    const float *const xs = samples_.coordinates(0) + first.x, *const ys = samples_.coordinates(1) + first.y,
                       *const zs = samples_.coordinates(2) + first.z;
    const uint8_t *const xSides = sideOf.data() + first.x, *const ySides = sideOf.data() + first.y,
                         *const zSides = sideOf.data() + first.z;
    edges_.axisBegin[axis] = n;
    forEachBit(cutRows(inside, axis, lowSides), [&](int row, int i) {
        const RowPlace place = rowPlaces[row];
        const int corner = brickFirst + place.corner + i, edge = edgePlace(corner, axis);
        // An edge lies between the sides of its own axis.
        const int sides = (axis == 0 ? 0 : xSides[i]) | (axis == 1 ? 0 : ySides[place.j]) << 1 |
                          (axis == 2 ? 0 : zSides[place.k]) << 2;
        const int low = sides & 7;
        const uint32_t slot = sides != 0 ? borderVertex(edge, low, sides >> 3, owner.value_or(0)) : vertices_++;
        number_[edge] = slot;
        if (low != 0 && owner) return;
        const float* const along = axis == 0 ? xs + i : axis == 1 ? ys + place.j : zs + place.k;
        edges_.set(n++, {xs[i], ys[place.j], zs[place.k]}, along[0], along[1] - along[0], values[corner],
                   values[corner + stride[axis]], slot);
    });
}

void BlockMesher::addVertices(const eval::Tape& tape, std::optional<OriginId> owner) {
    counts_.refinementEvaluations += findVertices(tape, refineSteps_, workspace_, openEdges_, edges_);
    const size_t n = edges_.size();
    flat_ = flat_ || (n > 0 && edges_.flat > 0);
    found_.resize(n);
    if (owner)
        std::fill(found_.begin(), found_.end(), *owner);
    else
        eval::evaluateOrigin(tape, {edges_.x.data(), edges_.y.data(), edges_.z.data(), n}, found_.data(), workspace_);
    positions_.resize(vertices_), normals_.resize(vertices_), origins_.resize(vertices_);
    for (size_t i = 0; i < n; ++i) {
        const uint32_t slot = edges_.slot[i];
        if (slot & borrowedBit) {
            borrowed_[(slot & ~borrowedBit) >> placeBits][slot & placeMask].origin = found_[i];
            continue;
        }
        positions_[slot] = {edges_.x[i], edges_.y[i], edges_.z[i]};
        normals_[slot] = {edges_.dx[i], edges_.dy[i], edges_.dz[i]};
        origins_[slot] = found_[i];
    }
}

void BlockMesher::addBrick(int number, const eval::Tape& tape) {
    const Vec3i brick = brickAt(number);
    const int corner = brickCorner(brick);
    const BitRows inside = insideRows(samples_.values() + corner);
    const std::optional<OriginId> owner = onlyOwner(tape);
    const uint8_t* const triangles = triangleCounts().data();
    Cell* const firstCell = cells_.data() + cellCount_;
    Cell* cell = firstCell;
    size_t made = 0;
    forEachBit(surfaceRows(inside), [&](int row, int i) {
        const auto c = static_cast<uint8_t>(caseOf(inside, row, i));
        *cell++ = {static_cast<uint16_t>(corner + rowPlaces[row].corner + i), c};
        made += triangles[c];
    });
    const auto count = static_cast<size_t>(cell - firstCell);
    if (count == 0) return;
    counts_.surfaceCells += count;
    cellCount_ += count;
    triangles_ += made;
    bricks_.push_back({cellCount_, owner});
    size_t edges = 0;
    edges_.reserve(3 * brickRows * brickCorners);
    addEdges<0>(inside, brick, owner, edges);
    addEdges<1>(inside, brick, owner, edges);
    addEdges<2>(inside, brick, owner, edges);
    edges_.axisBegin[3] = edges;
    addVertices(tape, owner);
}

/// Puts the lists of the seams one after the other, and numbers borrowed edges by their place there.
void BlockMesher::listSeams(Chunk& chunk) {
    borrowedOrigins_.clear();
    for (int kind = 0; kind < seamKinds; ++kind) {
        chunk.borrowed.begin[kind] = static_cast<uint32_t>(borrowedOrigins_.size());
        for (const Borrowed& b : borrowed_[kind]) {
            number_[b.edge] = borrowedBit | static_cast<uint32_t>(borrowedOrigins_.size());
            borrowedOrigins_.push_back(b.origin);
        }
        chunk.lent.begin[kind] = static_cast<uint32_t>(chunk.lent.vertices.size());
        chunk.lent.vertices.insert(chunk.lent.vertices.end(), lent_[kind].begin(), lent_[kind].end());
    }
    chunk.borrowed.vertices.resize(borrowedOrigins_.size());
    chunk.borrowed.begin.back() = static_cast<uint32_t>(borrowedOrigins_.size());
    chunk.lent.begin.back() = static_cast<uint32_t>(chunk.lent.vertices.size());
}

/// Joins vertices cell by cell. A triangle takes the origin of most of its vertices, the lowest where all three differ.
void BlockMesher::writeTriangles(Chunk& chunk) const {
    chunk.triangles.resize(triangles_);
    chunk.origins.resize(triangles_);
    Triangle* triangle = chunk.triangles.data();
    OriginId* origin = chunk.origins.data();
    const uint32_t* const number = number_.data();
    const auto& cases = placedCases();
    const Cell* cell = cells_.data();
    for (const Brick& brick : bricks_) {
        const Triangle* const first = triangle;
        for (const Cell* const end = cells_.data() + brick.cellsEnd; cell != end; ++cell) {
            const PlacedCase& placed = cases[cell->inside];
            const uint32_t* const at = number + edgePlace(cell->corner, 0);
            for (const int16_t *e = placed.edges.data(), *last = e + 3 * placed.triangles; e != last; e += 3)
                *triangle++ = {at[e[0]], at[e[1]], at[e[2]]};
        }
        const auto count = static_cast<size_t>(triangle - first);
        if (brick.owner)
            std::fill_n(origin, count, *brick.owner);
        else
            std::transform(first, static_cast<const Triangle*>(triangle), origin, [this](const Triangle& t) {
                return majority(originOf(t.x), originOf(t.y), originOf(t.z));
            });
        origin += count;
    }
}

}  // namespace sgm::mesh
