// Words of other languages and programs, and what is written here.
#include <algorithm>
#include <span>

#include "grammar/syntax/hints.h"

namespace sgm::syntax {

namespace {

constexpr std::string_view shapeOfOnesOwn =
    "a shape of one's own is a rule: 'rule Part -> …', and what it is to know stands where it is used: "
    "'Part with n = 3'";

constexpr ForeignDeclaration foreignDeclarations[] = {
    {"import", "use", "write 'use'"},
    {"include", "use", "write 'use'"},
    {"require", "use", "write 'use'"},
    {"const", "let", "write 'let'"},
    {"var", "let", "there are no variables: write 'let'"},
    {"parameter", "param", "write 'param'"},
    {"attr", "param", "write 'param'"},
    {"module", "", shapeOfOnesOwn},
    {"def", "", shapeOfOnesOwn},
    {"function", "", "a value is named by 'let storey = 3m', a shape by 'rule Part -> …'"},
};

struct ForeignWord {
    std::string_view word, hint;
};
constexpr ForeignWord foreignAttributes[] = {
    {"translate", "write 'move'"},
    {"position", "write 'move'"},
    {"offset", "write 'move'"},
    {"rotate", "write 'turn'"},
    {"rotation", "write 'turn'"},
    {"scale", "write 'size'"},
    {"radius", "write 'size' with the whole extent: 'sphere size 2' has a radius of 1m"},
    {"diameter", "write 'size'"},
    {"width", "write 'size (x, y, z)': x is the width"},
    {"height", "write 'size (x, y, z)': y is the height"},
    {"depth", "write 'size (x, y, z)': z is the depth"},
    {"free", "write 'at free(…)'"},
    {"last", "write 'on last'"},
    {"material", "write 'of' and a material, as 'of stone', or 'color #c8b090'"},
    {"roughness", "write 'rough'"},
    {"metalness", "write 'metal'"},
    {"repeat",
     "a rule repeats: 'rule Storey repeat 3 -> …'; copies are 'for k in 1..3 { … }', parts of a split '{ … }3'"},
    {"comp", "write 'faces { front: Wall | side: Wall | top: Roof }'"},
    {"s", "write 'size'"},
    {"t", "write 'move'"},
    {"r", "write 'turn'"},
    {"difference", "write 'a - b'"},
    {"union", "write 'a + b'"},
    {"noise", "write 'displace billow(.05m, 2/m)' or 'displace fbm(.05m, 2/m, 4)'"},
    {"fbm", "write 'displace fbm(.05m, 2/m, 4)'"},
    {"intersection", "write 'a & b'"},
    {"linear_extrude", "write 'footprint rect(8, 6) extrude 3m block'"},
};

constexpr ForeignWord foreignFunctions[] = {
    {"mod", "write 'a % b'"},
    {"fmod", "write 'a % b'"},
    {"mix", "write 'lerp(a, b, t)'"},
    {"power", "write 'pow(x, y)'"},
    {"atan", "write 'atan2(rise, run)'"},
    {"rand", "write what is drawn as a range, '1m..3m'"},
    {"random", "write what is drawn as a range, '1m..3m'"},
    {"uniform", "write what is drawn as a range, '1m..3m'"},
    {"radians", "write an angle with its unit, '30deg'"},
    {"noise", "write 'fbm(size, octaves)'"},
    {"range", "write both ends, '1..5'"},
};

std::string hintIn(std::span<const ForeignWord> words, std::string_view word) {
    const auto row = std::find_if(words.begin(), words.end(), [&](const ForeignWord& w) { return w.word == word; });
    return row == words.end() ? std::string() : std::string(row->hint);
}

}  // namespace

const ForeignDeclaration* findForeignDeclaration(std::string_view word) {
    const auto row = std::find_if(std::begin(foreignDeclarations), std::end(foreignDeclarations),
                                  [&](const ForeignDeclaration& d) { return d.word == word; });
    return row == std::end(foreignDeclarations) ? nullptr : row;
}

std::string foreignAttributeHint(std::string_view word) { return hintIn(foreignAttributes, word); }

std::string foreignFunctionHint(std::string_view word) { return hintIn(foreignFunctions, word); }

}  // namespace sgm::syntax
