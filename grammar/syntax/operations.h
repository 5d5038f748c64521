// What a rule operation is: the words a rule body may use on a shape, and what each stage does with them.
// Enters: nothing. Leaves: the type of a row and of the table. Assumes grammar/operations defines the rows, one file a
// family: the parser reads names and arguments from a row, the checker calls `check` and `agree`, derivation `apply`
// and `run`.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string_view>

namespace sgm {
struct Material;
}
namespace sgm::rules {
class OperationChecker;
struct Attribute;
struct Element;
struct Parts;
struct Value;
}  // namespace sgm::rules
namespace sgm::derive {
struct AttributeContext;
class PartsContext;
}  // namespace sgm::derive

namespace sgm::syntax {

struct Attribute;

/// What an argument of an operation is.
enum class ArgumentType : uint8_t {
    Number,    ///< plain number; also percent
    Length,    ///< metres; bare numbers are metres
    Angle,     ///< degrees
    Rotation,  ///< one angle about y, or three about x, y and z
    Size,      ///< a length, a share (30%) or a vector of them; one number scales all three axes
    Vector,    ///< up to three numbers or lengths; one number counts for every axis
    Color,     ///< #rrggbb
    Joint,     ///< a joint name, `centre`, `free(…)`, or a `for … in axes` variable
    Shape,     ///< `last`, `any(d)`, `each(Name)`
    Noise,     ///< billow(amplitude, frequency), fbm(amplitude, frequency [, octaves])
    Solid,     ///< a terminal or solid expression
    Axis,      ///< x, y or z
    Name,      ///< a bare word (a tag)
    Start,     ///< the name of a start
    Plan,      ///< a plan by name, ell(16, 12, 5, 6), or a number
    Symbol,    ///< the name of a shape that rules rewrite
    Material,  ///< a `material` by name, or a value that holds one
    Cut,       ///< how a split goes: an axis; `along WORD`, along edges; `area x`, by square metres along an axis
    Point,     ///< a point (x, y, z), or a joint
    File,      ///< the name of a file in quotes
};

/// "a length", "a joint": an argument's type in words.
std::string_view describe(ArgumentType type);

struct OperationArgument {
    std::string_view name;
    ArgumentType type;
    std::string_view doc;
    bool optional = false;
    std::string_view word{};  ///< a word that stands before it: the `to` of 'from P to Q'
};

/// Numbers that an operation takes, per component; both ends included.
struct OperationRange {
    double lo = -std::numeric_limits<double>::infinity(), hi = std::numeric_limits<double>::infinity();
    std::string_view text;         ///< "at most 1": what a message says that the number must be; empty: any number
    std::string_view ofZero = {};  ///< what to write instead of a 0 that it isn't; "" for nothing
};

struct Operation;

/// The block of an operation.
struct OperationBlock {
    std::string_view label{};              ///< a label that fits its { label: body | … }; empty: it has none
    bool isBody = false;                   ///< it is a body without labels: { body }
    const Operation* operation = nullptr;  ///< the operation of that name whose block begins behind one axis
};

/// Where an operation may be said.
struct OperationTraits {
    bool repeatable = false;     ///< may be said several times of one shape
    bool stacks = false;         ///< may be said several times from `grammar 2` on, one after the other
    bool beforeShape = false;    ///< may stand before a shape without an operator
    bool namesValue = false;     ///< its first argument is a name, followed by '=': rules below may read it
    bool takesSettings = false;  ///< { name = value … } may follow its arguments
    bool turnsShape = false;     ///< may leave the newcomer's joints in other directions
};

/// One rule operation. Behaviour that a row leaves out falls back to what most operations do.
struct Operation {
    /// When an operation acts, in this order.
    enum class Phase : uint8_t {
        Scope,      ///< on size and axes; before a shape it changes the matched scope
        Placement,  ///< on how a newcomer joins what stands
        Look,       ///< on the material; a terminal may carry it
        Whole,      ///< on all that the shape holds; needs no shape beside it
        Detail,     ///< on what another operation said; checked after all others
        Content,    ///< is the shape's content: makes parts of the scope, and runs a body in each
    };
    using Check = void (*)(rules::OperationChecker& checker, const Attribute& written);
    using Agree = void (*)(rules::OperationChecker& checker, const rules::Element& element,
                           const rules::Attribute& attribute);
    using Apply = void (*)(derive::AttributeContext& context, const rules::Attribute& attribute);
    using Decorate = void (*)(const rules::Value& value, Material& material);
    using CheckParts = std::shared_ptr<rules::Parts> (*)(rules::OperationChecker& checker, const Attribute& written);
    using Run = bool (*)(derive::PartsContext& context, const rules::Parts& parts);

    std::string_view name;
    std::string_view doc;
    std::string_view example;
    std::span<const OperationArgument> arguments{};
    Phase phase = Phase::Scope;
    OperationRange range{};
    OperationBlock block{};
    OperationTraits traits{};
    /// Checks the arguments and adds an attribute; null: every argument as its type asks, numbers within `range`.
    Check check = nullptr;
    /// Refuses what contradicts the element's operator or its other attributes; null: nothing does.
    Agree agree = nullptr;
    /// Evaluates the attribute for a newcomer or the matched shape; null: nothing to evaluate (it was checked into the
    /// element).
    Apply apply = nullptr;
    /// Phase Look: gives a terminal's material a constant value.
    Decorate decorate = nullptr;
    /// Phase Content: checks the block; and what makes its parts in derivation, false after a failure.
    CheckParts checkParts = nullptr;
    Run run = nullptr;

    bool hasBlock() const { return !block.label.empty() || block.isBody; }
};

/// The operations of a language, by name.
class OperationTable {
public:
    constexpr OperationTable() = default;
    /// `rows` must outlive the table.
    constexpr explicit OperationTable(std::span<const Operation* const> rows) : rows_(rows) {}

    std::span<const Operation* const> rows() const { return rows_; }
    /// The row called `name`, or null.
    const Operation* find(std::string_view name) const;

private:
    std::span<const Operation* const> rows_;
};

}  // namespace sgm::syntax
