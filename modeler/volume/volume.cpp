// Level sets in OpenVDB (Museth, "VDB: High-resolution sparse volumes with dynamic topology", 2013).
#include "modeler/volume/volume.h"

#include <fmt/format.h>
#include <openvdb/tools/LevelSetMeasure.h>
#include <openvdb/tools/SignedFloodFill.h>
#include <openvdb/tools/VolumeToMesh.h>

#include <memory>

#include "modeler/core/parallel.h"
#include "modeler/mesh/region.h"
#include "modeler/volume/band.h"
#include "modeler/volume/volume_impl.h"

namespace sgm::volume {
namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;
static_assert(Leaf::DIM == leafVoxels && Leaf::SIZE == std::tuple_size_v<decltype(BandLeaf::values)>);

/// A leaf whose voxels are active strictly within the band.
std::unique_ptr<Leaf> toLeaf(const BandLeaf& samples, float band_m) {
    const Vec3i c = samples.corner;
    auto leaf = std::make_unique<Leaf>(openvdb::Coord(c.x, c.y, c.z), band_m, false);
    for (openvdb::Index i = 0; i < Leaf::SIZE; ++i) {
        leaf->setValueOnly(i, samples.values[i]);
        if (std::abs(samples.values[i]) < band_m) leaf->setValueOn(i);
    }
    return leaf;
}

/// Corner normals from the faces around, weighted by area.
void setNormals(mesh::Chunk& chunk) {
    chunk.normals.assign(chunk.positions.size(), Vec3f{});
    for (const mesh::Triangle& t : chunk.triangles) {
        const Vec3f a = chunk.positions[t.x];
        const Vec3f n = cross(chunk.positions[t.y] - a, chunk.positions[t.z] - a);
        for (int corner = 0; corner < 3; ++corner) chunk.normals[t[corner]] += n;
    }
    for (Vec3f& n : chunk.normals) n = normalized(n);
}

}  // namespace

float Volume::voxel_m() const { return static_cast<float>(impl_->grid->voxelSize()[0]); }

uint64_t Volume::activeVoxels() const { return impl_->grid->activeVoxelCount(); }

float Volume::at(Vec3f p) const {
    const auto& grid = *impl_->grid;
    return grid.tree().getValue(grid.transform().worldToIndexCellCentered(openvdb::Vec3d(p.x, p.y, p.z)));
}

double Volume::enclosed_m3() const {
    const auto& grid = *impl_->grid;
    if (grid.getGridClass() != openvdb::GRID_LEVEL_SET || grid.tree().leafCount() == 0) return 0;
    return openvdb::tools::levelSetVolume(grid);
}

double Volume::integral_m3() const {
    double sum = 0;
    for (auto v = impl_->grid->cbeginValueOn(); v; ++v) sum += *v * static_cast<double>(v.getVoxelCount());
    return sum * std::pow(impl_->grid->voxelSize()[0], 3);
}

Box3f Volume::bounds() const {
    const openvdb::CoordBBox box = impl_->grid->evalActiveVoxelBoundingBox();
    if (box.empty()) return {};
    const openvdb::BBoxd world =
        impl_->grid->transform().indexToWorld(openvdb::BBoxd(box.min().asVec3d() - 0.5, box.max().asVec3d() + 0.5));
    return {Vec3d{world.min().x(), world.min().y(), world.min().z()}.as<float>(),
            Vec3d{world.max().x(), world.max().y(), world.max().z()}.as<float>()};
}

Status load() { return Done{}; }

Result<Volume> sample(const std::vector<mesh::Block>& blocks, const eval::Tape& whole, const mesh::Grid& grid,
                      int halfWidth, int threads, Progress* progress) {
    if (halfWidth < 1 || halfWidth > mesh::blockCells)
        return Error{Error::Kind::Usage,
                     fmt::format("a band of {} voxels: it takes 1 to {}", halfWidth, mesh::blockCells)};
    if (Status status = mesh::checkGrid(grid); !status.ok()) return status.error();
    openvdb::initialize();  // once for all, whichever thread comes first
    const float band_m = static_cast<float>(halfWidth) * grid.cell_m;
    auto band = sampleBand(blocks, whole, grid, band_m, threads, progress);
    if (!band.ok()) return band.error();

    auto result = openvdb::FloatGrid::create(band_m);
    result->setGridClass(openvdb::GRID_LEVEL_SET);
    const auto transform = openvdb::math::Transform::createLinearTransform(static_cast<double>(grid.cell_m));
    transform->postTranslate(openvdb::Vec3d(grid.origin.x, grid.origin.y, grid.origin.z));
    result->setTransform(transform);
    for (auto& batch : *band) {
        if (cancelled(progress)) return cancelledError();
        for (const BandLeaf& leaf : batch) result->tree().addLeaf(toLeaf(leaf, band_m).release());
        std::vector<BandLeaf>().swap(batch);  // the samples are stored now
    }
    // Leaves (level 0) have all their signs already.
    openvdb::tools::signedFloodFill(result->tree(), threadCount(threads) > 1, 1, 1);
    return Volume(std::make_shared<Volume::Impl>(Volume::Impl{result}));
}

Result<mesh::Mesh> toMesh(const Volume& volume) {
    std::vector<openvdb::Vec3s> points;
    std::vector<openvdb::Vec3I> triangles;
    std::vector<openvdb::Vec4I> quads;
    try {
        openvdb::tools::volumeToMesh(*volume.impl().grid, points, triangles, quads, 0.0, 0.0);
    } catch (const std::bad_alloc&) {
        return Error{Error::Kind::Budget, "OpenVDB can't mesh this volume: out of memory"};
    } catch (const std::exception& e) {
        return Error{Error::Kind::Internal, fmt::format("OpenVDB can't mesh this volume: {}", e.what())};
    }
    mesh::Mesh out;
    mesh::Chunk& chunk = out.chunks.emplace_back();
    for (const openvdb::Vec3s& p : points) chunk.positions.push_back({p[0], p[1], p[2]});
    // OpenVDB lists corners clockwise seen from outside.
    for (const openvdb::Vec3I& t : triangles) chunk.triangles.push_back({t[0], t[2], t[1]});
    for (const openvdb::Vec4I& q : quads) {
        chunk.triangles.push_back({q[0], q[2], q[1]});
        chunk.triangles.push_back({q[0], q[3], q[2]});
    }
    chunk.origins.assign(chunk.triangles.size(), 0);
    setNormals(chunk);
    return out;
}

}  // namespace sgm::volume
