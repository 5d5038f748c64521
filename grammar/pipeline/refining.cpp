#include "grammar/pipeline/refining.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <span>
#include <tuple>

#include "grammar/lower/off_surface.h"
#include "grammar/lower/thin_cells.h"
#include "grammar/lower/torn_eaves.h"
#include "grammar/lower/torn_rims.h"
#include "grammar/pipeline/grids.h"
#include "grammar/pipeline/halving_requests.h"
#include "grammar/pipeline/triangles_of_cells.h"
#include "modeler/core/random.h"
#include "modeler/mesh/refine.h"
#include "modeler/mesh/region.h"

namespace sgm::pipeline {
namespace {

constexpr size_t mostGrowth = 4;           ///< of triangles
constexpr size_t tornDivisor = 4;          ///< of that bound, for how much more what is torn may use
constexpr double cellsPerTriangle = 16;    ///< at most looked at, of the triangles that the mesh may have
constexpr uint64_t sampledOf = 8;          ///< parts: one tells what the others may take
constexpr size_t fewestSampled = 256;      ///< parts
constexpr double leastMissingEaves = 0.5;  ///< share of eaves that the mesh is said to lack

/// Cells that are halved, by how often.
using HalvedCells = std::array<mesh::CellSet, mostHalvingsOfCells + 1>;

class ThinPartRefiner {
public:
    ThinPartRefiner(const Model& model, mesh::Mesh& mesh, const mesh::Grid& grid,
                    const mesh::PolygonizeOptions& options, Context& context, mesh::Counts& counts)
        : model_(model),
          mesh_(mesh),
          grid_(grid),
          askedCell_m_(grid.cell_m),
          most_(allowedHalvings(model, options)),
          options_(options),
          mayHalveAll_(options.halvesAll),
          context_(context),
          counts_(counts),
          mostTriangles_(std::max(mostGrowth * mesh.triangleCount(), options.halvedTriangles)) {}

    /// Cells around what the mesh lacks are meshed anew, and again with smaller ones while some of it is still missing:
    /// within its scope a part may be thinner. What isn't missing stays so, for smaller cells have the larger ones'
    /// corners. What the mesh has, but torn, comes last: it may use what is left of the triangles.
    Result<std::vector<lower::ThinPart>> run() {
        if (const Status s = halveAllBySample(); !s.ok()) return s.error();
        bool isRefined = false;
        auto missing = holdAtOnce(isRefined);
        if (missing.ok() && isRefined) missing = hold(lower::findMissingParts, std::move(*missing));
        if (!missing.ok()) return missing;
        const double seconds = halvingSeconds_;
        mostTriangles_ = std::max(mostTriangles_, mesh_.triangleCount()) + mostTriangles_ / tornDivisor;
        std::vector<lower::ThinPart> torn;
        for (Finder* const finder : {lower::findTornParts, lower::findTornRims}) {
            auto left = hold(*finder);
            if (!left.ok()) return left;
            if (finder == lower::findTornRims) torn = std::move(*left);
        }
        auto eaves = hold(lower::findTornEaves);
        if (!eaves.ok()) return eaves;
        if (const auto off = hold(lower::findOffSurface); !off.ok()) return off;
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
            if (lacked.kind == lower::ThinPart::Kind::Part && isAmong(*missing, lacked)) continue;
            lacked.cell_m = lacked.thickness_m;  // cells that hold it without being halved
            missing->push_back(std::move(lacked));
        }
        std::erase_if(*missing, [](const lower::ThinPart& part) { return !(part.missing > 0); });
        for (lower::ThinPart& part : *missing)
            part.halvings = allowedHalvings(model_, options_), part.mostTriangles = options_.halvedTriangles,
            part.isBounded = isBounded(part);
        context_.stages.emplace_back("thin parts", findingSeconds_);
        if (halvingSeconds_ > 0) context_.stages.emplace_back("halve cells", halvingSeconds_);
        return missing;
    }

private:
    static int allowedHalvings(const Model& model, const mesh::PolygonizeOptions& options) {
        return mesh::isExpensive(model.tape) ? 0 : std::min(options.halvings, mostHalvingsOfCells);
    }

    using Finder = decltype(lower::findMissingParts);
    using Place = HalvingRequest::Place;
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
        // Cells half as large as those that were asked for judge well enough what is off the surface.
        const float cell_m =
            &finder == &lower::findOffSurface ? std::max(grid_.cell_m, askedCell_m_ / 2) : grid_.cell_m;
        auto found = finder(model_.derivation, *model_.lowered, model_.tape, mesh_, cell_m, context_.threads,
                            context_.progress, among);
        findingSeconds_ += finding.seconds();
        return found;
    }

    /// Halves all cells where what some parts lack says that this takes less time, so that all parts are looked at
    /// once.
    Status halveAllBySample() {
        const size_t parts = model_.lowered->shapeOf.size();
        if (!mayHalveAll_ || most_ == 0 || parts < fewestSampled) return Done{};
        std::vector<lower::ThinPart> some;
        for (OriginId part = 1; part < parts; ++part)
            if (pick(part, sampledOf) == 0)
                for (int face = -1; face < 6; ++face) some.push_back({.part = part, .face = face, .places = {}});
        const auto missing = find(lower::findMissingParts, &some);
        if (!missing.ok()) return missing.error();
        RequestsByHalvings asked = cellsAround(*missing, {});
        tried_.clear(), bounded_.clear();
        leaveOutFiner(asked);
        const GrowthByHalvings growth = multiplied(growthBy(asked, mesh_, grid_), sampledOf, mesh_.triangleCount());
        const int halvings = halvingsForAll(growth);
        if (halvings == 0) return Done{};
        const auto isHalved = halveAll(halvings);
        return isHalved.ok() ? Status(Done{}) : isHalved.error();
    }

    /// Halves cells around all that is missing or torn in the mesh as it is, or where that might take too many
    /// triangles around what is missing: few times are to suffice. Returns what was missing.
    Result<std::vector<lower::ThinPart>> holdAtOnce(bool& isRefined) {
        auto missing = find(lower::findMissingParts, nullptr);
        if (!missing.ok() || most_ == 0) return missing;
        const std::map<Place, int> before;
        RequestsByHalvings asked = cellsAround(*missing, before);
        const std::map<Place, int> tried = tried_;
        const std::set<Place> bounded = bounded_;
        std::set<OriginId> asWholes;  // is asked for already
        for (const lower::ThinPart& part : *missing)
            if (part.kind == lower::ThinPart::Kind::Part && !part.isWall()) asWholes.insert(part.part);
        RequestsByHalvings all = asked;
        for (Finder* const finder : {lower::findTornParts, lower::findOffSurface}) {
            auto torn = find(*finder, nullptr);
            if (!torn.ok()) return torn;
            if (finder == lower::findTornParts)  // which returns what is missing too
                std::erase_if(*torn, [&](const lower::ThinPart& part) { return asWholes.contains(part.part); });
            RequestsByHalvings more = cellsAround(*torn, before);
            for (size_t halvings = 1; halvings < all.size(); ++halvings)
                std::move(more[halvings].begin(), more[halvings].end(), std::back_inserter(all[halvings]));
        }
        leaveOutFiner(all);
        const GrowthByHalvings growth = growthBy(all, mesh_, grid_);
        if (const int halvings = halvingsForAll(growth); halvings > 0) {
            const auto isHalved = halveAll(halvings);
            if (!isHalved.ok()) return isHalved.error();
            if (*isHalved) return holdAtOnce(isRefined);
        }
        if (fits(all))
            asked = std::move(all);
        else
            tried_ = tried, bounded_ = bounded;
        if (const Status s = refineByHalvings(std::move(asked), isRefined); !s.ok()) return s.error();
        return missing;
    }

    /// Halves cells while that makes what is found fewer, of all parts or of some. Returns what is left.
    Result<std::vector<lower::ThinPart>> hold(Finder& finder,
                                              std::optional<std::vector<lower::ThinPart>> among = std::nullopt) {
        for (;;) {
            auto found = find(finder, among ? &*among : nullptr);
            if (!found.ok()) return found;
            bool isRefined = false;
            if (const Status s = refineByHalvings(cellsAround(*found, tried_), isRefined); !s.ok()) return s.error();
            if (!isRefined) return found;
            among = std::move(*found);
        }
    }

    /// Whether the mesh may have as many triangles as all requests take, by a guess.
    bool fits(const RequestsByHalvings& asked) const {
        size_t budget = mostTriangles_ - std::min(mostTriangles_, mesh_.triangleCount());
        for (int halvings = 1; halvings <= most_; ++halvings) {
            const std::vector<size_t> growth =
                guessGrowth(asked[static_cast<size_t>(halvings)], mesh_, grid_, halvings, 0);
            const size_t sum = std::accumulate(growth.begin(), growth.end(), size_t{0});
            if (sum > budget) return false;
            budget -= sum;
        }
        return true;
    }

    mesh::Grid halvedGrid(int halvings) const {
        const int parts = 1 << halvings;
        return {grid_.origin, grid_.cell_m / static_cast<float>(parts), grid_.cells * parts};
    }
    /// How often all cells are halved: not so that there are too many along an axis, or too small ones.
    int halvingsForAll(const GrowthByHalvings& growth) const {
        int most = 0;
        while (mayHalveAll_ && most < most_ && mesh::checkGrid(halvedGrid(most + 1)).ok()) ++most;
        return halvingsOfAll(growth, mesh_.triangleCount(), most, options_.halvedTriangles);
    }

    /// Meshes all anew in smaller cells, where these are possible. Returns whether they are.
    Result<bool> halveAll(int halvings) {
        const Stopwatch watch;
        const mesh::Grid grid = moveOffPlanes(halvedGrid(halvings), model_.derivation);
        const auto blocks = mesh::subdivide(model_.tape, grid, context_.threads, context_.progress, counts_);
        auto mesh = blocks.ok() ? mesh::polygonize(*blocks, grid, options_, context_.progress, counts_)
                                : Result<mesh::Mesh>(blocks.error());
        halvingSeconds_ += watch.seconds();
        if (!mesh.ok() && mesh.error().kind == Error::Kind::Cancelled) return mesh.error();
        mayHalveAll_ = mesh.ok();
        if (!mesh.ok()) return false;
        mesh_ = std::move(*mesh), grid_ = grid;
        most_ -= halvings;
        tried_.clear(), bounded_.clear();
        return true;
    }

    /// Those that are halved more often come last, so that they stay where cells of both meet.
    Status refineByHalvings(RequestsByHalvings asked, bool& isRefined) {
        leaveOutFiner(asked);
        for (int halvings = 1; halvings <= most_; ++halvings)
            if (Status s = refine(std::move(asked[static_cast<size_t>(halvings)]), halvings, mostTriangles_, isRefined);
                !s.ok())
                return s;
        return Done{};
    }

    /// Those with fewest cells first, where not all can be looked at.
    RequestsByHalvings cellsAround(const std::vector<lower::ThinPart>& missing,
                                   const std::map<Place, int>& triedBefore) {
        struct Wish {
            const lower::ThinPart* part;
            int halvings;
            double cells;
        };
        std::vector<Wish> wishes, thinner;
        double cellCount = 0;
        for (const lower::ThinPart& part : missing) {
            const auto known = triedBefore.find(placeOf(part));
            const int before = known == triedBefore.end() ? 0 : known->second;
            const int halvings = std::max(before + 1, lower::halvingsFor(part, grid_.cell_m));
            if (before >= most_) continue;
            const Wish wish{&part, std::min(halvings, most_), lower::countCellsAround(part, grid_)};
            (halvings <= most_ ? wishes : thinner).push_back(wish);
            cellCount += wish.cells;
        }
        // Smaller cells hold more of what they don't hold yet; they come last, for a mesh may not grow so far.
        wishes.insert(wishes.end(), thinner.begin(), thinner.end());
        const double most = cellsPerTriangle * static_cast<double>(mostTriangles_);
        if (cellCount > most)
            std::stable_sort(wishes.begin(), wishes.end(),
                             [](const Wish& a, const Wish& b) { return a.cells < b.cells; });
        RequestsByHalvings asked;
        cellCount = 0;
        for (const Wish& wish : wishes) {
            if (cellCount + wish.cells > most) {
                bounded_.insert(placeOf(*wish.part));
                continue;
            }
            cellCount += wish.cells;
            const lower::ThinPart& part = *wish.part;
            mesh::CellSet around;
            lower::addCellsAround(part, grid_, around);
            const int wanted = std::max(wish.halvings, halvingsIn(around));
            int& tried = tried_[placeOf(part)];
            tried = std::max(tried, wanted);
            // Places of walls overlap, for they are found along all axes.
            const double triangles = part.isWall() ? 0 : trianglesOfPart(part, static_cast<double>(grid_.cell_m));
            asked[static_cast<size_t>(wanted)].push_back({placeOf(part), around.list(), triangles});
        }
        return asked;
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

    /// Halves cells so often. Where the mesh would have too many triangles, those of parts that take most of them are
    /// halved less often.
    Status refine(std::vector<HalvingRequest> asked, int halvings, size_t mostTriangles, bool& isRefined) {
        const size_t budget = mostTriangles - std::min(mostTriangles, mesh_.triangleCount());
        const std::vector<size_t> growth = guessGrowth(asked, mesh_, grid_, halvings, budget);
        const size_t sum = std::accumulate(growth.begin(), growth.end(), size_t{0});
        if (sum <= budget) return refineAll(asked, halvings, mostTriangles, isRefined);
        std::vector<size_t> order(asked.size());
        std::iota(order.begin(), order.end(), size_t{0});
        std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return growth[a] < growth[b]; });
        std::vector<HalvingRequest> kept, less;
        size_t growthOfKept = 0;
        for (const size_t i : order) {
            // What is halved less often may take up to half of the triangles that the bound leaves.
            const size_t left = sum - growthOfKept - growth[i], rest = std::min(left / 4, budget / 2);
            const bool isKept = less.empty() && growthOfKept + growth[i] + (halvings > 1 ? rest : 0) <= budget;
            if (isKept) growthOfKept += growth[i];
            if (!isKept) bounded_.insert(asked[i].place);
            (isKept || halvings == 1 ? kept : less).push_back(std::move(asked[i]));
        }
        // Where cells of both meet, those that are halved more often come last and stay.
        if (!less.empty())
            if (const Status s = refine(std::move(less), halvings - 1, mostTriangles - growthOfKept, isRefined);
                !s.ok())
                return s;
        return refineAll(kept, halvings, mostTriangles, isRefined);
    }

    /// Halves cells so often, the first alone where that takes too many triangles when they are halved once. Where they
    /// come to take others with them that were halved more often, and hold there what larger ones don't, all of them
    /// are halved as often as these.
    Status refineAll(std::span<const HalvingRequest> asked, int halvings, size_t mostTriangles, bool& isRefined) {
        const mesh::CellSet cells = cellsOf(asked);
        if (cells.empty()) return Done{};
        const Stopwatch watch;
        const auto bound = [&] {
            for (const HalvingRequest& one : asked) bounded_.insert(one.place);
        };
        for (;;) {
            const size_t most = halvings > 1 ? ~size_t{0} : mostTriangles;
            auto refined = mesh::refineCells(mesh_, model_.tape, grid_, cells, {halvings, most, context_.threads},
                                             context_.progress);
            if (!refined.ok()) return refined.error();
            if (refined->isBounded) bound();
            if (!refined->made) break;
            if (const int finest = halvingsIn(refined->made->cells); finest > halvings) {
                halvings = finest;
                const size_t budget = mostTriangles - std::min(mostTriangles, mesh_.triangleCount());
                const std::vector<size_t> growth = guessGrowth(asked, mesh_, grid_, halvings, budget);
                if (std::accumulate(growth.begin(), growth.end(), size_t{0}) <= budget) continue;
                bound();
                break;
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
    mesh::Grid grid_;
    const float askedCell_m_;
    int most_;  ///< halvings of these cells
    const mesh::PolygonizeOptions& options_;
    bool mayHalveAll_;
    Context& context_;
    mesh::Counts& counts_;
    size_t mostTriangles_;
    std::map<Place, int> tried_;  ///< halvings of the cells there
    std::set<Place> bounded_;     ///< where halving ended at the bound of triangles
    HalvedCells halved_;
    double findingSeconds_ = 0, halvingSeconds_ = 0;
};

}  // namespace

Result<std::vector<lower::ThinPart>> holdThinParts(const Model& model, mesh::Mesh& mesh, const mesh::Grid& grid,
                                                   const mesh::PolygonizeOptions& options, Context& context,
                                                   mesh::Counts& counts) {
    return ThinPartRefiner(model, mesh, grid, options, context, counts).run();
}

}  // namespace sgm::pipeline
