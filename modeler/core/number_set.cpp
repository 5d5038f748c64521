#include "modeler/core/number_set.h"

namespace sgm {

bool NumberSet::insert(uint64_t number) {
    if (2 * (count_ + 1) > slots_.size()) grow();
    const bool isNew = place(number);
    count_ += isNew;
    return isNew;
}

bool NumberSet::contains(uint64_t number) const {
    size_t at = number & (slots_.size() - 1);
    while (slots_[at] != 0 && slots_[at] != number) at = (at + 1) & (slots_.size() - 1);
    return slots_[at] != 0;
}

bool NumberSet::place(uint64_t number) {
    size_t at = number & (slots_.size() - 1);
    while (slots_[at] != 0 && slots_[at] != number) at = (at + 1) & (slots_.size() - 1);
    const bool isNew = slots_[at] == 0;
    slots_[at] = number;
    return isNew;
}

void NumberSet::grow() {
    std::vector<uint64_t> old(4 * slots_.size());
    old.swap(slots_);
    for (const uint64_t number : old)
        if (number != 0) place(number);
}

}  // namespace sgm
