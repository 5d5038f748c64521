#include "modeler/mesh/levels.h"

#include <cmath>

#include "modeler/mesh/simplify.h"

namespace sgm::mesh {
namespace {

/// Of the picture in which no level is off by more than a pixel.
constexpr double pictureLines = 1080;

/// A level with more than this share of the triangles of the one before is worth another try, from the finest mesh
/// where that has at most so many times the triangles: of larger ones it would take long.
constexpr double littleGain = 0.75;
constexpr size_t mostTimes = 4;

class LevelMaker {
public:
    LevelMaker(const Mesh& finest, const LevelOptions& options, Progress* progress)
        : finest_(finest), options_(options), progress_(progress), before_(&finest) {}

    /// The next level, from 1 on.
    Result<LevelOfDetail> make(int level, double tolerance_m) {
        made_ = {{}, tolerance_m, 0, levelCoverage(level)};
        Status done = offer(simplified(*before_, tolerance_m - used_m_), 0);
        if (done.ok()) done = offer(meshedAnew(2 * tolerance_m), static_cast<float>(2 * tolerance_m));
        // Simplified twice a mesh keeps more than simplified at once, but that takes longer.
        const size_t before = before_->triangleCount();
        const bool little = static_cast<double>(made_.mesh.triangleCount()) > littleGain * static_cast<double>(before);
        if (done.ok() && little && before_ != &finest_ && finest_.triangleCount() <= mostTimes * before)
            done = offer(simplified(finest_, tolerance_m), 0);
        if (!done.ok()) return done.error();
        return std::move(made_);
    }

    /// Goes on from a level, which stays where it is.
    void follow(const LevelOfDetail& level) {
        before_ = &level.mesh;
        used_m_ = level.tolerance_m;
    }

private:
    Result<Mesh> simplified(const Mesh& mesh, double tolerance_m) const {
        return simplify(mesh, {tolerance_m, options_.threads}, progress_);
    }

    /// The field at such cells, simplified; without triangles where they are no larger than the finest mesh's or it has
    /// no surface there.
    Result<Mesh> meshedAnew(double cell_m) const {
        if (!options_.meshAt || !(cell_m > static_cast<double>(options_.cell_m))) return Mesh();
        const auto mesh = options_.meshAt(static_cast<float>(cell_m));
        if (!mesh.ok() || mesh->triangleCount() == 0) return mesh;
        return simplified(*mesh, cell_m / 4);
    }

    /// Takes a mesh of fewer triangles than what there is.
    Status offer(Result<Mesh> mesh, float cell_m) {
        if (!mesh.ok()) return mesh.error();
        const size_t count = mesh->triangleCount(), known = made_.mesh.triangleCount();
        if (count == 0 || (known > 0 && count >= known)) return Done{};
        made_.mesh = std::move(*mesh);
        made_.cell_m = cell_m;
        return Done{};
    }

    const Mesh& finest_;
    const LevelOptions& options_;
    Progress* const progress_;
    const Mesh* before_;
    double used_m_ = 0;  ///< of the tolerance, by the level before
    LevelOfDetail made_;
};

}  // namespace

double levelCoverage(int level) { return std::ldexp(1, -level); }

double levelTolerance(double longestSide_m, int level) { return longestSide_m / (pictureLines * levelCoverage(level)); }

Result<std::vector<LevelOfDetail>> makeLevels(const Mesh& finest, const LevelOptions& options, Progress* progress) {
    const auto side_m = static_cast<double>(maxComponent(finest.bounds().size()));
    LevelMaker maker(finest, options, progress);
    std::vector<LevelOfDetail> levels;
    levels.reserve(static_cast<size_t>(options.count));
    for (int level = 1; level <= options.count; ++level) {
        auto made = maker.make(level, levelTolerance(side_m, level));
        if (!made.ok()) return made.error();
        levels.push_back(std::move(*made));
        maker.follow(levels.back());
    }
    return levels;
}

}  // namespace sgm::mesh
