#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "modeler/core/conventions.h"
#include "modeler/core/printable.h"
#include "modeler/plan/read_parts.h"

namespace sgm::plan {
namespace {

using Json = nlohmann::json;

constexpr int deepest = 64;
constexpr size_t longestText = 4096, mostProperties = 256;

/// An error where lists and objects nest too deep: found before anything is built.
std::optional<Error> tooDeep(std::string_view bytes) {
    int depth = 0;
    bool inText = false;
    for (size_t i = 0; i < bytes.size(); ++i) {
        const char c = bytes[i];
        if (inText) {
            if (c == '\\')
                ++i;
            else if (c == '"')
                inText = false;
        } else if (c == '"') {
            inText = true;
        } else if (c == '[' || c == '{') {
            if (++depth > deepest)
                return Error{Error::Kind::Input, fmt::format("lists nest deeper than {} at byte {}", deepest, i + 1)};
        } else if (c == ']' || c == '}') {
            --depth;
        }
    }
    return {};
}

std::string textOf(const Json& value) { return shortened(printable(value.get_ref<const std::string&>()), longestText); }

/// A member that is a text, or "".
std::string_view member(const Json& object, const char* name) {
    if (!object.is_object()) return {};
    const auto at = object.find(name);
    return at != object.end() && at->is_string() ? std::string_view(at->get_ref<const std::string&>())
                                                 : std::string_view{};
}

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

void readProperties(const Json& object, Feature& feature) {
    for (const auto& [name, value] : object.items()) {
        if (feature.properties.size() >= mostProperties) return;
        Property property{shortened(printable(name), longestText), 0.0};
        if (value.is_string())
            property.value = textOf(value);
        else if (value.is_boolean())
            property.value = value.get<bool>() ? "true" : "false";
        else if (value.is_number() && std::isfinite(value.get<double>()))
            property.value = value.get<double>();
        else
            continue;
        feature.properties.push_back(std::move(property));
    }
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
            readProperties(*properties, feature);
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

/// Whether the file says that its coordinates are on a plane (a member from before RFC 7946).
bool namesPlane(const Json& root) {
    const auto crs = root.is_object() ? root.find("crs") : root.end();
    if (crs == root.end() || !crs->is_object() || !crs->contains("properties")) return false;
    const std::string_view name = member((*crs)["properties"], "name");
    return !name.empty() && name.find("CRS84") == name.npos && name.find("4326") == name.npos;
}

/// East and north to x and −z in metres.
void layOnPlane(Features& features, bool isPlane, double farthest_m) {
    Box2 box;
    forEachRing(features, [&](const Ring& ring) {
        for (const Vec2 p : ring.points) box.add(p);
    });
    const Vec2 middle = box.centre();
    features.fromDegrees = !isPlane && box.lo.x >= -180 && box.hi.x <= 180 && box.lo.z >= -90 && box.hi.z <= 90;
    Vec2 scale{1, 1}, origin;
    if (features.fromDegrees) {  // metres of a degree on the WGS84 ellipsoid, by its series
        const double at = radians(middle.z);
        scale.x = 111412.84 * std::cos(at) - 93.5 * std::cos(3 * at) + 0.118 * std::cos(5 * at);
        scale.z = 111132.92 - 559.82 * std::cos(2 * at) + 1.175 * std::cos(4 * at);
        origin = middle;
    } else if (std::max({std::abs(box.lo.x), std::abs(box.hi.x), std::abs(box.lo.z), std::abs(box.hi.z)}) >
               farthest_m) {
        origin = {std::round(middle.x), std::round(middle.z)};
    }
    features.east = origin.x, features.north = origin.z;
    forEachRing(features, [&](Ring& ring) {
        for (Vec2& p : ring.points) p = {(p.x - origin.x) * scale.x, -(p.z - origin.z) * scale.z};
    });
}

}  // namespace

Result<Features> readGeoJson(std::string_view bytes, const ReadLimits& limits, const Progress* progress) {
    if (bytes.size() > limits.mostBytes) return Error{Error::Kind::Input, "it is too large"};
    if (const auto e = tooDeep(bytes)) return *e;
    Json root;
    try {
        root = Json::parse(bytes);
    } catch (const Json::parse_error& e) {
        const auto line =
            1 + std::count(bytes.begin(), bytes.begin() + static_cast<ptrdiff_t>(std::min(e.byte, bytes.size())), '\n');
        return damaged("line", static_cast<uint64_t>(line), "this is no JSON");
    } catch (const Json::out_of_range&) {
        return Error{Error::Kind::Input, "a number is too large"};
    }
    Reading reading{limits, progress, ReadBudget(limits)};
    const auto list = root.is_object() ? root.find("features") : root.end();
    if (member(root, "type") == "FeatureCollection" && list != root.end() && list->is_array()) {
        for (const Json& object : *list) {
            if (cancelled(progress)) return cancelledError();
            if (auto e = readFeature(object, reading)) return *e;
        }
    } else if (auto e = readFeature(root, reading)) {
        return *e;
    }
    if (reading.features.list.empty())
        return Error{Error::Kind::Input, "it has no polygons; GeoJSON's Polygon and MultiPolygon are read"};
    layOnPlane(reading.features, namesPlane(root), limits.footprint.farthest_m);
    for (Feature& feature : reading.features.list) {
        if (cancelled(progress)) return cancelledError();
        Result<Footprint> sound = soundFootprint(feature.footprint, limits.footprint);
        if (!sound) return damaged("feature", feature.place, sound.error().message);
        feature.footprint = *std::move(sound);
    }
    return std::move(reading.features);
}

}  // namespace sgm::plan
