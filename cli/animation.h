// `--animate NAME=FROM..TO:FRAMES` and the names of frames.
// Enters: what the user wrote, a checked grammar. Leaves: parameter values frame by frame, file names. Assumes frames
// are counted from 1 in file names and from 0 here.
#pragma once

#include <string>
#include <vector>

#include "grammar/rules/grammar.h"
#include "modeler/core/result.h"

namespace sgm::cli {

/// Parameters that run from one value to another over the same frames.
struct Animation {
    struct Track {
        uint32_t param = 0;
        rules::Value from, to;
    };
    std::vector<Track> tracks;
    int frames = 0;

    /// The value of a track: linear, the last frame gives `to`; whole numbers are rounded.
    rules::Value value(const Track& track, int frame) const;
    /// `values` with the tracks' values of this frame in it.
    std::vector<rules::Value> values(std::vector<rules::Value> values, int frame) const;
    /// "peak = 0.25, floors = 7"
    std::string text(const rules::Grammar& grammar, int frame) const;
};

/// Reads every "NAME=FROM..TO:FRAMES". Error::Usage for a text that isn't that, for an unknown parameter and for counts
/// of frames that differ; Error::Input for values that the parameter doesn't take.
Result<Animation> readAnimation(const rules::Grammar& grammar, const std::vector<std::string>& texts);

/// The file of a frame: "roof_%04d.glb" gives "roof_0001.glb" for frame 0; "%%" is a percent sign. Error::Usage, which
/// names the `option` that asks for frames, unless the pattern has one number.
Result<std::string> frameName(const std::string& pattern, int frame, const char* option = "--animate");

}  // namespace sgm::cli
