#include "grammar/pipeline/refining.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <tuple>

#include "grammar/lower/thin_cells.h"
#include "grammar/lower/torn_eaves.h"
#include "grammar/lower/torn_rims.h"
#include "modeler/mesh/refine.h"
#include "modeler/mesh/region.h"

namespace sgm::pipeline {
namespace {

constexpr size_t mostGrowth = 4, leastBound = 1000000;  ///< of triangles
constexpr double cellsPerTriangle = 16;                 ///< at most looked at, of the triangles that the mesh may have
constexpr int mostHalvingsOfCells = 3;
constexpr double leastMissingEaves = 0.5;  ///< share of eaves that the mesh is said to lack

/// Cells to be halved, by how often.
using HalvedCells = std::array<mesh::CellSet, mostHalvingsOfCells + 1>;

class ThinPartRefiner {
public:
    ThinPartRefiner(const Model& model, mesh::Mesh& mesh, const mesh::Grid& grid, int mostHalvings, Context& context)
        : model_(model),
          mesh_(mesh),
          grid_(grid),
          most_(mesh::isExpensive(model.tape) ? 0 : std::min(mostHalvings, mostHalvingsOfCells)),
          context_(context),
          mostTriangles_(std::max(mostGrowth * mesh.triangleCount(), leastBound)) {}

    /// Cells around what the mesh lacks are meshed anew, and again with smaller ones while some of it is still missing:
    /// within its scope a part may be thinner. What isn't missing stays so, for smaller cells have the larger ones'
    /// corners. What the mesh has, but torn, comes last: it may use what is left of the triangles.
    Result<std::vector<lower::ThinPart>> run() {
        auto missing = hold(lower::findMissingParts);
        if (!missing.ok()) return missing;
        const double seconds = halvingSeconds_;
        std::vector<lower::ThinPart> torn;
        for (Finder* const finder : {lower::findTornParts, lower::findTornRims}) {
            auto left = hold(*finder);
            if (!left.ok()) return left;
            if (finder == lower::findTornRims) torn = std::move(*left);
        }
        auto eaves = hold(lower::findTornEaves);
        if (!eaves.ok()) return eaves;
        if (halvingSeconds_ > seconds && !missing->empty()) missing = find(lower::findMissingParts, &*missing);
        if (!missing.ok()) return missing;
        const std::vector<lower::ThinPart> bounded = boundedParts();
        if (!bounded.empty()) {
            auto left = find(lower::findTornParts, &bounded);
            if (!left.ok()) return left;
            std::move(left->begin(), left->end(), std::back_inserter(torn));
        }
        for (lower::ThinPart& part : torn)
            if (isBounded(part) && !isAmong(*missing, part)) missing->push_back(std::move(part));
        for (lower::ThinPart& lacked : *eaves) {
            if (lacked.missing < leastMissingEaves && !isBounded(lacked)) continue;
            lacked.cell_m = lacked.thickness_m;  // cells that hold it without being halved
            missing->push_back(std::move(lacked));
        }
        for (lower::ThinPart& part : *missing) part.halvings = most_, part.isBounded = isBounded(part);
        context_.stages.emplace_back("thin parts", findingSeconds_);
        if (halvingSeconds_ > 0) context_.stages.emplace_back("halve cells", halvingSeconds_);
        return missing;
    }

private:
    using Finder = decltype(lower::findMissingParts);
    /// Around a part, at its eaves, or beside a face.
    using Place = std::tuple<OriginId, bool, int>;
    /// By how often cells are halved for it.
    using PlacesByHalvings = std::array<std::vector<Place>, mostHalvingsOfCells + 1>;
    static Place placeOf(const lower::ThinPart& part) {
        return {part.part, part.kind == lower::ThinPart::Kind::Eaves, part.face};
    }

    bool isBounded(const lower::ThinPart& part) const { return bounded_.contains(placeOf(part)); }
    /// What findTornParts is to look at closely.
    std::vector<lower::ThinPart> boundedParts() const {
        std::vector<lower::ThinPart> parts;
        for (const Place& place : bounded_)
            if (!std::get<1>(place)) parts.push_back({.part = std::get<0>(place), .places = {}, .isBounded = true});
        return parts;
    }
    static bool isAmong(std::span<const lower::ThinPart> parts, const lower::ThinPart& part) {
        return std::any_of(parts.begin(), parts.end(), [&](const lower::ThinPart& p) { return p.part == part.part; });
    }

    Result<std::vector<lower::ThinPart>> find(Finder& finder, const std::vector<lower::ThinPart>* among) {
        const Stopwatch finding;
        auto found = finder(model_.derivation, *model_.lowered, model_.tape, mesh_, grid_.cell_m, context_.threads,
                            context_.progress, among);
        findingSeconds_ += finding.seconds();
        return found;
    }

    /// Halves cells while that makes what is found fewer. Returns what is left.
    Result<std::vector<lower::ThinPart>> hold(Finder& finder) {
        std::optional<std::vector<lower::ThinPart>> before;
        for (;;) {
            auto found = find(finder, before ? &*before : nullptr);
            if (!found.ok()) return found;
            PlacesByHalvings asked;
            const HalvedCells cells = cellsAround(*found, asked);
            bool isRefined = false;
            for (int halvings = 1; halvings <= most_; ++halvings)
                if (const auto h = static_cast<size_t>(halvings); !cells[h].empty())
                    if (const Status s = refine(cells[h], halvings, asked[h], isRefined); !s.ok()) return s.error();
            if (!isRefined) return found;
            before = std::move(*found);
        }
    }

    /// Leaves what the cells are halved for.
    HalvedCells cellsAround(const std::vector<lower::ThinPart>& missing, PlacesByHalvings& asked) {
        HalvedCells cells;
        double cellCount = 0;
        const auto halve = [&](const lower::ThinPart& part, int halvings) {
            const double count = lower::countCellsAround(part, grid_);
            if (cellCount + count > cellsPerTriangle * static_cast<double>(mostTriangles_)) {
                bounded_.insert(placeOf(part));
                return;
            }
            cellCount += count;
            mesh::CellSet around;
            lower::addCellsAround(part, grid_, around);
            int& tried = tried_[placeOf(part)];
            tried = std::max(halvings, halvingsIn(around));
            asked[static_cast<size_t>(tried)].push_back(placeOf(part));
            for (const Vec3i cell : around.list()) cells[static_cast<size_t>(tried)].insert(cell);
        };
        std::vector<const lower::ThinPart*> thinner;
        for (const lower::ThinPart& part : missing) {
            const int before = tried_[placeOf(part)];
            const int halvings = std::max(before + 1, lower::halvingsFor(part, grid_.cell_m));
            if (halvings <= most_)
                halve(part, halvings);
            else if (before < most_)
                thinner.push_back(&part);
        }
        // Smaller cells hold more of what they don't hold yet; they come last, for a mesh may not grow so far.
        for (const lower::ThinPart* part : thinner) halve(*part, most_);
        return cells;
    }

    /// How often some of the cells were halved at most.
    int halvingsIn(const mesh::CellSet& cells) const {
        for (int halvings = most_; halvings > 0; --halvings) {
            const mesh::CellSet& halved = halved_[static_cast<size_t>(halvings)];
            const auto isHalved = [&](Vec3i cell) { return halved.contains(cell); };
            if (!halved.empty() && std::any_of(cells.list().begin(), cells.list().end(), isHalved)) return halvings;
        }
        return 0;
    }

    /// Halves cells so often. Where they come to take others with them that were halved more often, and hold there what
    /// larger ones don't, all of them are halved as often as these.
    Status refine(const mesh::CellSet& cells, int halvings, const std::vector<Place>& asked, bool& isRefined) {
        const Stopwatch watch;
        for (;;) {
            auto refined = mesh::refineCells(mesh_, model_.tape, grid_, cells,
                                             {halvings, mostTriangles_, context_.threads}, context_.progress);
            if (!refined.ok()) return refined.error();
            if (refined->isBounded) bounded_.insert(asked.begin(), asked.end());
            if (!refined->made) break;
            if (const int finest = halvingsIn(refined->made->cells); finest > halvings) {
                halvings = finest;
                continue;
            }
            mesh_ = std::move(refined->made->mesh);
            for (const Vec3i cell : refined->made->cells.list()) halved_[static_cast<size_t>(halvings)].insert(cell);
            isRefined = true;
            break;
        }
        halvingSeconds_ += watch.seconds();
        return Done{};
    }

    const Model& model_;
    mesh::Mesh& mesh_;
    const mesh::Grid& grid_;
    const int most_;
    Context& context_;
    const size_t mostTriangles_;
    std::map<Place, int> tried_;  ///< halvings of the cells there
    std::set<Place> bounded_;     ///< where halving ended at the bound of triangles
    HalvedCells halved_;
    double findingSeconds_ = 0, halvingSeconds_ = 0;
};

}  // namespace

Result<std::vector<lower::ThinPart>> holdThinParts(const Model& model, mesh::Mesh& mesh, const mesh::Grid& grid,
                                                   int mostHalvings, Context& context) {
    return ThinPartRefiner(model, mesh, grid, mostHalvings, context).run();
}

}  // namespace sgm::pipeline
