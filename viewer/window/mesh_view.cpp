#include "viewer/window/mesh_view.h"

#include "viewer/render/shader_text.h"

namespace sgm::window {

Status MeshView::setMesh(std::unique_ptr<render::MeshScene> scene) {
    if (encode_.id() == 0) {
        Result<render::Program> made =
            render::Program::draw(render::shaderText("screen"), render::shaderText("encode"));
        if (!made) return made.error();
        encode_ = std::move(*made);
    }
    scene_ = std::move(scene);
    drawn_ = smooth_ = lit_ = sunlit_ = false;
    return Done{};
}

void MeshView::clear() {
    scene_.reset();
    for (auto& target : targets_) target.reset();
    drawn_ = smooth_ = lit_ = sunlit_ = false;
}

Status MeshView::light() {
    const Result<bool> all = scene_->lightMore(nullptr);
    if (!all) return all.error();
    lit_ = *all;
    sunlit_ = true;
    return Done{};
}

void MeshView::setLook(const render::PictureOptions& options, const render::MeshStyle& style) {
    if (drawn_ && options == look_ && style == style_) return;
    look_ = options;
    style_ = style;
    drawn_ = smooth_ = false;
}

Status MeshView::draw(int samples) {
    std::optional<render::ColorTarget>& target = targets_[samples > 1];
    if (!target || target->width != look_.width || target->height != look_.height) {
        Result<render::ColorTarget> made = render::ColorTarget::create(look_.width, look_.height, samples);
        if (!made) return made.error();
        target.emplace(std::move(*made));
    }
    if (Status s = scene_->draw(*target, 0, 0, look_, style_, nullptr); !s) return s;
    target->resolve();
    texture_.encode(*target, encode_);
    drawn_ = true;
    smooth_ = samples > 1;
    return Done{};
}

Status MeshView::step() {
    const ElapsedWatch watch;
    Status done = advance();
    spent_ += watch.spent();
    return done;
}

Status MeshView::advance() {
    if (!scene_ || look_.width < 1 || look_.height < 1) return Done{};
    // The sun's shadow belongs to the first picture; the sky's comes bit by bit.
    if (!sunlit_)
        if (Status s = light(); !s) return s;
    if (!drawn_) return draw(1);
    if (!lit_) return light();
    return smooth_ ? Status(Done{}) : draw(std::max(look_.samples, 2));
}

}  // namespace sgm::window
