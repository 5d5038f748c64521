// .vdb files: written with offsets, so that readers may load a part; the same bytes for the same volume.
#include <fmt/format.h>
#include <openvdb/io/Archive.h>
#include <openvdb/io/Stream.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "modeler/core/atomic_file.h"
#include "modeler/core/polled_file.h"
#include "modeler/core/random.h"
#include "modeler/volume/volume_impl.h"

namespace sgm::volume {
namespace {

/// OpenVDB's own file writer doesn't report a full disk; this one writes to our checked stream.
struct StreamArchive : openvdb::io::Archive {
    void writeTo(std::ostream& out, const openvdb::GridCPtrVec& grids, const openvdb::MetaMap& meta) const {
        Archive::write(out, grids, true, meta);
    }
};

// Magic number, three version numbers and the flag for offsets come first, then the tag: a UUID in text.
constexpr std::streamoff tagOffset = 8 + 3 * 4 + 1;
constexpr std::streamoff tagLength = 36;

/// Replaces the random tag in the header, which identifies the content to readers, by one made from the content.
void setTag(std::iostream& file, const Progress* progress) {
    std::vector<char> buffer(size_t{1} << 20);
    uint64_t a = 1, b = 2;
    file.seekg(tagOffset + tagLength);
    while (file && !cancelled(progress)) {
        file.read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
        if (file.gcount() == 0) break;
        const uint64_t part = hashText({buffer.data(), static_cast<size_t>(file.gcount())});
        a = combine(a, part);
        b = combine(b, part);
    }
    file.clear();
    const std::string hex = fmt::format("{:016x}{:016x}", a, b);
    file.seekp(tagOffset);
    file << fmt::format("{}-{}-{}-{}-{}", hex.substr(0, 8), hex.substr(8, 4), hex.substr(12, 4), hex.substr(16, 4),
                        hex.substr(20));
}

}  // namespace

Status fillVdb(const std::vector<NamedVolume>& volumes, const std::filesystem::path& file,
               const std::filesystem::path& target, const VdbOptions& options, const Progress* progress) {
    openvdb::initialize();
    openvdb::GridCPtrVec grids;
    for (const NamedVolume& v : volumes) {
        const openvdb::GridBase::Ptr grid = v.volume.impl().grid->copyGrid();  // shares the voxels
        grid->setName(v.name);
        grid->setCreator("sgm");
        grid->setSaveFloatAsHalf(options.half);
        grids.push_back(grid);
    }
    openvdb::MetaMap meta;
    for (const auto& [key, value] : options.metadata) meta.insertMeta(key, openvdb::StringMetadata(value));
    errno = 0;
    try {
        PolledFile buffer(file, progress);
        std::iostream out(&buffer);
        out.exceptions(std::ios::badbit | std::ios::failbit);  // OpenVDB itself doesn't ask how a write went
        StreamArchive().writeTo(out, grids, meta);
        out.exceptions(std::ios::goodbit);
        setTag(out, progress);
        if (!buffer.close()) out.setstate(std::ios::badbit);
        if (cancelled(progress)) return cancelledError();
        if (!out) return writeError(target, errno != 0 ? errno : EIO);
    } catch (const std::ios_base::failure&) {
        if (cancelled(progress)) return cancelledError();
        return writeError(target, errno != 0 ? errno : EIO);
    } catch (const std::bad_alloc&) {
        return Error{Error::Kind::Budget, fmt::format("cannot write '{}': out of memory", target.string())};
    } catch (const std::exception& e) {
        return writeError(target, e.what());
    }
    return Done{};
}

Status writeVdb(const Volume& volume, const std::filesystem::path& path, const std::string& name,
                const VdbOptions& options) {
    return replaceFile(path, [&](const std::filesystem::path& temporary) {
        return fillVdb({{volume, name}}, temporary, path, options);
    });
}

Result<Volume> readVdb(const std::filesystem::path& path, const std::string& name) {
    openvdb::initialize();
    const auto failed = [&](const std::string& cause) {
        return Error{Error::Kind::Input, fmt::format("cannot read '{}': {}", path.string(), cause)};
    };
    try {
        // A stream that throws at its end: openvdb::io::File would take a cut file's missing sizes as they come.
        std::ifstream in(path, std::ios::binary);
        if (!in) return failed(std::strerror(errno));
        in.exceptions(std::ios::failbit | std::ios::badbit);
        openvdb::io::Stream stream(in, false);  // all at once: the file may be replaced while the volume lives
        for (const openvdb::GridBase::Ptr& grid : *stream.getGrids())
            if (const auto floats = openvdb::gridPtrCast<openvdb::FloatGrid>(grid);
                floats && (name.empty() || grid->getName() == name))
                return Volume(std::make_shared<Volume::Impl>(Volume::Impl{floats}));
    } catch (const std::bad_alloc&) {
        return Error{Error::Kind::Budget, fmt::format("cannot read '{}': out of memory", path.string())};
    } catch (const std::exception& e) {
        return failed(e.what());
    }
    return failed(name.empty() ? "it holds no grid of floats"
                               : fmt::format("it holds no grid of floats called '{}'", name));
}

}  // namespace sgm::volume
