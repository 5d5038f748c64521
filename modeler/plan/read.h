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
    uint64_t mostBytes = 256ull << 20;
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
    /// The property called `word`, or null.
    const std::variant<std::string, double>* find(std::string_view word) const;
};

/// The features of a file, in metres about `origin`.
struct Features {
    std::vector<Feature> list;
    bool fromDegrees = false;            ///< coordinates were longitude and latitude
    double longitude = 0, latitude = 0;  ///< of x = z = 0 where they were, degrees
};

/// By the name's ending: .geojson and .json, .svg, .obj. Outlines that cross themselves are resolved by winding ≠ 0;
/// other faults are errors that name file, feature and edge.
Result<Features> readOutlines(const std::filesystem::path& path, const ReadLimits& limits = {},
                              const Progress* progress = nullptr);

/// RFC 7946 polygons and multipolygons, alone or in features and collections; other geometries are passed over. Degrees
/// are laid on a plane about the middle of all points (equirectangular: true to length there, .1 % off at 10 km),
/// metres are taken as they are where a coordinate is no longitude or latitude. x is east, z is south.
Result<Features> readGeoJson(std::string_view bytes, const ReadLimits& limits = {}, const Progress* progress = nullptr);
/// path (M L H V Z C S Q T and their relative forms; curves become 8 chords), polygon, rect; a path's further rings are
/// courts by winding ≠ 0. User units are metres; transforms of translate, scale, rotate and matrix count. x is right, z
/// down.
Result<Features> readSvg(std::string_view bytes, const ReadLimits& limits = {}, const Progress* progress = nullptr);
/// Faces that lie in a level plane, one feature a group (`o`, `g`), joined; x and z are taken, y is left out.
Result<Features> readObjOutlines(std::string_view bytes, const ReadLimits& limits = {},
                                 const Progress* progress = nullptr);

}  // namespace sgm::plan
