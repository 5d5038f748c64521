#include "cli/outputs.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>

#include "cli/renamed.h"
#include "cli/validators.h"
#include "grammar/lower/objects.h"
#include "grammar/lower/solid_tree.h"
#include "grammar/rules/words.h"
#include "modeler/mesh/proxy.h"

namespace sgm::cli {
namespace {

namespace fs = std::filesystem;
using exporter::Exporter;

const Exporter* formatOf(const std::string& file) { return exporter::exporterFor(file); }

Status checkFile(const std::string& file) {
    std::vector<std::string> known;
    for (const Exporter& e : exporter::exporters()) known.emplace_back(e.extension);
    if (!formatOf(file))
        return Error{Error::Kind::Usage, fmt::format("'{}': no format has the ending '{}'; there are {}", file,
                                                     fs::path(file).extension().string(), fmt::join(known, " "))};
    return Done{};
}

bool has(const Exporter& row, std::string_view name) {
    return std::any_of(row.options.begin(), row.options.end(),
                       [&](const exporter::ExportOption& o) { return o.name == name; });
}

/// Those of the options that the format has.
exporter::ExportOptions optionsFor(const OutputRequest& request, const Exporter& row) {
    exporter::ExportOptions options;
    for (const std::string& text : request.options) {
        const size_t equals = text.find('=');
        if (has(row, text.substr(0, equals))) options[text.substr(0, equals)] = text.substr(equals + 1);
    }
    return options;
}

/// Colliders need a file that holds them, and a file's names for colliders need some.
Status checkCollider(const OutputRequest& request) {
    const auto named = std::find_if(request.options.begin(), request.options.end(),
                                    [](const std::string& text) { return text.starts_with("engine="); });
    if (request.collider.empty()) {
        if (named == request.options.end()) return Done{};
        return Error{Error::Kind::Usage,
                     fmt::format("--format-option {} names colliders: add --collider boxes, convex or mesh", *named)};
    }
    if (request.collider == "mesh" && named != request.options.end() && *named == "engine=unreal")
        return Error{Error::Kind::Usage,
                     "--collider mesh: Unreal imports convex colliders alone; take boxes or convex"};
    if (std::any_of(request.files.begin(), request.files.end(),
                    [](const std::string& file) { return exporter::holdsColliders(*formatOf(file)); }))
        return Done{};
    return Error{Error::Kind::Usage,
                 fmt::format("--collider {}: colliders go into .glb and .gltf, and no such file is asked for",
                             request.collider)};
}

/// Objects need a file that holds them.
Status checkObjects(const OutputRequest& request) {
    const auto choice = lower::parseObjects(request.objects.empty() ? "material" : request.objects);
    if (!choice.ok()) return Error{Error::Kind::Usage, "--objects: " + choice.error().message};
    const auto instances = std::find_if(request.options.begin(), request.options.end(),
                                        [](const std::string& text) { return text.starts_with("instances="); });
    if (!choice->divides() && instances != request.options.end())
        return Error{
            Error::Kind::Usage,
            fmt::format(
                "--format-option {} is about objects: add --objects shape or the symbols whose shapes are objects",
                *instances)};
    if (request.objects.empty()) return Done{};
    const auto unreal = std::find(request.options.begin(), request.options.end(), "engine=unreal");
    if (choice->divides() && unreal != request.options.end())
        return Error{
            Error::Kind::Usage,
            fmt::format(
                "--objects {}: Unreal takes colliders by the name of one mesh; leave out the objects or the colliders",
                request.objects)};
    if (std::any_of(request.files.begin(), request.files.end(),
                    [](const std::string& file) { return formatOf(file)->holdsObjects; }))
        return Done{};
    std::vector<std::string> endings;
    for (const Exporter& e : exporter::exporters())
        if (e.holdsObjects) endings.emplace_back(e.extension);
    return Error{Error::Kind::Usage, fmt::format("--objects {}: objects go into {}, and no such file is asked for",
                                                 request.objects, fmt::join(endings, " "))};
}

/// Levels need a file that holds them, and an option about levels needs some.
Status checkLevels(const OutputRequest& request) {
    const auto said = std::find_if(request.options.begin(), request.options.end(),
                                   [](const std::string& text) { return text.starts_with("levels="); });
    if (request.lod == 1) {
        if (said == request.options.end()) return Done{};
        return Error{Error::Kind::Usage,
                     fmt::format("--format-option {} is about levels of detail: add --lod 3", *said)};
    }
    if (std::any_of(request.files.begin(), request.files.end(),
                    [](const std::string& file) { return formatOf(file)->holdsLevels; }))
        return Done{};
    return Error{Error::Kind::Usage, fmt::format("--lod {}: levels of detail go into {}, and no such file is asked for",
                                                 request.lod, exporter::leveledExtensions())};
}

/// An option that none of the files takes says so, rather than do nothing.
Status checkOption(const OutputRequest& request, const std::string& text) {
    const std::string name = text.substr(0, text.find('='));
    if (name.size() == text.size())
        return Error{Error::Kind::Usage, fmt::format("write --format-option NAME=VALUE instead of '{}'", text)};
    for (const std::string& file : allFiles(request))
        if (has(*formatOf(file), name)) return Done{};
    std::vector<std::string> endings, known;
    for (const Exporter& e : exporter::exporters()) {
        if (has(e, name)) endings.emplace_back(e.extension);
        for (const exporter::ExportOption& option : e.options) known.emplace_back(option.name);
    }
    const std::string near = rules::nearestHint(name, known);
    if (endings.empty())
        return Error{Error::Kind::Usage, fmt::format("--format-option {}: no format has that option; {}", text,
                                                     near.empty() ? "`sgm reference` lists them" : near)};
    return Error{Error::Kind::Usage, fmt::format("--format-option {}: an option of {}, and no such file is asked for",
                                                 text, fmt::join(endings, " "))};
}

}  // namespace

void addOutputOptions(CLI::App& command, OutputRequest& request) {
    command.add_option("-o,--output", request.files, "Output file, format by its ending; may be given again")
        ->allow_extra_args(false);
    command
        .add_option("--format-option", request.options,
                    "Option of a file format, NAME=VALUE (see `sgm reference`); may be given again")
        ->allow_extra_args(false);
    addRenamedOption(command, "--export", "--format-option", request.options);
    command
        .add_option("--objects", request.objects,
                    "Objects in .glb .gltf .obj .usda: none (one piece, colours alone), material (one object divided "
                    "by material), shape (every shape that shows), or the shapes of symbols: Storey,Window")
        ->option_text("none|material|shape|SYMBOL[,SYMBOL…] [material]");
    command
        .add_option(
            "--lod", request.lod,
            "Levels of detail, the finest included; each further one is off by twice as much: see docs/programs.md")
        ->check(wholeNumber(1, mesh::mostLevels))
        ->capture_default_str();
    command
        .add_option(
            "--collider", request.collider,
            "Add colliders to .glb and .gltf: boxes or convex parts made from the terminals, or the mesh, simplified")
        ->check(oneOf({"boxes", "convex", "mesh"}));
    auto* proxy = command.add_option(
        "--proxy", request.proxy,
        "Mesh file for a coarse closed mesh around the model; goes with the next version: see --collider");
    command
        .add_option("--proxy-tolerance", request.proxyTolerance_m,
                    "Metres the proxy may stand off (default: a twentieth of the longest side)")
        ->check(between(1e-6, 1e6))
        ->needs(proxy);
}

std::vector<std::string> allFiles(const OutputRequest& request) {
    std::vector<std::string> files = request.files;
    if (!request.proxy.empty()) files.push_back(request.proxy);
    return files;
}

Status checkMeshFile(const char* option, const std::string& file) {
    if (const Status s = checkFile(file); !s.ok()) return s;
    const Exporter& row = *formatOf(file);
    if (row.wantsMesh()) return Done{};
    const char* held = row.wantsVolume ? "volumes" : row.wantsPlan ? "plans" : "solid trees";
    return Error{Error::Kind::Usage,
                 fmt::format("{} {}: this is a mesh; '{}' holds {}", option, file, row.extension, held)};
}

Status checkOutputs(const OutputRequest& request) {
    for (const std::string& file : request.files)
        if (const Status s = checkFile(file); !s.ok()) return s;
    if (!request.proxy.empty()) {
        noteRenamed("--proxy", "--collider");
        if (const Status s = checkMeshFile("--proxy", request.proxy); !s.ok()) return s;
    }
    if (const Status s = checkCollider(request); !s.ok()) return s;
    if (const Status s = checkObjects(request); !s.ok()) return s;
    if (const Status s = checkLevels(request); !s.ok()) return s;
    for (const std::string& text : request.options)
        if (const Status s = checkOption(request, text); !s.ok()) return s;
    for (const std::string& file : allFiles(request))
        if (const Status s = exporter::checkOptions(*formatOf(file), optionsFor(request, *formatOf(file))); !s.ok())
            return s;
    return Done{};
}

bool wantsVolume(const OutputRequest& request) {
    return std::any_of(request.files.begin(), request.files.end(),
                       [](const std::string& file) { return formatOf(file)->wantsVolume; });
}

bool needsNoMesh(const OutputRequest& request) {
    return !request.files.empty() && request.proxy.empty() &&
           std::all_of(request.files.begin(), request.files.end(), [](const std::string& file) {
               return formatOf(file)->wantsSolids || formatOf(file)->wantsPlan;
           });
}

bool needsPositionsOnly(const OutputRequest& request) {
    return std::all_of(request.files.begin(), request.files.end(), [&](const std::string& file) {
        const Exporter& row = *formatOf(file);
        return exporter::takesPositionsOnly(row, optionsFor(request, row));
    });
}

Status checkStreamed(const OutputRequest& request) {
    if (request.files.size() != 1 || !request.proxy.empty())
        return Error{Error::Kind::Usage, "--stream writes one file, without a proxy: give a single -o"};
    if (formatOf(request.files[0])->stream) return Done{};
    return Error{Error::Kind::Usage,
                 fmt::format("--stream: {} wants the whole mesh; chunk by chunk there are {}",
                             formatOf(request.files[0])->extension, exporter::streamedExtensions())};
}

Status streamOutput(const OutputRequest& request, exporter::ExportInput input, const exporter::ChunkSource& chunks) {
    input.options = optionsFor(request, *formatOf(request.files[0]));
    return exporter::writeStreamed(input, chunks, request.files[0]);
}

Status writeMeshless(const OutputRequest& request, const Model& model, exporter::ExportInput input) {
    field::SolidTree tree;
    for (const std::string& file : request.files) {
        const Exporter& row = *formatOf(file);
        if (!row.wantsSolids && !row.wantsPlan) continue;
        input.plan = &model.derivation.plan;
        if (row.wantsSolids && tree.nodes.empty()) {
            auto collected = lower::solidTree(model.derivation, *model.lowered, input.progress);
            if (!collected.ok()) return collected.error();
            tree = std::move(*collected);
        }
        input.solids = &tree;
        input.options = optionsFor(request, row);
        if (const Status written = exporter::write(input, file); !written.ok()) return written;
    }
    return Done{};
}

Status writeOutputs(const OutputRequest& request, const Model& model, exporter::ExportInput input, int threads) {
    for (const std::string& file : request.files) {
        const Exporter& row = *formatOf(file);
        if (row.wantsSolids || row.wantsPlan) continue;
        input.options = optionsFor(request, row);
        if (const Status written = exporter::write(input, file); !written.ok()) return written;
    }
    if (request.proxy.empty()) return Done{};
    const Vec3f side = model.lowered->field.bounds.size();
    const double tolerance_m = request.proxyTolerance_m > 0
                                   ? request.proxyTolerance_m
                                   : static_cast<double>(std::max({side.x, side.y, side.z})) / 20;
    const auto own = lower::lower(model.derivation, input.progress);  // the proxy adds nodes to its graph
    if (!own.ok()) return own.error();
    const auto around = mesh::proxy((*own)->graph, (*own)->field, tolerance_m, threads, input.progress);
    if (!around.ok()) return around.error();
    input.mesh = &*around;
    input.colliders = {};
    input.objects = nullptr;  // the whole is one, around all of them
    input.levels = {};
    input.options = optionsFor(request, *formatOf(request.proxy));
    return exporter::write(input, request.proxy);
}

}  // namespace sgm::cli
