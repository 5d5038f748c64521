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

using Json = nlohmann::json;

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

/// Goes through the brackets, commas and texts of a file, and notes where its features begin and end.
class Splitter {
public:
    explicit Splitter(std::string_view bytes) : bytes_(bytes) {}

    std::optional<SplitFile> run() {
        for (; at_ < bytes_.size(); ++at_) {
            const char c = bytes_[at_];
            if (c == '"')
                skipText();
            else if (c == '[' || c == '{')
                open(c);
            else if (c == ']' || c == '}')
                close();
            else if (c == ',' && depth_ == 2 && isInFeatures_)
                endFeature();
        }
        if (lists_ != 1 || isInFeatures_ || depth_ != 0 || isTooDeep_) return {};
        const std::string_view before = bytes_.substr(0, begin_), after = bytes_.substr(end_);
        return SplitFile{fmt::format("{}0{}", before, after), std::move(features_)};
    }

private:
    void skipText() {
        const size_t from = ++at_;
        while (at_ < bytes_.size() && bytes_[at_] != '"') at_ += bytes_[at_] == '\\' ? 2 : 1;
        if (depth_ == 1 && at_ < bytes_.size()) latest_ = bytes_.substr(from, at_ - from), afterLatest_ = at_ + 1;
    }
    void open(char c) {
        if (++depth_ > deepestList) isTooDeep_ = true;
        if (depth_ != 2 || c != '[' || latest_ != "features") return;
        const std::string_view between = bytes_.substr(afterLatest_, at_ - afterLatest_);
        if (between.find(':') == between.npos || between.find_first_not_of(" \t\r\n:") != between.npos) return;
        isInFeatures_ = true;
        ++lists_;
        begin_ = feature_ = at_ + 1;
    }
    void close() {
        if (--depth_ != 1 || !isInFeatures_) return;
        endFeature();
        isInFeatures_ = false;
        end_ = at_;
    }
    void endFeature() {
        features_.push_back(bytes_.substr(feature_, at_ - feature_));
        feature_ = at_ + 1;
    }

    const std::string_view bytes_;
    size_t at_ = 0;
    int depth_ = 0, lists_ = 0;
    bool isInFeatures_ = false, isTooDeep_ = false;
    std::string_view latest_;  ///< text of the outermost object
    size_t afterLatest_ = 0, begin_ = 0, end_ = 0, feature_ = 0;
    std::vector<std::string_view> features_;
};

}  // namespace

std::optional<SplitFile> splitFeatures(std::string_view bytes) { return Splitter(bytes).run(); }

std::string textOf(const Json& value) { return shortened(printable(value.get_ref<const std::string&>()), longestText); }

std::string_view member(const Json& object, const char* name) {
    if (!object.is_object()) return {};
    const auto at = object.find(name);
    return at != object.end() && at->is_string() ? std::string_view(at->get_ref<const std::string&>())
                                                 : std::string_view{};
}

Result<Json> parseGeoJson(std::string_view bytes) {
    if (const auto e = tooDeep(bytes)) return *e;
    try {
        return Json::parse(bytes);
    } catch (const Json::parse_error& e) {
        const auto line =
            1 + std::count(bytes.begin(), bytes.begin() + static_cast<ptrdiff_t>(std::min(e.byte, bytes.size())), '\n');
        return damaged("line", static_cast<uint64_t>(line), "this is no JSON");
    } catch (const Json::out_of_range&) {
        return Error{Error::Kind::Input, "a number is too large"};
    }
}

void readProperties(const Json& object, std::vector<Property>& into) {
    for (const auto& [name, value] : object.items()) {
        if (into.size() >= mostProperties) return;
        Property property{shortened(printable(name), longestText), 0.0};
        if (value.is_string())
            property.value = textOf(value);
        else if (value.is_boolean())
            property.value = value.get<bool>() ? "true" : "false";
        else if (value.is_number() && std::isfinite(value.get<double>()))
            property.value = value.get<double>();
        else
            continue;
        into.push_back(std::move(property));
    }
}

bool namesPlane(const Json& root) {
    const auto crs = root.is_object() ? root.find("crs") : root.end();
    if (crs == root.end() || !crs->is_object() || !crs->contains("properties")) return false;
    const std::string_view name = member((*crs)["properties"], "name");
    return !name.empty() && name.find("CRS84") == name.npos && name.find("4326") == name.npos;
}

Plane planeOf(const Box2& box, bool isPlane, double farthest_m) {
    Plane plane;
    const Vec2 middle = box.centre();
    plane.fromDegrees = !isPlane && box.lo.x >= -180 && box.hi.x <= 180 && box.lo.z >= -90 && box.hi.z <= 90;
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
