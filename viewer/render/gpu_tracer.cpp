#include "viewer/render/gpu_tracer.h"

#include <bit>
#include <chrono>

#include "viewer/render/scene.h"
#include "viewer/render/shader_text.h"

namespace sgm::render {
namespace {

uint32_t registersOf(const PreparedField& field) {
    uint32_t most = 0;
    for (const eval::Tape& tape : field.tree.tapes) most = std::max(most, tape.registerCount());
    return most;
}

class GpuTracer final : public Tracer {
public:
    GpuTracer(std::shared_ptr<const PreparedField> field, std::shared_ptr<const RayPrograms> programs)
        : field_(std::move(field)), programs_(std::move(programs)) {
        std::vector<uint32_t> words, leaves;
        const CellTree& tree = field_->tree;
        for (size_t i = 0; i < tree.tapes.size(); ++i)
            leaves.insert(leaves.end(),
                          {eval::appendTape(tree.tapes[i], words), std::bit_cast<uint32_t>(tree.ranges[i].lo),
                           std::bit_cast<uint32_t>(tree.ranges[i].hi), tree.doubts[i]});
        if (words.empty()) words.resize(4);
        if (leaves.empty()) leaves.resize(4);
        words_ = TexelBuffer::of(words, 4);
        single_ = words_.as(1);
        nodes_ = TexelBuffer::of(tree.nodes, 1);
        leaves_ = TexelBuffer::of(leaves, 4);
    }

    void look(const PictureOptions& options, double fine) override {
        const float side = field_->sideOf(options.camera.eye.as<float>());
        for (const Program* program : {&programs_->trace, &programs_->surface}) {
            setScene(*program, field_->bounds, options);
            program->set("tapes", 0);
            program->set("tree", 1);
            program->set("tapeWords", 2);
            program->set("leaves", 3);
            program->set("rootLow", field_->tree.low);
            program->set("rootEdge", field_->tree.edge);
            program->set("boundsLow", field_->box.lo);
            program->set("boundsHigh", field_->box.hi);
            program->set("side", side);
            program->set("inverseLipschitz", field_->inverseLipschitz());
            program->set("margin", field_->tree.margin);
            if (fine != 1)
                program->set(
                    "pixelAngle",
                    static_cast<float>(viewOf(options.camera, options.width, options.height).pixelAngle / fine));
        }
    }

    Result<Hits> trace(std::span<const Ray> rays, Progress* progress) override {
        const Buffer rayBuffer = Buffer::of(rays), hits = Buffer::ofBytes(nullptr, rays.size() * sizeof(Hit)),
                     free = Buffer::ofBytes(nullptr, rays.size() * sizeof(float));
        rayBuffer.bindStorage(1);
        hits.bindStorage(2);
        free.bindStorage(3);
        if (Status s = run(programs_->trace, rays.size(), tracePiece_, progress); !s) return s.error();
        return Hits{hits.read<Hit>(rays.size()), std::vector<Vec3f>(rays.size(), Vec3f{}),
                    free.read<float>(rays.size())};
    }

    Status light(What what, std::span<const Hit> hits, std::span<Shading> shadings, Progress* progress) override {
        const Buffer hitBuffer = Buffer::of(hits), litBuffer = Buffer::of<Shading>(shadings);
        hitBuffer.bindStorage(2);
        litBuffer.bindStorage(3);
        programs_->surface.set("what", static_cast<int>(what));
        if (Status s = run(programs_->surface, hits.size(), lightPiece_[what == What::Light], progress); !s) return s;
        litBuffer.read(shadings.data(), shadings.size_bytes());
        return Done{};
    }

private:
    Status run(const Program& program, size_t count, size_t& piece, Progress* progress) {
        words_.bind(0);
        nodes_.bind(1);
        single_.bind(2);
        leaves_.bind(3);
        const Buffer counts = Buffer::of<uint32_t>(std::array<uint32_t, 3>{});
        counts.bindStorage(7);
        if (Status s = runInPieces(program, count, piece, progress); !s) return s;
        const std::vector<uint32_t> counted = counts.read<uint32_t>(3);
        cost_ += {counted[0], counted[1], counted[2]};
        return Done{};
    }

    std::shared_ptr<const PreparedField> field_;
    std::shared_ptr<const RayPrograms> programs_;
    TexelBuffer words_, single_, nodes_, leaves_;              // the tapes by instruction and by word; the tree
    size_t tracePiece_ = 2048, lightPiece_[2] = {2048, 2048};  // jobs a dispatch
};

}  // namespace

bool RayPrograms::cover(const PreparedField& field) const {
    return registersOf(field) <= registers && (eval::opsOf(field.tape) & ~ops).none();
}

Result<std::shared_ptr<const RayPrograms>> rayProgramsFor(const PreparedField& field,
                                                          std::shared_ptr<const RayPrograms> before) {
    if (before && before->cover(field)) return before;
    const auto programs = std::make_shared<RayPrograms>();
    programs->registers = std::max(before ? before->registers : 0, registersOf(field));
    programs->ops = (before ? before->ops : eval::OpSet()) | eval::opsOf(field.tape);
    const std::string interpreter = eval::interpreterGlsl(programs->registers, programs->ops);
    for (auto [stage, into] : {std::pair{"trace", &programs->trace}, std::pair{"surface", &programs->surface}}) {
        Result<Program> made = Program::compute(shaderText(stage, interpreter));
        if (!made) return made.error();
        *into = std::move(*made);
    }
    return std::shared_ptr<const RayPrograms>(programs);
}

std::unique_ptr<Tracer> gpuTracer(std::shared_ptr<const PreparedField> field,
                                  std::shared_ptr<const RayPrograms> programs) {
    return std::make_unique<GpuTracer>(std::move(field), std::move(programs));
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

}  // namespace sgm::render
