#include "modeler/eval/chosen_paths.h"

#include <bit>
#include <cassert>

namespace sgm::eval {
namespace {

constexpr uint64_t all = ~uint64_t{0};

/// A row of an operand of a minimum or maximum; `scratch` where it is a number.
const float* operandRow(Source source, const StepContext& c, size_t planes, size_t plane, float* scratch) {
    if (!isConstant(source)) return placeOf(c, source, planes, plane);
    std::fill_n(scratch, c.count, plane == 0 ? c.constants[indexOf(source)] : 0.0f);
    return scratch;
}

/// Of each point a or b, by masks of all bits or none.
void takeEach(const float* a, const float* b, const uint32_t* takesSecond, size_t n, float* out) {
    for (size_t i = 0; i < n; ++i) {
        const auto first = std::bit_cast<uint32_t>(a[i]), second = std::bit_cast<uint32_t>(b[i]);
        out[i] = std::bit_cast<float>((second & takesSecond[i]) | (first & ~takesSecond[i]));
    }
}

}  // namespace

ChosenPaths::ChosenPaths(const Tape& tape, Workspace::Impl& workspace, size_t planes, const Step* steps)
    : tape_(tape), w_(workspace), planes_(planes), steps_(steps), names_(tape, workspace, planes) {
    w_.choices.resize(tape.size());
}

const StepContext& ChosenPaths::run(Points points) {
    assert(points.n >= 1 && points.n <= pathPoints);
    findChoices(points);
    findLive(points.n);
    runLive(points.n);
    return live_;
}

/// What the points take of two operands: of values as the op does, of names as LabelPass does.
Choice ChosenPaths::choiceOf(const Instruction& in) {
    alignas(vectorFloats * sizeof(float)) std::array<float, pathPoints> numbers[2];
    const float* const a = operandRow(in.a, values_, 1, 0, numbers[0].data());
    const float* const b = operandRow(in.b, values_, 1, 0, numbers[1].data());
    const float margin = tape_.tieMargin();
    const size_t n = values_.count;
    const auto pinchedOf = [&](Source source) { return isConstant(source) ? 0 : w_.pathPinched[source]; };
    const uint64_t first = pinchedOf(in.a), second = pinchedOf(in.b);
    const bool least = field::traits(in.op).owner == field::ops::Owner::Least;
    Choice choice = least ? Choice{~w_.kernels.below(a, 0, b, 0, n), w_.kernels.below(b, 0, a, -margin, n), 0}
                          : Choice{~w_.kernels.below(b, 0, a, 0, n), w_.kernels.below(a, margin, b, 0, n), 0};
    if (least && first != 0) choice.names |= first & ~second & w_.kernels.below(b, 0, a, margin, n);
    uint64_t& pinched = w_.pathPinched[in.out];
    pinched = (first & ~choice.names) | (second & choice.names);
    if (!least && !isConstant(in.a) && !isConstant(in.b)) {
        alignas(vectorFloats * sizeof(float)) std::array<float, pathPoints> sums, zeros{};
        for (size_t i = 0; i < n; ++i) sums[i] = a[i] + b[i];
        pinched |= w_.kernels.below(sums.data(), 0, zeros.data(), margin, n) &
                   w_.kernels.below(zeros.data(), -margin, sums.data(), 0, n);
    }
    return choice;
}

/// Values of all instructions, and what minima and maxima take.
void ChosenPaths::findChoices(Points points) {
    StepContext& c = values_;
    w_.setUp(c, tape_, 1, pathPoints);
    c.count = roundedUp(points.n);
    float* const copies = w_.points.get(3 * pathPoints);
    const float* const from[] = {points.x, points.y, points.z};
    for (size_t axis = 0; axis < 3; ++axis) {
        w_.kernels.load(from[axis], points.n, c.count, copies + axis * pathPoints);
        c.coordinates[axis] = copies + axis * pathPoints;
    }
    w_.pathPinched.assign(tape_.registerCount(), 0);
    for (size_t i = 0; i < tape_.size(); ++i) {
        const Instruction& in = tape_.code()[i];
        if (field::traits(in.op).selects)
            w_.choices[i] = choiceOf(in);
        else
            w_.pathPinched[in.out] = 0;
        w_.kernels.values[static_cast<size_t>(in.op)](in, c);
    }
}

/// Goes back from the result to what it takes.
void ChosenPaths::findLive(size_t n) {
    std::vector<uint64_t>& readers = w_.pathReaders;  // points that need the value, by register
    readers.assign(tape_.registerCount(), 0);
    w_.liveInstructions.clear();
    const auto read = [&](Source source, uint64_t points) {
        if (!isConstant(source)) readers[source] |= points;
    };
    read(tape_.result(), n < pathPoints ? (uint64_t{1} << n) - 1 : all);
    for (size_t i = tape_.size(); i-- > 0;) {
        const Instruction& in = tape_.code()[i];
        const uint64_t points = readers[in.out];
        if (points == 0) continue;
        readers[in.out] = 0;
        w_.liveInstructions.push_back(static_cast<uint32_t>(i));
        const field::OpTraits& traits = field::traits(in.op);
        if (traits.selects) {
            Choice& choice = w_.choices[i];
            choice.points = points;
            read(in.a, points & ~(choice.values & choice.names));
            read(in.b, points & (choice.values | choice.names));
        } else if (traits.arity == field::ops::variadic) {
            for (uint32_t k = 0; k < in.count; ++k) read(tape_.sources()[in.a + k], points);
        } else {
            read(in.a, points);
            if (traits.arity == 2) read(in.b, points);
        }
    }
}

/// Which points take the second operand's derivatives: those that take its value; of two that tie and bend by little
/// against each other, those that take its name.
uint64_t ChosenPaths::derivativesOfSecond(const Instruction& in, const Choice& choice) const {
    constexpr float sameSide = .9f;  // cosine
    alignas(vectorFloats * sizeof(float)) std::array<float, pathPoints> numbers[2];
    uint64_t seconds = choice.values;
    for (uint64_t tied = (choice.values ^ choice.names) & choice.points; tied != 0; tied &= tied - 1) {
        const auto i = static_cast<size_t>(std::countr_zero(tied));
        Vec3f a, b;
        for (int axis = 0; axis < 3; ++axis) {
            const auto plane = static_cast<size_t>(axis + 1);
            a[axis] = operandRow(in.a, live_, planes_, plane, numbers[0].data())[i];
            b[axis] = operandRow(in.b, live_, planes_, plane, numbers[1].data())[i];
        }
        if (dot(a, b) > sameSide * length(a) * length(b)) seconds ^= uint64_t{1} << i;
    }
    return seconds;
}

/// The operand that each point takes, plane by plane.
void ChosenPaths::takeValues(const Instruction& in, const Choice& choice) const {
    alignas(vectorFloats * sizeof(float)) std::array<float, pathPoints> numbers[2];
    std::array<uint32_t, pathPoints> takesSecond;
    const uint64_t ofDerivatives = planes_ > 1 ? derivativesOfSecond(in, choice) : 0;
    for (size_t plane = 0; plane < planes_; ++plane) {
        const uint64_t seconds = plane == 0 ? choice.values : ofDerivatives;
        const bool first = (choice.points & ~seconds) != 0, second = (choice.points & seconds) != 0;
        if (first && second && plane < 2) spreadBits(seconds, live_.count, takesSecond.data());
        const float* const a = operandRow(in.a, live_, planes_, plane, numbers[0].data());
        const float* const b = operandRow(in.b, live_, planes_, plane, numbers[1].data());
        float* const out = rowOf(live_, in.out, planes_, plane);
        if (!first || !second)
            std::copy_n(first ? a : b, live_.count, out);
        else
            takeEach(a, b, takesSecond.data(), live_.count, out);
    }
}

/// Values, derivatives and names of what is live.
void ChosenPaths::runLive(size_t n) {
    StepContext& c = live_;
    if (planes_ == 1)
        w_.setUp(c, tape_, 1, pathPoints);
    else
        w_.setUpGradients(c, tape_, pathPoints);
    c.count = roundedUp(n);
    for (size_t axis = 0; axis < 3; ++axis) c.coordinates[axis] = values_.coordinates[axis];
    for (size_t k = w_.liveInstructions.size(); k-- > 0;) {
        const uint32_t i = w_.liveInstructions[k];
        const Instruction& in = tape_.code()[i];
        if (field::traits(in.op).selects) {
            names_.choose(in, c, w_.choices[i]);
            takeValues(in, w_.choices[i]);
        } else {
            names_(in, c);
            steps_[static_cast<size_t>(in.op)](in, c);
        }
    }
}

}  // namespace sgm::eval
