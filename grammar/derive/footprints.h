// The footprints of a derivation, each once.
// Enters: sound footprints about their scope's centre. Leaves: indices that scopes carry. Assumes that the table
// outlives the scopes.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

#include "modeler/core/random.h"
#include "modeler/core/result.h"
#include "modeler/core/vec.h"
#include "modeler/plan/formula.h"

namespace sgm::derive {

/// A footprint in shares of a scope's half-size along x and z (−1 … 1), so that it stretches with the scope, and its
/// formula.
struct PlanShape {
    plan::Footprint footprint;
    plan::Formula formula;
};

class Footprints {
public:
    /// The index of a footprint given in metres about the centre of a scope of that half-size: an old one where one is
    /// alike. Error::Input with the fault's sentence where its edges cross.
    Result<uint32_t> put(const plan::Footprint& footprint, Vec3d half);
    /// The same of a footprint that plan::firstFault found sound.
    uint32_t putSound(const plan::Footprint& footprint, Vec3d half);
    /// Appends all of another table; the index of its first one here.
    size_t append(const Footprints& other);
    const PlanShape& operator[](uint32_t index) const { return *shapes_[index]; }
    /// The footprint in metres about the centre of a scope of that half-size.
    plan::Footprint inMetres(uint32_t index, Vec3d half) const;
    /// Keeps the depth of that footprint in metres (field::PlanNumbers::depth), so that it is searched once.
    void noteDepth(uint32_t index, Vec3d half, double depth_m) { depths_[sizeOf(index, half)] = depth_m; }
    std::optional<double> knownDepth(uint32_t index, Vec3d half) const {
        const auto known = depths_.find(sizeOf(index, half));
        return known == depths_.end() ? std::nullopt : std::optional(known->second);
    }

private:
    Result<uint32_t> put(const plan::Footprint& footprint, Vec3d half,
                         Result<plan::Formula> (*formulaOf)(const plan::Footprint&));
    /// A footprint's number and the bits of a half-size along x and z.
    using Size = std::array<uint64_t, 3>;
    static Size sizeOf(uint32_t index, Vec3d half) {
        return {index, std::bit_cast<uint64_t>(half.x), std::bit_cast<uint64_t>(half.z)};
    }
    struct SizeHash {
        size_t operator()(const Size& s) const { return combine(combine(s[0], s[1]), s[2]); }
    };

    std::vector<std::shared_ptr<const PlanShape>> shapes_;
    std::unordered_multimap<uint64_t, uint32_t> byHash_;
    std::unordered_map<Size, double, SizeHash> depths_;
};

}  // namespace sgm::derive
