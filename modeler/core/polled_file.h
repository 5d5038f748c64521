// A stream buffer on a file, for libraries that write to a std::ostream and can't be asked to stop.
// Enters: a stream's bytes. Leaves: the file. Once the watcher cancels it takes no more, as on a full disk, and the
// stream goes bad. Assumes that whoever sees that asks `cancelled` for the reason.
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "modeler/core/progress.h"

namespace sgm {

class PolledFile : public std::filebuf {
public:
    /// Truncates `path` and opens it for writing and reading; is_open() tells whether that went well.
    PolledFile(const std::filesystem::path& path, const Progress* progress) : progress_(progress) {
        open(path, std::ios::in | std::ios::out | std::ios::binary | std::ios::trunc);
    }

protected:
    std::streamsize xsputn(const char* bytes, std::streamsize n) override {
        constexpr std::streamsize most = 1 << 20;  // at a time
        std::streamsize done = 0;
        while (done < n && !cancelled(progress_)) {
            const std::streamsize part = std::min(most, n - done);
            const std::streamsize taken = std::filebuf::xsputn(bytes + done, part);
            done += taken;
            if (taken != part) break;
        }
        return done;
    }

private:
    const Progress* progress_;
};

}  // namespace sgm
