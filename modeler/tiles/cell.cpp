#include "modeler/tiles/cell.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

namespace sgm::tiles {
namespace {

/// The bits of a number, every second one.
uint64_t spread(uint32_t v) {
    uint64_t bits = v;
    bits = (bits | bits << 16) & 0x0000ffff0000ffffull;
    bits = (bits | bits << 8) & 0x00ff00ff00ff00ffull;
    bits = (bits | bits << 4) & 0x0f0f0f0f0f0f0f0full;
    bits = (bits | bits << 2) & 0x3333333333333333ull;
    return (bits | bits << 1) & 0x5555555555555555ull;
}

/// Takes a number from the front of the text.
bool takeNumber(std::string_view& text, int& out) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
    if (error != std::errc{}) return false;
    text.remove_prefix(static_cast<size_t>(end - text.data()));
    return true;
}

bool takeSign(std::string_view& text, char sign) {
    if (text.empty() || text.front() != sign) return false;
    text.remove_prefix(1);
    return true;
}

}  // namespace

Vec3d Cell::centre(double finest_m) const {
    const double side = side_m(finest_m);
    return {(x + .5) * side, 0, (z + .5) * side};
}

std::string Cell::name() const { return fmt::format("{}/{}_{}", level, x, z); }

uint64_t Cell::morton() const {
    const auto unsignedOf = [](int v) { return static_cast<uint32_t>(v) ^ 0x80000000u; };
    return spread(unsignedOf(x)) | spread(unsignedOf(z)) << 1;
}

Cell cellAt(double x_m, double z_m, double finest_m) {
    return {0, static_cast<int>(std::floor(x_m / finest_m)), static_cast<int>(std::floor(z_m / finest_m))};
}

std::optional<Cell> cellNamed(std::string_view name) {
    Cell cell;
    const bool good = takeNumber(name, cell.level) && takeSign(name, '/') && takeNumber(name, cell.x) &&
                      takeSign(name, '_') && takeNumber(name, cell.z) && name.empty();
    return good && cell.level >= 0 && cell.level < 31 ? std::optional(cell) : std::nullopt;
}

std::vector<Cell> pyramidOver(std::vector<Cell> finest, int levels) {
    std::vector<Cell> all;
    std::set<Cell> level(finest.begin(), finest.end());
    for (int i = 0; i < levels; ++i) {
        std::vector<Cell> ordered(level.begin(), level.end());
        std::sort(ordered.begin(), ordered.end(), [](const Cell& a, const Cell& b) { return a.morton() < b.morton(); });
        all.insert(all.end(), ordered.begin(), ordered.end());
        std::set<Cell> next;
        for (const Cell& cell : level) next.insert(cell.parent());
        level = std::move(next);
    }
    return all;
}

std::pair<size_t, size_t> Share::range(size_t count) const {
    const auto at = [&](int i) { return count * static_cast<size_t>(i) / static_cast<size_t>(of); };
    return {at(task - 1), at(task)};
}

int Share::taskOf(size_t index, size_t count, int of) {
    // The least task whose range ends behind the index.
    return static_cast<int>(((index + 1) * static_cast<size_t>(of) + count - 1) / count);
}

std::optional<Share> parseShare(std::string_view text) {
    Share share;
    const bool good = takeNumber(text, share.task) && takeSign(text, '/') && takeNumber(text, share.of) && text.empty();
    return good && share.of >= 1 && share.of <= 1'000'000 && share.task >= 1 && share.task <= share.of
               ? std::optional(share)
               : std::nullopt;
}

std::string arrayNotation(const std::vector<int>& numbers) {
    std::string text;
    for (size_t i = 0; i < numbers.size();) {
        size_t end = i + 1;
        while (end < numbers.size() && numbers[end] == numbers[end - 1] + 1) ++end;
        if (!text.empty()) text += ',';
        text += end - i > 1 ? fmt::format("{}-{}", numbers[i], numbers[end - 1]) : fmt::format("{}", numbers[i]);
        i = end;
    }
    return text;
}

}  // namespace sgm::tiles
