// The mesh formats, a function each.
// Enters: all bytes of a file, which may be anything. Leaves: triangles whose corners may still be out of range, which
// readMesh checks for all formats; or an error that says what is wrong and on which line, without the file's name and
// without its content. Assumes less than 4 GiB.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "modeler/core/progress.h"
#include "modeler/core/result.h"
#include "modeler/mesh/triangle_soup.h"

namespace sgm::mesh {

/// Wavefront OBJ: `v` and `f`; everything else is skipped, material libraries too (Wavefront, Advanced Visualizer
/// Manual, appendix B).
Status readObj(std::string_view bytes, TriangleSoup& soup, const Progress* progress);
/// PLY, ascii and binary of either byte order (Turk, "The PLY Polygon File Format", 1994).
Status readPly(std::string_view bytes, TriangleSoup& soup, const Progress* progress);
/// STL, ascii and binary (3D Systems, "StereoLithography Interface Specification", 1988).
Status readStl(std::string_view bytes, TriangleSoup& soup, const Progress* progress);
/// Ascii OFF with any of its prefixes but 4 and n (Geomview manual, "OFF Files").
Status readOff(std::string_view bytes, TriangleSoup& soup, const Progress* progress);

/// Reads a file that lies beside the one that names it; the error is the cause alone.
using ReadBeside = std::function<Result<std::string>(const std::string& name)>;
/// glTF 2.0, .gltf and .glb: the triangles of the scene that is shown, where its nodes put them. Compressed and sparse
/// data are refused. `beside` gives the buffers that the file names.
Status readGltf(std::string_view bytes, const ReadBeside& beside, TriangleSoup& soup, const Progress* progress);

/// What holds for every format: there are triangles, not too many, with finite corners that are in range. The error is
/// without the file's name.
Status checkSoup(const TriangleSoup& soup);

/// "is damaged, line 12: …", or without the line where it is 0.
Error damaged(uint64_t line, std::string_view why);

/// Cuts a polygon into a fan while its corners come one after the other, so that a list of any length takes no memory.
class PolygonFan {
public:
    explicit PolygonFan(TriangleSoup& soup) : soup_(soup) {}
    void add(uint32_t corner) {
        if (corners_ == 0) first_ = corner;
        if (corners_ >= 2) soup_.triangles.push_back({first_, last_, corner});
        last_ = corner;
        ++corners_;
    }

private:
    TriangleSoup& soup_;
    uint64_t corners_ = 0;
    uint32_t first_ = 0, last_ = 0;
};

}  // namespace sgm::mesh
