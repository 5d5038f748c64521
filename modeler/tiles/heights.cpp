#include "modeler/tiles/heights.h"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "modeler/core/atomic_file.h"
#include "modeler/tiles/read_back.h"
#include "modeler/tiles/tileset.h"

namespace sgm::tiles {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr float noGround = -std::numeric_limits<float>::infinity();

/// Samples over a square, row by row from the least z on.
class Heights {
public:
    Heights(Vec3d corner, double pitch_m, int samples)
        : corner_(corner), pitch_(pitch_m), samples_(samples), all_(size_t(samples) * size_t(samples), noGround) {}

    /// Takes the triangles of a cell that lie over samples.
    void take(const std::vector<SurfacePiece>& pieces, Vec3d centre) {
        const Vec3d move = centre - corner_;
        for (const SurfacePiece& piece : pieces)
            for (size_t t = 0; t + 2 < piece.indices.size(); t += 3)
                take(at(piece, t, move), at(piece, t + 1, move), at(piece, t + 2, move));
    }
    const std::vector<float>& all() const { return all_; }

private:
    static Vec3d at(const SurfacePiece& piece, size_t corner, Vec3d move) {
        return piece.positions[piece.indices[corner]].as<double>() + move;
    }

    void take(Vec3d a, Vec3d b, Vec3d c) {
        const double area = (b.x - a.x) * (c.z - a.z) - (c.x - a.x) * (b.z - a.z);
        if (std::abs(area) < 1e-12) return;  // upright
        const auto first = [&](double v) { return std::max(0, static_cast<int>(std::ceil(v / pitch_ - 1e-6))); };
        const auto last = [&](double v) {
            return std::min(samples_ - 1, static_cast<int>(std::floor(v / pitch_ + 1e-6)));
        };
        const double slack = -1e-9;
        for (int j = first(std::min({a.z, b.z, c.z})); j <= last(std::max({a.z, b.z, c.z})); ++j)
            for (int i = first(std::min({a.x, b.x, c.x})); i <= last(std::max({a.x, b.x, c.x})); ++i) {
                const double x = i * pitch_, z = j * pitch_;
                const double v = ((x - a.x) * (c.z - a.z) - (c.x - a.x) * (z - a.z)) / area;
                const double w = ((b.x - a.x) * (z - a.z) - (x - a.x) * (b.z - a.z)) / area;
                if (v < slack || w < slack || v + w > 1 - slack) continue;
                float& held = all_[size_t(j) * size_t(samples_) + size_t(i)];
                held = std::max(held, static_cast<float>(a.y + v * (b.y - a.y) + w * (c.y - a.y)));
            }
    }

    const Vec3d corner_;
    const double pitch_;
    const int samples_;
    std::vector<float> all_;
};

/// How heights become numbers of 16 bits: one scale for all files.
struct Scale {
    double lowest_m = 0, step_m = 1;
    uint16_t of(float height) const {
        if (height == noGround) return 0;
        return static_cast<uint16_t>(
            std::clamp(std::round((static_cast<double>(height) - lowest_m) / step_m), 0.0, 65535.0));
    }
};

Status writeRaw(const fs::path& path, const std::vector<uint16_t>& samples) {
    static_assert(std::endian::native == std::endian::little);
    return writeFile(path, {reinterpret_cast<const char*>(samples.data()), 2 * samples.size()});
}

Status writeGrey16(const fs::path& path, int side, const std::vector<uint16_t>& samples) {
    return replaceFile(path, [&](const fs::path& temporary) -> Status {
        png_image png{};
        png.version = PNG_IMAGE_VERSION;
        png.width = png.height = static_cast<png_uint_32>(side);
        png.format = PNG_FORMAT_LINEAR_Y;
        if (!png_image_write_to_file(&png, temporary.c_str(), 0, samples.data(), 0, nullptr))
            return writeError(path, png.message);
        return Done{};
    });
}

/// The lowest and the highest place of the ground of all finest cells, by what their files say of it.
Result<std::pair<double, double>> groundHeights(const fs::path& folder, const BakePlan& plan,
                                                const Progress* progress) {
    double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
    for (const Cell& cell : plan.cells) {
        if (cancelled(progress)) return cancelledError();
        std::error_code ignored;
        const fs::path file = contentFile(folder, cell);
        if (cell.level != 0 || !fs::exists(file, ignored)) continue;
        const auto bounds = groundBounds(file);
        if (!bounds.ok()) return bounds.error();
        if (!*bounds) continue;
        lowest = std::min(lowest, (*bounds)->lo.y), highest = std::max(highest, (*bounds)->hi.y);
    }
    if (lowest > highest)
        return Error{Error::Kind::Input,
                     fmt::format("the cells of '{}' have no ground: there is no height", folder.string())};
    return std::pair(lowest, highest);
}

/// All heights of the ground of a square, from its cells and those around it, which share its border.
Result<Heights> sampled(const fs::path& folder, const BakePlan& plan, const Cell& square, Library& library,
                        const Progress* progress) {
    const double side = square.side_m(plan.side_m);
    Heights heights(square.centre(plan.side_m) - Vec3d{side / 2, 0, side / 2}, plan.cell_m,
                    static_cast<int>(std::lround(side / plan.cell_m)) + 1);
    const int across = 1 << square.level;
    for (int z = -1; z <= across; ++z)
        for (int x = -1; x <= across; ++x) {
            if (cancelled(progress)) return cancelledError();
            const Cell cell{0, square.x * across + x, square.z * across + z};
            std::error_code ignored;
            if (!fs::exists(contentFile(folder, cell), ignored)) continue;
            const auto read = readCell(contentFile(folder, cell), library);
            if (!read.ok()) return read.error();
            heights.take(read->content.ground, cell.centre(plan.side_m));
        }
    return heights;
}

}  // namespace

Status writeHeights(const fs::path& folder, Progress* progress) {
    const auto plan = readPlan(folder);
    if (!plan.ok()) return plan.error();
    for (const Cell& cell : plan->cells)
        if (!isDone(folder, cell))
            return Error{Error::Kind::Input,
                         fmt::format("'{}' isn't there yet: bake the cells that `sgm bake --missing` names",
                                     noteFile(folder, cell).string())};
    const auto bounds = groundHeights(folder, *plan, progress);
    if (!bounds.ok()) return bounds.error();
    // Step 0 is no ground, so the lowest one lies at step 1.
    const double step = std::max((bounds->second - bounds->first) / 65533, 1e-4);
    const Scale scale{bounds->first - step, step};
    std::error_code failed;
    fs::create_directories(folder / "heights", failed);
    if (failed) return writeError(folder / "heights", failed.message());
    const int top = static_cast<int>(plan->errors_m.size()) - 1;
    Library library;
    Json files = Json::array();
    if (progress)
        progress->begin("write",
                        static_cast<uint64_t>(std::count_if(plan->cells.begin(), plan->cells.end(),
                                                            [top](const Cell& cell) { return cell.level == top; })));
    for (const Cell& square : plan->cells) {
        if (square.level != top) continue;
        tick(progress);
        const auto heights = sampled(folder, *plan, square, library, progress);
        if (!heights.ok()) return heights.error();
        std::vector<uint16_t> samples;
        for (const float h : heights->all()) samples.push_back(scale.of(h));
        if (std::all_of(samples.begin(), samples.end(), [](uint16_t v) { return v == 0; })) continue;
        const auto count = static_cast<int>(std::lround(std::sqrt(double(samples.size()))));
        const std::string name = fmt::format("{}_{}", square.x, square.z);
        if (const Status s = writeRaw(folder / "heights" / (name + ".r16"), samples); !s.ok()) return s;
        if (const Status s = writeGrey16(folder / "heights" / (name + ".png"), count, samples); !s.ok()) return s;
        const double side = square.side_m(plan->side_m);
        files.push_back({{"name", name}, {"samples", count}, {"x_m", square.x * side}, {"z_m", square.z * side}});
    }
    const Json facts{{"metres_a_sample", plan->cell_m},
                     {"metres_a_step", scale.step_m},
                     {"height_of_0_m", scale.lowest_m},
                     {"files", std::move(files)}};
    return writeJson(folder / "heights" / "heights.json", facts);
}

}  // namespace sgm::tiles
