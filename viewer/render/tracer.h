// What traces rays through a prepared field: the GPU's shaders, or, where the driver has only a processor to run them
// on, that processor's own vectors, which are an order of magnitude quicker there. Enters: rays of a picture. Leaves:
// what their rays met, and the light there. Both trace alike (shaders/trace.comp.glsl, sphere_tracer.h).
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "modeler/core/progress.h"
#include "modeler/core/result.h"
#include "viewer/render/draw.h"
#include "viewer/render/pixels.h"
#include "viewer/render/prepared_field.h"

namespace sgm::render {

/// What traces here: `Best` becomes one of the others, by the current context.
TracedBy tracerHere(TracedBy by);

enum class HitKind { Sky, Object, Ground };

/// What a ray met, as shaders read and write it.
struct Hit {
    Vec3f position;  ///< metres; for the sky the ray's direction
    float kindNumber = 0;
    HitKind kind() const { return static_cast<HitKind>(static_cast<int>(kindNumber)); }
};

/// A ray through a sample of the picture, and what those beside it tell.
struct Ray {
    Job job;
    float start = 0;   ///< no surface is nearer along it, metres
    float guess = 0;   ///< where it may meet the plane that its pixel's first ray met, metres; 0 for nowhere
    float beside = 0;  ///< half the angle of the cone about it whose rays come later, radians; 0 for none
};

/// What rays met, an entry a ray.
struct Hits {
    std::vector<Hit> hits;
    std::vector<Vec3f> normals;  ///< unit, of those that became known on the way; else 0
    std::vector<float> free;     ///< metres along each up to which the cone beside it is known to hold no surface
};

/// How much light comes to a hit, as shaders read and write it; shares 0 … 1. All 0 for the sky.
struct Shading {
    Vec3f normal;    ///< unit
    float openness;  ///< of open sky
    float sunlight;  ///< of the sun's disc
    float daylight;  ///< in a hollow with a lamp: of the day that gets in
    float unused[2];
};

/// What a picture cost: evaluations of the field by shortened tapes, and the instructions of those.
struct TraceCost {
    uint64_t hits = 0, light = 0, instructions = 0;
    TraceCost& operator+=(const TraceCost& other);
};

/// Walks rays through one field. Not for two threads at once.
class Tracer {
public:
    virtual ~Tracer() = default;
    /// Sets camera, picture size and ground. `fine` scales how exactly surfaces are found: above 1 finer than the
    /// picture's pixels ask for.
    virtual void look(const PictureOptions& options, double fine) = 0;
    /// Error::Cancelled when `progress` says so, Error::Internal when the driver fails.
    virtual Result<Hits> trace(std::span<const Ray> rays, Progress* progress) = 0;
    /// Sets the normals alone, where hits are or as means over some of their pixels, or, by those, all the rest; of
    /// hits that aren't the sky's.
    enum class What : int { Normals, WideNormals, Light };
    virtual Status light(What what, std::span<const Hit> hits, std::span<Shading> shadings, Progress* progress) = 0;
    /// All so far.
    const TraceCost& cost() const { return cost_; }

protected:
    TraceCost cost_;
};

/// How deep space is best cut into cells for who walks: shaders gain by the shortest tapes; the processor asks many
/// places at once of longer ones as quickly, and needn't wait for the last cut. `Best` asks the current context.
int cellDepth(TracedBy by);

/// Walks on the processor, on `threads` threads (0 = all). `field` must live on.
std::unique_ptr<Tracer> processorTracer(std::shared_ptr<const PreparedField> field, int threads);

}  // namespace sgm::render
