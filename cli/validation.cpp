#include "cli/validation.h"

#include <fmt/format.h>

#include "cli/messages.h"
#include "modeler/core/packages.h"

namespace sgm::cli {

Status validated(const mesh::Mesh& mesh, bool quiet, Context& context) {
    const auto judgement = context.timed("validate", [&] { return mesh::validate(mesh); });
    if (!judgement.ok()) return judgement.error();
    const std::string verdict =
        fmt::format("CGAL: {}, {}, {}, {:.6g} m³", judgement->closed ? "closed" : "not closed",
                    judgement->outward ? "outward" : "not outward",
                    judgement->selfIntersects ? "crosses itself" : "free of self-intersections", judgement->volume_m3);
    if (!judgement->closed || !judgement->outward || judgement->selfIntersects)
        return Error{Error::Kind::Input, verdict};
    if (!quiet) fmt::print("{}\n", verdict);
    return Done{};
}

void warnOfFaults(const mesh::Mesh& mesh, Context& context) {
    if (!isBuiltWith(Package::Cgal)) {
        printMessage("warning: {}: the mesh may cross itself since it was smoothed\n",
                     missingPackage(Package::Cgal, "finding faults").message);
        return;
    }
    const auto judgement = context.timed("validate", [&] { return mesh::validate(mesh); });
    if (!judgement.ok() || (judgement->closed && !judgement->selfIntersects)) return;
    printMessage(
        "warning: the mesh {} since it was smoothed: smooth less, or take smaller cells (--validate makes this an "
        "error)\n",
        judgement->closed ? "crosses itself" : "has holes");
}

}  // namespace sgm::cli
