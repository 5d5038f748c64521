// Meshes from files: all formats, all dialects of them, and files that lie.
#include "modeler/mesh/read.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <random>

#include "modeler/mesh/distances.h"
#include "tests/cpu_time.h"
#include "tests/fuzz_keys.h"
#include "tests/scratch.h"

namespace sgm::mesh {
namespace {

const std::string corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv .5 .5 1\n";
const std::string plyRows = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n.5 .5 1\n4 3 2 1 0\n3 0 1 4\n3 1 2 4\n3 2 3 4\n3 3 0 4\n";
const std::string plyHead =
    "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 5\nproperty list uchar int vertex_indices\nend_header\n";

class ReadMesh : public testing::Test {
protected:
    Result<TriangleSoup> read(const std::string& name, const std::string& bytes) {
        return readMesh(scratch_.write(name, bytes));
    }
    /// What is said of a file that can't be read; "" where it can.
    std::string refusal(const std::string& name, const std::string& bytes) {
        const auto mesh = read(name, bytes);
        return mesh.ok() ? "" : mesh.error().message;
    }
    void expectPyramid(const std::string& name, const std::string& bytes) {
        const auto mesh = read(name, bytes);
        ASSERT_TRUE(mesh.ok()) << mesh.error().message;
        EXPECT_EQ(mesh->triangles.size(), 6u) << name;
        EXPECT_EQ(mesh->bounds(), (Box3d{{0, 0, 0}, {1, 1, 1}})) << name;
        EXPECT_TRUE(toDistances(*mesh, 20).ok()) << name;
    }
    Scratch scratch_;
};

/// A binary STL or PLY of the same pyramid.
template <class T>
void put(std::string& out, T value, bool bigEndian = false) {
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    if (bigEndian) std::reverse(bytes, bytes + sizeof value);
    out.append(bytes, sizeof value);
}
constexpr float points[5][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {.5f, .5f, 1}};
constexpr uint32_t sides[6][3] = {{3, 2, 1}, {3, 1, 0}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};

std::string binaryStl(const std::string& head = "x") {
    std::string out = head + std::string(80 - head.size(), ' ');
    put(out, uint32_t{6});
    for (const auto& side : sides) {
        for (int i = 0; i < 3; ++i) put(out, 0.0f);
        for (const uint32_t v : side)
            for (const float x : points[v]) put(out, x);
        put(out, uint16_t{0});
    }
    return out;
}

std::string binaryPly(bool bigEndian) {
    std::string out = std::string("ply\nformat binary_") + (bigEndian ? "big" : "little") +
                      "_endian 1.0\ncomment C:\\models\\\nelement vertex 5\nproperty double x\nproperty float "
                      "y\nproperty float z\nproperty uchar red\n"
                      "element face 6\nproperty uchar flags\nproperty list int uint vertex_index\nelement edge "
                      "2\nproperty short a\nend_header\n";
    for (const auto& p : points)
        put(out, double{p[0]}, bigEndian), put(out, p[1], bigEndian), put(out, p[2], bigEndian), out += 'r';
    for (const auto& side : sides) {
        out += 'f';
        put(out, int32_t{3}, bigEndian);
        for (const uint32_t v : side) put(out, v, bigEndian);
    }
    return out + "abcd";
}

TEST_F(ReadMesh, ReadsEveryDialect) {
    expectPyramid("a.obj", corners + "f 4 3 2 1\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n");
    expectPyramid(
        "b.OBJ",
        "# a\r\nmtllib /etc/passwd\r\n" + corners +
            "vt 0 0\nvn 0 0 1\no x\nusemtl y\nf -2/1/1 -3//1 \\\n -4 -5/1 # base\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5");
    expectPyramid("c.ply", plyHead + plyRows);
    expectPyramid("d.ply", "ply\r\ncomment before the format\r\n" + plyHead.substr(4) + plyRows);
    expectPyramid("e.ply", binaryPly(false));
    expectPyramid("f.ply", binaryPly(true));
    expectPyramid("g.stl", binaryStl());
    expectPyramid("h.stl", binaryStl("solid but binary"));
    std::string text = "solid a b c\n";
    for (const auto& side : sides) {
        text += "facet normal 0 0 0\n outer loop\n";
        for (const uint32_t v : side)
            text += "  vertex " + std::to_string(points[v][0]) + " " + std::to_string(points[v][1]) + " " +
                    std::to_string(points[v][2]) + "\n";
        text += " endloop\nendfacet\n";
    }
    expectPyramid("i.stl", text + "endsolid a b c\n");
    expectPyramid("j.off", "OFF\n# a\n5 5 0\n" + plyRows);
    expectPyramid("k.off",
                  "COFF 5 5 0\n0 0 0 255 0 0 255\n1 0 0 1 1 1 1\n1 1 0\n0 1 0 # b\n.5 .5 1\n4 3 2 1 0 .5 .5 .5\n3 0 1 "
                  "4 255 0 0\n3 1 2 4\n3 2 3 4\n3 3 0 4");
}

TEST_F(ReadMesh, KeepsTheDigitsOfFarCoordinates) {
    const auto mesh =
        read("far.obj", "v 500000.123 5400000.456 200\nv 500001 5400000 200\nv 500000 5400001 200\nf 1 2 3\n");
    ASSERT_TRUE(mesh.ok());
    EXPECT_EQ(mesh->positions[0], (Vec3d{500000.123, 5400000.456, 200}));
}

TEST_F(ReadMesh, SaysWhatIsWrongAndWhereWithoutQuotingIt) {
    EXPECT_NE(
        refusal("a.obj", corners + "v 1 secret 2\n").find("a.obj' is damaged, line 6: a vertex needs three numbers"),
        std::string::npos)
        << refusal("a.obj", corners + "v 1 secret 2\n");
    EXPECT_NE(refusal("b.ply", "ply\nformat ascii 1.0\nproperty float x\nend_header\n")
                  .find("line 3: a property stands before its element"),
              std::string::npos);
    EXPECT_NE(refusal("c.fbx", "x").find("is no mesh that can be read"), std::string::npos);
    EXPECT_NE(readMesh(scratch_ / "missing.obj").error().message.find("can't be read: No such file"),
              std::string::npos);
    EXPECT_NE(readMesh("/dev/zero.obj").error().message.find("can't be read"), std::string::npos);
}

TEST_F(ReadMesh, BelievesNoCount) {
    const std::string list =
        "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list int int vertex_indices\nend_header\n" +
        std::string(12, '\0');
    for (const auto& [name, bytes] : {
             std::pair("a.stl", std::string("solid cut\n")),
             {"b.stl", binaryStl().substr(0, 300)},
             {"c.stl", std::string(80, 'x') + "\xff\xff\xff\x7f"},
             {"d.obj", corners},
             {"e.obj", corners + "f 1 2 99\n"},
             {"f.obj", corners + "f 1 2 0\n"},
             {"g.obj", corners + "f 1 2 -9\n"},
             {"h.obj", corners + "f 1 2 99999999999999999999\n"},
             {"i.obj", std::string("v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")},
             {"j.obj", std::string("v inf 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")},
             {"k.ply", std::string("ply\nformat ascii 1.0\nelement vertex 99999999999\n")},
             {"l.ply", plyHead},
             {"m.ply", list + std::string("\xff\xff\xff\x7f", 4)},
             {"n.ply", list + std::string("\xff\xff\xff\xff", 4)},
             {"o.ply", std::string("ply\nformat ascii 1.0\nelement nothing 99999999999999999\nend_header\n")},
             {"p.ply", "ply\n" + std::string(100000, '\n')},
             {"q.ply", std::string("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n")},
             {"r.ply", plyHead + plyRows.substr(0, plyRows.size() - 4) + "9\n"},
             {"s.off", std::string("OFF\n999999999 999999999 0\n")},
             {"t.off", std::string("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n2000000000 0 2 1\n")},
             {"u.off", std::string("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n-3 0 2 1\n")},
             {"v.off", std::string("OFF BINARY\n")},
             {"w.off", std::string()},
             {"x.ply", std::string("ply\nformat ascii 1.0\nelement face 3\nproperty list uchar int "
                                   "vertex_indices\nend_header\n3 0 1 2\n")},
         })
        EXPECT_EQ(refusal(name, bytes).rfind("'", 0), 0u) << name;
}

TEST_F(ReadMesh, TakesAFaceOfAnyLength) {
    std::string text = "v 0 0 0\n", face = "f";
    for (int64_t i = 0; i < 50000; ++i)
        text += "v " + std::to_string(i) + " " + std::to_string(i * i) + " 0\n", face += " " + std::to_string(i + 1);
    const auto mesh = read("long.obj", text + face + "\n");
    ASSERT_TRUE(mesh.ok());
    EXPECT_EQ(mesh->triangles.size(), 49998u);
}

TEST_F(ReadMesh, StopsWhenItIsCancelled) {
    Progress progress;
    progress.cancel();
    const auto mesh = readMesh(scratch_.write("a.stl", binaryStl()), &progress);
    ASSERT_FALSE(mesh.ok());
    EXPECT_EQ(mesh.error().kind, Error::Kind::Cancelled);
}

/// Every file cut anywhere, and with bytes changed: read or refused, at once. SGM_FUZZ_MUTANTS sets how many.
TEST_F(ReadMesh, SurvivesWhateverTheBytesAre) {
    const std::pair<const char*, std::string> files[] = {{"m.obj", corners + "f 4 3 2 1\nf 1/1 2/2 5//1\n"},
                                                         {"m.ply", plyHead + plyRows},
                                                         {"n.ply", binaryPly(false)},
                                                         {"o.ply", binaryPly(true)},
                                                         {"m.stl", binaryStl()},
                                                         {"m.off", "OFF\n5 5 0\n" + plyRows}};
    const FuzzKeys keys = fuzzKeys(300);
    std::mt19937_64 random(7 + keys.first);
    const double started = secondsOf(threadClock());
    size_t good = 0;
    for (const auto& [name, bytes] : files) {
        for (size_t cut = 0; cut < bytes.size(); ++cut) (void)read(name, bytes.substr(0, cut));
        for (int i = 0; i < static_cast<int>(keys.count); ++i) {
            std::string mutant = bytes;
            for (uint64_t k = 1 + random() % 4; k > 0; --k) {
                const size_t at = random() % mutant.size();
                switch (random() % 4) {
                    case 0:
                        mutant[at] = static_cast<char>(random());
                        break;
                    case 1:
                        mutant[at] ^= static_cast<char>(1 << random() % 8);
                        break;
                    case 2:
                        mutant.erase(at, 1 + random() % 8);
                        break;
                    default:
                        mutant.insert(at, mutant.substr(random() % mutant.size(), random() % 40));
                }
                if (mutant.empty()) break;
            }
            const auto mesh = read(name, mutant);
            if (mesh.ok()) good += toDistances(*mesh, 8).ok();
        }
    }
    EXPECT_GT(good, 0u) << "some change nothing that matters";
    EXPECT_LT(secondsOf(threadClock()) - started, boundSeconds(20 + 0.02 * static_cast<double>(keys.count)));
}

}  // namespace
}  // namespace sgm::mesh
