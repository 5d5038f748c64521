// What holds of every source file: its length, its layout, its words.
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

constexpr size_t mostLines = 400;
const std::vector<std::string> folders{"modeler", "grammar", "viewer", "cli", "tests", "examples", "integrations"};

/// The C++ sources of the repository, the working directory.
std::vector<fs::path> sources() {
    std::vector<fs::path> files;
    for (const std::string& folder : folders)
        for (const auto& entry : fs::recursive_directory_iterator(folder))
            if (entry.path().extension() == ".cpp" || entry.path().extension() == ".h") files.push_back(entry.path());
    return files;
}

std::string read(const fs::path& path) {
    std::stringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

/// The text without comments, string and character literals.
std::string codeOf(const std::string& text) {
    std::string code;
    for (size_t i = 0; i < text.size(); ++i) {
        const std::string_view rest = std::string_view(text).substr(i);
        if (rest.starts_with("//")) {
            i = std::min(text.find('\n', i), text.size()) - 1;
        } else if (rest.starts_with("/*")) {
            i = text.find("*/", i) + 1;
        } else if (rest.starts_with("R\"(")) {
            i = text.find(")\"", i) + 1;
        } else if (text[i] == '"' ||
                   (text[i] == '\'' && (i == 0 || !std::isalnum(static_cast<unsigned char>(text[i - 1]))))) {
            const char quote = text[i];
            for (++i; i < text.size() && text[i] != quote; ++i)
                if (text[i] == '\\') ++i;
            code += ' ';
        } else {
            code += text[i];
        }
    }
    return code;
}

void forEachIdentifier(const std::string& code, const std::function<void(const std::string&)>& visit) {
    std::string word;
    for (const char c : code + " ") {
        if (std::isalnum(static_cast<unsigned char>(c)) || c == '_')
            word += c;
        else if (!word.empty()) {
            visit(word);
            word.clear();
        }
    }
}

TEST(Sources, HaveAtMostFourHundredLines) {
    size_t seen = 0;
    for (const fs::path& file : sources()) {
        const std::string text = read(file);
        EXPECT_LE(static_cast<size_t>(std::count(text.begin(), text.end(), '\n')), mostLines) << file;
        ++seen;
    }
    EXPECT_GT(seen, 500u) << "run from the repository root";
}

TEST(Sources, SayNoneOfTheReplacedIdentifiers) {
    std::set<std::string> replaced;
    std::ifstream list("tests/core/private_words.txt");
    for (std::string line; std::getline(list, line);)
        if (!line.empty() && line[0] != '#') replaced.insert(line);
    ASSERT_GT(replaced.size(), 50u);
    for (const fs::path& file : sources())
        forEachIdentifier(codeOf(read(file)), [&](const std::string& word) {
            EXPECT_FALSE(replaced.count(word)) << file << " says '" << word << "'";
        });
}

TEST(Sources, AreLaidOutByClangFormat) {
    // Other versions lay out otherwise.
    if (std::system("clang-format --version 2>/dev/null | grep -q 'version 14\\.'") != 0)
        GTEST_SKIP() << "clang-format 14 (Debian 12) isn't installed";
    const fs::path list = fs::temp_directory_path() / "sgm_sources.txt";
    {
        std::ofstream out(list);
        for (const fs::path& file : sources()) out << file.string() << "\n";
    }
    const std::string command = "xargs -a " + list.string() + " clang-format --dry-run -Werror 2>&1 | head -5";
    std::string problems;
    FILE* pipe = popen(command.c_str(), "r");
    ASSERT_TRUE(pipe);
    char line[512];
    while (fgets(line, sizeof line, pipe)) problems += line;
    pclose(pipe);
    EXPECT_EQ(problems, "");
}

}  // namespace
