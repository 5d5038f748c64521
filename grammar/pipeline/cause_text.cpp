// Why a piece floats, in words.
#include <fmt/format.h>

#include "grammar/pipeline/gaps.h"
#include "grammar/pipeline/grids.h"

namespace sgm::pipeline {
namespace {

std::string partText(const Model& model, OriginId origin) {
    const Part& part = model.lowered->provenance.parts[origin];
    return fmt::format("'{}' ({}:{})", part.path.text(), part.file(), part.line());
}

}  // namespace

std::string causeText(const Model& model, const FloatCause& cause, float cell_m) {
    const Vec3d at = cause.at;
    switch (cause.kind) {
        case FloatCause::Kind::Unknown:
            return {};
        case FloatCause::Kind::Gap:
            if (cause.ours == cause.theirs)
                return fmt::format("a gap of {:.3g} m divides {} at ({:.2f}, {:.2f}, {:.2f})", cause.width_m,
                                   partText(model, cause.ours), at.x, at.y, at.z);
            return fmt::format("a gap of {:.3g} m lies between its {} and {} at ({:.2f}, {:.2f}, {:.2f})",
                               cause.width_m, partText(model, cause.ours), partText(model, cause.theirs), at.x, at.y,
                               at.z);
        case FloatCause::Kind::Touch:
            if (cause.ours == cause.theirs)
                return fmt::format(
                    "{} is thinner than a cell of {:.3g} m at ({:.2f}, {:.2f}, {:.2f}): smaller cells show it whole",
                    partText(model, cause.ours), cell_m, at.x, at.y, at.z);
            return fmt::format(
                "its {} and {} meet at ({:.2f}, {:.2f}, {:.2f}) by less than a cell of {:.3g} m: let them overlap "
                "more, or take smaller cells",
                partText(model, cause.ours), partText(model, cause.theirs), at.x, at.y, at.z, cell_m);
        case FloatCause::Kind::Thin:
        case FloatCause::Kind::Fragment: {
            const std::string part = partText(model, cause.theirs);
            const std::string what =
                cause.kind == FloatCause::Kind::Thin
                    ? fmt::format("{}, {:.3g} m thick, holds it and", part, cause.width_m)
                    : fmt::format("it is a fragment of a wall of {:.3g} m of {}, which", cause.width_m, part);
            return fmt::format("{} is thinner than a cell of {:.3g} m: {} shows it", what, cell_m,
                               optionForCells(model.lowered->field.bounds, cause.whole_m));
        }
    }
    return {};
}

}  // namespace sgm::pipeline
