// OpenUSD as text (.usda): a UsdGeomMesh an object, with normals, indexed display colours, texture coordinates and the
// origin of each face, and a face subset bound to a UsdPreviewSurface for each material. Objects stand in each other as
// Xforms. Text isn't indented by depth, for a tree of shapes may be thousands deep.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "modeler/core/distinct_names.h"
#include "modeler/export/formats.h"
#include "modeler/export/levels.h"
#include "modeler/export/origins.h"
#include "modeler/export/out_file.h"
#include "modeler/export/shared_objects.h"
#include "modeler/export/usda_mesh.h"
#include "modeler/image/texture.h"

namespace sgm::exporter {
namespace {

/// A text in quotes; JSON's escapes are also USD's, since nothing but control characters needs them.
std::string quoted(const std::string& text) { return nlohmann::json(validUtf8(oneLine(text))).dump(); }

/// A path as USD writes an asset: between three @ where it holds one itself.
std::string assetPath(std::string path) {
    if (path.find('@') == std::string::npos) return "@" + path + "@";
    for (size_t at = 0; (at = path.find("@@@", at)) != std::string::npos; at += 4) path.insert(at, "\\");
    return "@@@" + path + "@@@";
}

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

/// The objects as prims, one in another as in their tree; the root's mesh comes first. What shows another's surface is
/// an instance that refers to its prim.
class ObjectPrims {
public:
    ObjectPrims(OutFile& out, const UsdSurface& surface, const SharedObjects* shared, std::string path)
        : out_(out),
          surface_(surface),
          shared_(shared),
          path_(std::move(path)),
          local_(surface.input.mesh->vertexCount()) {}

    void write() {
        const auto& patches = surface_.patched.patches;
        const size_t count = surface_.input.objects ? surface_.input.objects->nodes.size() : 1;
        std::vector<size_t> firstPatch(count, patches.size());
        for (size_t i = 0; i < patches.size(); i = surface_.patched.endOfObject(i)) firstPatch[patches[i].object] = i;
        mesh(firstPatch[0]);
        if (!surface_.input.objects) return;
        const ObjectTree& objects = *surface_.input.objects;
        std::vector<bool> kept(count);
        for (size_t i = 0; i < count; ++i) kept[i] = firstPatch[shared_->of[i]] < patches.size();
        kept = nodesAbove(objects, std::move(kept));
        std::vector<std::string> paths(count);
        paths[0] = path_;
        std::vector<uint32_t> open{0};
        for (uint32_t i = 1; i < count; ++i) {
            const ObjectNode& object = objects.nodes[i];
            for (; open.back() != object.parent; open.pop_back())
                if (kept[open.back()]) out_.text("}\n");
            open.push_back(i);
            // What is below an instance comes with what it refers to.
            if (shared_->isShared(i) && !shared_->isTop(objects, i)) kept[i] = false;
            if (!kept[i]) continue;
            const std::string name = names_.take(identifierOf(object.name));
            paths[i] = paths[object.parent] + "/" + name;
            const bool instance = shared_->isShared(i);
            out_.text(fmt::format("def Xform \"{}\" (\n    kind = \"subcomponent\"\n{}{})\n{{\n", name,
                                  instance ? reference(paths[shared_->of[i]]) : "", customData(object)));
            if (instance) move(shared_->moved[i]);
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
    static std::string reference(const std::string& path) {
        return fmt::format("    instanceable = true\n    prepend references = <{}>\n", path);
    }
    void move(Vec3d by) {
        const Placement place = placementOf(surface_.input);
        const Vec3d v = (place.zUp ? Vec3d{by.x, -by.z, by.y} : by) * static_cast<double>(place.unitsPerMetre);
        out_.text(
            fmt::format("    double3 xformOp:translate = ({}, {}, {})\n"
                        "    uniform token[] xformOpOrder = [\"xformOp:translate\"]\n",
                        v.x, v.y, v.z));
    }

    OutFile& out_;
    const UsdSurface surface_;
    const SharedObjects* shared_;  ///< set where there are objects
    const std::string path_;       ///< of the prim that the objects lie in
    std::vector<uint32_t> local_;
    DistinctNames names_{{"Materials", "Places", "Surface"}};
};

/// The parts behind the faces' origins, as lists beside each other.
void writeOriginTable(OutFile& out, const Provenance& provenance, const mesh::Mesh& mesh) {
    const std::vector<OriginId> origins = originsOf(mesh, provenance);
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
    list("string[] path", [](OriginId, const Part& part) { return quoted(part.path.text()); });
    list("string[] rule", [](OriginId, const Part& part) { return quoted(part.rule()); });
    list("string[] file", [](OriginId, const Part& part) { return quoted(part.file()); });
    list("int[] line", [](OriginId, const Part& part) { return fmt::format("{}", part.line()); });
    out.text("        }\n");
}

void writeLayer(OutFile& out, const ExportInput& input, const std::string& root) {
    out.text("#usda 1.0\n(\n");
    out.text("    customLayerData = {\n");
    for (const auto& [key, value] : input.extras)
        out.text(fmt::format("        string {} = {}\n", quoted(key), quoted(value)));
    writeOriginTable(out, *input.provenance, *input.mesh);
    out.text("    }\n");
    const Placement place = placementOf(input);
    out.text(
        fmt::format("    defaultPrim = \"{}\"\n    doc = \"sgm\"\n    metersPerUnit = {}\n    upAxis = \"{}\"\n)\n\n",
                    root, 1.0 / static_cast<double>(place.unitsPerMetre), place.zUp ? "Z" : "Y"));
}

/// The shaders of a texture below the prim of its material.
std::string textureShaders(const image::Texture& texture, const std::string& prim, const Path& folder) {
    std::string text = fmt::format(
        "\n            def Shader \"Coordinates\"\n            {{\n"
        "                uniform token info:id = \"UsdPrimvarReader_float2\"\n"
        "                string inputs:varname = \"st\"\n                float2 outputs:result\n            }}\n"
        "\n            def Shader \"Tiles\"\n            {{\n"
        "                uniform token info:id = \"UsdTransform2d\"\n"
        "                float2 inputs:in.connect = <{}/Coordinates.outputs:result>\n"
        "                float2 inputs:scale = ({}, {})\n                float2 outputs:result\n            }}\n",
        prim, 1 / texture.width_m, 1 / texture.height_m);
    const auto picture = [&](std::string_view name, const image::ImageFilePtr& file, std::string_view space,
                             std::string_view more) {
        if (!file) return;
        text += fmt::format(
            "\n            def Shader \"{}\"\n            {{\n"
            "                uniform token info:id = \"UsdUVTexture\"\n"
            "                asset inputs:file = {}\n"
            "                float2 inputs:st.connect = <{}/Tiles.outputs:result>\n"
            "                token inputs:wrapS = \"repeat\"\n                token inputs:wrapT = \"repeat\"\n"
            "                token inputs:sourceColorSpace = \"{}\"\n{}            }}\n",
            name, assetPath(pathFrom(folder, file->path)), prim, space, more);
    };
    picture("Color", texture.color, "sRGB", "                float3 outputs:rgb\n");
    picture("Roughness", texture.roughness, "raw", "                float outputs:g\n");
    picture("Normals", texture.normals, "raw",
            "                float4 inputs:scale = (2, 2, 2, 1)\n                float4 inputs:bias = (-1, -1, -1, 0)\n"
            "                float3 outputs:rgb\n");
    return text;
}

/// The inputs of a material's surface that its pictures give.
std::string textureInputs(const image::Texture& texture, const std::string& prim) {
    std::string text;
    if (texture.color)
        text += fmt::format("                color3f inputs:diffuseColor.connect = <{}/Color.outputs:rgb>\n", prim);
    if (texture.roughness)
        text += fmt::format("                float inputs:roughness.connect = <{}/Roughness.outputs:g>\n", prim);
    if (texture.normals)
        text += fmt::format("                normal3f inputs:normal.connect = <{}/Normals.outputs:rgb>\n", prim);
    return text;
}

void writeMaterials(OutFile& out, const ExportInput& input, const std::set<uint32_t>& used,
                    const std::vector<std::string>& names, const std::string& root, const Path& folder) {
    out.text("    def Scope \"Materials\"\n    {\n");
    for (const uint32_t material : used) {
        const Material& m = input.provenance->materials[material];
        const std::string prim = fmt::format("/{}/Materials/{}", root, names[material]);
        const bool textured = m.texture && option(input, "uv", "scope") != "none";
        out.text(fmt::format(
            "        def Material \"{0}\"\n        {{\n"
            "            token outputs:surface.connect = </{1}/Materials/{0}/Surface.outputs:surface>\n\n"
            "            def Shader \"Surface\"\n            {{\n"
            "                uniform token info:id = \"UsdPreviewSurface\"\n"
            "                color3f inputs:diffuseColor = {2}\n"
            "                float inputs:roughness = {3}\n"
            "                float inputs:metallic = {4}\n"
            "{5}                token outputs:surface\n            }}\n{6}        }}\n",
            names[material], root, usdTuple(m.color), m.roughness, m.metallic,
            textured ? textureInputs(*m.texture, prim) : "", textured ? textureShaders(*m.texture, prim, folder) : ""));
    }
    out.text("    }\n");
}

/// One mesh with what its prims need of it.
struct UsdLevel {
    ExportInput input;                            ///< its mesh is that of `shared` where that has one
    std::unique_ptr<const SharedObjects> shared;  ///< set where there are objects
    TextureSets texture;
    PatchedMesh patched;
};

Result<UsdLevel> makeLevel(const ExportInput& input, size_t level) {
    UsdLevel made{inputOfLevel(input, level), nullptr, {}, {}};
    if (const ObjectTree* const objects = made.input.objects)
        made.shared = std::make_unique<const SharedObjects>(option(input, "instances", "no") == "yes"
                                                                ? shareObjects(*made.input.mesh, *objects)
                                                                : keepOwnSurfaces(*objects));
    if (made.shared && made.shared->mesh) made.input.mesh = &*made.shared->mesh;
    auto texture = makeTexture(made.input);
    if (!texture.ok()) return texture.error();
    made.texture = std::move(*texture);
    made.patched = cutIntoPatches(*made.input.mesh, *made.input.provenance,
                                  {made.input.objects, made.texture.charts.ofTriangle, made.input.byMaterial});
    return made;
}

/// The head of the default prim; with levels of detail it has a variant set of them.
std::string rootHead(const ExportInput& input, const std::string& root) {
    const char* variants =
        input.levels.empty()
            ? ""
            : "    variants = {\n        string LOD = \"LOD0\"\n    }\n    prepend variantSets = \"LOD\"\n";
    return fmt::format("def Xform \"{}\" (\n    kind = \"component\"\n{})\n{{\n", root, variants);
}

/// The variants LOD0, LOD1, …: each has the prim of one level alone. Prims stand outside of them, so that a reader
/// without variants finds the model.
std::string levelVariants(const ExportInput& input) {
    std::string text = "    variantSet \"LOD\" = {\n";
    for (size_t chosen = 0; chosen < levelCount(input); ++chosen) {
        text += fmt::format("        \"LOD{}\" {{\n", chosen);
        for (size_t level = 0; level < levelCount(input); ++level)
            text += fmt::format(
                "            over \"{}\" (\n                active = {}\n            )\n            {{\n            "
                "}}\n",
                identifierOf(levelName(input.name, level)), level == chosen ? "true" : "false");
        text += "        }\n";
    }
    return text + "    }\n";
}

/// The objects of the scene and their places, as a PointInstancer whose prototypes lie below it.
class Places {
public:
    Places(OutFile& out, const ExportInput& input, const std::vector<std::string>& names, const std::string& root)
        : out_(out), input_(input), names_(names), root_(root) {}

    /// Adds the materials that it uses to `used`.
    Status write(std::set<uint32_t>& used) {
        out_.text("def PointInstancer \"Places\"\n{\n");
        list("int[] protoIndices", [](const mesh::Instance& i) { return fmt::format("{}", i.object); });
        const Placement place = placementOf(input_);
        list("point3f[] positions",
             [&](const mesh::Instance& i) { return usdTuple(place.position(i.part.pose.origin.as<float>())); });
        list("quath[] orientations", [&](const mesh::Instance& i) {
            auto q = mesh::quaternionOf(i.part.pose.axes);
            if (place.zUp) q = {q[0], -q[2], q[1], q[3]};
            return fmt::format("({:.4g}, {:.4g}, {:.4g}, {:.4g})", q[3], q[0], q[1], q[2]);
        });
        std::string prototypes;
        for (const mesh::SceneObject& object : input_.scene->objects)
            prototypes +=
                fmt::format("{}</{}/Places/{}>", prototypes.empty() ? "" : ", ", root_, identifierOf(object.name));
        out_.text(fmt::format("    rel prototypes = [{}]\n", prototypes));
        for (const mesh::SceneObject& object : input_.scene->objects)
            if (const Status s = prototype(object, used); !s.ok()) return s;
        out_.text("}\n");
        return Done{};
    }

private:
    template <class Element>
    void list(std::string_view declaration, Element element) {
        out_.text(fmt::format("    {} = [", declaration));
        bool first = true;
        for (const mesh::Instance& instance : input_.scene->instances) {
            out_.text((first ? "" : ", ") + element(instance));
            first = false;
        }
        out_.text("]\n");
    }

    Status prototype(const mesh::SceneObject& object, std::set<uint32_t>& used) {
        ExportInput own = input_;
        own.mesh = &object.mesh;
        own.provenance = &object.provenance;
        own.objects = nullptr;
        own.levels = {};
        own.scene = nullptr;
        auto level = makeLevel(own, 0);
        if (!level.ok()) return level.error();
        for (const Patch& p : level->patched.patches) used.insert(p.material);
        std::string said;
        for (const auto& [name, value] : object.values)
            said += fmt::format("        string {} = {}\n", quoted(name), quoted(value));
        const std::string id = identifierOf(object.name);
        out_.text(fmt::format("def Xform \"{}\" (\n    customData = {{\n{}    }}\n)\n{{\n", id, said));
        ObjectPrims(out_, {level->input, level->texture, level->patched, names_, root_}, nullptr,
                    "/" + root_ + "/Places/" + id)
            .write();
        out_.text("}\n");
        return Done{};
    }

    OutFile& out_;
    const ExportInput& input_;
    const std::vector<std::string>& names_;
    const std::string& root_;
};

}  // namespace

static Status writeUsda(const ExportInput& input, const Path& temporary, const Path& target) {
    auto level = makeLevel(input, 0);
    if (!level.ok()) return level.error();
    const std::vector<std::string> names = distinctNames(input.provenance->materials, identifierOf);
    const std::string root = identifierOf(input.name);
    if (input.progress) input.progress->begin("write", level->patched.patches.size());

    OutFile out(temporary, target, input.progress);
    writeLayer(out, input, root);
    out.text(rootHead(input, root));
    std::set<uint32_t> used;
    for (size_t i = 0;;) {
        for (const Patch& p : level->patched.patches) used.insert(p.material);
        std::string path = "/" + root;
        if (!input.levels.empty()) {
            const std::string name = identifierOf(level->input.name);
            out.text(fmt::format("def Xform \"{}\"\n{{\n", name));
            path += "/" + name;
        }
        const SharedObjects* const shared = level->shared ? &*level->shared : nullptr;
        ObjectPrims(out, {level->input, level->texture, level->patched, names, root}, shared, path).write();
        if (!input.levels.empty()) out.text("}\n");
        if (++i == levelCount(input)) break;
        level = makeLevel(input, i);
        if (!level.ok()) return level.error();
    }
    if (!input.levels.empty()) out.text(levelVariants(input));
    if (input.scene)
        if (const Status s = Places(out, input, names, root).write(used); !s.ok()) return s;
    if (input.byMaterial) writeMaterials(out, input, used, names, root, target.parent_path());
    out.text("}\n");
    return out.finish();
}

static constexpr ExportOption usdaOptions[] = {upOption, unitOption, uvOption, lightMapOption, instancesOption("no")};

constinit const Exporter usdaFormat{
    .extension = ".usda",
    .doc = "OpenUSD as text: normals, display colours, a subset and preview surface a material",
    .options = usdaOptions,
    .takesPositionsOnly = nullptr,
    .write = writeUsda,
    .stream = nullptr,
    .holdsObjects = true,
    .holdsScenes = true,
    .holdsLevels = true,
};

}  // namespace sgm::exporter
