#include "cli/validate.h"

#include <fmt/format.h>

#include "modeler/mesh/validate.h"

namespace sgm::cli {

Status validated(const mesh::Mesh& mesh, Stages& stages) {
    const auto judgement = timed(stages, "validate", [&] { return mesh::judge(mesh); });
    if (!judgement.ok()) return judgement.error();
    const std::string verdict = fmt::format("CGAL: {}, {}, {}, {:.6g} m³", judgement->closed ? "closed" : "not closed",
                                            judgement->outward ? "outward" : "not outward",
                                            judgement->selfIntersects ? "crosses itself" : "free of self-intersections", judgement->volume_m3);
    if (!judgement->closed || !judgement->outward || judgement->selfIntersects) return Error{Error::Kind::Input, verdict};
    fmt::print("{}\n", verdict);
    return Done{};
}

}  // namespace sgm::cli
