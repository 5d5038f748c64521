#include "modeler/mesh/one_chunk.h"

namespace sgm::mesh {
namespace {

template <class List>
void append(List& list, const List& more) {
    list.insert(list.end(), more.begin(), more.end());
}

}  // namespace

void appendVertices(Chunk& whole, const Chunk& c) {
    append(whole.positions, c.positions), append(whole.normals, c.normals);
    for (const ConfinedVertex& v : c.confined) whole.confined.push_back({c.firstVertex + v.vertex, v.place});
    for (const uint32_t v : c.faceted) whole.faceted.push_back(c.firstVertex + v);
}

void appendTriangles(Chunk& whole, const Chunk& c) {
    const auto first = static_cast<uint32_t>(whole.triangles.size());
    append(whole.origins, c.origins), append(whole.labels, c.labels);
    for (const Triangle& t : c.triangles) whole.triangles.push_back(c.inMesh(t));
    for (const CornerNormal& n : c.cornerNormals) whole.cornerNormals.push_back({3 * first + n.corner, n.normal});
}

Chunk joinChunks(const Mesh& mesh) {
    Chunk whole;
    const size_t vertices = mesh.vertexCount(), triangles = mesh.triangleCount();
    whole.positions.reserve(vertices), whole.normals.reserve(vertices);
    whole.triangles.reserve(triangles), whole.origins.reserve(triangles), whole.labels.reserve(triangles);
    for (const Chunk& c : mesh.chunks) appendVertices(whole, c), appendTriangles(whole, c);
    return whole;
}

void dropUnusedVertices(Chunk& chunk) {
    constexpr uint32_t none = 0xffffffffu;
    std::vector<uint32_t> number(chunk.positions.size(), none);
    for (const Triangle& t : chunk.triangles) number[t.x] = number[t.y] = number[t.z] = 0;
    uint32_t left = 0;
    for (uint32_t v = 0; v < number.size(); ++v) {
        if (number[v] == none) continue;
        chunk.positions[left] = chunk.positions[v], chunk.normals[left] = chunk.normals[v];
        number[v] = left++;
    }
    chunk.positions.resize(left), chunk.normals.resize(left);
    for (Triangle& t : chunk.triangles) t = {number[t.x], number[t.y], number[t.z]};
    std::erase_if(chunk.confined, [&](const ConfinedVertex& v) { return number[v.vertex] == none; });
    for (ConfinedVertex& v : chunk.confined) v.vertex = number[v.vertex];
    std::erase_if(chunk.faceted, [&](uint32_t v) { return number[v] == none; });
    for (uint32_t& v : chunk.faceted) v = number[v];
}

}  // namespace sgm::mesh
