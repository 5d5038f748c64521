#include "modeler/plan/geojson_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "modeler/core/conventions.h"
#include "modeler/core/printable.h"
#include "modeler/plan/read_parts.h"

namespace sgm::plan {

namespace {

constexpr int deepestList = 64;
constexpr size_t mostProperties = 256;

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
            if (++depth > deepestList)
                return Error{Error::Kind::Input,
                             fmt::format("lists nest deeper than {} at byte {}", deepestList, i + 1)};
        } else if (c == ']' || c == '}') {
            --depth;
        }
    }
    return {};
}

bool parse(std::string_view bytes, JsonFile& file) {
    file.parser = std::make_unique<simdjson::dom::parser>();
    // Its depth counts one more than the lists, and not a list of nothing.
    return file.parser->allocate(bytes.size(), deepestList + 1) == simdjson::SUCCESS &&
           file.parser->parse(bytes.data(), bytes.size()).get(file.root) == simdjson::SUCCESS;
}

}  // namespace

Result<JsonFile> parseGeoJson(std::string_view bytes) {
    JsonFile file;
    if (parse(bytes, file)) return file;
    // simdjson tells no place, and reads neither a mark of byte order nor whole numbers of more than 64 bits.
    if (const auto e = tooDeep(bytes)) return *e;
    try {
        if (parse(nlohmann::json::parse(bytes).dump(), file)) return file;
        return Error{Error::Kind::Input, "this is no JSON"};
    } catch (const nlohmann::json::parse_error& e) {
        const auto line =
            1 + std::count(bytes.begin(), bytes.begin() + static_cast<ptrdiff_t>(std::min(e.byte, bytes.size())), '\n');
        return damaged("line", static_cast<uint64_t>(line), "this is no JSON");
    } catch (const nlohmann::json::out_of_range&) {
        return Error{Error::Kind::Input, "a number is too large"};
    }
}

std::optional<Json> find(Json object, std::string_view name) {
    simdjson::dom::object members;
    std::optional<Json> found;
    if (object.get(members) != simdjson::SUCCESS) return found;
    for (const auto [key, value] : members)
        if (key == name) found = value;
    return found;
}

std::optional<simdjson::dom::array> findList(Json object, std::string_view name) {
    const auto found = find(object, name);
    simdjson::dom::array list;
    return found && found->get(list) == simdjson::SUCCESS ? std::optional(list) : std::nullopt;
}

std::string_view member(Json object, std::string_view name) {
    const auto found = find(object, name);
    std::string_view text;
    return found && found->get(text) == simdjson::SUCCESS ? text : std::string_view{};
}

std::vector<Json> itemsOf(simdjson::dom::array list) {
    std::vector<Json> items;
    items.reserve(list.size());
    for (const Json item : list) items.push_back(item);
    return items;
}

std::optional<Vec2> positionOf(Json at) {
    simdjson::dom::array list;
    if (at.get(list) != simdjson::SUCCESS) return {};
    double numbers[2];
    size_t count = 0;
    for (const Json one : list) {
        if (one.get(numbers[count]) != simdjson::SUCCESS) return {};
        if (++count == 2) return Vec2{numbers[0], numbers[1]};
    }
    return {};
}

std::string textOf(std::string_view text) { return shortened(printable(text), longestText); }

void readProperties(simdjson::dom::object object, std::vector<Property>& into) {
    std::vector<std::pair<std::string_view, Json>> members;
    for (const auto [name, value] : object) members.emplace_back(name, value);
    std::stable_sort(members.begin(), members.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    for (size_t i = 0; i < members.size() && into.size() < mostProperties; ++i) {
        const auto& [name, value] = members[i];
        if (i + 1 < members.size() && members[i + 1].first == name) continue;  // the last of that name counts
        Property property{textOf(name), 0.0};
        std::string_view text;
        double number = 0;
        bool isTrue = false;
        if (value.get(text) == simdjson::SUCCESS)
            property.value = textOf(text);
        else if (value.get(isTrue) == simdjson::SUCCESS)
            property.value = isTrue ? "true" : "false";
        else if (value.get(number) == simdjson::SUCCESS && std::isfinite(number))
            property.value = number;
        else
            continue;
        into.push_back(std::move(property));
    }
}

namespace {

/// Adds the positions of a geometry's coordinates, at any depth of lists.
void addPositions(Json coordinates, Box2& box) {
    if (const auto position = positionOf(coordinates)) return box.add(*position);
    simdjson::dom::array list;
    if (coordinates.get(list) == simdjson::SUCCESS)
        for (const Json one : list) addPositions(one, box);
}

/// Adds the lines and polygons of a collection, a feature or a geometry.
void addShapes(Json object, Box2& box) {
    for (const char* list : {"features", "geometries"})
        if (const auto items = findList(object, list))
            for (const Json one : *items) addShapes(one, box);
    if (const auto geometry = find(object, "geometry")) addShapes(*geometry, box);
    const std::string_view type = member(object, "type");
    if (!type.ends_with("LineString") && !type.ends_with("Polygon")) return;
    if (const auto coordinates = find(object, "coordinates")) addPositions(*coordinates, box);
}

bool namesPlane(Json root) {
    const auto crs = find(root, "crs");
    const auto properties = crs ? find(*crs, "properties") : std::nullopt;
    const std::string_view name = properties ? member(*properties, "name") : "";
    return !name.empty() && name.find("CRS84") == name.npos && name.find("4326") == name.npos;
}

}  // namespace

Plane planeOf(Json root, double farthest_m) {
    Plane plane;
    Box2 box;
    addShapes(root, box);
    if (box.empty()) return plane;
    const Vec2 middle = box.centre();
    plane.fromDegrees = !namesPlane(root) && box.lo.x >= -180 && box.hi.x <= 180 && box.lo.z >= -90 && box.hi.z <= 90;
    if (plane.fromDegrees) {  // metres of a degree on the WGS84 ellipsoid, by its series
        const double at = radians(middle.z);
        plane.scale.x = 111412.84 * std::cos(at) - 93.5 * std::cos(3 * at) + 0.118 * std::cos(5 * at);
        plane.scale.z = 111132.92 - 559.82 * std::cos(2 * at) + 1.175 * std::cos(4 * at);
        plane.origin = middle;
    } else if (std::max({std::abs(box.lo.x), std::abs(box.hi.x), std::abs(box.lo.z), std::abs(box.hi.z)}) >
               farthest_m) {
        plane.origin = {std::round(middle.x), std::round(middle.z)};
    }
    return plane;
}

std::optional<Error> tooWideForDegrees(const Plane& plane, const Box2& box, double farthest_m) {
    const Vec2 lo = plane.at(box.lo), hi = plane.at(box.hi);
    const double reach_m = std::max({std::abs(lo.x), std::abs(lo.z), std::abs(hi.x), std::abs(hi.z)});
    if (!plane.fromDegrees || reach_m <= farthest_m) return {};
    return Error{
        Error::Kind::Input,
        fmt::format(
            "all its coordinates lie within 180 and 90, so they count as degrees of longitude and latitude, "
            "and reach {:.0f} km from their middle, where {:.0f} are the most; where they are metres, write "
            "\"crs\": {{\"type\": \"name\", \"properties\": {{\"name\": \"metres\"}}}} beside the file's \"type\"",
            reach_m / 1000, farthest_m / 1000)};
}

}  // namespace sgm::plan
