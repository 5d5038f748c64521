#include "modeler/eval/changed_parts.h"

#include <algorithm>
#include <array>

#include "modeler/eval/links.h"
#include "modeler/eval/tape_builder.h"
#include "modeler/field/ops.h"

namespace sgm::eval {
namespace {

/// By value as in Links: does it hang on a constant that changed?
std::vector<bool> hangOn(const Tape& tape, const Links& links, const std::vector<uint32_t>& places) {
    std::vector<bool> number(tape.constants().size()), value(tape.size() + 3);
    for (const uint32_t place : places) number[place] = true;
    for (size_t i = 0; i < tape.size(); ++i) {
        const Source* const operands = links.operands(i);
        value[i + 3] = std::any_of(operands, operands + tape.code()[i].count,
                                   [&](Source s) { return isConstant(s) ? number[indexOf(s)] : value[s]; });
    }
    return value;
}

/// The changed values below the topmost minima.
std::vector<uint32_t> belowMinima(const Tape& tape, const Links& links, const std::vector<bool>& changed) {
    std::vector<uint32_t> found, stack;
    std::vector<bool> seen(changed.size());
    const auto visit = [&](Source s) {
        if (isConstant(s) || !changed[s] || seen[s]) return;
        seen[s] = true;
        stack.push_back(s);
    };
    visit(links.result());
    while (!stack.empty()) {
        const uint32_t value = stack.back();
        stack.pop_back();
        if (tape.code()[value - 3].op != field::codeOf<field::ops::Min>) {
            found.push_back(value);
            continue;
        }
        for (uint32_t k = 0; k < 2; ++k) visit(links.operands(value - 3)[k]);
    }
    return found;
}

/// The tape of one value.
void extract(const Tape& tape, const Links& links, uint32_t value, TapeBuilder& b, Tape& into) {
    b.begin(tape.size() + 3);
    for (uint32_t axis = 0; axis < 3; ++axis) b.bindInput(axis, axis);
    b.result({value});
    for (uint32_t v = b.nextLive(value + 1); v != TapeBuilder::none; v = b.nextLive(v))
        b.define(v, tape.code()[v - 3], links.operands(v - 3), nullptr);
    b.finish(tape.sharedConstants(), tape.grids(), tape.lipschitz(), into);
}

}  // namespace

std::optional<std::vector<ChangedPart>> changedParts(const Tape& tape, const NumbersChanged& changed) {
    Links links;
    links.follow(tape);
    const auto values = belowMinima(tape, links, hangOn(tape, links, changed.places));
    std::vector<ChangedPart> parts(values.size());
    TapeBuilder builder;
    size_t size = 0;
    for (size_t i = 0; i < values.size(); ++i) {
        extract(tape, links, values[i], builder, parts[i].now);
        size += parts[i].now.size();
        if (4 * size > tape.size()) return std::nullopt;
        parts[i].before = parts[i].now;
        TapeBuilder::rebind(parts[i].before, changed.before, tape.lipschitz());
    }
    return parts;
}

uint64_t unreached(const std::vector<ChangedPart>& parts, std::span<const Box3f> boxes, Care care, Workspace& workspace) {
    uint64_t far = boxes.size() == 64 ? ~uint64_t{0} : (uint64_t{1} << boxes.size()) - 1;
    std::array<Range, 64> ranges;
    const auto ask = [&](const Tape& tape) {
        evaluateRanges(tape, {boxes.data(), boxes.size()}, ranges.data(), workspace);
        for (size_t i = 0; i < boxes.size(); ++i)
            if (!(ranges[i].lo > care.most)) far &= ~(uint64_t{1} << i);
    };
    for (const ChangedPart& part : parts) {
        if (far == 0) break;
        ask(part.before);
        ask(part.now);
    }
    return far;
}

}  // namespace sgm::eval
