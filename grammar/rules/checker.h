// The checker at work: one Grammar being filled, and what its names mean so far.
// Enters: the Asts of a file and of what it uses, in the order they were used. Leaves: a filled Grammar and
// diagnostics. Assumes declare() runs before the rest: names may stand before they are declared.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "grammar/rules/check.h"
#include "grammar/rules/functions.h"
#include "grammar/rules/grammar.h"
#include "grammar/rules/make.h"
#include "grammar/rules/type.h"
#include "grammar/syntax/ast.h"

namespace sgm::rules {

/// A value with what it will be.
struct Typed {
    Expr expr;
    Type type;
};

inline Typed makeTyped(SourceSpan span, Value value) {
    const Type type = Type::of(value);
    return {makeConstant(span, std::move(value)), type};
}

/// What may be said at a spot of the grammar, and what was said so far in the rule around it.
struct Place {
    enum class Where : uint8_t {
        Constant,  ///< a parameter's default, a setting: plain values only
        Look,      ///< a terminal's colour or solid: parameters too
        Guard,     ///< before a rule's arrow: the matched shape and chance too
        Body,      ///< a rule's or a start's body
        Chain,     ///< the body of a rule with `repeat`: i, ~>, last, any
        Finally,   ///< after a chain: last
        Expect,    ///< a check's figures
    };
    explicit Place(Where where) : where(where) {}
    Where where;

    struct Local {
        std::string name;
        uint32_t index;
        Type type;
        bool counts = false;  ///< a whole number that goes up by one from one turn to the next
    };
    std::vector<Local> locals;                 ///< in sight, innermost last
    bool ofMap = false;                        ///< a map's formula: it stands at a place, but belongs to no shape
    uint32_t frame = 0;                        ///< locals so far, in sight or not
    std::map<std::string, uint32_t> ordinals;  ///< of each label in the body
    bool morphs = false;                       ///< an operator or a solid of the body morphs

    std::string attribute;  ///< what a range belongs to: names its draw
    uint32_t ranges = 0;    ///< ranges in it so far
    int axis = -1;          ///< 0 … 2: shares that meet lengths are of the scope along this axis; -1: they can't meet
    bool material = false;  ///< a material is asked for: terminals may lend theirs
    bool mixes = false;     ///< a share met a length since this was reset
    void enter(std::string name) {
        attribute = std::move(name);
        ranges = 0;
    }
};

struct RoadWord;

class Checker {
public:
    Checker(Grammar& grammar, syntax::Diagnostics& diagnostics, Loader load = {})
        : grammar_(grammar), diagnostics_(diagnostics), load_(std::move(load)) {}

    /// Names that stand in a line that couldn't be read may be declared there, and any name in a file that is missing:
    /// nothing is said of them.
    void suppressErrors(const syntax::Diagnostics& unread, bool missingFile);
    /// Takes the names an Ast declares and refuses doubles.
    void declare(const syntax::Ast& ast);
    /// Checks what stands behind the names.
    void parameters(const syntax::Ast& ast);
    void lsystems(const syntax::Ast& ast);
    void lets(const syntax::Ast& ast);
    void materials(const syntax::Ast& ast);
    void maps(const syntax::Ast& ast);
    void roads(const syntax::Ast& ast);
    void terminals(const syntax::Ast& ast);
    void productions(const syntax::Ast& ast);
    void checkDeclarations(const syntax::Ast& ast);  ///< derives, styles, checks
    /// A plain value: no parameters, no shape, no chance. Where `word` holds, a name stands for itself.
    std::optional<Value> plain(const syntax::Expr& e, bool word);
    /// Parameters of `ast` that nothing asks for.
    void unused(const syntax::Ast& ast);

private:
    friend class OperationChecker;

    // names.cpp
    void declareLet(const syntax::LetDecl& decl);
    void declareParameter(const syntax::ParamDecl& decl);
    void declareTerminals(const syntax::TerminalDecl& decl);
    void declareRule(const syntax::RuleDecl& decl);
    void collect(const syntax::Body& body);
    void collect(const syntax::Attribute& attribute);
    void collect(const std::vector<syntax::Case>& cases);
    SymbolId nonTerminal(const syntax::Name& name);
    bool twice(std::map<std::string, SourceSpan>& seen, const syntax::Name& name, std::string_view kind);
    std::vector<std::string> symbolNames(bool withRulesOnly) const;
    std::string nearest(std::string_view word, const std::vector<std::string>& candidates) const;

    /// What `load`, one of the loader's functions, makes of the file that `name` (a text) stands for; null after an
    /// error.
    template <class Load>
    auto readFile(const Load& load, const syntax::Expr& name) {
        std::string why = "no files can be read here";
        auto file = load ? load(name.text, *name.span.source, why) : nullptr;
        if (!file) diagnostics_.error(name.span, "can't use \"" + name.text + "\": " + why);
        return file;
    }
    /// The same, once a file: its place in `all`, where null stands for one that couldn't be read.
    using FilePlaces = std::map<std::pair<const syntax::Source*, std::string>, size_t>;
    template <class Pointer, class Load>
    size_t placeOfFile(FilePlaces& known, std::vector<Pointer>& all, const Load& load, const syntax::Expr& name) {
        const auto [at, fresh] = known.try_emplace({name.span.source, name.text}, all.size());
        if (fresh) all.push_back(readFile(load, name));
        return at->second;
    }
    std::optional<uint32_t> outlinesOf(const syntax::Expr& name);
    std::optional<uint32_t> imageOf(const syntax::Expr& name);

    // expressions.cpp
    Typed expression(Place& place, const syntax::Expr& e);
    Expr expression(Place& place, const syntax::Expr& e, Want want, std::string_view what);
    Typed infer(Place& place, const syntax::Expr& e);
    Typed number(const syntax::Expr& e);
    Typed name(Place& place, const syntax::Expr& e);
    Typed unknownName(const Place& place, const syntax::Expr& e);
    struct Constant;
    Typed constant(Place& place, const syntax::Expr& e, Constant& constant);
    bool mix(Place& place, Typed& a, Typed& b) const;
    Expr measured(Place& place, const syntax::Expr& e, Want want, std::string_view what);
    Typed member(Place& place, const syntax::Expr& e);
    Typed index(Place& place, const syntax::Expr& e);
    Typed tuple(Place& place, const syntax::Expr& e);
    Typed failed(SourceSpan span, std::string message, std::string hint = {});
    Typed unknown(SourceSpan span, const std::string& word, std::string message, std::string hint = {});
    Typed applied(Expr::Kind kind, Fn fn, SourceSpan span, std::vector<Typed> args);
    bool sameType(const Typed& a, const Typed& b, std::string_view verb);
    bool expectType(const Typed& value, Want want, std::string_view what, const syntax::Expr* written);

    // operators.cpp
    Typed call(Place& place, const syntax::Expr& e);
    Typed unknownFunction(const syntax::Expr& e);
    Typed countCall(Place& place, const syntax::Expr& e);
    Typed outlineCount(const syntax::Expr& e);
    Typed propertyCall(Place& place, const syntax::Expr& e, const Function& row);
    Typed placeCall(Place& place, const syntax::Expr& e, const Function& row);
    Typed unary(Place& place, const syntax::Expr& e);
    Typed binary(Place& place, const syntax::Expr& e);
    Typed comparedWord(Place& place, const syntax::Expr& e, const Type& other);
    Typed range(Place& place, const syntax::Expr& e);
    Typed ramp(Place& place, const syntax::Expr& e);
    Typed choice(Place& place, const syntax::Expr& e);
    Expr chance(Place& place, const syntax::Expr& e);
    const Place::Local* counter(const Place& place, SourceSpan span, std::string_view word, size_t alternatives);
    Expr weight(Place& place, const syntax::Expr& e);
    void checkWeights(const std::vector<const Expr*>& weights, SourceSpan span);

    // solids.cpp
    Solid solid(Place& place, const syntax::Expr& e);
    Solid namedSolid(Place& place, const syntax::Expr& e);
    Solid primitiveSolid(Place& place, const syntax::Expr& e, const field::Primitive& row);
    static Solid solidOfRow(SourceSpan span, const field::Primitive& row);
    void inRange(const Expr& expr, const field::Primitive& row, size_t index);
    Solid morphSolid(Place& place, const syntax::Expr& e);
    Solid combination(Place& place, const syntax::Expr& e);
    Expr primitiveArgument(Place& place, const syntax::Expr& e, const field::Primitive& row, size_t index);
    Expr fileArgument(const syntax::Expr& e, const field::Primitive& row);
    Expr choiceArgument(Place& place, const syntax::Expr& e, const field::PrimitiveParameter& parameter);
    Solid terminalSolid(const syntax::Name& name);
    void bounded(const Solid& solid, std::string_view verb);
    Solid composed(Solid solid);
    std::string unknownSolid(std::string_view word) const;

    // attributes.cpp
    Expr material(Place& place, const syntax::Expr& e);
    std::vector<Attribute> attributes(Place& place, Element& element, const std::vector<syntax::Attribute>& written);
    Expr joint(Place& place, const syntax::Expr& e);

    // bodies.cpp
    Body body(Place& place, const syntax::Body& written);
    Element element(Place& place, const syntax::Element& written);
    void shape(Place& place, const syntax::Element& written, Element& out);
    void content(Place& place, const syntax::Expr& e, Element& out);
    void loop(Place& place, const syntax::Element& written, Element& out);
    void choose(Place& place, const syntax::Element& written, Element& out);
    void let(Place& place, const syntax::Element& written, Element& out);
    Expr loopDomain(Place& place, const syntax::Expr& e, Type& type);
    void live(const syntax::Name& name, Element& out);
    const syntax::Attribute* contentOperation(const syntax::Element& written);
    void rule(const syntax::RuleDecl& decl);
    void start(const syntax::StartDecl& decl);

    // lsystems.cpp
    void declareLsystem(const syntax::LsystemDecl& decl);
    void lsystem(const syntax::LsystemDecl& decl);
    void production(const syntax::LsystemDecl::Production& written, Lsystem& out);
    void modules(Place& place, const std::vector<syntax::LsystemDecl::Module>& written,
                 std::vector<Lsystem::Module>& out);
    char letter(const syntax::Name& name);

    // maps.cpp
    void declareMap(const syntax::MapDecl& decl);
    void mapPicture(const syntax::MapDecl& decl, Map& map);
    void mapClasses(const syntax::MapDecl& decl, MapPicture& picture);
    void mapRange(const syntax::MapDecl& decl, MapPicture& picture);
    double costOf(const Expr& e) const;
    Typed mapValue(Place& place, const syntax::Expr& e, uint32_t index);
    Typed meanCall(Place& place, const syntax::Expr& e);

    // roads.cpp
    void declareRoads(const syntax::RoadsDecl& decl);
    void ownStreets(const syntax::Expr& file, Roads& out);
    void roadSetting(Place& place, const syntax::Setting& written, Roads& out);
    void roadNumber(Place& place, const syntax::Setting& written, const town::RoadParameter& row, Roads& out);
    Expr roadWord(Place& place, const syntax::Expr& e, const RoadWord& row);
    Expr roadPoint(Place& place, const syntax::Expr& e, std::string_view name);

    // declarations.cpp
    void parameter(const syntax::ParamDecl& decl);
    void usedDefaults(const syntax::Ast& ast);
    void terminal(const syntax::TerminalDecl& decl);
    void declaredJoint(const syntax::TerminalDecl::JointDecl& decl, std::vector<Joint>& joints);
    void look(const syntax::TerminalDecl& decl, Material& material, std::vector<Attribute>& open);
    void derive(const syntax::DeriveDecl& decl);
    void placeOf(const syntax::DeriveDecl::Step& step);
    std::vector<Setting> settings(const std::vector<syntax::Setting>& written);
    uint32_t startCalled(const syntax::Name& name);

    Grammar& grammar_;
    syntax::Diagnostics& diagnostics_;

    std::map<std::string, uint32_t> params_;
    std::vector<Value> defaults_;  ///< of all parameters
    std::map<std::string, SymbolId> symbols_;
    std::map<std::string, uint32_t> rules_;  ///< by name; unnamed ones as Cell#1
    std::set<uint32_t> usedParams_;
    std::set<uint32_t> brokenParams_;   ///< whose default could not be read: of no known type
    std::set<std::string> withNames_;   ///< set by `with` somewhere
    std::set<std::string> jointNames_;  ///< declared by a terminal or a primitive
    std::set<std::string> excused_;
    bool anythingExcused_ = false;  ///< a used file is missing, and nobody knows what it declares
    Loader load_;
    FilePlaces outlineFiles_;  ///< places in Grammar::outlines
    FilePlaces imageFiles_;    ///< places in Grammar::images
    FilePlaces meshFiles_;     ///< places in Grammar::meshes
    /// A file's constant: its text and, once it was read, its value.
    struct Constant {
        const syntax::LetDecl* decl = nullptr;
        std::optional<Typed> value;
        bool used = false, inWork = false;
    };
    std::map<std::string, Constant> lets_;
    std::map<std::string, uint32_t> maps_;
    std::vector<bool> mapIsKnown_;  ///< by map: checked, so that those below may ask it
    std::vector<double> mapCost_;   ///< by map: expressions that one answer takes
    std::set<SymbolId> ruled_;      ///< have a rule
    std::set<SymbolId> placed_;     ///< stand in a start, a body or behind a colon
    std::map<std::string, const syntax::TerminalDecl*> terminalDecls_;
    std::map<std::string, Solid> terminalSolids_;
    std::map<SymbolId, uint32_t> unnamedRules_;  ///< how many so far
    std::vector<std::string> terminalsInWork_;   ///< whose solids are being read: finds a = b, b = a
    std::map<std::string, SourceSpan> seenParams_, seenTerminals_, seenRules_, seenStarts_, seenStyles_, seenDerives_,
        seenLsystems_, seenMaps_, seenRoads_, seenLets_;
};

}  // namespace sgm::rules
