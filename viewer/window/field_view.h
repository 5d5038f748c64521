// A view of a field, or of fog in its place, that gets better by itself: coarse at once, then every pixel from the
// middle outwards, then edges. Enters: scenes and a look. Leaves: two textures, one over the other. Assumes a current
// GL context; every `step` takes about 20 ms, but for the coarse picture, whose pixels are chosen to take about 50 ms
// together.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "viewer/render/field_scene.h"
#include "viewer/render/fog_scene.h"
#include "viewer/window/elapsed.h"

namespace sgm::window {

/// Where a ray through a pixel ends.
struct Pick {
    render::HitKind kind = render::HitKind::Sky;
    Vec3f position;       ///< metres
    OriginId origin = 0;  ///< of an object
};

/// What drawing took, seconds.
struct FieldTimes {
    double coarse = 0, full = 0;  ///< of the last picture; full without the coarse one
    ElapsedTimes drawn;           ///< all so far
};

class FieldView {
public:
    const FieldTimes& times() const { return times_; }
    /// The picture starts again; gives what the last one was of.
    std::shared_ptr<const render::PreparedField> setField(std::unique_ptr<render::FieldScene> scene);
    /// Null: there is none until there is another.
    void setFog(std::unique_ptr<render::FogScene> fog);
    /// Draws fog rather than the field, as soon as there is any.
    void showFog(bool fog);
    bool drawsFog() const { return fogWanted_ && fog_; }
    /// Starts the picture again, unless it is of this look already.
    void setLook(const render::PictureOptions& options);
    bool hasField() const { return scene_ != nullptr; }
    /// Of the solid; only with a field.
    Box3f bounds() const { return scene_->field()->bounds; }
    /// Draws a little more; Error::Internal when the driver fails.
    Status step();
    /// All pixels are final.
    bool finished() const { return phase_ == Phase::Finished; }
    /// There is something to show: a coarse picture of the present look at least.
    bool visible() const { return phase_ > Phase::Coarse; }
    /// The coarse picture, and over it the pixels that are final, elsewhere transparent.
    uint32_t coarse() const { return coarse_.id(); }
    uint32_t fine() const { return fine_.id(); }
    /// Share of the pixels that have been drawn at full quality, 0 … 1.
    double share() const;
    /// Where the ray through the middle of pixel (x, y) ends, from the top left; nothing without a field.
    std::optional<Pick> pick(int x, int y);
    /// The picture so far; whole when `finished`.
    render::Image image() const { return sums_.image(); }

private:
    enum class Phase { Idle, Coarse, First, Edges, Finished };
    void restart();
    /// Sets the picture for `colorsOf`.
    void point(const render::PictureOptions& options, double fine = 1);
    Result<std::vector<std::array<float, 4>>> colorsOf(std::span<const render::Job> jobs);
    Status drawMore();
    Status drawCoarse();
    Status drawBatch();

    std::unique_ptr<render::FieldScene> scene_;
    std::unique_ptr<render::FogScene> fog_;
    bool fogWanted_ = false;
    render::PictureOptions look_;
    Phase phase_ = Phase::Idle;
    std::vector<render::Job> jobs_, first_;
    size_t next_ = 0, batch_ = 2048;
    render::PixelSums sums_;
    render::DisplayTexture coarse_, fine_;
    double secondsPerRay_[2] = {4e-6, 4e-6};  ///< of the field, of fog
    FieldTimes times_;
};

}  // namespace sgm::window
