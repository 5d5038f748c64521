#include "modeler/export/lightmap.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "modeler/export/islands.h"
#include "modeler/export/pack_rectangles.h"

namespace sgm::exporter {
namespace {

constexpr int margin = 1;  ///< texels around each island

/// Sizes of the islands' rectangles, metres; the longer side lies along u.
struct Lying {
    float width, height;
    bool turned;
};

Lying lying(const Island& island) {
    const float width = island.hi[0] - island.lo[0], height = island.hi[1] - island.lo[1];
    return width < height ? Lying{height, width, true} : Lying{width, height, false};
}

int texelsOf(float metres, double texelsPerMetre) {
    return static_cast<int>(std::ceil(static_cast<double>(metres) * texelsPerMetre)) + 2 * margin;
}

/// The islands of one object as rectangles at some scale; none where they take more room than there is.
std::vector<Rectangle> rectanglesOf(const std::vector<Lying>& islands, double texelsPerMetre, int texels) {
    std::vector<Rectangle> rectangles;
    rectangles.reserve(islands.size());
    int64_t room = int64_t{texels} * texels;
    for (const Lying& l : islands) {
        const Rectangle r{texelsOf(l.width, texelsPerMetre), texelsOf(l.height, texelsPerMetre), 0, 0};
        room -= int64_t{r.width} * r.height;
        if (room < 0) return {};
        rectangles.push_back(r);
    }
    return rectangles;
}

/// About the greatest scale, texels a metre, at which all have room, and their places there; 0 where none has, or where
/// the progress is cancelled.
double packAll(const std::vector<Lying>& islands, int texels, Progress* progress, std::vector<Rectangle>& places) {
    double area = 0, longest = 0;
    for (const Lying& l : islands) {
        area += static_cast<double>(l.width) * static_cast<double>(l.height);
        longest = std::max(longest, static_cast<double>(l.width));
    }
    const double most =
        std::min(texels / std::sqrt(std::max(area, 1e-12)), (texels - 2 * margin) / std::max(longest, 1e-6));
    constexpr double step = 0.97;
    constexpr int steps = 300;  // down to a ten-thousandth
    int good = steps, bad = -1;
    while (good - bad > 1 && !cancelled(progress)) {
        const int middle = (good + bad) / 2;
        std::vector<Rectangle> tried = rectanglesOf(islands, most * std::pow(step, middle), texels);
        if (!tried.empty() && packRectangles(tried, texels))
            good = middle, places = std::move(tried);
        else
            bad = middle;
    }
    return good == steps ? 0 : most * std::pow(step, good);
}

std::vector<uint32_t> objectsOf(const mesh::Mesh& mesh, const ObjectTree* tree) {
    std::vector<uint32_t> objects;
    if (!tree) return objects;
    objects.reserve(mesh.triangleCount());
    for (const mesh::Chunk& chunk : mesh.chunks)
        for (const OriginId origin : chunk.origins) objects.push_back(tree->nodeOf(origin));
    return objects;
}

}  // namespace

Result<LightMap> LightMap::make(const mesh::Mesh& mesh, const ObjectTree* objects, int texels, Progress* progress,
                                TextureCharts& charts) {
    const Islands islands = findIslands(mesh, charts, objectsOf(mesh, objects), progress);
    if (cancelled(progress)) return cancelledError();
    std::vector<std::vector<uint32_t>> ofObject(objects ? objects->nodes.size() : 1);
    for (uint32_t i = 0; i < islands.all.size(); ++i) ofObject[islands.all[i].object].push_back(i);
    LightMap map;
    map.places_.resize(islands.all.size());
    for (const std::vector<uint32_t>& own : ofObject) {
        if (own.empty()) continue;
        std::vector<Lying> sizes;
        for (const uint32_t i : own) sizes.push_back(lying(islands.all[i]));
        std::vector<Rectangle> places;
        const double scale = packAll(sizes, texels, progress, places);
        if (cancelled(progress)) return cancelledError();
        if (scale == 0)
            return Error{Error::Kind::Input,
                         fmt::format("a light map of {} texels a side has no room for {} islands: take a larger one, "
                                     "or more objects",
                                     texels, own.size())};
        for (size_t k = 0; k < own.size(); ++k) {
            const Island& island = islands.all[own[k]];
            const ChartAxes& axes = charts.axes[island.chart];
            Place& place = map.places_[own[k]];
            // Turned by a quarter to the left: what was up lies to the left, so its least is where its greatest was.
            place.axes = sizes[k].turned ? ChartAxes{-axes.v, axes.u} : axes;
            const float u = sizes[k].turned ? -island.hi[1] : island.lo[0];
            const float v = sizes[k].turned ? island.lo[0] : island.lo[1];
            place.scale = static_cast<float>(scale / texels);
            place.u = static_cast<float>(places[k].x + margin) / static_cast<float>(texels) - u * place.scale;
            place.v = static_cast<float>(places[k].y + margin) / static_cast<float>(texels) - v * place.scale;
        }
    }
    std::vector<ChartAxes> axes;
    for (const Island& island : islands.all) axes.push_back(charts.axes[island.chart]);
    charts = {std::move(axes), islands.ofTriangle};
    return map;
}

std::array<float, 2> LightMap::at(uint32_t island, Vec3f p) const {
    const Place& place = places_[island];
    return {place.u + place.scale * dot(p, place.axes.u), place.v + place.scale * dot(p, place.axes.v)};
}

}  // namespace sgm::exporter
