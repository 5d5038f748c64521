#include "modeler/tiles/surface.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "modeler/tiles/level_regions.h"
#include "modeler/tiles/textures.h"

namespace sgm::tiles {
namespace {

constexpr uint32_t none = 0xffffffffu;

/// Numbers for keys in the order in which they come: a hash table without a node a key.
class KeyTable {
public:
    explicit KeyTable(size_t expected) {
        size_t size = 64;
        while (size < 2 * expected) size *= 2;
        slots_.assign(size, {0, none});
    }
    /// The key's number; `fresh` tells whether it is new.
    uint32_t take(uint64_t key, bool& fresh) {
        if (2 * (count_ + 1) > slots_.size()) grow();
        Slot& slot = find(key);
        fresh = slot.number == none;
        if (fresh) slot = {key, count_++};
        return slot.number;
    }

private:
    struct Slot {
        uint64_t key;
        uint32_t number;
    };
    Slot& find(uint64_t key) {
        const size_t mask = slots_.size() - 1;
        size_t at = (key * 0x9e3779b97f4a7c15ull) >> 20 & mask;
        while (slots_[at].number != none && slots_[at].key != key) at = (at + 1) & mask;
        return slots_[at];
    }
    void grow() {
        std::vector<Slot> old(2 * slots_.size(), {0, none});
        old.swap(slots_);
        for (const Slot& slot : old)
            if (slot.number != none) find(slot.key) = slot;
    }

    std::vector<Slot> slots_;
    uint32_t count_ = 0;
};

/// A direction in 24 bits: those that round to the same one make no edge that is seen.
uint32_t codeOf(Vec3f n) {
    const auto byte = [](float v) {
        return static_cast<uint32_t>(static_cast<int>(std::lround(v * 127)) + 128) & 0xffu;
    };
    return byte(n.x) | byte(n.y) << 8 | byte(n.z) << 16;
}

/// A piece as it grows: vertices of equal number and direction are one.
class PieceBuilder {
public:
    PieceBuilder(uint32_t material, size_t triangles) : known_(triangles) {
        piece.material = material;
        piece.indices.reserve(3 * triangles);
    }
    /// What comes lies in a chart of a texture, and shares no vertices with what came.
    void enter(const TextureChart& chart, const image::Texture& texture, size_t triangles) {
        chart_ = &chart, hasRelief_ = texture.normals != nullptr;
        known_ = KeyTable(triangles);
        first_ = static_cast<uint32_t>(piece.positions.size());
    }
    void add(uint32_t vertex, Vec3f position, Vec3f normal) {
        bool fresh = false;
        const uint32_t number = first_ + known_.take(static_cast<uint64_t>(vertex) << 24 | codeOf(normal), fresh);
        if (fresh) {
            piece.positions.push_back(position);
            piece.normals.push_back(normal);
            if (chart_) piece.uvs.push_back(chart_->at(position));
            if (chart_ && hasRelief_) piece.tangents.push_back(chart_->tangentAt(normal));
        }
        piece.indices.push_back(number);
    }

    SurfacePiece piece;

private:
    KeyTable known_;
    const TextureChart* chart_ = nullptr;
    bool hasRelief_ = false;
    uint32_t first_ = 0;  ///< of the chart's vertices
};

const Part& partOf(const mesh::PackedMesh& mesh, const Provenance& provenance, size_t triangle) {
    const OriginId origin = mesh.origins[triangle];
    return provenance.parts[origin < provenance.parts.size() ? origin : 0];
}

uint32_t materialOf(const mesh::PackedMesh& mesh, const Provenance& provenance, size_t triangle) {
    return partOf(mesh, provenance, triangle).material;
}

/// The triangles' numbers, by material.
std::map<uint32_t, std::vector<uint32_t>> byMaterial(const mesh::PackedMesh& mesh, const Provenance& provenance) {
    std::map<uint32_t, std::vector<uint32_t>> lists;
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t) lists[materialOf(mesh, provenance, t)].push_back(t);
    return lists;
}

Vec3f unitOr(Vec3f v, Vec3f otherwise) { return length(v) > 0 ? normalized(v) : otherwise; }

constexpr double errorShare = .05;      // of a cell of the ground's grid, how far its simplification may move it
constexpr double levelShare = 0x1p-12;  // of such a cell, within which heights are level
constexpr double straightShare = .01;   // of such a cell, within which a border between level regions is straight
constexpr float nearly = .94f;          // cosine of the angle, 20°, between a triangle and what it may be shaded as

/// Every triangle with a normal of its own where its neighbours lie in other planes. Corners whose vertex has a normal
/// (by `normals`, where there are some) that is nearly the triangle's get that one, so that hills look smooth.
void addFaceted(PieceBuilder& builder, const std::vector<uint32_t>& indices, const std::vector<Vec3f>& positions,
                const std::vector<Vec3f>& normals = {}) {
    for (size_t t = 0; t + 2 < indices.size(); t += 3) {
        const Vec3f &a = positions[indices[t]], &b = positions[indices[t + 1]], &c = positions[indices[t + 2]];
        const Vec3f across = cross(b - a, c - a);
        // A triangle without area covers nothing, but holds a vertex of the border that a neighbour has, too.
        const Vec3f normal = unitOr(across, {0, 1, 0});
        for (size_t k = 0; k < 3; ++k) {
            const uint32_t vertex = indices[t + k];
            const bool smooth = !normals.empty() && dot(normals[vertex], normal) > nearly;
            builder.add(vertex, positions[vertex], smooth ? normals[vertex] : normal);
        }
    }
}

/// Some triangles with the vertices that they use.
struct Extract {
    std::vector<uint32_t> indices;
    std::vector<Vec3f> positions, normals;
};

Extract extract(const std::vector<uint32_t>& corners, const std::vector<Vec3f>& positions,
                const std::vector<Vec3f>& normals) {
    Extract out;
    std::vector<uint32_t> number(positions.size(), none);
    out.indices.reserve(corners.size());
    for (const uint32_t vertex : corners) {
        if (number[vertex] == none) {
            number[vertex] = static_cast<uint32_t>(out.positions.size());
            out.positions.push_back(positions[vertex]);
            out.normals.push_back(normals[vertex]);
        }
        out.indices.push_back(number[vertex]);
    }
    return out;
}

/// `indices` with fewer triangles.
std::vector<uint32_t> simplified(const std::vector<uint32_t>& indices, const std::vector<Vec3f>& positions,
                                 double error_m, unsigned options) {
    std::vector<uint32_t> simple(indices.size());
    const float scale = meshopt_simplifyScale(&positions[0].x, positions.size(), sizeof(Vec3f));
    simple.resize(meshopt_simplify(simple.data(), indices.data(), indices.size(), &positions[0].x, positions.size(),
                                   sizeof(Vec3f), 0, scale > 0 ? static_cast<float>(error_m) / scale : 0, options,
                                   nullptr));
    return simple;
}

}  // namespace

std::vector<SurfacePiece> piecesOf(const mesh::PackedMesh& mesh, const Provenance& provenance) {
    std::vector<Vec3f> normals(3 * mesh.triangles.size());  // by corner
    for (size_t t = 0; t < mesh.triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) normals[3 * t + static_cast<size_t>(k)] = mesh.normals[mesh.triangles[t][k]];
    for (const mesh::CornerNormal& corner : mesh.cornerNormals) normals[corner.corner] = corner.normal;
    const auto add = [&](PieceBuilder& builder, const std::vector<uint32_t>& triangles) {
        for (const uint32_t t : triangles)
            for (int k = 0; k < 3; ++k) {
                const uint32_t vertex = mesh.triangles[t][k];
                builder.add(vertex, mesh.positions[vertex], normals[3 * size_t{t} + static_cast<size_t>(k)]);
            }
    };
    std::vector<SurfacePiece> pieces;
    TextureCharts charts;
    for (const auto& [material, triangles] : byMaterial(mesh, provenance)) {
        PieceBuilder builder(material, triangles.size());
        if (const auto& texture = provenance.materials[material].texture) {
            std::map<uint32_t, std::vector<uint32_t>> byChart;
            for (const uint32_t t : triangles) {
                const Vec3f normal = normals[3 * size_t{t}] + normals[3 * size_t{t} + 1] + normals[3 * size_t{t} + 2];
                byChart[charts.of(partOf(mesh, provenance, t), unitOr(normal, {0, 1, 0}))].push_back(t);
            }
            for (const auto& [chart, list] : byChart) {
                builder.enter(charts[chart], *texture, list.size());
                add(builder, list);
            }
        } else {
            add(builder, triangles);
        }
        pieces.push_back(std::move(builder.piece));
    }
    return pieces;
}

std::vector<SurfacePiece> coarsePiecesOf(const mesh::PackedMesh& mesh, const Provenance& provenance, double error_m) {
    // A vertex between materials is there once for each: the simplification takes such pairs for seams and moves both.
    KeyTable known(mesh.positions.size());
    std::vector<Vec3f> positions;
    std::vector<uint32_t> indices, materials;
    indices.reserve(3 * mesh.triangles.size());
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
        const uint32_t material = materialOf(mesh, provenance, t);
        for (int k = 0; k < 3; ++k) {
            const uint32_t vertex = mesh.triangles[t][k];
            bool fresh = false;
            indices.push_back(known.take(static_cast<uint64_t>(material) << 32 | vertex, fresh));
            if (fresh) {
                positions.push_back(mesh.positions[vertex]);
                materials.push_back(material);
            }
        }
    }
    if (indices.empty()) return {};
    std::map<uint32_t, std::vector<uint32_t>> lists;
    const std::vector<uint32_t> simple = simplified(indices, positions, error_m, 0);
    for (size_t t = 0; t + 2 < simple.size(); t += 3) {
        auto& list = lists[materials[simple[t]]];
        list.insert(list.end(), simple.begin() + static_cast<std::ptrdiff_t>(t),
                    simple.begin() + static_cast<std::ptrdiff_t>(t) + 3);
    }
    std::vector<SurfacePiece> pieces;
    for (const auto& [material, list] : lists) {
        PieceBuilder builder(material, list.size() / 3);
        addFaceted(builder, list, positions);
        pieces.push_back(std::move(builder.piece));
    }
    return pieces;
}

std::vector<SurfacePiece> groundPieces(const mesh::PackedMesh& mesh, const std::vector<uint32_t>& triangles,
                                       const Provenance& provenance, Vec3d centre, double pitch_m) {
    TextureCharts charts;
    using Look = std::pair<uint32_t, uint32_t>;  // material, chart
    std::map<Look, uint32_t> keyOf;
    std::vector<Look> looks;  // by key
    KeyedTriangles ground;
    std::vector<Vec3f> positions, normals;
    std::vector<uint32_t> local(mesh.positions.size(), none);
    for (const uint32_t t : triangles) {
        const mesh::Triangle& c = mesh.triangles[t];
        Look look{materialOf(mesh, provenance, t), 0};
        if (provenance.materials[look.first].texture) {
            // Those of vertices lean where planes meet.
            const Vec3f& a = mesh.positions[c.x];
            const Vec3f across = cross(mesh.positions[c.y] - a, mesh.positions[c.z] - a);
            look.second = charts.of(partOf(mesh, provenance, t), unitOr(across, unitOr(mesh.normals[c.x], {0, 1, 0})));
        }
        const auto [key, isNew] = keyOf.try_emplace(look, static_cast<uint32_t>(looks.size()));
        if (isNew) looks.push_back(look);
        mesh::Triangle own;
        for (int k = 0; k < 3; ++k) {
            uint32_t& number = local[c[k]];
            if (number == none) {
                number = static_cast<uint32_t>(positions.size());
                // Exact: positions and centre are multiples of a cell's share.
                positions.push_back((mesh.positions[c[k]].as<double>() - centre).as<float>());
                normals.push_back(mesh.normals[c[k]]);
            }
            own[k] = number;
        }
        ground.triangles.push_back(own);
        ground.keys.push_back(key->second);
    }
    ground = mergeLevelRegions(ground, positions, levelShare * pitch_m, straightShare * pitch_m);
    std::vector<std::vector<uint32_t>> corners(looks.size());  // by key, three a triangle
    for (size_t t = 0; t < ground.triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) corners[ground.keys[t]].push_back(ground.triangles[t][k]);
    std::vector<SurfacePiece> pieces;
    std::optional<PieceBuilder> builder;
    for (auto at = keyOf.begin(); at != keyOf.end(); ++at) {
        const auto& [look, key] = *at;
        const Extract part = extract(corners[key], positions, normals);
        if (!builder) builder.emplace(look.first, part.indices.size() / 6);
        TextureChart lies;
        if (const auto& texture = provenance.materials[look.first].texture) {
            lies = movedTo(charts[look.second], centre, *texture);
            builder->enter(lies, *texture, part.indices.size() / 3);
        }
        addFaceted(*builder, simplified(part.indices, part.positions, errorShare * pitch_m, meshopt_SimplifyLockBorder),
                   part.positions, part.normals);
        if (const auto next = std::next(at); next != keyOf.end() && next->first.first == look.first) continue;
        if (!builder->piece.indices.empty()) pieces.push_back(std::move(builder->piece));
        builder.reset();
    }
    return pieces;
}

Box3f boundsOf(const std::vector<SurfacePiece>& pieces) {
    Box3f box;
    for (const SurfacePiece& piece : pieces)
        for (const Vec3f& p : piece.positions) box = hull(box, p);
    return box;
}

uint64_t trianglesOf(const std::vector<SurfacePiece>& pieces) {
    uint64_t count = 0;
    for (const SurfacePiece& piece : pieces) count += piece.indices.size() / 3;
    return count;
}

}  // namespace sgm::tiles
