// Compiled once for each instruction set, with SGM_ISA the namespace. As in modeler/eval/kernels.cpp, nothing here may
// instantiate an inline function that doesn't depend on Arch.
#include "modeler/eval/source_arch.h"
#include "modeler/eval/values_dual.h"
#include "modeler/eval/values_interval.h"
#include "modeler/eval/values_pair.h"
#include "modeler/eval/values_simd.h"
#include "modeler/field/ops.h"
#include "tests/bench/operation_times.h"

namespace sgm::bench {
namespace {

using Arch = eval::SourceArch;
using Float = eval::Lanes<Arch>;
using Dual = eval::Dual<Float>;
using Interval = eval::Interval<Float>;

constexpr int chains = 8;  ///< independent inputs, so that latency doesn't count
constexpr int tries = 5;
constexpr double trySeconds = 2e-4;
constexpr uint32_t mostOperands = 64;  ///< longer lists are measured with so many and scaled

/// Makes the compiler believe that the value was changed, or is needed.
inline void opaque(Float& f) {
#if defined(__AVX512BW__)
    asm volatile("" : "+v"(f.v.data));
#elif defined(__x86_64__)
    asm volatile("" : "+x"(f.v.data));
#else
    asm volatile("" : "+m"(f.v.data));
#endif
}
[[maybe_unused]] inline void opaque(float& f) { asm volatile("" : "+m"(f)); }
template <class V>
inline void opaque(eval::Pair<V>& p) {
    opaque(p.a), opaque(p.b);
}
template <class V>
inline void opaque(eval::Dual<V>& d) {
    opaque(d.value), opaque(d.dx), opaque(d.dy), opaque(d.dz);
}
inline void opaque(Interval& i) { opaque(i.lo), opaque(i.hi); }

template <class V>
V number(float f) {
    V v(f);
    opaque(v);
    return v;
}

/// A grid of a single cell, header and samples; heights lie farther on, all 0.
constexpr float grid[128] = {0, 0, 0, 1, 1, 1, -1, 1, 1, 1, 2, 4, 1, -1, 1, 1, 1, 1, 1, 1};

template <class Row>
auto dataOf(const eval::Operation& operation) {
    if constexpr (field::traitsOf<Row>().readsGrid)
        return static_cast<const float*>(grid);
    else
        return operation.data;
}

/// As the kernels do (modeler/eval/kernels.cpp).
template <class Row, class V>
V call(auto... args) {
    if constexpr (std::is_same_v<V, Dual> && requires { Row::gradient(args...); })
        return Row::gradient(args...);
    else if constexpr (std::is_same_v<V, Interval> && requires { Row::interval(args...); })
        return Row::interval(args...);
    else
        return Row::apply(args...);
}

/// Makes new operands of those that change from point to point: else the compiler would compute what hangs on the
/// others once for all.
template <class Row, class V>
inline void renew(V* args) {
    if constexpr (requires { Row::varyingOperands; }) {
        for (size_t k = 0; k < Row::varyingOperands; ++k) opaque(args[k]);
    } else {
        opaque(args[0]);
    }
}

/// Seconds of one run of `body`, the least of a few tries.
template <class Body>
double leastOf(Body&& body) {
    double best = 1e30;
    for (int t = 0, rounds = 64; t < tries; ++t) {
        const double start = secondsNow();
        for (int i = 0; i < rounds; ++i) body();
        const double seconds = secondsNow() - start;
        best = seconds / rounds < best ? seconds / rounds : best;
        if (seconds < trySeconds) rounds *= 8, --t;
    }
    return best;
}

/// Of one vector of a row whose operands are numbers but for the point: two run side by side, as in the kernels.
template <class Row, bool gradient>
double measuredByNumbers(const eval::Operation& operation) {
    using Two = eval::Pair<Float>;
    Two args[Row::varyingOperands];
    float plain[mostOperands];
    for (uint32_t i = 0; i < operation.count; ++i) plain[i] = number<float>(0.25f + 0.01f * static_cast<float>(i));
    for (size_t i = 0; i < Row::varyingOperands; ++i) args[i] = Two(plain[i]);
    const typename Row::template Numbers<float> numbers(std::span<const float>(plain, operation.count), operation.data);
    double seconds = 0;
    Row::visitPath(
        numbers.form, [&]<auto path>() {
            seconds = leastOf([&] {
                for (int c = 0; c < chains; ++c) {
                    renew<Row>(args);
                    if constexpr (gradient) {
                        eval::Dual<Two> at[Row::varyingOperands];
                        for (size_t k = 0; k < Row::varyingOperands; ++k)
                            at[k] = {args[k], Two(0.5f), Two(0.25f), Two(0.125f)};
                        auto out = Row::template evalUniform<path>(at, numbers);
                        opaque(out);
                    } else {
                        Two out = Row::template evalUniform<path>(args, numbers);
                        opaque(out);
                    }
                }
            });
        });
    return seconds / (2 * chains);
}

template <class Row, class V>
double measured([[maybe_unused]] const eval::Operation& operation) {
    if constexpr (Row::arity == field::ops::leaf) {
        return 0;
    } else if constexpr (!std::is_same_v<V, Interval> && requires { sizeof(typename Row::template Numbers<float>); }) {
        return measuredByNumbers<Row, std::is_same_v<V, Dual>>(operation);
    } else if constexpr (Row::arity == field::ops::variadic) {
        const uint32_t n = operation.count < mostOperands ? operation.count : mostOperands;
        V args[mostOperands];
        for (uint32_t i = 0; i < n; ++i) args[i] = number<V>(0.25f + 0.01f * static_cast<float>(i));
        const double seconds = leastOf([&] {
            for (int c = 0; c < chains; ++c) {
                renew<Row>(args);
                V out = call<Row, V>(std::span<const V>(args, n), dataOf<Row>(operation));
                opaque(out);
            }
        });
        return seconds / chains * operation.count / n;
    } else {
        V a[chains], b = number<V>(0.75f);
        for (int c = 0; c < chains; ++c) a[c] = number<V>(0.5f + 0.01f * static_cast<float>(c));
        return leastOf([&] {
                   for (V& v : a) {
                       opaque(v);
                       V out = v;
                       if constexpr (Row::arity == 1)
                           out = call<Row, V>(v);
                       else
                           out = call<Row, V>(v, b);
                       opaque(out);
                   }
               }) /
               chains;
    }
}

}  // namespace

namespace SGM_ISA {
double secondsPerPoint(const eval::Operation& operation) {
    const double vector = field::visitOp(operation.op, [&]<class Row>() {
        switch (operation.asked) {
            case eval::EvaluationKind::Gradient:
                return measured<Row, Dual>(operation);
            case eval::EvaluationKind::Range:
                return measured<Row, Interval>(operation);
            case eval::EvaluationKind::Value:
                break;
        }
        return measured<Row, Float>(operation);
    });
    return vector / static_cast<double>(Float::size);
}
}  // namespace SGM_ISA

}  // namespace sgm::bench
