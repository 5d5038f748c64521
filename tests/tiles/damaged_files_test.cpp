// Files of a bake that somebody changed are refused or read, whatever number stands in them.
#include <gtest/gtest.h>

#include <cstring>
#include <functional>

#include "modeler/core/atomic_file.h"
#include "modeler/tiles/cell_content.h"
#include "modeler/tiles/glb.h"
#include "modeler/tiles/read_back.h"
#include "tests/scratch.h"
#include "tests/tiles/baked.h"

namespace sgm::pipeline {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

const std::string text = R"(grammar 1
terminal lawn color #86a35f
start Town -> lawn size (60, 4, 60), Plot move (0, 6m, 0), Plot move (20m, 6m, 0)
rule Plot -> size (9, 8, 9) place House
start House -> cube size (8, 6, 6) - cube size (1, 2, 9) at -y to centre
)";

/// Calls visit(member) for the JSON and every member of it, at any depth.
void forEachMember(Json& json, const std::function<void(Json&)>& visit) {
    visit(json);
    if (json.is_structured())
        for (Json& member : json) forEachMember(member, visit);
}

/// A .glb file with another JSON.
std::string withJson(const std::string& glb, const Json& json) {
    const auto word = [](size_t value) {
        const auto number = static_cast<uint32_t>(value);
        return std::string(reinterpret_cast<const char*>(&number), sizeof number);
    };
    uint32_t length = 0;
    std::memcpy(&length, glb.data() + 12, sizeof length);
    std::string text = json.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    return glb.substr(0, 8) + word(glb.size() - length + text.size()) + word(text.size()) + glb.substr(16, 4) + text +
           glb.substr(20 + length);
}

class DamagedFiles : public testing::Test {
protected:
    DamagedFiles() { baked_.run(folder_.path(), {1, 1}); }

    /// Puts numbers and other types in every place of a file's JSON, and reads each of these files. Counts those that
    /// were refused.
    void readChanged(const fs::path& file, const std::function<bool(const fs::path&)>& isRead) {
        ASSERT_TRUE(isRead(file)) << file;
        auto glb = tiles::readGlb(file);
        ASSERT_TRUE(glb.ok());
        const std::string bytes = contentOf(file);
        // Beside it, since it names others by where it lies.
        const fs::path changed = file.parent_path() / "changed.glb";
        size_t refused = 0;
        forEachMember(glb->json, [&](Json& member) {
            const Json before = member;
            for (const Json& value :
                 {Json(4611686018427387905u), Json(3), Json(-1), Json(1e300), Json(), Json("x"), Json::array()}) {
                member = value;
                ASSERT_TRUE(writeFile(changed, withJson(bytes, glb->json)).ok());
                refused += !isRead(changed);
            }
            member = before;
        });
        EXPECT_GT(refused, 100u);
        fs::remove(changed);
    }
    fs::path firstObject() const {
        for (const auto& entry : fs::recursive_directory_iterator(folder_ / "lib"))
            if (entry.path().extension() == ".glb") return entry.path();
        return {};
    }

    const Scratch folder_;
    Baked baked_{text};
};

TEST_F(DamagedFiles, CellsAreReadOrRefused) {
    readChanged(tiles::contentFile(folder_.path(), {0, 0, 0}), [](const fs::path& file) {
        tiles::Library library;
        const auto cell = tiles::readCell(file, library);
        if (!cell.ok()) return false;
        for (const tiles::SurfacePiece& piece : cell->content.ground)
            EXPECT_LT(piece.material, cell->content.materials.size());
        return true;
    });
}

TEST_F(DamagedFiles, ObjectsAreReadOrRefused) {
    readChanged(firstObject(), [](const fs::path& file) {
        const auto object = tiles::readObject(file);
        if (!object.ok()) return false;
        for (const tiles::SurfacePiece& piece : object->pieces) EXPECT_LT(piece.material, object->materials.size());
        return true;
    });
}

TEST_F(DamagedFiles, ObjectsOfALibraryAreTakenOverOrRefused) {
    readChanged(firstObject(), [&](const fs::path& file) {
        tiles::Library library;
        if (!library.open(file).ok()) return false;
        tiles::CellContent content;
        content.packing = tiles::Packing::Meshopt;
        tiles::CellObject object;
        object.path = file;
        object.file = "../lib/" + file.filename().string();
        content.objects.push_back(object);
        return tiles::writeCell(content, library, folder_ / "cell.glb").ok();
    });
}

}  // namespace
}  // namespace sgm::pipeline
