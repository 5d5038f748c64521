// The table of functions that expressions may call.
// Enters: nothing. Leaves: rows. Assumes evaluate.cpp gives each Fn its meaning.
#pragma once

#include <span>
#include <string_view>

#include "grammar/rules/grammar.h"

namespace sgm::rules {

/// What a function asks of its arguments.
enum class Signature : uint8_t {
    Alike,     ///< numbers or vectors whose units can meet
    Plain,     ///< plain numbers
    Root,      ///< a plain number, or an area
    Angle,     ///< one angle
    Lerp,      ///< two alike numbers, vectors or colours, and a plain number
    If,        ///< a condition and two alike values
    Symbol,    ///< the name of a shape
    Mean,      ///< a number that depends on the place
    File,      ///< the name of a file in quotes; known when the grammar is read
    Property,  ///< the name of a property in quotes, and what it is where the file says nothing
    Place,     ///< a place or a length, and numbers; its value depends on where it is asked
};

struct Function {
    std::string_view name;
    Fn fn;
    uint8_t least, most;  ///< how many arguments
    Signature signature;
    std::string_view doc;
};

std::span<const Function> functions();
/// The row called `name`, or null.
const Function* findFunction(std::string_view name);

}  // namespace sgm::rules
