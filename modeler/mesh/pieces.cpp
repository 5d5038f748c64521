#include "modeler/mesh/pieces.h"

#include <array>
#include <span>
#include <unordered_map>

#include "modeler/core/parallel.h"
#include "modeler/mesh/chunk.h"
#include "modeler/mesh/components.h"

namespace sgm::mesh {
namespace {

constexpr uint32_t none = SurfaceLabels::none;

/// A corner's place among a chunk's vertices, `own` of its own and then those it borrows.
constexpr uint32_t placeOf(uint32_t corner, uint32_t own) {
    return corner + ((0u - (corner >> 31)) & (own + borrowedBit));  // without a branch that would be guessed wrong
}
constexpr Triangle placesOf(Triangle t, uint32_t own) {
    return {placeOf(t.x, own), placeOf(t.y, own), placeOf(t.z, own)};
}

uint32_t ownCount(const Chunk& c) { return static_cast<uint32_t>(c.positions.size()); }
size_t placeCount(const Chunk& c) { return c.positions.size() + c.borrowed.vertices.size(); }

/// Finds the chunks that own vertices; those that a chunk borrows come in long runs of one owner.
class Owners {
public:
    explicit Owners(std::span<const Chunk> chunks) : chunks_(chunks) {}
    /// The number of the chunk that owns a vertex counted in the whole mesh.
    size_t of(uint32_t vertex) {
        if (vertex < begin_ || vertex >= end_) {
            const Chunk& owner = ownerOf(chunks_, vertex);
            at_ = static_cast<size_t>(&owner - chunks_.data());
            begin_ = owner.firstVertex, end_ = begin_ + ownCount(owner);
        }
        return at_;
    }

private:
    const std::span<const Chunk> chunks_;
    size_t at_ = 0;
    uint32_t begin_ = 0, end_ = 0;
};

using Tally = std::unordered_map<OriginId, uint64_t>;

std::vector<OriginId> byCount(const Tally& tally) {
    std::vector<OriginId> origins;
    for (const auto& entry : tally) origins.push_back(entry.first);
    std::sort(origins.begin(), origins.end(), [&](OriginId a, OriginId b) {
        const uint64_t m = tally.at(a), n = tally.at(b);
        return m != n ? m > n : a < b;
    });
    return origins;
}

void judgeSupport(std::vector<Piece>& pieces, float slack_m) {
    if (pieces.empty()) return;
    float ground = pieces[0].bounds.lo.y;
    for (const Piece& p : pieces) ground = std::min(ground, p.bounds.lo.y);
    for (Piece& p : pieces) p.floats = p.bounds.lo.y > ground + slack_m;
    std::max_element(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) {
        return a.volume_m3 < b.volume_m3;
    })->floats = false;
}

/// What triangles of one part add up to.
struct Sum {
    uint64_t triangles = 0;
    double sixfold_m3 = 0;
    Box3d bounds;  ///< as seen from the mesh's first vertex
};

/// The same of the triangles that were given one label.
struct LabelSum {
    uint64_t triangles = 0;
    double sixfold_m3 = 0;
};

/// What hangs together among a chunk's triangles.
struct Parts {
    uint32_t first = 0;     ///< number of the first one in the mesh
    std::vector<Sum> sums;  ///< of each, in the order of their first triangles
    /// By place: the number of the vertex's part in the mesh, or none; empty where all are on the only one.
    PageVector<uint32_t> of;

    uint32_t at(size_t place) const { return of.empty() ? first : of[place]; }
};

/// Every connected surface, those around air too.
struct Surfaces {
    std::vector<Piece> pieces;      ///< without their owners
    std::vector<Parts> parts;       ///< by chunk
    std::vector<uint32_t> pieceOf;  ///< by part
};

/// What a worker needs to find the parts of chunks, seen from `near`, so that sums stay small; aligned as BlockMesher.
class alignas(128) PartFinder {
public:
    PartFinder(const Mesh& mesh, Vec3d near) : chunks_(mesh.chunks), owners_(mesh.chunks), near_(near) {}

    /// The chunk's parts, counted from 0.
    Parts find(const Chunk& c) {
        look(c);
        label(c);
        SurfaceLabels labels = labels_.found();
        Parts parts;
        parts.sums.resize(labels.count);
        for (size_t label = 0; label < sums_.size(); ++label) {
            Sum& sum = parts.sums[labels.numbers[label]];
            sum.triangles += sums_[label].triangles;
            sum.sixfold_m3 += sums_[label].sixfold_m3;
        }
        if (labels.count == 1 && std::find(labels.of.begin(), labels.of.end(), none) == labels.of.end()) {
            Box3d box;
            for (const Vec3d& p : at_) box = hull(box, p);
            parts.sums[0].bounds = box;
            return parts;
        }
        parts.of = std::move(labels.of);
        for (size_t v = 0; v < at_.size();) {  // neighbours lie on one part mostly
            const uint32_t part = parts.of[v];
            Box3d box;
            for (; v < at_.size() && parts.of[v] == part; ++v) box = hull(box, at_[v]);
            if (part != none) parts.sums[part].bounds = hull(parts.sums[part].bounds, box);
        }
        return parts;
    }

private:
    /// Labels the chunk's triangles, and adds up those of each label.
    void label(const Chunk& c) {
        const uint32_t own = ownCount(c);
        labels_.begin(at_.size());
        sums_.clear();
        std::array<Triangle, 256> some;  // their places come by vectors, and stay in the first cache
        for (size_t first = 0; first < c.triangles.size(); first += some.size()) {
            const size_t count = std::min(some.size(), c.triangles.size() - first);
            const uint32_t* const corners = &c.triangles[first].x;
            for (size_t i = 0; i < 3 * count; ++i) (&some[0].x)[i] = placeOf(corners[i], own);
            labelSome({some.data(), count});
        }
    }
    /// The same for triangles whose corners are places.
    void labelSome(std::span<const Triangle> triangles) {
        const Vec3d* const at = at_.data();
        size_t labels = sums_.size();
        LabelSum* sums = sums_.data();
        for (const Triangle& t : triangles) {
            const uint32_t label = labels_.label(t);
            if (label == labels) [[unlikely]] {
                sums_.emplace_back();
                sums = sums_.data(), ++labels;
            }
            // The solid under a triangle along x, by the divergence theorem.
            const Vec3d &p = at[t.x], &q = at[t.y], &r = at[t.z];
            LabelSum& sum = sums[label];
            sum.sixfold_m3 += (p.x + q.x + r.x) * ((q.y - p.y) * (r.z - p.z) - (q.z - p.z) * (r.y - p.y));
            ++sum.triangles;
        }
    }
    /// Where the chunk's vertices are, by place.
    void look(const Chunk& c) {
        at_.resize(placeCount(c));
        const Vec3d near = near_;
        Vec3d* at = at_.data();
        for (const Vec3f& p : c.positions) *at++ = p.as<double>() - near;
        for (const uint32_t v : c.borrowed.vertices) {
            const Chunk& owner = chunks_[owners_.of(v)];
            *at++ = owner.positions[v - owner.firstVertex].as<double>() - near;
        }
    }

    const std::span<const Chunk> chunks_;
    Owners owners_;
    const Vec3d near_;
    PageVector<Vec3d> at_;
    Labeller labels_;
    std::vector<LabelSum> sums_;
};

/// Numbers the parts of the chunks in the mesh and joins those that meet at borrowed vertices.
Components joinedParts(const Mesh& mesh, std::vector<Parts>& parts) {
    uint32_t count = 0;
    for (Parts& p : parts) {
        p.first = count;
        count += static_cast<uint32_t>(p.sums.size());
        for (uint32_t& part : p.of) part += part != none ? p.first : 0;
    }
    Components joined(count);
    Owners owners(mesh.chunks);
    for (size_t c = 0; c < parts.size(); ++c) {
        const Chunk& chunk = mesh.chunks[c];
        uint32_t lastOurs = none, lastTheirs = none;
        for (size_t i = 0; i < chunk.borrowed.vertices.size(); ++i) {
            const uint32_t v = chunk.borrowed.vertices[i];
            const size_t owner = owners.of(v);
            const uint32_t ours = parts[c].at(chunk.positions.size() + i);
            const size_t place = v - mesh.chunks[owner].firstVertex;
            const uint32_t theirs = parts[owner].at(place);
            if (ours == none || (ours == lastOurs && theirs == lastTheirs)) continue;
            if (theirs == none) {
                parts[owner].of[place] = ours;  // none of its own chunk's triangles uses it
                continue;
            }
            joined.join(ours, theirs);
            lastOurs = ours, lastTheirs = theirs;
        }
    }
    return joined;
}

Surfaces surfacesOf(const Mesh& mesh, int threads) {
    Surfaces found;
    found.parts.resize(mesh.chunks.size());
    Vec3d near{};
    for (const Chunk& c : mesh.chunks) {
        if (c.positions.empty()) continue;
        near = c.positions.front().as<double>();
        break;
    }
    std::vector<PartFinder> workers(static_cast<size_t>(threadCount(threads)), PartFinder(mesh, near));
    parallelFor(mesh.chunks.size(), threads, nullptr, [&](size_t c, int worker) {
        found.parts[c] = workers[static_cast<size_t>(worker)].find(mesh.chunks[c]);
    });
    Components joined = joinedParts(mesh, found.parts);
    found.pieceOf.resize(joined.size());
    uint32_t part = 0;
    for (const Parts& parts : found.parts)
        for (const Sum& sum : parts.sums) {
            const uint32_t lowest = joined.find(part);
            uint32_t& number = found.pieceOf[part];
            if (lowest == part) {
                number = static_cast<uint32_t>(found.pieces.size());
                found.pieces.emplace_back();
            } else {
                number = found.pieceOf[lowest];
            }
            Piece& piece = found.pieces[number];
            piece.triangles += sum.triangles;
            piece.volume_m3 += sum.sixfold_m3 / 6;
            piece.bounds = hull(piece.bounds, {(near + sum.bounds.lo).as<float>(), (near + sum.bounds.hi).as<float>()});
            ++part;
        }
    return found;
}

/// Who owns each surface, most triangles first.
void findOwners(const Mesh& mesh, Surfaces& surfaces) {
    std::vector<Tally> tallies(surfaces.pieces.size());
    for (size_t c = 0; c < mesh.chunks.size(); ++c) {
        const Chunk& chunk = mesh.chunks[c];
        for (size_t i = 0; i < chunk.triangles.size(); ++i) {
            const uint32_t part = surfaces.parts[c].at(placeOf(chunk.triangles[i].x, ownCount(chunk)));
            ++tallies[surfaces.pieceOf[part]][i < chunk.origins.size() ? chunk.origins[i] : 0];
        }
    }
    for (size_t i = 0; i < tallies.size(); ++i) surfaces.pieces[i].origins = byCount(tallies[i]);
}

/// Leaves the entries i for which stays(i) says so, `left` of them.
template <class T, class Stays>
void compact(PageVector<T>& list, size_t left, Stays stays) {
    T* const entries = list.data();
    for (size_t i = 0, n = 0; i < list.size(); ++i) {
        entries[n] = entries[i];
        n += stays(i);
    }
    list.resize(left);
}

/// Keeps the entries that stay, under the numbers that renamed(entry) gives them, none where they don't.
template <class Renamed>
void renumber(SeamList& list, Renamed renamed) {
    uint32_t n = 0;
    for (size_t kind = 0; kind < seamKinds; ++kind) {
        const uint32_t from = list.begin[kind], to = list.begin[kind + 1];
        list.begin[kind] = n;
        for (uint32_t i = from; i < to; ++i)
            if (const uint32_t vertex = renamed(i); vertex != none) list.vertices[n++] = vertex;
    }
    list.begin[seamKinds] = n;
    list.vertices.resize(n);
}

/// Drops surfaces that don't stay, chunk by chunk, with vertices that have no triangle.
class Dropper {
public:
    Dropper(Mesh& mesh, const Surfaces& surfaces, const std::vector<bool>& pieceStays)
        : mesh_(mesh), surfaces_(surfaces), owners_(mesh.chunks), partStays_(surfaces.pieceOf.size()) {
        for (size_t part = 0; part < partStays_.size(); ++part) partStays_[part] = pieceStays[surfaces.pieceOf[part]];
    }

    /// Drops what is gone of chunk c. What is left of the borders keeps its order in both chunks; what it borrows is to
    /// be named, and all chunks are to be numbered.
    void drop(size_t c) {
        if (allStays(surfaces_.parts[c])) return;
        const uint32_t left = findCorners(c);
        Chunk& chunk = mesh_.chunks[c];
        const uint32_t own = ownCount(chunk);
        const uint32_t* const corner = corner_.data();
        dropTriangles(chunk);
        const auto stays = [&](size_t v) { return corner[v] != none; };
        if (!chunk.normals.empty()) compact(chunk.normals, left, stays);
        compact(chunk.positions, left, stays);
        renumber(chunk.lent, [&](uint32_t i) { return corner[chunk.lent.vertices[i]]; });
        renumber(chunk.borrowed, [&](uint32_t i) { return corner[own + i]; });
        std::erase_if(chunk.faceted, [&](uint32_t v) { return !stays(v); });
        for (uint32_t& v : chunk.faceted) v = corner[v];
        std::erase_if(chunk.confined, [&](const ConfinedVertex& v) { return !stays(v.vertex); });
        for (ConfinedVertex& v : chunk.confined) v.vertex = corner[v.vertex];
    }

private:
    bool stays(uint32_t part) const { return part != none && partStays_[part] != 0; }
    bool allStays(const Parts& parts) const {
        const auto first = partStays_.begin() + parts.first;
        return std::all_of(first, first + static_cast<ptrdiff_t>(parts.sums.size()),
                           [](uint8_t stays) { return stays != 0; }) &&
               std::find(parts.of.begin(), parts.of.end(), none) == parts.of.end();
    }
    /// What becomes of the corners of chunk c, by place; returns how many vertices of its own are left.
    uint32_t findCorners(size_t c) {
        const Chunk& chunk = mesh_.chunks[c];
        const Parts& parts = surfaces_.parts[c];
        const uint32_t own = ownCount(chunk);
        corner_.resize(placeCount(chunk));
        uint32_t next = 0, borrowed = borrowedBit;
        for (uint32_t v = 0; v < own; ++v) {
            const bool left = stays(parts.at(v));
            corner_[v] = left ? next : none;
            next += left;
        }
        for (size_t i = 0; i < chunk.borrowed.vertices.size(); ++i) {
            const bool left = stays(partOfBorrowed(c, i));
            corner_[own + i] = left ? borrowed : none;
            borrowed += left;
        }
        return next;
    }
    /// The part of a borrowed vertex: its owner's, where no triangle of the chunk uses it.
    uint32_t partOfBorrowed(size_t c, size_t i) {
        const Chunk& chunk = mesh_.chunks[c];
        const uint32_t part = surfaces_.parts[c].at(chunk.positions.size() + i), vertex = chunk.borrowed.vertices[i];
        if (part != none) return part;
        const size_t owner = owners_.of(vertex);
        return surfaces_.parts[owner].at(vertex - mesh_.chunks[owner].firstVertex);
    }
    void dropTriangles(Chunk& chunk) const {
        const uint32_t own = ownCount(chunk);
        const uint32_t* const corner = corner_.data();
        const bool hasOrigins = !chunk.origins.empty(), hasLabels = !chunk.labels.empty();
        const std::vector<CornerNormal>& hard = chunk.cornerNormals;
        size_t left = 0, leftHard = 0, h = 0;
        for (size_t i = 0; i < chunk.triangles.size(); ++i) {
            const Triangle t = placesOf(chunk.triangles[i], own);
            const bool stays = corner[t.x] != none;
            chunk.triangles[left] = {corner[t.x], corner[t.y], corner[t.z]};
            if (hasOrigins) chunk.origins[left] = chunk.origins[i];
            if (hasLabels) chunk.labels[left] = chunk.labels[i];
            for (; h < hard.size() && hard[h].corner / 3 == i; ++h)
                if (stays)
                    chunk.cornerNormals[leftHard++] = {static_cast<uint32_t>(3 * left) + hard[h].corner % 3,
                                                       hard[h].normal};
            left += stays;
        }
        chunk.triangles.resize(left);
        chunk.cornerNormals.resize(leftHard);
        if (hasOrigins) chunk.origins.resize(left);
        if (hasLabels) chunk.labels.resize(left);
    }

    Mesh& mesh_;
    const Surfaces& surfaces_;
    Owners owners_;
    std::vector<uint8_t> partStays_;
    PageVector<uint32_t> corner_;  ///< of the chunk at hand, by place: what a corner becomes, or none
};

/// Drops the surfaces that don't stay, with vertices that have no triangle; the borders between chunks follow.
void keepSurfaces(Mesh& mesh, const Surfaces& surfaces, const std::vector<bool>& pieceStays) {
    Dropper dropper(mesh, surfaces, pieceStays);
    for (size_t c = 0; c < mesh.chunks.size(); ++c) dropper.drop(c);
    [[maybe_unused]] const Status numbered = Numbering{}.add(mesh.chunks);
    assert(numbered);  // there are fewer than before
    for (Chunk& chunk : mesh.chunks) nameBorrowed(mesh.chunks, chunk);
    std::erase_if(mesh.chunks, [](const Chunk& c) { return c.positions.empty() && c.triangles.empty(); });
}

}  // namespace

std::vector<Piece> pieces(const Mesh& mesh, float slack_m, int threads) {
    Surfaces surfaces = surfacesOf(mesh, threads);
    findOwners(mesh, surfaces);
    std::vector<Piece> found = std::move(surfaces.pieces);
    std::erase_if(found, [](const Piece& p) { return p.volume_m3 <= 0; });
    judgeSupport(found, slack_m);
    return found;
}

std::vector<bool> staying(std::vector<Piece> solids, Keep keep, float slack_m) {
    std::vector<bool> stays(solids.size(), keep == Keep::All);
    if (keep == Keep::All || solids.empty()) return stays;
    judgeSupport(solids, slack_m);
    const auto less = [](const Piece& a, const Piece& b) { return a.volume_m3 < b.volume_m3; };
    const auto greatest = std::max_element(solids.begin(), solids.end(), less);
    for (size_t i = 0; i < solids.size(); ++i)
        stays[i] = keep == Keep::Grounded && !solids[i].floats && solids[i].volume_m3 >= 1e-3 * greatest->volume_m3;
    stays[static_cast<size_t>(greatest - solids.begin())] = true;
    return stays;
}

Dropped keepOnly(Mesh& mesh, Keep keep, float slack_m, int threads) {
    Dropped dropped;
    if (keep == Keep::All || mesh.triangleCount() == 0) return dropped;
    const Surfaces surfaces = surfacesOf(mesh, threads);
    std::vector<Piece> solids;
    std::vector<size_t> solidOf(surfaces.pieces.size(), surfaces.pieces.size());
    for (size_t i = 0; i < surfaces.pieces.size(); ++i)
        if (surfaces.pieces[i].volume_m3 > 0) {
            solidOf[i] = solids.size();
            solids.push_back(surfaces.pieces[i]);
        }
    const std::vector<bool> solidStays = staying(solids, keep, slack_m);
    std::vector<bool> pieceStays(surfaces.pieces.size(), false);
    for (size_t i = 0; i < surfaces.pieces.size(); ++i) {
        if (solidOf[i] == surfaces.pieces.size()) {
            ++dropped.cavities;
            dropped.filled_m3 -= surfaces.pieces[i].volume_m3;
        } else if (solidStays[solidOf[i]]) {
            pieceStays[i] = true;
        } else {
            ++dropped.pieces;
            dropped.volume_m3 += surfaces.pieces[i].volume_m3;
        }
    }
    if (dropped.pieces + dropped.cavities > 0) keepSurfaces(mesh, surfaces, pieceStays);
    return dropped;
}

}  // namespace sgm::mesh
