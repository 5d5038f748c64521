#include "modeler/mesh/wrong_meetings.h"

#include <algorithm>
#include <mutex>

#include "modeler/core/parallel.h"
#include "modeler/mesh/box_finder.h"
#include "modeler/mesh/exact_meeting.h"

namespace sgm::mesh {
namespace {

constexpr size_t trianglesPerStep = 1 << 12;  ///< of a parallel loop

}  // namespace

std::vector<std::array<uint32_t, 2>> findWrongMeetings(std::span<const Vec3f> positions,
                                                       std::span<const Triangle> triangles,
                                                       std::span<const uint32_t> changed, int threads,
                                                       const Progress* progress) {
    std::vector<std::array<uint32_t, 2>> pairs;
    if (changed.empty()) return pairs;
    std::vector<Box3f> boxes;
    std::vector<bool> isChanged(triangles.size());
    for (const uint32_t t : changed) {
        boxes.push_back(boxOf(positions, triangles[t]));
        isChanged[t] = true;
    }
    const BoxFinder finder(boxes);
    std::mutex mutex;
    const size_t steps = (triangles.size() + trianglesPerStep - 1) / trianglesPerStep;
    parallelFor(steps, threads, progress, [&](size_t step, int) {
        std::vector<std::array<uint32_t, 2>> found;
        const size_t begin = step * trianglesPerStep, end = std::min(triangles.size(), begin + trianglesPerStep);
        const auto compare = [&](size_t t, std::span<const uint32_t> beside) {
            for (const uint32_t b : beside) {
                const uint32_t other = changed[b];
                if (isChanged[t] && other <= t) continue;  // compared from the other one's side, or the same
                if (meetWrongly(positions, triangles[t], triangles[other]))
                    found.push_back({static_cast<uint32_t>(t), other});
            }
        };
        finder.visitMeeting(
            positions, begin, end, [&](size_t t) { return triangles[t]; }, compare);
        if (found.empty()) return;
        const std::lock_guard lock(mutex);
        pairs.insert(pairs.end(), found.begin(), found.end());
    });
    return pairs;
}

}  // namespace sgm::mesh
