// Grammars read and checked for the tests.
// Enters: text. Leaves: the Grammar, or null, and what was said about it. Assumes files of `use` are given by name.
#pragma once

#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "grammar/operations/operations.h"
#include "grammar/rules/check.h"

namespace sgm::rules {

struct Checked {
    syntax::SourcePtr source;
    std::vector<syntax::SourcePtr> used;  ///< diagnostics point into them
    syntax::Diagnostics diagnostics;
    std::shared_ptr<const Grammar> grammar;

    /// All messages, one a line, warnings marked.
    std::string messages() const {
        std::string text;
        for (const auto& d : diagnostics.all())
            text += (d.severity == syntax::Severity::Warning ? "warning: " : "") + d.message + "\n";
        return text;
    }
};

inline Checked checked(const std::string& text, const std::map<std::string, std::string>& files = {},
                       const std::string& name = "test.sgm") {
    Checked result;
    result.source = std::make_shared<const syntax::Source>(name, text);
    const Loader loader = [&](const std::string& wanted, const syntax::Source&, std::string& why) -> syntax::SourcePtr {
        const auto file = files.find(wanted);
        if (file == files.end()) {
            why = "there is no such file";
            return nullptr;
        }
        result.used.push_back(std::make_shared<const syntax::Source>(file->first, file->second));
        return result.used.back();
    };
    result.grammar = load(result.source, operations::table(), loader, result.diagnostics);
    return result;
}

/// `body` after the line every grammar begins with.
inline Checked checkedBody(const std::string& body) { return checked("grammar 1\n" + body); }

inline std::string readText(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

}  // namespace sgm::rules
