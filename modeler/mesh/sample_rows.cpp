#include "modeler/mesh/sample_rows.h"

namespace sgm::mesh {
namespace {

/// For the seven bricks that come before a brick in its block, by their offset's bits: which numbers they have, as a
/// mask; none where the block ends.
using LowerBricks = std::array<uint64_t, 8>;

std::array<LowerBricks, bricksPerBlock> lowerBricks() {
    std::array<LowerBricks, bricksPerBlock> all{};
    for (int b = 0; b < bricksPerBlock; ++b)
        for (int offset = 1; offset < 8; ++offset) {
            const Vec3i other = brickAt(b) - Vec3i{offset & 1, offset >> 1 & 1, offset >> 2};
            if (minComponent(other) >= 0) all[b][offset] = 1ull << brickNumber(other);
        }
    return all;
}

}  // namespace

uint8_t sampledBelow(uint64_t bricks, int brick) {
    static const auto lower = lowerBricks();
    constexpr uint8_t within[] = {0, 0xaa, 0xcc, 0x88, 0xf0, 0xa0, 0xc0, 0x80};  // sides that have those of an offset
    uint8_t result = 0;
    for (int offset = 1; offset < 8; ++offset) result |= bricks & lower[brick][offset] ? within[offset] : uint8_t{0};
    return result;
}

void SampleRows::list(Vec3i corners, uint8_t below, int along) {
    count = points = 0;
    for (int k = 0; k < corners.z; ++k)
        for (int j = 0; j < corners.y; ++j) {
            const int low = (j == 0 ? 2 : 0) | (k == 0 ? 4 : 0);
            if (below >> low & 1) continue;
            const int skip = below >> (low | 1) & 1, n = corners.x - skip;
            rows[count++] = {static_cast<uint16_t>(skip + along * (j + along * k)), static_cast<uint8_t>(skip),
                             static_cast<uint8_t>(j), static_cast<uint8_t>(k), static_cast<uint8_t>(n)};
            points += static_cast<size_t>(n);
        }
}

}  // namespace sgm::mesh
