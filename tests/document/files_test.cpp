// Which files a grammar reaches, and which it doesn't.
#include "grammar/pipeline/files.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/document/shown.h"
#include "tests/scratch.h"

namespace sgm::document {
namespace {

namespace fs = std::filesystem;

constexpr const char* box =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n"
    "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";

/// A folder "inside" with a grammar, and files beside that folder.
class Reach : public testing::Test {
protected:
    Reach() {
        fs::create_directories(scratch_ / "inside/parts");
        scratch_.write("inside/parts/wall.sgm", "grammar 1\nterminal wall\n");
        scratch_.write("outside.sgm", "grammar 1\nterminal secret\n");
        scratch_.write("outside.obj", box);
        scratch_.write("inside/box.obj", box);
    }
    syntax::Source main() const { return {(scratch_ / "inside/main.sgm").string(), "grammar 1\n"}; }
    syntax::SourcePtr use(const std::string& name) { return why_.clear(), loader_.use(name, main(), why_); }
    bool mesh(const std::string& name) { return why_.clear(), loader_.mesh(name, main(), why_) != nullptr; }

    Scratch scratch_;
    rules::Loader loader_ = pipeline::fileLoader();
    std::string why_;
};

TEST_F(Reach, ItsFolderAndTheLibraryAndNothingElse) {
    EXPECT_TRUE(use("parts/wall.sgm")) << why_;
    EXPECT_TRUE(use("std/walls.sgm")) << why_;
    EXPECT_TRUE(mesh("box.obj")) << why_;
    const std::string absolute = (scratch_ / "outside.sgm").string();
    for (const std::string& name : {"std/" + absolute, "std//" + absolute, "std/.//" + absolute})
        EXPECT_FALSE(use(name)) << "not even below std/: " << name;
    for (const std::string& name :
         {absolute, std::string("../outside.sgm"), std::string("std/../../outside.sgm"),
          std::string("parts/../../outside.sgm"), std::string("std/../std/../../outside.sgm")}) {
        EXPECT_FALSE(use(name)) << name;
        EXPECT_NE(why_.find("its own folder or in std/"), std::string::npos) << name << ": " << why_;
    }
    const std::string mesh_file = (scratch_ / "outside.obj").string();
    for (const std::string& name : {mesh_file, "std/" + mesh_file, std::string("../outside.obj")})
        EXPECT_FALSE(mesh(name)) << name;
}

TEST_F(Reach, LinksOnlyWhereTheyStayInside) {
    fs::create_directory_symlink(scratch_.path(), scratch_ / "inside/up");
    fs::create_symlink(scratch_ / "outside.obj", scratch_ / "inside/link.obj");
    fs::create_symlink("parts/wall.sgm", scratch_ / "inside/alias.sgm");
    EXPECT_FALSE(use("up/outside.sgm"));
    EXPECT_NE(why_.find("its own folder or in std/"), std::string::npos) << why_;
    EXPECT_FALSE(mesh("link.obj"));
    const auto alias = use("alias.sgm");
    ASSERT_TRUE(alias) << why_;
    EXPECT_EQ(alias->name(), use("parts/wall.sgm")->name()) << "one file, one name";
}

TEST_F(Reach, OneNameForEverySpelling) {
    for (const char* name : {"./parts/wall.sgm", "parts//wall.sgm", "parts/../parts/./wall.sgm"}) {
        const auto source = use(name);
        ASSERT_TRUE(source) << name;
        EXPECT_EQ(source->name(), use("parts/wall.sgm")->name()) << name;
    }
}

TEST_F(Reach, RegularFilesAlone) {
    for (const char* name : {"pipe.sgm", "pipe.obj"})
        ASSERT_EQ(mkfifo((scratch_ / ("inside/" + std::string(name))).c_str(), 0600), 0);
    EXPECT_FALSE(use("pipe.sgm"));
    EXPECT_NE(why_.find("it is a pipe"), std::string::npos) << why_;
    EXPECT_FALSE(mesh("pipe.obj"));
    EXPECT_NE(why_.find("it is a pipe"), std::string::npos) << why_;
    EXPECT_FALSE(use("parts"));
    const auto device = pipeline::readSource("/dev/zero");
    ASSERT_FALSE(device.ok());
    EXPECT_NE(device.error().message.find("it is a device"), std::string::npos) << device.error().message;
}

TEST_F(Reach, QuoteNothingThatIsNoGrammar) {
    scratch_.write("inside/.env", "password = hunter2\n");
    scratch_.write("inside/blank.sgm", "\xef\xbb\xbf// walls\n\ngrammar 1\n");
    EXPECT_FALSE(use(".env"));
    EXPECT_NE(why_.find("it is no grammar"), std::string::npos) << why_;
    EXPECT_EQ(why_.find("hunter2"), std::string::npos) << why_;
    EXPECT_TRUE(use("blank.sgm")) << why_;
}

TEST_F(Reach, NoNamesWithControlCharacters) {
    for (const std::string& name : {std::string("std/walls.sgm\0/etc/passwd", 25),
                                    std::string("\x1b[31mparts/wall.sgm"), std::string("a\nb.sgm")}) {
        EXPECT_FALSE(use(name));
        EXPECT_NE(why_.find("control characters"), std::string::npos) << why_;
    }
}

TEST_F(Reach, NoMoreTextThanAnybodyWrites) {
    std::ofstream(scratch_ / "inside/large.sgm") << "grammar 1\n";
    fs::resize_file(scratch_ / "inside/large.sgm", (16 << 20) + 1);
    EXPECT_FALSE(use("large.sgm"));
    EXPECT_NE(why_.find("larger than 16 MiB"), std::string::npos) << why_;
}

TEST(FilesBeside, ArePartOfWhatTheWindowShows) {
    const Scratch scratch;
    scratch.write("streets.geojson",
                  "{\"type\":\"LineString\",\"crs\":{\"properties\":{\"name\":\"EPSG:25832\"}},"
                  "\"coordinates\":[[-150,20],[150,-20]]}");
    const auto path = scratch.write("town.sgm",
                                    "grammar 2\nterminal wall\nroads Net from \"streets.geojson\" { block = 60m }\n"
                                    "start Town -> size (400, 10, 400) network Net { block: wall }\n");
    const auto document = Document::open(path);
    ASSERT_TRUE(document.ok());
    const auto model = shown(*document);
    ASSERT_TRUE(model);
    EXPECT_GT(model->model.derivation.tree.shapes.size(), 5u);
}

TEST(FilesBeside, TexturesAreReadToo) {
    const Scratch scratch;
    fs::copy("examples/buildings/textures/brick.jpg", scratch / "brick.jpg");
    const auto path = scratch.write("wall.sgm", "grammar 2\nstart Wall -> cube texture \"brick.jpg\" 1m\n");
    const auto document = Document::open(path);
    ASSERT_TRUE(document.ok());
    const auto model = shown(*document);
    ASSERT_TRUE(model);
    const Provenance& provenance = model->model.lowered->provenance;
    EXPECT_TRUE(provenance.materialOf(1).texture);
}

}  // namespace
}  // namespace sgm::document
