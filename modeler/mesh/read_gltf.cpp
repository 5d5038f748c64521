// Where the triangles of a glTF 2.0 file stand (Khronos, "glTF 2.0 Specification", sections 3.5 to 3.7).
#include <array>
#include <nlohmann/json.hpp>

#include "modeler/mesh/gltf_file.h"
#include "modeler/mesh/read_formats.h"

namespace sgm::mesh {
namespace {

using Json = nlohmann::json;

/// A point is moved to the sum of its coordinates times the first three columns, and the last one.
using Placement = std::array<Vec3d, 4>;
constexpr Placement noMove{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}}};
constexpr unsigned asTriangles = 4, asStrip = 5, asFan = 6;
/// What a file may hold however small it is: objects that stand in many places.
constexpr size_t alwaysAllowed = 1'000'000;

Vec3d turned(const Placement& by, Vec3d p) { return by[0] * p.x + by[1] * p.y + by[2] * p.z; }

Placement product(const Placement& outer, const Placement& inner) {
    return {turned(outer, inner[0]), turned(outer, inner[1]), turned(outer, inner[2]),
            turned(outer, inner[3]) + outer[3]};
}

bool isMirrored(const Placement& by) { return dot(cross(by[0], by[1]), by[2]) < 0; }

/// `count` numbers of a member; nothing where it is another thing, and `out` as it was where there is none.
template <size_t count>
bool readNumbers(const Json& node, const char* name, std::array<double, count>& out) {
    const auto list = node.find(name);
    if (list == node.end()) return true;
    if (!list->is_array() || list->size() != count) return false;
    for (size_t i = 0; i < count; ++i) {
        if (!(*list)[i].is_number()) return false;
        out[i] = (*list)[i].get<double>();
    }
    return true;
}

std::optional<Placement> placementOf(const Json& node) {
    if (node.contains("matrix")) {
        std::array<double, 16> m{};
        if (!readNumbers(node, "matrix", m)) return {};
        return Placement{{{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}, {m[12], m[13], m[14]}}};
    }
    std::array<double, 3> t{0, 0, 0}, s{1, 1, 1};
    std::array<double, 4> q{0, 0, 0, 1};
    if (!readNumbers(node, "translation", t) || !readNumbers(node, "rotation", q) || !readNumbers(node, "scale", s))
        return {};
    const auto [x, y, z, w] = q;
    return Placement{{Vec3d{1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)} * s[0],
                      Vec3d{2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)} * s[1],
                      Vec3d{2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)} * s[2],
                      {t[0], t[1], t[2]}}};
}

class GltfReader {
public:
    GltfReader(const GltfFile& file, size_t bytes, TriangleSoup& soup, const Progress* progress)
        : file_(file), most_(alwaysAllowed + bytes), soup_(soup), progress_(progress) {}

    Status read() {
        if (const Status roots = pushRoots(); !roots.ok()) return roots;
        const auto nodes = file_.json().find("nodes");
        std::vector<bool> seen(nodes != file_.json().end() && nodes->is_array() ? nodes->size() : 0);
        while (!waiting_.empty()) {
            if (cancelled(progress_)) return cancelledError();
            const Waiting next = waiting_.back();
            waiting_.pop_back();
            const auto node = file_.at("nodes", *next.index);
            if (!node.ok()) return node.error();
            const size_t number = next.index->get<size_t>();
            if (seen[number]) return damaged(0, "a node stands in two places, or in itself");
            seen[number] = true;
            if (const Status s = readNode(**node, next.parent); !s.ok()) return s;
        }
        return Done{};
    }

private:
    struct Waiting {
        const Json* index;
        Placement parent;
    };

    Status push(const Json& indices, const Placement& parent) {
        if (!indices.is_array()) return damaged(0, "a list of nodes is none");
        for (const Json& index : indices) waiting_.push_back({&index, parent});
        return Done{};
    }

    /// The nodes of the scene that is shown; of all scenes the first where the file doesn't say.
    Status pushRoots() {
        const Json& json = file_.json();
        static const Json first = 0u;
        const auto named = json.find("scene");
        const auto scene = file_.at("scenes", named == json.end() ? first : *named);
        if (!scene.ok()) return json.contains("scenes") ? scene.error() : damaged(0, "it has no scene");
        if (!(*scene)->is_object()) return damaged(0, "a scene is none");
        const auto nodes = (*scene)->find("nodes");
        return nodes == (*scene)->end() ? Status(Done{}) : push(*nodes, noMove);
    }

    Status readNode(const Json& node, const Placement& parent) {
        if (!node.is_object()) return damaged(0, "a node is none");
        const auto own = placementOf(node);
        if (!own) return damaged(0, "a node's place is not of numbers");
        const Placement placement = product(parent, *own);
        if (const auto extensions = node.find("extensions");
            extensions != node.end() && extensions->contains("EXT_mesh_gpu_instancing"))
            return Error{Error::Kind::Input, "has instances of an extension of glTF: save it with a node for each"};
        if (const auto children = node.find("children"); children != node.end())
            if (const Status s = push(*children, placement); !s.ok()) return s;
        const auto named = node.find("mesh");
        if (named == node.end()) return Done{};
        const auto mesh = file_.at("meshes", *named);
        if (!mesh.ok()) return mesh.error();
        const auto primitives = (*mesh)->is_object() ? (*mesh)->find("primitives") : (*mesh)->end();
        if (primitives == (*mesh)->end() || !primitives->is_array()) return damaged(0, "a mesh has no primitives");
        for (const Json& primitive : *primitives)
            if (const Status s = readPrimitive(primitive, placement); !s.ok()) return s;
        return Done{};
    }

    Status readPrimitive(const Json& primitive, const Placement& placement) {
        if (cancelled(progress_)) return cancelledError();
        const auto mode = wholeNumber(primitive, "mode", asTriangles);
        if (!mode || !primitive.is_object()) return damaged(0, "a primitive is none");
        if (*mode < asTriangles) return Done{};  // points and lines
        if (const auto extensions = primitive.find("extensions");
            extensions != primitive.end() && extensions->contains("KHR_draco_mesh_compression"))
            return Error{Error::Kind::Input, "is compressed: save it without compression"};
        const auto attributes = primitive.find("attributes");
        if (*mode > asFan || attributes == primitive.end() || !attributes->is_object())
            return damaged(0, "a primitive is none");
        const auto position = attributes->find("POSITION");
        if (position == attributes->end()) return Done{};
        const auto positions = file_.elements(*position, 3);
        if (!positions.ok()) return positions.error();
        const auto named = primitive.find("indices");
        if (named == primitive.end()) return add(*positions, nullptr, *mode, placement);
        const auto indices = file_.elements(*named, 1);
        if (!indices.ok()) return indices.error();
        return add(*positions, &*indices, *mode, placement);
    }

    Status add(const GltfElements& positions, const GltfElements* indices, uint64_t mode, const Placement& placement) {
        const size_t corners = indices ? indices->count : positions.count, before = soup_.positions.size();
        if (corners < 3) return Done{};
        const size_t triangles = mode == asTriangles ? corners / 3 : corners - 2;
        if (before + positions.count > most_ || soup_.triangles.size() + triangles > most_)
            return Error{Error::Kind::Budget,
                         "puts its parts in so many places that it is far larger than its file: simplify it"};
        for (size_t i = 0; i < positions.count; ++i) {
            if (i % 4096 == 0 && cancelled(progress_)) return cancelledError();
            const Vec3d p{positionAt(positions, i, 0), positionAt(positions, i, 1), positionAt(positions, i, 2)};
            soup_.positions.push_back(turned(placement, p) + placement[3]);
        }
        const bool mirrored = isMirrored(placement);
        bool known = true;
        const auto vertex = [&](size_t corner) {
            const size_t v = indices ? vertexAt(*indices, corner) : corner;
            known = known && v < positions.count;
            return static_cast<uint32_t>(before + v);
        };
        for (size_t t = 0; t < triangles && known; ++t) {
            if (t % 4096 == 0 && cancelled(progress_)) return cancelledError();
            const size_t at = mode == asTriangles ? 3 * t : t;
            const bool swapped = mirrored != (mode == asStrip && t % 2 == 1);
            const uint32_t a = vertex(mode == asFan ? 0 : at), b = vertex(at + 1), c = vertex(at + 2);
            soup_.triangles.push_back(swapped ? Triangle{a, c, b} : Triangle{a, b, c});
        }
        return known ? Status(Done{}) : damaged(0, "a triangle has a corner that is none of its vertices");
    }

    const GltfFile& file_;
    const size_t most_;
    TriangleSoup& soup_;
    const Progress* progress_;
    std::vector<Waiting> waiting_;
};

}  // namespace

Status readGltf(std::string_view bytes, const ReadBeside& beside, TriangleSoup& soup, const Progress* progress) {
    const auto file = GltfFile::open(bytes, beside);
    if (!file.ok()) return file.error();
    return GltfReader(*file, bytes.size() + file->read_bytes(), soup, progress).read();
}

}  // namespace sgm::mesh
