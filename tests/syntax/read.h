// Reading files and rendering problems, for the tests of the syntax module.
#pragma once

#include <fstream>
#include <iterator>

#include "grammar/syntax/source.h"

namespace sgm::syntax {

inline SourcePtr makeSource(std::string text, std::string name = "t.sgm") {
    return std::make_shared<const Source>(std::move(name), std::move(text));
}

/// A file of the repository; tests run in its root.
inline SourcePtr readSource(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return makeSource({std::istreambuf_iterator<char>(file), {}}, path);
}

/// Every problem as the user sees it.
inline std::string renderAll(const Diagnostics& diagnostics) {
    std::string out;
    for (const Diagnostic& d : diagnostics.all()) out += render(d);
    return out;
}

}  // namespace sgm::syntax
