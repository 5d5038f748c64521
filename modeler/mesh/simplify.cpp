#include "modeler/mesh/simplify.h"

#include <cmath>
#include <optional>

#include "modeler/mesh/faults.h"
#include "modeler/mesh/planar_merge.h"
#include "modeler/mesh/planar_split.h"
#include "modeler/mesh/release.h"

namespace sgm::mesh {
namespace {

/// Of the tolerance: planes and borders may each take a part, so that both stay within it.
constexpr double planeShare = 0.25, chainShare = 0.5;
/// Of the largest coordinate: what rounding to float leaves of a plane or a straight line, a few units in the last
/// place.
constexpr double roundingShare = 0x1p-20;
/// After so many rounds with faults the mesh stays as it is.
constexpr int mostRounds = 24;

class Simplifier {
public:
    Simplifier(const Mesh& mesh, const SimplifyOptions& options, Progress* progress)
        : mesh_(mesh), options_(options), progress_(progress) {}

    Result<Mesh> run() {
        flat_ = flatten(mesh_, options_.threads);
        releaseConfined(mesh_, flat_, options_.threads, progress_);
        auto regions = findRegions(flat_, options_.threads);
        if (!regions.ok()) return regions.error();
        regions_ = std::move(*regions);
        const double rounding_m = roundingShare * largestCoordinate(), tolerance_m = options_.tolerance_m;
        const double planar_m = std::max(rounding_m, planeShare * tolerance_m);
        planes_ = findPlanes(flat_, regions_, planar_m, options_.threads);
        const std::vector<uint32_t> separated = separateBumps(flat_, planar_m, regions_, planes_);
        chains_ = findChains(regions_);
        rejectTouching(flat_, chains_, separated, std::max(rounding_m, chainShare * tolerance_m), planes_,
                       options_.threads);
        if (cancelled(progress_)) return cancelledError();
        const DecimationInput input{flat_, regions_, chains_, planes_};
        curved_.emplace(input, DecimationLimits{tolerance_m, chainShare * tolerance_m});
        planar_.emplace(input, chainShare * tolerance_m, rounding_m);

        FaultFinder finder(flat_.positions, options_.threads, progress_);
        for (int round = 0; round < mostRounds; ++round) {
            if (tolerance_m > rounding_m) curved_->run(options_.threads, progress_);
            const bool again = !cancelled(progress_) && planar_->run(*curved_, options_.threads, progress_);
            if (cancelled(progress_)) return cancelledError();
            if (again) continue;
            collect();
            const auto faults = finder.find(triangles_, planar_->triangulated());
            if (cancelled(progress_)) return cancelledError();
            if (faults.empty()) return composeMesh(mesh_, flat_, regions_, planes_, triangles_);
            if (!refine(faults)) break;
        }
        triangles_.clear();
        for (uint32_t t = 0; t < flat_.triangles.size(); ++t)
            triangles_.push_back({flat_.triangles[t], regions_.ofTriangle[t]});
        return composeMesh(mesh_, flat_, regions_, planes_, triangles_);
    }

private:
    double largestCoordinate() const {
        const Box3f box = mesh_.bounds();
        if (box.empty()) return 0;
        return static_cast<double>(std::max(maxComponent(box.hi), -minComponent(box.lo)));
    }

    /// The result so far: curved regions, planar ones, and those that stay as they are.
    void collect() {
        triangles_.assign(curved_->triangles.begin(), curved_->triangles.end());
        bool some = false;
        for (uint32_t r = 0; r < regions_.count(); ++r) {
            if (!planes_[r].planar()) continue;
            if (planar_->isLeft(r))
                some = true;
            else
                for (const Triangle& t : planar_->triangles(r)) triangles_.push_back({t, r});
        }
        if (!some) return;
        for (uint32_t t = 0; t < flat_.triangles.size(); ++t) {
            const uint32_t r = regions_.ofTriangle[t];
            if (planes_[r].planar() && planar_->isLeft(r)) triangles_.push_back({flat_.triangles[t], r});
        }
    }

    /// Gives back what was taken near triangles at fault; false when nothing is left to give.
    bool refine(std::span<const uint32_t> faults) {
        bool refined = false;
        std::vector<uint32_t> regions;
        for (const uint32_t t : faults) {
            if (t < curved_->triangles.size())
                refined |= curved_->keepAround(t);
            else
                regions.push_back(triangles_[t].region);
        }
        if (refined) return true;
        for (const uint32_t r : regions) refined |= planar_->refine(r, *curved_);
        return refined;
    }

    const Mesh& mesh_;
    const SimplifyOptions options_;
    Progress* const progress_;
    FlatMesh flat_;
    SurfaceRegions regions_;
    Chains chains_;
    std::vector<Plane> planes_;
    std::optional<Decimation> curved_;
    std::optional<PlanarMerge> planar_;
    std::vector<SimpleTriangle> triangles_;  ///< of the result; those of `curved_` first, in its order
};

}  // namespace

Result<Mesh> simplify(const Mesh& mesh, const SimplifyOptions& options, Progress* progress) {
    if (!(options.tolerance_m >= 0) || !std::isfinite(options.tolerance_m))
        return Error{Error::Kind::Usage, "the tolerance of simplification is a length, 0 or more"};
    if (progress) progress->begin("simplify", 1);
    return Simplifier(mesh, options, progress).run();
}

Result<Mesh> simplifyToShare(const Mesh& mesh, double share, int threads, Progress* progress) {
    if (!(share > 0 && share <= 1))
        return Error{Error::Kind::Usage, "the simplification ratio must be above 0 and at most 1"};
    if (share == 1) return mesh;
    const double most = share * static_cast<double>(mesh.triangleCount());
    const auto extent = static_cast<double>(maxComponent(mesh.bounds().size()));
    double low = 1e-5 * extent, high = 0.2 * extent;
    auto best = simplify(mesh, {high, threads}, progress);
    while (high > 1.125 * low) {
        const double middle = std::sqrt(low * high);
        auto tried = simplify(mesh, {middle, threads}, progress);
        if (!tried.ok()) return tried;
        if (static_cast<double>(tried->triangleCount()) <= most)
            high = middle, best = std::move(tried);
        else
            low = middle;
    }
    return best;
}

}  // namespace sgm::mesh
