// OpenUSD as text (.usda): a UsdGeomMesh an object, with normals, indexed display colours, texture coordinates and the
// origin of each face, and a face subset bound to a UsdPreviewSurface for each material. Objects stand in each other as
// Xforms. Text isn't indented by depth, for a tree of shapes may be thousands deep.
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <set>

#include "modeler/export/formats.h"
#include "modeler/export/origins.h"
#include "modeler/export/out_file.h"
#include "modeler/export/usda_mesh.h"

namespace sgm::exporter {
namespace {

/// A text in quotes; JSON's escapes are also USD's, since nothing but control characters needs them.
std::string quoted(const std::string& text) { return nlohmann::json(validUtf8(oneLine(text))).dump(); }

/// What a prim knows of its shape.
std::string customData(const ObjectNode& object) {
    std::string text = fmt::format("    customData = {{\n        string path = {}\n        string symbol = {}\n",
                                   quoted(object.path), quoted(object.symbol));
    if (!object.rule.empty()) text += fmt::format("        string rule = {}\n", quoted(object.rule));
    text += fmt::format("        string file = {}\n        int line = {}\n", quoted(object.file), object.line);
    for (const auto& [name, value] : object.values) {
        if (const double* number = std::get_if<double>(&value))
            text += fmt::format("        double {} = {}\n", quoted(name), *number);
        else if (const std::string* said = std::get_if<std::string>(&value))
            text += fmt::format("        string {} = {}\n", quoted(name), quoted(*said));
        else {
            const Vec3d v = std::get<Vec3d>(value);
            text += fmt::format("        double3 {} = ({}, {}, {})\n", quoted(name), v.x, v.y, v.z);
        }
    }
    return text + "    }\n";
}

/// The objects as prims, one in another as in their tree; the root's mesh comes first.
class ObjectPrims {
public:
    ObjectPrims(OutFile& out, const UsdSurface& surface)
        : out_(out), surface_(surface), local_(surface.input.mesh->vertexCount()) {}

    void write() {
        const auto& patches = surface_.patched.patches;
        const size_t count = surface_.input.objects ? surface_.input.objects->nodes.size() : 1;
        std::vector<size_t> firstPatch(count, patches.size());
        for (size_t i = 0; i < patches.size(); i = surface_.patched.endOfObject(i)) firstPatch[patches[i].object] = i;
        std::vector<bool> holds(count);
        for (size_t i = 0; i < count; ++i) holds[i] = firstPatch[i] < patches.size();
        mesh(firstPatch[0]);
        if (!surface_.input.objects) return;
        const std::vector<bool> kept = nodesAbove(*surface_.input.objects, holds);
        std::set<std::string> taken{"Materials", "Surface"};
        std::vector<uint32_t> open{0};
        for (uint32_t i = 1; i < count; ++i) {
            const ObjectNode& object = surface_.input.objects->nodes[i];
            for (; open.back() != object.parent; open.pop_back())
                if (kept[open.back()]) out_.text("}\n");
            open.push_back(i);
            if (!kept[i]) continue;
            out_.text(fmt::format("def Xform \"{}\" (\n    kind = \"subcomponent\"\n{})\n{{\n",
                                  distinct(object.name, taken), customData(object)));
            mesh(firstPatch[i]);
        }
        for (; open.size() > 1; open.pop_back())
            if (kept[open.back()]) out_.text("}\n");
    }

private:
    /// The mesh of the object whose patches begin there; nothing where it has none.
    void mesh(size_t firstPatch) {
        if (firstPatch >= surface_.patched.patches.size()) return;
        writeUsdMesh(out_, surface_, local_, firstPatch, surface_.patched.endOfObject(firstPatch));
        tick(surface_.input.progress);
    }
    static std::string distinct(const std::string& name, std::set<std::string>& taken) {
        std::string id = identifierOf(name);
        for (int i = 2; !taken.insert(id).second; ++i) id = fmt::format("{}_{}", identifierOf(name), i);
        return id;
    }

    OutFile& out_;
    const UsdSurface& surface_;
    std::vector<uint32_t> local_;
};

/// The parts behind the faces' origins, as lists beside each other.
void writeOriginTable(OutFile& out, const Provenance& provenance, const PatchedMesh& patched) {
    const std::vector<OriginId> origins = originsOf(patched, provenance);
    const auto list = [&](std::string_view declaration, auto&& element) {
        out.text(fmt::format("            {} = [", declaration));
        for (size_t i = 0; i < origins.size(); ++i) {
            if (i > 0) out.text(", ");
            out.text(element(origins[i], provenance.parts[origins[i]]));
        }
        out.text("]\n");
    };
    out.text("        dictionary origins = {\n");
    list("int[] id", [](OriginId id, const Part&) { return fmt::format("{}", id); });
    list("string[] path", [](OriginId, const Part& part) { return quoted(part.path); });
    list("string[] rule", [](OriginId, const Part& part) { return quoted(part.rule); });
    list("string[] file", [](OriginId, const Part& part) { return quoted(part.file); });
    list("int[] line", [](OriginId, const Part& part) { return fmt::format("{}", part.line); });
    out.text("        }\n");
}

void writeLayer(OutFile& out, const ExportInput& input, const PatchedMesh& patched, const std::string& root) {
    out.text("#usda 1.0\n(\n");
    out.text("    customLayerData = {\n");
    for (const auto& [key, value] : input.extras)
        out.text(fmt::format("        string {} = {}\n", quoted(key), quoted(value)));
    writeOriginTable(out, *input.provenance, patched);
    out.text("    }\n");
    const Placement place = placementOf(input);
    out.text(
        fmt::format("    defaultPrim = \"{}\"\n    doc = \"sgm\"\n    metersPerUnit = {}\n    upAxis = \"{}\"\n)\n\n",
                    root, 1.0 / static_cast<double>(place.unitsPerMetre), place.zUp ? "Z" : "Y"));
}

void writeMaterials(OutFile& out, const UsdSurface& surface) {
    std::set<uint32_t> used;
    for (const Patch& p : surface.patched.patches) used.insert(p.material);
    out.text("    def Scope \"Materials\"\n    {\n");
    for (const uint32_t material : used) {
        const Material& m = surface.input.provenance->materials[material];
        out.text(
            fmt::format("        def Material \"{0}\"\n        {{\n"
                        "            token outputs:surface.connect = </{1}/Materials/{0}/Surface.outputs:surface>\n\n"
                        "            def Shader \"Surface\"\n            {{\n"
                        "                uniform token info:id = \"UsdPreviewSurface\"\n"
                        "                color3f inputs:diffuseColor = {2}\n"
                        "                float inputs:roughness = {3}\n"
                        "                float inputs:metallic = {4}\n"
                        "                token outputs:surface\n            }}\n        }}\n",
                        surface.materialNames[material], surface.root, usdTuple(m.color), m.roughness, m.metallic));
    }
    out.text("    }\n");
}

}  // namespace

Status writeUsda(const ExportInput& input, const Path& temporary, const Path& target) {
    const auto texture = makeTexture(input);
    if (!texture.ok()) return texture.error();
    const PatchedMesh patched =
        cutIntoPatches(*input.mesh, *input.provenance, {input.objects, texture->charts.ofTriangle, input.byMaterial});
    const std::vector<std::string> names = distinctNames(input.provenance->materials, identifierOf);
    const std::string root = identifierOf(input.name);
    const UsdSurface surface{input, *texture, patched, names, root};
    if (input.progress) input.progress->begin("write", patched.patches.size());

    OutFile out(temporary, target, input.progress);
    writeLayer(out, input, patched, root);
    out.text(fmt::format("def Xform \"{}\" (\n    kind = \"component\"\n)\n{{\n", root));
    ObjectPrims(out, surface).write();
    if (input.byMaterial) writeMaterials(out, surface);
    out.text("}\n");
    return out.finish();
}

}  // namespace sgm::exporter
