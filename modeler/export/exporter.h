// The exporter table: one row a format.
// Enters: a mesh (or a level set, a solid tree, a town's plan) with its provenance. Leaves: a file, written beside its
// target and renamed into place, so that a good earlier file is never lost. Assumes metres, Y up; options say otherwise
// for formats that can't.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "modeler/core/object_tree.h"
#include "modeler/core/packages.h"
#include "modeler/core/progress.h"
#include "modeler/core/provenance.h"
#include "modeler/core/result.h"
#include "modeler/export/colliders.h"
#include "modeler/field/solid_tree.h"
#include "modeler/mesh/levels.h"
#include "modeler/mesh/polygonize.h"
#include "modeler/mesh/scene.h"
#include "modeler/town/town_plan.h"
#include "modeler/volume/volume.h"

namespace sgm::exporter {

/// One option of a format, for the export dialog and the reference page.
struct ExportOption {
    std::string_view name;
    std::string_view fallback;
    std::string_view choices;  ///< "y|z", or "" for free text or a number
    std::string_view doc;
    double lo = 0, hi = 0;       ///< a number in lo … hi where lo < hi
    std::string_view grid = "";  ///< that of the option `grids` without which it has no effect
};
/// Values by ExportOption::name.
using ExportOptions = std::map<std::string, std::string, std::less<>>;

/// What is written. `mesh` is set for mesh formats, `volume`, a level set, for volumes, `solids` for solid trees,
/// `plan` for plans of towns.
struct ExportInput {
    const mesh::Mesh* mesh = nullptr;
    const volume::Volume* volume = nullptr;
    const field::SolidTree* solids = nullptr;
    const town::TownPlan* plan = nullptr;
    const Provenance* provenance = nullptr;
    std::span<const Collider> colliders;  ///< written by formats that hold colliders
    const ObjectTree* objects = nullptr;  ///< into which formats that hold objects divide the mesh; null: one object
    bool byMaterial = true;               ///< formats that hold objects divide each by material; else colours alone
    std::span<const mesh::LevelOfDetail> levels;  ///< coarser meshes, written by formats that hold levels of detail
    std::string name = "model";                   ///< of the object in the file
    std::map<std::string, std::string> extras;    ///< grammar, seed, parameters: kept where the format can hold them
    ExportOptions options;                        ///< those of the format, checked by `write`
    /// Objects of their own that stand beside the mesh, whose provenance is then the scene's ground; formats that hold
    /// no instances get one mesh of everything. Null: none.
    const mesh::Scene* scene = nullptr;
    Progress* progress = nullptr;
};

/// Calls the visitor with all chunks of a mesh in order, as mesh::polygonizeInLayers does.
using ChunkSource = std::function<Status(const mesh::ChunkVisitor& visit)>;

struct Exporter {
    std::string_view extension;  ///< ".glb"
    std::string_view doc;
    bool wantsVolume = false;
    std::span<const ExportOption> options;
    /// Whether a file with these options says nothing of normals and origins, so that the mesh may hold positions only;
    /// null where every file does.
    bool (*takesPositionsOnly)(const ExportOptions& options) = nullptr;
    /// Writes to `temporary`; `write` renames it into place.
    Status (*write)(const ExportInput& input, const std::filesystem::path& temporary,
                    const std::filesystem::path& target) = nullptr;
    /// The same bytes from chunks, of which it holds none; null where the format wants the whole mesh.
    Status (*stream)(const ExportInput& input, const ChunkSource& chunks, const std::filesystem::path& temporary,
                     const std::filesystem::path& target) = nullptr;
    /// A second file that `write` makes beside the target; null where there is none.
    std::filesystem::path (*beside)(const std::filesystem::path& target) = nullptr;
    bool wantsSolids = false;                     ///< holds the model's solid tree, and neither a mesh nor a volume
    bool holdsObjects = false;                    ///< divides a mesh by ExportInput::objects
    bool holdsScenes = false;                     ///< writes ExportInput::scene, each object once
    bool holdsLevels = false;                     ///< writes ExportInput::levels beside the mesh
    bool wantsPlan = false;                       ///< holds the plan of a town alone
    std::optional<Package> needs = std::nullopt;  ///< without which a build can't write the format
    bool wantsMesh() const { return !wantsVolume && !wantsSolids && !wantsPlan; }
};

/// The table, in the order of docs/reference.md.
std::span<const Exporter> exporters();
/// The row for ".glb" …, or null.
const Exporter* findExporter(std::string_view extension);
/// The row whose extension the file's name ends with, in upper or lower case, or null.
const Exporter* exporterFor(const std::filesystem::path& path);
/// Extensions of the formats that take a mesh chunk by chunk: ".ply .stl …".
std::string streamedExtensions();
/// Error::Usage, in words, for a name that the format doesn't have and for a value that the option doesn't take;
/// Error::Input where this build lacks the package that the format needs.
Status checkOptions(const Exporter& row, const ExportOptions& options);
/// Whether files of the format hold colliders: those with the option `engine` do.
bool holdsColliders(const Exporter& row);
/// Extensions of the formats that hold levels of detail: ".glb …".
std::string leveledExtensions();
/// Whether a bare mesh has all that the format writes with these options.
bool takesPositionsOnly(const Exporter& row, const ExportOptions& options);
/// What `write` makes of `path`: the file, and those that lie beside it.
std::vector<std::filesystem::path> filesOf(const std::filesystem::path& path);
/// Writes `path` by its extension: all or nothing, Error::Cancelled when `input.progress` says so.
Status write(const ExportInput& input, const std::filesystem::path& path);
/// The same of a mesh that comes in chunks, `input.mesh` unset; the first error of `chunks` ends it. Error::Usage where
/// the format wants the whole mesh.
Status writeStreamed(const ExportInput& input, const ChunkSource& chunks, const std::filesystem::path& path);

}  // namespace sgm::exporter
