// What the window asks of itself: how long a picture of a field takes, and how often it evaluates the field.
// Enters: nothing; draws a cloud of 5,000 spheres and a KIFS building of 12 storeys at 640 × 640. Leaves: a table and
// bars. Assumes an OpenGL driver, software or not.
#pragma once

#include <string>
#include <vector>

#include "tests/bench/bars.h"
#include "tests/bench/measure.h"

namespace sgm::bench {

struct PictureResult {
    std::string name;
    double cellsSeconds = 0;          ///< space cut into cells, words uploaded
    double coarseSeconds = 0;         ///< 128 × 128, a sample a pixel: what a moving camera shows
    double fullSeconds = 0;           ///< 640 × 640, edges smoothed
    double fullProcessorSeconds = 0;  ///< the same of all threads
    double samples = 0;               ///< a pixel
    double hits = 0, light = 0;       ///< evaluations of the field a pixel
    bool asked = true;                ///< the bars speak of it: drawn as sgm draws on this machine
    double plain = 0;                 ///< those of plain sphere tracing of the whole field for the same samples

    double ratio() const { return plain / (hits + light); }
};

Result<std::vector<PictureResult>> measurePictures(int repeats, Running running);
std::string pictureTable(const std::vector<PictureResult>& results);
/// Full in 1.5 s, coarse in 0.12 s, a third of the evaluations.
std::vector<Bar> judge(const std::vector<PictureResult>& results);

}  // namespace sgm::bench
