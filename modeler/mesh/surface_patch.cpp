#include "modeler/mesh/surface_patch.h"

#include <span>
#include <utility>

#include "modeler/mesh/one_chunk.h"

namespace sgm::mesh {
namespace {

constexpr uint32_t noNumber = 0xffffffffu;

/// Puts a patch back.
class PatchMerger {
public:
    PatchMerger(const Chunk& whole, const SurfacePatch& patch, const ReplacedPatch& replaced)
        : whole_(whole),
          patch_(patch),
          made_(replaced.surface),
          triangleOf_(replaced.triangleOf),
          numberOfWhole_(whole.positions.size()),
          numberOfMade_(made_.positions.size(), noNumber) {}

    Chunk run() {
        addVertices();
        addTriangles();
        return std::move(merged_);
    }

private:
    void addVertices() {
        for (const Triangle& t : made_.triangles) numberOfMade_[t.x] = numberOfMade_[t.y] = numberOfMade_[t.z] = 0;
        const size_t most = whole_.positions.size() + made_.positions.size() - patch_.vertices.size();
        merged_.positions.reserve(most), merged_.normals.reserve(most);
        size_t inPatch = 0;
        for (uint32_t v = 0; v < numberOfWhole_.size(); ++v) {
            numberOfWhole_[v] = static_cast<uint32_t>(merged_.positions.size());
            if (inPatch < patch_.vertices.size() && patch_.vertices[inPatch] == v) {
                uint32_t& number = numberOfMade_[inPatch++];
                if (number == noNumber) {
                    numberOfWhole_[v] = noNumber;
                    continue;
                }
                number = numberOfWhole_[v];
            }
            merged_.positions.push_back(whole_.positions[v]), merged_.normals.push_back(whole_.normals[v]);
        }
        for (size_t v = patch_.vertices.size(); v < numberOfMade_.size(); ++v) {
            if (numberOfMade_[v] == noNumber) continue;
            numberOfMade_[v] = static_cast<uint32_t>(merged_.positions.size());
            merged_.positions.push_back(made_.positions[v]), merged_.normals.push_back(made_.normals[v]);
        }
        addMarks(whole_, numberOfWhole_, 0);
        addMarks(made_, numberOfMade_, static_cast<uint32_t>(patch_.vertices.size()));
    }

    /// Of the vertices from `first` on.
    void addMarks(const Chunk& chunk, const std::vector<uint32_t>& numbers, uint32_t first) {
        for (const ConfinedVertex& v : chunk.confined)
            if (v.vertex >= first && numbers[v.vertex] != noNumber)
                merged_.confined.push_back({numbers[v.vertex], v.place});
        for (const uint32_t v : chunk.faceted)
            if (v >= first && numbers[v] != noNumber) merged_.faceted.push_back(numbers[v]);
    }

    void addTriangles() {
        const size_t most = whole_.triangles.size() + made_.triangles.size();
        merged_.triangles.reserve(most), merged_.origins.reserve(most), merged_.labels.reserve(most);
        size_t inPatch = 0;
        visitTriangles(whole_, [&](uint32_t t, std::span<const CornerNormal> normals) {
            if (inPatch == patch_.triangles.size() || patch_.triangles[inPatch] != t) {
                add(whole_, t, numberOfWhole_, normals);
                return;
            }
            while (nextMade_ < triangleOf_.size() && triangleOf_[nextMade_] == inPatch) addMade();
            ++inPatch;
        });
        while (nextMade_ < made_.triangles.size()) addMade();
    }

    void addMade() {
        const size_t first = nextNormal_;
        while (nextNormal_ < made_.cornerNormals.size() && made_.cornerNormals[nextNormal_].corner / 3 == nextMade_)
            ++nextNormal_;
        add(made_, nextMade_++, numberOfMade_, std::span(made_.cornerNormals).subspan(first, nextNormal_ - first));
    }

    void add(const Chunk& from, uint32_t t, const std::vector<uint32_t>& numbers,
             std::span<const CornerNormal> normals) {
        const auto triangle = static_cast<uint32_t>(merged_.triangles.size());
        const Triangle& c = from.triangles[t];
        merged_.triangles.push_back({numbers[c.x], numbers[c.y], numbers[c.z]});
        merged_.origins.push_back(from.origins[t]), merged_.labels.push_back(from.labels[t]);
        for (const CornerNormal& n : normals) merged_.cornerNormals.push_back({3 * triangle + n.corner % 3, n.normal});
    }

    const Chunk& whole_;
    const SurfacePatch& patch_;
    const Chunk& made_;
    const std::vector<uint32_t>& triangleOf_;
    std::vector<uint32_t> numberOfWhole_, numberOfMade_;  ///< of vertices in the merged surface
    uint32_t nextMade_ = 0;
    size_t nextNormal_ = 0;  ///< of those made
    Chunk merged_;
};

}  // namespace

SurfacePatch::SurfacePatch(const Chunk& whole, std::vector<uint32_t> some) : triangles(std::move(some)) {
    std::vector<uint32_t> number(whole.positions.size(), noNumber);
    for (const uint32_t t : triangles)
        for (int k = 0; k < 3; ++k) number[whole.triangles[t][k]] = 0;
    for (uint32_t v = 0; v < number.size(); ++v) {
        if (number[v] == noNumber) continue;
        number[v] = static_cast<uint32_t>(vertices.size());
        vertices.push_back(v);
        surface.positions.push_back(whole.positions[v]), surface.normals.push_back(whole.normals[v]);
    }
    auto normal = whole.cornerNormals.begin();
    for (const uint32_t t : triangles) {
        const auto triangle = static_cast<uint32_t>(surface.triangles.size());
        const Triangle& c = whole.triangles[t];
        surface.triangles.push_back({number[c.x], number[c.y], number[c.z]});
        surface.origins.push_back(whole.origins[t]), surface.labels.push_back(whole.labels[t]);
        while (normal != whole.cornerNormals.end() && normal->corner / 3 < t) ++normal;
        for (; normal != whole.cornerNormals.end() && normal->corner / 3 == t; ++normal)
            surface.cornerNormals.push_back({3 * triangle + normal->corner % 3, normal->normal});
    }
    for (const ConfinedVertex& v : whole.confined)
        if (number[v.vertex] != noNumber) surface.confined.push_back({number[v.vertex], v.place});
    for (const uint32_t v : whole.faceted)
        if (number[v] != noNumber) surface.faceted.push_back(number[v]);
}

Chunk withReplaced(const Chunk& whole, const SurfacePatch& patch, const ReplacedPatch& replaced) {
    return PatchMerger(whole, patch, replaced).run();
}

}  // namespace sgm::mesh
