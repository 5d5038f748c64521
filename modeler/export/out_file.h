// A file written front to back through one large buffer.
// Enters: bytes, text and numbers. Leaves: the file, or the first error; a cancelled progress is one. Assumes a
// little-endian machine, as every format here is little-endian.
#pragma once

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <type_traits>
#include <vector>

#include "modeler/core/progress.h"
#include "modeler/core/result.h"
#include "modeler/core/vec.h"

namespace sgm::exporter {

static_assert(std::endian::native == std::endian::little);

/// Keeps the first error and ignores all later writes, so that a writer asks once, at `finish`.
class OutFile {
public:
    /// Truncates `path`; `target` is the name that error messages use. `progress` is asked at every flush whether to go
    /// on.
    OutFile(const std::filesystem::path& path, std::filesystem::path target, const Progress* progress);
    /// A file without a name in the folder of `target`, for what is appended to another one later.
    OutFile(std::filesystem::path target, const Progress* progress);
    ~OutFile();
    OutFile(const OutFile&) = delete;
    OutFile& operator=(const OutFile&) = delete;

    void bytes(const void* data, size_t size);
    void text(std::string_view s) { bytes(s.data(), s.size()); }
    /// The values' own bytes, one after the other.
    template <class... T>
    void raw(const T&... values) {
        static_assert((std::is_trivially_copyable_v<T> && ...));
        constexpr size_t size = (sizeof(T) + ...);
        static_assert(size <= rowRoom);
        char* to = buffer_.data() + used_;
        ((std::memcpy(to, &values, sizeof values), to += sizeof values), ...);
        used_ += size;
        if (used_ >= blockBytes) writeBlock();
    }
    /// `count` rows of `size` bytes, each written by row(i, to), one after the other; a row may write up to `rowRoom`
    /// bytes, of which the next one takes those beyond `size`.
    template <size_t size, class Row>
    void rows(size_t count, Row row) {
        static_assert(size <= rowRoom);
        for (size_t i = 0; i < count && !failed();) {
            const size_t end = std::min(count, i + (blockBytes - used_ + size - 1) / size);
            char* to = buffer_.data() + used_;
            used_ += (end - i) * size;
            for (; i < end; ++i, to += size) row(i, to);
            if (used_ >= blockBytes) writeBlock();
        }
    }
    /// The shortest decimal text that reads back as the same number.
    template <class T>
    void number(T value) {
        char digits[32];
        const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
        bytes(digits, static_cast<size_t>(end - digits));
    }
    /// Three numbers with `separator` between them.
    template <class T>
    void numbers(Vec3<T> v, std::string_view separator) {
        number(v.x);
        text(separator);
        number(v.y);
        text(separator);
        number(v.z);
    }
    /// All that was written to `part` so far, and its error.
    void append(OutFile& part);
    /// Writes over bytes that are there already.
    void patch(uint64_t at, const void* data, size_t size);
    /// True once nothing more is written, so that a long loop may end early.
    bool failed() const { return error_ != 0 || stopped_; }
    /// Writes what is left and closes. Call it last, once. Error::Cancelled where the progress was.
    Status finish();

private:
    /// What is written at once: a whole number of the file's pages, so that the system takes large ones. Stays in the
    /// second cache until the system has copied it.
    static constexpr size_t blockBytes = size_t{1} << 18;
    /// Beyond the block, for the last row.
    static constexpr size_t rowRoom = 128;

    void flush();
    void writeBlock();
    void write(size_t size);

    std::filesystem::path target_;
    std::vector<char> buffer_ = std::vector<char>(blockBytes + 2 * rowRoom);
    const Progress* progress_;
    size_t used_ = 0;       ///< less than a block between calls
    bool stopped_ = false;  ///< cancelled
    int fd_ = -1;
    int error_ = 0;  ///< errno of the first failure
};

}  // namespace sgm::exporter
