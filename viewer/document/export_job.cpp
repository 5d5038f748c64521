#include "viewer/document/export_job.h"

#include <fmt/format.h>

#include "grammar/pipeline/grids.h"
#include "grammar/pipeline/products.h"
#include "grammar/pipeline/scene.h"
#include "modeler/core/atomic_file.h"
#include "modeler/core/guarded.h"

namespace sgm::document {
namespace fs = std::filesystem;
namespace {

/// What every format is told of the model.
exporter::ExportInput inputOf(const BuiltModel& shown, const ExportRequest& request, Progress& progress) {
    exporter::ExportInput input = pipeline::exportInput(shown.model, shown.grammar->sources[0]->name());
    input.plan = &shown.model.derivation.plan;
    input.options = request.options;
    input.progress = &progress;
    return input;
}

Status writeSolids(const BuiltModel& shown, const ExportRequest& request, pipeline::Context& context) {
    const auto tree = pipeline::makeSolidTree(shown.model, context);
    if (!tree.ok()) return tree.error();
    exporter::ExportInput input = inputOf(shown, request, *context.progress);
    input.solids = &*tree;
    return exporter::write(input, request.file);
}

/// The model that a file holds: objects that are shown as copies or boxes in the field are meshed each by itself.
Result<pipeline::Model> modelOf(const BuiltModel& shown, bool apart, pipeline::Context& context) {
    if (apart) return pipeline::makeModel(shown.grammar, shown.options, context, pipeline::Objects::Apart);
    return pipeline::Model(shown.model);
}

Status write(const BuiltModel& shown, const ExportRequest& request, const exporter::Exporter& format,
             Progress& progress) {
    pipeline::Context context{&progress, request.threads};
    const derive::Derivation& derivation = shown.model.derivation;
    const bool apart = format.wantsMesh() && derivation.copies + derivation.masses > 0 && !shown.byHand;
    if (!apart && !format.wantsPlan && derivation.masses > 0)
        return Error{
            Error::Kind::Budget,
            fmt::format("'{}' holds one field, and the model's objects are shown as boxes in it; export a mesh, or "
                        "build with a greater --max-shapes",
                        request.file.string())};
    if (format.wantsSolids) return writeSolids(shown, request, context);
    if (format.wantsPlan) return exporter::write(inputOf(shown, request, progress), request.file);
    const auto model = modelOf(shown, apart, context);
    if (!model.ok()) return model.error();
    auto division = pipeline::divide(*model, format.holdsObjects ? request.objects : "");
    if (!division.ok()) return division.error();
    mesh::PolygonizeOptions meshing{.surface = mesh::Surface::Crisp};
    const mesh::Grid grid = pipeline::gridOver(*model, {request.resolution, request.cell_m}, meshing.surface);
    const float cell_m = grid.cell_m;
    meshing.positionsOnly = !apart && exporter::takesPositionsOnly(format, request.options);
    auto meshed = pipeline::makeMesh(*model, grid, meshing, context);
    if (!meshed.ok()) return meshed.error();
    const pipeline::MeshEdits edits{.keep = request.keep};
    mesh::keepOnly(meshed->mesh, edits.keep, cell_m, request.threads);
    const auto made = pipeline::makeScene(
        *model, {.resolution = request.resolution, .cell_m = request.cell_m, .meshing = meshing, .edits = edits},
        context);
    if (!made.ok()) return made.error();
    if (meshed->mesh.triangleCount() == 0 && made->scene.empty()) return pipeline::noSurface(*model, cell_m);
    auto mesh = pipeline::edited(std::move(meshed->mesh), edits, {model->tape, meshing.surface, cell_m}, context);
    if (!mesh.ok()) return mesh.error();
    pipeline::ProductRequest wanted;
    wanted.division = std::move(*division);
    wanted.levelSet = format.wantsVolume;
    wanted.edits = edits;
    wanted.meshing = meshing;
    const auto products = pipeline::makeProducts(*model, *meshed, std::move(*mesh), std::move(wanted), context);
    if (!products.ok()) return products.error();
    exporter::ExportInput input = inputOf(shown, request, progress);
    products->applyTo(input);
    if (!made->scene.empty()) input.scene = &made->scene, input.provenance = &made->scene.ground;
    return exporter::write(input, request.file);
}

}  // namespace

std::vector<ExportRow> exportRows(const exporter::Exporter& format) {
    std::vector<ExportRow> rows;
    for (const exporter::ExportOption& option : format.options) {
        ExportRow row{std::string(option.name),
                      std::string(option.doc),
                      std::string(option.fallback),
                      {},
                      option.lo < option.hi,
                      option.lo,
                      option.hi};
        for (size_t begin = 0; begin < option.choices.size();) {
            const size_t end = std::min(option.choices.find('|', begin), option.choices.size());
            row.choices.emplace_back(option.choices.substr(begin, end - begin));
            begin = end + 1;
        }
        rows.push_back(std::move(row));
    }
    return rows;
}

ExportJob::~ExportJob() {
    cancel();
    if (thread_.joinable()) thread_.join();
}

Status ExportJob::start(std::shared_ptr<const BuiltModel> shown, ExportRequest request, std::function<void()> notify) {
    if (thread_.joinable()) return Error{Error::Kind::Input, "another export is under way"};
    if (!shown) return Error{Error::Kind::Input, "there is no model to export yet"};
    const exporter::Exporter* format = exporter::exporterFor(request.file);
    if (!format)
        return Error{Error::Kind::Usage, fmt::format("'{}': no format has the ending '{}'", request.file.string(),
                                                     request.file.extension().string())};
    if (const Status s = exporter::checkOptions(*format, request.options); !s.ok()) return s;
    const fs::path folder = request.file.parent_path();
    if (std::error_code ignored; !folder.empty() && !fs::is_directory(folder, ignored))
        return Error{Error::Kind::Input,
                     fmt::format("'{}': the folder '{}' does not exist", request.file.string(), folder.string())};
    for (const fs::path& file : exporter::filesOf(request.file)) {
        if (const Status s = checkTarget(file); !s.ok()) return s;
        for (const fs::path& input : request.inputs)
            if (identityOf(file) == identityOf(input))
                return Error{
                    Error::Kind::Input,
                    fmt::format("'{}' is what the model is made from: give the export another name", file.string())};
    }
    progress_ = std::make_shared<Progress>();
    done_ = false;
    file_ = request.file;
    thread_ = std::thread([this, shown = std::move(shown), request = std::move(request), format,
                           notify = std::move(notify), progress = progress_] {
        outcome_ = guarded([&] { return write(*shown, request, *format, *progress); });
        done_ = true;
        if (notify) notify();
    });
    return Done{};
}

std::optional<Status> ExportJob::take() {
    if (!done_ || !thread_.joinable()) return std::nullopt;
    thread_.join();
    return std::exchange(outcome_, std::nullopt);
}

}  // namespace sgm::document
