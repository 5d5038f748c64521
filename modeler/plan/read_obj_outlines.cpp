#include <algorithm>
#include <array>
#include <cmath>

#include "modeler/core/printable.h"
#include "modeler/plan/clipper_paths.h"
#include "modeler/plan/read_parts.h"

namespace sgm::plan {
namespace {

/// Faces of a group, as counter-clockwise paths.
struct Group {
    std::string name;
    uint64_t line = 1;
    LatticePaths faces;
};

std::string_view takeWord(std::string_view& line) {
    const size_t begin = std::min(line.find_first_not_of(" \t\r"), line.size());
    const size_t end = std::min(line.find_first_of(" \t\r", begin), line.size());
    const std::string_view word = line.substr(begin, end - begin);
    line.remove_prefix(end);
    return word;
}

/// The vertex that a corner of a face names; nothing where there is none.
std::optional<size_t> vertexOf(std::string_view word, size_t count) {
    std::string_view number = word.substr(0, word.find('/'));
    const auto value = takeNumber(number);
    if (!value || !number.empty() || *value != std::floor(*value)) return {};
    const double at = *value > 0 ? *value - 1 : static_cast<double>(count) + *value;
    if (*value == 0 || at < 0 || at >= static_cast<double>(count)) return {};
    return static_cast<size_t>(at);
}

using Vertices = std::vector<std::array<double, 3>>;

/// A level face's outline; empty for others.
LatticePath levelPath(const Vertices& corners) {
    Box2 box;
    double lo = corners[0][1], hi = lo;
    std::vector<Vec2> points;
    for (const auto& v : corners) {
        box.add({v[0], v[2]});
        lo = std::min(lo, v[1]), hi = std::max(hi, v[1]);
        points.push_back({v[0], v[2]});
    }
    if (hi - lo > 1e-4 * std::max({box.size().x, box.size().z, 1e-2})) return {};
    Ring ring = ringOf(std::move(points));
    if (signedArea(ring) < 0) ring = reversed(ring);
    LatticePath path;
    for (const Vec2 p : ring.points) path.push_back(latticePoint(p));
    return path;
}

}  // namespace

Result<Features> readObjOutlines(std::string_view bytes, const ReadLimits& limits, const Progress* progress) {
    Vertices vertices;
    std::vector<Group> groups(1);
    ReadBudget budget(limits);
    uint64_t number = 0;
    while (!bytes.empty()) {
        if (++number % 4096 == 0 && cancelled(progress)) return cancelledError();
        const size_t end = std::min(bytes.find('\n'), bytes.size());
        std::string_view line = bytes.substr(0, end);
        bytes.remove_prefix(std::min(end + 1, bytes.size()));
        const std::string_view key = takeWord(line);
        if (key == "v") {
            auto& v = vertices.emplace_back();
            for (double& c : v) {
                std::string_view word = takeWord(line);
                const auto value = takeNumber(word);
                if (!value || !word.empty() || std::abs(*value) > limits.footprint.farthest_m)
                    return damaged("line", number, "a vertex needs three numbers within 100 km");
                c = *value;
            }
            if (auto e = budget.addPoints(1)) return *e;
        } else if (key == "o" || key == "g") {
            if (auto e = budget.addFeature()) return *e;
            groups.push_back({shortened(printable(takeWord(line)), 256), number, {}});
        } else if (key == "f") {
            Vertices corners;
            for (std::string_view word; !(word = takeWord(line)).empty();) {
                const auto at = vertexOf(word, vertices.size());
                if (!at) return damaged("line", number, "a face has a corner that is no vertex");
                corners.push_back(vertices[*at]);
            }
            if (corners.size() < 3) return damaged("line", number, "a face has fewer than three corners");
            if (auto e = budget.addPoints(corners.size())) return *e;
            if (LatticePath path = levelPath(corners); !path.empty()) groups.back().faces.push_back(std::move(path));
        }
    }
    Features features;
    for (const Group& group : groups) {
        if (group.faces.empty()) continue;
        if (cancelled(progress)) return cancelledError();
        Footprint joined = tidied(booleanOf(PathBoolean::Union, group.faces, {}));
        Result<Footprint> sound = soundFootprint(joined, limits.footprint);
        if (!sound) return damaged("line", group.line, sound.error());
        features.list.push_back({group.name, *std::move(sound), {}, group.line});
    }
    if (features.list.empty())
        return Error{Error::Kind::Input, "it has no level faces; outlines are faces of one height"};
    return features;
}

}  // namespace sgm::plan
