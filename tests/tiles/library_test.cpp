// What a bake knows of the library's files is bounded.
#include <gtest/gtest.h>

#include "modeler/tiles/cell_content.h"
#include "tests/scratch.h"

namespace sgm::tiles {
namespace {

namespace fs = std::filesystem;

/// Writes a triangle, two metres wide and one high.
void writeSail(const fs::path& file) {
    LibraryObject object;
    object.name = "sail";
    object.materials = {Material{}};
    SurfacePiece piece;
    piece.positions = {{0, 0, 0}, {2, 0, 0}, {0, 1, 0}}, piece.normals.assign(3, {0, 0, 1}), piece.indices = {0, 1, 2};
    object.pieces = {piece};
    fs::create_directories(file.parent_path());
    ASSERT_TRUE(writeObject(object, Packing::Meshopt, file).ok());
}

TEST(Library, KnowsTheFilesThatWereOpenedLast) {
    const Scratch folder;
    const auto fileOf = [&](int i) { return folder.path() / "lib" / "00" / (std::to_string(i) + ".glb"); };
    writeSail(fileOf(0));

    Library library;
    const auto isKnown = [&](int i) {
        const auto entry = library.open(fileOf(i));
        EXPECT_TRUE(!entry.ok() || (*entry)->triangles == 1);
        return entry.ok();
    };
    constexpr int count = 2500;
    for (int i = 0; i < count; ++i) {
        if (i > 0) fs::copy_file(fileOf(0), fileOf(i));
        ASSERT_TRUE(isKnown(i)) << i;
        EXPECT_TRUE(i != 1500 || isKnown(3));  // opened again, it is one of the latest
    }
    fs::remove_all(folder.path() / "lib");
    EXPECT_TRUE(isKnown(count - 1));
    EXPECT_TRUE(isKnown(count - 1000));
    EXPECT_TRUE(isKnown(3));
    EXPECT_FALSE(isKnown(100));
}

TEST(Library, TellsTheBoxOfAnObject) {
    const Scratch folder;
    const fs::path file = folder.path() / "lib" / "00" / "0.glb";
    writeSail(file);
    Library library;
    const auto entry = library.open(file);
    ASSERT_TRUE(entry.ok());
    EXPECT_NEAR((*entry)->box.hi.x, 2, 1e-4);
    EXPECT_NEAR((*entry)->box.hi.y, 1, 1e-4);
    EXPECT_EQ((*entry)->fileBytes, fs::file_size(file));
}

}  // namespace
}  // namespace sgm::tiles
