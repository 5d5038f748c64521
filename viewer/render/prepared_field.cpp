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

namespace {

/// Owners of what a tape's probes meet. Where solids touch, the field within their sum is 0 again, so that the values
/// at both ends of a probe don't tell where it meets the first of them: a step as long as the value at its beginning
/// leads there, or near it, and two more values are taken behind it.
std::vector<OriginId> ownersAt(const eval::Tape& tape, const std::vector<PreparedField::Probe>& probes,
                               eval::Workspace& workspace) {
    constexpr float behind = 0.05f;  // of a probe
    constexpr size_t samples = 3;
    const size_t n = probes.size();
    std::vector<float> x(samples * n), y(samples * n), z(samples * n), values(samples * n), first(n), begin(n);
    const auto put = [&](size_t row, size_t k, float share) {
        const Vec3f p = probes[k].from + (probes[k].to - probes[k].from) * share;
        x[row * n + k] = p.x, y[row * n + k] = p.y, z[row * n + k] = p.z;
    };
    for (size_t k = 0; k < n; ++k) put(0, k, 0);
    eval::evaluate(tape, {x.data(), y.data(), z.data(), n}, begin.data(), workspace);
    for (size_t k = 0; k < n; ++k) {
        const float step = begin[k] / (std::max(tape.lipschitz(), 1e-6f) * length(probes[k].to - probes[k].from));
        first[k] = std::min(std::max(step, 0.0f) + behind, 1.0f);
        put(0, k, first[k]), put(1, k, (first[k] + 1) / 2), put(2, k, 1);
    }
    eval::evaluate(tape, {x.data(), y.data(), z.data(), samples * n}, values.data(), workspace);
    for (size_t k = 0; k < n; ++k) {
        const float at[samples] = {first[k], (first[k] + 1) / 2, 1};
        size_t inside = 0;
        while (inside < samples && !(values[inside * n + k] < 0)) ++inside;
        if (inside == 0 || inside == samples) {
            put(0, k, at[std::min(inside, samples - 1)]);
            continue;
        }
        const float before = values[(inside - 1) * n + k], after = values[inside * n + k];
        const float met = at[inside - 1] + (at[inside] - at[inside - 1]) * (before / (before - after));
        put(0, k, std::min(met + behind, 1.0f));
    }
    // Of faces in one plane the first part has all of it, as in meshes: by values alone rounding would decide.
    std::vector<uint32_t> labels(n);
    std::vector<OriginId> origins(n);
    eval::evaluateLabels(tape, {x.data(), y.data(), z.data(), n}, labels.data(), origins.data(), workspace);
    return origins;
}

}  // namespace

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
        const uint32_t number = members[starts[g]].tape;
        std::vector<Probe> own(n);
        for (size_t k = 0; k < n; ++k) own[k] = probes[members[starts[g] + k].place];
        const std::vector<OriginId> origins = ownersAt(number < whole ? tree.tapes[number] : tape, own, workspace);
        for (size_t k = 0; k < n; ++k)
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
