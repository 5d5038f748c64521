// A mesh on the GPU under the field's light: soft sun shadow from few depth maps, sky visibility from many.
// Enters: a mesh and whose its triangles are. Leaves: draws into a target. Assumes a current GL 4.3 context for all but
// `prepareMesh`, and objects of at most 2³² triangles.
#pragma once

#include <memory>
#include <vector>

#include "viewer/render/blocks_scene.h"
#include "viewer/render/crease_lines.h"
#include "viewer/render/draw.h"
#include "viewer/render/gpu.h"
#include "viewer/render/mesh_light.h"
#include "viewer/render/mesh_style.h"
#include "viewer/render/mesh_textures.h"
#include "viewer/render/scene.h"

namespace sgm::render {

/// Everything about a mesh that needs no GPU, so that any thread can make it.
struct PreparedMesh {
    /// Whose a triangle is: index of its material, of its rule among all rules, of its connected component, of its
    /// smooth piece.
    struct Owner {
        uint32_t material, rule, component, piece;
    };
    std::vector<Vec3f> positions, normals;
    std::vector<float> curvatures;  ///< mean curvature at vertices, 1/m, positive on a ball
    std::vector<Vec3<uint32_t>> triangles;
    std::vector<Owner> owners;  ///< by triangle
    std::vector<Segment> hardEdges;
    std::vector<Material> materials;
    MeshTextures textures;
    Box3f bounds;
    uint32_t components = 0;
};
/// Error::Internal when a vertex lacks its normal or a triangle its origin; the errors of prepareMeshTextures.
Result<PreparedMesh> prepareMesh(const mesh::Mesh& mesh, const Provenance& provenance);

/// The shaders that draw meshes.
struct MeshPrograms {
    Program depth, mask, position, blur, color, section, backdrop, crease;  // section: the colour of what is cut open
    static Result<std::shared_ptr<const MeshPrograms>> create();
};

/// A sample of pixels beside their middles.
struct Subsample {
    double right = 0, down = 0;           ///< pixels from the middle
    const TexelBuffer* wanted = nullptr;  ///< a word a pixel of the target, bottom row first, 0 where none is wanted
};

/// A prepared mesh in GPU memory. May be made in one context and drawn in another that shares with it.
class MeshScene {
public:
    /// Directions from which light of the sky is sampled: fewer in a window, where every frame samples them all.
    static constexpr SkyBudget skyOfWindows{40, 1}, skyOfPictures{128, 4};

    MeshScene(const PreparedMesh& mesh, std::shared_ptr<const MeshPrograms> programs, SkyBudget sky = skyOfWindows);
    /// Of triangles that a shader has made, with the owner of each: all of one component, a piece a part, without
    /// curvature and hard edges.
    MeshScene(GpuTriangles triangles, std::span<const OriginId> owners, const Box3f& bounds,
              const Provenance& provenance, std::shared_ptr<const MeshPrograms> programs);
    /// Draws all maps of shadow and sky.
    Status light(Progress* progress);
    /// Draws the next map: first the sun's, then those of the sky, which count once all are there. True when none is
    /// left.
    Result<bool> lightMore(Progress* progress);
    /// Draws finer maps for what a picture shows, in place of those for the last one; none inside a hollow.
    Status lightFor(const PictureOptions& options, Progress* progress);
    /// The part of the picture whose lower left pixel, from the bottom left, is (x0, y0), as large as `target`.
    Status draw(const ColorTarget& target, int x0, int y0, const PictureOptions& options, const MeshStyle& style,
                Progress* progress, const Subsample& subsample = {}) const;
    size_t triangleCount() const { return triangleCount_; }
    const Box3f& bounds() const { return bounds_; }

private:
    Result<std::vector<Vec3f>> seenFrom(const PictureOptions& options, Progress* progress) const;
    Status drawTriangles(const Program& program, Progress* progress) const;
    double nearest(const View& view) const;
    Matrix4 clipOf(const PictureOptions& options, double left, double low, int width, int height) const;
    void bindTextures(const Program& program) const;
    /// Nothing is drawn where a subsample isn't wanted.
    void drawMask(const Subsample& subsample, int columns) const;
    /// Where all triangles are drawn: a picture's projection and its nearest distance.
    struct Projection {
        Matrix4 clipFromWorld;
        Vec3f eye;
        float near;
    };
    Status drawCreases(const Projection& from, const ColorTarget& target, const MeshStyle& style,
                       Progress* progress) const;

    std::shared_ptr<const MeshPrograms> programs_;
    Box3f bounds_;
    TriangleBuffers triangles_;
    size_t triangleCount_ = 0;
    TexelBuffer owners_;
    CreaseLines hardEdges_;
    Buffer materials_;
    bool textured_ = false;
    TexelBuffer frameOfTriangle_;
    Buffer frames_;
    PictureStack colorPictures_, numberPictures_;
    MeshLight light_;
};

}  // namespace sgm::render
