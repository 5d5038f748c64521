// What a writer writes, somebody else's reader reads: figures, materials, normals, texture coordinates, options.
#include <gtest/gtest.h>

#include <cstring>

#include "modeler/export/exporter.h"
#include "tests/export/hand_made.h"
#include "tests/export/read_back.h"
#include "tests/scratch.h"

namespace sgm::exporter {
namespace {

/// A sphere in five chunks with two materials, and what is written of it.
struct Fixture {
    mesh::Mesh mesh = icosphere({1, 2, 3}, 2, 3, 5);
    Provenance provenance = twoMaterials();
    ExportInput input;
    Scratch folder;

    Fixture() {
        input.mesh = &mesh;
        input.provenance = &provenance;
        input.extras = {{"grammar", "a \"b\".sgm"}, {"seed", "7"}};
    }
    std::filesystem::path write(const std::string& name) {
        const auto path = folder / name;
        const Status status = exporter::write(input, path);
        EXPECT_TRUE(status.ok()) << (status.ok() ? "" : status.error().message);
        return path;
    }
};

std::vector<mesh::Triangle> trianglesOf(const mesh::Mesh& mesh) {
    std::vector<mesh::Triangle> all;
    for (const mesh::Chunk& c : mesh.chunks)
        for (const mesh::Triangle& t : c.triangles) all.push_back(c.inMesh(t));
    return all;
}

std::vector<Vec3f> positionsOf(const mesh::Mesh& mesh) {
    std::vector<Vec3f> all;
    for (const mesh::Chunk& c : mesh.chunks) all.insert(all.end(), c.positions.begin(), c.positions.end());
    return all;
}

Box3f boundsOf(const std::vector<Vec3f>& positions) {
    Box3f box;
    for (const Vec3f& p : positions) box = hull(box, p);
    return box;
}

double volumeOf(const ReadBack& r) {
    return enclosedVolume(r.triangles, [&](uint32_t v) { return r.positions[v].as<double>(); });
}

/// Directed edges that lack their opposite: 0 for a closed, consistently turned surface.
size_t openEdges(const ReadBack& r) {
    std::map<std::pair<uint32_t, uint32_t>, int> balance;
    for (const mesh::Triangle& t : r.triangles)
        for (int i = 0; i < 3; ++i) {
            const uint32_t a = t[i], b = t[(i + 1) % 3];
            balance[std::minmax(a, b)] += a < b ? 1 : -1;
        }
    size_t open = 0;
    for (const auto& [edge, sum] : balance) open += sum != 0;
    return open;
}

class EveryMeshFormat : public testing::TestWithParam<std::string> {};

TEST_P(EveryMeshFormat, KeepsCountsBoundsVolumeAndClosedness) {
    Fixture f;
    const ReadBack r = welded(readBack(f.write("sphere" + GetParam())));
    const auto positions = positionsOf(f.mesh);
    EXPECT_EQ(r.triangles.size(), f.mesh.triangleCount());
    EXPECT_EQ(r.positions.size(), f.mesh.vertexCount());
    EXPECT_EQ(boundsOf(r.positions), f.mesh.bounds());
    EXPECT_EQ(openEdges(r), 0u);
    const double volume = enclosedVolume(trianglesOf(f.mesh), [&](uint32_t v) { return positions[v].as<double>(); });
    EXPECT_NEAR(volumeOf(r), volume, 1e-9);
    EXPECT_GT(volume, 0.95 * 4 / 3 * pi * 8);
}

TEST_P(EveryMeshFormat, KeepsNormals) {
    Fixture f;
    const ReadBack r = readBack(f.write("sphere" + GetParam()));
    if (GetParam() == ".stl" || GetParam() == ".off") {
        EXPECT_TRUE(r.normals.empty());
        return;
    }
    ASSERT_EQ(r.normals.size(), r.positions.size());
    for (size_t i = 0; i < r.positions.size(); ++i)
        EXPECT_GT(dot(r.normals[i], normalized(r.positions[i] - Vec3f{1, 2, 3})), 0.99999f);
}

TEST_P(EveryMeshFormat, WritesTheSameBytesAgain) {
    Fixture f;
    const std::string first = contentOf(f.write("sphere" + GetParam()));
    EXPECT_GT(first.size(), 1000u);
    EXPECT_EQ(first, contentOf(f.write("sphere" + GetParam())));
}

TEST_P(EveryMeshFormat, RefusesAnEmptyMesh) {
    Fixture f;
    f.mesh = {};
    const Status status = write(f.input, f.folder / ("none" + GetParam()));
    ASSERT_FALSE(status.ok());
    EXPECT_NE(status.error().message.find("no triangles"), std::string::npos);
    EXPECT_EQ(f.folder.fileCount(), 0u);
}

TEST_P(EveryMeshFormat, TurnsAndScalesByOption) {
    Fixture f;
    const Exporter* row = findExporter(GetParam());
    ASSERT_NE(row, nullptr);
    f.input.options = {{"up", "z"}, {"unit", "cm"}};
    if (GetParam() == ".glb" || GetParam() == ".gltf") {  // it has metres and Y up by its own word
        EXPECT_EQ(write(f.input, f.folder / ("sphere" + GetParam())).error().kind, Error::Kind::Usage);
        return;
    }
    const ReadBack r = welded(readBack(f.write("sphere" + GetParam())));
    const Box3f was = f.mesh.bounds(), is = boundsOf(r.positions);
    EXPECT_FLOAT_EQ(is.lo.x, 100 * was.lo.x);
    EXPECT_FLOAT_EQ(is.lo.z, 100 * was.lo.y);
    EXPECT_FLOAT_EQ(is.lo.y, -100 * was.hi.z);
    EXPECT_EQ(openEdges(r), 0u);
    EXPECT_GT(volumeOf(r), 0);
}

INSTANTIATE_TEST_SUITE_P(Formats, EveryMeshFormat,
                         testing::Values(".glb", ".gltf", ".obj", ".ply", ".stl", ".off", ".usda"),
                         [](const auto& info) { return info.param.substr(1); });

TEST(RoundTrip, MaterialsKeepTheirTriangles) {
    Fixture f;
    size_t moss = 0;
    for (const mesh::Chunk& c : f.mesh.chunks)
        for (const OriginId o : c.origins) moss += o == 2;
    for (const std::string name : {"a.glb", "a.gltf", "a.usda"}) {
        const ReadBack r = readBack(f.write(name));
        EXPECT_EQ(static_cast<size_t>(std::count(r.materials.begin(), r.materials.end(), "moss")), moss) << name;
        EXPECT_EQ(static_cast<size_t>(std::count(r.materials.begin(), r.materials.end(), "stone")),
                  f.mesh.triangleCount() - moss);
    }
    // Moss is (0.1, 0.6, 0.2): linear bytes in .mtl, sRGB bytes in .ply.
    const ReadBack obj = readBack(f.write("a.obj"));
    EXPECT_EQ(static_cast<size_t>(std::count(obj.materials.begin(), obj.materials.end(), "26 153 51")), moss);
    const ReadBack ply = readBack(f.write("a.ply"));
    EXPECT_GT(std::count(ply.materials.begin(), ply.materials.end(), "89 203 124"), 0);
    EXPECT_GT(std::count(ply.materials.begin(), ply.materials.end(), "188 137 99"), 0);
    const ReadBack glb = readBack(f.write("a.glb"));
    EXPECT_EQ(glb.colors.at("moss"), (Vec3f{0.1f, 0.6f, 0.2f}));
    EXPECT_EQ(glb.generator, "sgm");
    EXPECT_EQ(glb.extras, f.input.extras);
}

TEST(RoundTrip, PlyFacesCarryTheirOrigin) {
    Fixture f;
    const std::string bytes = contentOf(f.write("a.ply"));
    const std::string end = "end_header\n";
    constexpr size_t vertexBytes = 8 * 4 + 3, faceBytes = 1 + 3 * 4 + 4;
    const size_t faces = bytes.find(end) + end.size() + f.mesh.vertexCount() * vertexBytes;
    ASSERT_EQ(bytes.size(), faces + f.mesh.triangleCount() * faceBytes);
    size_t i = 0;
    for (const mesh::Chunk& c : f.mesh.chunks)
        for (const OriginId origin : c.origins) {
            uint32_t read = 0;
            std::memcpy(&read, bytes.data() + faces + i++ * faceBytes + 13, sizeof read);
            ASSERT_EQ(read, origin);
        }
}

TEST(RoundTrip, PlyOfTheShapeAlone) {
    Fixture f;
    const ReadBack all = readBack(f.write("a.ply"));
    f.input.options = {{"attributes", "none"}};
    const std::string bytes = contentOf(f.write("b.ply"));
    const size_t shape = f.mesh.vertexCount() * 12 + f.mesh.triangleCount() * 13;
    EXPECT_EQ(bytes.size(), bytes.find("end_header\n") + 11 + shape);
    const ReadBack positionsOnly = readBack(f.folder / "b.ply");
    EXPECT_EQ(positionsOnly.positions, all.positions);
    EXPECT_EQ(positionsOnly.triangles, all.triangles);
}

TEST_P(EveryMeshFormat, OfABareMeshHasTheSameBytesOrIsRefused) {
    Fixture full, positionsOnly;
    for (mesh::Chunk& c : positionsOnly.mesh.chunks) c.normals.clear(), c.origins.clear();
    const std::string file = "sphere" + GetParam();
    for (const ExportOptions& options : {ExportOptions{}, ExportOptions{{"attributes", "none"}}}) {
        const Exporter& row = *findExporter(GetParam());
        if (!checkOptions(row, options).ok()) continue;
        full.input.options = positionsOnly.input.options = options;
        if (takesPositionsOnly(row, options)) {
            EXPECT_EQ(contentOf(positionsOnly.write(file)), contentOf(full.write(file)));
            continue;
        }
        const Status status = write(positionsOnly.input, positionsOnly.folder / file);
        ASSERT_FALSE(status.ok());
        EXPECT_NE(status.error().message.find("no normals"), std::string::npos);
        EXPECT_EQ(positionsOnly.folder.fileCount(), 0u);
        if (!row.stream) continue;
        const ChunkSource all = [&](const mesh::ChunkVisitor& visit) {
            return visit(positionsOnly.mesh, positionsOnly.mesh.chunks[0]);
        };
        ExportInput input = positionsOnly.input;
        input.mesh = nullptr;
        EXPECT_EQ(writeStreamed(input, all, positionsOnly.folder / file).error().message, status.error().message);
    }
}

TEST(RoundTrip, TextureChartsAreInMetresAndNeverMirrored) {
    Fixture f;
    const ReadBack r = readBack(f.write("a.glb"));
    ASSERT_EQ(r.uvs.size(), r.positions.size());
    for (const mesh::Triangle& t : r.triangles) {
        const Vec3f n = cross(r.positions[t.y] - r.positions[t.x], r.positions[t.z] - r.positions[t.x]);
        const auto &a = r.uvs[t.x], &b = r.uvs[t.y], &c = r.uvs[t.z];
        // v runs downwards in glTF, so a face that isn't mirrored turns clockwise there.
        const float area = -((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]));
        const float largest = std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)});
        EXPECT_NEAR(area, largest, 1e-5f);
    }
    f.input.options = {{"uv", "none"}};
    const ReadBack plain = readBack(f.write("a.glb"));
    EXPECT_TRUE(plain.uvs.empty());
    EXPECT_LT(plain.positions.size(), r.positions.size());
}

TEST(RoundTrip, StlLeavesOutTrianglesWithEqualCornersAndStaysClosed) {
    Fixture f;
    // Pull one vertex onto a neighbour: the two triangles of their edge collapse.
    const mesh::Triangle t = f.mesh.chunks[0].triangles[0];
    f.mesh.chunks[0].positions[t.x] = f.mesh.chunks[0].positions[t.y];
    const ReadBack r = welded(readBack(f.write("a.stl")));
    EXPECT_EQ(r.triangles.size(), f.mesh.triangleCount() - 2);
    EXPECT_EQ(openEdges(r), 0u);
}

TEST(RoundTrip, AwkwardMaterialNamesStayApart) {
    Fixture f;
    f.provenance.materials[0].name = "wet stone";
    f.provenance.materials[1].name = "wet#stone";
    const std::string obj = contentOf(f.write("my cave.obj"));
    const std::string library = "my_cave-" + obj.substr(obj.find("mtllib my_cave-") + 15, 8) + ".mtl";
    EXPECT_NE(obj.find("mtllib " + library + "\n"), std::string::npos)
        << "a name of its own, for my_cave.obj has one too";
    EXPECT_NE(obj.find("usemtl wet_stone\n"), std::string::npos);
    EXPECT_NE(obj.find("usemtl wet_stone_2\n"), std::string::npos);
    EXPECT_NE(contentOf(f.folder / library).find("newmtl wet_stone_2\n"), std::string::npos);
    const ReadBack usd = readBack(f.write("a.usda"));
    EXPECT_GT(std::count(usd.materials.begin(), usd.materials.end(), "wet_stone_2"), 0);
    f.provenance.materials[1].name = "caf\xe9";  // Latin-1: no UTF-8, which JSON would need
    EXPECT_TRUE(readBack(f.write("a.glb")).colors.count("caf\xef\xbf\xbd"));
}

TEST(RoundTrip, ZeroNormalsBecomeUnitOnes) {
    Fixture f;
    f.mesh.chunks[0].normals[0] = {};
    const ReadBack r = readBack(f.write("a.glb"));
    for (const Vec3f& n : r.normals) EXPECT_NEAR(length(n), 1, 1e-5f);
}

}  // namespace
}  // namespace sgm::exporter
