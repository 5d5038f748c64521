// Finds and loads the module that holds what needs OpenVDB.
#include <dlfcn.h>
#include <sys/mman.h>

#include <mutex>
#include <thread>
#include <vector>

#include "modeler/core/installation.h"
#include "modeler/core/parallel.h"
#include "modeler/volume/plugin_functions.h"

namespace sgm::volume {
namespace {

constexpr const char* moduleName = "sgm_volumes.so";
constexpr size_t moduleBytes = size_t{64} << 20;  ///< of address space, at least what the module and its libraries map
constexpr int loggingThreads = 4;                 ///< log4cplus starts them while it is loaded

/// Whether so many threads can run beside this one. OpenVDB and TBB end the program where they get none.
bool canStart(int threads) {
    std::mutex gate;
    std::vector<std::thread> started;
    gate.lock();
    const auto wait = [&gate] { const std::lock_guard pass(gate); };
    bool all = true;
    try {
        started.reserve(static_cast<size_t>(threads));
        for (int i = 0; i < threads; ++i) started.emplace_back(wait);
    } catch (const std::exception&) {
        all = false;
    }
    gate.unlock();
    for (std::thread& thread : started) thread.join();
    return all;
}

/// Whether the module's libraries, which end the program where they get no threads, can start theirs once it is mapped.
bool canLoad() {
    void* const room = mmap(nullptr, moduleBytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (room == MAP_FAILED) return false;
    const bool can = canStart(threadCount(0) + loggingThreads);
    munmap(room, moduleBytes);
    return can;
}

/// A module that is there but can't be loaded: there is no memory for it, or a library is missing.
Error unloadable(const std::string& why) {
    const bool memory =
        why.find("failed to map") != std::string::npos || why.find("annot allocate") != std::string::npos;
    return {memory ? Error::Kind::Budget : Error::Kind::Internal,
            "volumes: " + why + (memory ? ": out of memory" : "")};
}

/// Lets the module find the functions of the library that holds this one, where a program loaded that for itself alone,
/// as Python loads its modules.
void shareSymbols() {
    Dl_info info{};
    if (dladdr(reinterpret_cast<const void*>(&shareSymbols), &info) != 0 && info.dli_fname)
        dlopen(info.dli_fname, RTLD_NOW | RTLD_NOLOAD | RTLD_GLOBAL);
}

}  // namespace

Result<const PluginFunctions*> loadPlugin() {
    const Error noThreads{Error::Kind::Budget,
                          "volumes: the system gives no more threads: allow more processes (ulimit -u, or the "
                          "container's limit) or memory"};
    if (!canLoad()) return noThreads;
    std::vector<std::filesystem::path> places;
    for (const std::filesystem::path& folder : binaryFolders())
        for (const char* beside : {"", "sgm", "../sgm", "../lib/sgm"}) places.push_back(folder / beside / moduleName);
    for (const auto& path : places) {
        if (!std::filesystem::exists(path)) continue;
        shareSymbols();
        void* const module = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
        const void* const symbol = module ? dlsym(module, "sgm_volume_functions") : nullptr;
        if (!symbol) return unloadable(dlerror());
        const auto* const table = static_cast<const PluginFunctions*>(symbol);
        if (!canStart(threadCount(0))) return noThreads;  // the module took memory
        table->startThreads(threadCount(0));
        return table;
    }
    return Error{Error::Kind::Internal, std::string("volumes: ") + moduleName +
                                            " is not installed: it was built without OpenVDB, or lies " +
                                            "neither beside the program nor in lib/sgm"};
}

}  // namespace sgm::volume
