// Any text from the lexer to the field: what is said of it lies inside its file, the check fails with an error or not
// at all, and every start becomes a finite field or an error in words, within a small budget.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>

#include "grammar/lower/lower.h"
#include "tests/rules/read.h"
#include "tests/syntax/mutate.h"

extern "C" size_t LLVMFuzzerMutate(uint8_t* data, size_t size, size_t most);

namespace sgm {
namespace {

/// The standard library, which most examples use; the fuzzer runs in the root of the project.
std::map<std::string, std::string> standardLibrary() {
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator("grammar/std"))
        files["std/" + entry.path().filename().string()] = rules::readText(entry.path().string());
    return files;
}

void require(bool holds) {
    if (!holds) std::abort();
}

void grow(const std::shared_ptr<const rules::Grammar>& grammar) {
    const auto starts = static_cast<uint32_t>(std::min<size_t>(grammar->starts.size(), 3));
    for (uint32_t start = 0; start < starts; ++start) {
        derive::Options options;
        options.start = start;
        options.budget.shapes = 300;
        options.budget.seconds = 1;
        options.budget.memory_bytes = 256u << 20;
        const auto derivation = derive::derive(grammar, options, nullptr);
        require(derivation.ok() || !derivation.error().message.empty());
        if (!derivation.ok()) continue;
        const auto model = lower::lower(*derivation, nullptr);
        require(model.ok() || !model.error().message.empty());
        if (!model.ok()) continue;
        require((*model)->field.bounds.finite() && !(*model)->field.bounds.empty());
        require(!std::isnan((*model)->field.lipschitz));
    }
}

}  // namespace
}  // namespace sgm

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace sgm;
    static const auto files = standardLibrary();
    const rules::Checked c = rules::checked(std::string(reinterpret_cast<const char*>(data), size), files);
    require((c.grammar == nullptr) == c.diagnostics.hasErrors());
    for (const syntax::Diagnostic& d : c.diagnostics.all()) {
        require(d.span.source != nullptr && d.span.begin <= d.span.end && d.span.end <= d.span.source->text().size());
        require(!syntax::render(d).empty());
    }
    if (c.grammar) grow(c.grammar);
    return 0;
}

/// Every second mutant is one of words, for bytes alone seldom make another grammar.
extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t most, unsigned int seed) {
    if (seed % 2 != 0) return LLVMFuzzerMutate(data, size, most);
    const sgm::syntax::Mutator mutate(std::string(reinterpret_cast<const char*>(data), size));
    const std::string text = mutate(seed / 2);
    const size_t length = std::min(text.size(), most);
    std::copy_n(text.begin(), length, data);
    return length;
}
