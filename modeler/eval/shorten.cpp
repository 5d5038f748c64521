#include <cassert>

#include "modeler/eval/workspace.h"
#include "modeler/field/ops.h"

namespace sgm::eval {

Tape shorten(const Tape& tape, size_t index, Workspace& workspace) {
    Workspace::Impl& w = workspace.impl();
    assert(w.rangedCode == tape.code().data() && index < maxBoxes);
    TapeBuilder& b = w.builder;
    b.begin(tape.registerCount());
    for (uint32_t axis = 0; axis < 3; ++axis) b.bindInput(axis, axis);
    b.result({tape.result(), tape.origins()[0]});
    const uint64_t* keeps = w.keeps.data() + w.keeps.size();
    for (size_t i = tape.size(); i-- > 0;) {
        const Instruction& in = tape.code()[i];
        const field::OpTraits& row = field::traits(in.op);
        if (row.chooses) keeps -= in.count;
        if (!b.live(in.out)) continue;
        const bool many = row.arity == field::ops::variadic;
        const Source direct[] = {in.a, in.b};
        const Source* const sources = many ? tape.sources().data() + in.a : direct;
        const OriginId* const origins = in.origins ? tape.origins().data() + in.origins - 1 : nullptr;
        w.uses.clear();
        for (uint32_t k = 0; k < in.count; ++k) {
            const bool kept = !row.chooses || k < row.firstChoice || (keeps[k] >> index & 1) != 0;
            if (kept) w.uses.push_back({sources[k], origins ? origins[k] : 0});
        }
        if (row.chooses && w.uses.size() == row.firstChoice + 1u)
            b.alias(in.out, w.uses.back());
        else
            b.define(in.out, in.op, in.data, w.uses.data(), w.uses.size(), origins != nullptr);
    }
    return b.finish(tape.sharedConstants(), tape.lipschitz());
}

}  // namespace sgm::eval
