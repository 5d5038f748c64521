#include "viewer/render/field_scene.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include "modeler/core/parallel.h"
#include "viewer/render/scene.h"
#include "viewer/render/shader_text.h"

namespace sgm::render {

Result<std::shared_ptr<const FieldPrograms>> programsFor(const PreparedField& field,
                                                         std::shared_ptr<const FieldPrograms> before, TracedBy by) {
    std::shared_ptr<const RayPrograms> rays;
    if (tracerHere(by) == TracedBy::Gpu) {
        auto made = rayProgramsFor(field, before ? before->rays : nullptr);
        if (!made) return made.error();
        rays = std::move(*made);
    }
    if (before && before->rays == rays) return before;
    Result<Program> shade = Program::compute(shaderText("shade"));
    if (!shade) return shade.error();
    return std::make_shared<const FieldPrograms>(FieldPrograms{std::move(*shade), std::move(rays)});
}

FieldScene::FieldScene(PreparedField field, std::shared_ptr<const FieldPrograms> programs, int threads)
    : field_(std::make_shared<const PreparedField>(std::move(field))),
      programs_(std::move(programs)),
      tracer_(programs_->rays ? gpuTracer(field_, programs_->rays) : processorTracer(field_, threads)),
      materials_(uploadMaterials(field_->materials)),
      threads_(threads) {}

Status FieldScene::warmUp() {
    const Job job{0, 0};
    look(PictureOptions{.camera = frame(field_->bounds, 1)});
    const Result<Rays> ray = draw({&job, 1}, nullptr);
    return ray ? Status(Done{}) : ray.error();
}

void FieldScene::look(const PictureOptions& options, double fine, bool share) {
    setScene(programs_->shade, field_->bounds, options);
    tracer_->look(options, fine);
    seen_.look(options, fine);
    view_ = viewOf(options.camera, options.width, options.height);
    share_ = share;
}

Status FieldScene::ask(Tracer::What what, const std::vector<uint32_t>& which, Rays& rays, Progress* progress) {
    std::vector<Hit> hits;
    std::vector<Shading> shadings;
    for (const uint32_t i : which) {
        hits.push_back(rays.hits[i]);
        shadings.push_back(rays.shadings[i]);
    }
    if (Status s = tracer_->light(what, hits, shadings, progress); !s) return s;
    for (size_t k = 0; k < which.size(); ++k) rays.shadings[which[k]] = shadings[k];
    return Done{};
}

/// Hits lie a little before their surface, where an edge of another part that ends in it may be as near; right behind
/// it the surface's own part is deepest. Behind is where the normal says, for a slanting ray passes into the part
/// beside it; or along the ray while no normal is known.
void FieldScene::findOrigins(const std::vector<uint32_t>& which, Rays& rays) const {
    std::vector<PreparedField::Probe> probes;
    std::vector<uint32_t> of;
    for (const uint32_t i : which) {
        if (rays.hits[i].kind() != HitKind::Object) continue;
        of.push_back(i);
        const Vec3f ahead = rays.hits[i].position - view_.eye.as<float>(), normal = rays.shadings[i].normal;
        const Vec3f behind = normal == Vec3f{} ? ahead : normal * std::min(dot(normal, ahead), -0.6f * length(ahead));
        const Vec3f at = rays.hits[i].position;
        probes.push_back({at, at + (0.4f * static_cast<float>(view_.pixelAngle)) * behind});
    }
    const std::vector<OriginId> origins = field_->originsOf(probes, threads_);
    for (size_t k = 0; k < of.size(); ++k) rays.origins[of[k]] = origins[k];
}

/// Key pixels ask the field, others only for what those around them don't tell.
Status FieldScene::light(std::span<const Job> jobs, Rays& rays, Progress* progress) {
    const auto put = [&](uint32_t i) { seen_.put(jobs[i], rays.hits[i], rays.shadings[i], rays.origins[i]); };
    const auto take = [&](uint32_t i, const std::optional<Shading>& lit) {
        if (!lit) return false;
        rays.shadings[i] = *lit;
        put(i);
        return true;
    };
    for (const bool key : {true, false}) {
        std::vector<uint32_t> unknown, dark;
        for (uint32_t i = 0; i < jobs.size(); ++i) {
            if ((!share_ || PixelCache::isKey(jobs[i])) != key || rays.hits[i].kind() == HitKind::Sky) continue;
            if (key || !take(i, seen_.surface(jobs[i], rays.hits[i], rays.origins[i]))) unknown.push_back(i);
        }
        std::vector<uint32_t> withoutNormal;
        std::ranges::copy_if(unknown, std::back_inserter(withoutNormal),
                             [&](uint32_t i) { return rays.shadings[i].normal == Vec3f{}; });
        // A pixel's first sample stands for all of it, until its others add what they meet.
        const auto isFirst = [&](uint32_t i) { return jobs[i].sample == 0; };
        const std::vector<uint32_t> others(std::ranges::stable_partition(withoutNormal, isFirst).begin(),
                                           withoutNormal.end());
        withoutNormal.resize(withoutNormal.size() - others.size());
        if (Status s = ask(Tracer::What::WideNormals, withoutNormal, rays, progress); !s) return s;
        if (Status s = ask(Tracer::What::Normals, others, rays, progress); !s) return s;
        findOrigins(withoutNormal, rays);
        findOrigins(others, rays);
        for (const uint32_t i : unknown)
            if (key || !take(i, seen_.light(jobs[i], rays.hits[i], rays.shadings[i].normal, rays.origins[i])))
                dark.push_back(i);
        if (Status s = ask(Tracer::What::Light, dark, rays, progress); !s) return s;
        for (const uint32_t i : dark) put(i);
    }
    return Done{};
}

Result<Rays> FieldScene::trace(std::span<const Job> jobs, Progress* progress) {
    Rays rays{std::vector<Hit>(jobs.size()),
              std::vector<Shading>(jobs.size(), Shading{}),
              {},
              std::vector<OriginId>(jobs.size(), 0)};
    for (const bool leading : {true, false}) {
        std::vector<uint32_t> which;
        std::vector<Ray> some;
        for (uint32_t i = 0; i < jobs.size(); ++i) {
            if (PixelCache::leads(jobs[i]) != leading) continue;
            which.push_back(i);
            some.push_back(seen_.ray(jobs[i]));
        }
        if (some.empty()) continue;
        const Result<Hits> met = tracer_->trace(some, progress);
        if (!met) return met.error();
        for (size_t k = 0; k < which.size(); ++k) {
            rays.hits[which[k]] = met->hits[k];
            rays.shadings[which[k]].normal = met->normals[k];
            seen_.put(jobs[which[k]], met->free[k]);
        }
    }
    std::vector<uint32_t> all(jobs.size());
    std::iota(all.begin(), all.end(), 0u);
    findOrigins(all, rays);
    return rays;
}

/// A hit on a texture has a row of its own behind those of the materials.
FieldScene::Surfaces FieldScene::surfacesOf(const Rays& rays) const {
    Surfaces surfaces;
    for (const OriginId origin : rays.origins) surfaces.materialOfHit.push_back(field_->materialOf[origin]);
    const SurfaceTextures& textures = field_->textures;
    if (!textures.any()) return surfaces;
    surfaces.rows = materialRows(field_->materials);
    surfaces.shadings = rays.shadings;
    const auto before = static_cast<uint32_t>(field_->materials.size());
    std::vector<uint32_t> covered;
    for (uint32_t i = 0; i < rays.hits.size(); ++i)
        if (rays.hits[i].kind() == HitKind::Object && textures.covers(rays.origins[i])) covered.push_back(i);
    surfaces.rows.resize(2 * (before + covered.size()));
    parallelFor(covered.size(), threads_, nullptr, [&](size_t k, int) {
        const uint32_t i = covered[k];
        const Material& m = field_->materials[surfaces.materialOfHit[i]];
        SurfaceLook look{m.color, m.roughness, m.metallic, surfaces.shadings[i].normal};
        const Vec3f toEye = view_.eye.as<float>() - rays.hits[i].position;
        const float distance_m = length(toEye), slope = std::abs(dot(toEye, look.normal)) / std::max(distance_m, 1e-9f);
        const double footprint_m =
            static_cast<double>(distance_m / std::sqrt(std::max(slope, .05f))) * view_.pixelAngle;
        textures.apply(rays.origins[i], rays.hits[i].position, footprint_m, look);
        surfaces.materialOfHit[i] = before + static_cast<uint32_t>(k);
        surfaces.shadings[i].normal = look.normal;
        surfaces.rows[2 * (before + k)] = {look.color.x, look.color.y, look.color.z, look.roughness};
        surfaces.rows[2 * (before + k) + 1] = {look.metallic, 0, 0, 0};
    });
    return surfaces;
}

Result<Rays> FieldScene::draw(std::span<const Job> jobs, Progress* progress) {
    Result<Rays> traced = trace(jobs, progress);
    if (!traced) return traced;
    Rays& rays = *traced;
    if (Status s = light(jobs, rays, progress); !s) return s.error();
    const Surfaces surfaces = surfacesOf(rays);
    const Buffer hitBuffer = Buffer::of<Hit>(rays.hits),
                 litBuffer = Buffer::of<Shading>(surfaces.rows.empty() ? rays.shadings : surfaces.shadings),
                 materialBuffer = Buffer::of<uint32_t>(surfaces.materialOfHit),
                 textured = surfaces.rows.empty() ? Buffer() : Buffer::of<std::array<float, 4>>(surfaces.rows),
                 colors = Buffer::ofBytes(nullptr, jobs.size() * sizeof(rays.colors[0]));
    hitBuffer.bindStorage(2);
    litBuffer.bindStorage(3);
    materialBuffer.bindStorage(4);
    (surfaces.rows.empty() ? materials_ : textured).bindStorage(5);
    colors.bindStorage(6);
    if (Status s = runInPieces(programs_->shade, jobs.size(), shadePiece_, progress); !s) return s.error();
    rays.colors = colors.read<std::array<float, 4>>(jobs.size());
    return traced;
}

}  // namespace sgm::render
