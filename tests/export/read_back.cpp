#include "tests/export/read_back.h"

#include <tiny_gltf.h>
#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

#include <cstring>
#include <sstream>
#include <tuple>

#include "tests/scratch.h"

namespace sgm::exporter {
namespace {

template <class T>
std::vector<T> elements(const tinygltf::Model& model, int index) {
    const auto& accessor = model.accessors[static_cast<size_t>(index)];
    const auto& view = model.bufferViews[static_cast<size_t>(accessor.bufferView)];
    const size_t stride = static_cast<size_t>(accessor.ByteStride(view));
    const unsigned char* data = model.buffers[0].data.data() + view.byteOffset + accessor.byteOffset;
    std::vector<T> out(accessor.count);
    for (size_t i = 0; i < out.size(); ++i) std::memcpy(&out[i], data + i * stride, sizeof(T));
    return out;
}

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from) {
    to.insert(to.end(), from.begin(), from.end());
}

ReadBack readGltf(const std::filesystem::path& path) {
    tinygltf::Model model;
    std::string error, warning;
    const bool ok = path.extension() == ".glb"
                        ? tinygltf::TinyGLTF().LoadBinaryFromFile(&model, &error, &warning, path.string())
                        : tinygltf::TinyGLTF().LoadASCIIFromFile(&model, &error, &warning, path.string());
    ReadBack out;
    if (!ok || !error.empty() || !warning.empty()) return out;
    out.generator = model.asset.generator;
    for (const auto& key : model.nodes[0].extras.Keys())
        out.extras[key] = model.nodes[0].extras.Get(key).Get<std::string>();
    for (const auto& primitive : model.meshes[0].primitives) {
        const auto& material = model.materials[static_cast<size_t>(primitive.material)];
        const auto& color = material.pbrMetallicRoughness.baseColorFactor;
        out.colors[material.name] = Vec3d{color[0], color[1], color[2]}.as<float>();
        const auto base = static_cast<uint32_t>(out.positions.size());
        append(out.positions, elements<Vec3f>(model, primitive.attributes.at("POSITION")));
        append(out.normals, elements<Vec3f>(model, primitive.attributes.at("NORMAL")));
        if (const auto uv = primitive.attributes.find("TEXCOORD_0"); uv != primitive.attributes.end())
            append(out.uvs, elements<std::array<float, 2>>(model, uv->second));
        const auto indices = elements<uint32_t>(model, primitive.indices);
        for (size_t i = 0; i + 2 < indices.size(); i += 3) {
            out.triangles.push_back({base + indices[i], base + indices[i + 1], base + indices[i + 2]});
            out.materials.push_back(material.name);
        }
    }
    return out;
}

struct Traits : OpenMesh::DefaultTraits {
    VertexAttributes(OpenMesh::Attributes::Normal | OpenMesh::Attributes::TexCoord2D | OpenMesh::Attributes::Color);
    FaceAttributes(OpenMesh::Attributes::Color);
};

/// Names a colour byte by byte, as materials have lost their names in these formats.
template <class Color>
std::string colorName(const Color& c) {
    return std::to_string(int{c[0]}) + " " + std::to_string(int{c[1]}) + " " + std::to_string(int{c[2]});
}

ReadBack readOpenMesh(const std::filesystem::path& path) {
    using Options = OpenMesh::IO::Options;
    OpenMesh::TriMesh_ArrayKernelT<Traits> mesh;
    const std::string extension = path.extension().string();
    Options options = Options::Default;
    if (extension == ".ply") options = Options::VertexNormal | Options::VertexTexCoord | Options::VertexColor;
    if (extension == ".obj") options = Options::VertexNormal | Options::VertexTexCoord | Options::FaceColor;
    ReadBack out;
    if (!OpenMesh::IO::read_mesh(mesh, path.string(), options)) return out;
    for (const auto v : mesh.vertices()) {
        const auto p = mesh.point(v), n = mesh.normal(v);
        out.positions.push_back({p[0], p[1], p[2]});
        if (options.check(Options::VertexNormal)) out.normals.push_back({n[0], n[1], n[2]});
        if (options.check(Options::VertexTexCoord)) out.uvs.push_back({mesh.texcoord2D(v)[0], mesh.texcoord2D(v)[1]});
    }
    for (const auto f : mesh.faces()) {
        auto v = mesh.cfv_begin(f);
        mesh::Triangle t;
        for (int corner = 0; corner < 3; ++corner, ++v) t[corner] = static_cast<uint32_t>(v->idx());
        out.triangles.push_back(t);
        if (options.check(Options::FaceColor)) out.materials.push_back(colorName(mesh.color(f)));
        if (options.check(Options::VertexColor))
            out.materials.push_back(colorName(mesh.color(mesh.vertex_handle(t.x))));
    }
    return out;
}

/// The numbers between the brackets that follow `declaration`, from position `from` on.
std::vector<float> usdNumbers(const std::string& text, const std::string& declaration, size_t from = 0) {
    std::vector<float> numbers;
    const size_t at = text.find(declaration + " = [", from);
    if (at == std::string::npos) return numbers;
    const size_t begin = at + declaration.size() + 4;
    std::string list = text.substr(begin, text.find(']', begin) - begin);
    for (char& c : list)
        if (c == ',' || c == '(' || c == ')') c = ' ';
    std::istringstream in(list);
    for (float v; in >> v;) numbers.push_back(v);
    return numbers;
}

std::vector<Vec3f> triples(const std::vector<float>& numbers) {
    std::vector<Vec3f> out;
    for (size_t i = 0; i + 2 < numbers.size(); i += 3) out.push_back({numbers[i], numbers[i + 1], numbers[i + 2]});
    return out;
}

ReadBack readUsda(const std::filesystem::path& path) {
    const std::string text = contentOf(path);
    ReadBack out;
    out.positions = triples(usdNumbers(text, "point3f[] points"));
    out.normals = triples(usdNumbers(text, "normal3f[] normals"));
    for (const Vec3f t : triples(usdNumbers(text, "int[] faceVertexIndices")))
        out.triangles.push_back(t.as<uint32_t>());
    out.materials.resize(out.triangles.size());
    const std::string subset = "def GeomSubset \"";
    for (size_t at = text.find(subset); at != std::string::npos; at = text.find(subset, at + 1)) {
        const size_t begin = at + subset.size();
        for (const float face : usdNumbers(text, "int[] indices", at))
            out.materials[static_cast<size_t>(face)] = text.substr(begin, text.find('"', begin) - begin);
    }
    return out;
}

}  // namespace

ReadBack readBack(const std::filesystem::path& path) {
    const std::string extension = path.extension().string();
    if (extension == ".glb" || extension == ".gltf") return readGltf(path);
    return extension == ".usda" ? readUsda(path) : readOpenMesh(path);
}

ReadBack welded(const ReadBack& in) {
    ReadBack out;
    std::map<std::tuple<float, float, float>, uint32_t> known;
    std::vector<uint32_t> number;
    for (const Vec3f& p : in.positions) {
        const auto [it, fresh] = known.try_emplace({p.x, p.y, p.z}, static_cast<uint32_t>(out.positions.size()));
        if (fresh) out.positions.push_back(p);
        number.push_back(it->second);
    }
    for (const mesh::Triangle& t : in.triangles) out.triangles.push_back({number[t.x], number[t.y], number[t.z]});
    out.materials = in.materials;
    return out;
}

}  // namespace sgm::exporter
