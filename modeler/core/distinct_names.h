// Names of which no two are equal: nodes, objects, prims of a file.
// Enters: names that may be equal. Leaves: the same, numbered where they were. Assumes nothing.
#pragma once

#include <cstdint>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <utility>

namespace sgm {

/// Numbers names that are equal: Window, Window_2, Window_3.
class DistinctNames {
public:
    DistinctNames() = default;
    /// None of these is given out.
    explicit DistinctNames(std::unordered_set<std::string> taken) : taken_(std::move(taken)) {}

    /// `base`, or with the next number behind it where that was taken before.
    std::string take(const std::string& base) {
        std::string name = base;
        uint32_t& next = nextNumber_.try_emplace(base, 2).first->second;
        while (!taken_.insert(name).second) name = base + '_' + std::to_string(next++);
        return name;
    }

private:
    std::unordered_set<std::string> taken_;
    std::unordered_map<std::string, uint32_t> nextNumber_;
};

}  // namespace sgm
