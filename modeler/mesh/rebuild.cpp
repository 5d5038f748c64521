#include "modeler/mesh/rebuild.h"

#include <algorithm>
#include <iterator>
#include <mutex>

#include "modeler/core/random.h"
#include "modeler/core/stopwatch.h"
#include "modeler/mesh/chunk.h"
#include "modeler/mesh/region.h"

namespace sgm::mesh {
namespace {

bool sameGrid(const Grid& a, const Grid& b) {
    return a.origin == b.origin && a.cell_m == b.cell_m && a.cells == b.cells;
}

int levelOf(int blocks) {
    int level = 0;
    for (; blocks > 1; blocks /= regionSplits) ++level;
    return level;
}

}  // namespace

size_t Rebuild::RegionHash::operator()(const Region& r) const {
    const auto word = [](int v) { return static_cast<uint64_t>(static_cast<uint32_t>(v)); };
    return mix(word(r.level) << 60 ^ word(r.index.x) << 40 ^ word(r.index.y) << 20 ^ word(r.index.z));
}

void Rebuild::forget() {
    regions_.clear();
    mesh_.chunks.clear();
    tape_ = {};
    numbers_.reset();
    near_ = {};
    grid_ = {};
}

/// Takes over what lies in regions that stayed the same.
void Rebuild::keepBelow(const Regions& before, const Regions& same, Regions& now) {
    int top = 0;
    for (const auto& [region, tape] : before) top = std::max(top, region.level);
    for (const auto& [region, tape] : before)
        for (Region above = region; above.level <= top; ++above.level) {
            if (same.contains(above)) {
                now.emplace(region, tape);
                break;
            }
            above.index = {above.index.x / regionSplits, above.index.y / regionSplits, above.index.z / regionSplits};
        }
}

/// The chunks of the last mesh whose blocks are still there and weren't made anew.
std::vector<Chunk> Rebuild::takeKept(const Regions& now, const std::vector<Block>& made) {
    const auto isMade = [&](Vec3i block) {
        const auto at = std::lower_bound(made.begin(), made.end(), block,
                                         [](const Block& b, Vec3i i) { return zyxLess(b.index, i); });
        return at != made.end() && at->index == block;
    };
    std::vector<Chunk> chunks;
    for (Chunk& c : mesh_.chunks)
        if (now.contains({0, c.block}) && !isMade(c.block)) chunks.push_back(std::move(c));
    return chunks;
}

/// Adds to `same` the regions that no changed part reaches, and to `reached` the boxes of all other blocks. False where
/// ranges tell nothing of some part there.
bool Rebuild::leaveUnreached(const eval::Tape& tape, const Grid& grid, Regions& same, Box3f& reached) {
    const eval::RelevantRange care = relevantRangeFor(tape, grid);
    bool bounded = true;
    scratch_.resize(std::max<size_t>(scratch_.size(), 1));
    std::vector<Vec3i> regions{{0, 0, 0}}, next;
    for (int blocks = blocksOfRoot(grid) / regionSplits; blocks > 0; blocks /= regionSplits) {
        next.clear();
        for (const Vec3i region : regions) {
            const Children children(region, blocks * blockCells, 0, regionSplits, grid);
            if (children.n == 0) continue;
            const auto reach = parts_.reach({children.boxes.data(), children.n}, care, scratch_.front());
            bounded = bounded && reach.bounded;
            for (size_t i = 0; i < children.n; ++i) {
                if (reach.unreached >> i & 1) {
                    same.emplace(Region{levelOf(blocks), children.indices[i]}, eval::Fingerprint{});
                    continue;
                }
                next.push_back(children.indices[i]);
                if (blocks == 1) reached = hull(reached, children.boxes[i]);
            }
        }
        regions.swap(next);
    }
    return bounded;
}

/// The tape in a box that holds `reached`, where no numbers count but those that changed: kept from change to change
/// while a parameter is dragged. Not for a field that is expensive in places: what is cared for would hang on the box.
const eval::Tape& Rebuild::tapeAround(const Box3f& reached, const eval::Tape& tape, const Grid& grid,
                                      const eval::NumbersChanged& changed) {
    const auto& known = near_.places;
    if (near_.box.contains(reached.lo) && near_.box.contains(reached.hi) &&
        std::includes(known.begin(), known.end(), changed.places.begin(), changed.places.end())) {
        eval::TapeBuilder::rebind(near_.tape, tape.sharedConstants(), eval::TapeBuilder::scaleOf(tape));
    } else {
        const Box3f box = reached.inflated(static_cast<float>(blockCells) * grid.cell_m);
        near_ = {box, changed.places, parts_.around(tape, box, relevantRangeFor(tape, grid), scratch_.front())};
    }
    return near_.tape;
}

Result<const Mesh*> Rebuild::run(const eval::Tape& tape, const Grid& grid, Progress* progress, Counts& counts,
                                 const eval::NumbersChanged* changed) {
    Regions now, same;
    std::mutex guard;
    RegionFilter filter;
    const Stopwatch reaching;
    const eval::Tape* from = &tape;
    if (!changed) parts_ = {}, near_ = {};
    if (changed && parts_.find(tape, *changed)) {
        Box3f reached;
        const bool bounded = leaveUnreached(tape, grid, same, reached);
        if (bounded && !reached.empty() && !isExpensive(tape)) from = &tapeAround(reached, tape, grid, *changed);
        filter.skips = [&](std::span<const Vec3i> indices, int blocks) {
            const std::lock_guard lock(guard);
            uint64_t some = 0;
            for (size_t i = 0; i < indices.size(); ++i)
                some |= uint64_t{same.contains({levelOf(blocks), indices[i]})} << i;
            return some;
        };
    }
    counts.subdivideSeconds += reaching.seconds();
    filter.wants = [&](Vec3i index, int blocks, const eval::Tape& shortened) {
        const Region region{levelOf(blocks), index};
        if (from != &tape && blocks > 1) {  // good in part of the region: tells nothing of all of it
            const std::lock_guard lock(guard);
            now.emplace(region, eval::Fingerprint{});
            return true;
        }
        const eval::Fingerprint print = eval::fingerprint(shortened);
        const auto before = regions_.find(region);
        const bool equal = before != regions_.end() && before->second == print;
        const std::lock_guard lock(guard);
        (equal ? same : now).emplace(region, print);
        return !equal;
    };
    const auto blocks = subdivide(*from, grid, options_.threads, progress, counts, filter, &scratch_);
    if (!blocks.ok()) return blocks.error();
    keepBelow(regions_, same, now);

    auto made = meshBlocks(*blocks, grid, options_, progress, counts);
    if (!made.ok()) return made.error();
    std::vector<Chunk> all = takeKept(now, *blocks);
    blocksMade_ = blocks->size();
    blocksKept_ =
        static_cast<size_t>(std::count_if(now.begin(), now.end(), [](const auto& r) { return r.first.level == 0; })) -
        blocksMade_;
    std::move(made->begin(), made->end(), std::back_inserter(all));
    std::sort(all.begin(), all.end(), [](const Chunk& a, const Chunk& b) { return zyxLess(a.block, b.block); });
    mesh_.chunks = std::move(all);
    if (Status status = link(mesh_.chunks, options_.threads); !status) return status.error();
    regions_ = std::move(now);
    return &mesh_;
}

const Mesh* Rebuild::keepAll() {
    blocksKept_ += blocksMade_;
    blocksMade_ = 0;
    return &mesh_;
}

Result<const Mesh*> Rebuild::update(const eval::Tape& tape, const Grid& grid, Progress* progress, Counts& counts,
                                    const eval::NumbersChanged* changed) {
    const eval::RelevantRange care = relevantRangeFor(tape, grid);
    const bool sameTies = options_.surface != Surface::Crisp || tape.tieMargin() == tieMargin_;
    if (!sameGrid(grid, grid_) || !(care == relevant_) || !sameTies) forget();
    if (!changed || !numbers_ || changed->before != numbers_) changed = nullptr;
    const eval::Fingerprint print = changed ? eval::Fingerprint{} : eval::fingerprint(tape);
    if (changed ? changed->places.empty() : print == tape_) return keepAll();
    auto result = run(tape, grid, progress, counts, changed);
    if (!result.ok()) {
        forget();
        return result;
    }
    tape_ = print;
    numbers_ = tape.sharedConstants();
    grid_ = grid;
    relevant_ = care;
    tieMargin_ = tape.tieMargin();
    return result;
}

Grid gridToKeep(const Grid& previous, const Box3f& bounds, float cell_m, float room) {
    const Vec3i last = previous.cells - Vec3i{1, 1, 1};
    const bool fits = previous.cell_m == cell_m && minComponent(last) > 1 && !bounds.empty() &&
                      minComponent(bounds.lo - previous.corner(1, 1, 1)) >= 0 &&
                      minComponent(previous.corner(last.x, last.y, last.z) - bounds.hi) >= 0;
    if (fits || bounds.empty() || !bounds.finite()) return fits ? previous : gridFor(bounds, cell_m);
    return gridFor(bounds.inflated(room * maxComponent(bounds.size())), cell_m);
}

}  // namespace sgm::mesh
