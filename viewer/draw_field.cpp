// Sphere tracing in one fixed shader (design: "The viewer"). The CPU cuts space into cells with shortened tapes and
// says whose surface each hit is; the GPU finds the hits and lights them. Pixels on edges are sampled again.
#include <chrono>
#include <cmath>

#include "modeler/core/parallel.h"
#include "modeler/eval/evaluate.h"
#include "modeler/eval/glsl.h"
#include "viewer/cells.h"
#include "viewer/gpu.h"
#include "viewer/scene.h"
#include "viewer/shader_text.h"

namespace sgm::viewer {
namespace {

/// One sample of one pixel, as the shaders read it.
struct Job {
    uint32_t pixel;  ///< x | y << 16
    uint32_t sample;
};
using Vec4 = std::array<float, 4>;

constexpr size_t chunkJobs = size_t(1) << 18;
constexpr float hitObject = 1.0f;

/// Everything on the GPU that stays for the whole picture.
struct FieldPicture {
    CellTree tree;
    Program trace, shade;
    TexelBuffer words, nodes;
    Buffer materials;
    const Provenance& provenance;
    eval::Tape whole;
    int threads;
};

/// The tree's words with leaves pointing at their tapes' texels, and those texels.
void uploadCells(const CellTree& tree, FieldPicture& picture, uint32_t& registers) {
    std::vector<uint32_t> words, starts, nodes = tree.nodes;
    for (const eval::Tape& tape : tree.tapes) {
        starts.push_back(eval::appendTape(tape, words));
        registers = std::max(registers, tape.registerCount());
    }
    for (uint32_t& word : nodes)
        if (CellTree::stateOf(word) == CellState::Near)
            word = uint32_t(CellState::Near) << 30 | starts[CellTree::indexOf(word)];
    if (words.empty()) words.resize(4);
    picture.words = TexelBuffer::of(words, 4);
    picture.nodes = TexelBuffer::of(nodes, 1);
}

/// Value of the field at one place.
float valueAt(const eval::Tape& tape, Vec3f p) {
    eval::Workspace workspace;
    float value = 0;
    eval::evaluate(tape, {&p.x, &p.y, &p.z, 1}, &value, workspace);
    return value;
}

void setCells(const Program& program, const FieldPicture& picture, const Box3f& bounds, float side) {
    const CellTree& tree = picture.tree;
    program.set("tapes", 0);
    program.set("tree", 1);
    program.set("rootLow", tree.low);
    program.set("rootEdge", tree.edge);
    program.set("boundsLow", bounds.lo);
    program.set("boundsHigh", bounds.hi);
    program.set("side", side);
    program.set("inverseLipschitz", 1.0f / std::max(picture.whole.lipschitz(), 1e-6f));
    program.set("margin", tree.margin);
}

Result<FieldPicture> prepare(const eval::Tape& tape, const Box3f& bounds, const Provenance& provenance,
                             const PictureOptions& options, Progress* progress) {
    // The pictures' soft shadows and occlusion ask for exact distances up to the margin, and no further.
    const float margin = 0.03f * length(bounds.size());
    const Box3f box = bounds.inflated(margin);
    Result<CellTree> tree = cutIntoCells(tape, box, margin, options.threads, progress);
    if (!tree) return tree.error();
    FieldPicture picture{std::move(*tree), {}, {}, {}, {}, uploadMaterials(provenance), provenance, tape,
                         options.threads};
    uint32_t registers = tape.registerCount();
    uploadCells(picture.tree, picture, registers);

    const std::string interpreter = eval::interpreterGlsl(registers, eval::opsOf(tape));
    for (auto [stage, into] : {std::pair{"trace", &picture.trace}, std::pair{"shade", &picture.shade}}) {
        Result<Program> made = Program::compute(shaderText(stage, interpreter));
        if (!made) return made.error();
        *into = std::move(*made);
        setScene(*into, bounds, options);
        setCells(*into, picture, box, valueAt(tape, options.camera.eye.as<float>()) < 0 ? -1.0f : 1.0f);
    }
    return picture;
}

/// Runs a program over `count` jobs in pieces that each take about 30 ms, so that nothing waits long for a cancel.
Status runInPieces(const Program& program, size_t count, Progress* progress) {
    program.use();
    size_t piece = 2048;
    for (size_t first = 0; first < count;) {
        if (cancelled(progress)) return Error{Error::Kind::Cancelled, "cancelled"};
        const size_t n = std::min(piece, count - first);
        const auto start = std::chrono::steady_clock::now();
        program.set("firstJob", static_cast<uint32_t>(first));
        program.set("jobCount", static_cast<uint32_t>(n));
        dispatch(n);
        finish();
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
        const double wanted = static_cast<double>(n) * std::clamp(0.03 / std::max(took.count(), 1e-4), 0.25, 4.0);
        piece = std::clamp(static_cast<size_t>(wanted) / 64 * 64, size_t(256), chunkJobs);
        first += n;
        if (progress) progress->tick(n);
    }
    return Done{};
}

/// The material under every hit: hits are gathered by cell and asked on the cell's own tape.
std::vector<uint32_t> materialsOf(const std::vector<Vec4>& hits, const FieldPicture& picture) {
    const size_t leaves =
        picture.tree.tapes.size();  // index `leaves` is the whole tape, for hits beside every near cell
    std::vector<std::vector<uint32_t>> byLeaf(leaves + 1);
    for (size_t i = 0; i < hits.size(); ++i) {
        if (hits[i][3] != hitObject) continue;
        const uint32_t word = picture.tree.find({hits[i][0], hits[i][1], hits[i][2]});
        byLeaf[CellTree::stateOf(word) == CellState::Near ? CellTree::indexOf(word) : leaves].push_back(
            static_cast<uint32_t>(i));
    }
    std::vector<uint32_t> materials(hits.size(), 0);
    std::vector<eval::Workspace> workspaces(size_t(threadCount(picture.threads)));
    parallelFor(byLeaf.size(), picture.threads, nullptr, [&](size_t leaf, int worker) {
        const std::vector<uint32_t>& members = byLeaf[leaf];
        if (members.empty()) return;
        std::vector<float> x, y, z;
        for (const uint32_t i : members) {
            x.push_back(hits[i][0]);
            y.push_back(hits[i][1]);
            z.push_back(hits[i][2]);
        }
        std::vector<OriginId> origins(members.size());
        const eval::Tape& tape = leaf < leaves ? picture.tree.tapes[leaf] : picture.whole;
        eval::evaluateOrigin(tape, {x.data(), y.data(), z.data(), x.size()}, origins.data(),
                             workspaces[size_t(worker)]);
        for (size_t k = 0; k < members.size(); ++k) {
            const OriginId origin = origins[k] < picture.provenance.parts.size() ? origins[k] : 0;
            materials[members[k]] = picture.provenance.parts[origin].material;
        }
    });
    return materials;
}

/// Display light of up to `chunkJobs` jobs.
Result<std::vector<Vec4>> drawChunk(std::span<const Job> jobs, const FieldPicture& picture, Progress* progress) {
    const Buffer jobBuffer = Buffer::of(jobs);
    const Buffer hitBuffer = Buffer::ofBytes(nullptr, jobs.size() * sizeof(Vec4));
    const Buffer colorBuffer = Buffer::ofBytes(nullptr, jobs.size() * sizeof(Vec4));
    picture.words.bind(0);
    picture.nodes.bind(1);
    jobBuffer.bindStorage(1);
    hitBuffer.bindStorage(2);
    picture.materials.bindStorage(4);
    colorBuffer.bindStorage(5);
    if (Status status = runInPieces(picture.trace, jobs.size(), progress); !status) return status.error();
    const Buffer materialBuffer = Buffer::of<uint32_t>(materialsOf(hitBuffer.read<Vec4>(jobs.size()), picture));
    materialBuffer.bindStorage(3);
    if (Status status = runInPieces(picture.shade, jobs.size(), progress); !status) return status.error();
    return colorBuffer.read<Vec4>(jobs.size());
}

/// Adds the display light of every job to its pixel.
Status addJobs(const std::vector<Job>& jobs, const FieldPicture& picture, int width, std::vector<float>& pixels,
               Progress* progress) {
    if (progress) progress->begin("draw", jobs.size() * 2);
    for (size_t first = 0; first < jobs.size(); first += chunkJobs) {
        const std::span chunk = std::span(jobs).subspan(first, std::min(chunkJobs, jobs.size() - first));
        const Result<std::vector<Vec4>> colors = drawChunk(chunk, picture, progress);
        if (!colors) return colors.error();
        for (size_t i = 0; i < chunk.size(); ++i) {
            const size_t pixel = (chunk[i].pixel >> 16) * size_t(width) + (chunk[i].pixel & 0xffffu);
            for (size_t c = 0; c < 4; ++c) pixels[pixel * 4 + c] += (*colors)[i][c];
        }
    }
    return Done{};
}

/// Every pixel once, in blocks of 8 × 8 so that neighbours run together.
std::vector<Job> firstSamples(int width, int height) {
    std::vector<Job> jobs;
    jobs.reserve(size_t(width) * size_t(height));
    for (int by = 0; by < height; by += 8)
        for (int bx = 0; bx < width; bx += 8)
            for (int y = by; y < std::min(by + 8, height); ++y)
                for (int x = bx; x < std::min(bx + 8, width); ++x)
                    jobs.push_back({static_cast<uint32_t>(x) | static_cast<uint32_t>(y) << 16, 0});
    return jobs;
}

/// True where a pixel differs from a neighbour enough to be seen (Whitted 1980's adaptive sampling, on display light).
std::vector<bool> edges(const std::vector<float>& pixels, int width, int height) {
    constexpr float visible = 0.055f;  // of the square root of light, which is about what the eye sees
    std::vector<bool> edge(size_t(width) * size_t(height), false);
    const auto compare = [&](size_t a, size_t b) {
        float most = 0;
        for (size_t c = 0; c < 3; ++c)
            most = std::max(most, std::abs(std::sqrt(pixels[a * 4 + c]) - std::sqrt(pixels[b * 4 + c])));
        if (most > visible) edge[a] = edge[b] = true;
    };
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const size_t here = size_t(y) * size_t(width) + size_t(x);
            if (x + 1 < width) compare(here, here + 1);
            if (y + 1 < height) compare(here, here + size_t(width));
        }
    return edge;
}

}  // namespace

Result<Image> drawField(const eval::Tape& tape, const Box3f& bounds, const Provenance& provenance,
                        const PictureOptions& options, Progress* progress) {
    if (Status status = checkPicture(bounds, options); !status) return status.error();
    const Result<GpuContext> gpu = GpuContext::create();
    if (!gpu) return gpu.error();
    const Result<FieldPicture> picture = prepare(tape, bounds, provenance, options, progress);
    if (!picture) return picture.error();

    const int width = options.width, height = options.height;
    std::vector<float> pixels(size_t(width) * size_t(height) * 4, 0.0f);
    const std::vector<Job> first = firstSamples(width, height);
    if (Status status = addJobs(first, *picture, width, pixels, progress); !status) return status.error();
    if (options.samples > 1) {
        const std::vector<bool> edge = edges(pixels, width, height);
        std::vector<Job> more;
        for (const Job& job : first)
            if (edge[(job.pixel >> 16) * size_t(width) + (job.pixel & 0xffffu)])
                for (uint32_t s = 1; s < static_cast<uint32_t>(options.samples); ++s) more.push_back({job.pixel, s});
        if (Status status = addJobs(more, *picture, width, pixels, progress); !status) return status.error();
    }
    for (size_t i = 0; i < pixels.size(); i += 4)
        for (size_t c = 0; c < 4; ++c) pixels[i + c] /= c < 3 ? pixels[i + 3] : 1.0f;
    return encode(pixels, width, height);
}

}  // namespace sgm::viewer
