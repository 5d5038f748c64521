// Small meshes with known figures, for tests of writers.
#pragma once

#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "modeler/core/conventions.h"
#include "modeler/core/provenance.h"
#include "modeler/mesh/mesh.h"
#include "tests/export/made_part.h"

namespace sgm::exporter {

/// Materials stone (parts 0, 1) and moss (part 2).
inline Provenance twoMaterials() {
    Provenance p;
    p.materials = {{"stone", {0.5f, 0.25f, 0.125f}, 0.8f, 0.0f, nullptr},
                   {"moss", {0.1f, 0.6f, 0.2f}, 0.9f, 0.1f, nullptr}};
    p.parts = {Part{}, madePart("Cave/A", {"A", "start", "a.sgm", 1}, 0),
               madePart("Cave/B", {"B", "grow", "a.sgm", 2}, 1)};
    return p;
}

/// An icosphere about `centre`, its triangles halved `levels` times: 20 · 4^levels triangles. The upper half is moss
/// (origin 2), the lower stone (origin 1). Triangles are dealt to `chunkCount` chunks, vertices follow their first use.
inline mesh::Mesh icosphere(Vec3f centre, float radius, int levels, size_t chunkCount) {
    const float g = (1 + std::sqrt(5.0f)) / 2;
    std::vector<Vec3f> unit = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                               {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    std::vector<mesh::Triangle> faces = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                         {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                         {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                         {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    for (Vec3f& v : unit) v = normalized(v);
    for (int level = 0; level < levels; ++level) {
        std::map<std::pair<uint32_t, uint32_t>, uint32_t> halves;
        const auto half = [&](uint32_t a, uint32_t b) {
            const auto [it, fresh] = halves.try_emplace(std::minmax(a, b), static_cast<uint32_t>(unit.size()));
            if (fresh) unit.push_back(normalized(unit[a] + unit[b]));
            return it->second;
        };
        std::vector<mesh::Triangle> finer;
        for (const auto [a, b, c] : faces) {
            const uint32_t ab = half(a, b), bc = half(b, c), ca = half(c, a);
            finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
        }
        faces = std::move(finer);
    }
    mesh::Mesh out;
    out.chunks.resize(chunkCount);
    std::vector<uint32_t> number(unit.size(), 0xffffffffu);
    uint32_t next = 0;
    for (size_t i = 0; i < chunkCount; ++i) {
        mesh::Chunk& chunk = out.chunks[i];
        chunk.block = {static_cast<int>(i), 0, 0};
        chunk.firstVertex = next;
        for (size_t f = faces.size() * i / chunkCount; f < faces.size() * (i + 1) / chunkCount; ++f) {
            float y = 0;
            for (int k = 0; k < 3; ++k) {
                const Vec3f n = unit[faces[f][k]];
                y += n.y;
                uint32_t& v = number[faces[f][k]];
                if (v == 0xffffffffu) {
                    v = next++;
                    chunk.positions.push_back(centre + n * radius);
                    chunk.normals.push_back(n);
                }
                if (v < chunk.firstVertex) chunk.ghosts.vertices.push_back(v);
                faces[f][k] = v < chunk.firstVertex
                                  ? mesh::ghostBit | static_cast<uint32_t>(chunk.ghosts.vertices.size() - 1)
                                  : v - chunk.firstVertex;
            }
            chunk.triangles.push_back(faces[f]);
            chunk.origins.push_back(y > 0 ? 2 : 1);
        }
    }
    return out;
}

/// Volume by the divergence theorem, of any triangle list.
template <class Position>
double enclosedVolume(const std::vector<mesh::Triangle>& triangles, Position position) {
    double six = 0;
    for (const mesh::Triangle& t : triangles) {
        const Vec3d a = position(t.x), b = position(t.y), c = position(t.z);
        six += dot(a, cross(b, c));
    }
    return six / 6;
}

}  // namespace sgm::exporter
