// What options take.
// Enters: an option's text. Leaves: a check whose refusal says what is wrong and what would be right. CLI11's own let
// NaN through, take -1 for a huge number and print their own notation.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace CLI {
class Validator;
}

namespace sgm::cli {

/// Accepts finite numbers from `lo` to `hi`.
CLI::Validator between(double lo, double hi);

/// Accepts whole numbers from `lo` to `hi`, written in decimal digits.
CLI::Validator wholeNumber(uint64_t lo, uint64_t hi);

/// Accepts any seed: a whole number of 64 bits.
CLI::Validator anySeed();

/// Accepts one of the words.
CLI::Validator oneOf(std::vector<std::string> words);

/// Accepts one of the words and puts its number in its stead, for an option that is an enum.
CLI::Validator namedValue(std::map<std::string, int> values);

}  // namespace sgm::cli
