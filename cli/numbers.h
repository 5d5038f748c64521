// Numbers on the command line.
// Enters: an option's text. Leaves: a check that CLI11's own ranges, which let NaN through, don't give.
#pragma once

namespace CLI {
class Validator;
}

namespace sgm::cli {

/// Accepts finite numbers from `lo` to `hi`.
CLI::Validator between(double lo, double hi);

}  // namespace sgm::cli
