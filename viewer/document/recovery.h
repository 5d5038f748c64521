// Unsaved work, kept beside the window so that a crash costs nothing.
// Enters: documents as they change. Leaves: a file a document in the state folder, and after a crash the offer to go
// on. Assumes POSIX: a lock (flock) ends with its process, however that ends, so a living program's work is never
// offered.
#pragma once

#include <condition_variable>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "viewer/document/document.h"

namespace sgm::document {

/// $XDG_STATE_HOME/sgm, else ~/.local/state/sgm (XDG base directories).
std::filesystem::path recoveryFolder();

/// Work that nobody has open any more.
struct Abandoned {
    std::filesystem::path kept;      ///< the recovery file
    std::filesystem::path document;  ///< the file it was about, "" for one without a name
    std::string text;
    std::filesystem::file_time_type time;
};
/// Recovery files whose program is gone, the newest first. Unreadable ones are left alone.
std::vector<Abandoned> abandonedWork(const std::filesystem::path& folder = recoveryFolder());
/// Throws the work away: it was recovered and kept anew, or isn't wanted.
void discard(const Abandoned& work);

/// Keeps one document's unsaved text on disk. Writing is done on a thread of its own, so that the disk never holds the
/// window up; the newest text counts.
class Recovery {
public:
    explicit Recovery(std::filesystem::path folder = recoveryFolder());
    /// Takes the file away: whoever closes a document in good order has saved it or doesn't want it.
    ~Recovery();
    Recovery(const Recovery&) = delete;
    Recovery& operator=(const Recovery&) = delete;

    /// To be called after edits, as often as one likes: writes when the text has changed since, takes the file away
    /// when the document is saved.
    void keep(const Document& document);
    /// Waits until all is on the disk. Error::Input where the last write failed (it is tried again at the next `keep`).
    Status flush();
    /// The file, "" before the first unsaved work. Call `flush` first.
    const std::filesystem::path& file() const { return file_; }

private:
    struct Work {
        std::string document, text;
        bool unsaved = false;
    };
    void run();
    Status write(const Work& work);

    std::filesystem::path folder_, file_;
    int lock_ = -1;  ///< file descriptor of the lock
    uint64_t seen_ = 0;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::optional<Work> next_;
    bool busy_ = false, quit_ = false, seenDirty_ = false;
    Status last_ = Done{};
    std::thread thread_;
};

}  // namespace sgm::document
