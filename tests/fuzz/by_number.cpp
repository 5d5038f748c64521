// Runs a fuzz target without libFuzzer: inputs by number, each a seed with a few bytes, words or stretches changed.
// They are many times as fast as instrumented ones.   fuzz_TARGET_by_number FIRST COUNT FILE-OR-FOLDER…
// Enters: numbers of inputs, seeds. Leaves: exit status 0; else the number of the input that crashed, took 20 s or left
// memory behind, on stderr, and its bytes in the file `input-NUMBER`. Assumes that the target is deterministic.
#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "modeler/core/random.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);

namespace {

namespace fs = std::filesystem;
using sgm::combine, sgm::pick;

constexpr size_t longest = 4000;
constexpr unsigned limit_s = 20;
constexpr long growth_kB = 300'000;

/// What a signal handler may read.
std::string input;
char outputName[40], message[120];

void report(int) {
    const int file = open(outputName, O_WRONLY | O_CREAT | O_TRUNC, 0644);
    (void)!write(file, input.data(), input.size());
    (void)!write(STDERR_FILENO, message, std::char_traits<char>::length(message));
    _exit(1);
}

std::vector<std::string> seedsIn(const std::vector<std::string>& places) {
    std::vector<fs::path> files;
    for (const fs::path place : places) {
        if (!fs::is_directory(place))
            files.push_back(place);
        else
            for (const auto& entry : fs::recursive_directory_iterator(place))
                if (entry.is_regular_file()) files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    std::vector<std::string> seeds;
    for (const fs::path& file : files) {
        std::ifstream stream(file, std::ios::binary);
        std::string bytes(std::istreambuf_iterator<char>(stream), {});
        if (!bytes.empty() && bytes.size() <= longest) seeds.push_back(std::move(bytes));
    }
    return seeds;
}

/// Numbers at the ends of what formats count with, as text and as four bytes of either order.
constexpr std::array<std::string_view, 20> extremes{"-1",
                                                    "0",
                                                    "4294967295",
                                                    "2147483648",
                                                    "1e999",
                                                    "-1e-320",
                                                    "nan",
                                                    "inf",
                                                    "99999999999999999999",
                                                    "\xff\xff\xff\xff",
                                                    std::string_view("\0\0\0\0", 4),
                                                    std::string_view("\0\0\0\x80", 4),
                                                    "\x7f\xff\xff\xff",
                                                    std::string_view("\1\0\0\0", 4),
                                                    std::string_view("\0\0\0\1", 4),
                                                    "\n",
                                                    " ",
                                                    "\"",
                                                    std::string_view("\0\0\xc0\x7f", 4),
                                                    std::string_view("\x7f\x80\0\0", 4)};

/// A stretch of letters or digits around or behind a place.
std::pair<size_t, size_t> wordAt(const std::string& text, size_t at) {
    const auto isWord = [&](size_t i) { return std::isalnum(static_cast<unsigned char>(text[i])) || text[i] == '.'; };
    while (at < text.size() && !isWord(at)) ++at;
    size_t end = at;
    while (end < text.size() && isWord(end)) ++end;
    while (at > 0 && isWord(at - 1)) --at;
    return {at, end - at};
}

void change(std::string& text, const std::string& other, uint64_t key) {
    const auto draw = [&](uint64_t what, uint64_t count) { return pick(combine(key, what), count); };
    const size_t at = draw(1, text.size() + 1), length = 1 + draw(2, draw(3, 4) == 0 ? 60 : 6);
    switch (draw(0, 8)) {
        case 0:
            if (at < text.size()) text[at] ^= static_cast<char>(1u << draw(4, 8));
            break;
        case 1:
            if (at < text.size()) text[at] = static_cast<char>(draw(4, 256));
            break;
        case 2:
            text.erase(at, length);
            break;
        case 3:
            text.insert(at, text.substr(draw(4, text.size() + 1), length));
            break;
        case 4:
            text.insert(at, other.substr(draw(4, other.size()), length));
            break;
        case 5:
            text.replace(at, 4, extremes[draw(4, extremes.size())]);
            break;
        case 6: {
            const auto [from, size] = wordAt(text, at);
            text.replace(from, size, extremes[draw(4, extremes.size())]);
            break;
        }
        default: {
            const auto [from, size] = wordAt(text, at);
            const auto [otherFrom, otherSize] = wordAt(other, draw(4, other.size()));
            text.replace(from, size, other, otherFrom, otherSize);
        }
    }
}

/// Input number `key`: a seed with one to five changes, for which it borrows from another.
void make(const std::vector<std::string>& seeds, uint64_t key) {
    input = seeds[pick(combine(key, 0), seeds.size())];
    const std::string& other = seeds[pick(combine(key, 1), seeds.size())];
    for (uint64_t k = 1 + pick(combine(key, 2), 5); k > 0; --k) change(input, other, combine(key, 2 + k));
    if (input.size() > longest) input.resize(longest);
}

long resident_kB() {
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    return used.ru_maxrss;
}

}  // namespace

int main(int count, char** words) {
    if (count < 4) return std::fprintf(stderr, "usage: %s FIRST COUNT FILE-OR-FOLDER…\n", words[0]), 2;
    const uint64_t first = std::strtoull(words[1], nullptr, 10), inputs = std::strtoull(words[2], nullptr, 10);
    const std::vector<std::string> seeds = seedsIn({words + 3, words + count});
    if (seeds.empty()) return std::fputs("there are no seeds\n", stderr), 2;
    for (const int signal : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGALRM}) std::signal(signal, report);
    long early_kB = 0;
    for (uint64_t key = first; key < first + inputs; ++key) {
        make(seeds, key);
        std::snprintf(outputName, sizeof outputName, "input-%llu", static_cast<unsigned long long>(key));
        std::snprintf(message, sizeof message, "input %llu crashed or took %u s: %s\n",
                      static_cast<unsigned long long>(key), limit_s, outputName);
        if (key % 64 == 0) alarm(limit_s);
        LLVMFuzzerTestOneInput(reinterpret_cast<const uint8_t*>(input.data()), input.size());
        if (key == first + inputs / 4) early_kB = resident_kB();
    }
    const long grown_kB = resident_kB() - early_kB;
    if (grown_kB < growth_kB) return 0;
    return std::fprintf(stderr, "memory grew by %ld kB over the last three quarters of the inputs\n", grown_kB), 1;
}
