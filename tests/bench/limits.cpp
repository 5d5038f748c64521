#include "tests/bench/limits.h"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include <algorithm>
#include <cstring>
#include <memory>
#include <vector>

#include "modeler/core/parallel.h"
#include "modeler/eval/evaluate.h"

namespace sgm::bench {
namespace {

constexpr int rounds = 2'000'000;
constexpr int chains = 12;  ///< independent sums: more than latency times the units of any machine of today
constexpr int tries = 5;
constexpr size_t bytesAThread = size_t{128} << 20;

/// Runs rounds · chains fused operations and returns a number that depends on all of them; sets `lanes`.
using FusedLoop = float (*)(int& lanes);

#if defined(__x86_64__)
// Alike but for the vector's type: an instruction set belongs to a whole function.
__attribute__((target("avx512f"))) float fusedAvx512(int& lanes) {
    __m512 sum[chains];
    for (__m512& s : sum) s = _mm512_set1_ps(1);
    const __m512 factor = _mm512_set1_ps(0.999f), summand = _mm512_set1_ps(0.001f);
    for (int i = 0; i < rounds; ++i)
        for (__m512& s : sum) s = _mm512_fmadd_ps(s, factor, summand);
    for (const __m512& s : sum) sum[0] = _mm512_add_ps(sum[0], s);
    lanes = 16;
    return _mm512_cvtss_f32(sum[0]);
}
__attribute__((target("avx2,fma"))) float fusedAvx2(int& lanes) {
    __m256 sum[chains];
    for (__m256& s : sum) s = _mm256_set1_ps(1);
    const __m256 factor = _mm256_set1_ps(0.999f), summand = _mm256_set1_ps(0.001f);
    for (int i = 0; i < rounds; ++i)
        for (__m256& s : sum) s = _mm256_fmadd_ps(s, factor, summand);
    for (const __m256& s : sum) sum[0] = _mm256_add_ps(sum[0], s);
    lanes = 8;
    return _mm256_cvtss_f32(sum[0]);
}
#endif

float fusedPortable(int& lanes) {
    constexpr int width = 4;
    float sum[chains * width];
    std::fill(std::begin(sum), std::end(sum), 1.0f);
    for (int i = 0; i < rounds; ++i)
        for (float& s : sum) s = s * 0.999f + 0.001f;
    lanes = width;
    return *std::max_element(std::begin(sum), std::end(sum));
}

FusedLoop fusedLoop() {
#if defined(__x86_64__)
    if (eval::bestIsa() == eval::Isa::Avx512) return fusedAvx512;
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return fusedAvx2;
#endif
    return fusedPortable;
}

/// Least seconds of a few tries of body(thread) on all threads.
template <class Body>
double bestSeconds(Running running, Body&& body) {
    double best = 1e30;
    for (int t = 0; t < tries; ++t) {
        const Stopwatch watch(running);
        parallelFor(static_cast<size_t>(running.threads), running.threads, nullptr,
                    [&](size_t thread, int) { body(thread); });
        best = std::min(best, watch.seconds());
    }
    return best;
}

double fusedGflops(Running running) {
    std::vector<float> results(static_cast<size_t>(running.threads));
    std::vector<int> lanes(results.size());
    const FusedLoop loop = fusedLoop();
    const double seconds = bestSeconds(running, [&](size_t t) { results[t] = loop(lanes[t]); });
    // Reading the results keeps the loops from being dropped.
    const bool sane = std::all_of(results.begin(), results.end(), [](float r) { return r > 0; });
    return sane ? 2e-9 * rounds * chains * lanes[0] * running.threads / seconds : 0;
}

}  // namespace

std::string_view instructionSet() {
    switch (eval::bestIsa()) {
        case eval::Isa::Avx512:
            return "AVX-512";
        case eval::Isa::Avx2:
            return "AVX2";
        default:
            return "portable";
    }
}

Limits measureLimits(Running running) {
    const int n = running.threads;
    std::vector<std::unique_ptr<char[]>> from(static_cast<size_t>(n)), to(from.size());
    const auto fresh = [&](size_t t) {
        to[t].reset(new char[bytesAThread]);
        std::memset(to[t].get(), 1, bytesAThread);
    };
    const double freshSeconds = bestSeconds(running, fresh);
    for (auto& f : from) f = std::make_unique<char[]>(bytesAThread);
    const double writeSeconds = bestSeconds(running, [&](size_t t) { std::memset(to[t].get(), 2, bytesAThread); });
    const double copySeconds =
        bestSeconds(running, [&](size_t t) { std::memcpy(to[t].get(), from[t].get(), bytesAThread); });
    const double gigabytes = 1e-9 * static_cast<double>(bytesAThread) * n;
    return {fusedGflops(running), gigabytes / writeSeconds, gigabytes / freshSeconds, gigabytes / copySeconds};
}

}  // namespace sgm::bench
