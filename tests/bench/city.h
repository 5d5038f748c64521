// What baking cities costs: the town of examples/city at sizes from ten thousand to a million buildings.
// Enters: a size, and the share of the cells that is baked. Leaves: processor time and memory, projected where not all
// was baked. Assumes the repository's examples, and one thread, as a worker has.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "modeler/core/result.h"
#include "tests/bench/bars.h"

namespace sgm::bench {

struct CityCase {
    std::string name;
    double buildings = 1e4;  ///< about as many
    double side_m = 4500;
    bool isDistinct = false;  ///< every building is an object of its own as far as chance decides something of it
    double objectCell_m = .3;
    double share = 1;         ///< of the cells, drawn by their places
    double bar_s = 0;         ///< of processor time; 0: none
    bool isShared = false;    ///< baked once more by two processes at a time
    double groundCell_m = 2;  ///< at 25 km float32 tells no vertices apart in cells of less than 3 m
};

/// What baking a case costs: plain bytes, which one process hands to another.
struct CityFigures {
    uint64_t places = 0, objects = 0, cells = 0, bakedCells = 0, bakedObjects = 0;
    double plan_s = 0, baked_s = 0;                ///< processor time, measured
    double total_s = 0;                            ///< plan and all cells; projected where only a share was baked
    double objects_s = 0, ground_s = 0;            ///< of it, of objects and of the ground of cells
    double planMemory_MB = 0, bakeMemory_MB = 0;   ///< at most; the second beyond what the plan holds once it is made
    double folder_MB = 0, largestDwelling_kB = 0;  ///< the first projected as the time
    double twoWorkers_s = 0;  ///< processor time of the slower of two, with its plan; 0: not measured
};

/// The figures of a case.
struct CityCosts : CityFigures {
    CityCase what;
};

/// The cases of docs/city.md with at most so many buildings.
std::vector<CityCase> cityCases(double mostBuildings);
/// Bakes in a process of its own, as a worker does: what earlier cases leave in the heap would count as memory.
/// Error::Internal with what that process says where it fails.
Result<CityCosts> measureCity(const CityCase& what);
std::string cityHeader();
std::string cityLine(const CityCosts& costs);
std::vector<Bar> judge(const std::vector<CityCosts>& costs);

}  // namespace sgm::bench
