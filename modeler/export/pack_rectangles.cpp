#include "modeler/export/pack_rectangles.h"

#include <algorithm>

// Stable, so that places are the same with every library.
#define STBRP_SORT(rectangles, count, size, compare) \
    std::stable_sort(rectangles, rectangles + count, [](const auto& a, const auto& b) { return compare(&a, &b) < 0; })
#define STBRP_STATIC
#define STB_RECT_PACK_IMPLEMENTATION
#include <stb/stb_rect_pack.h>

namespace sgm::exporter {

bool packRectangles(std::vector<Rectangle>& rectangles, int side) {
    std::vector<stbrp_node> nodes(static_cast<size_t>(side));
    stbrp_context context;
    stbrp_init_target(&context, side, side, nodes.data(), side);
    std::vector<stbrp_rect> all;
    for (const Rectangle& r : rectangles) all.push_back({static_cast<int>(all.size()), r.width, r.height, 0, 0, 0});
    if (!stbrp_pack_rects(&context, all.data(), static_cast<int>(all.size()))) return false;
    for (size_t i = 0; i < all.size(); ++i) rectangles[i].x = all[i].x, rectangles[i].y = all[i].y;
    return true;
}

}  // namespace sgm::exporter
