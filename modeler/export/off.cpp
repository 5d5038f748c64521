// OFF, the Object File Format of Geomview (Rowan, 1991): positions and triangles as text.
#include <fmt/format.h>

#include "modeler/export/lists.h"

namespace sgm::exporter {
namespace {

class Off : public Lists {
public:
    explicit Off(const ExportInput& input) : place_(placementOf(input)) {}

    // Comments would be allowed here, but not every reader skips them.
    void header(OutFile& out, uint64_t vertices, uint64_t triangles) const override {
        out.text(fmt::format("OFF\n{} {} 0\n", vertices, triangles));
    }
    void vertices(OutFile& out, const mesh::Chunk& chunk) const override {
        for (const Vec3f& p : chunk.positions) {
            if (out.failed()) break;
            out.numbers(place_.position(p), " ");
            out.text("\n");
        }
    }
    void triangles(OutFile& out, const mesh::Chunk& chunk) const override {
        for (const mesh::Triangle t : chunk.triangles) {
            if (out.failed()) break;
            out.text("3 ");
            out.numbers(chunk.inMesh(t), " ");
            out.text("\n");
        }
    }

private:
    const Placement place_;
};

}  // namespace

static Status writeOff(const ExportInput& input, const Path& temporary, const Path& target) {
    return writeLists(Off(input), input, temporary, target);
}

static Status streamOff(const ExportInput& input, const ChunkSource& chunks, const Path& temporary,
                        const Path& target) {
    return streamLists(Off(input), input, chunks, temporary, target);
}

static constexpr ExportOption offOptions[] = {upOption, unitOption};

constinit const Exporter offFormat{
    .extension = ".off",
    .doc = "OFF: positions and triangles as text",
    .options = offOptions,
    .takesPositionsOnly = saysPositionsOnly,
    .write = writeOff,
    .stream = streamOff,
};

}  // namespace sgm::exporter
