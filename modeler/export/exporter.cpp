#include "modeler/export/exporter.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <new>

#include "modeler/core/atomic_file.h"
#include "modeler/core/lower_case.h"
#include "modeler/export/formats.h"

namespace sgm::exporter {
namespace {

/// Every format, in the order of docs/reference.md.
const auto& table() {
#define SGM_LIST(name) name##Format,
    static const std::array rows{SGM_FORMATS(SGM_LIST)};
#undef SGM_LIST
    return rows;
}

/// `parts`, each turned to text by `name`, with `separator` between them.
template <class Parts, class Name>
std::string joined(const Parts& parts, std::string_view separator, Name name) {
    std::string text;
    for (const auto& part : parts) {
        if (!text.empty()) text += separator;
        text += name(part);
    }
    return text;
}

/// True when `choices` ("y|z") has `value`; every value will do where there are none.
bool allowed(std::string_view choices, std::string_view value) {
    if (choices.empty()) return true;
    for (size_t begin = 0; begin <= choices.size();) {
        const size_t end = std::min(choices.find('|', begin), choices.size());
        if (choices.substr(begin, end - begin) == value) return true;
        begin = end + 1;
    }
    return false;
}

/// Why the option doesn't take `value`, "" where it does.
std::string refusal(const ExportOption& option, const std::string& value) {
    if (!allowed(option.choices, value)) return fmt::format("is one of {}, not '{}'", option.choices, value);
    if (option.lo >= option.hi) return {};
    const std::optional<double> number = numberOf(value);
    if (!number) return fmt::format("is a number, not '{}'", value);
    if (*number < option.lo || *number > option.hi)
        return fmt::format("is from {} to {}, not {}", option.lo, option.hi, value);
    return {};
}

Error bareError(const Path& path) { return writeError(path, "the mesh has no normals and origins"); }

Status checkInput(const ExportInput& input, const Exporter& row, const Path& path) {
    if (row.wantsVolume && !input.volume) return writeError(path, "there is no volume");
    if (row.wantsSolids && !input.solids) return writeError(path, "there is no solid tree");
    if (row.wantsPlan && (!input.plan || input.plan->empty()))
        return writeError(path, "the model has no plan: it is what 'network' and 'lots' lay out");
    const bool isEmpty = !input.mesh || input.mesh->triangleCount() == 0;
    if (row.wantsMesh() && isEmpty && !(input.mesh && input.scene && !input.scene->empty()))
        return writeError(path, "the mesh has no triangles");
    if (Status status = checkOptions(row, input.options); !status.ok()) return status;
    if (input.mesh && !takesPositionsOnly(row, input.options) && input.mesh->hasPositionsOnly()) return bareError(path);
    return Done{};
}

/// The format of a path.
Result<const Exporter*> rowFor(const Path& path) {
    if (const Exporter* const row = exporterFor(path)) return row;
    return Error{Error::Kind::Usage, fmt::format("no format for '{}'; the extensions are {}", path.string(),
                                                 joined(table(), " ", [](const Exporter& e) { return e.extension; }))};
}

/// Replaces the file by what fill(input, temporary) writes; the input has a provenance then.
template <class Fill>
Status replaced(const ExportInput& input, const Path& path, Fill fill) {
    const Provenance nobody;
    ExportInput complete = input;
    if (!complete.provenance) complete.provenance = &nobody;
    try {
        return replaceFile(path, [&](const Path& temporary) { return fill(complete, temporary); });
    } catch (const std::bad_alloc&) {
        return Error{Error::Kind::Budget, fmt::format("cannot write '{}': out of memory", path.string())};
    } catch (const std::exception& e) {
        return writeError(path, e.what());
    }
}

}  // namespace

Status checkOptions(const Exporter& row, const ExportOptions& options) {
    if (row.needs && !isBuiltWith(*row.needs)) return missingPackage(*row.needs, std::string(row.extension));
    for (const auto& [name, value] : options) {
        const auto known = std::find_if(row.options.begin(), row.options.end(),
                                        [&name = name](const ExportOption& o) { return o.name == name; });
        if (known == row.options.end())
            return Error{Error::Kind::Usage,
                         fmt::format("{} has no option '{}'; it has: {}", row.extension, name,
                                     joined(row.options, ", ", [](const ExportOption& o) { return o.name; }))};
        if (const std::string why = refusal(*known, value); !why.empty())
            return Error{Error::Kind::Usage, fmt::format("option '{}' of {} {}", name, row.extension, why)};
        if (known->grid.empty() || value == known->fallback) continue;
        const auto given = options.find("grids");
        const auto usual = std::ranges::find(row.options, std::string_view("grids"), &ExportOption::name);
        if ((given == options.end() ? usual->fallback : given->second).find(known->grid) == std::string_view::npos)
            return Error{Error::Kind::Usage,
                         fmt::format("option '{0}' of {1} is about {2}, and the file holds none: add grids={2}", name,
                                     row.extension, known->grid)};
    }
    return Done{};
}

std::span<const Exporter> exporters() { return table(); }

bool holdsColliders(const Exporter& row) {
    return std::any_of(row.options.begin(), row.options.end(),
                       [](const ExportOption& o) { return o.name == "engine"; });
}

bool takesPositionsOnly(const Exporter& row, const ExportOptions& options) {
    return row.takesPositionsOnly && row.takesPositionsOnly(options);
}

const Exporter* findExporter(std::string_view extension) {
    const std::string lower = lowerCase(std::string(extension));
    const auto row =
        std::find_if(table().begin(), table().end(), [&](const Exporter& e) { return e.extension == lower; });
    return row == table().end() ? nullptr : row;
}

const Exporter* exporterFor(const Path& path) {
    const std::string name = lowerCase(path.filename().string());
    const auto row = std::find_if(table().begin(), table().end(), [&](const Exporter& e) {
        return name.size() > e.extension.size() && name.ends_with(e.extension);
    });
    return row == table().end() ? nullptr : row;
}

std::vector<Path> filesOf(const Path& path) {
    const Exporter* const row = exporterFor(path);
    return row && row->beside ? std::vector{path, row->beside(path)} : std::vector{path};
}

Status write(const ExportInput& input, const Path& path) {
    const auto row = rowFor(path);
    if (!row.ok()) return row.error();
    if (Status status = checkInput(input, **row, path); !status.ok()) return status;
    if (input.scene && (*row)->wantsMesh() && !(*row)->holdsScenes) {
        const auto flat = mesh::flatten(*input.scene, *input.mesh);
        if (!flat.ok()) return flat.error();
        ExportInput one = input;
        one.scene = nullptr;
        one.mesh = &flat->mesh;
        one.provenance = &flat->provenance;
        return write(one, path);
    }
    return replaced(input, path, [&](const ExportInput& complete, const Path& temporary) {
        return (*row)->write(complete, temporary, path);
    });
}

Status writeStreamed(const ExportInput& input, const ChunkSource& chunks, const Path& path) {
    const auto row = rowFor(path);
    if (!row.ok()) return row.error();
    if (!(*row)->stream)
        return Error{Error::Kind::Usage, fmt::format("{} wants the whole mesh; chunk by chunk there are {}",
                                                     (*row)->extension, streamedExtensions())};
    if (Status status = checkOptions(**row, input.options); !status.ok()) return status;
    return replaced(input, path, [&](const ExportInput& complete, const Path& temporary) -> Status {
        uint64_t triangles = 0;
        const bool whole = !takesPositionsOnly(**row, input.options);
        const ChunkSource counted = [&](const mesh::ChunkVisitor& visit) {
            return chunks([&](const mesh::Mesh& window, const mesh::Chunk& chunk) -> Status {
                triangles += chunk.triangles.size();
                if (whole && chunk.hasPositionsOnly()) return bareError(path);
                return visit(window, chunk);
            });
        };
        if (Status status = (*row)->stream(complete, counted, temporary, path); !status.ok()) return status;
        if (triangles == 0) return writeError(path, "the mesh has no triangles");
        return Done{};
    });
}

std::string leveledExtensions() {
    std::vector<std::string_view> extensions;
    for (const Exporter& e : table())
        if (e.holdsLevels) extensions.push_back(e.extension);
    return joined(extensions, " ", [](std::string_view e) { return e; });
}

std::string streamedExtensions() {
    std::vector<std::string_view> extensions;
    for (const Exporter& e : table())
        if (e.stream) extensions.push_back(e.extension);
    return joined(extensions, " ", [](std::string_view e) { return e; });
}

}  // namespace sgm::exporter
