#include "viewer/document/export_job.h"

#include <fmt/format.h>

#include "grammar/lower/solid_tree.h"
#include "modeler/core/atomic_file.h"
#include "modeler/core/guarded.h"
#include "modeler/mesh/simplify.h"
#include "modeler/volume/keep.h"
#include "viewer/document/meshing.h"

namespace sgm::viewer {
namespace fs = std::filesystem;
namespace {

Status writeSolids(const Shown& shown, const ExportRequest& request, Progress& progress) {
    const auto tree = lower::solidTree(shown.model.derivation, *shown.model.lowered, &progress);
    if (!tree.ok()) return tree.error();
    exporter::ExportInput input = exportInput(shown.model, shown.grammar->sources[0]->name());
    input.solids = &*tree;
    input.options = request.options;
    input.progress = &progress;
    return exporter::write(input, request.file);
}

Status write(const Shown& shown, const ExportRequest& request, const exporter::Exporter& format, Progress& progress) {
    if (format.wantsSolids) return writeSolids(shown, request, progress);
    const auto division = divide(shown.model, format.holdsObjects ? request.objects : "");
    if (!division.ok()) return division.error();
    const Box3f& bounds = shown.model.lowered->field.bounds;
    const float cell_m =
        request.cell_m > 0 ? static_cast<float>(request.cell_m) : mesh::cellFor(bounds, request.resolution);
    Stages stages;
    const mesh::PolygonizeOptions options{.surface = mesh::Surface::Crisp,
                                          .threads = request.threads,
                                          .bare = exporter::takesBare(format, request.options)};
    auto meshed = makeMesh(shown.model, mesh::gridFor(bounds, cell_m), options, stages, &progress);
    if (!meshed.ok()) return meshed.error();
    mesh::keepOnly(meshed->mesh, request.keep, cell_m, request.threads);
    if (meshed->mesh.triangleCount() == 0) return noSurface(shown.model, cell_m);
    auto simple = mesh::simplify(meshed->mesh, {mesh::usualTolerance(cell_m), request.threads}, &progress);
    if (!simple.ok()) return simple.error();
    meshed->mesh = std::move(*simple);
    exporter::ExportInput input = exportInput(shown.model, shown.grammar->sources[0]->name());
    input.mesh = &meshed->mesh;
    division->applyTo(input);
    input.options = request.options;
    input.progress = &progress;
    std::optional<volume::Volume> level;
    if (format.wantsVolume) {
        auto sampled = levelSet(shown.model, *meshed, request.threads, &progress);
        if (!sampled.ok()) return sampled.error();
        if (const Status s = volume::keepOnly(*sampled, request.keep, cell_m, &progress); !s.ok()) return s;
        input.volume = &level.emplace(std::move(*sampled));
    }
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

Status ExportJob::start(std::shared_ptr<const Shown> shown, ExportRequest request, std::function<void()> wake) {
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
    thread_ = std::thread([this, shown = std::move(shown), request = std::move(request), format, wake = std::move(wake),
                           progress = progress_] {
        outcome_ = guarded([&] { return write(*shown, request, *format, *progress); });
        done_ = true;
        if (wake) wake();
    });
    return Done{};
}

std::optional<Status> ExportJob::take() {
    if (!done_ || !thread_.joinable()) return std::nullopt;
    thread_.join();
    return std::exchange(outcome_, std::nullopt);
}

}  // namespace sgm::viewer
