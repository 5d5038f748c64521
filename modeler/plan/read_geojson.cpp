#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "modeler/core/parallel.h"
#include "modeler/core/printable.h"
#include "modeler/plan/geojson_parts.h"
#include "modeler/plan/read_parts.h"

namespace sgm::plan {
namespace {

using Json = nlohmann::json;

/// What was read so far; points as the file has them.
struct Reading {
    const ReadLimits& limits;
    const Progress* progress;
    ReadBudget budget;
    Features features{};
    uint64_t number = 0;  ///< of the feature
};

std::optional<Error> readRing(const Json& list, bool isCourt, Reading& reading, Ring& ring) {
    if (!list.is_array()) return damaged("feature", reading.number, "a ring is no list of positions");
    if (auto e = reading.budget.addPoints(list.size())) return e;
    std::vector<Vec2> points;
    points.reserve(list.size());
    for (const Json& at : list) {
        if (!at.is_array() || at.size() < 2 || !at[0].is_number() || !at[1].is_number())
            return damaged("feature", reading.number,
                           fmt::format("position {} of a ring is not a list of two numbers", points.size() + 1));
        points.push_back({at[0].get<double>(), at[1].get<double>()});
        if (!std::isfinite(points.back().x) || !std::isfinite(points.back().z))
            return damaged("feature", reading.number,
                           fmt::format("position {} of a ring is not finite", points.size()));
    }
    if (points.size() > 1 && points.front() == points.back()) points.pop_back();
    if (points.size() < 3) return damaged("feature", reading.number, "a ring has fewer than three points");
    ring = ringOf(std::move(points), {0, isCourt ? EdgeSource::Court : EdgeSource::Side});
    return {};
}

std::optional<Error> readPolygon(const Json& rings, Reading& reading, Footprint& into) {
    if (!rings.is_array()) return damaged("feature", reading.number, "a polygon is no list of rings");
    Polygon polygon;
    for (const Json& list : rings) {
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

std::optional<Error> readGeometry(const Json& geometry, Reading& reading, Footprint& into) {
    if (!geometry.is_object()) return {};
    const std::string_view type = member(geometry, "type");
    const auto coordinates = geometry.find("coordinates");
    if (type == "GeometryCollection") {
        const auto list = geometry.find("geometries");
        if (list != geometry.end() && list->is_array())
            for (const Json& one : *list)
                if (auto e = readGeometry(one, reading, into)) return e;
        return {};
    }
    if (type != "Polygon" && type != "MultiPolygon") return {};
    if (coordinates == geometry.end() || !coordinates->is_array())
        return damaged("feature", reading.number, "a polygon has no coordinates");
    if (type == "Polygon") return readPolygon(*coordinates, reading, into);
    for (const Json& one : *coordinates)
        if (auto e = readPolygon(one, reading, into)) return e;
    return {};
}

/// Words for the edges of the first outline.
void readTags(const Json& properties, Footprint& footprint) {
    const auto tags = properties.find("tags");
    if (tags == properties.end() || !tags->is_array() || footprint.empty()) return;
    Ring& ring = footprint.polygons[0].outer;
    for (size_t i = 0; i < std::min(tags->size(), ring.size()); ++i)
        if ((*tags)[i].is_string()) ring.edges[i].tag = footprint.tag(textOf((*tags)[i]));
}

/// `object` is a feature, or a geometry that stands alone.
std::optional<Error> readFeature(const Json& object, Reading& reading) {
    ++reading.number;
    Feature feature;
    feature.place = reading.number;
    const bool isFeature = member(object, "type") == "Feature";
    const auto geometry = isFeature ? object.find("geometry") : object.end();
    if (isFeature && geometry == object.end()) return damaged("feature", reading.number, "it has no geometry");
    if (auto e = readGeometry(isFeature ? *geometry : object, reading, feature.footprint)) return e;
    if (feature.footprint.empty()) return {};
    if (auto e = reading.budget.addFeature()) return e;
    if (isFeature) {
        const auto properties = object.find("properties");
        if (properties != object.end() && properties->is_object()) {
            readProperties(*properties, feature.properties);
            readTags(*properties, feature.footprint);
            feature.name = shortened(printable(member(*properties, "name")), longestText);
        }
        const auto id = object.find("id");
        if (id != object.end() && id->is_string())
            feature.name = textOf(*id);
        else if (id != object.end() && id->is_number_integer())
            feature.name = id->dump();
    }
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
Result<Plane> layOnPlane(Features& features, bool isPlane, double farthest_m) {
    Box2 box;
    forEachRing(features, [&](const Ring& ring) {
        for (const Vec2 p : ring.points) box.add(p);
    });
    const Plane plane = planeOf(box, isPlane, farthest_m);
    if (auto e = tooWideForDegrees(plane, box, farthest_m)) return *e;
    features.fromDegrees = plane.fromDegrees;
    features.east = plane.origin.x, features.north = plane.origin.z;
    forEachRing(features, [&](Ring& ring) {
        for (Vec2& p : ring.points) p = plane.at(p);
    });
    return plane;
}

/// Reads the features of a file by themselves, on all threads. False where one of them, or what is left of the file, is
/// no JSON: then nothing was read.
bool readSplit(const SplitFile& file, Reading& reading, std::optional<Error>& error) {
    struct One {
        bool isJson = false;
        size_t points = 0;
        Features features{};  ///< one at most
        std::optional<Error> error{};
    };
    std::vector<One> all(file.features.size());
    constexpr size_t together = 32;
    const auto read = [&](size_t i) {
        Reading own{reading.limits, reading.progress, ReadBudget(reading.limits), {}, i};
        const Json object = Json::parse(file.features[i], nullptr, false);
        all[i].isJson = !object.is_discarded();
        if (all[i].isJson) all[i].error = readFeature(object, own);
        all[i].points = own.budget.points();
        all[i].features = std::move(own.features);
    };
    parallelFor((all.size() + together - 1) / together, 0, reading.progress, [&](size_t chunk, int) {
        for (size_t i = chunk * together; i < std::min((chunk + 1) * together, all.size()); ++i) read(i);
    });
    if (cancelled(reading.progress)) return error = cancelledError(), true;
    if (!std::all_of(all.begin(), all.end(), [](const One& one) { return one.isJson; })) return false;
    for (One& one : all) {
        error = reading.budget.addPoints(one.points);
        if (!error) error = one.error;
        if (!error && !one.features.list.empty()) error = reading.budget.addFeature();
        if (error) return true;
        for (Feature& feature : one.features.list) reading.features.list.push_back(std::move(feature));
    }
    return true;
}

/// Reads a file feature by feature where that can be, else as a whole. Gives what is left of it beside its features.
Result<Json> readFeatures(std::string_view bytes, Reading& reading) {
    if (const auto split = splitFeatures(bytes)) {
        Json rest = Json::parse(split->rest, nullptr, false);
        const bool isSplit = rest.is_object() && member(rest, "type") == "FeatureCollection" &&
                             rest["features"].is_array() && rest["features"].size() == 1;
        std::optional<Error> error;
        if (isSplit && readSplit(*split, reading, error)) return error ? Result<Json>(*error) : std::move(rest);
    }
    Result<Json> parsed = parseGeoJson(bytes);
    if (!parsed.ok()) return parsed.error();
    const Json& root = *parsed;
    const auto list = root.is_object() ? root.find("features") : root.end();
    if (member(root, "type") == "FeatureCollection" && list != root.end() && list->is_array()) {
        for (const Json& object : *list) {
            if (cancelled(reading.progress)) return cancelledError();
            if (auto e = readFeature(object, reading)) return *e;
        }
    } else if (auto e = readFeature(root, reading)) {
        return *e;
    }
    return parsed;
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
    const Result<Json> rest = readFeatures(bytes, reading);
    if (!rest.ok()) return rest.error();
    if (reading.features.list.empty())
        return Error{Error::Kind::Input, "it has no polygons; GeoJSON's Polygon and MultiPolygon are read"};
    const auto plane = layOnPlane(reading.features, namesPlane(*rest), limits.footprint.farthest_m);
    if (!plane) return plane.error();
    if (auto e = makeSound(reading, *plane)) return *e;
    return std::move(reading.features);
}

}  // namespace sgm::plan
