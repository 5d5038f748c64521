// What the checks of a grammar share: the Grammar being filled, and what its names mean so far.
// Enters: the Asts of a file and of what it uses, in the order they were used. Leaves: a filled Grammar and
// diagnostics. Assumes declareNames() runs before the other passes: names may stand before they are declared.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "grammar/rules/check.h"
#include "grammar/rules/file_tables.h"
#include "grammar/rules/grammar.h"
#include "grammar/rules/typed.h"
#include "grammar/syntax/ast.h"

namespace sgm::rules {

/// A file's constant: its text and, once it was read, its value.
struct Constant {
    const syntax::LetDecl* decl = nullptr;
    std::optional<Typed> value;
    bool used = false, inWork = false;
};

/// A value that `with` sets: where first in the file itself (no source: in none), and whether an expression reads it.
struct InheritedName {
    SourceSpan span;
    bool used = false;
};

/// A live shape's name that no rule matches, although a rule matches a similar one.
struct MaybeMisspelt {
    SourceSpan span;
    SymbolId symbol = none;
    std::string hint;
};

/// What a name means. Indices are into the lists of the Grammar.
struct NameTable {
    std::map<std::string, uint32_t> params;
    std::map<std::string, SymbolId> symbols;
    std::map<std::string, uint32_t> rules;  ///< by name; unnamed ones as Cell#1
    std::map<std::string, uint32_t> maps;
    std::map<std::string, Constant> lets;
    std::map<std::string, const syntax::TerminalDecl*> terminals;
    std::map<std::string, InheritedName> inherited;
    std::set<std::string> joints;               ///< declared by a terminal or a primitive
    std::set<SymbolId> ruled;                   ///< have a rule
    std::set<SymbolId> referenced;              ///< by count(Name), on each(Name), beside Name …
    std::vector<MaybeMisspelt> misspelt;        ///< perhaps
    std::map<SymbolId, uint32_t> unnamedRules;  ///< how many so far
};

/// Where each name was declared first, by kind of declaration.
struct Declared {
    using Spans = std::map<std::string, SourceSpan>;
    Spans params, lets, terminals, rules, starts, styles, derives, lsystems, maps, roads;
    Spans ruledSymbols;  ///< the first rule for each symbol in the last file that has one
};

/// What is known of parameters beyond their declarations.
struct ParameterState {
    std::vector<Value> defaults;  ///< of all parameters
    std::set<uint32_t> used;
    std::set<uint32_t> broken;  ///< whose default could not be read: of no known type
};

/// What is known of maps, by map.
struct MapState {
    std::vector<bool> isKnown;  ///< checked, so that those below may ask it
    std::vector<double> cost;   ///< expressions that one answer takes
};

/// The solids that terminals stand for.
struct TerminalSolids {
    std::map<std::string, Solid> known;
    std::vector<std::string> inWork;  ///< being read: finds a = b, b = a
};

/// Names of which nothing is said: those in a line that couldn't be read may be declared there, and any name in a file
/// that is missing.
class SuppressedNames {
public:
    void read(const syntax::Diagnostics& unread, bool missingFile);
    /// `word` stands in a line that couldn't be read.
    bool contains(const std::string& word) const { return words_.contains(word); }
    /// `word` may be declared in what couldn't be read.
    bool covers(const std::string& word) const { return all_ || contains(word); }

private:
    std::set<std::string> words_;
    bool all_ = false;  ///< a used file is missing, and nobody knows what it declares
};

/// A `value` of what files say of outlines.
struct OutlineValue {
    std::string property;
    Unit unit = Unit::None;  ///< of what stands for it
    SourceSpan span;
};

/// What every check takes: where its product and its messages go, and what names mean.
struct CheckContext {
    CheckContext(Grammar& filled, syntax::Diagnostics& found, Loader load = {})
        : grammar(filled), diagnostics(found), files(filled, found, std::move(load)) {}

    Grammar& grammar;
    syntax::Diagnostics& diagnostics;
    FileTables files;
    SuppressedNames suppressed;
    NameTable names;
    Declared seen;
    ParameterState params;
    MapState maps;
    TerminalSolids solids;
    std::vector<OutlineValue> outlineValues;
};

}  // namespace sgm::rules
