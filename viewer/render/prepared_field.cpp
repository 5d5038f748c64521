#include "viewer/render/prepared_field.h"

#include <algorithm>

#include "modeler/core/parallel.h"
#include "modeler/eval/evaluate.h"

namespace sgm::render {

Result<PreparedField> prepareField(const eval::Tape& tape, const Box3f& bounds, const Provenance& provenance,
                                   int threads, Progress* progress, int levels) {
    // Soft shadows and occlusion ask for exact distances up to the margin, and no further.
    const float margin = 0.03f * length(bounds.size());
    PreparedField field{tape, bounds, bounds.inflated(margin), {}, provenance.materials, {}, {}};
    Result<SurfaceTextures> textures = SurfaceTextures::create(provenance, progress);
    if (!textures) return textures.error();
    field.textures = std::move(*textures);
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
std::vector<OriginId> PreparedField::originsOf(const std::vector<Probe>& probes, int threads) const {
    const auto whole =
        static_cast<uint32_t>(tree.tapes.size());  // the field's own tape, for places beside every near cell
    struct Member {
        uint32_t tape, place;
    };
    std::vector<Member> members(probes.size());
    for (uint32_t i = 0; i < probes.size(); ++i) {
        const uint32_t word = tree.find(probes[i].to);
        members[i] = {CellTree::stateOf(word) == CellState::Near ? CellTree::indexOf(word) : whole, i};
    }
    std::stable_sort(members.begin(), members.end(), [](const Member& a, const Member& b) { return a.tape < b.tape; });
    std::vector<size_t> starts;  // of each tape's members
    for (size_t i = 0; i < members.size(); ++i)
        if (i == 0 || members[i].tape != members[i - 1].tape) starts.push_back(i);
    starts.push_back(members.size());
    std::vector<OriginId> all(probes.size(), 0);
    const size_t groups = starts.size() - 1;
    constexpr size_t fewGroups = 64;  // a thread takes so many at a time
    std::vector<eval::Workspace> workspaces(std::min(size_t(threadCount(threads)), groups / fewGroups + 1));
    const auto askGroup = [&](size_t g, eval::Workspace& workspace) {
        const size_t n = starts[g + 1] - starts[g];
        std::vector<float> x(2 * n), y(2 * n), z(2 * n), values(2 * n);  // ends, then beginnings
        const auto put = [&](size_t k, Vec3f p) { x[k] = p.x, y[k] = p.y, z[k] = p.z; };
        const auto probeOf = [&](size_t k) -> const Probe& { return probes[members[starts[g] + k].place]; };
        for (size_t k = 0; k < n; ++k) put(k, probeOf(k).to), put(n + k, probeOf(k).from);
        const uint32_t number = members[starts[g]].tape;
        const eval::Tape& own = number < whole ? tree.tapes[number] : tape;
        eval::evaluate(own, {x.data(), y.data(), z.data(), 2 * n}, values.data(), workspace);
        for (size_t k = 0; k < n; ++k) {
            const float from = values[n + k], to = values[k];
            if ((from < 0) == (to < 0)) continue;
            put(k, probeOf(k).from + (probeOf(k).to - probeOf(k).from) * std::min(from / (from - to) + 0.05f, 1.0f));
        }
        std::vector<OriginId> origins(n);
        eval::evaluateOrigin(own, {x.data(), y.data(), z.data(), n}, origins.data(), workspace);
        for (size_t k = 0; k < origins.size(); ++k)
            all[members[starts[g] + k].place] = origins[k] < materialOf.size() ? origins[k] : 0;
    };
    parallelFor((groups + fewGroups - 1) / fewGroups, static_cast<int>(workspaces.size()), nullptr,
                [&](size_t batch, int worker) {
                    for (size_t g = batch * fewGroups; g < std::min((batch + 1) * fewGroups, groups); ++g)
                        askGroup(g, workspaces[size_t(worker)]);
                });
    return all;
}

}  // namespace sgm::render
