// Grammars that read files which a test makes up.
// Enters: a loader and the text of a grammar. Leaves: the checked grammar. Assumes gtest in the caller.
#pragma once

#include "tests/derive/grammars.h"

namespace sgm::testing_ {

/// The grammar of the text; its errors as text in `errors`, else as failures of the test. Its source stays until the
/// program ends.
inline std::shared_ptr<const rules::Grammar> loaded(const rules::Loader& loader, const std::string& text,
                                                    std::string* errors = nullptr) {
    static std::vector<syntax::SourcePtr> kept;
    kept.push_back(std::make_shared<const syntax::Source>("test.sgm", text));
    syntax::Diagnostics diagnostics;
    auto grammar = rules::load(kept.back(), operations::table(), loader, diagnostics);
    for (const auto& d : diagnostics.all()) {
        if (d.severity != syntax::Severity::Error) continue;
        if (errors)
            *errors += syntax::render(d);
        else
            ADD_FAILURE() << syntax::render(d);
    }
    return grammar;
}

}  // namespace sgm::testing_
