#include "modeler/export/gltf_nodes.h"

#include <tiny_gltf.h>

#include <algorithm>

#include "modeler/export/formats.h"
#include "modeler/export/origins.h"

namespace sgm::exporter {
namespace {

using Value = tinygltf::Value;

Value textOf(const std::string& text) { return Value(validUtf8(text)); }

Value valueOf(const ObjectValue& value) {
    if (const double* number = std::get_if<double>(&value)) return Value(*number);
    if (const std::string* text = std::get_if<std::string>(&value)) return textOf(*text);
    const Vec3d v = std::get<Vec3d>(value);
    return Value(Value::Array{Value(v.x), Value(v.y), Value(v.z)});
}

Value::Object extrasOf(const ObjectNode& object) {
    Value::Object extras;
    extras["path"] = textOf(object.path);
    extras["symbol"] = textOf(object.symbol);
    if (!object.rule.empty()) extras["rule"] = textOf(object.rule);
    extras["file"] = textOf(object.file);
    extras["line"] = Value(static_cast<int>(object.line));
    for (const auto& [name, value] : object.values) extras[validUtf8(name)] = valueOf(value);
    return extras;
}

/// Which origins of the surface that the node shows stand for which of its own: the other's, its own, the other's …
Value originsInPlace(const SharedObjects& shared, uint32_t node, const std::vector<OriginId>& shown) {
    Value::Array pairs;
    const auto &theirs = shared.origins[shared.of[node]], &own = shared.origins[node];
    for (size_t i = 0; i < own.size(); ++i) {
        if (!std::binary_search(shown.begin(), shown.end(), theirs[i])) continue;
        pairs.emplace_back(static_cast<int>(theirs[i]));
        pairs.emplace_back(static_cast<int>(own[i]));
    }
    return Value(pairs);
}

/// The nodes below the whole, which is the model's node 0.
void addObjects(tinygltf::Model& model, const ExportInput& input, const SharedObjects& shared,
                const std::vector<int>& meshOfNode) {
    const ObjectTree& tree = *input.objects;
    const auto& objects = tree.nodes;
    const std::vector<OriginId> shown = originsOf(*input.mesh, *input.provenance);
    std::vector<bool> holds(objects.size());
    for (size_t i = 0; i < objects.size(); ++i) holds[i] = meshOfNode[shared.of[i]] >= 0;
    const std::vector<bool> kept = nodesAbove(tree, holds);
    std::vector<int> nodeOf(objects.size(), 0);
    for (uint32_t i = 1; i < objects.size(); ++i) {
        if (!kept[i]) continue;
        tinygltf::Node node;
        node.name = validUtf8(objects[i].name);
        node.mesh = meshOfNode[shared.of[i]];
        Value::Object extras = extrasOf(objects[i]);
        if (shared.isShared(i) && node.mesh >= 0) extras["origins"] = originsInPlace(shared, i, shown);
        node.extras = Value(extras);
        if (const Vec3d moved = shared.moved[i]; moved != Vec3d{}) node.translation = {moved.x, moved.y, moved.z};
        nodeOf[i] = static_cast<int>(model.nodes.size());
        model.nodes[static_cast<size_t>(nodeOf[objects[i].parent])].children.push_back(nodeOf[i]);
        model.nodes.push_back(node);
    }
}

}  // namespace

void addScene(tinygltf::Model& model, const ExportInput& input, const SharedObjects* shared,
              const std::vector<int>& meshOfNode) {
    model.asset.version = "2.0";
    model.asset.generator = "sgm";
    tinygltf::Node root;
    root.name = validUtf8(input.name);
    root.mesh = meshOfNode[0];
    if (!input.extras.empty()) {
        // On the node, where viewers show them as the object's own properties.
        Value::Object extras;
        for (const auto& [key, value] : input.extras) extras[validUtf8(key)] = textOf(value);
        root.extras = Value(extras);
    }
    model.nodes.push_back(root);
    if (input.objects) addObjects(model, input, *shared, meshOfNode);
    tinygltf::Scene scene;
    scene.nodes = {0};
    model.scenes.push_back(scene);
    model.defaultScene = 0;
}

Value originTable(const Provenance& provenance, const mesh::Mesh& mesh) {
    // Lists beside each other: half the text of an object an origin.
    Value::Array ids, paths, rules, files, lines;
    for (const OriginId origin : originsOf(mesh, provenance)) {
        const Part& part = provenance.parts[origin];
        ids.emplace_back(static_cast<int>(origin));
        paths.push_back(textOf(part.path.text()));
        rules.push_back(textOf(part.rule()));
        files.push_back(textOf(part.file()));
        lines.emplace_back(static_cast<int>(part.line()));
    }
    Value::Object table, extras;
    table["id"] = Value(ids);
    table["path"] = Value(paths);
    table["rule"] = Value(rules);
    table["file"] = Value(files);
    table["line"] = Value(lines);
    extras["origins"] = Value(table);
    return Value(extras);
}

Value originRuns(const PatchedMesh& patched, const Patch& patch) {
    Value::Array runs;
    forOriginRuns(patched, patch, [&](OriginId origin, uint32_t, uint32_t count) {
        runs.emplace_back(static_cast<int>(origin));
        runs.emplace_back(static_cast<int>(count));
    });
    Value::Object extras;
    extras["origins"] = Value(runs);
    return Value(extras);
}

}  // namespace sgm::exporter
