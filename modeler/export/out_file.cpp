#include "modeler/export/out_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <string>

#include "modeler/core/atomic_file.h"

namespace sgm::exporter {

OutFile::OutFile(const std::filesystem::path& path, std::filesystem::path target, const Progress* progress)
    : target_(std::move(target)), progress_(progress) {
    fd_ = open(path.c_str(), O_WRONLY | O_TRUNC | O_CLOEXEC);
    if (fd_ < 0) error_ = errno;
}

OutFile::OutFile(std::filesystem::path target, const Progress* progress)
    : target_(std::move(target)), progress_(progress) {
    const std::filesystem::path folder = target_.has_parent_path() ? target_.parent_path() : ".";
    std::string name = (folder / ".sgm-XXXXXX").string();
    fd_ = mkostemp(name.data(), O_CLOEXEC);
    if (fd_ < 0)
        error_ = errno;
    else
        unlink(name.c_str());
}

OutFile::~OutFile() {
    if (fd_ >= 0) close(fd_);
}

void OutFile::bytes(const void* data, size_t size) {
    const char* from = static_cast<const char*>(data);
    while (size > 0) {
        const size_t n = std::min(size, blockBytes - used_);
        std::memcpy(buffer_.data() + used_, from, n);
        used_ += n;
        from += n;
        size -= n;
        if (used_ == blockBytes) writeBlock();
    }
}

void OutFile::write(size_t size) {
    stopped_ = stopped_ || cancelled(progress_);
    for (size_t done = 0; done < size && !failed();) {
        const ssize_t n = ::write(fd_, buffer_.data() + done, size - done);
        if (n >= 0)
            done += static_cast<size_t>(n);
        else if (errno != EINTR)
            error_ = errno;
    }
}

void OutFile::writeBlock() {
    write(blockBytes);
    used_ -= blockBytes;
    std::memcpy(buffer_.data(), buffer_.data() + blockBytes, used_);
}

void OutFile::flush() {
    write(used_);
    used_ = 0;
}

void OutFile::append(OutFile& part) {
    flush();
    part.flush();
    if (!failed()) error_ = part.error_;
    stopped_ = stopped_ || part.stopped_;
    for (off_t at = 0; !failed();) {
        const ssize_t n = pread(part.fd_, buffer_.data(), blockBytes, at);
        if (n == 0) break;
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) {
            error_ = errno;
            break;
        }
        at += n;
        used_ = static_cast<size_t>(n);
        flush();
    }
}

void OutFile::patch(uint64_t at, const void* data, size_t size) {
    flush();
    const char* from = static_cast<const char*>(data);
    while (size > 0 && !failed()) {
        const ssize_t n = pwrite(fd_, from, size, static_cast<off_t>(at));
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) {
            error_ = errno;
            break;
        }
        from += n;
        at += static_cast<uint64_t>(n);
        size -= static_cast<size_t>(n);
    }
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
