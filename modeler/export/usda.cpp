// OpenUSD as text (.usda): a UsdGeomMesh with normals, indexed display colours and texture coordinates, and a face
// subset bound to a UsdPreviewSurface for each material.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "modeler/export/formats.h"
#include "modeler/export/out_file.h"
#include "modeler/export/surface.h"

namespace sgm::exporter {
namespace {

/// Patches [begin, end) share a material.
struct Subset {
    uint32_t material;
    uint32_t firstTriangle, triangleCount;
};

std::vector<Subset> subsetsOf(const PatchedMesh& patched) {
    std::vector<Subset> subsets;
    for (const Patch& p : patched.patches) {
        if (subsets.empty() || subsets.back().material != p.material)
            subsets.push_back({p.material, p.firstTriangle, 0});
        subsets.back().triangleCount += p.triangleCount;
    }
    return subsets;
}

/// A text in quotes; JSON's escapes are also USD's, since nothing but control characters needs them.
std::string quoted(const std::string& text) { return nlohmann::json(validUtf8(oneLine(text))).dump(); }

std::string tuple(Vec3f v) { return fmt::format("({}, {}, {})", v.x, v.y, v.z); }

/// The mesh prim's text, an attribute after the other.
class MeshPrim {
public:
    MeshPrim(OutFile& out, const ExportInput& input, const PatchedMesh& patched)
        : out_(out), input_(input), patched_(patched), vertices_(*input.mesh), place_(placementOf(input)) {}

    void topology() {
        const size_t n = patched_.triangles.size();
        list("int[] faceVertexCounts", n, [&](size_t) { out_.text("3"); });
        list("int[] faceVertexIndices", n, [&](size_t i) {
            const mesh::Triangle t = patched_.triangles[i];
            out_.numbers(mesh::Triangle{patched_.vertices[t.x], patched_.vertices[t.y], patched_.vertices[t.z]}, ", ");
        });
    }

    void vertices() {
        const Box3f box = input_.mesh->bounds();
        const Vec3f a = place_.position(box.lo), b = place_.position(box.hi);
        out_.text(fmt::format("        float3[] extent = [{}, {}]\n", tuple(min(a, b)), tuple(max(a, b))));
        const size_t n = input_.mesh->vertexCount();
        list("point3f[] points", n,
             [&](size_t i) { parenthesized(place_.position(vertices_.position(static_cast<uint32_t>(i)))); });
        normals();
    }

    void colors(const std::vector<Subset>& subsets) {
        list(
            "color3f[] primvars:displayColor", subsets.size(),
            [&](size_t i) { out_.text(tuple(input_.provenance->materials[subsets[i].material].color)); }, "uniform");
        size_t subset = 0;
        list("int[] primvars:displayColor:indices", patched_.triangles.size(), [&](size_t i) {
            while (i >= subsets[subset].firstTriangle + subsets[subset].triangleCount) ++subset;
            out_.number(subset);
        });
    }

    void textureCoordinates() {
        size_t patch = 0;
        list(
            "texCoord2f[] primvars:st", patched_.vertices.size(),
            [&](size_t i) {
                while (i >= patched_.patches[patch].firstVertex + patched_.patches[patch].vertexCount) ++patch;
                const Vec3f p = vertices_.position(patched_.vertices[i]);
                const auto [s, t] = boxProjection(p, patched_.patches[patch].facing);
                out_.text("(");
                out_.number(s);
                out_.text(", ");
                out_.number(t);
                out_.text(")");
            },
            "faceVarying");
        list("int[] primvars:st:indices", patched_.triangles.size(),
             [&](size_t i) { out_.numbers(patched_.triangles[i], ", "); });
    }

    void subsets(const std::vector<Subset>& subsets, const std::vector<std::string>& names, const std::string& root) {
        out_.text("        uniform token subsetFamily:materialBind:familyType = \"partition\"\n");
        for (const Subset& s : subsets) {
            out_.text(
                fmt::format("\n        def GeomSubset \"{0}\" (\n"
                            "            prepend apiSchemas = [\"MaterialBindingAPI\"]\n        )\n        {{\n"
                            "            uniform token elementType = \"face\"\n"
                            "            uniform token familyName = \"materialBind\"\n"
                            "            rel material:binding = </{1}/Materials/{0}>\n",
                            names[s.material], root));
            list("    int[] indices", s.triangleCount, [&](size_t i) { out_.number(s.firstTriangle + i); });
            out_.text("        }\n");
        }
    }

private:
    /// One a vertex; one a face's corner where the mesh has hard edges.
    void normals() {
        if (patched_.corners.empty())
            return list(
                "normal3f[] normals", input_.mesh->vertexCount(),
                [&](size_t i) {
                    parenthesized(place_.direction(unitNormal(vertices_.normal(static_cast<uint32_t>(i)))));
                },
                "vertex");
        list(
            "normal3f[] normals", 3 * patched_.triangles.size(),
            [&](size_t i) {
                const uint32_t v = patched_.triangles[i / 3][static_cast<int>(i % 3)];
                parenthesized(place_.direction(patched_.normal(v, vertices_)));
            },
            "faceVarying");
    }

    /// "type name = [element, element, …]", with its interpolation where it has one.
    template <class Element>
    void list(std::string_view declaration, size_t count, Element element, std::string_view interpolation = "") {
        out_.text("        ");
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
    const ExportInput& input_;
    const PatchedMesh& patched_;
    Vertices vertices_;
    Placement place_;
};

void writeLayer(OutFile& out, const ExportInput& input, const std::string& root) {
    out.text("#usda 1.0\n(\n");
    if (!input.extras.empty()) {
        out.text("    customLayerData = {\n");
        for (const auto& [key, value] : input.extras)
            out.text(fmt::format("        string {} = {}\n", quoted(key), quoted(value)));
        out.text("    }\n");
    }
    const Placement place = placementOf(input);
    out.text(
        fmt::format("    defaultPrim = \"{}\"\n    doc = \"sgm\"\n    metersPerUnit = {}\n    upAxis = \"{}\"\n)\n\n",
                    root, 1.0 / static_cast<double>(place.unitsPerMetre), place.zUp ? "Z" : "Y"));
}

void writeMaterials(OutFile& out, const Provenance& provenance, const std::vector<Subset>& subsets,
                    const std::vector<std::string>& names, const std::string& root) {
    out.text("    def Scope \"Materials\"\n    {\n");
    for (const Subset& s : subsets) {
        const Material& m = provenance.materials[s.material];
        out.text(
            fmt::format("        def Material \"{0}\"\n        {{\n"
                        "            token outputs:surface.connect = </{1}/Materials/{0}/Surface.outputs:surface>\n\n"
                        "            def Shader \"Surface\"\n            {{\n"
                        "                uniform token info:id = \"UsdPreviewSurface\"\n"
                        "                color3f inputs:diffuseColor = {2}\n"
                        "                float inputs:roughness = {3}\n"
                        "                float inputs:metallic = {4}\n"
                        "                token outputs:surface\n            }}\n        }}\n",
                        names[s.material], root, tuple(m.color), m.roughness, m.metallic));
    }
    out.text("    }\n");
}

}  // namespace

Status writeUsda(const ExportInput& input, const Path& temporary, const Path& target) {
    const bool textured = option(input, "uv", "box") == "box";
    const PatchedMesh patched = cutIntoPatches(*input.mesh, *input.provenance, textured);
    const std::vector<Subset> subsets = subsetsOf(patched);
    const std::vector<std::string> names = distinctNames(input.provenance->materials, identifierOf);
    const std::string root = identifierOf(input.name);
    if (input.progress) input.progress->begin("write", 4);

    OutFile out(temporary, target, input.progress);
    writeLayer(out, input, root);
    out.text(
        fmt::format("def Xform \"{}\" (\n    kind = \"component\"\n)\n{{\n    def Mesh \"Surface\"\n    {{\n"
                    "        uniform token subdivisionScheme = \"none\"\n",
                    root));
    MeshPrim prim(out, input, patched);
    prim.topology();
    tick(input.progress);
    prim.vertices();
    tick(input.progress);
    prim.colors(subsets);
    if (textured) prim.textureCoordinates();
    tick(input.progress);
    prim.subsets(subsets, names, root);
    out.text("    }\n\n");
    writeMaterials(out, *input.provenance, subsets, names, root);
    out.text("}\n");
    tick(input.progress);
    return out.finish();
}

}  // namespace sgm::exporter
