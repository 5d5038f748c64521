// The syntax tree of a grammar file, every node with its span.
// Enters: tokens, from the parser. Leaves: what was written, names unresolved. Assumes the Source outlives it (held
// here).
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "grammar/syntax/operations.h"
#include "grammar/syntax/source.h"

namespace sgm::syntax {

/// A word with its place.
struct Name {
    std::string text;
    SourceSpan span;
    bool empty() const { return text.empty(); }
};

/// An expression. One struct for all kinds: children in `args`, words in `text`.
struct Expr {
    enum class Kind {
        Number,    ///< number, with `unit` ("m", "deg", "%", "/m", "")
        Floating,  ///< ~args[0]: a share of what is left in a split
        Text,      ///< "…": text
        Color,     ///< #rrggbb: number holds 0xrrggbb
        Name,      ///< text; axes are words too: "+x", "-z"
        Member,    ///< args[0].text, as scope.x
        Index,     ///< args[0][args[1]]
        Call,      ///< text(args…), argNames[i] is "" for a positional argument
        Tuple,     ///< (args…), two or more
        Unary,     ///< text is "-" or "not"
        Binary,    ///< text is + - * / % < <= > >= == != and or
        Range,     ///< args[0]..args[1]
        Ramp,      ///< args[0] ~> args[1]
        Choose,    ///< choose { args[0]: args[1] | args[2]: args[3] … }: weights and values; text is "", "distinct"
                   ///< or "shuffled"
        Error,     ///< stands where an expression could not be read; a diagnostic was given
    };
    Kind kind = Kind::Error;
    SourceSpan span;    ///< with its parentheses, where it has some
    double number = 0;  ///< as written: 30% is 30 with the unit "%"
    std::string unit, text;
    std::vector<Expr> args;
    std::vector<std::string> argNames;
};

/// How an element joins what stands. None: it is the content (or stands beside it, after a comma).
enum class Operator : uint8_t { None, Sum, Difference, Intersection, Morph };

struct Body;

/// label: body in a split, inset, faces or choose block; `{ … }*` repeats its cases.
struct Case {
    SourceSpan span;
    std::optional<Expr> label;  ///< a size, a weight, or a word ("rim", "side"); empty for `tag K` and a repeated group
    Name tag;                   ///< the K of `tag K:`
    bool repeated = false;      ///< { cases }*
    bool atLeastOnce = false;   ///< { cases }+
    std::optional<Expr> times;  ///< { cases }3
    std::vector<Case> cases;    ///< of a repeated group
    std::shared_ptr<Body> body;
};

/// `name = value` between braces.
struct Setting {
    SourceSpan span;
    Name name;
    Expr value;
};

/// `size 2 ~> 1.2`, `at free(+x)`, `split y { … }`: one use of an operation.
struct Attribute {
    SourceSpan span;
    Name name;
    const Operation* operation = nullptr;
    std::vector<Expr> args;         ///< one per row argument that was given; of `with a = 2m`: the Name a, then 2m
    std::vector<Case> cases;        ///< for operations with a block
    std::vector<Setting> settings;  ///< for operations with settings
};

/// One step of a body: an operator, a solid or symbol, and the attributes that bind to it; or control around more.
struct Element {
    enum class Kind { Shape, Group, For, While, When, Choose, Let };
    Kind kind = Kind::Shape;
    SourceSpan span;
    Operator op = Operator::None;
    std::vector<Attribute> before;  ///< prefix attributes (change the matched scope when there is no operator)
    std::optional<Expr> solid;      ///< Shape: a Name or Call; empty when only attributes are given (all in `before`)
    std::vector<Attribute> after;
    Name live;                   ///< `: Name`
    std::shared_ptr<Body> body;  ///< Group: ( … ); For, While, When: { … }
    Name variable;               ///< For and Let: the word behind it; Choose: `distinct`, `shuffled` or empty
    std::optional<Expr> over;    ///< For: what follows `in`; While and When: the condition; Let: the value
    std::optional<Expr> guard;   ///< For: what follows `when`
    std::vector<Case> cases;     ///< Choose: weight: body
};

/// Siblings by comma; each a chain of elements joined by operators.
struct Body {
    SourceSpan span;
    std::vector<std::vector<Element>> siblings;
};

struct ParamDecl {
    SourceSpan span;
    Name name;
    Expr value;                 ///< default
    std::optional<Expr> range;  ///< after `in`
    std::vector<Name> choices;  ///< after `of`
    std::string label, group;
    Name key;
};
struct MapDecl {
    SourceSpan span;
    Name name;
    Expr file;  ///< a text; nothing where there is a formula
    std::optional<Expr> formula;
    std::optional<Expr> range;  ///< after `as`: what black and white stand for
    std::optional<Expr> over;   ///< metres along x and z
    struct Class {
        SourceSpan span;
        std::optional<Expr> color;
        Name word;
    };                           ///< without a colour: `else`
    std::vector<Class> classes;  ///< after `of`
};
struct RoadsDecl {
    SourceSpan span;
    Name name;
    std::optional<Expr> file;  ///< after `from`: a text, of streets that are there already
    std::vector<Setting> settings;
};
struct LetDecl {
    SourceSpan span;
    Name name;
    Expr value;
};
/// A `terminal`, or a `material`, which is a look without a solid.
struct TerminalDecl {
    SourceSpan span;
    bool isMaterial = false;
    std::vector<Name> names;  ///< several may share a line
    std::vector<Attribute> attributes;
    std::optional<Expr> solid;  ///< after `=`
    struct JointDecl {
        SourceSpan span;
        Name name;
        Expr at, facing;
    };
    std::vector<JointDecl> joints;
};
struct StartDecl {
    SourceSpan span;
    Name symbol;
    Body body;
};
struct RuleDecl {
    SourceSpan span;
    Name name;  ///< R0, or empty
    Name symbol;
    Name beside, after;
    std::optional<Expr> when, weight, repeat;
    Body body;
    std::optional<Body> finally_;
};
struct DeriveDecl {
    SourceSpan span;
    Name name;
    struct Step {
        Name rule;
        Expr at;
        bool hasPlace = false;
        std::string place;
    };  ///< place "Cave/Cell[3]"
    std::vector<Step> steps;
};
struct StyleDecl {
    SourceSpan span;
    Name name, start;
    std::vector<Setting> settings;
};
struct CheckDecl {
    SourceSpan span;
    Name start;
    std::vector<Setting> settings;
    std::optional<Expr> expect;
};
struct UseDecl {
    SourceSpan span;
    Expr file;
    std::vector<Setting> settings;
};
struct LsystemDecl {
    SourceSpan span;
    Name name;
    std::vector<Setting> settings;  ///< passes, angle, step
    /// A letter of an axiom or a production: F, or F(l * .9).
    struct Module {
        SourceSpan span;
        char letter = 'F';
        std::vector<Expr> args;
    };
    Expr axiom;  ///< the text, with its quotes
    std::vector<Module> axiomModules;
    struct Production {
        SourceSpan span;
        Name before, symbol, behind;   ///< before < symbol > behind
        std::vector<Name> parameters;  ///< A(l, w)
        Expr text;
        std::vector<Module> modules;
        std::optional<Expr> when, weight;
    };
    std::vector<Production> productions;
};

/// One file, declarations by kind in file order.
struct Ast {
    SourcePtr source;
    const OperationTable* operations = nullptr;  ///< of the language it was read in
    int version = 1;
    std::vector<UseDecl> uses;
    std::vector<ParamDecl> params;
    std::vector<LetDecl> lets;
    std::vector<MapDecl> maps;
    std::vector<TerminalDecl> terminals;
    std::vector<StartDecl> starts;
    std::vector<RuleDecl> rules;
    std::vector<DeriveDecl> derives;
    std::vector<LsystemDecl> lsystems;
    std::vector<RoadsDecl> roads;
    std::vector<StyleDecl> styles;
    std::vector<CheckDecl> checks;
};

}  // namespace sgm::syntax
