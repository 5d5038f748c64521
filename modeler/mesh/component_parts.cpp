#include "modeler/mesh/component_parts.h"

#include <algorithm>
#include <array>
#include <unordered_map>

#include "modeler/core/parallel.h"

namespace sgm::mesh::detail {
namespace {

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
        for (const uint32_t v : c.ghosts.vertices) {
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

/// Numbers the parts of the chunks in the mesh and joins those that meet at ghosts.
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
        for (size_t i = 0; i < chunk.ghosts.vertices.size(); ++i) {
            const uint32_t v = chunk.ghosts.vertices[i];
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

}  // namespace

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
            ConnectedComponent& piece = found.pieces[number];
            piece.triangles += sum.triangles;
            piece.volume_m3 += sum.sixfold_m3 / 6;
            piece.bounds = hull(piece.bounds, {(near + sum.bounds.lo).as<float>(), (near + sum.bounds.hi).as<float>()});
            ++part;
        }
    return found;
}

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

}  // namespace sgm::mesh::detail
