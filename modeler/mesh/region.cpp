#include "modeler/mesh/region.h"

#include <algorithm>

#include "modeler/field/ops.h"

namespace sgm::mesh {

bool isDear(const eval::Tape& tape) {
    using field::ops::Kifs;
    constexpr uint32_t manyParts = 8;
    return std::any_of(tape.code().begin(), tape.code().end(), [](const eval::Instruction& in) {
        if (in.op != field::codeOf<Kifs> && in.op != field::codeOf<field::ops::Facade>) return false;
        const Kifs::Form form = Kifs::unpack(in.data);
        return form.passes * (1u + form.folds + form.turns) >= manyParts;
    });
}

eval::Care careOf(const eval::Tape& tape, const Grid& grid) {
    const float lipschitz = tape.lipschitz();
    if (!(lipschitz > 0) || !std::isfinite(lipschitz)) return {};
    int exponent = 0;
    const bool isPower = std::frexp(lipschitz, &exponent) == 0.5f;
    const float cells = isDear(tape) ? farMiddle : 1.25f;
    const float most = cells * std::ldexp(grid.cell_m, isPower ? exponent - 1 : exponent);
    return {-most, most};
}

}  // namespace sgm::mesh
