// Streets that are there before roads grow: from a file, as the start of the net.
// Enters: GeoJSON that somebody else made. Leaves: pieces of a planar graph. Assumes nothing of the file: sizes,
// nesting and counts are bounded; lines may cross, touch and repeat one another.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "modeler/plan/read.h"
#include "modeler/town/grow.h"

namespace sgm::town {

/// A street's middle line, metres: x east, z south.
struct OwnStreet {
    std::vector<Vec2> line;
    RoadClass kind = RoadClass::Street;
    bool bridge = false;
};

/// The streets of a file.
struct OwnStreets {
    std::string name;  ///< of the file
    std::vector<OwnStreet> list;
    bool fromDegrees = false;  ///< coordinates were longitude and latitude
    plan::Box2 box;            ///< around all lines
};

/// LineStrings and MultiLineStrings of GeoJSON; other geometries are passed over, as are ways for walkers. A property
/// "class" says highway or street; without one, the words of OpenStreetMap's "highway" decide: from motorway to
/// secondary highways, else streets. "bridge" (true, yes, 1 or a word but no) makes a bridge. Error::Input names the
/// feature.
Result<OwnStreets> readStreetsBytes(std::string_view bytes, const plan::ReadLimits& limits = {},
                                    const Progress* progress = nullptr);
/// The same from a file, which the error names.
Result<OwnStreets> readStreets(const std::filesystem::path& path, const Progress* progress = nullptr);

/// A place where a street may branch off an own one.
struct OwnStop {
    uint32_t node = noIndex;
    Vec2 heading;
    RoadClass kind = RoadClass::Street;
};

/// Lays the streets into the graph, clipped to the area: where they cross one another they meet, over water they are
/// bridges. A piece that would touch another beside its ends, once on the lattice, is left out. Returns the ends of
/// streets and places along them a block apart.
std::vector<OwnStop> layStreets(RoadGraph& graph, const OwnStreets& streets, const RoadParameters& parameters,
                                const Land& land, OwnStreetsReport& report);

/// Removes all edges but those of the component with most; returns how many own ones went.
size_t keepLargestComponent(RoadGraph& graph);

}  // namespace sgm::town
