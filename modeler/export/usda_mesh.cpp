#include "modeler/export/usda_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "modeler/export/formats.h"

namespace sgm::exporter {
namespace {

/// The text of one object's mesh prim, an attribute after the other.
class MeshPrim {
public:
    /// Of patches [begin, end), which are one object's.
    MeshPrim(OutFile& out, const UsdSurface& surface, std::vector<uint32_t>& local, size_t begin, size_t end)
        : out_(out),
          surface_(surface),
          patched_(surface.patched),
          patches_(surface.patched.patches.begin() + static_cast<std::ptrdiff_t>(begin),
                   surface.patched.patches.begin() + static_cast<std::ptrdiff_t>(end)),
          local_(local),
          vertices_(*surface.input.mesh),
          place_(placementOf(surface.input)) {
        const Patch &first = patches_.front(), &last = patches_.back();
        firstVertex_ = first.firstVertex, vertexCount_ = last.firstVertex + last.vertexCount - firstVertex_;
        firstTriangle_ = first.firstTriangle;
        triangleCount_ = last.firstTriangle + last.triangleCount - firstTriangle_;
        const auto from = patched_.vertices.begin() + firstVertex_;
        points_.assign(from, from + vertexCount_);
        std::sort(points_.begin(), points_.end());
        points_.erase(std::unique(points_.begin(), points_.end()), points_.end());
        for (uint32_t i = 0; i < points_.size(); ++i) local_[points_[i]] = i;
    }

    void write() {
        out_.text("def Mesh \"Surface\"\n{\n    uniform token subdivisionScheme = \"none\"\n");
        topology();
        points();
        normals();
        colors();
        origins();
        if (!surface_.texture.empty()) textureCoordinates();
        if (surface_.input.byMaterial) subsets();
        out_.text("}\n");
    }

private:
    mesh::Triangle triangle(size_t i) const { return patched_.triangles[firstTriangle_ + i]; }

    void topology() {
        list("int[] faceVertexCounts", triangleCount_, [&](size_t) { out_.text("3"); });
        list("int[] faceVertexIndices", triangleCount_, [&](size_t i) {
            const mesh::Triangle t = triangle(i);
            const auto point = [&](uint32_t v) { return local_[patched_.vertices[v]]; };
            out_.numbers(mesh::Triangle{point(t.x), point(t.y), point(t.z)}, ", ");
        });
    }

    void points() {
        Box3f box;
        for (const uint32_t v : points_) box = hull(box, place_.position(vertices_.position(v)));
        out_.text(fmt::format("    float3[] extent = [{}, {}]\n", usdTuple(box.lo), usdTuple(box.hi)));
        list("point3f[] points", points_.size(),
             [&](size_t i) { parenthesized(place_.position(vertices_.position(points_[i]))); });
    }

    /// One a vertex; one a face's corner where the mesh has hard edges.
    void normals() {
        if (patched_.corners.empty())
            return list(
                "normal3f[] normals", points_.size(),
                [&](size_t i) { parenthesized(place_.direction(unitNormal(vertices_.normal(points_[i])))); }, "vertex");
        list(
            "normal3f[] normals", 3 * size_t{triangleCount_},
            [&](size_t i) {
                parenthesized(place_.direction(patched_.normal(triangle(i / 3)[static_cast<int>(i % 3)], vertices_)));
            },
            "faceVarying");
    }

    void colors() {
        std::vector<uint32_t> used;  // materials
        for (const Patch& p : patches_)
            for (uint32_t v = p.firstVertex; v < p.firstVertex + p.vertexCount; ++v)
                if (used.empty() || used.back() != patched_.materials[v]) used.push_back(patched_.materials[v]);
        std::sort(used.begin(), used.end());
        used.erase(std::unique(used.begin(), used.end()), used.end());
        list(
            "color3f[] primvars:displayColor", used.size(),
            [&](size_t i) { out_.text(usdTuple(surface_.input.provenance->materials[used[i]].color)); }, "uniform");
        list("int[] primvars:displayColor:indices", triangleCount_, [&](size_t i) {
            const auto at = std::lower_bound(used.begin(), used.end(), patched_.materials[triangle(i).x]);
            out_.number(at - used.begin());
        });
    }

    /// Whose each face is: a number in the table of the layer.
    void origins() {
        list(
            "int[] primvars:origin", triangleCount_,
            [&](size_t i) { out_.number(patched_.origins[firstTriangle_ + i]); }, "uniform");
    }

    void textureCoordinates() {
        const TextureSets& sets = surface_.texture;
        textureSet("st", [&](uint32_t chart, Vec3f p) { return sets.charts.at(chart, p); });
        if (sets.light) textureSet("st1", [&](uint32_t chart, Vec3f p) { return sets.light->at(chart, p); });
    }

    template <class At>
    void textureSet(std::string_view name, At at) {
        list(
            fmt::format("texCoord2f[] primvars:{}", name), vertexCount_,
            [&](size_t i) {
                const size_t v = firstVertex_ + i;
                const auto [s, t] = at(patched_.charts[v], vertices_.position(patched_.vertices[v]));
                out_.text("(");
                out_.number(s);
                out_.text(", ");
                out_.number(t);
                out_.text(")");
            },
            "faceVarying");
        const mesh::Triangle first{firstVertex_, firstVertex_, firstVertex_};
        list(fmt::format("int[] primvars:{}:indices", name), triangleCount_,
             [&](size_t i) { out_.numbers(triangle(i) - first, ", "); });
    }

    void subsets() {
        out_.text("    uniform token subsetFamily:materialBind:familyType = \"partition\"\n");
        for (const Patch& p : patches_) {
            out_.text(
                fmt::format("\n    def GeomSubset \"{0}\" (\n"
                            "        prepend apiSchemas = [\"MaterialBindingAPI\"]\n    )\n    {{\n"
                            "        uniform token elementType = \"face\"\n"
                            "        uniform token familyName = \"materialBind\"\n"
                            "        rel material:binding = </{1}/Materials/{0}>\n    ",
                            surface_.materialNames[p.material], surface_.root));
            list("int[] indices", p.triangleCount,
                 [&](size_t i) { out_.number(p.firstTriangle - firstTriangle_ + i); });
            out_.text("    }\n");
        }
    }

    /// "type name = [element, element, …]", with its interpolation where it has one.
    template <class Element>
    void list(std::string_view declaration, size_t count, Element element, std::string_view interpolation = "") {
        out_.text("    ");
        out_.text(declaration);
        out_.text(" = [");
        for (size_t i = 0; i < count && !out_.failed(); ++i) {
            if (i > 0) out_.text(", ");
            element(i);
        }
        out_.text("]");
        if (!interpolation.empty()) out_.text(fmt::format(" (interpolation = \"{}\")", interpolation));
        out_.text("\n");
    }
    void parenthesized(Vec3f v) {
        out_.text("(");
        out_.numbers(v, ", ");
        out_.text(")");
    }

    OutFile& out_;
    const UsdSurface& surface_;
    const PatchedMesh& patched_;
    const std::span<const Patch> patches_;
    std::vector<uint32_t>& local_;  ///< by mesh vertex: its place in `points_`
    std::vector<uint32_t> points_;  ///< mesh vertices of the object, ascending
    uint32_t firstVertex_, vertexCount_, firstTriangle_, triangleCount_;
    Vertices vertices_;
    Placement place_;
};

}  // namespace

std::string usdTuple(Vec3f v) { return fmt::format("({}, {}, {})", v.x, v.y, v.z); }

void writeUsdMesh(OutFile& out, const UsdSurface& surface, std::vector<uint32_t>& local, size_t begin, size_t end) {
    MeshPrim(out, surface, local, begin, end).write();
}

}  // namespace sgm::exporter
