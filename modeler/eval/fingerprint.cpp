#include "modeler/eval/fingerprint.h"

#include <bit>

#include "modeler/core/random.h"
#include "modeler/field/ops.h"

namespace sgm::eval {
namespace {

/// Two streams of words, each multiplied on by an odd number of its own; mixed at the end.
class Hash {
public:
    void add(uint64_t word) {
        a_ = std::rotl((a_ ^ word) * 0x9e3779b97f4a7c15ull, 29);
        b_ = std::rotl((b_ + word) * 0xd1342543de82ef95ull, 37);
    }
    void add(uint32_t low, uint32_t high) { add(uint64_t{high} << 32 | low); }
    Fingerprint result() const { return {mix(a_ ^ std::rotl(b_, 17)), mix(b_ + std::rotl(a_, 41))}; }

private:
    uint64_t a_ = 0x243f6a8885a308d3ull, b_ = 0x13198a2e03707344ull;
};

}  // namespace

Fingerprint fingerprint(const Tape& tape) {
    Hash hash;
    // A register, or the bits of a constant, told apart by the other half of the word.
    const auto addSource = [&](Source s) {
        if (isConstant(s))
            hash.add(std::bit_cast<uint32_t>(tape.constants()[indexOf(s)]), constantBit);
        else
            hash.add(s, 0);
    };
    for (const Instruction& in : tape.code()) {
        const int arity = field::traits(in.op).arity;
        hash.add(static_cast<uint32_t>(in.op), in.count);
        hash.add(in.out, in.data);
        if (field::traits(in.op).readsGrid) hash.add(tape.grids()->list[in.data]->hash());
        hash.add(in.origins, in.piece);
        if (arity == field::ops::variadic)
            for (uint32_t k = 0; k < in.count; ++k) addSource(tape.sources()[in.a + k]);
        else
            addSource(in.a);
        if (arity == 2) addSource(in.b);
    }
    addSource(tape.result());
    for (const OriginId id : tape.origins()) hash.add(id);
    return hash.result();
}

}  // namespace sgm::eval
