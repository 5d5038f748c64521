// A model packed for the page that shows it (page/data.js reads it).
// Enters: a mesh with its provenance. Leaves: bytes. Assumes what `write` has checked.
//
// A number of 32 bits, the length of the JSON; the JSON: names, materials, groups (the objects, or the symbols of the
// shapes), parts, and patches of triangles of one group and material, each with runs of one part. Then, over the
// vertices of all patches, positions in steps of 16 bits from `origin` (x, y, z: each as differences from the vertex
// before, zigzag, low bytes and then high bytes), normals (octahedral, 8 bits, likewise), and for each corner how far
// its vertex lies behind the next new one of its patch, in 7 bits a byte. Where materials have textures: for each
// vertex the difference of its chart from the one before, zigzag, in 7 bits a byte, and the pictures' files.
#pragma once

#include <cstdint>
#include <vector>

#include "modeler/export/exporter.h"

namespace sgm::exporter {

/// The model's bytes, compressed (RFC 1951). Error::Cancelled when the progress says so, Error::Budget where zlib gets
/// no memory.
Result<std::vector<uint8_t>> packPage(const ExportInput& input);

}  // namespace sgm::exporter
