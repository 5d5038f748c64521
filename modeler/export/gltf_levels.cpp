#include "modeler/export/gltf_levels.h"

#include <algorithm>

#include "modeler/export/formats.h"
#include "modeler/export/gltf_append.h"
#include "modeler/export/levels.h"

namespace sgm::exporter {
namespace {

/// Moves what hangs on node 0 to a new node below it.
int moveToLevel0(tinygltf::Model& model, const std::string& name) {
    tinygltf::Node node;
    node.name = name;
    node.mesh = std::exchange(model.nodes[0].mesh, -1);
    node.children = std::exchange(model.nodes[0].children, {});
    const int level0 = addNode(model, std::move(node));
    model.nodes[0].children.push_back(level0);
    return level0;
}

}  // namespace

Status addLevels(tinygltf::Model& model, const ExportInput& input, const ModelOfMesh& modelOf) {
    if (input.levels.empty()) return Done{};
    const std::string name = validUtf8(input.name);
    const int finest = moveToLevel0(model, levelName(name, 0));
    tinygltf::Value::Array ids, coverages;
    for (size_t i = 0; i < input.levels.size(); ++i) {
        const auto made = modelOf(inputOfLevel(input, i + 1));
        if (!made.ok()) return made.error();
        tinygltf::Node node;
        node.name = levelName(name, i + 1);
        node.mesh = appendMesh(model, *made);
        ids.emplace_back(addNode(model, std::move(node)));
        coverages.emplace_back(input.levels[i].coverage);
        if (option(input, "levels", "scene") == "scene") model.nodes[0].children.push_back(ids.back().Get<int>());
    }
    coverages.emplace_back(0.0);  // the coarsest one is never left out
    tinygltf::Node& node = model.nodes[static_cast<size_t>(finest)];
    node.extensions["MSFT_lod"] = tinygltf::Value(tinygltf::Value::Object{{"ids", tinygltf::Value(ids)}});
    node.extras = tinygltf::Value(tinygltf::Value::Object{{"MSFT_screencoverage", tinygltf::Value(coverages)}});
    model.extensionsUsed.emplace_back("MSFT_lod");
    return Done{};
}

}  // namespace sgm::exporter
