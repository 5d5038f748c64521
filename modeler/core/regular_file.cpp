#include "modeler/core/regular_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

namespace sgm {
namespace {

Error failed(int errorNumber) { return {Error::Kind::Input, std::generic_category().message(errorNumber)}; }

const char* kindOf(mode_t mode) {
    if (S_ISDIR(mode)) return "a folder";
    if (S_ISFIFO(mode)) return "a pipe";
    if (S_ISSOCK(mode)) return "a socket";
    return "a device";
}

Error tooLarge(uint64_t most_bytes) {
    constexpr uint64_t mebibyte = 1 << 20;
    return {Error::Kind::Budget, fmt::format("it is larger than {} MiB", most_bytes / mebibyte)};
}

/// Closes what it holds.
struct Descriptor {
    int fd;
    ~Descriptor() {
        if (fd >= 0) close(fd);
    }
};

}  // namespace

Result<std::string> readRegularFile(const std::filesystem::path& path, uint64_t most_bytes, const Progress* progress) {
    // Without O_NONBLOCK a pipe would wait here for somebody to write.
    const Descriptor file{open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY)};
    if (file.fd < 0) return failed(errno);
    struct stat found {};
    if (fstat(file.fd, &found) != 0) return failed(errno);
    if (!S_ISREG(found.st_mode))
        return Error{Error::Kind::Input, fmt::format("it is {}, not a file", kindOf(found.st_mode))};
    if (static_cast<uint64_t>(found.st_size) > most_bytes) return tooLarge(most_bytes);

    constexpr size_t step = 1 << 20;
    std::string bytes;
    bytes.reserve(static_cast<size_t>(found.st_size) + 1);
    for (;;) {
        if (cancelled(progress)) return cancelledError();
        const size_t before = bytes.size();
        bytes.resize(std::max(std::min(before + step, bytes.capacity()), before + 1));
        const ssize_t got = ::read(file.fd, bytes.data() + before, bytes.size() - before);
        if (got < 0 && errno != EINTR) return failed(errno);
        bytes.resize(before + static_cast<size_t>(std::max<ssize_t>(got, 0)));
        if (bytes.size() > most_bytes) return tooLarge(most_bytes);  // it grew, or tells no size
        if (got == 0) return bytes;
    }
}

}  // namespace sgm
