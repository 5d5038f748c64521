// Which vectors a source may use that is compiled once for each instruction set (sgm_per_instruction_set).
// Enters: the compiler's options. Leaves: the xsimd name of their widest vectors. Assumes that what is made with it
// stays in the source's unnamed namespace, for it is another type in each of them.
#pragma once

#include <xsimd/xsimd.hpp>

namespace sgm::eval {

#if defined(__AVX512BW__)
using SourceArch = xsimd::avx512bw;
#elif defined(__AVX2__)
using SourceArch = xsimd::avx2;
#else
using SourceArch = xsimd::default_arch;
#endif

}  // namespace sgm::eval
