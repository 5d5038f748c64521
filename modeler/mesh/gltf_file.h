// What a glTF 2.0 file holds, with every number of it checked before it is used.
// Enters: the bytes of a .glb or .gltf file, which may be anything. Leaves: its JSON, its buffers and elements of its
// accessors. Assumes nothing: counts, offsets and references are judged by the bytes that are there.
#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "modeler/core/result.h"
#include "modeler/mesh/read_formats.h"

namespace sgm::mesh {

/// Elements of one accessor: scalars or vectors whose numbers lie within their buffer.
struct GltfElements {
    std::string_view bytes;
    size_t count = 0, stride_bytes = 0;
    int componentType = 0;  ///< 5120 … 5126, as OpenGL numbers them
    int components = 0;     ///< 1 or 3
    bool normalized = false;
};

class GltfFile {
public:
    /// Takes a file apart. Error::Input for what is no glTF 2.0, damaged, too deep, or needs an extension that isn't
    /// known here; `bytes` stay where they are while the result lives.
    static Result<GltfFile> open(std::string_view bytes, const ReadBeside& beside);
    GltfFile(GltfFile&&) noexcept;
    ~GltfFile();

    const nlohmann::json& json() const { return *json_; }
    /// The bytes of the buffers that are not in the file's own second chunk.
    uint64_t read_bytes() const { return read_bytes_; }

    /// The object number `index` of the list `list`; Error::Input where there is none.
    Result<const nlohmann::json*> at(const char* list, const nlohmann::json& index) const;

    /// The elements of an accessor, which has this many components. Error::Input where it is sparse, compressed, or
    /// reaches beyond its buffer.
    Result<GltfElements> elements(const nlohmann::json& accessor, int components) const;

private:
    GltfFile();
    Status splitGlb(std::string_view bytes);
    Status parse(std::string_view text);
    Status readBuffers(const ReadBeside& beside);
    Result<std::string_view> bytesOfView(const nlohmann::json& index, size_t& stride_bytes) const;

    std::unique_ptr<nlohmann::json> json_;
    std::optional<std::string_view> binary_;  ///< the second chunk of a .glb
    std::vector<std::string> owned_;          ///< buffers that were decoded or read
    uint64_t read_bytes_ = 0;
    std::vector<std::string_view> buffers_;
};

/// A member that is a whole number of at least 0, or `otherwise` where there is none; nothing where it is something
/// else.
std::optional<uint64_t> wholeNumber(const nlohmann::json& object, const char* name, uint64_t otherwise);

/// Component `component` of element `index` of positions, as a number of metres.
double positionAt(const GltfElements& elements, size_t index, int component);
/// The vertex that element `index` of indices names.
uint32_t vertexAt(const GltfElements& elements, size_t index);

}  // namespace sgm::mesh
