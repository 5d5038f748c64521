#include "cli/memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

namespace sgm::cli {
namespace {

namespace fs = std::filesystem;
constexpr uint64_t unlimited = std::numeric_limits<uint64_t>::max();

/// The number in a file; `unlimited` where there is none, as in "max".
uint64_t numberIn(const fs::path& file) {
    uint64_t number = 0;
    return std::ifstream(file) >> number ? number : unlimited;
}

/// The least limit of a group and those that hold it.
uint64_t limitOfGroup(const fs::path& root, const std::string& group, const char* file) {
    uint64_t least = unlimited;
    for (fs::path at = fs::path(group).relative_path();; at = at.parent_path()) {
        least = std::min(least, numberIn(root / at / file));
        if (at.empty()) return least;
    }
}

/// Of both versions of control groups, as /proc/self/cgroup names them: "0::/a/b" and "5:memory:/a/b".
uint64_t limitOfGroups() {
    uint64_t least = unlimited;
    std::ifstream list("/proc/self/cgroup");
    for (std::string line; std::getline(list, line);) {
        const size_t first = line.find(':'), second = line.find(':', first + 1);
        if (first == std::string::npos || second == std::string::npos) continue;
        const std::string controllers = "," + line.substr(first + 1, second - first - 1) + ",",
                          group = line.substr(second + 1);
        if (controllers == ",,") least = std::min(least, limitOfGroup("/sys/fs/cgroup", group, "memory.max"));
        if (controllers.find(",memory,") != std::string::npos)
            least = std::min(least, limitOfGroup("/sys/fs/cgroup/memory", group, "memory.limit_in_bytes"));
    }
    return least;
}

}  // namespace

uint64_t usualMemory_bytes() {
    const long pages = sysconf(_SC_PHYS_PAGES), page_bytes = sysconf(_SC_PAGESIZE);
    const uint64_t machine =
        pages > 0 && page_bytes > 0 ? static_cast<uint64_t>(pages) * static_cast<uint64_t>(page_bytes) : unlimited;
    const uint64_t allowed = std::min(machine, limitOfGroups());
    return allowed == unlimited ? 0 : allowed / 4 * 3;
}

void limitMemory(uint64_t bytes) {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // these map far more than they use
    rlimit limit{};
    if (bytes == 0 || getrlimit(RLIMIT_DATA, &limit) != 0 || limit.rlim_cur <= bytes) return;
    limit.rlim_cur = bytes;
    setrlimit(RLIMIT_DATA, &limit);
#else
    static_cast<void>(bytes);
#endif
}

void reserveStack() {
    constexpr size_t enough = 1 << 20, page = 4096;
    [[maybe_unused]] volatile char stack[enough];
    for (size_t i = 0; i < enough; i += page) stack[enough - 1 - i] = 0;
}

}  // namespace sgm::cli
