// The light of a picture's pixels, for samples beside them, which so ask the field little or nothing (as Whitted's
// adaptive sampling, 1980, but for light). Enters: hits of a picture with their light. Leaves: light for other hits.
// Assumes that pixels are put before samples beside them ask.
#pragma once

#include <optional>

#include "viewer/tracer.h"

namespace sgm::viewer {

class SeenPixels {
public:
    /// Forgets all pixels unless the picture is the same.
    void look(const PictureOptions& options, double fine);
    /// Keeps the first sample of a pixel.
    void put(Job job, const Hit& hit, const Lit& lit, OriginId origin);
    /// Normal and light of a hit that lies in one plane with pixels around it which have the same light; nothing where
    /// there are none.
    std::optional<Lit> surface(Job job, const Hit& hit, OriginId origin) const;
    /// Light of the pixels around for a hit with this normal, by how near they are. A pixel's first sample takes only
    /// what they have in common; its others stand for less than a pixel, and take what there is.
    std::optional<Lit> light(Job job, const Hit& hit, Vec3f normal, OriginId origin) const;
    /// Pixels that ask the field themselves, so that others needn't: a chessboard's black squares.
    static bool isKey(Job job) { return job.sample == 0 && (job.x() + job.y()) % 2 == 0; }

private:
    struct Pixel {
        Hit hit;
        Lit lit;
        OriginId origin;
    };
    class Mean;
    /// Adds to `mean` the pixels around that `belongs` takes.
    template <class Belongs>
    void gather(Job job, const Hit& hit, OriginId origin, Mean& mean, Belongs&& belongs) const;
    float pixelAt(const Hit& hit) const { return pixelAngle_ * length(hit.position - eye_); }

    PictureOptions options_;
    double fine_ = 0;
    Vec3f eye_;
    float pixelAngle_ = 0;
    std::vector<Pixel> pixels_;
    std::vector<bool> known_;
};

}  // namespace sgm::viewer
