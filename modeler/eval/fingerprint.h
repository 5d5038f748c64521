// What a tape computes, as a number: equal tapes have equal fingerprints.
// Enters: a tape. Leaves: 128 bits over its instructions, the values of the constants that they read, and the owners.
// Assumes that nobody looks for collisions: two tapes that differ share a fingerprint with a chance of about 2⁻¹²⁸.
#pragma once

#include <cstdint>

#include "modeler/eval/tape.h"

namespace sgm::eval {

struct Fingerprint {
    uint64_t a = 0, b = 0;
    friend bool operator==(const Fingerprint&, const Fingerprint&) = default;
};

/// Two tapes of the same fingerprint give the same bits everywhere, in values, derivatives and owners, and shorten
/// alike. Where the tape's constants lie in their table doesn't count.
Fingerprint fingerprint(const Tape& tape);

}  // namespace sgm::eval
