// A view of a mesh: drawn at once, its light completed map by map, smoothed when nothing moves.
// Enters: a prepared mesh, a look, a style. Leaves: a texture. Assumes a current GL context.
#pragma once

#include <memory>
#include <optional>

#include "viewer/render/mesh_scene.h"
#include "viewer/window/elapsed.h"

namespace sgm::window {

class MeshView {
public:
    Status setMesh(std::unique_ptr<render::MeshScene> scene);
    /// Shows nothing, and holds no buffers, until there is another mesh.
    void clear();
    void setLook(const render::PictureOptions& options, const render::MeshStyle& style);
    bool hasMesh() const { return scene_ != nullptr; }
    /// Draws what changed, else completes the light, else draws with smooth edges.
    Status step();
    bool finished() const { return !scene_ || (drawn_ && smooth_ && lit_); }
    bool visible() const { return scene_ && drawn_; }
    uint32_t texture() const { return texture_.id(); }
    /// What all steps so far took.
    const ElapsedTimes& drawn() const { return spent_; }
    size_t triangleCount() const { return scene_ ? scene_->triangleCount() : 0; }
    /// The picture so far; whole when `finished`.
    render::Image image() const { return {texture_.width(), texture_.height(), texture_.read()}; }

private:
    Status advance();
    Status draw(int samples);
    Status light();

    std::unique_ptr<render::MeshScene> scene_;
    render::Program encode_;
    render::PictureOptions look_;
    render::MeshStyle style_;
    render::DisplayTexture texture_;
    std::optional<render::ColorTarget> targets_[2];  ///< one sample a pixel; several
    ElapsedTimes spent_;
    bool drawn_ = false, smooth_ = false, sunlit_ = false, lit_ = false;
};

}  // namespace sgm::window
