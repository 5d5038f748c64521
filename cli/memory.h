// How much memory a command may take.
// Enters: what the machine and its control group allow. Leaves: a limit that makes allocations fail in time, so that
// the program ends with a message and not by the kernel's out-of-memory killer. Assumes Linux.
#pragma once

#include <cstdint>

namespace sgm::cli {

/// Three quarters of what the machine has, or of what the process's control groups allow where that is less; 0 where
/// neither is known.
uint64_t usualMemory_bytes();

/// From here on the process can't have more than so much memory of its own; 0: no limit. A lower limit that holds
/// already stays.
void limitMemory(uint64_t bytes);

/// Takes the stack that the main thread may need later, for it can't grow any more when memory has run out.
void reserveStack();

}  // namespace sgm::cli
