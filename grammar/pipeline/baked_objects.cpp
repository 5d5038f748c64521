#include "grammar/pipeline/baked_objects.h"

#include <fmt/format.h>

#include "grammar/derive/graft.h"
#include "grammar/pipeline/scene.h"
#include "modeler/core/random.h"

namespace sgm::pipeline {
namespace {

namespace fs = std::filesystem;

/// The box around an object as twelve triangles; nothing where it has no solid.
std::optional<tiles::LibraryObject> solidBoxOf(const derive::Derivation& object) {
    const auto mass = derive::massOf(object);
    if (!mass) return std::nullopt;
    tiles::SurfacePiece box;
    for (uint32_t face = 0; face < derive::faceCount; ++face) {
        const Vec3d out = derive::faceDirection(face);
        const Vec3d u{out.y, out.z, out.x}, v = cross(out, u);
        const auto first = static_cast<uint32_t>(box.positions.size());
        for (const auto& [a, b] : {std::pair(-1, -1), {1, -1}, {1, 1}, {-1, 1}}) {
            box.positions.push_back(mass->box.point(out + u * a + v * b).as<float>());
            box.normals.push_back((mass->box.axes * out).as<float>());
        }
        for (const uint32_t corner : {0u, 1u, 2u, 0u, 2u, 3u}) box.indices.push_back(first + corner);
    }
    tiles::LibraryObject made;
    made.materials = {object.materials[mass->material == derive::none ? 0 : mass->material]};
    made.pieces.push_back(std::move(box));
    return made;
}

}  // namespace

std::vector<MeshWarning> BakedObjects::warnings() const {
    std::vector<MeshWarning> all;
    for (const auto& [object, some] : warnings_) all.insert(all.end(), some.begin(), some.end());
    return all;
}

std::string BakedObjects::nameOf(uint32_t object, Detail detail) const {
    const uint64_t a = objects_[object].inputs.hash(), b = combine(hashText(model_), a);
    const std::string key = fmt::format("{:016x}{:016x}", a, b);
    return fmt::format("{}/{}-{}.glb", key.substr(0, 2), key, static_cast<int>(detail));
}

Status BakedObjects::make(uint32_t object, Detail detail, Context& context) {
    std::error_code ignored;
    if (detail == Detail::Mass || fs::exists(pathOf(object, detail), ignored)) return Done{};
    fs::create_directories(pathOf(object, detail).parent_path(), ignored);
    return makeMeshes(object, context);
}

Material BakedObjects::fromAfar(Material material) {
    material.color = farColors_.of(material);
    material.texture = nullptr;
    return material;
}

Result<tiles::CellBox> BakedObjects::boxOf(uint32_t object, const Part& place) {
    const PlacedModel& placed = objects_[object];
    const auto mass = derive::massOf(*placed.derivation);
    if (!mass) return Error{Error::Kind::Internal, "the object has no solid"};
    const derive::Scope& box = mass->box;
    const auto edge = [&](Vec3d axis) { return length(box.point(axis) - box.centre); };
    return tiles::CellBox{&place,
                          objects_.nameOf(placed),
                          fromAfar(placed.derivation->materials[mass->material == derive::none ? 0 : mass->material]),
                          box.centre,
                          {edge({1, 0, 0}), edge({0, 1, 0}), edge({0, 0, 1})},
                          box.axes};
}

Status BakedObjects::makeMeshes(uint32_t object, Context& context) {
    const PlacedModel& placed = objects_[object];
    SceneRequest request;
    request.meshing.surface = mesh::Surface::Crisp;
    request.meshing.halvings = 0;  // what is thinner than the cells isn't worth its bytes in a town
    request.cell_m = cell_m_;
    if (inspected_.contains(object)) {  // by its own parts, and by triangles that are hardly larger than a cell
        auto inspected = meshObject(*placed.derivation, request, context, objects_.nameOf(placed));
        if (!inspected.ok()) return inspected.error();
        const std::lock_guard lock(*mutex_);
        warnings_[object] = std::move(inspected->lacks);
    }
    request.joinsBoxes = request.meshing.mergesCells = true;
    auto meshed = meshObject(*placed.derivation, request, context, "");
    if (!meshed.ok()) return meshed.error();
    const mesh::PackedMesh mesh = mesh::pack(meshed->mesh);
    meshed->mesh = {};
    tiles::LibraryObject made;
    made.name = objects_.nameOf(placed);
    made.values = objects_.valuesOf(placed);
    for (const Material& material : meshed->provenance.materials) made.materials.push_back(fromAfar(material));
    made.pieces = tiles::coarsePiecesOf(mesh, meshed->provenance, coarseError_m());
    made.inColors = true;
    if (made.pieces.empty()) {  // all of it is thinner than the error
        auto mass = solidBoxOf(*placed.derivation);
        if (!mass) return Error{Error::Kind::Internal, "the object has no solid"};
        made.pieces = std::move(mass->pieces), made.materials = std::move(mass->materials);
    }
    if (const Status s = tiles::writeObject(made, packing_, pathOf(object, Detail::Coarse)); !s.ok()) return s;
    made.materials = meshed->provenance.materials;
    made.pieces = tiles::piecesOf(mesh, meshed->provenance);
    made.inColors = false;
    return tiles::writeObject(made, packing_, pathOf(object, Detail::Finest));
}

}  // namespace sgm::pipeline
