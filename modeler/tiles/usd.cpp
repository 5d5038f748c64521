#include "modeler/tiles/usd.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "modeler/core/atomic_file.h"

namespace sgm::tiles {
namespace {

namespace fs = std::filesystem;

std::string header(const char* prim) {
    return fmt::format("#usda 1.0\n(\n    defaultPrim = \"{}\"\n    metersPerUnit = 1\n    upAxis = \"Y\"\n)\n\n",
                       prim);
}

std::string quoted(const std::string& text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') out += '\\';
        out += c == '\n' ? ' ' : c;
    }
    return out + "\"";
}

/// `count` items in brackets, each as `item(i)` says.
template <class Item>
std::string listOf(size_t count, Item item) {
    std::string out = "[";
    for (size_t i = 0; i < count; ++i) {
        if (i > 0) out += ", ";
        out += item(i);
    }
    return out + "]";
}

std::string tuple(Vec3f v) { return fmt::format("({}, {}, {})", v.x, v.y, v.z); }

/// A mesh with a subset of faces for every material, and the materials below `looks`.
std::string meshOf(const char* name, const std::vector<SurfacePiece>& pieces, const std::vector<Material>& materials,
                   const std::string& looks) {
    std::vector<Vec3f> positions, normals;
    std::vector<uint32_t> indices;
    std::string subsets, surfaces;
    std::set<uint32_t> known;
    for (const SurfacePiece& piece : pieces) {
        const size_t first = indices.size() / 3, count = piece.indices.size() / 3;
        const auto base = static_cast<uint32_t>(positions.size());
        for (const uint32_t i : piece.indices) indices.push_back(base + i);
        positions.insert(positions.end(), piece.positions.begin(), piece.positions.end());
        normals.insert(normals.end(), piece.normals.begin(), piece.normals.end());
        const std::string look = fmt::format("look{}", piece.material);
        subsets += fmt::format(
            "        def GeomSubset \"{}\" (\n            prepend apiSchemas = [\"MaterialBindingAPI\"]\n        )\n   "
            "     {{\n"
            "            uniform token elementType = \"face\"\n            uniform token familyName = "
            "\"materialBind\"\n"
            "            int[] indices = {}\n            rel material:binding = <{}/{}>\n        }}\n",
            look, listOf(count, [&](size_t i) { return std::to_string(first + i); }), looks, look);
        if (!known.insert(piece.material).second) continue;
        const Material& m = materials[piece.material];
        surfaces += fmt::format(
            "        def Material \"{0}\" (\n            displayName = {1}\n        )\n        {{\n"
            "            token outputs:surface.connect = <{2}/{0}/surface.outputs:surface>\n"
            "            def Shader \"surface\"\n            {{\n                uniform token info:id = "
            "\"UsdPreviewSurface\"\n"
            "                color3f inputs:diffuseColor = {3}\n                float inputs:roughness = {4}\n"
            "                float inputs:metallic = {5}\n                token outputs:surface\n            }}\n      "
            "  }}\n",
            look, quoted(m.name), looks, tuple(m.color), m.roughness, m.metallic);
    }
    const Box3f box = boundsOf(pieces);
    std::string out = fmt::format("    def Mesh \"{}\"\n    {{\n", name);
    out += fmt::format("        uniform token subdivisionScheme = \"none\"\n        float3[] extent = [{}, {}]\n",
                       tuple(box.lo), tuple(box.hi));
    out += "        int[] faceVertexCounts = " + listOf(indices.size() / 3, [](size_t) { return "3"; }) + "\n";
    out += "        int[] faceVertexIndices = " +
           listOf(indices.size(), [&](size_t i) { return std::to_string(indices[i]); }) + "\n";
    out +=
        "        point3f[] points = " + listOf(positions.size(), [&](size_t i) { return tuple(positions[i]); }) + "\n";
    out += "        normal3f[] normals = " + listOf(normals.size(), [&](size_t i) { return tuple(normals[i]); }) +
           " (\n            interpolation = \"vertex\"\n        )\n";
    return out + subsets + "    }\n    def Scope \"" + looks.substr(looks.rfind('/') + 1) + "\"\n    {\n" + surfaces +
           "    }\n";
}

std::string instancerOf(const CellContent& content) {
    std::vector<const Part*> parts;
    std::vector<size_t> prototypes;
    for (size_t i = 0; i < content.objects.size(); ++i)
        for (const CellPlace& place : content.objects[i].places) parts.push_back(place.part), prototypes.push_back(i);
    const size_t count = parts.size();
    std::string out =
        "    def PointInstancer \"Places\"\n    {\n        rel prototypes = " +
        listOf(content.objects.size(), [](size_t i) { return fmt::format("</Cell/Places/Objects/o{}>", i); }) +
        "\n        def Scope \"Objects\"\n        {\n";
    for (size_t i = 0; i < content.objects.size(); ++i)
        out += fmt::format(
            "            def Xform \"o{}\" (\n                prepend references = @{}@\n            )\n"
            "            {{\n            }}\n",
            i, content.objects[i].file);
    out += "        }\n        int[] protoIndices = " +
           listOf(count, [&](size_t i) { return std::to_string(prototypes[i]); });
    out += "\n        point3f[] positions = " +
           listOf(count, [&](size_t i) { return tuple((parts[i]->pose.origin - content.centre).as<float>()); });
    out += "\n        quath[] orientations = " + listOf(count, [&](size_t i) {
               const auto q = mesh::quaternionOf(parts[i]->pose.axes);
               return fmt::format("({:.5f}, {:.5f}, {:.5f}, {:.5f})", q[3], q[0], q[1], q[2]);
           });
    const auto texts = [&](const char* name, auto text) {
        out += fmt::format("\n        string[] primvars:{} = ", name) +
               listOf(count, [&](size_t i) { return quoted(text(*parts[i])); }) +
               " (\n            interpolation = \"varying\"\n        )";
    };
    texts("path", [](const Part& part) { return part.path.text(); });
    texts("rule", [](const Part& part) { return part.rule(); });
    out +=
        "\n        int[] primvars:line = " + listOf(count, [&](size_t i) { return std::to_string(parts[i]->line()); }) +
        " (\n            interpolation = \"varying\"\n        )\n    }\n";
    return out;
}

}  // namespace

Status writeUsdObject(const LibraryObject& object, const fs::path& path) {
    std::string values;
    for (const auto& [name, value] : object.values) {
        std::string word = name;
        std::replace(word.begin(), word.end(), ' ', '_');
        values += fmt::format("        string {} = {}\n", word, quoted(value));
    }
    return writeFile(path, header("Object") + "def Xform \"Object\" (\n    displayName = " + quoted(object.name) +
                               "\n    kind = \"component\"\n    customData = {\n" + values + "    }\n)\n{\n" +
                               meshOf("Surface", object.pieces, object.materials, "/Object/Looks") + "}\n");
}

Status writeUsdCell(const CellContent& content, const fs::path& path) {
    std::string text = header("Cell") + "def Xform \"Cell\"\n{\n";
    if (!content.ground.empty()) text += meshOf("Ground", content.ground, content.materials, "/Cell/Looks");
    if (!content.objects.empty()) text += instancerOf(content);
    return writeFile(path, text + "}\n");
}

Status writeUsdStage(const std::vector<UsdPayload>& cells, const fs::path& path) {
    std::string text = header("City") + "def Xform \"City\" (\n    kind = \"assembly\"\n)\n{\n";
    for (const UsdPayload& cell : cells)
        text += fmt::format(
            "    def Xform \"{}\" (\n        kind = \"group\"\n        prepend payload = @{}@\n    )\n    {{\n"
            "        double3 xformOp:translate = ({}, {}, {})\n"
            "        uniform token[] xformOpOrder = [\"xformOp:translate\"]\n    }}\n",
            cell.name, cell.file, cell.centre.x, cell.centre.y, cell.centre.z);
    return writeFile(path, text + "}\n");
}

}  // namespace sgm::tiles
