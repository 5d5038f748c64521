// For the address sanitizer: what packages leave behind is no leak of ours. Mesa's software renderer and LLVM keep some
// memory to the end; OpenVDB drops what it holds when its input ends early.
#ifdef __SANITIZE_ADDRESS__
#include <dlfcn.h>

// Mesa's reports can be told apart only while it stays loaded.
[[maybe_unused]] static void* const driver =
    dlopen("/usr/lib/x86_64-linux-gnu/dri/swrast_dri.so", RTLD_NOW | RTLD_NODELETE);

extern "C" const char* __lsan_default_suppressions() {
    return "leak:swrast_dri\nleak:libLLVM\nleak:bloscFromStream\nleak:openvdb*readTopology\n";
}
#endif
