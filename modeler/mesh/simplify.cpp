#include "modeler/mesh/simplify.h"

#include <cmath>
#include <mutex>
#include <optional>

#include "modeler/core/parallel.h"
#include "modeler/mesh/apart.h"
#include "modeler/mesh/components.h"
#include "modeler/mesh/curved_edges.h"
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
constexpr int mostSplitRounds = 12;  ///< of these, in which edges of planar regions get a point back each
constexpr int mostRetries = 2;       ///< of planar regions that couldn't be merged
constexpr size_t leastRetried = 64;  ///< triangles of such a region that is worth it
/// Of the result's triangles: what another try takes away at most has to be more, for it takes as long as the first.
constexpr double leastGain = 0.125;

/// Which solids and cavities a surface has, to see whether simplification turns one inside out: those about as small as
/// the tolerance may be turned.
class Insides {
public:
    Insides(const FlatMesh& flat, const SurfaceRegions& regions)
        : positions_(flat.positions), component_(regions.count()), anchor_(regions.count()), before_(regions.count()) {
        Components joined(regions.count());
        for (const BorderEdge& e : regions.borders) joined.join(e.left, e.right);
        for (uint32_t r = 0; r < component_.size(); ++r) component_[r] = joined.find(r);
        std::vector<bool> isKnown(regions.count());
        for (size_t t = 0; t < flat.triangles.size(); ++t) {
            const uint32_t component = component_[regions.ofTriangle[t]];
            if (!isKnown[component])
                isKnown[component] = true, anchor_[component] = flat.positions[flat.triangles[t].x];
            before_[component] += volumeUnder(flat.triangles[t], component);
        }
    }

    /// The triangles of components that enclose air where they enclosed solid, or the other way round.
    std::vector<uint32_t> turned(std::span<const SimpleTriangle> triangles) const {
        std::vector<double> now(component_.size());
        for (const SimpleTriangle& t : triangles)
            now[component_[t.region]] += volumeUnder(t.corners, component_[t.region]);
        std::vector<uint32_t> found;
        for (uint32_t i = 0; i < triangles.size(); ++i) {
            const uint32_t component = component_[triangles[i].region];
            if (!(before_[component] * now[component] > 0)) found.push_back(i);
        }
        return found;
    }

private:
    /// Six times what lies between a triangle and a point of its component, by the divergence theorem.
    double volumeUnder(const Triangle& t, uint32_t component) const {
        const Vec3d near = anchor_[component].as<double>();
        return dot(positions_[t.x].as<double>() - near,
                   cross(positions_[t.y].as<double>() - near, positions_[t.z].as<double>() - near));
    }

    std::span<const Vec3f> positions_;
    std::vector<uint32_t> component_;  ///< by region: the lowest one of its component
    std::vector<Vec3f> anchor_;        ///< by that region: a point of the component
    std::vector<double> before_;       ///< by that region: six times the component's volume, of cavities below 0
};

class Simplifier {
public:
    Simplifier(const Mesh& mesh, double tolerance_m, double rounding_m, int threads, Progress* progress)
        : mesh_(mesh), tolerance_m_(tolerance_m), rounding_m_(rounding_m), threads_(threads), progress_(progress) {}

    /// Nothing where every result within the tolerance has faults.
    Result<std::optional<Mesh>> run() {
        flat_ = flatten(mesh_, threads_);
        releaseConfined(mesh_, flat_, threads_, progress_);
        auto regions = findRegions(flat_, threads_);
        if (!regions.ok()) return regions.error();
        regions_ = std::move(*regions);
        const double planar_m = std::max(rounding_m_, planeShare * tolerance_m_);
        planes_ = findPlanes(flat_, regions_, planar_m, threads_);
        const std::vector<uint32_t> separated = separateBumps(flat_, planar_m, regions_, planes_);
        chains_ = findChains(regions_);
        rejectTouching(flat_, chains_, separated, std::max(rounding_m_, chainShare * tolerance_m_), planes_, threads_);
        if (cancelled(progress_)) return cancelledError();
        const Insides insides(flat_, regions_);
        auto best = simplifyOnce(insides);
        for (int attempt = 0; attempt < mostRetries && best.ok() && *best && treatLeftAsCurved(**best); ++attempt) {
            auto made = simplifyOnce(insides);
            if (!made.ok()) return made;
            if (!*made || (*made)->triangleCount() >= (*best)->triangleCount()) break;
            best = std::move(made);
        }
        return best;
    }

    /// Whether faults made run() give so much back that a smaller tolerance, with fewer faults, may leave fewer
    /// triangles than this result: without any it would leave about as many as there were before the first fault.
    bool gaveMuchBack(const Mesh& result) const {
        const auto count = static_cast<double>(result.triangleCount());
        return count - static_cast<double>(fewest_) > leastGain * count;
    }

    /// The mean length of the mesh's edges, were its triangles equilateral, after run(); metres.
    double meanEdge() const {
        double area_m2 = 0;
        for (const Triangle& t : flat_.triangles) {
            const Vec3d p = flat_.positions[t.x].as<double>();
            area_m2 += length(cross(flat_.positions[t.y].as<double>() - p, flat_.positions[t.z].as<double>() - p)) / 2;
        }
        return std::sqrt(area_m2 / (std::sqrt(3) / 4 * static_cast<double>(flat_.triangles.size())));
    }

    /// All triangles as they are, after run().
    Mesh keepAll() {
        triangles_.clear();
        for (uint32_t t = 0; t < flat_.triangles.size(); ++t)
            triangles_.push_back({flat_.triangles[t], regions_.ofTriangle[t]});
        return composeMesh(mesh_, flat_, regions_, planes_, triangles_);
    }

private:
    /// The result with the planes as they are, nothing where it has faults.
    Result<std::optional<Mesh>> simplifyOnce(const Insides& insides) {
        const DecimationInput input{flat_, regions_, chains_, planes_};
        splits_ = 0;
        curved_.emplace(input, DecimationLimits{tolerance_m_, chainShare * tolerance_m_});
        planar_.emplace(input, chainShare * tolerance_m_, rounding_m_);

        FaultFinder finder(flat_.positions, threads_, progress_);
        for (int round = 0; round < mostRounds; ++round) {
            if (tolerance_m_ > rounding_m_) curved_->run(threads_, progress_);
            const bool again = !cancelled(progress_) && planar_->run(*curved_, threads_, progress_);
            if (cancelled(progress_)) return cancelledError();
            if (again) continue;
            collect();
            auto faults = finder.find(triangles_, planar_->triangulated());
            if (cancelled(progress_)) return cancelledError();
            if (faults.empty()) faults = insides.turned(triangles_);
            if (faults.empty()) return std::optional(composeMesh(mesh_, flat_, regions_, planes_, triangles_));
            if (!refine(faults)) break;
        }
        return std::optional<Mesh>();
    }

    /// Takes the planes from large planar regions that have kept all their triangles, since some place of them crosses
    /// others: as curved ones they keep those near there. Whether they are much of the result.
    bool treatLeftAsCurved(const Mesh& result) {
        if (!(tolerance_m_ > rounding_m_)) return false;
        std::vector<size_t> triangles(regions_.count());
        for (const uint32_t r : regions_.ofTriangle) ++triangles[r];
        size_t left = 0;
        for (uint32_t r = 0; r < regions_.count(); ++r)
            if (isLeftWhole(r, triangles[r])) left += triangles[r];
        if (!(static_cast<double>(left) > leastGain * static_cast<double>(result.triangleCount()))) return false;
        for (uint32_t r = 0; r < regions_.count(); ++r)
            if (isLeftWhole(r, triangles[r])) planes_[r] = {};
        return true;
    }
    bool isLeftWhole(uint32_t region, size_t triangles) const {
        return planes_[region].planar() && planar_->isLeft(region) && triangles >= leastRetried;
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
        if (some) collectLeft();
        fewest_ = std::min(fewest_, triangles_.size());
    }
    void collectLeft() {
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
        // Where one place is at fault, the rest of its regions needn't have their points back.
        if (splits_++ < mostSplitRounds) {
            for (const uint32_t t : faults) refined |= planar_->splitEdges(triangles_[t].region, triangles_[t].corners);
            if (refined) return true;
        }
        for (const uint32_t r : regions) refined |= planar_->refine(r, *curved_);
        return refined;
    }

    const Mesh& mesh_;
    const double tolerance_m_, rounding_m_;
    const int threads_;
    Progress* const progress_;
    FlatMesh flat_;
    SurfaceRegions regions_;
    Chains chains_;
    std::vector<Plane> planes_;
    std::optional<Decimation> curved_;
    std::optional<PlanarMerge> planar_;
    int splits_ = 0;                         ///< rounds that split edges at fault
    std::vector<SimpleTriangle> triangles_;  ///< of the result; those of `curved_` first, in its order
    size_t fewest_ = SIZE_MAX;               ///< triangles of a result, with faults or without
};

/// A mesh simplified within the tolerance. Within one as large as the triangles, parts cross one another in many
/// places, which keep their vertices then: quarters of it, `mostQuarters` at most, may leave fewer, or no faults at
/// all. The fewest triangles count. Where little was given back there is little to gain.
Result<Mesh> simplifyWithin(const Mesh& mesh, double tolerance_m, double rounding_m, int threads, Progress* progress) {
    constexpr int mostQuarters = 8;
    const auto extent_m = static_cast<double>(maxComponent(mesh.bounds().size()));
    double within_m = std::min(tolerance_m, std::max(extent_m, rounding_m));
    std::optional<Mesh> best;
    for (int quarter = 0;; ++quarter, within_m /= 4) {
        Simplifier simplifier(mesh, within_m, rounding_m, threads, progress);
        auto made = simplifier.run();
        if (!made.ok()) return made.error();
        if (*made) {
            const bool gaveMuchBack = simplifier.gaveMuchBack(**made);
            if (!best || (*made)->triangleCount() < best->triangleCount()) best = std::move(*made);
            if (!gaveMuchBack) return std::move(*best);
        }
        const bool isLast = quarter == mostQuarters || within_m <= rounding_m;
        if (best && (isLast || within_m < 0.25 * simplifier.meanEdge())) return std::move(*best);
        if (isLast) return simplifier.keepAll();
    }
}

/// The same, with curved edges split where the options have a field.
Result<Mesh> simplifyPiece(const Mesh& mesh, const SimplifyOptions& options, double rounding_m, int threads,
                           Progress* progress) {
    auto made = simplifyWithin(mesh, options.tolerance_m, rounding_m, threads, progress);
    if (!made.ok() || !options.field || !(options.tolerance_m > 0)) return made;
    const auto split = splitCurvedEdges(*made, *options.field, options.tolerance_m, threads, progress);
    if (!split.ok()) return split.error();
    return made;
}

/// Pieces that are large share the threads, each of the others has one of them.
class PieceSimplifier {
public:
    PieceSimplifier(const std::vector<Mesh>& pieces, const SimplifyOptions& options, double rounding_m,
                    Progress* progress)
        : pieces_(pieces), options_(options), rounding_m_(rounding_m), progress_(progress), made_(pieces.size()) {}

    /// What is made of each piece.
    Result<std::vector<std::shared_ptr<const Mesh>>> run() {
        std::vector<size_t> small;
        for (size_t i = 0; i < pieces_.size(); ++i) {
            if (options_.pieces && (made_[i] = options_.pieces->find(pieces_[i]))) continue;
            if (pieces_[i].triangleCount() < largeTriangles)
                small.push_back(i);
            else
                make(i, options_.threads);
        }
        parallelFor(small.size(), options_.threads, progress_, [&](size_t k, int) { make(small[k], 1); });
        if (cancelled(progress_)) return cancelledError();
        if (failed_) return *failed_;
        return std::move(made_);
    }

private:
    static constexpr size_t largeTriangles = 1 << 17;

    void make(size_t i, int threads) {
        auto mesh = simplifyPiece(pieces_[i], options_, rounding_m_, threads, progress_);
        if (mesh.ok()) {
            made_[i] = std::make_shared<const Mesh>(std::move(*mesh));
            return;
        }
        const std::lock_guard lock(mutex_);
        if (failed_ && failedAt_ < i) return;
        failed_ = mesh.error(), failedAt_ = i;
    }

    const std::vector<Mesh>& pieces_;
    const SimplifyOptions& options_;
    const double rounding_m_;
    Progress* const progress_;
    std::vector<std::shared_ptr<const Mesh>> made_;
    std::mutex mutex_;
    std::optional<Error> failed_;
    size_t failedAt_ = 0;  ///< the first piece that failed
};

double roundingOf(const Mesh& mesh) {
    const Box3f box = mesh.bounds();
    if (box.empty()) return 0;
    return roundingShare * static_cast<double>(std::max(maxComponent(box.hi), -minComponent(box.lo)));
}

}  // namespace

std::shared_ptr<const Mesh> SimplifiedPieces::find(const Mesh& piece) const {
    const auto [begin, end] = pieces_.equal_range(hashSurface(piece));
    for (auto at = begin; at != end; ++at)
        if (sameSurface(at->second.from, piece)) return at->second.to;
    return nullptr;
}

void SimplifiedPieces::begin(double tolerance_m, double rounding_m) {
    if (tolerance_m != tolerance_m_ || rounding_m != rounding_m_) pieces_.clear();
    tolerance_m_ = tolerance_m, rounding_m_ = rounding_m;
}

void SimplifiedPieces::keep(std::vector<Mesh> from, std::vector<std::shared_ptr<const Mesh>> to) {
    pieces_.clear();
    for (size_t i = 0; i < from.size(); ++i) {
        const uint64_t hash = hashSurface(from[i]);
        pieces_.emplace(hash, Piece{std::move(from[i]), std::move(to[i])});
    }
}

Result<Mesh> simplify(const Mesh& mesh, const SimplifyOptions& options, Progress* progress) {
    if (!(options.tolerance_m >= 0) || !std::isfinite(options.tolerance_m))
        return Error{Error::Kind::Usage, "the tolerance of simplification is a length, 0 or more"};
    if (progress) progress->begin("simplify", 1);
    const double rounding_m = roundingOf(mesh);
    // Surfaces move by the tolerance at most.
    std::vector<Mesh> pieces = splitApart(mesh, 4 * std::max(options.tolerance_m, rounding_m), options.threads);
    if (pieces.empty()) return simplifyPiece(mesh, options, rounding_m, options.threads, progress);
    if (options.pieces) options.pieces->begin(options.tolerance_m, rounding_m);
    auto made = PieceSimplifier(pieces, options, rounding_m, progress).run();
    if (!made.ok()) return made.error();
    std::vector<const Mesh*> simplified;
    for (const auto& piece : *made) simplified.push_back(piece.get());
    Mesh joined = join(simplified);
    if (options.pieces) options.pieces->keep(std::move(pieces), std::move(*made));
    return joined;
}

Result<Mesh> simplifyToShare(const Mesh& mesh, double share, int threads, Progress* progress) {
    if (!(share > 0 && share <= 1))
        return Error{Error::Kind::Usage, "the simplification ratio must be above 0 and at most 1"};
    if (share == 1) return mesh;
    const double most = share * static_cast<double>(mesh.triangleCount());
    const auto extent = static_cast<double>(maxComponent(mesh.bounds().size()));
    double low = 1e-5 * extent, high = 0.2 * extent;
    auto best = simplify(mesh, {high, threads}, progress);
    if (!best.ok()) return best;
    while (high > 1.125 * low) {
        const double middle = std::sqrt(low * high);
        auto tried = simplify(mesh, {middle, threads}, progress);
        if (!tried.ok()) return tried;
        const bool isEnough = static_cast<double>(tried->triangleCount()) <= most;
        (isEnough ? high : low) = middle;
        if (isEnough || tried->triangleCount() < best->triangleCount()) best = std::move(tried);
    }
    return best;
}

}  // namespace sgm::mesh
