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
#include "grammar/pipeline/triangles_of_cells.h"
#include "modeler/mesh/refine.h"
#include "modeler/mesh/region.h"

namespace sgm::pipeline {
namespace {

constexpr size_t mostGrowth = 4;         ///< of triangles
constexpr size_t tornDivisor = 4;        ///< of that bound, for how much more what is torn may use
constexpr double cellsPerTriangle = 16;  ///< at most looked at, of the triangles that the mesh may have
constexpr int mostHalvingsOfCells = 3;
constexpr double leastMissingEaves = 0.5;  ///< share of eaves that the mesh is said to lack

/// Cells that are halved, by how often.
using HalvedCells = std::array<mesh::CellSet, mostHalvingsOfCells + 1>;

class ThinPartRefiner {
public:
    ThinPartRefiner(const Model& model, mesh::Mesh& mesh, const mesh::Grid& grid,
                    const mesh::PolygonizeOptions& options, Context& context)
        : model_(model),
          mesh_(mesh),
          grid_(grid),
          most_(mesh::isExpensive(model.tape) ? 0 : std::min(options.halvings, mostHalvingsOfCells)),
          context_(context),
          leastBound_(options.halvedTriangles),
          mostTriangles_(std::max(mostGrowth * mesh.triangleCount(), leastBound_)) {}

    /// Cells around what the mesh lacks are meshed anew, and again with smaller ones while some of it is still missing:
    /// within its scope a part may be thinner. What isn't missing stays so, for smaller cells have the larger ones'
    /// corners. What the mesh has, but torn, comes last: it may use what is left of the triangles.
    Result<std::vector<lower::ThinPart>> run() {
        auto missing = hold(lower::findMissingParts);
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
            part.halvings = most_, part.mostTriangles = leastBound_, part.isBounded = isBounded(part);
        context_.stages.emplace_back("thin parts", findingSeconds_);
        if (halvingSeconds_ > 0) context_.stages.emplace_back("halve cells", halvingSeconds_);
        return missing;
    }

private:
    using Finder = decltype(lower::findMissingParts);
    /// Around a part, at its eaves, or beside a face.
    using Place = std::tuple<OriginId, bool, int>;
    /// What is to be halved for a part.
    struct Request {
        Place place;
        std::vector<Vec3i> cells;
        double wholeTriangles;  ///< of the part in cells that aren't halved; 0 of walls
    };
    /// By how often cells are to be halved.
    using RequestsByHalvings = std::array<std::vector<Request>, mostHalvingsOfCells + 1>;
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
            RequestsByHalvings asked = cellsAround(*found);
            bool isRefined = false;
            for (int halvings = 1; halvings <= most_; ++halvings)
                if (const Status s =
                        refine(std::move(asked[static_cast<size_t>(halvings)]), halvings, mostTriangles_, isRefined);
                    !s.ok())
                    return s.error();
            if (!isRefined) return found;
            before = std::move(*found);
        }
    }

    /// Those with fewest cells first, where not all can be looked at.
    RequestsByHalvings cellsAround(const std::vector<lower::ThinPart>& missing) {
        struct Wish {
            const lower::ThinPart* part;
            int halvings;
            double cells;
        };
        std::vector<Wish> wishes, thinner;
        double cellCount = 0;
        for (const lower::ThinPart& part : missing) {
            const int before = tried_[placeOf(part)];
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
            int& tried = tried_[placeOf(part)];
            tried = std::max(wish.halvings, halvingsIn(around));
            // Places of walls overlap, for they are found along all axes.
            const double triangles = part.isWall() ? 0 : trianglesOfPart(part, static_cast<double>(grid_.cell_m));
            asked[static_cast<size_t>(tried)].push_back({placeOf(part), around.list(), triangles});
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

    static mesh::CellSet allOf(std::span<const Request> asked) {
        mesh::CellSet all;
        for (const Request& one : asked)
            for (const Vec3i cell : one.cells) all.insert(cell);
        return all;
    }

    /// About how many triangles more the mesh has where each part's cells are halved that often, without those of parts
    /// before it. Nothing where all stay within the bound at any rate.
    std::vector<size_t> guessGrowth(std::span<const Request> asked, int halvings, size_t room) const {
        const mesh::CellSet all = allOf(asked);
        const size_t after = trianglesOfHalved(halvings);
        if (all.size() * after <= room) return {};
        std::vector<size_t> growth(asked.size());
        const std::vector<uint32_t> counts = countTriangles(mesh_, grid_, all);
        size_t next = 0;  // of all cells, which come in the order of the parts
        for (size_t i = 0; i < asked.size(); ++i)
            for (const Vec3i cell : asked[i].cells) {
                if (next == all.size() || all.list()[next] != cell) continue;
                if (counts[next++] > 0) growth[i] += after;
            }
        // Where the mesh shows nothing of a part, its size tells how many there will be.
        for (size_t i = 0; i < asked.size(); ++i)
            growth[i] = std::max(growth[i], static_cast<size_t>(std::ldexp(asked[i].wholeTriangles, 2 * halvings)));
        return growth;
    }

    /// Halves cells so often. Where the mesh would have too many triangles, those of parts that take most of them are
    /// halved less often.
    Status refine(std::vector<Request> asked, int halvings, size_t mostTriangles, bool& isRefined) {
        const size_t room = mostTriangles - std::min(mostTriangles, mesh_.triangleCount());
        const std::vector<size_t> growth = guessGrowth(asked, halvings, room);
        const size_t sum = std::accumulate(growth.begin(), growth.end(), size_t{0});
        if (sum <= room) return refineAll(asked, halvings, mostTriangles, isRefined);
        std::vector<size_t> order(asked.size());
        std::iota(order.begin(), order.end(), size_t{0});
        std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return growth[a] < growth[b]; });
        std::vector<Request> kept, less;
        size_t growthOfKept = 0;
        for (const size_t i : order) {
            // What is halved less often may take up to half of the triangles that the bound leaves.
            const size_t left = sum - growthOfKept - growth[i], rest = std::min(left / 4, room / 2);
            const bool isKept = less.empty() && growthOfKept + growth[i] + (halvings > 1 ? rest : 0) <= room;
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
    Status refineAll(std::span<const Request> asked, int halvings, size_t mostTriangles, bool& isRefined) {
        const mesh::CellSet cells = allOf(asked);
        if (cells.empty()) return Done{};
        const Stopwatch watch;
        const auto bound = [&] {
            for (const Request& one : asked) bounded_.insert(one.place);
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
                const size_t room = mostTriangles - std::min(mostTriangles, mesh_.triangleCount());
                const std::vector<size_t> growth = guessGrowth(asked, halvings, room);
                if (std::accumulate(growth.begin(), growth.end(), size_t{0}) <= room) continue;
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
    const mesh::Grid& grid_;
    const int most_;
    Context& context_;
    const size_t leastBound_;
    size_t mostTriangles_;
    std::map<Place, int> tried_;  ///< halvings of the cells there
    std::set<Place> bounded_;     ///< where halving ended at the bound of triangles
    HalvedCells halved_;
    double findingSeconds_ = 0, halvingSeconds_ = 0;
};

}  // namespace

Result<std::vector<lower::ThinPart>> holdThinParts(const Model& model, mesh::Mesh& mesh, const mesh::Grid& grid,
                                                   const mesh::PolygonizeOptions& options, Context& context) {
    return ThinPartRefiner(model, mesh, grid, options, context).run();
}

}  // namespace sgm::pipeline
