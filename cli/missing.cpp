#include "cli/missing.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "cli/messages.h"

namespace sgm::cli {
namespace {

/// The parts of one line of a grammar.
struct Line {
    std::string symbol;
    size_t parts = 0;
    double thickness_m = 0, cell_m = 0;  ///< of the thinnest
    double missing = 0;                  ///< the sum of their shares
};

}  // namespace

Result<std::vector<lower::ThinPart>> findMissingParts(const Model& model, const MeshedModel& meshed, int threads,
                                                      Progress* progress) {
    return lower::findMissingParts(model.derivation, *model.lowered, model.tape, meshed.mesh, meshed.grid.cell_m,
                                   threads, progress);
}

void printMissingParts(const Model& model, const mesh::Grid& grid, const std::vector<lower::ThinPart>& missing) {
    constexpr size_t most = 5;
    std::map<std::pair<std::string, uint32_t>, Line> lines;
    for (const lower::ThinPart& m : missing) {
        const Part& part = model.lowered->provenance.parts[m.part];
        Line& line = lines[{part.file, part.line}];
        if (line.parts++ == 0) line = {part.symbol, 1, m.thickness_m, m.cell_m, 0};
        line.thickness_m = std::min(line.thickness_m, m.thickness_m), line.cell_m = std::min(line.cell_m, m.cell_m);
        line.missing += m.missing;
    }
    const Vec3f extent = model.lowered->field.bounds.size();
    size_t told = 0;
    for (const auto& [place, line] : lines) {
        if (told++ == most) break;
        printMessage(
            "warning: {}:{}: {} '{}' of {:.3g} m {} thinner than the mesh's cells of {:.3g} m and lack{} {:.0f} % of "
            "the surface: "
            "--resolution {} holds {}\n",
            place.first, place.second, line.parts == 1 ? "a" : std::to_string(line.parts), line.symbol,
            line.thickness_m, line.parts == 1 ? "is" : "are", grid.cell_m, line.parts == 1 ? "s" : "",
            100 * line.missing / static_cast<double>(line.parts),
            static_cast<int>(std::ceil(static_cast<double>(maxComponent(extent)) / line.cell_m)),
            line.parts == 1 ? "it" : "them");
    }
    if (lines.size() > most)
        printMessage("warning: parts of {} more lines are too thin for these cells\n", lines.size() - most);
}

}  // namespace sgm::cli
