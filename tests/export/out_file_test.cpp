// Bytes come out in order, however they came in and wherever the buffer's blocks end.
#include "modeler/export/out_file.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "tests/scratch.h"

namespace sgm::exporter {
namespace {

std::string contentOf(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// The bytes of a row of 13, and three more, which the next row takes.
std::array<char, 16> rowOf(size_t i) {
    std::array<char, 16> row;
    for (size_t k = 0; k < row.size(); ++k) row[k] = static_cast<char>(k < 13 ? i * 31 + k : 0x55);
    return row;
}

TEST(OutFile, KeepsTheOrderOfRowsBytesAndValues) {
    Scratch folder;
    const std::filesystem::path path = folder / "file";
    std::ofstream(path).flush();
    std::string expected;
    OutFile out(path, path, nullptr), part(path, nullptr);
    for (size_t round = 0; round < 40; ++round) {
        const size_t count = round * 997;  // 10 MB in all: many blocks, which end at every place of a row
        out.rows<13>(count, [](size_t i, char* to) {
            const auto row = rowOf(i);
            std::memcpy(to, row.data(), row.size());
        });
        for (size_t i = 0; i < count; ++i) expected.append(rowOf(i).data(), 13);
        out.raw(uint64_t{round}, uint16_t{7});
        expected.append(reinterpret_cast<const char*>(&round), 8).append("\7\0", 2);
        const std::string text(round * 9001, static_cast<char>('a' + round % 26));
        out.text(text);
        expected += text;
    }
    part.text(std::string(700'001, 'p'));
    out.append(part);
    expected += std::string(700'001, 'p');
    out.text("end");
    expected += "end";
    out.patch(300'000, "patch", 5);
    expected.replace(300'000, 5, "patch");
    ASSERT_TRUE(out.finish().ok());
    EXPECT_TRUE(contentOf(path) == expected);
}

}  // namespace
}  // namespace sgm::exporter
