// glTF 2.0, binary (.glb) and as JSON with its buffer embedded (.gltf): Khronos, glTF 2.0 specification.
// A mesh an object, a primitive a material; metres and Y up are the format's own conventions.
#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <optional>
#include <ostream>

#include "modeler/core/atomic_file.h"
#include "modeler/core/polled_file.h"
#include "modeler/export/formats.h"
#include "modeler/export/gltf_colliders.h"
#include "modeler/export/gltf_draco.h"
#include "modeler/export/gltf_instances.h"
#include "modeler/export/gltf_levels.h"
#include "modeler/export/gltf_meshopt.h"
#include "modeler/export/gltf_nodes.h"
#include "modeler/export/gltf_textures.h"
#include "modeler/export/surface.h"
#include "modeler/export/texture_sets.h"
#include "modeler/image/texture.h"

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
int addAccessorOfView(tinygltf::Model& model, const View& view, size_t first, size_t count, int type,
                      int componentType) {
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

int addMaterial(tinygltf::Model& model, const Material& material, GltfTextures* textures) {
    tinygltf::Material entry;
    entry.name = validUtf8(material.name);
    auto& pbr = entry.pbrMetallicRoughness;
    pbr.baseColorFactor = {decimal(material.color.x), decimal(material.color.y), decimal(material.color.z), 1.0};
    pbr.roughnessFactor = decimal(material.roughness);
    pbr.metallicFactor = decimal(material.metallic);
    if (textures && material.texture) textures->cover(entry, *material.texture);
    model.materials.push_back(entry);
    return static_cast<int>(model.materials.size()) - 1;
}

/// A light of 0 … 1 in 16 bits.
uint16_t word(float light) { return static_cast<uint16_t>(std::lround(65535 * std::clamp(light, 0.0f, 1.0f))); }

/// Fills the buffer patch by patch and adds a mesh an object, a primitive a patch.
class MeshBuilder {
public:
    /// `textures` gathers the pictures of the materials.
    MeshBuilder(const ExportInput& input, TextureSets texture, GltfTextures& textures)
        : input_(input),
          textures_(textures),
          texture_(std::move(texture)),
          patched_(cutIntoPatches(*input.mesh, *input.provenance,
                                  {input.objects, texture_.charts.ofTriangle, input.byMaterial})),
          vertices_(*input.mesh),
          materials_(input.provenance->materials.size(), -1) {
        model.buffers.emplace_back();
        if (patched_.triangles.empty()) return;  // no view of a glTF file is empty
        const size_t count = patched_.vertices.size(), textured = texture_.empty() ? 0 : texture_.light ? 16 : 8;
        // One allocation: the buffer is the largest thing here.
        model.buffers[0].data.reserve(count * (24 + textured + (input.byMaterial ? 0 : 8)) +
                                      patched_.triangles.size() * 12);
        positions_ = addView(model, count, 3, TINYGLTF_TARGET_ARRAY_BUFFER);
        normals_ = addView(model, count, 3, TINYGLTF_TARGET_ARRAY_BUFFER);
        if (textured) uvs_ = addView(model, count, 2, TINYGLTF_TARGET_ARRAY_BUFFER);
        if (textured && hasReliefs()) tangents_ = addView(model, count, 4, TINYGLTF_TARGET_ARRAY_BUFFER);
        if (texture_.light) lightUvs_ = addView(model, count, 2, TINYGLTF_TARGET_ARRAY_BUFFER);
        if (!input.byMaterial) colors_ = addView(model, count, 2, TINYGLTF_TARGET_ARRAY_BUFFER);
        indices_ = addView(model, patched_.triangles.size(), 3, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
        indices_.stride = 4;  // an element of an index accessor is one index
    }

    /// False when the progress was cancelled.
    bool build() {
        meshOfNode.assign(input_.objects ? input_.objects->nodes.size() : 1, -1);
        if (input_.progress) input_.progress->begin("write", patched_.patches.size());
        for (size_t i = 0; i < patched_.patches.size();) {
            const size_t end = patched_.endOfObject(i);
            const uint32_t object = patched_.patches[i].object;
            meshOfNode[object] = static_cast<int>(model.meshes.size());
            tinygltf::Mesh mesh;
            mesh.name = validUtf8(object == 0 ? input_.name : input_.objects->nodes[object].name);
            for (; i < end; ++i) {
                mesh.primitives.push_back(primitiveOf(patched_.patches[i]));
                if (cancelled(input_.progress)) return false;
                tick(input_.progress);
            }
            model.meshes.push_back(std::move(mesh));
        }
        return true;
    }

    tinygltf::Model model;
    std::vector<int> meshOfNode;  ///< by node of the object tree; -1: none

private:
    template <class T>
    void put(const View& view, size_t element, const T& value) {
        std::memcpy(model.buffers[0].data.data() + view.offset + element * view.stride, &value, sizeof value);
    }

    tinygltf::Primitive primitiveOf(const Patch& patch) {
        Box3f bounds;
        putVertices(patch, bounds);
        const Vec3<uint32_t> base{patch.firstVertex, patch.firstVertex, patch.firstVertex};
        for (size_t t = patch.firstTriangle; t < patch.firstTriangle + patch.triangleCount; ++t)
            put(indices_, 3 * t, patched_.triangles[t] - base);

        tinygltf::Primitive primitive;
        primitive.mode = TINYGLTF_MODE_TRIANGLES;
        primitive.material = materialOf(patch.material);
        const auto attribute = [&](const View& view, int type, int component = TINYGLTF_COMPONENT_TYPE_FLOAT) {
            return addAccessorOfView(model, view, patch.firstVertex, patch.vertexCount, type, component);
        };
        const int position = primitive.attributes["POSITION"] = attribute(positions_, TINYGLTF_TYPE_VEC3);
        model.accessors[static_cast<size_t>(position)].minValues = {bounds.lo.x, bounds.lo.y, bounds.lo.z};
        model.accessors[static_cast<size_t>(position)].maxValues = {bounds.hi.x, bounds.hi.y, bounds.hi.z};
        primitive.attributes["NORMAL"] = attribute(normals_, TINYGLTF_TYPE_VEC3);
        if (!texture_.empty()) primitive.attributes["TEXCOORD_0"] = attribute(uvs_, TINYGLTF_TYPE_VEC2);
        if (hasRelief(patch.material)) primitive.attributes["TANGENT"] = attribute(tangents_, TINYGLTF_TYPE_VEC4);
        if (texture_.light) primitive.attributes["TEXCOORD_1"] = attribute(lightUvs_, TINYGLTF_TYPE_VEC2);
        if (!input_.byMaterial) {
            const int color = primitive.attributes["COLOR_0"] =
                attribute(colors_, TINYGLTF_TYPE_VEC4, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT);
            model.accessors[static_cast<size_t>(color)].normalized = true;
        }
        primitive.indices =
            addAccessorOfView(model, indices_, 3 * size_t{patch.firstTriangle}, 3 * size_t{patch.triangleCount},
                              TINYGLTF_TYPE_SCALAR, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT);
        primitive.extras = originRuns(patched_, patch);
        return primitive;
    }

    /// Whether a normal map covers the material: readers need tangents for it.
    bool hasRelief(uint32_t material) const {
        const auto& texture = input_.provenance->materials[material].texture;
        return texture && texture->normals && input_.byMaterial && !texture_.empty();
    }
    bool hasReliefs() const {
        for (uint32_t m = 0; m < input_.provenance->materials.size(); ++m)
            if (hasRelief(m)) return true;
        return false;
    }

    /// The file's material, added with its first use.
    int materialOf(uint32_t material) {
        int& index = materials_[input_.byMaterial ? material : 0];
        if (index < 0) {
            const Material colorsAlone{"colors", {1, 1, 1}, 0.8f, 0.0f, nullptr};
            index = addMaterial(model, input_.byMaterial ? input_.provenance->materials[material] : colorsAlone,
                                texture_.empty() ? nullptr : &textures_);
        }
        return index;
    }

    void putVertices(const Patch& patch, Box3f& bounds) {
        for (uint32_t v = patch.firstVertex; v < patch.firstVertex + patch.vertexCount; ++v) {
            if (cancelled(input_.progress)) return;
            const Vec3f position = vertices_.position(patched_.vertices[v]);
            bounds = hull(bounds, position);
            put(positions_, v, position);
            put(normals_, v, patched_.normal(v, vertices_));
            if (!input_.byMaterial) {
                const Vec3f c = input_.provenance->materials[patched_.materials[v]].color;
                put(colors_, v, std::array<uint16_t, 4>{word(c.x), word(c.y), word(c.z), 65535});
            }
            const uint32_t chart = patched_.charts[v];
            if (hasRelief(patch.material))
                put(tangents_, v, tangentOf(texture_.charts.axes[chart], patched_.normal(v, vertices_)));
            if (!texture_.empty()) put(uvs_, v, downwards(texture_.charts.at(chart, position)));
            if (texture_.light) put(lightUvs_, v, downwards(texture_.light->at(chart, position)));
        }
    }

    /// Along u and square to the normal; the relief's y is up, along v.
    static std::array<float, 4> tangentOf(const ChartAxes& axes, Vec3f normal) {
        Vec3f along = axes.u - normal * dot(normal, axes.u);
        if (length(along) < 1e-3f) along = cross(axes.v, normal);
        along = along / length(along);
        return {along.x, along.y, along.z, 1};
    }

    /// glTF counts v downwards.
    static std::array<float, 2> downwards(std::array<float, 2> uv) { return {uv[0], 1 - uv[1]}; }

    const ExportInput& input_;
    GltfTextures& textures_;
    TextureSets texture_;
    PatchedMesh patched_;
    Vertices vertices_;
    View positions_{}, normals_{}, tangents_{}, uvs_{}, lightUvs_{}, colors_{}, indices_{};
    std::vector<int> materials_;  ///< by Provenance::materials: the file's, -1 where not yet used
};

Error tooLarge(const Path& target) {
    return writeError(target, "the mesh is larger than the 4 GB a .glb can hold; choose another format");
}

/// Whether a .glb with such a buffer keeps its lengths within 32 bits; a little room is left for the JSON.
bool fits(const tinygltf::Model& model, bool binary) { return !binary || model.buffers[0].data.size() <= 0xfff00000u; }

/// Fills the temporary file by `fill(stream)`.
template <class Fill>
static Status writeStream(const ExportInput& input, const Path& temporary, const Path& target, Fill fill) {
    errno = 0;
    PolledFile file(temporary, input.progress);
    std::ostream out(&file);
    fill(out);
    if (!file.close()) out.setstate(std::ios::badbit);
    if (cancelled(input.progress)) return cancelledError();
    if (!out) return writeError(target, errno != 0 ? errno : EIO);
    return Done{};
}

Result<tinygltf::Model> modelOfMesh(const ExportInput& input, GltfTextures& textures) {
    auto texture = makeTexture(input);
    if (!texture.ok()) return texture.error();
    MeshBuilder builder(input, std::move(*texture), textures);
    if (!builder.build()) return cancelledError();
    return std::move(builder.model);
}

static Status writeScene(const ExportInput& input, const Path& temporary, const Path& target, bool binary) {
    ExportInput own = input;  // without what is shown twice
    std::optional<SharedObjects> shared;
    if (input.objects)
        shared = option(input, "instances", "yes") == "yes" ? shareObjects(*input.mesh, *input.objects)
                                                            : keepOwnSurfaces(*input.objects);
    if (shared && shared->mesh) own.mesh = &*shared->mesh;
    auto texture = makeTexture(own);
    if (!texture.ok()) return texture.error();
    GltfTextures textures;
    const ModelOfMesh modelOf = [&](const ExportInput& other) { return modelOfMesh(other, textures); };
    MeshBuilder builder(own, std::move(*texture), textures);
    if (!builder.build()) return cancelledError();
    addScene(builder.model, input, shared ? &*shared : nullptr, builder.meshOfNode);
    builder.model.asset.extras = originTable(*input.provenance, *input.mesh);
    if (Status status = addInstances(builder.model, input, modelOf); !status.ok()) return status;
    if (Status status = addLevels(builder.model, input, modelOf); !status.ok()) return status;
    if (Status status = addColliders(builder.model, input); !status.ok()) return status;
    const std::string_view pack = option(input, "pack", "none");
    if (pack == "meshopt") {
        auto packed = packByMeshopt(std::move(builder.model), input.progress);
        if (!packed.ok()) return packed.error();
        textures.embed(packed->model);
        if (!fits(packed->model, binary)) return tooLarge(target);
        return writeStream(input, temporary, target, [&](std::ostream& out) { writeMeshopt(*packed, out, binary); });
    }
    if (pack == "draco")
        if (Status status = packByDraco(builder.model, input.progress); !status.ok()) return status;
    textures.embed(builder.model);
    if (!fits(builder.model, binary)) return tooLarge(target);
    return writeStream(input, temporary, target, [&](std::ostream& out) {
        tinygltf::TinyGLTF().WriteGltfSceneToStream(&builder.model, out, !binary, binary);
    });
}

}  // namespace

static Status writeGlb(const ExportInput& input, const Path& temporary, const Path& target) {
    return writeScene(input, temporary, target, true);
}

static Status writeGltf(const ExportInput& input, const Path& temporary, const Path& target) {
    return writeScene(input, temporary, target, false);
}

static constexpr ExportOption gltfOptions[] = {
    uvOption,
    lightMapOption,
    instancesOption("yes"),
    {"places", "nodes", "nodes|gpu",
     "how objects that `place` puts stand in the scene: a node a place, or EXT_mesh_gpu_instancing, a node an object"},
    {"engine", "godot", "godot|unreal|unity", "whose names colliders bear, so that it imports them as such"},
    {"pack", "none", "none|meshopt|draco",
     "compression, for readers that have it: 16-bit positions on one grid, 8-bit normals"},
    {"levels", "scene", "scene|msft",
     "where coarser levels of detail are: in the scene beside the finest, or outside, for readers of MSFT_lod alone"}};

constinit const Exporter glbFormat{
    .extension = ".glb",
    .doc = "glTF 2.0, binary: normals, texture coordinates, a primitive a material",
    .options = gltfOptions,
    .takesPositionsOnly = nullptr,
    .write = writeGlb,
    .stream = nullptr,
    .holdsObjects = true,
    .holdsScenes = true,
    .holdsLevels = true,
};

constinit const Exporter gltfFormat{
    .extension = ".gltf",
    .doc = "glTF 2.0 as JSON, with its buffer inside",
    .options = gltfOptions,
    .takesPositionsOnly = nullptr,
    .write = writeGltf,
    .stream = nullptr,
    .holdsObjects = true,
    .holdsScenes = true,
    .holdsLevels = true,
};

}  // namespace sgm::exporter
