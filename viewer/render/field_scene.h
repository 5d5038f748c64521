// A field that can be drawn: a tracer finds what rays meet and the light there, one shader colours it.
// Enters: a prepared field. Leaves: what each ray met and its colour. Assumes a current GL 4.3 context.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "viewer/render/gpu_tracer.h"
#include "viewer/render/pixel_cache.h"
#include "viewer/render/scene.h"
#include "viewer/render/tracer.h"

namespace sgm::render {

/// The shaders, kept while they know every op of the fields that come.
struct FieldPrograms {
    Program shade;
    std::shared_ptr<const RayPrograms> rays;  ///< null where the processor walks the rays
};
/// Programs for this field and those that `before` covers (null: none): `before` itself where it covers the field.
Result<std::shared_ptr<const FieldPrograms>> programsFor(const PreparedField& field,
                                                         std::shared_ptr<const FieldPrograms> before,
                                                         TracedBy by = TracedBy::Best);

/// What a batch of rays met, an entry a job.
struct Rays {
    std::vector<Hit> hits;
    std::vector<Shading> shadings;
    std::vector<std::array<float, 4>> colors;  ///< display light 0 … 1, linear, and 1
    std::vector<OriginId> origins;             ///< of objects, else 0
};

/// A prepared field with its tracer.
class FieldScene {
public:
    /// `programs` must cover the field.
    FieldScene(PreparedField field, std::shared_ptr<const FieldPrograms> programs, int threads);
    /// Draws one ray from anywhere: drivers finish compiling at a program's first draw.
    Status warmUp();
    /// Sets camera, picture size and ground. `fine` scales how exactly surfaces are found: above 1 finer than the
    /// picture's pixels ask for. With `share`, samples whose surroundings agree take their light from there.
    void look(const PictureOptions& options, double fine = 1, bool share = true);
    /// What the rays of jobs of the picture last looked at meet: without light and colours.
    Result<Rays> trace(std::span<const Job> jobs, Progress* progress);
    /// Traces and lights up to `mostJobs` jobs of the picture last looked at, in pieces of some 15 ms.
    Result<Rays> draw(std::span<const Job> jobs, Progress* progress);
    /// Of all that was drawn.
    const TraceCost& cost() const { return tracer_->cost(); }
    const std::shared_ptr<const PreparedField>& field() const { return field_; }

private:
    /// Asks the tracer about some of the hits.
    Status ask(Tracer::What what, const std::vector<uint32_t>& which, Rays& rays, Progress* progress);
    void findOrigins(const std::vector<uint32_t>& which, Rays& rays) const;
    Status light(std::span<const Job> jobs, Rays& rays, Progress* progress);
    /// What the hits are like, for the shader that colours them.
    struct Surfaces {
        std::vector<uint32_t> materialOfHit;
        MaterialRows rows;              ///< empty: those of the materials alone
        std::vector<Shading> shadings;  ///< with the normals of textures; empty as well then
    };
    Surfaces surfacesOf(const Rays& rays) const;

    std::shared_ptr<const PreparedField> field_;
    std::shared_ptr<const FieldPrograms> programs_;
    std::unique_ptr<Tracer> tracer_;
    PixelCache seen_;
    bool share_ = true;
    Buffer materials_;
    View view_{};
    int threads_;
    size_t shadePiece_ = 2048;  ///< jobs a dispatch
};

}  // namespace sgm::render
