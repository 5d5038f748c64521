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

/// The edges at each lower vertex, by their upper ends: in the front of a vertex's part those that their triangle runs
/// up along, in its back the others. A counting sort, whose parts lie about as the mesh does.
struct EdgesByVertex {
    std::vector<size_t> start;    ///< of each vertex's part
    std::vector<uint32_t> ups;    ///< how many run up
    std::vector<uint32_t> upper;  ///< ends
};

EdgesByVertex edgesByVertex(const Flat& flat) {
    const size_t vertices = flat.positions.size();
    EdgesByVertex edges{std::vector<size_t>(vertices + 1), std::vector<uint32_t>(vertices),
                        std::vector<uint32_t>(3 * flat.triangles.size())};
    const auto forEach = [&](auto&& visit) {
        for (const Triangle& t : flat.triangles)
            for (int i = 0; i < 3; ++i) visit(t[i], t[(i + 1) % 3]);
    };
    forEach([&](uint32_t a, uint32_t b) { ++edges.start[std::min(a, b) + size_t{1}]; });
    std::partial_sum(edges.start.begin(), edges.start.end(), edges.start.begin());
    std::vector<uint32_t> downs(vertices);
    forEach([&](uint32_t a, uint32_t b) {
        if (a < b)
            edges.upper[edges.start[a] + edges.ups[a]++] = b;
        else
            edges.upper[edges.start[b + size_t{1}] - ++downs[b]] = a;
    });
    return edges;
}

void countEdges(const Flat& flat, MeshFigures& figures, uint64_t& edges) {
    EdgesByVertex all = edgesByVertex(flat);
    for (size_t v = 0; v < all.ups.size(); ++v) {
        uint32_t *up = all.upper.data() + all.start[v], *const upEnd = up + all.ups[v],
                 *down = upEnd, *const downEnd = all.upper.data() + all.start[v + 1];
        std::sort(up, upEnd);
        std::sort(down, downEnd);
        while (up != upEnd || down != downEnd) {
            const uint32_t end = down == downEnd || (up != upEnd && *up < *down) ? *up : *down;
            size_t upwards = 0, count = 0;
            for (; up != upEnd && *up == end; ++up) ++upwards, ++count;
            for (; down != downEnd && *down == end; ++down) ++count;
            ++edges;
            if (count == 1) ++figures.boundaryEdges;
            if (count > 2 || (count == 2 && upwards != 1)) ++figures.nonmanifoldEdges;
        }
    }
}

MeshFigures measureFlat(const Flat& flat) {
    MeshFigures figures;
    figures.triangles = flat.triangles.size();
    const SurfaceLabels surfaces = labelSurfaces(flat.positions.size(), [&](auto f) {
        for (const Triangle& t : flat.triangles) f(t);
    });
    figures.components = surfaces.count;
    const Vec3d origin = flat.positions.empty() ? Vec3d{} : flat.positions.front().as<double>();
    std::vector<double> volumes_m3(surfaces.count);
    for (const Triangle& t : flat.triangles) {
        const Vec3d a = flat.positions[t.x].as<double>() - origin, b = flat.positions[t.y].as<double>() - origin,
                    c = flat.positions[t.z].as<double>() - origin;
        const double volume_m3 = dot(a, cross(b, c)) / 6;
        figures.volume_m3 += volume_m3, volumes_m3[surfaces.of[t.x]] += volume_m3;
        figures.area_m2 += length(cross(b - a, c - a)) / 2;
    }
    figures.cavities = static_cast<uint64_t>(
        std::count_if(volumes_m3.begin(), volumes_m3.end(), [](double volume_m3) { return volume_m3 < 0; }));
    for (uint32_t v = 0; v < flat.positions.size(); ++v) {
        if (surfaces.of[v] == SurfaceLabels::none) continue;
        ++figures.vertices;
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
