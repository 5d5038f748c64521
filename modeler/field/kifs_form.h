// What of a kaleidoscopic iterated function system is structure, where its operands lie, and what it costs.
// Enters: nothing. Leaves: constants of Kifs (kifs.h), which facades share. Assumes nothing.
#pragma once

#include <cstddef>
#include <cstdint>

#include "modeler/field/values.h"

namespace sgm::field::ops {

struct KifsForm {
    /// Places of the operands; vectors take three, rotations nine (by columns). Coordinates are multiplied by the
    /// stretch before the passes.
    enum Operand : size_t {
        position,
        centreOfScale = 3,
        scale = 6,
        fold = 7,
        turn = 16,
        bailout = 25,
        stretch = 26,
        operandCount = 29
    };

    /// Bits of `data`.
    enum Bits : uint32_t {
        passesMask = 255,
        isCube = 256,
        jumps = 512,
        bailsOut = 1024,
        hasFold = 2048,
        hasTurn = 4096
    };

    /// What of a node is structure.
    struct Form {
        uint32_t passes = 6;  ///< 1 … 255
        bool cube = false;    ///< terminal solid: the cube of the centre's largest component, or the ball of radius 2
        bool jump = false;    ///< as printed, instead of the continuous fold
        bool bails = false;   ///< stop where the squared radius exceeds the bailout
        bool folds = true;    ///< false: R₂ = I and its operands are not read
        bool turns = true;    ///< the same for R₁
        constexpr bool continuous() const { return !bails && !(jump && turns); }
    };
    static constexpr uint32_t pack(const Form& f) {
        return f.passes | (f.cube ? uint32_t{isCube} : 0) | (f.jump ? uint32_t{jumps} : 0) |
               (f.bails ? uint32_t{bailsOut} : 0) | (f.folds ? uint32_t{hasFold} : 0) |
               (f.turns ? uint32_t{hasTurn} : 0);
    }
    static constexpr Form unpack(uint32_t d) {
        return {d & passesMask,      (d & isCube) != 0,  (d & jumps) != 0,
                (d & bailsOut) != 0, (d & hasFold) != 0, (d & hasTurn) != 0};
    }

    /// Passes, each with its rotations.
    static constexpr uint32_t foldSteps(uint32_t data) {
        const Form form = unpack(data);
        return form.passes * (1u + form.folds + form.turns);
    }
    static constexpr bool foldsEverywhere = true;
    static constexpr uint32_t cost(uint32_t, uint32_t data) { return 15 + 20 * foldSteps(data); }

    static constexpr GlslNumber glslNumbers[] = {{"atPosition", position}, {"atCentre", centreOfScale},
                                                 {"atScale", scale},       {"atFold", fold},
                                                 {"atTurn", turn},         {"atBailout", bailout},
                                                 {"atStretch", stretch},   {"passesMask", passesMask},
                                                 {"isCube", isCube},       {"jumps", jumps},
                                                 {"bailsOut", bailsOut},   {"hasFold", hasFold},
                                                 {"hasTurn", hasTurn}};
};

}  // namespace sgm::field::ops
