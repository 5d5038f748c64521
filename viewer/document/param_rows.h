// The Parameters panel: what can be set, as the panel shows it; values back to text.
// Enters: a grammar and what is chosen. Leaves: rows in the order of the text, and edits of it (the text is the
// document: a slider rewrites a default or a style). Assumes numbers as people read them: metres, degrees, percent.
#pragma once

#include <string>
#include <vector>

#include "grammar/derive/derive.h"
#include "viewer/document/document.h"
#include "viewer/document/edits.h"

namespace sgm::document {

struct ParamRow {
    enum class Kind : uint8_t {
        Integer,  ///< a slider by whole numbers; several numbers: a slider each
        Real,     ///< a slider with its unit; several numbers: a slider each
        Choice,   ///< a combo of `choices`
        Color,    ///< `color`
        Truth,    ///< a checkbox: number[0] is 0 or 1
        Text,     ///< `word`
    };
    Kind kind = Kind::Real;
    std::string name, label, group;  ///< label: the name where none is given
    std::string unit;                ///< "m", "deg", "%", "/m", ""
    char key = 0;                    ///< hotkey, lower case; shift reverses; 0 for none
    std::vector<double> number;      ///< one, or one a component
    std::vector<double> lo, hi;      ///< range of each; empty where there is none
    std::vector<std::string> choices;
    std::string word;               ///< Choice, Text
    std::array<double, 3> color{};  ///< Color: linear rgb, 0 … 1
    bool locked = false;            ///< a re-roll leaves it alone
    syntax::SourceSpan span;        ///< of its declaration
};

/// The parameters with the values they have in this choice.
std::vector<ParamRow> paramRows(const rules::Grammar& grammar, const derive::Options& options, const Choice& choice);

/// The row's value as a grammar would say it: "7", "1.2m", "(1, 2, 3)", "#c8b090", "flat". Reals are rounded to the
/// digits that a slider over their range can set.
std::string valueText(const ParamRow& row);

/// Writes the rows' values into the text: into the chosen style, or where the values come from.
edits::Edit setParams(const syntax::Ast& ast, const Choice& choice, const std::vector<ParamRow>& rows);

/// The value one step on: whole numbers by 1, reals by a twentieth of their range, the next choice, the other truth;
/// `back` goes the other way. Stays in the range; choices go round. What hotkeys do.
ParamRow stepped(ParamRow row, bool back);
/// The row with this hotkey, or null.
const ParamRow* rowOfKey(const std::vector<ParamRow>& rows, char key);

/// New values within their ranges for all that aren't locked, decided by `seed` alone. Colours and texts stay.
std::vector<ParamRow> rerolled(std::vector<ParamRow> rows, uint64_t seed);

/// Names of the styles for the chosen start, in the order of the text.
std::vector<std::string> stylesFor(const rules::Grammar& grammar, uint32_t start);
/// Symbols of the starts, in the order of the text; names of the `derive` ways.
std::vector<std::string> startsOf(const rules::Grammar& grammar);
std::vector<std::string> waysOf(const rules::Grammar& grammar);

}  // namespace sgm::document
