#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "modeler/core/parallel.h"
#include "modeler/core/printable.h"
#include "modeler/plan/geojson_parts.h"
#include "modeler/plan/read_parts.h"

namespace sgm::plan {
namespace {

/// What was read so far; points as the file has them.
struct Reading {
    const ReadLimits& limits;
    const Progress* progress;
    ReadBudget budget;
    Features features{};
    uint64_t number = 0;  ///< of the feature
};

std::optional<Error> readRing(Json written, bool isCourt, Reading& reading, Ring& ring) {
    simdjson::dom::array list;
    if (written.get(list) != simdjson::SUCCESS)
        return damaged("feature", reading.number, "a ring is no list of positions");
    if (auto e = reading.budget.addPoints(list.size())) return e;
    std::vector<Vec2> points;
    points.reserve(list.size());
    for (const Json at : list) {
        const auto position = positionOf(at);
        if (!position)
            return damaged("feature", reading.number,
                           fmt::format("position {} of a ring is not a list of two numbers", points.size() + 1));
        points.push_back(*position);
        if (!std::isfinite(points.back().x) || !std::isfinite(points.back().z))
            return damaged("feature", reading.number,
                           fmt::format("position {} of a ring is not finite", points.size()));
    }
    if (points.size() > 1 && points.front() == points.back()) points.pop_back();
    if (points.size() < 3) return damaged("feature", reading.number, "a ring has fewer than three points");
    ring = ringOf(std::move(points), {0, isCourt ? EdgeSource::Court : EdgeSource::Side});
    return {};
}

std::optional<Error> readPolygon(simdjson::dom::array rings, Reading& reading, Footprint& into) {
    Polygon polygon;
    for (const Json list : rings) {
        Ring ring;
        const bool isCourt = polygon.outer.size() > 0;
        if (auto e = readRing(list, isCourt, reading, ring)) return e;
        if (isCourt)
            polygon.courts.push_back(std::move(ring));
        else
            polygon.outer = std::move(ring);
    }
    if (polygon.outer.size() > 0) into.polygons.push_back(std::move(polygon));
    return {};
}

std::optional<Error> readGeometry(Json geometry, Reading& reading, Footprint& into) {
    if (!geometry.is_object()) return {};
    const std::string_view type = member(geometry, "type");
    if (type == "GeometryCollection") {
        if (const auto list = findList(geometry, "geometries"))
            for (const Json one : *list)
                if (auto e = readGeometry(one, reading, into)) return e;
        return {};
    }
    if (type != "Polygon" && type != "MultiPolygon") return {};
    const auto coordinates = findList(geometry, "coordinates");
    if (!coordinates) return damaged("feature", reading.number, "a polygon has no coordinates");
    if (type == "Polygon") return readPolygon(*coordinates, reading, into);
    for (const Json one : *coordinates) {
        simdjson::dom::array rings;
        if (one.get(rings) != simdjson::SUCCESS)
            return damaged("feature", reading.number, "a polygon is no list of rings");
        if (auto e = readPolygon(rings, reading, into)) return e;
    }
    return {};
}

/// Words for the edges of the first outline.
void readTags(Json properties, Footprint& footprint) {
    const auto tags = findList(properties, "tags");
    if (!tags || footprint.empty()) return;
    Ring& ring = footprint.polygons[0].outer;
    size_t edge = 0;
    for (const Json tag : *tags) {
        if (edge == ring.size()) return;
        if (std::string_view text; tag.get(text) == simdjson::SUCCESS)
            ring.edges[edge].tag = footprint.tag(textOf(text));
        ++edge;
    }
}

/// What a feature says beside its outline.
void readWords(Json object, Feature& feature) {
    const auto properties = find(object, "properties"), id = find(object, "id");
    simdjson::dom::object words;
    if (properties && properties->get(words) == simdjson::SUCCESS) {
        readProperties(words, feature.properties);
        readTags(*properties, feature.footprint);
        feature.name = textOf(member(*properties, "name"));
    }
    std::string_view text;
    int64_t number = 0;
    uint64_t large = 0;
    if (!id) return;
    if (id->get(text) == simdjson::SUCCESS)
        feature.name = textOf(text);
    else if (id->is_int64() && id->get(number) == simdjson::SUCCESS)
        feature.name = std::to_string(number);
    else if (id->is_uint64() && id->get(large) == simdjson::SUCCESS)
        feature.name = std::to_string(large);
}

/// `object` is a feature, or a geometry that stands alone.
std::optional<Error> readFeature(Json object, Reading& reading) {
    ++reading.number;
    Feature feature;
    feature.place = reading.number;
    const bool isFeature = member(object, "type") == "Feature";
    const auto geometry = isFeature ? find(object, "geometry") : object;
    if (!geometry) return damaged("feature", reading.number, "it has no geometry");
    if (auto e = readGeometry(*geometry, reading, feature.footprint)) return e;
    if (feature.footprint.empty()) return {};
    if (auto e = reading.budget.addFeature()) return e;
    if (isFeature) readWords(object, feature);
    reading.features.list.push_back(std::move(feature));
    return {};
}

template <class Fn>
void forEachRing(Features& features, Fn&& fn) {
    for (Feature& feature : features.list)
        for (Polygon& polygon : feature.footprint.polygons) {
            fn(polygon.outer);
            for (Ring& court : polygon.courts) fn(court);
        }
}

/// East and north to x and −z in metres.
Result<Plane> layOnPlane(Features& features, Json root, double farthest_m) {
    Box2 box;
    forEachRing(features, [&](const Ring& ring) {
        for (const Vec2 p : ring.points) box.add(p);
    });
    const Plane plane = planeOf(root, farthest_m);
    if (auto e = tooWideForDegrees(plane, box, farthest_m)) return *e;
    features.fromDegrees = plane.fromDegrees;
    features.east = plane.origin.x, features.north = plane.origin.z;
    forEachRing(features, [&](Ring& ring) {
        for (Vec2& p : ring.points) p = plane.at(p);
    });
    return plane;
}

/// Reads the features of a file by themselves, on all threads.
std::optional<Error> readEach(const std::vector<Json>& objects, Reading& reading) {
    struct One {
        size_t points = 0;
        Features features{};  ///< one at most
        std::optional<Error> error{};
    };
    std::vector<One> all(objects.size());
    constexpr size_t together = 32;
    parallelFor((all.size() + together - 1) / together, 0, reading.progress, [&](size_t chunk, int) {
        for (size_t i = chunk * together; i < std::min((chunk + 1) * together, all.size()); ++i) {
            Reading own{reading.limits, reading.progress, ReadBudget(reading.limits), {}, i};
            all[i].error = readFeature(objects[i], own);
            all[i].points = own.budget.points();
            all[i].features = std::move(own.features);
        }
    });
    if (cancelled(reading.progress)) return cancelledError();
    for (One& one : all) {
        auto error = reading.budget.addPoints(one.points);
        if (!error) error = one.error;
        if (!error && !one.features.list.empty()) error = reading.budget.addFeature();
        if (error) return error;
        for (Feature& feature : one.features.list) reading.features.list.push_back(std::move(feature));
    }
    return {};
}

std::optional<Error> readFeatures(Json root, Reading& reading) {
    const auto list = member(root, "type") == "FeatureCollection" ? findList(root, "features") : std::nullopt;
    return list ? readEach(itemsOf(*list), reading) : readFeature(root, reading);
}

/// Makes outlines sound, on all threads; the first feature's error that can't be.
std::optional<Error> makeSound(Reading& reading, const Plane& plane) {
    std::vector<Feature>& list = reading.features.list;
    std::vector<std::optional<Error>> errors(list.size());
    constexpr size_t together = 32;
    parallelFor((list.size() + together - 1) / together, 0, reading.progress, [&](size_t chunk, int) {
        for (size_t i = chunk * together; i < std::min((chunk + 1) * together, list.size()); ++i) {
            std::optional<Fault> repaired;
            Result<Footprint> sound = soundFootprint(list[i].footprint, reading.limits.footprint, &repaired);
            if (!sound) {
                errors[i] = damaged("feature", list[i].place, sound.error());
                continue;
            }
            if (repaired) list[i].fault = repairText(*repaired, plane.inFile(repaired->at));
            list[i].footprint = *std::move(sound);
        }
    });
    if (cancelled(reading.progress)) return cancelledError();
    const auto first = std::find_if(errors.begin(), errors.end(), [](const auto& e) { return e.has_value(); });
    return first == errors.end() ? std::nullopt : *first;
}

}  // namespace

Result<Features> readGeoJson(std::string_view bytes, const ReadLimits& limits, const Progress* progress) {
    if (bytes.size() > limits.mostBytes) return Error{Error::Kind::Budget, "it is too large"};
    Reading reading{limits, progress, ReadBudget(limits)};
    const Result<JsonFile> file = parseGeoJson(bytes);
    if (!file.ok()) return file.error();
    if (auto e = readFeatures(file->root, reading)) return *e;
    if (reading.features.list.empty())
        return Error{Error::Kind::Input, "it has no polygons; GeoJSON's Polygon and MultiPolygon are read"};
    const auto plane = layOnPlane(reading.features, file->root, limits.footprint.farthest_m);
    if (!plane) return plane.error();
    if (auto e = makeSound(reading, *plane)) return *e;
    return std::move(reading.features);
}

}  // namespace sgm::plan
