#include "modeler/mesh/validate.h"

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>

#include "modeler/mesh/components.h"

namespace sgm::mesh {
namespace {

/// The mesh as flat arrays, its vertices perhaps welded.
struct Flat {
    std::vector<Vec3f> positions;
    std::vector<Triangle> triangles;
};

Flat flatten(const Mesh& mesh) {
    Flat flat;
    flat.positions.reserve(mesh.vertexCount());
    flat.triangles.reserve(mesh.triangleCount());
    for (const Chunk& c : mesh.chunks) {
        flat.positions.insert(flat.positions.end(), c.positions.begin(), c.positions.end());
        for (const Triangle& t : c.triangles) flat.triangles.push_back(c.inMesh(t));
    }
    return flat;
}

/// Sorts by key(item), an unsigned integer, byte by byte from the lowest: linear and stable.
template <class Item, class Key>
void radixSort(std::vector<Item>& items, Key key) {
    std::vector<Item> other(items.size());
    for (size_t byte = 0; byte < sizeof(key(items[0])); ++byte) {
        std::array<size_t, 257> start{};
        const auto bucket = [&](const Item& item) { return key(item) >> 8 * byte & 0xff; };
        for (const Item& item : items) ++start[bucket(item) + 1];
        if (std::find(start.begin(), start.end(), items.size()) != start.end()) continue;  // all bytes are equal
        std::partial_sum(start.begin(), start.end(), start.begin());
        for (const Item& item : items) other[start[bucket(item)]++] = item;
        items.swap(other);
    }
}

/// Maps vertices of equal position to the first of them; −0 equals 0.
std::vector<uint32_t> weldMap(const std::vector<Vec3f>& positions) {
    std::vector<uint32_t> order(positions.size()), map(positions.size());
    std::iota(order.begin(), order.end(), 0u);
    for (int axis = 0; axis < 3; ++axis)
        radixSort(order, [&](uint32_t v) { return std::bit_cast<uint32_t>(positions[v][axis] + 0.0f); });
    for (size_t i = 0; i < order.size(); ++i)
        map[order[i]] = i > 0 && positions[order[i]] == positions[order[i - 1]] ? map[order[i - 1]] : order[i];
    return map;
}

/// Edges of all triangles as (low vertex, high vertex) in one key, and whether the triangle runs upwards along it.
struct DirectedEdge {
    uint64_t key;
    bool upwards;
};

void countEdges(const Flat& flat, MeshFigures& figures, uint64_t& edges) {
    std::vector<DirectedEdge> all;
    all.reserve(flat.triangles.size() * 3);
    for (const Triangle& t : flat.triangles)
        for (int i = 0; i < 3; ++i) {
            const uint64_t a = t[i], b = t[(i + 1) % 3];
            all.push_back({std::min(a, b) << 32 | std::max(a, b), a < b});
        }
    radixSort(all, [](const DirectedEdge& e) { return e.key; });
    for (size_t i = 0, next; i < all.size(); i = next) {
        size_t upwards = 0;
        for (next = i; next < all.size() && all[next].key == all[i].key; ++next) upwards += all[next].upwards ? 1 : 0;
        const size_t count = next - i;
        ++edges;
        if (count == 1) ++figures.boundaryEdges;
        if (count > 2 || (count == 2 && upwards != 1)) ++figures.nonmanifoldEdges;
    }
}

MeshFigures measureFlat(const Flat& flat) {
    MeshFigures figures;
    figures.triangles = flat.triangles.size();
    Components components(flat.positions.size());
    std::vector<bool> used(flat.positions.size());
    const Vec3d origin = flat.positions.empty() ? Vec3d{} : flat.positions.front().as<double>();
    for (const Triangle& t : flat.triangles) {
        const Vec3d a = flat.positions[t.x].as<double>() - origin, b = flat.positions[t.y].as<double>() - origin,
                    c = flat.positions[t.z].as<double>() - origin;
        figures.volume_m3 += dot(a, cross(b, c)) / 6;
        figures.area_m2 += length(cross(b - a, c - a)) / 2;
        components.join(t.x, t.y);
        components.join(t.x, t.z);
        for (int i = 0; i < 3; ++i) used[t[i]] = true;
    }
    for (uint32_t v = 0; v < flat.positions.size(); ++v) {
        if (!used[v]) continue;
        ++figures.vertices;
        figures.components += components.find(v) == v ? 1 : 0;
        figures.bounds = hull(figures.bounds, flat.positions[v]);
    }
    uint64_t edges = 0;
    countEdges(flat, figures, edges);
    figures.euler =
        static_cast<int64_t>(figures.vertices) - static_cast<int64_t>(edges) + static_cast<int64_t>(figures.triangles);
    return figures;
}

}  // namespace

MeshFigures measure(const Mesh& mesh) { return measureFlat(flatten(mesh)); }

MeshFigures measureWelded(const Mesh& mesh) {
    Flat flat = flatten(mesh);
    const std::vector<uint32_t> map = weldMap(flat.positions);
    for (Triangle& t : flat.triangles) t = {map[t.x], map[t.y], map[t.z]};
    // A triangle that welding has folded up has no edges left to judge.
    std::erase_if(flat.triangles, [](const Triangle& t) { return t.x == t.y || t.y == t.z || t.z == t.x; });
    return measureFlat(flat);
}

}  // namespace sgm::mesh
