#include "cli/numbers.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

namespace sgm::cli {

CLI::Validator between(double lo, double hi) {
    const auto refusal = [lo, hi](std::string& text) {
        double value = 0;
        const bool inside = CLI::detail::lexical_cast(text, value) && value >= lo && value <= hi;
        return inside ? std::string() : fmt::format("'{}' is no number from {:g} to {:g}", text, lo, hi);
    };
    return {refusal, fmt::format("FLOAT in [{:g} - {:g}]", lo, hi)};
}

}  // namespace sgm::cli
