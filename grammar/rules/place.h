// A spot of the grammar while it is checked.
// Enters: what stands around the spot. Leaves: what may be said there. Assumes one Place a body, declaration or figure.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "grammar/rules/type.h"

namespace sgm::rules {

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
    bool isInPart = false;                     ///< of a scope that is split, mirrored or repeated: it begins empty
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
    /// Takes the locals out of sight that came after the first `outside` ones.
    void leave(size_t outside) { locals.resize(outside, Local{{}, 0, Type::unknown()}); }
};

}  // namespace sgm::rules
