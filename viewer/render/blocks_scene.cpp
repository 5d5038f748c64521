#include "viewer/render/blocks_scene.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "modeler/core/parallel.h"
#include "modeler/eval/evaluate.h"
#include "modeler/mesh/edge_loops.h"
#include "modeler/mesh/marching_cubes.h"
#include "viewer/render/field_scene.h"
#include "viewer/render/shader_text.h"

namespace sgm::render {
namespace {

constexpr size_t cornersPerBlock = 33 * 33 * 33, cellsPerBlock = 32 * 32 * 32;
constexpr float cellsPerEdge = 32;  // of a block
constexpr float nearestToCorner = mesh::edgeMargin;

Buffer caseWords() {
    std::vector<uint32_t> words;
    for (const mesh::CellCase& c : mesh::caseTable()) {
        words.push_back(c.triangles);
        words.insert(words.end(), c.edges.begin(), c.edges.end());
    }
    return Buffer::of<uint32_t>(words);
}

void setGrid(const Program& program, const mesh::Grid& grid) {
    program.set("gridOrigin", grid.origin);
    program.set("gridCells", grid.cells.as<float>());
    program.set("cellEdge", grid.cell_m);
}

/// Room for so many triangles.
GpuTriangles roomFor(size_t count) {
    const auto room = [](size_t bytes) { return Buffer::ofBytes(nullptr, std::max<size_t>(bytes, 4)); };
    return {count, room(count * 9 * sizeof(float)), room(count * 9 * sizeof(float)),
            room(count * 3 * sizeof(uint32_t))};
}

}  // namespace

Result<PreparedBlocks> prepareBlocks(const eval::Tape& tape, const mesh::Grid& grid, int threads, Progress* progress) {
    mesh::Counts counts;
    auto blocks = mesh::subdivide(tape, grid, threads, progress, counts);
    if (!blocks.ok()) return blocks.error();
    PreparedBlocks prepared;
    prepared.grid = grid;
    prepared.ops = eval::opsOf(tape);
    for (mesh::Block& block : *blocks) {
        const auto start = static_cast<int32_t>(eval::appendTape(block.tape, prepared.words));
        prepared.blocks.push_back({block.index.x, block.index.y, block.index.z, start});
        prepared.registers = std::max(prepared.registers, block.tape.registerCount());
        prepared.tapes.push_back(std::move(block.tape));
    }
    return prepared;
}

Result<std::shared_ptr<const BlockPrograms>> programsFor(const PreparedBlocks& blocks,
                                                         std::shared_ptr<const BlockPrograms> before) {
    if (before && before->cover(blocks)) return before;
    const auto programs = std::make_shared<BlockPrograms>();
    programs->registers = std::max(before ? before->registers : 0, blocks.registers);
    programs->ops = (before ? before->ops : eval::OpSet()) | blocks.ops;
    programs->cases = caseWords();
    for (auto [name, into] : {std::pair{"corners", &programs->corners}, std::pair{"triangles", &programs->triangles}}) {
        Result<Program> made =
            Program::compute(shaderText(name, eval::interpreterGlsl(programs->registers, programs->ops)));
        if (!made) return made.error();
        *into = std::move(*made);
    }
    return std::shared_ptr<const BlockPrograms>(programs);
}

Result<GpuTriangles> polygonizeOnGpu(const PreparedBlocks& blocks, const BlockPrograms& programs, Progress* progress) {
    if (blocks.blocks.empty()) return roomFor(0);
    const size_t n = blocks.blocks.size();
    if (progress) progress->begin("triangles", n * (cornersPerBlock + 2 * cellsPerBlock));
    const TexelBuffer words = TexelBuffer::of(blocks.words, 4), single = words.as(1);
    const Buffer places = Buffer::of<std::array<int32_t, 4>>(blocks.blocks);
    const Buffer values = Buffer::ofBytes(nullptr, n * cornersPerBlock * sizeof(float));
    words.bind(0);
    single.bind(1);
    places.bindStorage(1);
    values.bindStorage(2);
    programs.cases.bindStorage(3);
    const Program& corners = programs.corners;
    corners.set("tapes", 0);
    corners.set("tapeWords", 1);
    setGrid(corners, blocks.grid);
    size_t piece = 2048;
    if (Status s = runInPieces(corners, n * cornersPerBlock, piece, progress); !s) return s.error();

    const Program& cells = programs.triangles;
    setGrid(cells, blocks.grid);
    cells.set("nearestToCorner", nearestToCorner);
    GpuTriangles made = roomFor(0);
    for (const bool counting : {true, false}) {
        const Buffer count = Buffer::of<uint32_t>(std::array<uint32_t, 1>{});
        count.bindStorage(4);
        made.positions.bindStorage(5);
        made.normals.bindStorage(6);
        made.indices.bindStorage(8);
        cells.set("room", static_cast<uint32_t>(made.count));
        if (Status s = runInPieces(cells, n * cellsPerBlock, piece, progress); !s) return s.error();
        if (counting) made = roomFor(count.read<uint32_t>(1)[0]);
    }
    return made;
}

std::vector<OriginId> ownersOf(const PreparedBlocks& blocks, const GpuTriangles& triangles, int threads) {
    const std::vector<Vec3f> corners = triangles.positions.read<Vec3f>(triangles.count * 3);
    std::map<std::array<int, 3>, size_t> blockAt;
    for (size_t b = 0; b < blocks.blocks.size(); ++b)
        blockAt[{blocks.blocks[b][0], blocks.blocks[b][1], blocks.blocks[b][2]}] = b;
    struct Members {
        std::vector<float> x, y, z;
        std::vector<size_t> triangles;
    };
    std::vector<Members> members(blocks.blocks.size());
    const float edge = cellsPerEdge * blocks.grid.cell_m;
    for (size_t t = 0; t < triangles.count; ++t) {
        const Vec3f middle = (corners[3 * t] + corners[3 * t + 1] + corners[3 * t + 2]) / 3.0f,
                    place = (middle - blocks.grid.origin) / edge;
        const auto index = [](float v) { return static_cast<int>(std::floor(v)); };
        const auto block = blockAt.find({index(place.x), index(place.y), index(place.z)});
        if (block == blockAt.end()) continue;  // rounded across the border of all blocks
        Members& into = members[block->second];
        into.x.push_back(middle.x), into.y.push_back(middle.y), into.z.push_back(middle.z);
        into.triangles.push_back(t);
    }
    std::vector<OriginId> owners(triangles.count, 0);
    std::vector<eval::Workspace> workspaces(size_t(threadCount(threads)));
    parallelFor(members.size(), threads, nullptr, [&](size_t b, int worker) {
        const Members& m = members[b];
        if (m.triangles.empty()) return;
        std::vector<OriginId> found(m.triangles.size());
        eval::evaluateOrigin(blocks.tapes[b], {m.x.data(), m.y.data(), m.z.data(), found.size()}, found.data(),
                             workspaces[size_t(worker)]);
        for (size_t i = 0; i < found.size(); ++i) owners[m.triangles[i]] = found[i];
    });
    return owners;
}

Result<std::vector<Vec3f>> polygonizeOnGpu(const eval::Tape& tape, const mesh::Grid& grid) {
    const Result<GpuContext> gpu = GpuContext::create();
    if (!gpu) return gpu.error();
    const Result<PreparedBlocks> blocks = prepareBlocks(tape, grid, 0, nullptr);
    if (!blocks) return blocks.error();
    const auto programs = programsFor(*blocks, nullptr);
    if (!programs) return programs.error();
    const Result<GpuTriangles> triangles = polygonizeOnGpu(*blocks, **programs, nullptr);
    if (!triangles) return triangles.error();
    return triangles->positions.read<Vec3f>(triangles->count * 3);
}

}  // namespace sgm::render
