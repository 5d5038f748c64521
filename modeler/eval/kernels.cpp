// Compiled once for each instruction set (CMakeLists.txt), with SGM_ISA the namespace of its table. Nothing here may
// instantiate an inline function that doesn't depend on Arch: the linker might keep the copy this machine can't run.
#include "modeler/eval/kernels.h"

#include <limits>

#include "modeler/eval/kernel_planes.h"
#include "modeler/eval/source_arch.h"
#include "modeler/eval/values_dual.h"
#include "modeler/eval/values_interval.h"
#include "modeler/eval/values_pair.h"
#include "modeler/eval/values_simd.h"
#include "modeler/field/ops.h"

namespace sgm::eval {
namespace {

/// The row's body for a value type, its override where it has one.
template <class Row, class V>
struct Body {
    static V call(auto... args) { return Row::apply(args...); }
};
template <class Row, class F>
struct Body<Row, Dual<F>> {
    static Dual<F> call(auto... args) {
        if constexpr (requires { Row::gradient(args...); })
            return Row::gradient(args...);
        else
            return Row::apply(args...);
    }
};
template <class Row, class F>
struct Body<Row, Interval<F>> {
    /// Unknown where an operand is.
    static Interval<F> call(auto... args) { return unmasked(args...).where((known(args) & ...)); }
    static Interval<F> call(std::span<const Interval<F>> args, auto data) {
        auto mask = known(args[0]);
        for (const Interval<F>& a : args) mask = mask & known(a);
        return unmasked(args, data).where(mask);
    }

private:
    static Interval<F> unmasked(auto... args) {
        if constexpr (requires { Row::interval(args...); })
            return Row::interval(args...);
        else
            return Row::apply(args...);
    }
};

/// What a variadic row's functions take after its operands: the words of a grid, or the instruction's own integer.
template <class Row>
auto dataOf(const Instruction& in, const StepContext& c) {
    if constexpr (field::traitsOf<Row>().readsGrid)
        return c.grids[in.data];
    else
        return in.data;
}

/// Where an instruction writes.
template <class V>
float* outOf(const StepContext& c, uint32_t reg) {
    return c.result ? c.result : c.registers + size_t{reg} * Planes<V>::count * c.stride;
}

/// How far the planes there are apart.
inline size_t outStride(const StepContext& c) { return c.result ? c.resultStride : c.stride; }

/// Where an operand is read.
template <class V>
Place placeOf(const StepContext& c, uint32_t reg) {
    if constexpr (!std::is_same_v<V, Interval<Float>>)
        if (reg < 3) return {c.coordinates[reg], c.derivatives[reg]};
    const float* const first = c.registers + size_t{reg} * Planes<V>::count * c.stride;
    return {first, first + c.stride};
}

/// An operand that is one constant for all lanes.
template <class V>
struct Fixed {
    V v;
    V at(size_t) const { return v; }
};
/// An operand in a register.
template <class V>
struct Moving {
    Place place;
    size_t stride;
    V at(size_t i) const { return Planes<V>::load(place.from(i), stride); }
};

/// fn with the operand as it is: the choice is made once an instruction, not once a vector.
template <class V, class Fn>
void withOperand(Source s, const StepContext& c, Fn&& fn) {
    if (isConstant(s))
        fn(Fixed<V>{V(c.constants[indexOf(s)])});
    else
        fn(Moving<V>{placeOf<V>(c, s), c.stride});
}

template <class V>
V loadAt(Source s, const StepContext& c, size_t i) {
    return isConstant(s) ? V(c.constants[indexOf(s)]) : Planes<V>::load(placeOf<V>(c, s).from(i), c.stride);
}

/// What pruning needs to know: each operand's end that is nearer to being chosen, and the reach; NaN where one is
/// unknown.
template <class Row>
void keepBounds(std::span<const Interval<Float>> args, uint32_t data, size_t i, const StepContext& c) {
    auto mask = known(args[0]);
    for (size_t k = 0; k < args.size(); ++k) {
        mask = mask & known(args[k]);
        (Row::owner == field::ops::Owner::Least ? args[k].lo : args[k].hi).store(c.bounds + k * c.stride + i);
    }
    const Float pruneBound = select(mask, Row::pruneBound(args, data), Float(std::numeric_limits<float>::quiet_NaN()));
    pruneBound.store(c.bounds + args.size() * c.stride + i);
}

/// Any operands, gathered vector by vector.
template <class Row, class V>
void stepOver(const Instruction& in, const StepContext& c) {
    [[maybe_unused]] constexpr bool chooses = field::traitsOf<Row>().chooses && std::is_same_v<V, Interval<Float>>;
    float* const out = outOf<V>(c, in.out);
    const size_t stride = outStride(c);
    V* const args = static_cast<V*>(c.arguments);
    const Source* const sources = c.sources + in.a;
    for (size_t i = 0; i < c.count; i += Float::size) {
        for (uint32_t k = 0; k < in.count; ++k) args[k] = loadAt<V>(sources[k], c, i);
        const std::span<const V> all(args, in.count);
        if constexpr (chooses) keepBounds<Row>(all, in.data, i, c);
        Planes<V>::store(Body<Row, V>::call(all, dataOf<Row>(in, c)), out + i, stride);
    }
}

/// A row whose operands are numbers but for those that move, from point i on for as many whole V as there are. Returns
/// how far it came.
template <class Row, auto path, class V>
size_t stepByNumbers(size_t i, const Place* places, const auto& numbers, float* out, const StepContext& c) {
    const size_t stride = outStride(c);
    for (; i + Planes<V>::floats <= c.count; i += Planes<V>::floats) {
        V at[Row::varyingOperands];
        for (size_t k = 0; k < Row::varyingOperands; ++k) at[k] = Planes<V>::load(places[k].from(i), c.stride);
        Planes<V>::store(Row::template evalUniform<path>(at, numbers), out + i, stride);
    }
    return i;
}

/// Derivatives of a row of x, y, z themselves and numbers.
template <class Row>
void stepBySlopes(const Instruction& in, float* out, const StepContext& c) {
    const Source* const sources = c.sources + in.a;
    const size_t stride = outStride(c);
    Float args[Row::operandCount];
    for (size_t k = Row::varyingOperands; k < Row::operandCount; ++k) args[k] = Float(c.constants[indexOf(sources[k])]);
    for (size_t i = 0; i < c.count; i += Float::size) {
        for (size_t k = 0; k < Row::varyingOperands; ++k) args[k] = Float::load(c.coordinates[k] + i);
        const auto [value, by] = Row::template slopes<Float>([&](size_t k) { return args[k]; });
        Planes<Dual<Float>>::store({value, by.x, by.y, by.z}, out + i, stride);
    }
}

/// Operands of a known number, the moving ones in registers and the others constant: those stay in vector registers.
/// False where the operands are otherwise.
template <class Row, class V>
bool stepOverNumbers(const Instruction& in, const StepContext& c) {
    constexpr size_t count = Row::operandCount, moving = Row::varyingOperands;
    const Source* const sources = c.sources + in.a;
    for (size_t k = 0; k < count; ++k)
        if (isConstant(sources[k]) != (k >= moving)) return false;
    Place places[moving];
    for (size_t k = 0; k < moving; ++k) places[k] = placeOf<V>(c, sources[k]);
    float* const out = outOf<V>(c, in.out);
    const size_t stride = outStride(c);
    if constexpr (!std::is_same_v<V, Interval<Float>> &&
                  requires { sizeof(typename Row::template UniformParams<float>); }) {
        float args[count];
        for (size_t k = moving; k < count; ++k) args[k] = c.constants[indexOf(sources[k])];
        const typename Row::template UniformParams<float> numbers(std::span<const float>(args, count), in.data);
        Row::visitPath(
            numbers.form, [&]<auto path>() {
                using Two = std::conditional_t<std::is_same_v<V, Float>, Pair<Float>, Dual<Pair<Float>>>;
                const size_t i = stepByNumbers<Row, path, Two>(0, places, numbers, out, c);
                stepByNumbers<Row, path, V>(i, places, numbers, out, c);
            });
    } else {
        if constexpr (std::is_same_v<V, Dual<Float>> && requires { &Row::template slopes<Float, float (*)(size_t)>; }) {
            if (sources[0] == 0 && sources[1] == 1 && sources[2] == 2) {
                stepBySlopes<Row>(in, out, c);
                return true;
            }
        }
        V args[count];
        for (size_t k = moving; k < count; ++k) args[k] = V(c.constants[indexOf(sources[k])]);
        for (size_t i = 0; i < c.count; i += Float::size) {
            for (size_t k = 0; k < moving; ++k) args[k] = Planes<V>::load(places[k].from(i), c.stride);
            Planes<V>::store(Body<Row, V>::call(std::span<const V>(args, count), dataOf<Row>(in, c)), out + i, stride);
        }
    }
    return true;
}

template <class Row, class V>
void step(const Instruction& in, const StepContext& c) {
    [[maybe_unused]] constexpr bool chooses = field::traitsOf<Row>().chooses && std::is_same_v<V, Interval<Float>>;
    float* const out = outOf<V>(c, in.out);
    const size_t stride = outStride(c);
    if constexpr (Row::arity == 1) {
        withOperand<V>(in.a, c, [&](auto a) {
            for (size_t i = 0; i < c.count; i += Float::size)
                Planes<V>::store(Body<Row, V>::call(a.at(i)), out + i, stride);
        });
    } else if constexpr (Row::arity == 2) {
        withOperand<V>(in.a, c, [&](auto a) {
            withOperand<V>(in.b, c, [&](auto b) {
                for (size_t i = 0; i < c.count; i += Float::size) {
                    const V args[] = {a.at(i), b.at(i)};
                    if constexpr (chooses) keepBounds<Row>(args, in.data, i, c);
                    Planes<V>::store(Body<Row, V>::call(args[0], args[1]), out + i, stride);
                }
            });
        });
    } else if constexpr (Row::arity == field::ops::variadic) {
        if constexpr (requires { Row::operandCount; }) {
            if (stepOverNumbers<Row, V>(in, c)) return;
        }
        stepOver<Row, V>(in, c);
    }
}

template <bool Lesser>
void moveOwners(const float* values, const float* owners, float one, size_t n, float* best, float* taken) {
    for (size_t i = 0; i < n; i += Float::size) {
        const Float value = Float::load(values + i), soFar = Float::load(best + i);
        const auto wins = Lesser ? value < soFar : value > soFar;
        const Float owner = owners ? Float::load(owners + i) : Float(one);
        select(wins, value, soFar).store(best + i);
        select(wins, owner, Float::load(taken + i)).store(taken + i);
    }
}

template <bool Lesser>
void ownersOfTwo(const float* const values[2], const float* const owners[2], const float ones[2], size_t n,
                 float* taken) {
    const auto ownersAt = [&](int k, size_t i) { return owners[k] ? Float::load(owners[k] + i) : Float(ones[k]); };
    for (size_t i = 0; i < n; i += Float::size) {
        const Float first = Float::load(values[0] + i), second = Float::load(values[1] + i);
        select(Lesser ? second < first : second > first, ownersAt(1, i), ownersAt(0, i)).store(taken + i);
    }
}

/// The n < Float::size floats at `from`, then `rest`.
inline Float loadSome(const float* from, size_t n, float rest) {
#if defined(__AVX512F__)
    const auto mask = static_cast<__mmask16>((1u << n) - 1);
    return Float(Float::Batch(_mm512_mask_loadu_ps(_mm512_set1_ps(rest), mask, from)));
#else
    alignas(64) float row[Float::size];
    for (size_t i = 0; i < Float::size; ++i) row[i] = i < n ? from[i] : rest;
    return Float::load(row);
#endif
}

void load(const float* from, size_t n, size_t count, float* row) {
    size_t i = 0;
    for (; i + Float::size <= n; i += Float::size) Float(Float::Batch::load_unaligned(from + i)).store(row + i);
    const Float last = from[n - 1];
    if (i < n) loadSome(from + i, n - i, from[n - 1]).store(row + i), i += Float::size;
    for (; i < count; i += Float::size) last.store(row + i);
}

void store(const float* row, size_t n, float* to) {
    size_t i = 0;
    for (; i + Float::size <= n; i += Float::size) Float::load(row + i).v.store_unaligned(to + i);
#if defined(__AVX512F__)
    if (i < n) _mm512_mask_storeu_ps(to + i, static_cast<__mmask16>((1u << (n - i)) - 1), _mm512_load_ps(row + i));
#else
    for (; i < n; ++i) to[i] = row[i];
#endif
}

/// A bit a lane.
inline uint64_t bitsOf(Float::Mask mask) {
#if defined(__AVX512F__)
    return mask.m.data;
#elif defined(__AVX__)
    return static_cast<uint64_t>(_mm256_movemask_ps(mask.m));
#else
    alignas(64) bool lanes[Float::size];
    mask.m.store_aligned(lanes);
    uint64_t bits = 0;
    for (size_t i = 0; i < Float::size; ++i) bits |= uint64_t{lanes[i]} << i;
    return bits;
#endif
}

uint64_t notAbove(const float* row, const float* most, size_t n) {
    uint64_t bits = 0;
    for (size_t i = 0; i < n; i += Float::size) bits |= bitsOf(!(Float::load(row + i) > Float::load(most + i))) << i;
    return bits;
}

uint64_t below(const float* a, float more, const float* b, float less, size_t n) {
    uint64_t bits = 0;
    for (size_t i = 0; i < n; i += Float::size)
        bits |= bitsOf(Float::load(a + i) + Float(more) < Float::load(b + i) + Float(less)) << i;
    return bits;
}

/// A row whose derivatives are, bit for bit, those of the least field where no other counts.
template <class Row>
struct OfPieces : Row {
    template <class D>
    static D gradient(std::span<const D> args, uint32_t data) {
        return Row::template gradientOf<true>(args, data);
    }
};
/// Whether a row has derivatives that tell exactness apart.
template <class Row>
concept HasExactGradient = requires(std::span<const Dual<Float>> args) {
    Row::template gradientOf<true>(args, 0u);
};
template <class Row>
constexpr Step pieceStep() {
    if constexpr (HasExactGradient<Row>)
        return step<OfPieces<Row>, Dual<Float>>;
    else
        return step<Row, Dual<Float>>;
}

template <class V, class... Rows>
const Step* steps(field::TypeList<Rows...>) {
    static constexpr Step table[] = {step<Rows, V>...};
    return table;
}

template <class... Rows>
const Step* pieceSteps(field::TypeList<Rows...>) {
    static constexpr Step table[] = {pieceStep<Rows>()...};
    return table;
}

}  // namespace

namespace SGM_ISA {
Kernels kernels() {
    constexpr field::OpTable rows;
    return {steps<Float>(rows),
            steps<Dual<Float>>(rows),
            pieceSteps(rows),
            steps<Interval<Float>>(rows),
            moveOwners<true>,
            moveOwners<false>,
            ownersOfTwo<true>,
            ownersOfTwo<false>,
            load,
            store,
            notAbove,
            below};
}
}  // namespace SGM_ISA

}  // namespace sgm::eval
