// How large classes and functions may be. Universal Ctags reads the sources.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace {

constexpr size_t mostFunctions = 30;  ///< of a class, constructors and overloads counted
constexpr size_t mostFields = 15;     ///< of a class, without static ones and those of its bases
constexpr size_t mostLines = 60;      ///< of a function, from its name to its closing brace

/// What Ctags says of one name.
struct Tag {
    std::string kind, file, scope, name, code;
    size_t line = 0, end = 0;  ///< end is 0 where only a declaration stands
};

std::vector<Tag> readTags() {
    // One column a field; the code comes last, since it may hold the separator.
    FILE* pipe = popen(
        "ctags -R --languages=C++ --langmap=C++:+.h --kinds-C++=+p --fields=+ne --sort=no -x "
        "--_xformat='%K|%F|%n|%e|%Z|%N|%C' modeler grammar viewer cli integrations 2>/dev/null",
        "r");
    std::string text;
    char part[4096];
    while (pipe && fgets(part, sizeof part, pipe)) text += part;
    if (pipe) pclose(pipe);

    std::vector<Tag> tags;
    for (size_t begin = 0; begin < text.size();) {
        const size_t end = std::min(text.find('\n', begin), text.size());
        std::vector<std::string> columns;
        size_t at = begin;
        while (columns.size() < 6) {
            const size_t bar = std::min(text.find('|', at), end);
            columns.push_back(text.substr(at, bar - at));
            at = std::min(bar + 1, end);
        }
        const auto number = [&](size_t i) {
            return static_cast<size_t>(std::strtoul(columns[i].c_str(), nullptr, 10));
        };
        tags.push_back(
            {columns[0], columns[1], columns[4], columns[5], text.substr(at, end - at), number(2), number(3)});
        begin = end + 1;
    }
    return tags;
}

struct ClassSize {
    size_t begin = 0, end = 0;  ///< lines
    size_t functions = 0, fields = 0;
};

/// By file and full name.
std::map<std::pair<std::string, std::string>, ClassSize> classSizes(const std::vector<Tag>& tags) {
    std::map<std::pair<std::string, std::string>, ClassSize> sizes;
    for (const Tag& tag : tags)
        if (tag.kind == "class" || tag.kind == "struct")
            sizes[{tag.file, tag.scope.empty() ? tag.name : tag.scope + "::" + tag.name}] = {tag.line, tag.end};
    for (const Tag& tag : tags) {
        const auto found = sizes.find({tag.file, tag.scope});
        if (found == sizes.end()) continue;
        ClassSize& size = found->second;
        const bool isInside = tag.line >= size.begin && tag.line <= size.end;
        if ((tag.kind == "function" || tag.kind == "prototype") && isInside) ++size.functions;
        if (tag.kind == "member" && tag.code.find("static ") == std::string::npos) ++size.fields;
    }
    return sizes;
}

class Sizes : public testing::Test {
protected:
    void SetUp() override {
        if (std::system("ctags --version 2>/dev/null | grep -q 'Universal Ctags'") != 0)
            GTEST_SKIP() << "universal-ctags isn't installed";
        tags = readTags();
        ASSERT_GT(tags.size(), 10'000u) << "run from the repository root";
    }
    std::vector<Tag> tags;
};

TEST_F(Sizes, NoClassHasMoreThanThirtyFunctionsOrFifteenFields) {
    size_t seen = 0;
    for (const auto& [name, size] : classSizes(tags)) {
        const std::string& qualified = name.second;
        EXPECT_LE(size.functions, mostFunctions) << qualified << " in " << name.first << ": functions";
        EXPECT_LE(size.fields, mostFields) << qualified << " in " << name.first << ": fields";
        ++seen;
    }
    EXPECT_GT(seen, 500u);
}

TEST_F(Sizes, NoFunctionHasMoreThanSixtyLines) {
    size_t seen = 0;
    for (const Tag& tag : tags) {
        if (tag.kind != "function" || tag.end == 0) continue;
        EXPECT_LE(tag.end - tag.line + 1, mostLines) << tag.name << " in " << tag.file << ", line " << tag.line;
        ++seen;
    }
    EXPECT_GT(seen, 2000u);
}

}  // namespace
