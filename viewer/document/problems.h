// The Problems panel: what is wrong with the grammar, as plain rows.
// Enters: diagnostics, and errors of later stages. Leaves: rows that outlive the sources they point at. Assumes
// nothing.
#pragma once

#include <string>
#include <vector>

#include "grammar/syntax/source.h"
#include "modeler/core/result.h"

namespace sgm::document {

struct Problem {
    syntax::Severity severity = syntax::Severity::Error;
    std::string file;                     ///< as the source is named; "" where no place is known
    uint32_t line = 0, column = 0;        ///< from 1; 0 where no place is known
    uint32_t endLine = 0, endColumn = 0;  ///< behind the last byte
    std::string message, hint;            ///< hint: what to write instead, "" where nobody knows
    friend bool operator==(const Problem&, const Problem&) = default;
};

/// A row a diagnostic, in their order.
std::vector<Problem> problemsOf(const syntax::Diagnostics& diagnostics);

/// An error of a later stage; its place is read off the "file:line:column: " that it begins with.
Problem problemOf(const Error& error);

}  // namespace sgm::document
