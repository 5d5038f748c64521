#include "viewer/render/pixel_cache.h"

#include <cmath>
#include <utility>

namespace sgm::render {
namespace {

/// Larger pictures don't keep their pixels, which would take a gigabyte.
constexpr size_t mostPixels = size_t(1) << 24;
/// Of the weights by distance, pixels²: a pixel's own light on ornament counts little more than that of those around
/// it.
constexpr float softness = 1;

}  // namespace

/// A weighted mean of light, and how far what it is of differs.
class PixelCache::Mean {
public:
    void add(const Shading& lit, float weight, int dx, int dy) {
        const float shares[] = {lit.sunlight, lit.openness, lit.daylight};
        for (size_t i = 0; i < 3; ++i) {
            low_[i] = std::min(low_[i], shares[i]);
            high_[i] = std::max(high_[i], shares[i]);
            sums_[i] += weight * shares[i];
        }
        normal_ += weight * lit.normal;
        weight_ += weight;
        left_ |= dx<0, right_ |= dx> 0, above_ |= dy<0, below_ |= dy> 0;
        ++count_;
    }
    /// A pixel that isn't taken.
    void skip() { whole_ = false; }
    int count() const { return count_; }
    /// None was left out.
    bool whole() const { return whole_; }
    /// Some of it lies on opposite sides.
    bool around() const { return (left_ && right_) || (above_ && below_); }
    /// The most that a share differs.
    float spread() const { return std::max({high_[0] - low_[0], high_[1] - low_[1], high_[2] - low_[2]}); }
    /// How much the normals agree, the cosine of what lies between for two.
    float agreement() const { return length(normal_) / weight_; }
    Shading lit() const {
        return {normalized(normal_), sums_[1] / weight_, sums_[0] / weight_, sums_[2] / weight_, {}};
    }

private:
    float low_[3] = {1, 1, 1}, high_[3] = {0, 0, 0}, sums_[3] = {0, 0, 0}, weight_ = 0;
    Vec3f normal_{};
    int count_ = 0;
    bool whole_ = true, left_ = false, right_ = false, above_ = false, below_ = false;
};

void PixelCache::look(const PictureOptions& options, double fine) {
    if (options == options_ && fine == fine_) return;
    options_ = options;
    fine_ = fine;
    view_ = viewOf(options.camera, options.width, options.height);
    eye_ = view_.eye.as<float>();
    pixelAngle_ = static_cast<float>(view_.pixelAngle);
    const size_t count = size_t(options.width) * size_t(options.height);
    pixels_.resize(count <= mostPixels ? count : 0);
    known_.assign(pixels_.size(), false);
    free_.assign(pixels_.size(), 0);
}

bool PixelCache::smoothTowards(Job job) const {
    const Pixel& first = pixels_[indexOf(job.x(), job.y())];
    const PicturePlace place = job.place();
    const int x = static_cast<int>(job.x()), y = static_cast<int>(job.y());
    const int besideX = place.x > x + 0.5 ? x + 1 : x - 1, besideY = place.y > y + 0.5 ? y + 1 : y - 1;
    for (const auto& [u, v] : {std::pair{besideX, y}, {x, besideY}, {besideX, besideY}}) {
        if (u < 0 || v < 0 || u >= options_.width || v >= options_.height) return false;
        const size_t at = indexOf(size_t(u), size_t(v));
        const Pixel& p = pixels_[at];
        if (!known_[at] || p.hit.kind() != HitKind::Object) return false;
        if (std::abs(dot(p.hit.position - first.hit.position, first.lit.normal)) > pixelAt(first.hit)) return false;
    }
    return true;
}

Ray PixelCache::ray(Job job) const {
    // Half a pixel's diagonal, and for all of the block's the way to the farthest one.
    constexpr float ofPixel = 0.75f, ofBlock = 2.83f + ofPixel;
    Ray ray{job};
    if (pixels_.empty()) return ray;
    if (job.sample == 0) {
        ray.beside = (leads(job) ? ofBlock : ofPixel) * pixelAngle_;
        const size_t x = job.x() / block * block + 2, y = job.y() / block * block + 2;
        if (!leads(job) && x < size_t(options_.width) && y < size_t(options_.height)) ray.start = free_[indexOf(x, y)];
        return ray;
    }
    const size_t at = indexOf(job.x(), job.y());
    ray.start = free_[at];
    const Pixel& first = pixels_[at];
    if (!known_[at] || first.hit.kind() != HitKind::Object) return ray;
    const Vec3f direction = rayThrough(view_, options_, job.place());
    const float cosine = dot(first.lit.normal, direction);
    if (cosine > -0.1f) return ray;
    const float plane = dot(first.hit.position - eye_, first.lit.normal) / cosine;
    // What stands before it is narrower than its pixel, or one of those around it would show it.
    const float most = smoothTowards(job) ? 24 : 2;
    if (plane >= ray.start && plane < ray.start * (1 + most * pixelAngle_)) ray.guess = plane;
    return ray;
}

void PixelCache::put(Job job, float free) {
    if (job.sample == 0 && !free_.empty()) free_[indexOf(job.x(), job.y())] = free;
}

void PixelCache::put(Job job, const Hit& hit, const Shading& lit, OriginId origin) {
    if (job.sample != 0 || pixels_.empty()) return;
    const size_t at = indexOf(job.x(), job.y());
    pixels_[at] = {hit, lit, origin};
    known_[at] = true;
}

template <class Belongs>
void PixelCache::gather(Job job, const Hit& hit, OriginId origin, Mean& mean, Belongs&& belongs) const {
    if (pixels_.empty()) return;
    const int width = options_.width, height = options_.height;
    const float pixel = pixelAt(hit);
    for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
            const int x = static_cast<int>(job.x()) + dx, y = static_cast<int>(job.y()) + dy;
            if (x < 0 || y < 0 || x >= width || y >= height) continue;
            // A first sample asks those beside it: what was asked of the field itself.
            if (job.sample == 0 && std::abs(dx) + std::abs(dy) != 1) continue;
            const size_t at = indexOf(size_t(x), size_t(y));
            if (!known_[at]) continue;
            const Pixel& p = pixels_[at];
            const Vec3f away = hit.position - p.hit.position;
            if (p.hit.kindNumber != hit.kindNumber || p.origin != origin || !belongs(p, away)) {
                mean.skip();
                continue;
            }
            mean.add(p.lit, 1 / (dot(away, away) + softness * pixel * pixel), dx, dy);
        }
}

std::optional<Shading> PixelCache::surface(Job job, const Hit& hit, OriginId origin) const {
    const float pixel = pixelAt(hit);
    Mean mean;
    gather(job, hit, origin, mean, [&](const Pixel& p, Vec3f away) {
        return std::abs(dot(away, p.lit.normal)) < 0.04f * pixel && length(away) < 8 * pixel;
    });
    if (job.sample == 0 ? !mean.around() : mean.count() < 2) return std::nullopt;
    // Beside an edge normals are those of a pixel's width, which no neighbour has.
    if (!mean.whole() || mean.spread() > 0.1f || mean.agreement() < 0.98f) return std::nullopt;
    return mean.lit();
}

std::optional<Shading> PixelCache::light(Job job, const Hit& hit, Vec3f normal, OriginId origin) const {
    const float pixel = pixelAt(hit);
    // What faces away from the sun doesn't know whether it is seen from there.
    const bool sunny = dot(normal, sunDirection()) > 0;
    Mean mean;
    gather(job, hit, origin, mean, [&](const Pixel& p, Vec3f away) {
        return dot(p.lit.normal, normal) > 0.3f && length(away) < 4 * pixel &&
               (!sunny || dot(p.lit.normal, sunDirection()) > 0);
    });
    if (mean.count() == 0 || (job.sample == 0 && !mean.around())) return std::nullopt;
    // The edge of a shadow on something smooth must be found; on ornament nobody sees it.
    if (mean.spread() > 0.25f && (job.sample == 0 || mean.agreement() > 0.95f)) return std::nullopt;
    Shading lit = mean.lit();
    lit.normal = normal;
    return lit;
}

}  // namespace sgm::render
