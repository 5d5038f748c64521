// The solid tree as JSON (.csg.json): every primitive in its place with who made it, and the booleans that join them.
// One array element a line; nodes name nodes that stand before them, the last one is the model. docs/solid-tree.md has
// the format and the formula of every solid.
#include <nlohmann/json.hpp>

#include "modeler/core/decimal.h"
#include "modeler/export/formats.h"
#include "modeler/export/out_file.h"
#include "modeler/field/solid_tree.h"

namespace sgm::exporter {
namespace {

using Json = nlohmann::ordered_json;

std::string textOf(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

Json listOf(Vec3d v) { return Json::array({v.x, v.y, v.z}); }

/// A number as it was meant: .8f as .8.
double decimal(float v) { return decimalOf(textOf(Json(v))); }

Json materialOf(const Material& m) {
    return {{"name", m.name},
            {"color", {decimal(m.color.x), decimal(m.color.y), decimal(m.color.z)}},
            {"roughness", decimal(m.roughness)},
            {"metallic", decimal(m.metallic)}};
}

Json partOf(const Part& p) {
    return {{"path", p.path.text()}, {"symbol", p.symbol()}, {"rule", p.rule()},
            {"file", p.file()},      {"line", p.line()},     {"material", p.material}};
}

Json solidOf(const field::PlacedSolid& s) {
    Json json{{"solid", s.primitive->name},
              {"origin", s.origin},
              {"centre", listOf(s.frame.centre)},
              {"axes", {listOf(s.frame.rotation.x), listOf(s.frame.rotation.y), listOf(s.frame.rotation.z)}},
              {"size", listOf(s.size)}};
    for (size_t i = 0; i < s.arguments.size(); ++i) json[std::string(s.primitive->parameters[i].name)] = s.arguments[i];
    return json;
}

Json nodeOf(const field::SolidTree& tree, const field::SolidNode& node) {
    using Op = field::SolidNode::Op;
    if (node.op == Op::Solid) return solidOf(tree.solids[node.solid]);
    const char* op = node.op == Op::Union ? "union" : node.op == Op::Difference ? "difference" : "intersection";
    return {{"op", op}, {"of", node.operands}};
}

/// "name": [ … ], one element a line.
template <class Rows, class Row>
void list(OutFile& out, const char* name, const Rows& rows, Progress* progress, Row row) {
    out.text(std::string(",\n\"") + name + "\": [");
    const char* separator = "\n";
    for (const auto& r : rows) {
        if (out.failed()) return;
        out.text(separator);
        out.text(textOf(row(r)));
        separator = ",\n";
        tick(progress);
    }
    out.text("\n]");
}

}  // namespace

static Status writeCsgJson(const ExportInput& input, const Path& temporary, const Path& target) {
    const field::SolidTree& tree = *input.solids;
    const Provenance& provenance = *input.provenance;
    if (input.progress)
        input.progress->begin("write", provenance.materials.size() + provenance.parts.size() + tree.nodes.size());
    OutFile out(temporary, target, input.progress);
    Json head{{"format", "sgm solid tree"}, {"version", 1}, {"name", input.name}};
    for (const auto& [name, value] : input.extras) head["extras"][name] = value;
    head["unit"] = "m";
    head["up"] = "y";
    head["bounds"] = {{"low", listOf(tree.bounds.lo)}, {"high", listOf(tree.bounds.hi)}};
    std::string first = textOf(head);
    first.pop_back();  // the lists belong to the same object
    out.text(first);
    list(out, "materials", provenance.materials, input.progress, materialOf);
    list(out, "parts", provenance.parts, input.progress, partOf);
    list(out, "nodes", tree.nodes, input.progress, [&](const field::SolidNode& node) { return nodeOf(tree, node); });
    out.text("\n}\n");
    return out.finish();
}

constinit const Exporter csgJsonFormat{
    .extension = ".csg.json",
    .doc =
        "The solid tree as JSON: booleans of primitives with their parts and materials, of models that are exactly "
        "that",
    .options = {},
    .takesPositionsOnly = saysPositionsOnly,
    .write = writeCsgJson,
    .stream = nullptr,
    .wantsSolids = true,
};

}  // namespace sgm::exporter
