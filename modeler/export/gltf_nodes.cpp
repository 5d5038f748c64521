#include "modeler/export/gltf_nodes.h"

#include <tiny_gltf.h>

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

Value extrasOf(const ObjectNode& object) {
    Value::Object extras;
    extras["path"] = textOf(object.path);
    extras["symbol"] = textOf(object.symbol);
    if (!object.rule.empty()) extras["rule"] = textOf(object.rule);
    extras["file"] = textOf(object.file);
    extras["line"] = Value(static_cast<int>(object.line));
    for (const auto& [name, value] : object.values) extras[validUtf8(name)] = valueOf(value);
    return Value(extras);
}

}  // namespace

void addScene(tinygltf::Model& model, const ExportInput& input, const std::vector<int>& meshOfNode) {
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
    if (input.objects) {
        const auto& objects = input.objects->nodes;
        std::vector<bool> holds(objects.size());
        for (size_t i = 0; i < objects.size(); ++i) holds[i] = meshOfNode[i] >= 0;
        const std::vector<bool> kept = nodesAbove(*input.objects, holds);
        std::vector<int> nodeOf(objects.size(), 0);
        for (size_t i = 1; i < objects.size(); ++i) {
            if (!kept[i]) continue;
            tinygltf::Node node;
            node.name = validUtf8(objects[i].name);
            node.mesh = meshOfNode[i];
            node.extras = extrasOf(objects[i]);
            nodeOf[i] = static_cast<int>(model.nodes.size());
            model.nodes[static_cast<size_t>(nodeOf[objects[i].parent])].children.push_back(nodeOf[i]);
            model.nodes.push_back(node);
        }
    }
    tinygltf::Scene scene;
    scene.nodes = {0};
    model.scenes.push_back(scene);
    model.defaultScene = 0;
}

void addOriginTable(tinygltf::Model& model, const Provenance& provenance, const PatchedMesh& patched) {
    // Lists beside each other: half the text of an object an origin.
    Value::Array ids, paths, rules, files, lines;
    for (const OriginId origin : originsOf(patched, provenance)) {
        const Part& part = provenance.parts[origin];
        ids.emplace_back(static_cast<int>(origin));
        paths.push_back(textOf(part.path));
        rules.push_back(textOf(part.rule));
        files.push_back(textOf(part.file));
        lines.emplace_back(static_cast<int>(part.line));
    }
    Value::Object table, extras;
    table["id"] = Value(ids);
    table["path"] = Value(paths);
    table["rule"] = Value(rules);
    table["file"] = Value(files);
    table["line"] = Value(lines);
    extras["origins"] = Value(table);
    model.asset.extras = Value(extras);
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
