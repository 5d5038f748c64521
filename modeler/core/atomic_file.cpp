#include "modeler/core/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <ctime>
#include <fstream>
#include <mutex>
#include <set>
#include <string_view>
#include <system_error>

namespace sgm {
namespace fs = std::filesystem;
namespace {

/// Names of temporary files: ".sgm-PID-N.tmp".
constexpr std::string_view beginning = ".sgm-", ending = ".tmp";

/// Whether a temporary file was left by a process that is gone: nobody holds its lock, and it isn't so new that its
/// process may still be about to take it.
bool isAbandoned(const fs::path& path) {
    constexpr time_t fresh_s = 60;
    const int fd = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    if (fd < 0) return false;
    struct stat found {};
    const bool old = fstat(fd, &found) == 0 && S_ISREG(found.st_mode) && found.st_mtime + fresh_s < time(nullptr);
    const bool abandoned = old && flock(fd, LOCK_EX | LOCK_NB) == 0;
    close(fd);
    return abandoned;
}

/// Removes what killed processes left in a folder; once a folder in the life of this process, for it may be large.
void removeAbandoned(const fs::path& folder) {
    static std::mutex mutex;
    static std::set<std::string> seen;  // only so that no folder is read twice
    {
        const std::lock_guard lock(mutex);
        if (!seen.insert(folder.string()).second) return;
    }
    std::error_code failed;
    for (fs::directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed)) {
        const std::string name = at->path().filename().string();
        if (name.starts_with(beginning) && name.ends_with(ending) && isAbandoned(at->path()))
            unlink(at->path().c_str());
    }
}

/// A file that is removed at the end of its scope, unless it was renamed away. Its lock tells other processes that it
/// is in use.
class Temporary {
public:
    /// Creates an empty file in `folder` under a name nobody else has; errno says why when path() stays empty.
    explicit Temporary(const fs::path& folder) {
        static std::atomic<unsigned> serial{0};  // only so that names differ within a process
        for (int attempt = 0; attempt < 1000; ++attempt) {
            const fs::path path = folder / fmt::format("{}{}-{}{}", beginning, getpid(), serial++, ending);
            fd_ = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
            if (fd_ >= 0) {
                flock(fd_, LOCK_EX | LOCK_NB);  // some file systems can't; then it is safe for a minute
                path_ = path;
                return;
            }
            if (errno != EEXIST) return;
        }
    }
    ~Temporary() {
        if (!path_.empty()) unlink(path_.c_str());
        if (fd_ >= 0) close(fd_);
    }
    Temporary(const Temporary&) = delete;
    Temporary& operator=(const Temporary&) = delete;

    const fs::path& path() const { return path_; }
    void release() { path_.clear(); }

private:
    fs::path path_;
    int fd_ = -1;
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

fs::path folderOf(const fs::path& path) { return path.has_parent_path() ? path.parent_path() : fs::path("."); }

}  // namespace

Error writeError(const fs::path& path, const std::string& cause) {
    return {Error::Kind::Input, fmt::format("cannot write '{}': {}", path.string(), cause)};
}

Error writeError(const fs::path& path, int errorNumber) {
    return writeError(path, std::generic_category().message(errorNumber));
}

Status checkTarget(const fs::path& target) {
    struct stat old {};
    // Of `target`, for a link of /dev/fd to a pipe leads to no file by its name.
    if (stat(target.c_str(), &old) == 0 && !S_ISREG(old.st_mode)) return writeError(target, "it is not a regular file");
    const fs::path path = resolved(target), folder = folderOf(path);
    std::error_code error;
    if (!fs::is_directory(folder, error))
        return writeError(target, fmt::format("there is no folder '{}'", folder.string()));
    if (access(folder.c_str(), W_OK | X_OK) != 0) return writeError(target, errno);
    return Done{};
}

std::string identityOf(const fs::path& path) {
    const fs::path at = resolved(path);
    struct stat found {};
    if (stat(at.c_str(), &found) == 0) return fmt::format("{}:{}", found.st_dev, found.st_ino);
    std::error_code ignored;
    const fs::path folder = fs::weakly_canonical(folderOf(at), ignored);
    return (folder / at.filename()).string();
}

Status replaceFile(const fs::path& target, const std::function<Status(const fs::path&)>& fill) {
    if (const Status s = checkTarget(target); !s.ok()) return s;
    const fs::path path = resolved(target), folder = folderOf(path);
    struct stat old {};
    const bool replaces = stat(path.c_str(), &old) == 0;

    removeAbandoned(folder);
    Temporary temporary(folder);
    if (temporary.path().empty()) return writeError(target, errno);
    if (Status status = fill(temporary.path()); !status.ok()) return status;
    if (const int e = flushToDisk(temporary.path())) return writeError(target, e);  // while it can still be read
    if (replaces && chmod(temporary.path().c_str(), old.st_mode & 07777) != 0) return writeError(target, errno);
    if (rename(temporary.path().c_str(), path.c_str()) != 0) return writeError(target, errno);
    temporary.release();
    flushToDisk(folder);  // some file systems can't; the rename stands all the same
    return Done{};
}

Status writeFile(const fs::path& path, std::string_view bytes) {
    return replaceFile(path, [&](const fs::path& temporary) -> Status {
        errno = 0;
        std::ofstream out(temporary, std::ios::binary);
        out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        out.close();
        return out ? Status(Done{}) : Status(writeError(path, errno != 0 ? errno : EIO));
    });
}

}  // namespace sgm
