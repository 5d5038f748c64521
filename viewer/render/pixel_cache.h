// What is known of a picture's pixels, for samples beside them, which so ask the field little or nothing: light (as
// Whitted's adaptive sampling, 1980, but for light), and how far rays are free. Enters: what rays met, with its light.
// Leaves: light for other hits, and where other rays may start. Assumes that pixels are put before samples beside them
// ask.
#pragma once

#include <optional>

#include "viewer/render/scene.h"
#include "viewer/render/tracer.h"

namespace sgm::render {

class PixelCache {
public:
    /// Forgets all pixels unless the picture is the same.
    void look(const PictureOptions& options, double fine);
    /// A sample's ray, with what those traced before it tell. The first one of a pixel starts where those of its block
    /// do; others where theirs knows of nothing nearer, and perhaps meet the plane that it met.
    Ray ray(Job job) const;
    /// The first ray of a block of pixels, to be traced before the others.
    static bool leads(Job job) { return job.sample == 0 && job.x() % block == 2 && job.y() % block == 2; }
    /// Keeps how far the cone beside the first ray of a pixel is free, metres.
    void put(Job job, float free);
    /// Keeps the first sample of a pixel.
    void put(Job job, const Hit& hit, const Shading& lit, OriginId origin);
    /// Normal and light of a hit that lies in one plane with pixels around it which have the same light; nothing where
    /// there are none.
    std::optional<Shading> surface(Job job, const Hit& hit, OriginId origin) const;
    /// Light of the pixels around for a hit with this normal, by how near they are. A pixel's first sample takes only
    /// what they have in common; its others stand for less than a pixel, and take what there is.
    std::optional<Shading> light(Job job, const Hit& hit, Vec3f normal, OriginId origin) const;
    /// Pixels that ask the field themselves, so that others needn't: a chessboard's black squares.
    static bool isKey(Job job) { return job.sample == 0 && (job.x() + job.y()) % 2 == 0; }

private:
    static constexpr size_t block = 4;  ///< pixels a side, the leading one in the third row and column
    struct Pixel {
        Hit hit;
        Shading lit;
        OriginId origin;
    };
    class Mean;
    /// Whether the first rays of the pixels around a sample met places near the plane that its own pixel's met.
    bool smoothTowards(Job job) const;
    size_t indexOf(size_t x, size_t y) const { return y * size_t(options_.width) + x; }
    /// Adds to `mean` the pixels around that `belongs` takes.
    template <class Belongs>
    void gather(Job job, const Hit& hit, OriginId origin, Mean& mean, Belongs&& belongs) const;
    float pixelAt(const Hit& hit) const { return pixelAngle_ * length(hit.position - eye_); }

    PictureOptions options_;
    double fine_ = 0;
    View view_{};
    Vec3f eye_;
    float pixelAngle_ = 0;
    std::vector<Pixel> pixels_;
    std::vector<float> free_;
    std::vector<bool> known_;
};

}  // namespace sgm::render
