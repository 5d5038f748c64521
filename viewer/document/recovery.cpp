#include "viewer/document/recovery.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstdlib>

#include "modeler/core/atomic_file.h"
#include "modeler/core/guarded.h"
#include "modeler/core/regular_file.h"

namespace sgm::document {
namespace fs = std::filesystem;
namespace {

// A recovery file is "sgm-recovery BYTES\n", that many bytes of the document's path, and the text. NAME.recovery is
// locked through NAME.lock, which stays while the file is replaced again and again.
constexpr std::string_view magic = "sgm-recovery ", ending = ".recovery", lockEnding = ".lock";

/// Opens and locks a file; −1 where it can't be had or another process holds it.
int lockFile(const fs::path& path, int flags) {
    const int fd = open(path.c_str(), flags | O_RDWR | O_CLOEXEC, 0600);
    if (fd < 0 || flock(fd, LOCK_EX | LOCK_NB) == 0) return fd;
    close(fd);
    return -1;
}

fs::path lockOf(fs::path kept) { return kept.replace_extension(lockEnding); }

/// Nobody alive holds the file's lock.
bool isAbandoned(const fs::path& kept) {
    if (std::error_code ignored; !fs::exists(lockOf(kept), ignored)) return true;
    const int fd = lockFile(lockOf(kept), 0);
    if (fd < 0) return false;
    close(fd);
    return true;
}

/// Removes a lock that guards nothing and that nobody holds: its process was ended before it had unsaved work.
void removeIdleLock(const fs::path& lock) {
    using namespace std::chrono_literals;
    std::error_code failed;
    fs::path kept = lock;
    if (fs::exists(kept.replace_extension(ending), failed)) return;
    if (fs::file_time_type::clock::now() - fs::last_write_time(lock, failed) < 1min || failed)
        return;  // about to be taken
    const int fd = lockFile(lock, O_NOFOLLOW);
    if (fd < 0) return;
    fs::remove(lock, failed);
    close(fd);
}

std::optional<Abandoned> read(const fs::path& kept) {
    constexpr uint64_t most_bytes = 256u << 20;  // more than any document that could be opened
    const auto bytes = readRegularFile(kept, most_bytes);
    if (!bytes.ok()) return std::nullopt;
    std::string_view text = *bytes;
    if (!text.starts_with(magic)) return std::nullopt;
    text.remove_prefix(magic.size());
    size_t length = 0;
    const auto [end, bad] = std::from_chars(text.data(), text.data() + text.size(), length);
    if (bad != std::errc() || end == text.data() + text.size() || *end != '\n') return std::nullopt;
    text.remove_prefix(static_cast<size_t>(end - text.data()) + 1);
    if (length > text.size()) return std::nullopt;
    std::error_code ignored;
    return Abandoned{kept, std::string(text.substr(0, length)), std::string(text.substr(length)),
                     fs::last_write_time(kept, ignored)};
}

}  // namespace

fs::path recoveryFolder() {
    if (const char* state = std::getenv("XDG_STATE_HOME"); state && fs::path(state).is_absolute())
        return fs::path(state) / "sgm";
    const char* home = std::getenv("HOME");
    return fs::path(home && *home ? home : ".") / ".local/state/sgm";
}

std::vector<Abandoned> abandonedWork(const fs::path& folder) {
    std::vector<Abandoned> found;
    std::error_code failed;
    for (fs::directory_iterator entry(folder, failed), end; !failed && entry != end; entry.increment(failed)) {
        if (entry->path().extension() == lockEnding) removeIdleLock(entry->path());
        if (entry->path().extension() != ending || !isAbandoned(entry->path())) continue;
        if (auto work = read(entry->path())) found.push_back(std::move(*work));
    }
    std::sort(found.begin(), found.end(), [](const Abandoned& a, const Abandoned& b) {
        return a.time != b.time ? a.time > b.time : a.kept < b.kept;
    });
    return found;
}

void discard(const Abandoned& work) {
    std::error_code ignored;
    fs::remove(work.kept, ignored);
    fs::remove(lockOf(work.kept), ignored);
}

Recovery::Recovery(fs::path folder) : folder_(std::move(folder)), thread_([this] { run(); }) {}

Recovery::~Recovery() {
    {
        const std::lock_guard lock(mutex_);
        quit_ = true;
        next_ = Work{};
    }
    changed_.notify_all();
    thread_.join();
    if (lock_ >= 0) {
        std::error_code ignored;
        fs::remove(lockOf(file_), ignored);
        close(lock_);
    }
}

void Recovery::keep(const Document& document) {
    const bool dirty = document.dirty();
    std::unique_lock lock(mutex_);
    if (document.revision() == seen_ && dirty == seenDirty_ && last_.ok()) return;
    seen_ = document.revision();
    seenDirty_ = dirty;
    std::error_code ignored;
    const fs::path path = document.path().empty() ? fs::path() : fs::absolute(document.path(), ignored);
    next_ = Work{path.string(), document.text(), dirty};
    lock.unlock();
    changed_.notify_all();
}

Status Recovery::flush() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return !next_ && !busy_; });
    return last_;
}

void Recovery::run() {
    std::unique_lock lock(mutex_);
    for (;;) {
        changed_.wait(lock, [this] { return next_ || quit_; });
        if (!next_) return;
        const Work work = *std::exchange(next_, std::nullopt);
        busy_ = true;
        lock.unlock();
        Status done = guarded([&] { return write(work); });
        lock.lock();
        last_ = std::move(done);
        busy_ = false;
        changed_.notify_all();
    }
}

/// Takes a name and its lock at the first unsaved text; later texts replace the file.
Status Recovery::write(const Work& work) {
    std::error_code failed;
    if (!work.unsaved) {
        if (lock_ >= 0) fs::remove(file_, failed);
        return Done{};
    }
    if (lock_ < 0) {
        fs::create_directories(folder_, failed);
        if (failed) return writeError(folder_, failed.message());
        for (int serial = 0; lock_ < 0; ++serial) {
            file_ = folder_ / fmt::format("{}-{}{}", getpid(), serial, ending);
            if (fs::exists(file_, failed)) continue;
            lock_ = lockFile(lockOf(file_), O_CREAT | O_EXCL);
            if (lock_ < 0 && errno != EEXIST) return writeError(lockOf(file_), errno);
        }
    }
    return writeFile(file_, fmt::format("{}{}\n{}{}", magic, work.document.size(), work.document, work.text));
}

}  // namespace sgm::document
