#include "modeler/export/gltf_primitive.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace sgm::exporter {
namespace {

/// Steps that 16 bits count, less one for the rounding at either end.
constexpr double mostSteps = 65534;

template <class T>
Status read(const tinygltf::Model& model, int index, int type, int componentType, std::vector<T>& out) {
    const tinygltf::Accessor& accessor = model.accessors[static_cast<size_t>(index)];
    if (accessor.type != type || accessor.componentType != componentType)
        return Error{Error::Kind::Input, fmt::format("accessor {} has a type that packing doesn't know", index)};
    const tinygltf::BufferView& view = model.bufferViews[static_cast<size_t>(accessor.bufferView)];
    const size_t stride = view.byteStride > 0 ? view.byteStride : sizeof(T);
    const auto& data = model.buffers[static_cast<size_t>(view.buffer)].data;
    const unsigned char* from = data.data() + view.byteOffset + accessor.byteOffset;
    out.resize(accessor.count);
    for (size_t i = 0; i < out.size(); ++i) std::memcpy(&out[i], from + i * stride, sizeof(T));
    return Done{};
}

RawAttribute readRaw(const tinygltf::Model& model, int index) {
    const tinygltf::Accessor& accessor = model.accessors[static_cast<size_t>(index)];
    const tinygltf::BufferView& view = model.bufferViews[static_cast<size_t>(accessor.bufferView)];
    const auto size =
        static_cast<size_t>(tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(accessor.componentType)) *
                            tinygltf::GetNumComponentsInType(static_cast<uint32_t>(accessor.type)));
    RawAttribute out{accessor.componentType, accessor.type, accessor.normalized, size, {}};
    const unsigned char* from =
        model.buffers[static_cast<size_t>(view.buffer)].data.data() + view.byteOffset + accessor.byteOffset;
    for (size_t i = 0; i<accessor.count; ++i, from += view.byteStride> 0 ? view.byteStride : size)
        out.bytes.insert(out.bytes.end(), from, from + size);
    return out;
}

}  // namespace

bool isSurface(const tinygltf::Mesh& mesh) {
    return std::all_of(mesh.primitives.begin(), mesh.primitives.end(),
                       [](const tinygltf::Primitive& p) { return p.attributes.count("NORMAL") > 0; });
}

Result<PrimitiveData> readPrimitive(const tinygltf::Model& model, const tinygltf::Primitive& primitive) {
    PrimitiveData data;
    constexpr int number = TINYGLTF_COMPONENT_TYPE_FLOAT;
    for (const auto& [name, index] : primitive.attributes) {
        Status status = Done{};
        if (name == "POSITION")
            status = read(model, index, TINYGLTF_TYPE_VEC3, number, data.positions);
        else if (name == "NORMAL")
            status = read(model, index, TINYGLTF_TYPE_VEC3, number, data.normals);
        else if (name.starts_with("TEXCOORD_"))
            status = read(model, index, TINYGLTF_TYPE_VEC2, number, data.textureCoordinates[name]);
        else
            data.others[name] = readRaw(model, index);
        if (!status.ok()) return status.error();
    }
    if (const Status status =
            read(model, primitive.indices, TINYGLTF_TYPE_SCALAR, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, data.indices);
        !status.ok())
        return status.error();
    return data;
}

Result<MeshData> readMesh(const tinygltf::Model& model, const tinygltf::Mesh& mesh) {
    MeshData data;
    for (const tinygltf::Primitive& primitive : mesh.primitives) {
        auto read = readPrimitive(model, primitive);
        if (!read.ok()) return read.error();
        for (const Vec3f& p : read->positions) data.bounds = hull(data.bounds, p);
        data.primitives.push_back(std::move(*read));
    }
    return data;
}

TakenData::TakenData(tinygltf::Model& model)
    : model_(model),
      bytes_(std::move(model.buffers[0].data)),
      views_(std::move(model.bufferViews)),
      accessors_(std::move(model.accessors)) {
    model.buffers[0].data.clear();
    model.bufferViews.clear();
    model.accessors.clear();
}

void TakenData::keep(tinygltf::Primitive& primitive, const AddView& addView) {
    for (auto& [name, index] : primitive.attributes) index = keep(index, addView);
    primitive.indices = keep(primitive.indices, addView);
}

int TakenData::keep(int index, const AddView& addView) {
    tinygltf::Accessor accessor = accessors_[static_cast<size_t>(index)];
    const auto [at, fresh] = kept_.try_emplace(accessor.bufferView, 0);
    if (fresh) {
        const tinygltf::BufferView& view = views_[static_cast<size_t>(accessor.bufferView)];
        at->second = addView(view, {bytes_.data() + view.byteOffset, view.byteLength});
    }
    accessor.bufferView = at->second;
    return addAccessor(model_, accessor);
}

int addAccessor(tinygltf::Model& model, const tinygltf::Accessor& accessor) {
    model.accessors.push_back(accessor);
    return static_cast<int>(model.accessors.size()) - 1;
}

int64_t QuantizationGrid::nearest(double v) const { return std::llround(v / step); }

int64_t QuantizationGrid::below(double v) const { return static_cast<int64_t>(std::floor(v / step)); }

QuantizationGrid gridOver(double extent) {
    if (!(extent > 0) || !std::isfinite(extent)) return {};
    int exponent = 0;
    const double mantissa = std::frexp(extent / mostSteps, &exponent);  // in [½, 1)
    return {std::ldexp(1, mantissa == 0.5 ? exponent - 1 : exponent)};
}

}  // namespace sgm::exporter
