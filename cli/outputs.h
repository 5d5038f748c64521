// What `sgm build` writes: files by their endings, options of formats, the proxy.
// Enters: what the user asked for, a model and its mesh. Leaves: files. Assumes `checkOutputs` came before the work.
#pragma once

#include "cli/requests.h"
#include "modeler/export/exporter.h"

namespace sgm::cli {

struct OutputRequest {
    std::vector<std::string> files;
    std::vector<std::string> options;  ///< "NAME=VALUE"
    std::string objects;               ///< as lower::parseObjects reads it, "" for by material
    std::string collider;              ///< "boxes", "convex" or "mesh", "" for none
    int lod = 1;                       ///< levels of detail, the finest included
    std::string proxy;                 ///< a mesh file, "" for none
    double proxyTolerance_m = 0;       ///< 0: a twentieth of the model's longest side
};
/// Adds -o, --format-option, --objects, --lod, --collider, --proxy and --proxy-tolerance.
void addOutputOptions(CLI::App& command, OutputRequest& request);

/// The outputs and the proxy, if there is one.
std::vector<std::string> allFiles(const OutputRequest& request);

/// Error::Usage for endings, options and values that no format takes; Error::Input for folders that aren't there.
Status checkOutputs(const OutputRequest& request);

/// Error::Usage unless `file`, which `option` names, has the ending of a mesh format; Error::Input for a missing
/// folder.
Status checkMeshFile(const char* option, const std::string& file);

/// True when one of the files holds a volume.
bool wantsVolume(const OutputRequest& request);

/// True when every file holds the solid tree or the plan of a town, so that no mesh is wanted.
bool needsNoMesh(const OutputRequest& request);

/// True when no file says anything of the mesh's normals and origins. (The proxy is a mesh of its own.)
bool needsPositionsOnly(const OutputRequest& request);

/// Error::Usage unless there is one file, of a format that takes a mesh chunk by chunk.
Status checkStreamed(const OutputRequest& request);
/// Writes that file.
Status streamOutput(const OutputRequest& request, exporter::ExportInput input, const exporter::ChunkSource& chunks);

/// Writes the files that hold the model's solid tree or its plan, if any. Error::Input, located, where the model isn't
/// exactly one, or where it has no plan.
Status writeMeshless(const OutputRequest& request, const Model& model, exporter::ExportInput input);

/// Writes every other file. `input` has the mesh, the level set where one of the files wants it, and what is known of
/// the model.
Status writeOutputs(const OutputRequest& request, const Model& model, exporter::ExportInput input, int threads);

}  // namespace sgm::cli
