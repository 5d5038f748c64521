// A view of a field that gets better by itself: coarse at once, then every pixel from the middle outwards, then edges.
// Enters: a prepared field and a look. Leaves: two textures, one over the other. Assumes a current GL context; every
// `step` takes about 20 ms, but for the coarse picture, whose pixels are chosen to take about 50 ms together.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "viewer/field_scene.h"

namespace sgm::viewer {

/// Where a ray through a pixel ends.
struct Pick {
    HitKind kind = HitKind::Sky;
    Vec3f position;       ///< metres
    OriginId origin = 0;  ///< of an object
};

/// What the last field and its picture took, seconds, and how often shaders were compiled so far.
struct FieldTimes {
    double compile = 0, upload = 0;  ///< of the last field
    double coarse = 0, full = 0;     ///< drawing of the last picture; full without the coarse one
    double drawn = 0;                ///< all drawing and compiling so far
    int compiles = 0;
};

class FieldView {
public:
    const FieldTimes& times() const { return times_; }
    /// Compiles where the field has ops that no earlier one had. The picture starts again.
    Status setField(std::shared_ptr<const PreparedField> field);
    /// Starts the picture again, unless it is of this look already.
    void setLook(const PictureOptions& options);
    bool hasField() const { return scene_.has_value(); }
    /// Of the solid; only with a field.
    Box3f bounds() const { return scene_->field().bounds; }
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
    Image image() const { return sums_.image(); }

private:
    enum class Phase { Idle, Coarse, First, Edges, Finished };
    void restart();
    Status drawMore();
    Status drawCoarse();
    Status drawBatch();

    FieldPrograms programs_;
    std::optional<FieldScene> scene_;
    PictureOptions look_;
    Phase phase_ = Phase::Idle;
    std::vector<Job> jobs_, first_;
    size_t next_ = 0, batch_ = 2048;
    PixelSums sums_;
    DisplayTexture coarse_, fine_;
    double secondsPerRay_ = 4e-6;
    FieldTimes times_;
};

}  // namespace sgm::viewer
