#include "modeler/mesh/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <unordered_map>

#include "modeler/image/texture.h"
#include "modeler/image/texture_frame.h"

namespace sgm::mesh {
namespace {

/// Adds a copy of `from` to `to`, moved; its origins count from `firstOrigin` on.
void append(Mesh& to, uint32_t& vertices, const Mesh& from, const Pose& pose, OriginId firstOrigin) {
    const auto turned = [&](Vec3f n) { return (pose.axes * n.as<double>()).as<float>(); };
    const uint32_t first = vertices;
    for (const Chunk& chunk : from.chunks) {
        Chunk copy = chunk;
        copy.firstVertex += first;
        for (Vec3f& p : copy.positions) p = (pose.origin + pose.axes * p.as<double>()).as<float>();
        for (Vec3f& n : copy.normals) n = turned(n);
        for (CornerNormal& c : copy.cornerNormals) c.normal = turned(c.normal);
        for (uint32_t& ghost : copy.ghosts.vertices) ghost += first;
        for (OriginId& origin : copy.origins) origin += firstOrigin;
        copy.confined.clear();
        vertices += static_cast<uint32_t>(copy.positions.size());
        to.chunks.push_back(std::move(copy));
    }
}

/// A material of the list that looks like `material` and has its name; a new one, with a name of its own, where there
/// is none.
uint32_t indexOf(std::vector<Material>& all, std::map<std::string, std::vector<uint32_t>>& byName,
                 std::set<std::string>& taken, const Material& material) {
    std::vector<uint32_t>& known = byName[material.name];
    for (const uint32_t i : known) {
        Material like = material;
        like.name = all[i].name;
        // Every object has textures of its own.
        if (like.texture && all[i].texture && *like.texture == *all[i].texture) like.texture = all[i].texture;
        if (like == all[i]) return i;
    }
    Material added = material;
    for (uint32_t n = 2; !taken.insert(added.name).second; ++n) added.name = fmt::format("{}_{}", material.name, n);
    known.push_back(static_cast<uint32_t>(all.size()));
    all.push_back(std::move(added));
    return known.back();
}

}  // namespace

PackedMesh pack(const Mesh& mesh) {
    PackedMesh packed;
    packed.positions.reserve(mesh.vertexCount());
    packed.triangles.reserve(mesh.triangleCount());
    const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
    for (const Chunk& chunk : mesh.chunks) {
        const auto corners = static_cast<uint32_t>(3 * packed.triangles.size());
        append(packed.positions, chunk.positions);
        append(packed.normals, chunk.normals);
        for (const Triangle& t : chunk.triangles) packed.triangles.push_back(chunk.inMesh(t));
        append(packed.origins, chunk.origins);
        append(packed.labels, chunk.labels);
        for (CornerNormal normal : chunk.cornerNormals) {
            normal.corner += corners;
            packed.cornerNormals.push_back(normal);
        }
        for (const uint32_t vertex : chunk.faceted) packed.faceted.push_back(chunk.firstVertex + vertex);
    }
    return packed;
}

Mesh unpack(const PackedMesh& packed) {
    Chunk chunk;
    const auto copy = [](auto& to, const auto& from) { to.assign(from.begin(), from.end()); };
    copy(chunk.positions, packed.positions);
    copy(chunk.normals, packed.normals);
    copy(chunk.triangles, packed.triangles);
    copy(chunk.origins, packed.origins);
    copy(chunk.labels, packed.labels);
    chunk.cornerNormals = packed.cornerNormals;
    chunk.faceted = packed.faceted;
    Mesh mesh;
    if (!chunk.triangles.empty()) mesh.chunks.push_back(std::move(chunk));
    return mesh;
}

uint64_t Scene::triangleCount() const {
    std::vector<uint64_t> own;
    for (const SceneObject& object : objects) own.push_back(object.mesh.triangleCount());
    uint64_t count = 0;
    for (const Instance& instance : instances) count += own[instance.object];
    return count;
}

void shareMaterials(Scene& scene) {
    std::vector<Material> all;
    std::map<std::string, std::vector<uint32_t>> byName;
    std::set<std::string> taken;
    const auto take = [&](Provenance& provenance) {
        std::vector<uint32_t> numbers;
        for (const Material& material : provenance.materials) numbers.push_back(indexOf(all, byName, taken, material));
        for (Part& part : provenance.parts) part.material = numbers[part.material];
    };
    take(scene.ground);
    for (SceneObject& object : scene.objects) take(object.provenance);
    scene.ground.materials = all;
    for (SceneObject& object : scene.objects) object.provenance.materials = all;
}

Box3f boundsOf(const Scene& scene, const Mesh& ground) {
    Box3f box = ground.bounds();
    std::vector<Box3f> own;
    for (const SceneObject& object : scene.objects) own.push_back(object.mesh.bounds());
    for (const Instance& instance : scene.instances) {
        const Box3f& b = own[instance.object];
        const Pose& pose = instance.part.pose;
        if (b.empty()) continue;
        for (int corner = 0; corner < 8; ++corner) {
            const Vec3d at{static_cast<double>(corner & 1 ? b.hi.x : b.lo.x),
                           static_cast<double>(corner & 2 ? b.hi.y : b.lo.y),
                           static_cast<double>(corner & 4 ? b.hi.z : b.lo.z)};
            box = hull(box, (pose.origin + pose.axes * at).as<float>());
        }
    }
    return box;
}

std::array<double, 4> quaternionOf(const Mat3& m) {
    // The greatest of the four is found first, so that nothing is divided by a small number (Shepperd 1978).
    const double squares[] = {m.x.x - m.y.y - m.z.z, m.y.y - m.x.x - m.z.z, m.z.z - m.x.x - m.y.y,
                              m.x.x + m.y.y + m.z.z};
    const auto greatest = std::max_element(std::begin(squares), std::end(squares)) - std::begin(squares);
    const double twice = std::sqrt(std::max(0.0, 1 + squares[greatest])), half = .5 / twice;
    std::array<double, 4> q{};
    switch (greatest) {
        case 0:
            q = {twice / 2, (m.x.y + m.y.x) * half, (m.x.z + m.z.x) * half, (m.y.z - m.z.y) * half};
            break;
        case 1:
            q = {(m.x.y + m.y.x) * half, twice / 2, (m.y.z + m.z.y) * half, (m.z.x - m.x.z) * half};
            break;
        case 2:
            q = {(m.x.z + m.z.x) * half, (m.y.z + m.z.y) * half, twice / 2, (m.x.y - m.y.x) * half};
            break;
        default:
            q = {(m.y.z - m.z.y) * half, (m.z.x - m.x.z) * half, (m.x.y - m.y.x) * half, twice / 2};
    }
    if (q[3] < 0)
        for (double& v : q) v = -v;
    return q;
}

namespace {

std::shared_ptr<const image::TextureFrame> moved(const image::TextureFrame& frame, const Pose& pose) {
    auto there = std::make_shared<image::TextureFrame>(frame);
    there->origin = pose.origin + pose.axes * frame.origin;
    there->axes = pose.axes * frame.axes;
    return there;
}

}  // namespace

Result<FlatScene> flatten(const Scene& scene, const Mesh& ground) {
    uint64_t total = ground.vertexCount();
    for (const Instance& instance : scene.instances) total += scene.objects[instance.object].mesh.vertexCount();
    if (total >= ghostBit)
        return Error{
            Error::Kind::Budget,
            fmt::format("{} vertices of all places together are more than one mesh holds; write .glb, .gltf or "
                        ".usda, which hold instances",
                        total)};
    FlatScene flat{ground, scene.ground};
    auto vertices = static_cast<uint32_t>(ground.vertexCount());
    for (const Instance& instance : scene.instances) {
        const SceneObject& object = scene.objects[instance.object];
        const auto firstOrigin = static_cast<OriginId>(flat.provenance.parts.size());
        append(flat.mesh, vertices, object.mesh, instance.part.pose, firstOrigin);
        std::unordered_map<const image::TextureFrame*, std::shared_ptr<const image::TextureFrame>> frames;
        for (Part part : object.provenance.parts) {
            part.path = instance.part.path.text() + "/" + part.path.text();
            part.pose = {instance.part.pose.origin + instance.part.pose.axes * part.pose.origin,
                         instance.part.pose.axes * part.pose.axes};
            if (part.textureFrame) {
                auto& frame = frames[part.textureFrame.get()];
                if (!frame) frame = moved(*part.textureFrame, instance.part.pose);
                part.textureFrame = frame;
            }
            flat.provenance.parts.push_back(std::move(part));
        }
    }
    return flat;
}

}  // namespace sgm::mesh
