// Sphere tracing in one fixed shader (design: "The viewer"). The CPU cuts space into cells with shortened tapes and
// says whose surface each hit is; the GPU finds the hits and lights them.
#include "viewer/field_scene.h"

#include <bit>
#include <chrono>

#include "modeler/core/parallel.h"
#include "modeler/eval/evaluate.h"
#include "viewer/scene.h"
#include "viewer/shader_text.h"

namespace sgm::viewer {
namespace {

using Vec4 = std::array<float, 4>;

/// Value of the field at one place.
float valueAt(const eval::Tape& tape, Vec3f p) {
    eval::Workspace workspace;
    float value = 0;
    eval::evaluate(tape, {&p.x, &p.y, &p.z, 1}, &value, workspace);
    return value;
}

void setCells(const Program& program, const PreparedField& field, float side) {
    program.set("tapes", 0);
    program.set("tree", 1);
    program.set("tapeWords", 2);
    program.set("rootLow", field.tree.low);
    program.set("rootEdge", field.tree.edge);
    program.set("boundsLow", field.box.lo);
    program.set("boundsHigh", field.box.hi);
    program.set("side", side);
    program.set("inverseLipschitz", 1.0f / std::max(field.tape.lipschitz(), 1e-6f));
    program.set("margin", field.tree.margin);
}

}  // namespace

Result<PreparedField> prepareField(const eval::Tape& tape, const Box3f& bounds, const Provenance& provenance, int threads,
                                   Progress* progress) {
    // Soft shadows and occlusion ask for exact distances up to the margin, and no further.
    const float margin = 0.03f * length(bounds.size());
    PreparedField field{tape, bounds, bounds.inflated(margin), {}, {}, {}, 0, provenance.materials, {}};
    Result<CellTree> tree = cutIntoCells(tape, field.box, margin, threads, progress);
    if (!tree) return tree.error();
    field.tree = std::move(*tree);
    std::vector<uint32_t> starts;
    for (size_t i = 0; i < field.tree.tapes.size(); ++i) {
        const eval::Tape& shortened = field.tree.tapes[i];
        starts.push_back(eval::appendTape(shortened, field.words));
        // The last word of a tape's first texel is free: how near the surface may be from inside the cell.
        field.words[size_t(starts.back()) * 4 + 3] = std::bit_cast<uint32_t>(field.tree.ranges[i].lo);
        field.registers = std::max(field.registers, shortened.registerCount());
    }
    field.nodes = field.tree.nodes;
    for (uint32_t& word : field.nodes)
        if (CellTree::stateOf(word) == CellState::Near)
            word = uint32_t(CellState::Near) << 30 | starts[CellTree::indexOf(word)];
    if (field.words.empty()) field.words.resize(4);
    for (const Part& part : provenance.parts) field.materialOf.push_back(part.material);
    return field;
}

bool FieldPrograms::cover(const PreparedField& field) const {
    return trace.id() != 0 && field.registers <= registers && (eval::opsOf(field.tape) & ~ops).none();
}

Result<std::shared_ptr<const FieldPrograms>> programsFor(const PreparedField& field,
                                                         std::shared_ptr<const FieldPrograms> before) {
    if (before && before->cover(field)) return before;
    const auto programs = std::make_shared<FieldPrograms>();
    programs->registers = std::max(before ? before->registers : 0, field.registers);
    programs->ops = (before ? before->ops : eval::OpSet()) | eval::opsOf(field.tape);
    const std::string interpreter = eval::interpreterGlsl(programs->registers, programs->ops);
    for (auto [stage, into] : {std::pair{"trace", &programs->trace}, std::pair{"shade", &programs->shade}}) {
        Result<Program> made = Program::compute(shaderText(stage, interpreter));
        if (!made) return made.error();
        *into = std::move(*made);
    }
    return std::shared_ptr<const FieldPrograms>(programs);
}

FieldScene::FieldScene(PreparedField field, std::shared_ptr<const FieldPrograms> programs, int threads)
    : programs_(std::move(programs)),
      words_(TexelBuffer::of(field.words, 4)),
      single_(words_.as(1)),
      nodes_(TexelBuffer::of(field.nodes, 1)),
      materials_(uploadMaterials(field.materials)),
      threads_(threads) {
    field.words = field.nodes = {};
    field_ = std::make_shared<const PreparedField>(std::move(field));
}

Status FieldScene::warmUp() {
    const Job job{0, 0};
    look(PictureOptions{.camera = frame(field_->bounds, 1)});
    const Result<Rays> ray = draw({&job, 1}, nullptr);
    return ray ? Status(Done{}) : ray.error();
}

void FieldScene::look(const PictureOptions& options, double fine) {
    const float side = valueAt(field_->tape, options.camera.eye.as<float>()) < 0 ? -1.0f : 1.0f;
    for (const Program* program : {&programs_->trace, &programs_->shade}) {
        setScene(*program, field_->bounds, options);
        setCells(*program, *field_, side);
        if (fine != 1) program->set("pixelAngle", static_cast<float>(viewOf(options.camera, options.width, options.height).pixelAngle / fine));
    }
}

/// Every piece takes about 15 ms, so that no draw holds the screen and nothing waits long for a cancel.
Status runInPieces(const Program& program, size_t count, size_t& piece, Progress* progress) {
    program.use();
    for (size_t first = 0; first < count;) {
        if (cancelled(progress)) return cancelledError();
        const size_t n = std::min(piece, count - first);
        const auto start = std::chrono::steady_clock::now();
        program.set("firstJob", static_cast<uint32_t>(first));
        program.set("jobCount", static_cast<uint32_t>(n));
        dispatch(n);
        finish();
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
        const double wanted = static_cast<double>(n) * std::clamp(0.015 / std::max(took.count(), 1e-4), 0.25, 4.0);
        if (n == piece || took.count() > 0.02)
            piece = std::clamp(static_cast<size_t>(wanted) / 64 * 64, size_t(256), mostJobs);
        first += n;
        tick(progress, n);
    }
    return Done{};
}

/// Hits are gathered by cell and asked on the cell's own tape.
std::vector<OriginId> FieldScene::originsOf(const Rays& rays) const {
    const CellTree& tree = field_->tree;
    const size_t leaves = tree.tapes.size();  // index `leaves` is the whole tape, for hits beside every near cell
    std::vector<std::vector<uint32_t>> byLeaf(leaves + 1);
    for (size_t i = 0; i < rays.hits.size(); ++i) {
        if (rays.kind(i) != HitKind::Object) continue;
        const uint32_t word = tree.find(rays.position(i));
        byLeaf[CellTree::stateOf(word) == CellState::Near ? CellTree::indexOf(word) : leaves].push_back(
            static_cast<uint32_t>(i));
    }
    std::vector<OriginId> all(rays.hits.size(), 0);
    std::vector<eval::Workspace> workspaces(size_t(threadCount(threads_)));
    parallelFor(byLeaf.size(), threads_, nullptr, [&](size_t leaf, int worker) {
        const std::vector<uint32_t>& members = byLeaf[leaf];
        if (members.empty()) return;
        std::vector<float> x, y, z;
        for (const uint32_t i : members) {
            x.push_back(rays.hits[i][0]);
            y.push_back(rays.hits[i][1]);
            z.push_back(rays.hits[i][2]);
        }
        std::vector<OriginId> origins(members.size());
        const eval::Tape& tape = leaf < leaves ? tree.tapes[leaf] : field_->tape;
        eval::evaluateOrigin(tape, {x.data(), y.data(), z.data(), x.size()}, origins.data(), workspaces[size_t(worker)]);
        for (size_t k = 0; k < members.size(); ++k)
            all[members[k]] = origins[k] < field_->materialOf.size() ? origins[k] : 0;
    });
    return all;
}

Result<Rays> FieldScene::draw(std::span<const Job> jobs, Progress* progress) {
    const Buffer jobBuffer = Buffer::of(jobs);
    const auto room = [&] { return Buffer::ofBytes(nullptr, jobs.size() * sizeof(Vec4)); };
    const Buffer hits = room(), colors = room(), surfaces = room();
    words_.bind(0);
    nodes_.bind(1);
    single_.bind(2);
    jobBuffer.bindStorage(1);
    hits.bindStorage(2);
    Rays rays;
    const Buffer counts = Buffer::of<uint32_t>(std::array<uint32_t, 3>{});
    counts.bindStorage(7);
    if (Status s = runInPieces(programs_->trace, jobs.size(), tracePiece_, progress); !s) return s.error();
    rays.hits = hits.read<Vec4>(jobs.size());
    rays.origins = originsOf(rays);
    std::vector<uint32_t> materials;
    for (const OriginId origin : rays.origins) materials.push_back(field_->materialOf[origin]);
    const Buffer materialOfJob = Buffer::of<uint32_t>(materials);
    materialOfJob.bindStorage(3);
    materials_.bindStorage(4);
    colors.bindStorage(5);
    surfaces.bindStorage(6);
    if (Status s = runInPieces(programs_->shade, jobs.size(), shadePiece_, progress); !s) return s.error();
    rays.colors = colors.read<Vec4>(jobs.size());
    rays.surfaces = surfaces.read<Vec4>(jobs.size());
    const std::vector<uint32_t> counted = counts.read<uint32_t>(3);
    std::copy_n(counted.begin(), 2, rays.evaluations);
    rays.instructions = counted[2];
    return rays;
}

}  // namespace sgm::viewer
