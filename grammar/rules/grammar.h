// The checked grammar ⟨V_T, V_N, R, I⟩ (SG-M definition 1): every name an index, every unit known, every range legal.
// Enters: an Ast, from `check`. Leaves: an immutable value that `derive` runs. Assumes its Sources outlive it (held
// here).
#pragma once

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "grammar/rules/expr.h"
#include "grammar/rules/maps.h"
#include "grammar/rules/plans.h"
#include "grammar/syntax/ast.h"
#include "modeler/core/provenance.h"
#include "modeler/field/primitives.h"
#include "modeler/image/image_file.h"
#include "modeler/plan/read.h"
#include "modeler/town/road_parameters.h"

namespace sgm::town {
struct OwnStreets;
}

namespace sgm::rules {

using syntax::Operation;
using syntax::Operator;
using syntax::SourceSpan;

/// A solid: what fills a scope.
struct Solid {
    enum class Kind : uint8_t { Primitive, Morph, Combination, Nil };
    Kind kind = Kind::Nil;
    SourceSpan span;
    const field::Primitive* primitive = nullptr;
    std::vector<Expr> args;        ///< Primitive: one per row parameter, defaults filled in
    std::vector<Solid> parts;      ///< Morph: two. Combination: parts with `op` between
    Operator op = Operator::None;  ///< Combination
    Expr amount;                   ///< Morph: a in 0 … 1 (eq. 14)
    uint32_t material = none;      ///< of the first terminal in it that has a look, index into Grammar::materials
};

/// What a footprint is drawn from.
struct PlanExpr {
    enum class Kind : uint8_t {
        Drawn,       ///< row, args: one a parameter
        Outline,     ///< args: points, vectors of two, all lengths or all shares of the scope
        Lsystem,     ///< the outline that Grammar::lsystems[index] draws
        Walls,       ///< args[0] wide, along what Grammar::lsystems[index] draws, or along the points that follow
        File,        ///< args[0]: which outline of Grammar::outlines[index], from 1
        Union,       ///< parts
        Difference,  ///< parts: the first less the others
    };
    Kind kind = Kind::Drawn;
    SourceSpan span;
    const PlanRow* row = nullptr;
    uint32_t index = 0;
    std::vector<Expr> args;
    std::vector<PlanExpr> parts;
    std::optional<Expr> at, turn;    ///< `at: (x, z)` and `turn: angle` of a part
    bool inShares = false;           ///< Outline: its points are shares
    std::vector<std::string> words;  ///< of `setback edges(…)`: one an argument of the attribute
};

/// An L-system: letters rewritten in parallel, read by a turtle.
struct Lsystem {
    /// A letter and the numbers in parentheses behind it.
    struct Module {
        char letter = 'F';
        std::vector<Expr> args;
    };
    struct Production {
        SourceSpan span;
        char letter = 'F';
        char before = 0, behind = 0;  ///< the letters that must stand beside it; 0: any
        uint32_t parameters = 0;      ///< how many numbers it has: the locals 0, 1, … of `when` and `modules`
        std::optional<Expr> when;
        std::vector<Module> modules;
        double weight = 1;
    };
    std::string name;
    SourceSpan span;
    std::vector<Module> axiom;
    std::vector<Production> productions;
    Expr passes, angle, step, shrink;  ///< a whole number; radians; metres; metres that each step takes from the next
};

/// A value that depends on the place in the plan: a picture laid over it, or a formula.
struct Map {
    std::string name;
    SourceSpan span;
    MapPicture picture;           ///< without a raster where there is a formula
    std::optional<Expr> formula;  ///< asks maps with a lower index alone
    Value like;                   ///< kind and unit of its values
};

/// What `roads` are asked for everywhere.
struct RoadExpressions {
    std::optional<Expr> pull, spread, water, park, height;  ///< asked everywhere
    std::optional<Expr> grid, rings, shore, contours;       ///< asked everywhere: weights of the field's parts
};

/// Roads that `network` grows (grammar/rules/roads.h has the rows).
struct Roads : RoadExpressions {
    std::string name;
    SourceSpan span;
    std::optional<Expr> from, centre;                 ///< places
    std::optional<Expr> pattern, turns, ends;         ///< words
    std::shared_ptr<const town::OwnStreets> streets;  ///< of a file, where growth begins; or null
    SourceSpan streetsSpan;                           ///< of the file's name
    std::vector<std::pair<const town::RoadParameter*, Expr>> numbers;
};

struct Body;

/// `place START { settings }`: what decides an object of its own.
struct Placing {
    SymbolId start = none;                            ///< the symbol of one of Grammar::starts
    std::vector<std::pair<uint32_t, Expr>> settings;  ///< parameters by index in Grammar::params
    std::vector<SourceSpan> spans;                    ///< of the settings' values
    std::optional<Expr> variety;                      ///< how many different objects chance may make; none: any
    bool onLot = false;                               ///< it grows in the scope where it is placed, over its plan
};

/// The block of a content operation (`split x { … }`): parts of the scope, a body in every one.
struct Parts {
    struct Part {
        SourceSpan span;
        std::string label;      ///< a word: `side`, or a tag
        Expr size;              ///< metres or a share of the scope; floating: a weight, in `{ … }*` wished metres
        bool floating = false;  ///< ~: shares what fixed sizes leave
        std::shared_ptr<const Body> body;
        std::vector<Part> repeated;  ///< of `{ … }*`; then size and body say nothing
        uint32_t local = none;       ///< the local that counts repetitions from 1
        bool atLeastOnce = false;    ///< `{ … }+`
        std::optional<Expr> times;   ///< `{ … }3`: how often it repeats; nothing: as often as fits
        /// Whether a draw decides about its size: a repetition then has sizes of its own.
        bool isDrawn = false;
    };
    /// `snap NAME t`: where cuts may move.
    struct Snap {
        SymbolId symbol = none;
        Expr reach;  ///< metres
        SourceSpan span;
    };
    SourceSpan span;
    const Operation* operation = nullptr;
    int axis = 0;            ///< 0 x, 1 y, 2 z
    std::vector<Expr> args;  ///< of the operation itself
    std::string edges;       ///< split along: the word of the edges it follows
    bool byArea = false;     ///< split: sizes are square metres of the plan
    std::optional<Snap> snap;
    uint32_t index = none;    ///< network: of Grammar::roads
    std::vector<Part> parts;  ///< in the order of the text
    Placing placing;          ///< place
};

/// What joins the tree when an element runs: nothing, a solid, a symbol, a group or the parts of a content operation.
class Content {
public:
    Content() = default;
    explicit Content(Solid solid) : value_(std::move(solid)) {}
    explicit Content(std::shared_ptr<const Body> group) : value_(std::move(group)) {}
    explicit Content(std::shared_ptr<const Parts> parts) : value_(std::move(parts)) {}
    static Content ofSymbol(SymbolId symbol) {
        Content content;
        content.value_ = SymbolUse{symbol};
        return content;
    }

    bool empty() const { return std::holds_alternative<std::monostate>(value_); }
    /// What the content is, or null (`none` of a symbol) where it is something else.
    const Solid* solid() const { return std::get_if<Solid>(&value_); }
    SymbolId symbol() const {
        const auto* use = std::get_if<SymbolUse>(&value_);
        return use ? use->id : none;
    }
    const Body* group() const { return pointed<Body>(); }
    const Parts* parts() const { return pointed<Parts>(); }

private:
    struct SymbolUse {
        SymbolId id;
    };
    template <class T>
    const T* pointed() const {
        const auto* held = std::get_if<std::shared_ptr<const T>>(&value_);
        return held ? held->get() : nullptr;
    }
    std::variant<std::monostate, Solid, SymbolUse, std::shared_ptr<const Body>, std::shared_ptr<const Parts>> value_;
};

/// One use of an operation, checked.
struct Attribute {
    const Operation* operation = nullptr;
    SourceSpan span;
    std::vector<Expr> args;
    std::shared_ptr<Solid> pattern;        ///< `clad`: an ornament with the thickness, tile and mirror said beside it
    SymbolId symbol = none;                ///< `clad`: the terminal that named the pattern
    std::shared_ptr<const PlanExpr> plan;  ///< `footprint`: what draws it
};

/// `at each(…)`: the faces of a block or a roof that a newcomer grows on, one each.
struct FaceChoice {
    enum class Kind : uint8_t { Side, Corner, Slope, Eave, Gable, Apex, Ridge, Hip, Valley };
    Kind kind = Kind::Side;
    std::string word;  ///< which of them: a word for edges (front, court, a tag); "side" for all
};
/// What `each(…)` calls them; sides are called by words for edges alone as well.
inline constexpr std::pair<std::string_view, FaceChoice::Kind> faceKinds[] = {
    {"side", FaceChoice::Kind::Side},   {"corner", FaceChoice::Kind::Corner}, {"slope", FaceChoice::Kind::Slope},
    {"eave", FaceChoice::Kind::Eave},   {"gable", FaceChoice::Kind::Gable},   {"apex", FaceChoice::Kind::Apex},
    {"ridge", FaceChoice::Kind::Ridge}, {"hip", FaceChoice::Kind::Hip},       {"valley", FaceChoice::Kind::Valley}};

/// `at`, `to`: which joints are asked for.
struct JointChoice {
    SourceSpan span;
    std::optional<FaceChoice> each;
    bool free = false;         ///< `free(…)`: one of the candidates `joints` (empty: all) that nothing has met
    std::vector<Expr> joints;  ///< each evaluates to an Axis or a Word (a named joint)
};

/// `on`: the shape of a chain whose joint is met.
struct HostChoice {
    enum class Kind : uint8_t { Last, Any, Each } kind = Kind::Last;
    SourceSpan span;
    Expr of;  ///< Any: a direction; Each: the symbol's index
};

struct Choice {
    Expr weight;
    std::shared_ptr<Body> body;
};

/// How an element joins what stands.
struct ElementJoin {
    Operator op = Operator::None;
    std::optional<JointChoice> at, to;
    std::optional<HostChoice> on;  ///< none: the matched shape
    bool inMatchedFrame = false;   ///< `%`, `scope`, `move` and the place are of the matched scope (grammar 2)
    SymbolId through = none;       ///< Difference: the shape above the matched one that it cuts
};

/// What control around bodies asks and repeats.
struct ElementControl {
    /// For: `local` runs over `over` (a Tuple whose args are the values, or a Range of whole numbers) where `guard`
    /// holds. Let: `local` becomes the value of `over`. Choose in a series: `local` counts its draws.
    uint32_t local = 0;
    Series series = Series::None;
    std::optional<Expr> over, guard;
    std::shared_ptr<Body> body;
    std::vector<Choice> choices;
};

struct Element : ElementJoin, ElementControl {
    enum class Kind : uint8_t { Shape, For, While, When, Choose, Let };
    Kind kind = Kind::Shape;
    SourceSpan span;
    std::vector<Attribute> prefix;  ///< change the matched scope
    Content content;
    std::vector<Attribute> attributes;
    SymbolId live = none;  ///< `: Name`
    uint32_t ordinal = 0;  ///< ordinal of this symbol in the rule's body: part of the child's key
    std::string label;     ///< key text: symbol or primitive name
};

/// Siblings, each a chain: a content and what its operators join on.
struct Body {
    SourceSpan span;
    std::vector<std::vector<Element>> siblings;
    bool grows = false;  ///< starts with an operator: the matched content stays
};

/// What a rule asks before it rewrites a shape.
struct RuleGuard {
    SymbolId beside = none;
    SymbolId after = none;    ///< it waits while a live shape of that name has a rule left
    bool besideWins = false;  ///< `beside` that holds wins over rules without a guard (grammar 2)
    std::optional<Expr> when, repeat;
    std::optional<Expr> weight;
};

struct Rule : RuleGuard {
    std::string name;  ///< "R0", or "Cell#2" for the second unnamed rule of Cell
    SymbolId symbol = none;
    SourceSpan span;
    SourceSpan symbolSpan;  ///< the symbol it matches: what messages about the rule point at
    Body body;
    std::optional<Body> finally_;
    bool morphic = false;         ///< R_M: its body morphs; else R_C
    bool finallyMorphic = false;  ///< the same of `finally_`, which is a step of its own
    uint32_t locals = 0;          ///< frame size for `for` variables and `i`
    uint32_t stepLocal = none;    ///< the local that holds i in 1 … n of `repeat`
};

struct Joint {
    std::string name;
    Vec3d at;      ///< shares of the half-size, −1 … 1
    Vec3d facing;  ///< unit, or zero
};

struct Symbol {
    std::string name;
    bool terminal = false;
    bool isMaterial = false;  ///< a look alone, declared by `material`
    SourceSpan span;
    std::optional<Solid> solid;  ///< terminal with a solid; without one it is a cube
    uint32_t material =
        none;  ///< index into Grammar::materials, where colour or roughness were given (at default parameters)
    std::vector<Attribute>
        look;  ///< those of Color, Rough, Metal that depend on parameters: they act on every shape of the symbol
    std::vector<Joint> joints;    ///< declared ones, besides the solid's own
    std::vector<uint32_t> rules;  ///< rules for it, in file order
};

struct Param {
    std::string name, label, group, key;
    SourceSpan span;
    SourceSpan valueSpan;         ///< what a GUI rewrites: the default, or what a `use` sets in its place
    Value value;                  ///< default
    std::optional<Value> lo, hi;  ///< range, inclusive, per component
    std::vector<std::string> choices;
};

struct Start {
    SymbolId symbol;
    SourceSpan span;
    Body body;
    uint32_t locals = 0;
};
struct Derive {
    std::string name;
    SourceSpan span;
    struct Step {
        uint32_t rule;
        std::string place;
        SourceSpan span;
    };
    std::vector<Step> steps;
};
struct Setting {
    uint32_t param;
    Value value;
    SourceSpan span;
    SourceSpan valueSpan;  ///< what a GUI rewrites
};
struct Style {
    std::string name;
    uint32_t start = none;
    std::vector<Setting> settings;
    SourceSpan span;
};
struct Check {
    uint32_t start;
    std::vector<Setting> settings;
    Expr expect;
    SourceSpan span;
};

/// A name that shapes `report` numbers under, which are summed.
struct Report {
    std::string name;
    Value like;  ///< kind and unit of its numbers
    SourceSpan span;
};

/// What a grammar was read from.
struct GrammarFiles {
    std::vector<syntax::SourcePtr> sources;  ///< sources[0] is the file itself, the rest came by `use`
    std::vector<int> versions;               ///< by source: the version of the language it is written in
    std::vector<std::shared_ptr<const plan::Features>> outlines;  ///< of files that footprints name, each once
    std::vector<image::ImageFilePtr> images;                      ///< of textures, each once; null: unreadable
    std::vector<field::SampledGridPtr> meshes;                    ///< of a solid's File argument, by its n[0]
};

struct Grammar : GrammarFiles {
    std::vector<Symbol> symbols;
    std::vector<Param> params;
    std::vector<Material> materials;  ///< materials[0] is the default
    std::vector<Rule> rules;
    std::vector<Start> starts;
    std::vector<Derive> derives;
    std::vector<Lsystem> lsystems;
    std::vector<Map> maps;
    std::vector<Roads> roads;
    std::vector<Style> styles;
    std::vector<Check> checks;
    std::vector<Report> reports;
    std::set<std::string, std::less<>> properties;  ///< of outlines, which values and words ask for
};

}  // namespace sgm::rules
