// glTF 2.0, binary (.glb) and as JSON with its buffer embedded (.gltf): Khronos, glTF 2.0 specification.
// One node, one mesh, one primitive a material; metres and Y up are the format's own conventions.
#include <tiny_gltf.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <ostream>

#include "modeler/core/atomic_file.h"
#include "modeler/core/polled_file.h"
#include "modeler/export/formats.h"
#include "modeler/export/gltf_colliders.h"
#include "modeler/export/gltf_draco.h"
#include "modeler/export/gltf_meshopt.h"
#include "modeler/export/surface.h"

namespace sgm::exporter {
namespace {

/// One stretch of the buffer: `components` numbers of four bytes an element.
struct View {
    int index;  ///< into Model::bufferViews
    size_t offset, stride;
};

/// Appends a zeroed buffer view of `count` elements.
View addView(tinygltf::Model& model, size_t count, int components, int target) {
    auto& data = model.buffers[0].data;
    const View view{static_cast<int>(model.bufferViews.size()), data.size(), 4 * static_cast<size_t>(components)};
    tinygltf::BufferView entry;
    entry.buffer = 0;
    entry.byteOffset = view.offset;
    entry.byteLength = count * view.stride;
    entry.byteStride = target == TINYGLTF_TARGET_ARRAY_BUFFER ? view.stride : 0;
    entry.target = target;
    data.resize(data.size() + entry.byteLength);
    model.bufferViews.push_back(entry);
    return view;
}

/// Appends an accessor of elements [first, first + count) of a view and returns its index.
int addAccessor(tinygltf::Model& model, const View& view, size_t first, size_t count, int type, int componentType) {
    tinygltf::Accessor accessor;
    accessor.bufferView = view.index;
    accessor.byteOffset = first * view.stride;
    accessor.componentType = componentType;
    accessor.type = type;
    accessor.count = count;
    model.accessors.push_back(accessor);
    return static_cast<int>(model.accessors.size()) - 1;
}

/// A number as it was meant: 0.8f as 0.8, six digits being more than a colour has.
double decimal(float v) { return std::round(std::clamp(static_cast<double>(v), 0.0, 1.0) * 1e6) / 1e6; }

int addMaterial(tinygltf::Model& model, const Material& material) {
    tinygltf::Material entry;
    entry.name = validUtf8(material.name);
    auto& pbr = entry.pbrMetallicRoughness;
    pbr.baseColorFactor = {decimal(material.color.x), decimal(material.color.y), decimal(material.color.z), 1.0};
    pbr.roughnessFactor = decimal(material.roughness);
    pbr.metallicFactor = decimal(material.metallic);
    model.materials.push_back(entry);
    return static_cast<int>(model.materials.size()) - 1;
}

/// Fills the buffer patch by patch and adds one primitive a material.
class MeshBuilder {
public:
    MeshBuilder(const ExportInput& input, bool textured)
        : input_(input), patched_(cutIntoPatches(*input.mesh, *input.provenance, textured)), vertices_(*input.mesh) {
        model.buffers.emplace_back();
        // One allocation: the buffer is the largest thing here.
        model.buffers[0].data.reserve(patched_.vertices.size() * (textured ? 32 : 24) + patched_.triangles.size() * 12);
        positions_ = addView(model, patched_.vertices.size(), 3, TINYGLTF_TARGET_ARRAY_BUFFER);
        normals_ = addView(model, patched_.vertices.size(), 3, TINYGLTF_TARGET_ARRAY_BUFFER);
        if (textured) uvs_ = addView(model, patched_.vertices.size(), 2, TINYGLTF_TARGET_ARRAY_BUFFER);
        indices_ = addView(model, patched_.triangles.size(), 3, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
        indices_.stride = 4;  // an element of an index accessor is one index
        textured_ = textured;
    }

    /// False when the progress was cancelled.
    bool build() {
        model.meshes.emplace_back();
        model.meshes[0].name = validUtf8(input_.name);
        if (input_.progress) input_.progress->begin("write", patched_.patches.size());
        for (size_t i = 0; i < patched_.patches.size();) {
            size_t end = i;
            while (end < patched_.patches.size() && patched_.patches[end].material == patched_.patches[i].material)
                ++end;
            addPrimitive(i, end);
            if (cancelled(input_.progress)) return false;
            tick(input_.progress, end - i);
            i = end;
        }
        return true;
    }

    tinygltf::Model model;

private:
    template <class T>
    void put(const View& view, size_t element, const T& value) {
        std::memcpy(model.buffers[0].data.data() + view.offset + element * view.stride, &value, sizeof value);
    }

    /// Patches [begin, end) share a material: their vertices and triangles lie one after another.
    void addPrimitive(size_t begin, size_t end) {
        const Patch& first = patched_.patches[begin];
        const Patch& last = patched_.patches[end - 1];
        const size_t vertexCount = last.firstVertex + last.vertexCount - first.firstVertex;
        const size_t triangleCount = last.firstTriangle + last.triangleCount - first.firstTriangle;
        Box3f bounds;
        for (size_t i = begin; i < end; ++i) putVertices(patched_.patches[i], bounds);
        const Vec3<uint32_t> base{first.firstVertex, first.firstVertex, first.firstVertex};
        for (size_t t = first.firstTriangle; t < first.firstTriangle + triangleCount; ++t)
            put(indices_, 3 * t, patched_.triangles[t] - base);

        tinygltf::Primitive primitive;
        primitive.mode = TINYGLTF_MODE_TRIANGLES;
        primitive.material = addMaterial(model, input_.provenance->materials[first.material]);
        const auto attribute = [&](const View& view, int type) {
            return addAccessor(model, view, first.firstVertex, vertexCount, type, TINYGLTF_COMPONENT_TYPE_FLOAT);
        };
        const int position = primitive.attributes["POSITION"] = attribute(positions_, TINYGLTF_TYPE_VEC3);
        model.accessors[static_cast<size_t>(position)].minValues = {bounds.lo.x, bounds.lo.y, bounds.lo.z};
        model.accessors[static_cast<size_t>(position)].maxValues = {bounds.hi.x, bounds.hi.y, bounds.hi.z};
        primitive.attributes["NORMAL"] = attribute(normals_, TINYGLTF_TYPE_VEC3);
        if (textured_) primitive.attributes["TEXCOORD_0"] = attribute(uvs_, TINYGLTF_TYPE_VEC2);
        primitive.indices = addAccessor(model, indices_, 3 * size_t{first.firstTriangle}, 3 * triangleCount,
                                        TINYGLTF_TYPE_SCALAR, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT);
        model.meshes[0].primitives.push_back(primitive);
    }

    void putVertices(const Patch& patch, Box3f& bounds) {
        for (uint32_t v = patch.firstVertex; v < patch.firstVertex + patch.vertexCount; ++v) {
            if (cancelled(input_.progress)) return;
            const Vec3f position = vertices_.position(patched_.vertices[v]);
            bounds = hull(bounds, position);
            put(positions_, v, position);
            put(normals_, v, patched_.normal(v, vertices_));
            if (!textured_) continue;
            auto uv = boxProjection(position, patch.facing);
            uv[1] = 1 - uv[1];  // glTF counts v downwards
            put(uvs_, v, uv);
        }
    }

    const ExportInput& input_;
    PatchedMesh patched_;
    Vertices vertices_;
    View positions_, normals_, uvs_, indices_;
    bool textured_ = false;
};

void addScene(tinygltf::Model& model, const ExportInput& input) {
    model.asset.version = "2.0";
    model.asset.generator = "sgm";
    tinygltf::Node node;
    node.name = validUtf8(input.name);
    node.mesh = 0;
    if (!input.extras.empty()) {
        // On the node, where viewers show them as the object's own properties.
        tinygltf::Value::Object extras;
        for (const auto& [key, value] : input.extras) extras[validUtf8(key)] = tinygltf::Value(validUtf8(value));
        node.extras = tinygltf::Value(extras);
    }
    model.nodes.push_back(node);
    tinygltf::Scene scene;
    scene.nodes = {0};
    model.scenes.push_back(scene);
    model.defaultScene = 0;
}

Error tooLarge(const Path& target) {
    return writeError(target, "the mesh is larger than the 4 GB a .glb can hold; choose another format");
}

/// Whether a .glb with such a buffer keeps its lengths within 32 bits; a little room is left for the JSON.
bool fits(const tinygltf::Model& model, bool binary) { return !binary || model.buffers[0].data.size() <= 0xfff00000u; }

/// Fills the temporary file by `fill(stream)`.
template <class Fill>
Status writeStream(const ExportInput& input, const Path& temporary, const Path& target, Fill fill) {
    errno = 0;
    PolledFile file(temporary, input.progress);
    std::ostream out(&file);
    fill(out);
    if (!file.close()) out.setstate(std::ios::badbit);
    if (cancelled(input.progress)) return cancelledError();
    if (!out) return writeError(target, errno != 0 ? errno : EIO);
    return Done{};
}

Status writeScene(const ExportInput& input, const Path& temporary, const Path& target, bool binary) {
    MeshBuilder builder(input, option(input, "uv", "box") == "box");
    if (!builder.build()) return cancelledError();
    addScene(builder.model, input);
    if (Status status = addColliders(builder.model, input); !status.ok()) return status;
    const std::string_view pack = option(input, "pack", "none");
    if (pack == "meshopt") {
        auto packed = packByMeshopt(std::move(builder.model), input.progress);
        if (!packed.ok()) return packed.error();
        if (!fits(packed->model, binary)) return tooLarge(target);
        return writeStream(input, temporary, target, [&](std::ostream& out) { writeMeshopt(*packed, out, binary); });
    }
    if (pack == "draco")
        if (Status status = packByDraco(builder.model, input.progress); !status.ok()) return status;
    if (!fits(builder.model, binary)) return tooLarge(target);
    return writeStream(input, temporary, target, [&](std::ostream& out) {
        tinygltf::TinyGLTF().WriteGltfSceneToStream(&builder.model, out, !binary, binary);
    });
}

}  // namespace

Status writeGlb(const ExportInput& input, const Path& temporary, const Path& target) {
    return writeScene(input, temporary, target, true);
}

Status writeGltf(const ExportInput& input, const Path& temporary, const Path& target) {
    return writeScene(input, temporary, target, false);
}

}  // namespace sgm::exporter
