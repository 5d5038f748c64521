// Grammars by chance: sound texts that put solids together in every way the language has.
// Enters: a key. Leaves: a grammar's text, decided by it alone. Assumes nothing.
#pragma once

#include <string>

#include "modeler/core/random.h"

namespace sgm::testing_ {

class RandomGrammar {
public:
    explicit RandomGrammar(uint64_t key) : key_(key) {}

    std::string text() {
        std::string out =
            "grammar 2\nuse \"std/kifs.sgm\"\nstart A -> size " + vector(2, 9) + " " + block(topmost) + "\n";
        for (const char* name : {"B", "C"}) out += std::string("rule ") + name + " -> " + block(2) + "\n";
        return out + "rule D -> " + solid() + "\n";
    }

private:
    static constexpr int topmost = 3;
    uint64_t draw(uint64_t count) { return pick(key_ = mix(key_ + 1), count); }
    template <size_t n>
    std::string oneOf(const char* const (&list)[n]) {
        return list[draw(n)];
    }
    /// Round numbers and others, so that faces coincide now and then.
    std::string number(double lo, double hi) {
        const double at = lo + (hi - lo) * static_cast<double>(draw(1001)) / 1000;
        const double rounded = draw(3) == 0 ? at : static_cast<double>(static_cast<int>(at * 4)) / 4;
        return std::to_string(rounded < lo ? lo : rounded);
    }
    std::string vector(double lo, double hi) {
        return "(" + number(lo, hi) + ", " + number(lo, hi) + ", " + number(lo, hi) + ")";
    }
    std::string joint() { return oneOf({"+x", "-x", "+y", "-y", "+z", "-z"}); }

    std::string solid() {
        return oneOf({"cube", "sphere", "cylinder", "cone", "pyramid", "torus", "prism", "roof(.3)", "cube", "cube",
                      "morph(cube, sphere, .4)", "morph(cylinder, cone, .7)"});
    }

    /// What follows a newcomer: where it stands and how.
    std::string attributes(bool shared) {
        std::string out = " size " + (draw(3) == 0 ? number(20, 120) + "%" : vector(.3, 4));
        if (draw(2) == 0) out += " at " + joint() + (draw(3) == 0 ? " to centre" : "");
        if (draw(4) == 0) out += " turn (" + number(-90, 90) + "deg, " + number(-90, 90) + "deg, 0deg)";
        if (draw(4) == 0) out += " move " + vector(-1, 1);
        if (!shared && draw(6) == 0) out += " blend " + number(.1, .6) + "m";
        return out;
    }

    std::string sum() {
        std::string out = solid();
        if (draw(3) == 0) out += " size " + vector(1, 6);
        for (uint64_t k = draw(4); k > 0; --k) {
            const std::string how = oneOf({" + ", " + ", " - ", " - ", " & "});
            out += how + solid() + attributes(how == " & ");
        }
        if (draw(9) == 0) out += " displace billow(.08m, 2/m)";
        if (draw(12) == 0) out += " clad palazzo";
        return "(" + out + ")";
    }

    std::string part(int depth) {
        if (depth == topmost && draw(3) == 0) return oneOf({"B", "C"});
        if (depth > 0 && draw(2) == 0) return block(depth - 1);
        return draw(3) == 0 ? "D" : sum();
    }

    std::string block(int depth) {
        const std::string axis = oneOf({"x", "y", "z"});
        switch (draw(9)) {
            case 0:
                return "split " + axis + " { ~1: " + part(depth) + " | " + number(.2, 2) + "m: " + part(depth) +
                       " | ~" + number(.5, 2) + ": " + part(depth) + " }";
            case 1:
                return "row " + std::to_string(2 + draw(3)) + " along " + axis + " gap " + number(0, .5) + "m { " +
                       part(depth) + " }";
            case 2:
                return "around " + std::to_string(3 + draw(4)) + " radius " + number(1, 4) + "m { " + part(depth) +
                       " }";
            case 3:
                return "mirror " + axis + " { " + part(depth) + " }";
            case 4:
                return "footprint " +
                       oneOf({"ell(9, 8, 3, 4)", "tee(9, 8, 3, 3)", "yard(9, 8, 2)", "ngon(7)", "ring(12, 9, 3)",
                              "round(12)"}) +
                       " extrude " + number(2, 5) + "m (cube + " +
                       oneOf({"hipRoof(35deg)", "gableRoof(40deg)", "mansardRoof()", "domeRoof()", "shedRoof(20deg)"}) +
                       " at +y)";
            case 5:
                return "footprint " + oneOf({"ell(9, 8, 3, 4)", "yard(9, 8, 2)"}) +
                       " extrude 4m faces .4m { side: " + part(0) + " | top: cube | rest: cube }";
            case 6:
                return "(cube + cylinder from " + vector(-3, 3) + " to " + joint() + " size " + number(.2, 1) + "m)";
            default:
                return sum();
        }
    }

    uint64_t key_;
};

}  // namespace sgm::testing_
