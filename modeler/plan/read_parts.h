// What the readers of outlines share. For this folder's sources alone.
// Enters: rings as a file has them. Leaves: sound features. Assumes nothing.
#pragma once

#include <optional>

#include "modeler/plan/read.h"

namespace sgm::plan {

/// Counts what a file holds against its limits.
class ReadBudget {
public:
    explicit ReadBudget(const ReadLimits& limits) : limits_(limits) {}
    /// An error where one feature more, or so many points more, are too many.
    std::optional<Error> addFeature();
    std::optional<Error> addPoints(size_t count);
    size_t points() const { return points_; }

private:
    const ReadLimits& limits_;
    size_t features_ = 0, points_ = 0;
};

/// The footprint of polygons as they were written: senses corrected, points on one another left out, crossings
/// resolved. The error is what is wrong with it. `repaired` gets the fault whose repair changed the area enclosed, as
/// crossings do and a point that touches doesn't.
Result<Footprint> soundFootprint(const Footprint& drawn, const Limits& limits,
                                 std::optional<Fault>* repaired = nullptr);
/// What `repaired` says, in the words of files: "its outline crosses itself near (4.2, 1)"; `at` as the file has it.
std::string repairText(const Fault& fault, Vec2 at);

/// Error::Input: "feature 3: …", "line 12: …".
Error damaged(std::string_view unit, uint64_t number, std::string_view why);
/// The same of an error inside, whose kind it keeps.
Error damaged(std::string_view unit, uint64_t number, const Error& why);

/// The number at the beginning of `text`, which is moved behind it; nothing where there is none or it isn't finite.
std::optional<double> takeNumber(std::string_view& text);

}  // namespace sgm::plan
