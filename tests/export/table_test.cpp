// The table itself: its rows, the checks before a writer runs, paths, cancelling.
#include <gtest/gtest.h>

#include "modeler/export/exporter.h"
#include "tests/export/hand_made.h"
#include "tests/export/read_back.h"
#include "tests/scratch.h"

namespace sgm::exporter {
namespace {

TEST(ExporterTable, EveryRowIsComplete) {
    EXPECT_EQ(exporters().size(), 13u);
    for (const Exporter& row : exporters()) {
        EXPECT_EQ(row.extension[0], '.');
        EXPECT_FALSE(row.doc.empty());
        EXPECT_EQ(findExporter(row.extension), &row);
        EXPECT_EQ(exporterFor("folder.ply/a.b" + std::string(row.extension)), &row);
        for (const ExportOption& o : row.options) {
            EXPECT_FALSE(o.doc.empty());
            if (!o.choices.empty()) {
                EXPECT_NE(o.choices.find(o.fallback), std::string_view::npos) << o.name;
            }
        }
    }
    EXPECT_EQ(findExporter(".GLB"), findExporter(".glb"));
    EXPECT_EQ(findExporter(".fbx"), nullptr);
    EXPECT_EQ(findExporter(""), nullptr);
    EXPECT_EQ(exporterFor("a.json"), nullptr);
    EXPECT_EQ(exporterFor(".glb"), nullptr);
}

class Write : public testing::Test {
protected:
    Write() { input.mesh = &mesh; }
    /// The error of writing to `path`, "" where there is none.
    std::string errorOf(const std::filesystem::path& path) {
        const Status status = write(input, path);
        return status.ok() ? "" : status.error().message;
    }
    mesh::Mesh mesh = icosphere({}, 1, 1, 2);
    ExportInput input;
    Scratch folder;
};

TEST_F(Write, NamesWhatIsWrong) {
    EXPECT_EQ(errorOf(folder / "a.fbx").find("no format for '"), 0u);
    EXPECT_NE(errorOf(folder / "a.fbx").find(".glb .gltf .obj"), std::string::npos);
    EXPECT_EQ(errorOf(folder / "missing/a.ply"), "cannot write '" + (folder / "missing/a.ply").string() +
                                                     "': there is no folder '" + (folder / "missing").string() + "'");
    input.options = {{"color", "red"}};
    EXPECT_EQ(errorOf(folder / "a.ply"), ".ply has no option 'color'; it has: up, unit, attributes");
    input.options = {{"up", "x"}};
    EXPECT_EQ(errorOf(folder / "a.ply"), "option 'up' of .ply is one of y|z, not 'x'");
    input.options = {};
    EXPECT_NE(errorOf(folder / "a.vdb").find("there is no volume"), std::string::npos);
    EXPECT_EQ(folder.fileCount(), 0u);
}

TEST_F(Write, TakesOddPaths) {
    for (const std::string name : {"with blank.ply", "h\xc3\xb6hle.stl", "quote'\".off", "line\nbreak.glb", "-o.obj",
                                   "caf\xe9.usda", "UPPER.PLY", ".hidden.gltf"}) {
        EXPECT_EQ(errorOf(folder / name), "") << name;
        EXPECT_GT(std::filesystem::file_size(folder / name), 100u);
    }
    EXPECT_EQ(errorOf(folder / (std::string(251, 'a') + ".ply")), "") << "the longest name a file can have";
}

TEST_F(Write, WritesIntoTheCurrentFolder) {
    const auto before = std::filesystem::current_path();
    std::filesystem::current_path(folder.path());
    EXPECT_EQ(errorOf("here.ply"), "");
    std::filesystem::current_path(before);
    EXPECT_TRUE(std::filesystem::exists(folder / "here.ply"));
}

TEST_F(Write, StopsWhenCancelled) {
    Progress progress;
    progress.cancel();
    input.progress = &progress;
    for (const Exporter& row : exporters()) {
        if (!row.wantsMesh()) continue;
        const Status status = write(input, folder / std::string("a").append(row.extension));
        ASSERT_FALSE(status.ok()) << row.extension;
        EXPECT_EQ(status.error().kind, Error::Kind::Cancelled);
    }
    EXPECT_EQ(folder.fileCount(), 0u);
}

TEST_F(Write, TicksToTheEnd) {
    Progress progress;
    input.progress = &progress;
    for (const Exporter& row : exporters())
        if (row.wantsMesh()) {
            EXPECT_EQ(errorOf(folder / std::string("a").append(row.extension)), "");
            EXPECT_DOUBLE_EQ(progress.fraction(), 1) << row.extension;
        }
}

}  // namespace
}  // namespace sgm::exporter
