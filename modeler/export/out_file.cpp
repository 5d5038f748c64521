#include "modeler/export/out_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "modeler/core/atomic_file.h"

namespace sgm::exporter {

OutFile::OutFile(const std::filesystem::path& path, std::filesystem::path target, const Progress* progress)
    : target_(std::move(target)), buffer_(size_t{1} << 20), progress_(progress) {
    fd_ = open(path.c_str(), O_WRONLY | O_TRUNC | O_CLOEXEC);
    if (fd_ < 0) error_ = errno;
}

OutFile::~OutFile() {
    if (fd_ >= 0) close(fd_);
}

void OutFile::bytes(const void* data, size_t size) {
    const char* from = static_cast<const char*>(data);
    while (size > 0) {
        const size_t n = std::min(size, buffer_.size() - used_);
        std::memcpy(buffer_.data() + used_, from, n);
        used_ += n;
        from += n;
        size -= n;
        if (used_ == buffer_.size()) flush();
    }
}

void OutFile::flush() {
    stopped_ = stopped_ || cancelled(progress_);
    for (size_t done = 0; done < used_ && !failed();) {
        const ssize_t n = ::write(fd_, buffer_.data() + done, used_ - done);
        if (n >= 0)
            done += static_cast<size_t>(n);
        else if (errno != EINTR)
            error_ = errno;
    }
    used_ = 0;
}

Status OutFile::finish() {
    flush();
    if (fd_ >= 0 && close(fd_) != 0 && error_ == 0) error_ = errno;
    fd_ = -1;
    if (stopped_) return cancelledError();
    if (error_ != 0) return writeError(target_, error_);
    return Done{};
}

}  // namespace sgm::exporter
