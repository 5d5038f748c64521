// Where the names of a grammar stand: what each word of a text refers to.
// Enters: syntax trees. Leaves: occurrences in the order of the text. Assumes the trees' sources are kept.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "grammar/syntax/ast.h"

namespace sgm::language {

enum class NameKind : uint8_t {
    Symbol,     ///< a shape: `rule Cell`, `start House`, `terminal stone`
    Parameter,  ///< `param`
    Value,      ///< what `with` sets
    Local,      ///< what `for` runs through, and a body's own `let`
    Rule,       ///< the name before a rule's symbol
    Joint,      ///< declared by a terminal
    Style,
    Way,  ///< `derive`
    Lsystem,
    Map,
    Tag,
    Constant,  ///< a file's `let`
};

/// One name at one place.
struct Occurrence {
    NameKind kind = NameKind::Symbol;
    std::string name;
    syntax::SourceSpan span;
    bool defines = false;            ///< it stands where the name is declared; a symbol has a place for each rule
    syntax::SourceSpan declaration;  ///< where it defines: the whole declaration
    uint32_t scope = 0;              ///< of a Local: where its `for` begins
};

/// Whether two occurrences mean the same thing.
inline bool same(const Occurrence& a, const Occurrence& b) {
    return a.kind == b.kind && a.name == b.name &&
           (a.kind != NameKind::Local || (a.scope == b.scope && a.span.source == b.span.source));
}

/// The names that a grammar and the files it uses declare, by kind.
struct Known {
    std::set<std::string, std::less<>> symbols, parameters, values, rules, joints, styles, ways, lsystems, maps,
        constants;
    std::map<std::string, std::vector<std::string>, std::less<>> choices;  ///< of parameters

    void add(const syntax::Ast& ast);
};

/// All names of a text. What is a word of the language, a primitive or unknown has no occurrence.
std::vector<Occurrence> occurrencesOf(const syntax::Ast& ast, const Known& known);

/// The occurrence that holds or touches a byte offset, or null.
const Occurrence* occurrenceAt(const std::vector<Occurrence>& all, uint32_t offset);

}  // namespace sgm::language
