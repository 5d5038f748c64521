// Units and kinds: what may stand where.
#include <gtest/gtest.h>

#include "tests/rules/read.h"

namespace sgm::rules {
namespace {

struct Case {
    const char* body;
    const char* message;  ///< "" when it is fine
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.body; }

class Types : public testing::TestWithParam<Case> {};

TEST(Slips, AreReportedOnce) {
    EXPECT_EQ(checkedBody("start S -> cube ++ sphere at +x\n").messages(), "expected a shape, found '+'\n");
    EXPECT_EQ(checkedBody("start S -> cube\n  + morph(sphere cube, .5) at +x\n").messages().find('\n'),
              checkedBody("start S -> cube\n  + morph(sphere cube, .5) at +x\n").messages().size() - 1);
    EXPECT_EQ(checkedBody("use std/walls.sgm\nstart S -> stone\n").messages(),
              "expected a file's name in quotes, found 'std'\n");
    EXPECT_EQ(checkedBody("start S -> cube ++ sphere\nrule S -> spere\n").messages(),
              "expected a shape, found '+'\nunknown solid 'spere'\n")
        << "other declarations still speak";
}

TEST(Parameters, WholeNumbersBetweenZeroAndOneAreWarnedOf) {
    const auto said = [](const std::string& range) {
        return checkedBody("param n = " + range + "\nstart S -> cube size (1 + n)\n").messages();
    };
    EXPECT_EQ(said("1 in 0..1"), "warning: 'n' is a whole number, so it is 0 or 1 and nothing between\n");
    for (const char* real : {"1 in 0..1.0", ".5 in 0..1", "1m in 0..1", "1 in 0..2"}) EXPECT_EQ(said(real), "") << real;
}

TEST_P(Types, AreCheckedInTheRule) {
    const std::string prelude =
        "param n = 3 in 1..9\nparam w = 1m in 0..2m\nparam a = 9deg\nparam v = (1, 2, 3, 4, 5, 6)\nparam b = "
        "true\nparam c = flat of flat, steep\nstart S -> cube : A\n";
    const std::string use = "rule A when n + w / 1m + a / 1deg + v[+x] > 0 and b and c == flat -> nil\n";
    const Checked checked = checkedBody(prelude + use + "rule A repeat 2 -> " + GetParam().body + "\n");
    const std::string wanted = GetParam().message;
    EXPECT_EQ(checked.messages(), wanted.empty() ? wanted : wanted + "\n");
}

INSTANTIATE_TEST_SUITE_P(
    Rule, Types,
    testing::Values(
        Case{"+ cube size w at +x", ""}, Case{"+ cube size (w, 30%, 2) at +x", ""},
        Case{"+ cube size n * w at +x", "'*' can't follow the argument of 'size'"},
        Case{"+ cube size (n * w) at +x", ""},
        Case{"+ cube size (w * w * w * w) at +x", "a volume times a length is nothing a grammar can measure"},
        Case{"+ cube size (w * w) at +x",
             "'size' takes a length, a share (30%) or (x, y, z) of them, but this is an area"},
        Case{"+ cube size (w + a) at +x", "can't add a length and an angle"},
        Case{"+ cube size a at +x", "'size' takes a length, a share (30%) or (x, y, z) of them, but this is an angle"},
        Case{"+ cube size (1, 2) at +x",
             "'size' takes a length, a share (30%) or (x, y, z) of them, but this is a vector of 2"},
        Case{"+ cube size choose { n: 2m | 1: w } at choose { 3: +x | 1: -z } turn choose { 1: a | 1: 0deg }", ""},
        Case{"+ cube size choose { 1: 2m | 1: a } at +x", "can't choose between a length and an angle"},
        Case{"+ cube size choose { a: 2m | 1: w } at +x",
             "the weight of a choice takes a plain number, but this is an angle"},
        Case{"+ cube size choose { 0: 2m | 0: 1m } at +x", "all weights are 0, so nothing could be chosen"},
        Case{"+ cube size choose { -1: 2m | 1: 0 } at choose { 1: +x | 1: dor }",
             "a weight is no less than 0, not -1\n'size' is 0m, but must be at least 0.000001m, and at most 1000 "
             "km\nunknown joint 'dor'"},
        Case{"+ cube size 0 at +x", "'size' is 0m, but must be at least 0.000001m, and at most 1000 km"},
        Case{"+ cube size -1..1 at +x", "'size' is -1m, but must be at least 0.000001m, and at most 1000 km"},
        Case{"+ cube size 2..1 at +x", "the range runs backwards"}, Case{"+ cube turn a at +x", ""},
        Case{"+ cube turn 0 at +x", ""}, Case{"+ cube turn (0deg, a, 5deg) at +x", ""},
        Case{"+ cube turn (0, a, 0) at +x", ""},
        Case{"+ cube turn (0, 5, 0deg) at +x", "'turn' takes an angle (30deg), or three, but this is a plain number"},
        Case{"+ cube turn 5 at +x", "'turn' takes an angle (30deg), or three, but this is a plain number"},
        Case{"+ cube shift (10%, .2, 1m) at +x", ""},
        Case{"+ cube blend 30% at +x", "'blend' takes a length in metres, but this is a share (%)"},
        Case{"+ cube displace billow(.05m, 2.2/m) at +x", ""},
        Case{"+ cube displace billow(.05m, 2m) at +x",
             "the frequency of 'billow' takes a frequency (2.2/m), but this is a length"},
        Case{"+ cube displace fbm(.1, 2, 40) at +x", "noise has 1 … 8 octaves, not 40"},
        Case{"+ cube color #102030 rough .2 at +x", ""},
        Case{"+ cube color .2 at +x", "'color' takes a colour (#rrggbb), but this is a plain number"},
        Case{"+ cube color rgb(.1, .2, .3) at +x", ""},
        Case{"+ cube rough 1.5 at +x", "'rough' is 1.5, but must be 0 … 1"}, Case{"+ torus(.2) at +x", ""},
        Case{"+ torus(tube: 20%) at +x", ""}, Case{"+ torus(ring: .2) at +x", "'torus' has no parameter 'ring'"},
        Case{"+ cube at +x overlap 1m", "'overlap' takes a plain number, but this is a length"},
        Case{"+ cube size split.index", "unknown name 'split'"},
        Case{"+ torus(2m) at +x", "'tube' of 'torus' takes a plain number, but this is a length"},
        Case{"+ cube(1) at +x", "'cube' takes no parameters"},
        Case{"+ morph(cube, sphere) at +x", "'morph' takes two solids and a share, but 2 are given"},
        Case{"+ morph(cube, sphere, 2) at +x", "the share of a morph is 2, but must be 0 … 1"},
        Case{"for k in 1..2.5 { + cube at +x }", "a loop takes a whole number, but this may have a fraction"},
        Case{"for k in 1..round(2.5) { + cube size k at +x }", ""}, Case{"for d in (+x, -z) { + cube at d }", ""},
        Case{"for d in axes when v[d] > 2 { + cube at -d }", ""},
        Case{"for d in axes { + cube size d at +x }",
             "'size' takes a length, a share (30%) or (x, y, z) of them, but this is a direction"},
        Case{"for n in axes { + cube at +x }", "'n' names a parameter (line 2)"},
        Case{"when c == round { + cube at +x }", "it is never 'round', but one of flat, steep"},
        Case{"when not (n == 2) or b { + cube at +x }", ""},
        Case{"when n { + cube at +x }", "'when' takes something true or false, but this is a plain number"},
        Case{"when w < 5deg { + cube at +x }", "can't compare a length and an angle"},
        Case{"when count(A) < 5 { + cube at +x }", ""},
        Case{"when count(Q) < 5 { + cube at +x }", "'count' takes the name of a shape, and there is none called 'Q'"},
        Case{"+ cube size v[6] at +x", "there is no value number 6: the vector's are 0 … 5"},
        Case{"+ cube size min(w, 2m) at +x", ""},
        Case{"+ cube size min(w, a) at +x", "can't compare a length and an angle"},
        Case{"+ cube overlap max(0, 20%, 1m) at +x", "can't compare a share (%) and a length"},
        Case{"+ cube size lerp(1, 2) at +x", "'lerp' takes 3 arguments, but 2 are given"},
        Case{"+ cube size sin(w) at +x", "'sin' takes an angle (30deg), but this is a length"},
        Case{"+ cube size if(b, 1m, 2) at +x", ""}, Case{"+ cube size i at +x", ""},
        Case{"+ cube at +x overlap 2", "'overlap' is 2, but must be at most 1"},
        Case{"+ cube overlap .2", "'overlap' needs the joint it speaks of"}, Case{"+ cube at centre on any(+x)", ""},
        Case{"+ cube at centre on any(2)", "'any' takes a direction such as +x, but this is a plain number"},
        Case{"+ cube size 1 size 2 at +x", "'size' is given twice"}, Case{"- halfspace at +y", ""},
        Case{"& halfspace at +y", ""},
        Case{"morph halfspace by .5", "a halfspace has no end and can't be morphed: it may only cut"}));

}  // namespace
}  // namespace sgm::rules
