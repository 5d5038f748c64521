#include "modeler/core/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <system_error>

namespace sgm {
namespace fs = std::filesystem;
namespace {

/// A file that is removed at the end of its scope, unless it was renamed away.
class Temporary {
public:
    /// Creates an empty file in `folder` under a name nobody else has; errno says why when path() stays empty.
    explicit Temporary(const fs::path& folder) {
        static std::atomic<unsigned> serial{0};  // only so that names differ within a process
        for (int attempt = 0; attempt < 1000; ++attempt) {
            const fs::path path = folder / fmt::format(".sgm-{}-{}.tmp", getpid(), serial++);
            const int fd = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
            if (fd >= 0) {
                close(fd);
                path_ = path;
                return;
            }
            if (errno != EEXIST) return;
        }
    }
    ~Temporary() {
        if (!path_.empty()) unlink(path_.c_str());
    }
    Temporary(const Temporary&) = delete;
    Temporary& operator=(const Temporary&) = delete;

    const fs::path& path() const { return path_; }
    void release() { path_.clear(); }

private:
    fs::path path_;
};

/// Forces a file's content, or a folder's entries, to the disk. Returns 0 or an error number.
int flushToDisk(const fs::path& path) {
    const int fd = open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (fd < 0) return errno;
    const int error = fsync(fd) == 0 ? 0 : errno;
    close(fd);
    return error;
}

/// Where the bytes go: behind symbolic links, so that a link stays a link.
fs::path resolved(const fs::path& target) {
    std::error_code ignored;
    fs::path path = target;
    for (int links = 0; links < 40 && fs::is_symlink(path, ignored); ++links)  // as many as Linux follows
        path = path.parent_path() / fs::read_symlink(path, ignored);           // also one that leads nowhere yet
    return path;
}

}  // namespace

Error writeError(const fs::path& path, const std::string& cause) {
    return {Error::Kind::Input, fmt::format("cannot write '{}': {}", path.string(), cause)};
}

Error writeError(const fs::path& path, int errorNumber) {
    return writeError(path, std::generic_category().message(errorNumber));
}

Status replaceFile(const fs::path& target, const std::function<Status(const fs::path&)>& fill) {
    const fs::path path = resolved(target);
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    std::error_code error;
    if (!fs::is_directory(folder, error))
        return writeError(target, fmt::format("there is no folder '{}'", folder.string()));
    struct stat old {};
    const bool replaces = stat(path.c_str(), &old) == 0;
    if (replaces && !S_ISREG(old.st_mode)) return writeError(target, "it is not a regular file");

    Temporary temporary(folder);
    if (temporary.path().empty()) return writeError(target, errno);
    if (Status status = fill(temporary.path()); !status.ok()) return status;
    if (replaces && chmod(temporary.path().c_str(), old.st_mode & 07777) != 0) return writeError(target, errno);
    if (const int e = flushToDisk(temporary.path())) return writeError(target, e);
    if (rename(temporary.path().c_str(), path.c_str()) != 0) return writeError(target, errno);
    temporary.release();
    flushToDisk(folder);  // some file systems can't; the rename stands all the same
    return Done{};
}

}  // namespace sgm
