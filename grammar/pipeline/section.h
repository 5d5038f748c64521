// A model cut open, so that its inside is seen.
// Enters: where to cut. Leaves: the rest of the model, each part in its own material. Assumes Y up.
#pragma once

#include <string>

#include "grammar/pipeline/model.h"

namespace sgm::pipeline {

/// A plane across an axis.
struct Section {
    int axis = 0;           ///< 0 x, 1 y, 2 z
    bool leavesLow = true;  ///< what lies toward + is cut away; else what lies toward -
    double at = 0;          ///< metres, or a share of the model's bounds from low to high
    bool isShare = false;

    friend bool operator==(const Section&, const Section&) = default;

    /// Its place along the axis within these bounds, metres.
    double offset_m(const Box3f& bounds) const;
    /// Whether its place lies outside these bounds.
    bool isBeside(const Box3f& bounds) const;
    /// Unit, toward what is cut away.
    Vec3d normal() const;
};

/// "x=1.5", "y=2m", "z=40%": what lies beyond along the axis is cut away; "-x=1.5": what lies before. Error::Usage says
/// what to write.
Result<Section> parseSection(const std::string& text);

/// The stages "objects", "lower" and "compile" of makeModel, with field::section between the latter two; objects are
/// cut open with all else. Error::Usage where nothing is left.
Result<Model> makeModel(derive::Derivation derivation, const Section& section, Context& context);

}  // namespace sgm::pipeline
