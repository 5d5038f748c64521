#include "viewer/prepared_field.h"

#include "modeler/core/parallel.h"
#include "modeler/eval/evaluate.h"

namespace sgm::viewer {

Result<PreparedField> prepareField(const eval::Tape& tape, const Box3f& bounds, const Provenance& provenance, int threads,
                                   Progress* progress, int levels) {
    // Soft shadows and occlusion ask for exact distances up to the margin, and no further.
    const float margin = 0.03f * length(bounds.size());
    PreparedField field{tape, bounds, bounds.inflated(margin), {}, provenance.materials, {}};
    Result<CellTree> tree = cutIntoCells(tape, field.box, margin, threads, progress, levels);
    if (!tree) return tree.error();
    field.tree = std::move(*tree);
    for (const Part& part : provenance.parts) field.materialOf.push_back(part.material);
    return field;
}

float PreparedField::sideOf(Vec3f eye) const {
    eval::Workspace workspace;
    float value = 0;
    eval::evaluate(tape, {&eye.x, &eye.y, &eye.z, 1}, &value, workspace);
    return value < 0 ? -1.0f : 1.0f;
}

/// Places are gathered by cell and asked on the cell's own tape.
std::vector<OriginId> PreparedField::originsOf(const std::vector<Vec3f>& places, int threads) const {
    const size_t leaves = tree.tapes.size();  // index `leaves` is the whole tape, for places beside every near cell
    std::vector<std::vector<uint32_t>> byLeaf(leaves + 1);
    for (size_t i = 0; i < places.size(); ++i) {
        const uint32_t word = tree.find(places[i]);
        byLeaf[CellTree::stateOf(word) == CellState::Near ? CellTree::indexOf(word) : leaves].push_back(static_cast<uint32_t>(i));
    }
    std::vector<OriginId> all(places.size(), 0);
    std::vector<eval::Workspace> workspaces(size_t(threadCount(threads)));
    parallelFor(byLeaf.size(), threads, nullptr, [&](size_t leaf, int worker) {
        const std::vector<uint32_t>& members = byLeaf[leaf];
        if (members.empty()) return;
        std::vector<float> x, y, z;
        for (const uint32_t i : members) {
            x.push_back(places[i].x);
            y.push_back(places[i].y);
            z.push_back(places[i].z);
        }
        std::vector<OriginId> origins(members.size());
        eval::evaluateOrigin(leaf < leaves ? tree.tapes[leaf] : tape, {x.data(), y.data(), z.data(), x.size()}, origins.data(),
                             workspaces[size_t(worker)]);
        for (size_t k = 0; k < members.size(); ++k) all[members[k]] = origins[k] < materialOf.size() ? origins[k] : 0;
    });
    return all;
}

}  // namespace sgm::viewer
