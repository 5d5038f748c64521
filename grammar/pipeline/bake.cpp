#include "grammar/pipeline/bake.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <tuple>

#include "grammar/pipeline/bake_digest.h"
#include "modeler/core/atomic_file.h"
#include "modeler/core/pages.h"
#include "modeler/export/exporter.h"

namespace sgm::pipeline {
namespace {

namespace fs = std::filesystem;
using tiles::Cell;

/// Objects made between two releases of unused memory: a release takes some milliseconds.
constexpr size_t objectsPerRelease = 8;

/// Adds the time of its life to a sum.
class Added {
public:
    explicit Added(double& sum) : sum_(sum) {}
    ~Added() { sum_ += watch_.seconds(); }
    Added(const Added&) = delete;
    Added& operator=(const Added&) = delete;

private:
    double& sum_;
    const Stopwatch watch_;
};

/// Orders cells so that those of all levels in one coarsest cell come together: what is known of their ground is then
/// found once.
void inSquares(std::vector<Cell>& cells, int levels) {
    const auto placeOf = [&](const Cell& cell) {
        Cell coarsest = cell;
        while (coarsest.level < levels - 1) coarsest = coarsest.parent();
        return std::tuple(coarsest.morton(), -cell.level, cell.morton());
    };
    std::sort(cells.begin(), cells.end(), [&](const Cell& a, const Cell& b) { return placeOf(a) < placeOf(b); });
}

}  // namespace

Bake::Bake(const Model& model, const BakeRequest& request, Context& context)
    : model_(model),
      request_(request),
      objects_(std::make_unique<PlacedModels>(model.derivation, request.budget, context)),
      ground_(model, {request.side_m, request.cell_m, request.levels}),
      parts_(model, request.side_m),
      library_(*objects_, request.folder / "lib", request.objectCell_m, request.packing) {}

Detail Bake::detailOf(int level) const {
    if (level == 0) return Detail::Finest;
    return level == 1 && request_.levels > 2 ? Detail::Coarse : Detail::Mass;
}

Result<Bake> Bake::begin(const Model& model, const BakeRequest& request, Context& context) {
    const double blocks = request.side_m / request.cell_m / mesh::blockCells;
    if (std::abs(blocks - std::round(blocks)) > 1e-9 || blocks < 1)
        return Error{
            Error::Kind::Usage,
            fmt::format("the side of a cell, {} m, has to be a multiple of {} cells of the ground's grid, {} m",
                        request.side_m, mesh::blockCells, mesh::blockCells * request.cell_m)};
    Bake bake(model, request, context);
    if (const Status s = bake.ground_.check(); !s.ok()) return s.error();
    if (const Status s = bake.layOut(context); !s.ok()) return s.error();
    bake.ground_.prepare();
    return bake;
}

/// The cells that the model's own surface may reach.
Status Bake::addGroundCells(std::vector<Cell>& cells) const {
    const Box3f& box = model_.lowered->field.bounds;
    if (box.empty()) return Done{};
    const double margin = 2 * request_.cell_m;
    const Cell lo = tiles::cellAt(box.lo.x - margin, box.lo.z - margin, request_.side_m);
    const Cell hi = tiles::cellAt(box.hi.x + margin, box.hi.z + margin, request_.side_m);
    const double count = (double(hi.x) - lo.x + 1) * (double(hi.z) - lo.z + 1);
    if (count > 1e6)
        return Error{Error::Kind::Budget, fmt::format("the ground has {:.0f} cells of {} m; take larger ones (--side)",
                                                      count, request_.side_m)};
    for (int z = lo.z; z <= hi.z; ++z)
        for (int x = lo.x; x <= hi.x; ++x) cells.push_back({0, x, z});
    return Done{};
}

Status Bake::layOut(Context& context) {
    if (const Status s = objects_->derive(); !s.ok()) return s;
    auto places = objects_->places(request_.budget.shapes);
    if (!places.ok()) return places.error();
    places_ = std::move(*places);
    std::vector<Cell> cells;
    std::set<uint32_t> used;
    for (uint32_t i = 0; i < places_.size(); ++i) {
        if ((*objects_)[places_[i].object].derivation->terminals() == 0) continue;
        const Vec3d at = places_[i].part.pose.origin;
        const Cell cell = tiles::cellAt(at.x, at.z, request_.side_m);
        auto& here = placesOf_[cell];
        if (here.empty()) cells.push_back(cell);
        here.push_back(i);
        used.insert(places_[i].object);
    }
    if (const Status s = addGroundCells(cells); !s.ok()) return s;
    plan_.model = digestOf(model_.derivation, request_);
    plan_.name = fs::path(model_.derivation.grammar->sources[0]->name()).stem().string();
    plan_.side_m = request_.side_m;
    plan_.cell_m = request_.cell_m;
    plan_.objectCell_m = request_.objectCell_m;
    for (int level = 0; level < request_.levels; ++level)
        plan_.errors_m.push_back(level == 0                          ? 0
                                 : detailOf(level) == Detail::Coarse ? 2 * library_.coarseError_m()
                                                                     : 4.0 * (1 << level));
    plan_.cells = tiles::pyramidOver(std::move(cells), request_.levels);
    plan_.objects = used.size();
    plan_.places = places_.size();
    library_.setModel(plan_.model);
    std::vector<std::pair<std::string, uint32_t>> named;
    for (const uint32_t object : used) named.emplace_back(library_.nameOf(object, Detail::Finest), object);
    std::sort(named.begin(), named.end());
    for (const auto& [name, object] : named) used_.push_back(object);
    if (request_.seeksThinParts) library_.inspectFirstOfEachStart();
    return cancelled(context.progress) ? Status(cancelledError()) : Status(Done{});
}

std::vector<MeshWarning> Bake::warnings() const {
    std::vector<MeshWarning> all = parts_.warnings(request_.cell_m);
    const std::vector<MeshWarning> ofObjects = library_.warnings();
    all.insert(all.end(), ofObjects.begin(), ofObjects.end());
    return all;
}

std::vector<int> Bake::missing(int of) const {
    std::set<int> tasks;
    for (size_t i = 0; i < plan_.cells.size(); ++i)
        if (!tiles::isDone(request_.folder, plan_.cells[i]))
            tasks.insert(tiles::Share::taskOf(i, plan_.cells.size(), of));
    return {tasks.begin(), tasks.end()};
}

Status Bake::makeObject(uint32_t object, int level, Context& context) {
    const Added time(times_.objects);
    return library_.make(object, detailOf(level), context);
}

Result<tiles::CellFigures> Bake::bakeCell(const Cell& cell, std::vector<tiles::SurfacePiece> ground, Context& context) {
    tiles::CellContent content;
    content.centre = cell.centre(request_.side_m);
    content.packing = request_.packing;
    content.materials = model_.lowered->provenance.materials;
    content.ground = std::move(ground);
    content.groundGrid = ground_.placesOf(cell);
    std::map<uint32_t, std::vector<tiles::CellPlace>> byObject;
    const int reach = 1 << cell.level;
    for (int dz = 0; dz < reach; ++dz)
        for (int dx = 0; dx < reach; ++dx)
            if (const auto places = placesOf_.find({0, cell.x * reach + dx, cell.z * reach + dz});
                places != placesOf_.end())
                for (const uint32_t i : places->second) byObject[places_[i].object].push_back({&places_[i].part});
    for (auto& [object, places] : byObject) {
        if (detailOf(cell.level) == Detail::Mass) {
            auto box = library_.boxOf(object, *places.front().part);
            if (!box.ok()) return box.error();
            for (const tiles::CellPlace& place : places) {
                box->part = place.part;
                content.boxes.push_back(*box);
            }
            continue;
        }
        if (const Status s = makeObject(object, cell.level, context); !s.ok()) return s.error();
        const std::string name = library_.nameOf(object, detailOf(cell.level));
        content.objects.push_back({"../../lib/" + name, request_.folder / "lib" / name,
                                   objects_->valuesOf((*objects_)[object]), std::move(places)});
    }
    const Added time(times_.cells);
    return tiles::writeCell(content, opened_, tiles::contentFile(request_.folder, cell));
}

Status Bake::makeFolders() const {
    std::error_code failed;
    fs::create_directories(request_.folder / "lib", failed);
    for (int level = 0; level < request_.levels && !failed; ++level)
        fs::create_directories(request_.folder / "cells" / std::to_string(level), failed);
    if (failed) return writeError(request_.folder, failed.message());
    if (const Status s = tiles::keepPlan(plan_, request_.folder); !s.ok()) return s;
    const auto& materials = model_.lowered->provenance.materials;
    if (const Status s = tiles::writePictures(materials, request_.folder / "lib" / "textures"); !s.ok()) return s;
    const fs::path plan = request_.folder / "plan.geojson";
    if (model_.derivation.plan.empty() || fs::exists(plan, failed)) return Done{};
    exporter::ExportInput input;
    input.plan = &model_.derivation.plan;
    return exporter::write(input, plan);
}

Status Bake::makeObjects(const tiles::Share& share, Context& context) {
    const auto [begin, end] = share.range(used_.size());
    if (context.progress) context.progress->begin("objects", end - begin);
    for (size_t i = begin; i < end; ++i) {
        if (cancelled(context.progress)) return cancelledError();
        if ((i - begin) % objectsPerRelease == 0) releasePages(), releaseHeap();  // what they leave unused would add up
        Context own{nullptr, context.threads};
        for (int level = 0; level < std::min(request_.levels, 2); ++level)
            if (const Status s = makeObject(used_[i], level, own); !s.ok()) return s;
        tick(context.progress);
    }
    return Done{};
}

Status Bake::runCells(const std::vector<size_t>& cells, Context& context, const CellVisitor& told) {
    if (const Status s = makeFolders(); !s.ok()) return s;
    if (context.progress) context.progress->begin("cells", cells.size());
    std::vector<Cell> open;
    for (const size_t i : cells)
        if (tiles::isDone(request_.folder, plan_.cells[i]))
            tick(context.progress);
        else
            open.push_back(plan_.cells[i]);
    inSquares(open, request_.levels);
    std::map<Cell, std::vector<tiles::SurfacePiece>> ground;
    while (!open.empty()) {
        const std::vector<Cell> group = ground_.groupOf(open);
        if (group.front().level > 0) releasePages(), releaseHeap();  // what groups leave unused would add up
        Context own{nullptr, context.threads};
        {
            const Added time(times_.ground);
            auto made = ground_.make(group, request_.seeksThinParts ? &parts_ : nullptr, own);
            if (!made.ok()) return made.error();
            ground = std::move(*made);
        }
        for (const Cell& cell : group) {
            if (cancelled(context.progress)) return cancelledError();
            const auto figures = bakeCell(cell, std::move(ground[cell]), own);
            if (!figures.ok()) return figures.error();
            if (const Status s = tiles::noteCell(request_.folder, cell, *figures); !s.ok()) return s;
            if (told) told(cell, *figures);
            tick(context.progress);
        }
        std::erase_if(open,
                      [&](const Cell& c) { return ground.contains(c) || std::count(group.begin(), group.end(), c); });
    }
    return Done{};
}

Status Bake::run(const tiles::Share& share, Context& context, const CellVisitor& told) {
    if (const Status s = makeFolders(); !s.ok()) return s;
    const Status made = context.timed("objects", [&] { return makeObjects(share, context); });
    if (!made.ok()) return made;
    const auto [begin, end] = share.range(plan_.cells.size());
    std::vector<size_t> cells(end - begin);
    std::iota(cells.begin(), cells.end(), begin);
    return context.timed("cells", [&] { return runCells(cells, context, told); });
}

}  // namespace sgm::pipeline
