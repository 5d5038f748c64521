#include <fmt/format.h>

#include <cmath>

#include "modeler/plan/geojson_parts.h"
#include "modeler/plan/read_parts.h"

namespace sgm::plan {
namespace {

/// What was read so far; points as the file has them.
struct Reading {
    ReadBudget budget;
    Lines lines{};
    uint64_t number = 0;  ///< of the feature
};

std::optional<Error> readLine(simdjson::dom::array list, Reading& reading, std::vector<Vec2>& line) {
    if (auto e = reading.budget.addPoints(list.size())) return e;
    for (const Json at : list) {
        const auto position = positionOf(at);
        if (!position)
            return damaged("feature", reading.number,
                           fmt::format("position {} of a line is not a list of two numbers", line.size() + 1));
        line.push_back(*position);
        if (!std::isfinite(line.back().x) || !std::isfinite(line.back().z))
            return damaged("feature", reading.number, fmt::format("position {} of a line is not finite", line.size()));
    }
    if (line.size() < 2) return damaged("feature", reading.number, "a line has fewer than two points");
    return {};
}

std::optional<Error> readGeometry(Json geometry, Reading& reading, LineFeature& into) {
    if (!geometry.is_object()) return {};
    const std::string_view type = member(geometry, "type");
    if (type == "GeometryCollection") {
        if (const auto list = findList(geometry, "geometries"))
            for (const Json one : *list)
                if (auto e = readGeometry(one, reading, into)) return e;
        return {};
    }
    if (type != "LineString" && type != "MultiLineString") return {};
    const auto coordinates = findList(geometry, "coordinates");
    if (!coordinates) return damaged("feature", reading.number, "a line has no coordinates");
    if (type == "LineString") return readLine(*coordinates, reading, into.lines.emplace_back());
    for (const Json one : *coordinates) {
        simdjson::dom::array list;
        if (one.get(list) != simdjson::SUCCESS)
            return damaged("feature", reading.number, "a line is no list of positions");
        if (auto e = readLine(list, reading, into.lines.emplace_back())) return e;
    }
    return {};
}

std::optional<Error> readFeature(Json object, Reading& reading) {
    ++reading.number;
    LineFeature feature;
    feature.place = reading.number;
    const bool isFeature = member(object, "type") == "Feature";
    const auto geometry = isFeature ? find(object, "geometry") : object;
    if (!geometry) return damaged("feature", reading.number, "it has no geometry");
    if (auto e = readGeometry(*geometry, reading, feature)) return e;
    if (feature.lines.empty()) return {};
    if (auto e = reading.budget.addFeature()) return e;
    const auto properties = isFeature ? find(object, "properties") : std::nullopt;
    simdjson::dom::object words;
    if (properties && properties->get(words) == simdjson::SUCCESS) readProperties(words, feature.properties);
    reading.lines.list.push_back(std::move(feature));
    return {};
}

}  // namespace

Result<Lines> readGeoJsonLines(std::string_view bytes, const ReadLimits& limits, const Progress* progress) {
    if (bytes.size() > limits.mostBytes) return Error{Error::Kind::Budget, "it is too large"};
    const Result<JsonFile> file = parseGeoJson(bytes);
    if (!file.ok()) return file.error();
    Reading reading{ReadBudget(limits)};
    const bool isCollection = member(file->root, "type") == "FeatureCollection";
    if (const auto list = isCollection ? findList(file->root, "features") : std::nullopt) {
        for (const Json object : *list) {
            if (cancelled(progress)) return cancelledError();
            if (auto e = readFeature(object, reading)) return *e;
        }
    } else if (auto e = readFeature(file->root, reading)) {
        return *e;
    }
    if (reading.lines.list.empty())
        return Error{Error::Kind::Input, "it has no lines; GeoJSON's LineString and MultiLineString are read"};
    const Plane plane = planeOf(file->root, limits.footprint.farthest_m);
    reading.lines.fromDegrees = plane.fromDegrees;
    for (LineFeature& feature : reading.lines.list)
        for (auto& line : feature.lines)
            for (Vec2& p : line) p = plane.at(p);
    return std::move(reading.lines);
}

}  // namespace sgm::plan
