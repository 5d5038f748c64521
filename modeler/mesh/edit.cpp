#include "modeler/mesh/edit.h"

#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModNormalFlippingT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>
#include <OpenMesh/Tools/Smoother/JacobiLaplaceSmootherT.hh>
#include <algorithm>
#include <cmath>

#include "modeler/mesh/openmesh.h"

namespace sgm::mesh {
namespace {

namespace decimater = OpenMesh::Decimater;

/// Tells the decimater to stop when the watcher wants it.
class CancelObserver : public decimater::Observer {
public:
    explicit CancelObserver(Progress* progress) : Observer(interval), progress_(progress) {}
    void notify(size_t) override { tick(progress_, interval); }
    bool abort() const override { return cancelled(progress_); }

private:
    static constexpr size_t interval = 256;
    Progress* progress_;
};

}  // namespace

Result<Mesh> smooth(const Mesh& mesh, int passes, Progress* progress) {
    if (passes < 0) return Error{Error::Kind::Usage, "the number of smoothing passes can't be negative"};
    if (passes == 0) return mesh;
    if (progress) progress->begin("smooth", static_cast<uint64_t>(passes));
    HalfEdgeMesh half = toOpenMesh(mesh);
    using Smoother = OpenMesh::Smoother::JacobiLaplaceSmootherT<HalfEdgeMesh>;
    Smoother smoother(half);
    smoother.initialize(Smoother::Tangential_and_Normal, Smoother::C1);
    for (int pass = 0; pass < passes; ++pass) {
        if (cancelled(progress)) return cancelledError();
        smoother.smooth(1);
        tick(progress);
    }
    return fromOpenMesh(half, false);
}

Result<Mesh> decimate(const Mesh& mesh, double ratio, Progress* progress) {
    if (!(ratio > 0 && ratio <= 1))
        return Error{Error::Kind::Usage, "the decimation ratio must be above 0 and at most 1"};
    HalfEdgeMesh half = toOpenMesh(mesh);
    const auto target = static_cast<size_t>(std::ceil(ratio * static_cast<double>(half.n_faces())));
    if (target == half.n_faces()) return fromOpenMesh(half, true);
    if (progress) progress->begin("decimate", (half.n_faces() - target) / 2);  // a collapse takes two faces

    CancelObserver observer(progress);
    decimater::DecimaterT<HalfEdgeMesh> decimater(half);
    decimater::ModQuadricT<HalfEdgeMesh>::Handle quadric;
    decimater::ModNormalFlippingT<HalfEdgeMesh>::Handle flipping;
    decimater.add(quadric);
    decimater.add(flipping);
    decimater.module(quadric).unset_max_err();  // a priority, no limit
    decimater.module(flipping).set_max_normal_deviation(60);
    decimater.set_observer(&observer);
    if (!decimater.initialize()) return Error{Error::Kind::Internal, "OpenMesh can't start its decimation"};
    decimater.decimate_to_faces(0, target);
    if (cancelled(progress)) return cancelledError();
    half.garbage_collection();
    return fromOpenMesh(half, false);
}

void correctNormals(Mesh& mesh) {
    constexpr float leastAgreement = .6f;  // cosine
    constexpr float sliver = 0.02f;        // height as a share of the longest edge
    const auto square = [](Vec3f v) { return dot(v, v); };
    std::vector<const Chunk*> owners;  // by vertex of the whole mesh
    owners.reserve(mesh.vertexCount());
    for (const Chunk& c : mesh.chunks) owners.insert(owners.end(), c.positions.size(), &c);
    std::vector<CornerNormal> kept;
    for (Chunk& chunk : mesh.chunks) {
        if (chunk.hasPositionsOnly()) continue;
        kept.clear();
        auto own = chunk.cornerNormals.begin();
        for (uint32_t t = 0; t < chunk.triangles.size(); ++t) {
            const Triangle corners = chunk.inMesh(chunk.triangles[t]);
            const auto place = [&](int k) {
                return owners[corners[k]]->positions[corners[k] - owners[corners[k]]->firstVertex];
            };
            const Vec3f across = cross(place(1) - place(0), place(2) - place(0)), face = normalized(across);
            const float longest =
                std::max({square(place(1) - place(0)), square(place(2) - place(1)), square(place(0) - place(2))});
            const float least = length(across) <= sliver * longest ? 0 : leastAgreement;
            for (int k = 0; k < 3; ++k) {
                const uint32_t corner = 3 * t + static_cast<uint32_t>(k);
                const bool isOwn = own != chunk.cornerNormals.end() && own->corner == corner;
                const Vec3f normal =
                    isOwn ? own->normal : owners[corners[k]]->normals[corners[k] - owners[corners[k]]->firstVertex];
                if (dot(face, normal) < least)
                    kept.push_back({corner, face});
                else if (isOwn)
                    kept.push_back(*own);
                own += isOwn;
            }
        }
        chunk.cornerNormals = kept;
    }
}

void rotate(Mesh& mesh, const Mat3& rotation) {
    const auto turn = [&](Vec3f& v) { v = (rotation * v.as<double>()).as<float>(); };
    for (Chunk& chunk : mesh.chunks) {
        std::for_each(chunk.positions.begin(), chunk.positions.end(), turn);
        std::for_each(chunk.normals.begin(), chunk.normals.end(), turn);
        for (CornerNormal& own : chunk.cornerNormals) turn(own.normal);
        for (ConfinedVertex& vertex : chunk.confined) turn(vertex.place);
    }
}

void turnInsideOut(Mesh& mesh) {
    for (Chunk& chunk : mesh.chunks) {
        for (Triangle& t : chunk.triangles) std::swap(t.y, t.z);
        for (Vec3f& n : chunk.normals) n = -n;
        for (CornerNormal& own : chunk.cornerNormals) {
            if (const uint32_t k = own.corner % 3; k != 0) own.corner += k == 1 ? 1 : -1;
            own.normal = -own.normal;
        }
        std::sort(chunk.cornerNormals.begin(), chunk.cornerNormals.end(),
                  [](const CornerNormal& a, const CornerNormal& b) { return a.corner < b.corner; });
    }
}

}  // namespace sgm::mesh
