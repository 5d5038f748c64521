#include "modeler/export/gltf_colliders.h"

#include <tiny_gltf.h>

#include <cstring>

#include "modeler/export/colliders.h"
#include "modeler/export/formats.h"

namespace sgm::exporter {
namespace {

/// The colliders' data one after another in one buffer view.
class View {
public:
    View(tinygltf::Model& model, size_t bytes, int target) : model_(model) {
        auto& data = model.buffers[0].data;
        data.resize((data.size() + 3) / 4 * 4);  // numbers begin at whole words
        next_ = begin_ = data.size();
        data.resize(data.size() + bytes);
        tinygltf::BufferView view;
        view.buffer = 0;
        view.byteOffset = begin_;
        view.byteLength = bytes;
        view.byteStride = target == TINYGLTF_TARGET_ARRAY_BUFFER ? sizeof(Vec3f) : 0;
        view.target = target;
        index_ = static_cast<int>(model.bufferViews.size());
        model.bufferViews.push_back(view);
    }

    /// Appends the bytes of `items` and an accessor of `count` elements; its index.
    template <class T>
    int add(const std::vector<T>& items, size_t count, int type, int componentType) {
        std::memcpy(model_.buffers[0].data.data() + next_, items.data(), items.size() * sizeof(T));
        tinygltf::Accessor accessor;
        accessor.bufferView = index_;
        accessor.byteOffset = next_ - begin_;
        accessor.componentType = componentType;
        accessor.type = type;
        accessor.count = count;
        next_ += items.size() * sizeof(T);
        model_.accessors.push_back(accessor);
        return static_cast<int>(model_.accessors.size()) - 1;
    }

private:
    tinygltf::Model& model_;
    size_t begin_ = 0, next_ = 0;
    int index_ = 0;
};

tinygltf::Primitive primitiveOf(tinygltf::Model& model, const Collider& collider, View& positions, View& indices) {
    Box3f bounds;
    for (const Vec3f& p : collider.positions) bounds = hull(bounds, p);
    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    const int position =
        positions.add(collider.positions, collider.positions.size(), TINYGLTF_TYPE_VEC3, TINYGLTF_COMPONENT_TYPE_FLOAT);
    model.accessors[static_cast<size_t>(position)].minValues = {bounds.lo.x, bounds.lo.y, bounds.lo.z};
    model.accessors[static_cast<size_t>(position)].maxValues = {bounds.hi.x, bounds.hi.y, bounds.hi.z};
    primitive.attributes["POSITION"] = position;
    primitive.indices = indices.add(collider.triangles, 3 * collider.triangles.size(), TINYGLTF_TYPE_SCALAR,
                                    TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT);
    return primitive;
}

}  // namespace

Status addColliders(tinygltf::Model& model, const ExportInput& input) {
    if (input.colliders.empty()) return Done{};
    const std::string_view engine = option(input, "engine", "godot");
    size_t corners = 0, triangles = 0;
    for (const Collider& collider : input.colliders) {
        if (!collider.convex && engine == "unreal")
            return Error{Error::Kind::Usage, "Unreal imports convex colliders alone: take --collider boxes or convex"};
        corners += collider.positions.size();
        triangles += collider.triangles.size();
    }
    View positions(model, corners * sizeof(Vec3f), TINYGLTF_TARGET_ARRAY_BUFFER);
    View indices(model, triangles * sizeof(mesh::Triangle), TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
    if (engine == "unreal" && input.objects)
        return Error{Error::Kind::Usage, "Unreal takes colliders by the name of one mesh: leave out the objects"};
    const std::string seen = validUtf8(input.name);  // Unreal looks for the mesh of this name
    for (size_t i = 0; i < input.colliders.size(); ++i) {
        const Collider& collider = input.colliders[i];
        tinygltf::Node node;
        node.name = colliderName(engine, seen, i, collider.convex);
        node.mesh = static_cast<int>(model.meshes.size());
        tinygltf::Mesh mesh;
        mesh.name = node.name;
        mesh.primitives.push_back(primitiveOf(model, collider, positions, indices));
        model.meshes.push_back(mesh);
        model.nodes[0].children.push_back(static_cast<int>(model.nodes.size()));
        model.nodes.push_back(node);
    }
    return Done{};
}

}  // namespace sgm::exporter
