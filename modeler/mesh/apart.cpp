#include "modeler/mesh/apart.h"

#include <CGAL/box_intersection_d.h>

#include <array>
#include <string_view>

#include "modeler/core/random.h"
#include "modeler/mesh/component_parts.h"

namespace sgm::mesh {
namespace {

using detail::none;
using detail::ownCount;
using detail::placeOf;
using detail::Surfaces;

/// The component that a vertex of a chunk is on, or none.
uint32_t componentAt(const Surfaces& surfaces, size_t chunk, size_t place) {
    const uint32_t part = surfaces.parts[chunk].at(place);
    return part == none ? none : surfaces.pieceOf[part];
}

/// By component: a box that it stays in while its confined vertices go to their places.
std::vector<Box3f> boxesOf(const Mesh& mesh, const Surfaces& surfaces) {
    std::vector<Box3f> boxes;
    for (const ConnectedComponent& piece : surfaces.pieces) boxes.push_back(piece.bounds);
    for (size_t c = 0; c < mesh.chunks.size(); ++c)
        for (const ConfinedVertex& confined : mesh.chunks[c].confined)
            if (const uint32_t at = componentAt(surfaces, c, confined.vertex); at != none)
                boxes[at] = hull(boxes[at], confined.place);
    return boxes;
}

/// By component: the number of the mesh that it goes to. `count`: how many meshes there are.
std::vector<uint32_t> groupsOf(const std::vector<Box3f>& boxes, double reach_m, size_t& count) {
    using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, uint32_t>;
    std::vector<Box> wide;
    for (uint32_t i = 0; i < boxes.size(); ++i) {
        const Box3d box = boxes[i].as<double>().inflated(reach_m / 2);
        double low[] = {box.lo.x, box.lo.y, box.lo.z}, high[] = {box.hi.x, box.hi.y, box.hi.z};
        wide.emplace_back(low, high, i);
    }
    Components joined(boxes.size());
    CGAL::box_self_intersection_d(wide.begin(), wide.end(),
                                  [&](const Box& a, const Box& b) { joined.join(a.info(), b.info()); });
    std::vector<uint32_t> groups(boxes.size());
    count = 0;
    for (uint32_t i = 0; i < boxes.size(); ++i) {
        const uint32_t lowest = joined.find(i);
        groups[i] = lowest == i ? static_cast<uint32_t>(count++) : groups[lowest];
    }
    return groups;
}

class Splitter {
public:
    Splitter(const Mesh& mesh, const Surfaces& surfaces, const std::vector<uint32_t>& groups, size_t count)
        : mesh_(mesh), surfaces_(surfaces), groups_(groups), pieces_(count), bare_(mesh.hasPositionsOnly()) {
        for (const Chunk& c : mesh.chunks) labelled_ |= !c.labels.empty();
        for (Mesh& piece : pieces_) piece.chunks.resize(1);
        number_.resize(mesh.vertexCount());
    }

    std::vector<Mesh> split() {
        for (size_t c = 0; c < mesh_.chunks.size(); ++c) takeVertices(c);
        for (size_t c = 0; c < mesh_.chunks.size(); ++c) takeTriangles(c);
        return std::move(pieces_);
    }

private:
    Chunk& pieceAt(size_t chunk, size_t place) {
        return pieces_[groups_[componentAt(surfaces_, chunk, place)]].chunks[0];
    }

    void takeVertices(size_t c) {
        const Chunk& chunk = mesh_.chunks[c];
        for (uint32_t v = 0; v < chunk.positions.size(); ++v) {
            if (surfaces_.parts[c].at(v) == none) continue;  // no triangle has it
            Chunk& piece = pieceAt(c, v);
            number_[chunk.firstVertex + v] = ownCount(piece);
            piece.positions.push_back(chunk.positions[v]);
            if (!bare_) piece.normals.push_back(chunk.normals[v]);
        }
        for (const ConfinedVertex& confined : chunk.confined)
            if (surfaces_.parts[c].at(confined.vertex) != none)
                pieceAt(c, confined.vertex)
                    .confined.push_back({number_[chunk.firstVertex + confined.vertex], confined.place});
    }

    void takeTriangles(size_t c) {
        const Chunk& chunk = mesh_.chunks[c];
        auto normal = chunk.cornerNormals.begin();
        for (uint32_t t = 0; t < chunk.triangles.size(); ++t) {
            Chunk& piece = pieceAt(c, placeOf(chunk.triangles[t].x, ownCount(chunk)));
            for (; normal != chunk.cornerNormals.end() && normal->corner / 3 == t; ++normal)
                piece.cornerNormals.push_back(
                    {static_cast<uint32_t>(3 * piece.triangles.size()) + normal->corner % 3, normal->normal});
            const Triangle corners = chunk.inMesh(chunk.triangles[t]);
            piece.triangles.push_back({number_[corners.x], number_[corners.y], number_[corners.z]});
            if (!bare_) piece.origins.push_back(chunk.origins[t]);
            if (labelled_) piece.labels.push_back(t < chunk.labels.size() ? chunk.labels[t] : 0);
        }
    }

    const Mesh& mesh_;
    const Surfaces& surfaces_;
    const std::vector<uint32_t>& groups_;
    std::vector<Mesh> pieces_;
    PageVector<uint32_t> number_;  ///< by vertex: its number in its piece
    const bool bare_;
    bool labelled_ = false;
};

template <class List>
std::string_view bytesOf(const List& list) {
    return {reinterpret_cast<const char*>(list.data()), list.size() * sizeof(list[0])};
}

/// The arrays that a surface is made of, as bytes.
std::array<std::string_view, 7> arraysOf(const Chunk& c) {
    return {bytesOf(c.positions), bytesOf(c.normals),       bytesOf(c.triangles), bytesOf(c.origins),
            bytesOf(c.labels),    bytesOf(c.cornerNormals), bytesOf(c.confined)};
}

template <class List>
void append(List& to, const List& more) {
    to.insert(to.end(), more.begin(), more.end());
}

}  // namespace

std::vector<Mesh> splitApart(const Mesh& mesh, double reach_m, int threads) {
    const Surfaces surfaces = detail::surfacesOf(mesh, threads);
    if (surfaces.pieces.size() < 2) return {};
    size_t count = 0;
    const std::vector<uint32_t> groups = groupsOf(boxesOf(mesh, surfaces), reach_m, count);
    if (count < 2) return {};
    return Splitter(mesh, surfaces, groups, count).split();
}

Mesh join(const std::vector<const Mesh*>& pieces) {
    Mesh mesh;
    Chunk& all = mesh.chunks.emplace_back();
    for (const Mesh* piece : pieces) {
        const Chunk& c = piece->chunks[0];
        const uint32_t vertices = ownCount(all), corners = static_cast<uint32_t>(3 * all.triangles.size());
        append(all.positions, c.positions);
        append(all.normals, c.normals);
        append(all.origins, c.origins);
        append(all.labels, c.labels);
        for (const Triangle& t : c.triangles) all.triangles.push_back({t.x + vertices, t.y + vertices, t.z + vertices});
        for (const CornerNormal& n : c.cornerNormals) all.cornerNormals.push_back({n.corner + corners, n.normal});
    }
    return mesh;
}

bool sameSurface(const Mesh& a, const Mesh& b) { return arraysOf(a.chunks[0]) == arraysOf(b.chunks[0]); }

uint64_t hashSurface(const Mesh& piece) {
    uint64_t hash = 0;
    for (const std::string_view array : arraysOf(piece.chunks[0]))
        hash = mix(hash ^ std::hash<std::string_view>{}(array));
    return hash;
}

}  // namespace sgm::mesh
