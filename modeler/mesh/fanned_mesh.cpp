#include "modeler/mesh/fanned_mesh.h"

#include <unordered_set>

namespace sgm::mesh {
namespace {

/// The mesh in one chunk, with fans instead of what they replace and without vertices that have no triangle.
class FannedMesh {
public:
    FannedMesh(const Mesh& mesh, std::span<const TipFan> fans) {
        const size_t vertices = mesh.vertexCount(), triangles = mesh.triangleCount();
        chunk_.positions.reserve(vertices), chunk_.normals.reserve(vertices);
        chunk_.triangles.reserve(triangles), chunk_.origins.reserve(triangles), chunk_.labels.reserve(triangles);
        for (const Chunk& c : mesh.chunks) addArrays(c);
        fans_.resize(chunk_.triangles.size(), nullptr), isRemoved_.resize(chunk_.triangles.size());
        std::unordered_set<uint32_t> tops;
        for (const TipFan& fan : fans) {
            tops.insert(fan.top);
            for (const uint32_t t : fan.removed) isRemoved_[t] = true;
            for (const TipTriangle& t : fan.triangles) fans_[t.number] = &t;
            chunk_.positions[fan.top] = fan.apex;
        }
        std::erase_if(chunk_.confined, [&](const ConfinedVertex& v) { return tops.contains(v.vertex); });
    }

    Mesh make() {
        replaceTriangles();
        dropVertices();
        Mesh made;
        made.chunks.push_back(std::move(chunk_));
        return made;
    }

private:
    template <class List>
    static void append(List& list, const List& more) {
        list.insert(list.end(), more.begin(), more.end());
    }

    void addArrays(const Chunk& c) {
        const auto firstTriangle = static_cast<uint32_t>(chunk_.triangles.size());
        append(chunk_.positions, c.positions), append(chunk_.normals, c.normals);
        append(chunk_.origins, c.origins), append(chunk_.labels, c.labels);
        for (const Triangle& t : c.triangles) chunk_.triangles.push_back(c.inMesh(t));
        for (const CornerNormal& n : c.cornerNormals)
            chunk_.cornerNormals.push_back({3 * firstTriangle + n.corner, n.normal});
        for (const ConfinedVertex& v : c.confined) chunk_.confined.push_back({c.firstVertex + v.vertex, v.place});
        for (const uint32_t v : c.faceted) chunk_.faceted.push_back(c.firstVertex + v);
    }

    void replaceTriangles() {
        std::vector<CornerNormal> normals;
        auto own = chunk_.cornerNormals.begin();
        uint32_t left = 0;
        for (uint32_t t = 0; t < chunk_.triangles.size(); ++t) {
            const auto first = own;
            while (own != chunk_.cornerNormals.end() && own->corner / 3 == t) ++own;
            const TipTriangle* const fan = fans_[t];
            if (isRemoved_[t] && !fan) continue;
            chunk_.triangles[left] = fan ? fan->corners : chunk_.triangles[t];
            chunk_.origins[left] = chunk_.origins[t];
            if (!chunk_.labels.empty()) chunk_.labels[left] = chunk_.labels[t];
            if (fan) {
                for (uint32_t k = 0; k < 3; ++k)
                    if (fan->ownNormals >> k & 1) normals.push_back({3 * left + k, fan->normals[k]});
            } else {
                for (auto n = first; n != own; ++n) normals.push_back({3 * left + n->corner % 3, n->normal});
            }
            ++left;
        }
        chunk_.triangles.resize(left), chunk_.origins.resize(left);
        if (!chunk_.labels.empty()) chunk_.labels.resize(left);
        chunk_.cornerNormals = std::move(normals);
    }

    void dropVertices() {
        constexpr uint32_t none = 0xffffffffu;
        std::vector<uint32_t> number(chunk_.positions.size(), none);
        for (const Triangle& t : chunk_.triangles) number[t.x] = number[t.y] = number[t.z] = 0;
        uint32_t left = 0;
        for (uint32_t v = 0; v < number.size(); ++v) {
            if (number[v] == none) continue;
            chunk_.positions[left] = chunk_.positions[v], chunk_.normals[left] = chunk_.normals[v];
            number[v] = left++;
        }
        chunk_.positions.resize(left), chunk_.normals.resize(left);
        for (Triangle& t : chunk_.triangles) t = {number[t.x], number[t.y], number[t.z]};
        std::erase_if(chunk_.confined, [&](const ConfinedVertex& v) { return number[v.vertex] == none; });
        for (ConfinedVertex& v : chunk_.confined) v.vertex = number[v.vertex];
        std::erase_if(chunk_.faceted, [&](uint32_t v) { return number[v] == none; });
        for (uint32_t& v : chunk_.faceted) v = number[v];
    }

    Chunk chunk_;
    std::vector<const TipTriangle*> fans_;  ///< by triangle: what takes its place
    std::vector<bool> isRemoved_;           ///< by triangle
};

}  // namespace

Mesh withFans(const Mesh& mesh, std::span<const TipFan> fans) { return FannedMesh(mesh, fans).make(); }

}  // namespace sgm::mesh
