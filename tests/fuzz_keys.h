// Which inputs a fuzz test makes: a few by themselves, others and more when ./run.sh fuzz runs it.
// Enters: the environment. Leaves: keys, each of which decides an input. Assumes nothing.
#pragma once

#include <cstdint>
#include <cstdlib>

namespace sgm {

/// The keys first … first + count - 1.
struct FuzzKeys {
    uint64_t first = 0, count = 0;
    uint64_t end() const { return first + count; }
};

/// SGM_FUZZ_MUTANTS says how many instead of `usual`, SGM_FUZZ_FIRST where they begin instead of at 0.
inline FuzzKeys fuzzKeys(uint64_t usual) {
    const auto number = [](const char* name, uint64_t otherwise) {
        const char* text = std::getenv(name);
        return text ? std::strtoull(text, nullptr, 10) : otherwise;
    };
    return {number("SGM_FUZZ_FIRST", 0), number("SGM_FUZZ_MUTANTS", usual)};
}

}  // namespace sgm
