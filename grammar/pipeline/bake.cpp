#include "grammar/pipeline/bake.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "grammar/derive/graft.h"
#include "grammar/pipeline/products.h"
#include "modeler/core/random.h"
#include "modeler/mesh/chunk.h"

namespace sgm::pipeline {
namespace {

namespace fs = std::filesystem;
using tiles::Cell;

constexpr int masses = 2, coarser = 1, finest = 0;  ///< details of the library
constexpr float coarserBy = 4;                      ///< cells of coarser objects

/// Everything that decides the bytes of a bake, in one text.
std::string digestOf(const derive::Derivation& d, const BakeRequest& request) {
    std::string text;
    for (const syntax::SourcePtr& source : d.grammar->sources) text += std::string(source->text()) + '\0';
    for (const rules::Value& value : d.params) text += rules::toText(value) + '\0';
    text += fmt::format("{} {} {:a} {:a} {:a} {}", d.start, d.seed, request.side_m, request.cell_m,
                        request.objectCell_m, request.levels);
    return tiles::digestOf(text);
}

/// The box around an object as a mesh of twelve triangles.
Result<ObjectMesh> massMesh(const derive::Derivation& object) {
    const auto mass = derive::massOf(object);
    if (!mass) return Error{Error::Kind::Internal, "the object has no solid"};
    mesh::PackedMesh box;
    for (uint32_t face = 0; face < derive::faceCount; ++face) {
        const Vec3d out = derive::faceDirection(face);
        const Vec3d u{out.y, out.z, out.x}, v = cross(out, u);
        const auto first = static_cast<uint32_t>(box.positions.size());
        for (const auto& [a, b] : {std::pair(-1, -1), {1, -1}, {1, 1}, {-1, 1}}) {
            box.positions.push_back(mass->box.point(out + u * a + v * b).as<float>());
            box.normals.push_back((mass->box.axes * out).as<float>());
        }
        for (const mesh::Triangle t : {mesh::Triangle{0, 1, 2}, {0, 2, 3}}) {
            box.triangles.push_back(t + mesh::Triangle{first, first, first});
            box.origins.push_back(0);
            box.labels.push_back(0);
        }
    }
    ObjectMesh made{mesh::unpack(box), {}};
    made.provenance.materials = {object.materials[mass->material == derive::none ? 0 : mass->material]};
    return made;
}

/// The chunks of a cell's blocks, made with their lower neighbours, as one mesh; the indices of the cell's triangles.
mesh::PackedMesh packed(std::vector<mesh::Chunk> chunks, const std::function<bool(Vec3i)>& isOwn,
                        std::vector<uint32_t>& own) {
    mesh::PackedMesh mesh;
    mesh::Numbering numbering;
    static_cast<void>(numbering.add(chunks));
    for (mesh::Chunk& chunk : chunks) {
        mesh.positions.insert(mesh.positions.end(), chunk.positions.begin(), chunk.positions.end());
        if (!isOwn(chunk.block)) continue;
        mesh::numberGhosts(chunks, chunk);
        for (size_t t = 0; t < chunk.triangles.size(); ++t) {
            own.push_back(static_cast<uint32_t>(mesh.triangles.size()));
            mesh.triangles.push_back(chunk.inMesh(chunk.triangles[t]));
            mesh.origins.push_back(chunk.origins[t]);
        }
    }
    return mesh;
}

}  // namespace

int Bake::detailOf(int level) const {
    if (level == 0) return finest;
    return level == 1 && request_.levels > 2 ? coarser : masses;
}

Result<Bake> Bake::begin(const Model& model, const BakeRequest& request, Context& context) {
    const double blocks = request.side_m / request.cell_m / mesh::blockCells;
    if (std::abs(blocks - std::round(blocks)) > 1e-9 || blocks < 1)
        return Error{
            Error::Kind::Usage,
            fmt::format("the side of a cell, {} m, has to be a multiple of {} cells of the ground's grid, {} m",
                        request.side_m, mesh::blockCells, mesh::blockCells * request.cell_m)};
    Bake bake(model, request, context);
    if (const Status s = bake.layOut(context); !s.ok()) return s.error();
    return bake;
}

Status Bake::layOut(Context& context) {
    if (const Status s = objects_.derive(); !s.ok()) return s;
    auto places = objects_.places(request_.budget.shapes);
    if (!places.ok()) return places.error();
    places_ = std::move(*places);
    std::vector<Cell> cells;
    std::set<uint32_t> used;
    for (uint32_t i = 0; i < places_.size(); ++i) {
        if (objects_[places_[i].object].derivation->terminals() == 0) continue;
        const Vec3d at = places_[i].part.pose.origin;
        const Cell cell = tiles::cellAt(at.x, at.z, request_.side_m);
        placesOf_[cell].push_back(i);
        cells.push_back(cell);
        used.insert(places_[i].object);
    }
    if (const Box3f& box = model_.lowered->field.bounds; !box.empty()) {
        const double margin = 2 * request_.cell_m;
        const Cell lo = tiles::cellAt(box.lo.x - margin, box.lo.z - margin, request_.side_m);
        const Cell hi = tiles::cellAt(box.hi.x + margin, box.hi.z + margin, request_.side_m);
        const double count = (double(hi.x) - lo.x + 1) * (double(hi.z) - lo.z + 1);
        if (count > 1e6)
            return Error{
                Error::Kind::Budget,
                fmt::format("the ground has {:.0f} cells of {} m; take larger ones (--side)", count, request_.side_m)};
        for (int z = lo.z; z <= hi.z; ++z)
            for (int x = lo.x; x <= hi.x; ++x) cells.push_back({0, x, z});
    }
    plan_.model = digestOf(model_.derivation, request_);
    plan_.name = fs::path(model_.derivation.grammar->sources[0]->name()).stem().string();
    plan_.side_m = request_.side_m;
    plan_.cell_m = request_.cell_m;
    plan_.objectCell_m = request_.objectCell_m;
    for (int level = 0; level < request_.levels; ++level)
        plan_.errors_m.push_back(level == 0                   ? 0
                                 : detailOf(level) == coarser ? 2 * coarserBy * request_.objectCell_m
                                                              : 4.0 * (1 << level));
    plan_.cells = tiles::pyramidOver(std::move(cells), request_.levels);
    plan_.objects = used.size();
    plan_.places = places_.size();
    return cancelled(context.progress) ? Status(cancelledError()) : Status(Done{});
}

std::vector<int> Bake::missing(int of) const {
    std::set<int> tasks;
    for (size_t i = 0; i < plan_.cells.size(); ++i)
        if (!tiles::isDone(request_.folder, plan_.cells[i]))
            tasks.insert(tiles::Share::taskOf(i, plan_.cells.size(), of));
    return {tasks.begin(), tasks.end()};
}

/// The name of the object's file in the library, which is made where it isn't there.
Result<std::string> Bake::libraryFile(uint32_t object, int level, Context& context) {
    const PlacedModel& placed = objects_[object];
    const uint64_t a = placed.inputs.hash(), b = combine(hashText(plan_.model), a);
    const std::string name = fmt::format("{:016x}{:016x}-{}.glb", a, b, level);
    const fs::path file = request_.folder / "lib" / name;
    std::error_code ignored;
    if (!fs::exists(file, ignored))
        if (const Status s = bakeObject(object, level, file, context); !s.ok()) return s.error();
    return name;
}

Status Bake::bakeObject(uint32_t object, int level, const fs::path& file, Context& context) {
    const PlacedModel& placed = objects_[object];
    SceneRequest request;
    request.meshing.surface = mesh::Surface::Crisp;
    request.cell_m = level == finest ? request_.objectCell_m : coarserBy * request_.objectCell_m;
    auto made = level == masses ? massMesh(*placed.derivation) : meshObject(*placed.derivation, request, context);
    if (!made.ok() && level == coarser) made = massMesh(*placed.derivation);  // too thin for such cells
    if (!made.ok()) return made.error();
    exporter::ExportInput input;
    input.mesh = &made->mesh;
    input.provenance = &made->provenance;
    input.name = objects_.nameOf(placed);
    for (const auto& [name, value] : objects_.valuesOf(placed)) input.extras[name] = value;
    if (level == masses) input.options = {{"uv", "none"}};
    return exporter::write(input, file);
}

Result<std::vector<tiles::GroundPiece>> Bake::ground(const Cell& cell, Context& context) const {
    const Box3f& box = model_.lowered->field.bounds;
    if (box.empty()) return std::vector<tiles::GroundPiece>{};
    const double pitch = request_.cell_m * (1 << cell.level), side = cell.side_m(request_.side_m);
    const double top = request_.side_m * (1 << (request_.levels - 1)), margin = 2 * pitch;
    const auto below = [](double v, double step) { return std::floor(v / step) * step; };
    mesh::Grid grid;
    grid.cell_m = static_cast<float>(pitch);
    const Vec3d origin{below(box.lo.x - margin, top), below(box.lo.y - margin, pitch), below(box.lo.z - margin, top)};
    grid.origin = origin.as<float>();
    const auto cells = [&](double hi, double lo) { return static_cast<int>(std::ceil((hi + margin - lo) / pitch)); };
    grid.cells = {cells(box.hi.x, origin.x), cells(box.hi.y, origin.y), cells(box.hi.z, origin.z)};
    const int blocks = static_cast<int>(std::lround(side / pitch / mesh::blockCells));
    const Vec3d corner = cell.centre(request_.side_m) - Vec3d{side / 2, 0, side / 2};
    const auto blockAt = [&](double at, double from) {
        return static_cast<int>(std::lround((at - from) / (pitch * mesh::blockCells)));
    };
    const int x = blockAt(corner.x, origin.x), z = blockAt(corner.z, origin.z);
    const auto isOwn = [=](Vec3i b) { return b.x >= x && b.x < x + blocks && b.z >= z && b.z < z + blocks; };
    mesh::RegionFilter filter;
    filter.skips = [=](std::span<const Vec3i> indices, int size) {
        uint64_t skipped = 0;
        for (size_t i = 0; i < indices.size(); ++i) {
            const int x0 = indices[i].x * size, z0 = indices[i].z * size;  // the ring below lends vertices
            const bool touches = x0 < x + blocks && x0 + size > x - 1 && z0 < z + blocks && z0 + size > z - 1;
            if (!touches) skipped |= uint64_t{1} << i;
        }
        return skipped;
    };
    mesh::Counts counts;
    const auto found = mesh::subdivide(model_.tape, grid, context.threads, nullptr, counts, filter);
    if (!found.ok()) return found.error();
    mesh::PolygonizeOptions options{.surface = mesh::Surface::Crisp, .threads = context.threads};
    auto chunks = mesh::meshBlocks(*found, grid, options, nullptr, counts);
    if (!chunks.ok()) return chunks.error();
    std::vector<uint32_t> own;
    const mesh::PackedMesh mesh = packed(std::move(*chunks), isOwn, own);
    return tiles::groundPieces(mesh, own, model_.lowered->provenance, cell.centre(request_.side_m),
                               static_cast<float>(pitch / 20));
}

Result<tiles::CellFigures> Bake::bakeCell(const Cell& cell, Context& context) {
    tiles::CellContent content;
    content.centre = cell.centre(request_.side_m);
    content.materials = model_.lowered->provenance.materials;
    auto pieces = ground(cell, context);
    if (!pieces.ok()) return pieces.error();
    content.ground = std::move(*pieces);
    std::map<uint32_t, std::vector<tiles::CellPlace>> byObject;
    const int reach = 1 << cell.level;
    for (int dz = 0; dz < reach; ++dz)
        for (int dx = 0; dx < reach; ++dx)
            if (const auto places = placesOf_.find({0, cell.x * reach + dx, cell.z * reach + dz});
                places != placesOf_.end())
                for (const uint32_t i : places->second)
                    byObject[places_[i].object].push_back({places_[i].part.pose, places_[i].part});
    for (auto& [object, places] : byObject) {
        const auto name = libraryFile(object, detailOf(cell.level), context);
        if (!name.ok()) return name.error();
        content.objects.push_back({"../../lib/" + *name, request_.folder / "lib" / *name,
                                   objects_.valuesOf(objects_[object]), std::move(places)});
    }
    return tiles::writeCell(content, library_, tiles::contentFile(request_.folder, cell));
}

Status Bake::run(const tiles::Share& share, Context& context,
                 const std::function<void(const Cell&, const tiles::CellFigures&)>& told) {
    std::error_code ignored;
    fs::create_directories(request_.folder / "lib", ignored);
    for (int level = 0; level < request_.levels; ++level)
        fs::create_directories(request_.folder / "cells" / std::to_string(level), ignored);
    if (const Status s = tiles::keepPlan(plan_, request_.folder); !s.ok()) return s;
    const auto [begin, end] = share.range(plan_.cells.size());
    if (context.progress) context.progress->begin("bake", end - begin);
    return context.timed("bake", [&]() -> Status {
        for (size_t i = begin; i < end; ++i) {
            if (cancelled(context.progress)) return cancelledError();
            if (!tiles::isDone(request_.folder, plan_.cells[i])) {
                Context own{nullptr, context.threads};
                const auto figures = bakeCell(plan_.cells[i], own);
                if (!figures.ok()) return figures.error();
                if (const Status s = tiles::noteCell(request_.folder, plan_.cells[i], *figures); !s.ok()) return s;
                if (told) told(plan_.cells[i], *figures);
            }
            tick(context.progress);
        }
        return Done{};
    });
}

}  // namespace sgm::pipeline
