// Formats of a header with two counts, all vertices and then all triangles.
// Enters: how one chunk's lists are written. Leaves: the file, from a whole mesh or from chunks. Assumes that what is
// said of a chunk can be told from it alone.
#pragma once

#include "modeler/export/formats.h"
#include "modeler/export/out_file.h"

namespace sgm::exporter {

/// What differs from format to format.
class Lists {
public:
    virtual ~Lists() = default;
    virtual void header(OutFile& out, uint64_t vertices, uint64_t triangles) const = 0;
    virtual void vertices(OutFile& out, const mesh::Chunk& chunk) const = 0;
    virtual void triangles(OutFile& out, const mesh::Chunk& chunk) const = 0;
};

Status writeLists(const Lists& lists, const ExportInput& input, const Path& temporary, const Path& target);
/// The counts are known at the end only: meanwhile both lists wait in files without a name beside the target.
Status streamLists(const Lists& lists, const ExportInput& input, const ChunkSource& chunks, const Path& temporary,
                   const Path& target);

}  // namespace sgm::exporter
