// What comes before the tape costs: derivation, lowering and compiling of large walls, plans from files, L-systems.
// Enters: grammars that are written here. Leaves: times and memory beside what is asked for. Assumes a machine that is
// calm where several threads share the work, for then the wall's time counts.
#pragma once

#include <string>
#include <vector>

#include "modeler/core/result.h"
#include "tests/bench/bars.h"

namespace sgm::bench {

/// A wall of windows, split from its storeys to its panes.
struct WallCase {
    enum class Asks { Nothing, Few, All };
    std::string name;
    double width_m = 60, height_m = 60;
    Asks asks = Asks::Nothing;  ///< of which panes rules ask for joints: none, one in a hundred, each
    double turn_deg = 0;
    bool isMeshed = false;
};

struct WallCosts {
    WallCase what;
    size_t shapes = 0, terminals = 0, tape = 0;
    double derive_s = 0, lower_s = 0, compile_s = 0, mesh_s = 0;  ///< processor time of one thread, the least of runs
    double lowerShared_s = 0;                                     ///< by the wall, on all threads
    double bytesPerShape = 0;                                     ///< of the tree and the log
    double shapesPerSecond() const { return derive_s > 0 ? static_cast<double>(shapes) / derive_s : 0; }
};

/// Measures walls, plans of a file and letters; prints a line a wall as it comes. The bars of all.
Result<std::vector<Bar>> measureDerivation();

}  // namespace sgm::bench
