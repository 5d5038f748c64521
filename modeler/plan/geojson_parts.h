// What the readers of GeoJSON share. For this folder's sources alone.
// Enters: bytes that somebody else made. Leaves: JSON of bounded depth, properties, places in metres. Assumes nothing.
#pragma once

#include <simdjson.h>

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "modeler/core/result.h"
#include "modeler/plan/read.h"

namespace sgm::plan {

inline constexpr size_t longestText = 4096;  ///< of a property, bytes

using Json = simdjson::dom::element;

/// A file as JSON. Any number of threads may read it.
struct JsonFile {
    std::unique_ptr<simdjson::dom::parser> parser;  ///< holds what `root` is of
    Json root;
};
/// Error::Input with the line, or where lists nest too deep. O(bytes).
Result<JsonFile> parseGeoJson(std::string_view bytes);

/// The member of an object, the last one where several have that name; nothing where it has none or is no object.
std::optional<Json> find(Json object, std::string_view name);
/// The same of one that is a list.
std::optional<simdjson::dom::array> findList(Json object, std::string_view name);
/// The same of one that is a text, or "".
std::string_view member(Json object, std::string_view name);
/// The items of a list, by number.
std::vector<Json> itemsOf(simdjson::dom::array list);
/// The first two numbers of a position; nothing where it is no list of two.
std::optional<Vec2> positionOf(Json at);
/// A text without what can't be printed, shortened.
std::string textOf(std::string_view text);
/// Texts, numbers and truth values among the members, in the order of their names, 256 at most.
void readProperties(simdjson::dom::object object, std::vector<Property>& into);

/// How a file's coordinates lie on the plan: x east, z south.
struct Plane {
    bool fromDegrees = false;
    Vec2 origin, scale{1, 1};
    Vec2 at(Vec2 p) const { return {(p.x - origin.x) * scale.x, -(p.z - origin.z) * scale.z}; }
    /// As the file has it.
    Vec2 inFile(Vec2 p) const { return {p.x / scale.x + origin.x, origin.z - p.z / scale.z}; }
};
/// Degrees about their middle where all may be such and the file names no other system ("crs", from before RFC 7946);
/// else metres, about the middle where they are farther than that from the origin. The middle is that of all lines and
/// polygons of the file, so that those of one file fit together, whichever are read. O(points).
Plane planeOf(Json root, double farthest_m);
/// Error::Input where coordinates were taken for degrees and reach farther than that from their middle: they are hardly
/// degrees.
std::optional<Error> tooWideForDegrees(const Plane& plane, const Box2& box, double farthest_m);

}  // namespace sgm::plan
