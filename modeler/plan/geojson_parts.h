// What the readers of GeoJSON share. For this folder's sources alone.
// Enters: bytes that somebody else made. Leaves: JSON of bounded depth, properties, places in metres. Assumes nothing.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "modeler/core/result.h"
#include "modeler/plan/read.h"

namespace sgm::plan {

inline constexpr size_t longestText = 4096;  ///< of a property, bytes

/// The file as JSON. Error::Input with the line, or where lists nest too deep.
Result<nlohmann::json> parseGeoJson(std::string_view bytes);

/// A file whose features can be read one by one, from any thread.
struct SplitFile {
    std::string rest;                        ///< the file with one number in place of its features
    std::vector<std::string_view> features;  ///< each by itself, in the file's order
};
/// Splits the list "features" of a file's outermost object. Nothing where there is no such list, or more than one, or
/// where the text can't be JSON: then the file is read as a whole, which says what is wrong with it. What is left and
/// all features are JSON where, and only where, the file is. O(bytes), of which it reads each once.
std::optional<SplitFile> splitFeatures(std::string_view bytes);

/// A text without what can't be printed, shortened.
std::string textOf(const nlohmann::json& value);
/// A member that is a text, or "".
std::string_view member(const nlohmann::json& object, const char* name);
/// Texts, numbers and truth values among the members, 256 at most.
void readProperties(const nlohmann::json& object, std::vector<Property>& into);

/// How a file's coordinates lie on the plan: x east, z south.
struct Plane {
    bool fromDegrees = false;
    Vec2 origin, scale{1, 1};
    Vec2 at(Vec2 p) const { return {(p.x - origin.x) * scale.x, -(p.z - origin.z) * scale.z}; }
    /// As the file has it.
    Vec2 inFile(Vec2 p) const { return {p.x / scale.x + origin.x, origin.z - p.z / scale.z}; }
};
/// Whether the file says that its coordinates are on a plane (a member from before RFC 7946).
bool namesPlane(const nlohmann::json& root);
/// Degrees about their middle where all points may be such and `isPlane` doesn't say otherwise; else metres, about the
/// middle where they are large.
Plane planeOf(const Box2& box, bool isPlane, double farthest_m);
/// Error::Input where coordinates were taken for degrees and reach farther than that from their middle: they are hardly
/// degrees.
std::optional<Error> tooWideForDegrees(const Plane& plane, const Box2& box, double farthest_m);

}  // namespace sgm::plan
