// Outlines from GeoJSON, SVG and OBJ files.
// Enters: bytes that somebody else wrote. Leaves: features with footprints and properties, or Error::Input that names
// the line or the feature. Assumes nothing: sizes, nesting and counts are bounded. Numbers are read the same in every
// locale.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "modeler/core/progress.h"
#include "modeler/core/result.h"
#include "modeler/plan/validate.h"

namespace sgm::plan {

/// What is read at most.
struct ReadLimits {
    uint64_t mostBytes = 64ull << 20;
    size_t mostFeatures = 1'000'000;
    size_t mostPoints = 20'000'000;  ///< of all features together
    Limits footprint;                ///< of each
};

/// A feature's word: a name and a text or a number.
struct Property {
    std::string name;
    std::variant<std::string, double> value;
};

/// One outline of a file.
struct Feature {
    std::string name;  ///< its id, name, or the OBJ group; "" without one
    Footprint footprint;
    std::vector<Property> properties;
    uint64_t place = 0;  ///< number of the feature from 1 (GeoJSON), or line (SVG, OBJ)
    std::string
        fault{};  ///< what was wrong with the outline and made another one of it, with a place; "" where nothing
    /// The property called `word`, or null.
    const std::variant<std::string, double>* find(std::string_view word) const;
};

/// The features of a file, in metres.
struct Features {
    std::vector<Feature> list;
    bool fromDegrees = false;    ///< coordinates were longitude and latitude
    double east = 0, north = 0;  ///< of x = z = 0: degrees where they were, else metres
};

/// Lines of a file's feature.
struct LineFeature {
    std::vector<std::vector<Vec2>> lines;
    std::vector<Property> properties;
    uint64_t place = 0;  ///< number of the feature from 1
};
/// The lines of a file, in metres.
struct Lines {
    std::vector<LineFeature> list;
    bool fromDegrees = false;  ///< coordinates were longitude and latitude
};

/// By the name's ending: .geojson and .json, .svg, .obj. The error names the file.
Result<Features> readOutlines(const std::filesystem::path& path, const ReadLimits& limits = {},
                              const Progress* progress = nullptr);

// Outlines that cross or touch themselves are resolved; other faults are errors with the feature's or line's number and
// the edge. Files without outlines are errors too.

/// RFC 7946 polygons and multipolygons, alone or in features and collections; other geometries are passed over. Degrees
/// are laid on a plane about the middle of all lines and polygons (true to length there, .1 % off 10 km away), other
/// coordinates are taken as metres, about that middle where they are large. x is east, z is south. Properties that are
/// texts, numbers or truth values are kept; a list "tags" tags the edges of the first outline in the file's order.
Result<Features> readGeoJson(std::string_view bytes, const ReadLimits& limits = {}, const Progress* progress = nullptr);
/// RFC 7946 lines, alone or in features and collections, by the same rules; other geometries are passed over.
Result<Lines> readGeoJsonLines(std::string_view bytes, const ReadLimits& limits = {},
                               const Progress* progress = nullptr);
/// path, polygon and rect, with the transforms of their groups; each one feature. A path's rings inside others are
/// courts by turns (even-odd). A curve becomes 8 chords. User units are metres; x is right, z is down. The property
/// "class" is kept.
Result<Features> readSvg(std::string_view bytes, const ReadLimits& limits = {}, const Progress* progress = nullptr);
/// Level faces, one feature a group (`o`, `g`), joined; x and z are taken, y is left out. Other faces are passed over.
Result<Features> readObjOutlines(std::string_view bytes, const ReadLimits& limits = {},
                                 const Progress* progress = nullptr);

}  // namespace sgm::plan
