// OpenUSD as text (.usda): a UsdGeomMesh an object, with normals, indexed display colours, texture coordinates and the
// origin of each face, and a face subset bound to a UsdPreviewSurface for each material. Objects stand in each other as
// Xforms. Text isn't indented by depth, for a tree of shapes may be thousands deep.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "modeler/export/formats.h"
#include "modeler/export/origins.h"
#include "modeler/export/out_file.h"
#include "modeler/export/surface.h"
#include "modeler/export/texture.h"

namespace sgm::exporter {
namespace {

/// A text in quotes; JSON's escapes are also USD's, since nothing but control characters needs them.
std::string quoted(const std::string& text) { return nlohmann::json(validUtf8(oneLine(text))).dump(); }

std::string tuple(Vec3f v) { return fmt::format("({}, {}, {})", v.x, v.y, v.z); }

/// What all mesh prims of a file share.
struct Surface {
    const ExportInput& input;
    const TextureCharts& texture;
    const PatchedMesh& patched;
    const std::vector<std::string>& materialNames;
    const std::string& root;
};

/// The text of one object's mesh prim, an attribute after the other.
class MeshPrim {
public:
    /// Of patches [begin, end), which are one object's.
    MeshPrim(OutFile& out, const Surface& surface, std::vector<uint32_t>& local, size_t begin, size_t end)
        : out_(out),
          surface_(surface),
          patched_(surface.patched),
          patches_(surface.patched.patches.begin() + static_cast<std::ptrdiff_t>(begin),
                   surface.patched.patches.begin() + static_cast<std::ptrdiff_t>(end)),
          local_(local),
          vertices_(*surface.input.mesh),
          place_(placementOf(surface.input)) {
        const Patch &first = patches_.front(), &last = patches_.back();
        firstVertex_ = first.firstVertex, vertexCount_ = last.firstVertex + last.vertexCount - firstVertex_;
        firstTriangle_ = first.firstTriangle;
        triangleCount_ = last.firstTriangle + last.triangleCount - firstTriangle_;
        const auto from = patched_.vertices.begin() + firstVertex_;
        points_.assign(from, from + vertexCount_);
        std::sort(points_.begin(), points_.end());
        points_.erase(std::unique(points_.begin(), points_.end()), points_.end());
        for (uint32_t i = 0; i < points_.size(); ++i) local_[points_[i]] = i;
    }

    void write() {
        out_.text("def Mesh \"Surface\"\n{\n    uniform token subdivisionScheme = \"none\"\n");
        topology();
        points();
        normals();
        colors();
        origins();
        if (!surface_.texture.empty()) textureCoordinates();
        if (surface_.input.byMaterial) subsets();
        out_.text("}\n");
    }

private:
    mesh::Triangle triangle(size_t i) const { return patched_.triangles[firstTriangle_ + i]; }

    void topology() {
        list("int[] faceVertexCounts", triangleCount_, [&](size_t) { out_.text("3"); });
        list("int[] faceVertexIndices", triangleCount_, [&](size_t i) {
            const mesh::Triangle t = triangle(i);
            const auto point = [&](uint32_t v) { return local_[patched_.vertices[v]]; };
            out_.numbers(mesh::Triangle{point(t.x), point(t.y), point(t.z)}, ", ");
        });
    }

    void points() {
        Box3f box;
        for (const uint32_t v : points_) box = hull(box, place_.position(vertices_.position(v)));
        out_.text(fmt::format("    float3[] extent = [{}, {}]\n", tuple(box.lo), tuple(box.hi)));
        list("point3f[] points", points_.size(),
             [&](size_t i) { parenthesized(place_.position(vertices_.position(points_[i]))); });
    }

    /// One a vertex; one a face's corner where the mesh has hard edges.
    void normals() {
        if (patched_.corners.empty())
            return list(
                "normal3f[] normals", points_.size(),
                [&](size_t i) { parenthesized(place_.direction(unitNormal(vertices_.normal(points_[i])))); }, "vertex");
        list(
            "normal3f[] normals", 3 * size_t{triangleCount_},
            [&](size_t i) {
                parenthesized(place_.direction(patched_.normal(triangle(i / 3)[static_cast<int>(i % 3)], vertices_)));
            },
            "faceVarying");
    }

    void colors() {
        std::vector<uint32_t> used;  // materials
        for (const Patch& p : patches_)
            for (uint32_t v = p.firstVertex; v < p.firstVertex + p.vertexCount; ++v)
                if (used.empty() || used.back() != patched_.materials[v]) used.push_back(patched_.materials[v]);
        std::sort(used.begin(), used.end());
        used.erase(std::unique(used.begin(), used.end()), used.end());
        list(
            "color3f[] primvars:displayColor", used.size(),
            [&](size_t i) { out_.text(tuple(surface_.input.provenance->materials[used[i]].color)); }, "uniform");
        list("int[] primvars:displayColor:indices", triangleCount_, [&](size_t i) {
            const auto at = std::lower_bound(used.begin(), used.end(), patched_.materials[triangle(i).x]);
            out_.number(at - used.begin());
        });
    }

    /// Whose each face is: a number in the table of the layer.
    void origins() {
        list(
            "int[] primvars:origin", triangleCount_,
            [&](size_t i) { out_.number(patched_.origins[firstTriangle_ + i]); }, "uniform");
    }

    void textureCoordinates() {
        list(
            "texCoord2f[] primvars:st", vertexCount_,
            [&](size_t i) {
                const size_t v = firstVertex_ + i;
                const auto [s, t] = surface_.texture.at(patched_.charts[v], vertices_.position(patched_.vertices[v]));
                out_.text("(");
                out_.number(s);
                out_.text(", ");
                out_.number(t);
                out_.text(")");
            },
            "faceVarying");
        const mesh::Triangle first{firstVertex_, firstVertex_, firstVertex_};
        list("int[] primvars:st:indices", triangleCount_, [&](size_t i) { out_.numbers(triangle(i) - first, ", "); });
    }

    void subsets() {
        out_.text("    uniform token subsetFamily:materialBind:familyType = \"partition\"\n");
        for (const Patch& p : patches_) {
            out_.text(
                fmt::format("\n    def GeomSubset \"{0}\" (\n"
                            "        prepend apiSchemas = [\"MaterialBindingAPI\"]\n    )\n    {{\n"
                            "        uniform token elementType = \"face\"\n"
                            "        uniform token familyName = \"materialBind\"\n"
                            "        rel material:binding = </{1}/Materials/{0}>\n    ",
                            surface_.materialNames[p.material], surface_.root));
            list("int[] indices", p.triangleCount,
                 [&](size_t i) { out_.number(p.firstTriangle - firstTriangle_ + i); });
            out_.text("    }\n");
        }
    }

    /// "type name = [element, element, …]", with its interpolation where it has one.
    template <class Element>
    void list(std::string_view declaration, size_t count, Element element, std::string_view interpolation = "") {
        out_.text("    ");
        out_.text(declaration);
        out_.text(" = [");
        for (size_t i = 0; i < count && !out_.failed(); ++i) {
            if (i > 0) out_.text(", ");
            element(i);
        }
        out_.text("]");
        if (!interpolation.empty()) out_.text(fmt::format(" (interpolation = \"{}\")", interpolation));
        out_.text("\n");
    }
    void parenthesized(Vec3f v) {
        out_.text("(");
        out_.numbers(v, ", ");
        out_.text(")");
    }

    OutFile& out_;
    const Surface& surface_;
    const PatchedMesh& patched_;
    const std::span<const Patch> patches_;
    std::vector<uint32_t>& local_;  ///< by mesh vertex: its place in `points_`
    std::vector<uint32_t> points_;  ///< mesh vertices of the object, ascending
    uint32_t firstVertex_, vertexCount_, firstTriangle_, triangleCount_;
    Vertices vertices_;
    Placement place_;
};

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
    ObjectPrims(OutFile& out, const Surface& surface)
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
        MeshPrim(out_, surface_, local_, firstPatch, surface_.patched.endOfObject(firstPatch)).write();
        tick(surface_.input.progress);
    }
    static std::string distinct(const std::string& name, std::set<std::string>& taken) {
        std::string id = identifierOf(name);
        for (int i = 2; !taken.insert(id).second; ++i) id = fmt::format("{}_{}", identifierOf(name), i);
        return id;
    }

    OutFile& out_;
    const Surface& surface_;
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

void writeMaterials(OutFile& out, const Surface& surface) {
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
                        surface.materialNames[material], surface.root, tuple(m.color), m.roughness, m.metallic));
    }
    out.text("    }\n");
}

}  // namespace

Status writeUsda(const ExportInput& input, const Path& temporary, const Path& target) {
    const TextureCharts texture = chartTexture(option(input, "uv", "box"), *input.mesh);
    const PatchedMesh patched =
        cutIntoPatches(*input.mesh, *input.provenance, {input.objects, texture.ofTriangle, input.byMaterial});
    const std::vector<std::string> names = distinctNames(input.provenance->materials, identifierOf);
    const std::string root = identifierOf(input.name);
    const Surface surface{input, texture, patched, names, root};
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
