#include "tests/bench/operation_times.h"

#include <chrono>

#include "modeler/eval/evaluate.h"

namespace sgm::bench {

double secondsNow() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double leastSeconds(const eval::Tally& tally) {
    const eval::Isa isa = eval::bestIsa();
    double sum = 0;
    for (const auto& [operation, points] : tally) {
#if defined(SGM_X86_KERNELS)
        const double each = isa == eval::Isa::Avx512 ? avx512::secondsPerPoint(operation)
                            : isa == eval::Isa::Avx2 ? avx2::secondsPerPoint(operation)
                                                     : portable::secondsPerPoint(operation);
#else
        static_cast<void>(isa);
        const double each = portable::secondsPerPoint(operation);
#endif
        sum += each * static_cast<double>(points);
    }
    return sum;
}

}  // namespace sgm::bench
