// The parser on good input: the language's sketch, what its nodes hold, and where they say they stand.
#include "grammar/syntax/parser.h"
#include "grammar/operations/operations.h"

#include <gtest/gtest.h>

#include "tests/syntax/dump.h"
#include "tests/syntax/read.h"

namespace sgm::syntax {
namespace {

using Kind = Expr::Kind;

/// The tree of "grammar 1" and `text`, which must parse.
Ast parsed(const std::string& text) {
    Diagnostics diagnostics;
    Ast ast = parse(makeSource("grammar 1\n" + text), operations::table(), diagnostics);
    EXPECT_EQ(renderAll(diagnostics), "") << text;
    return ast;
}

/// The only element of the only start.
Element elementOf(const Ast& ast) {
    EXPECT_EQ(ast.starts.at(0).body.siblings.size(), 1u);
    return ast.starts.at(0).body.siblings.at(0).at(0);
}

/// Operators and operands in prefix form, units glued: "(+ 1 (* 2m x))".
std::string shortForm(const Expr& e) {
    const auto list = [&](const std::string& head) {
        std::string out = '(' + head;
        for (const Expr& arg : e.args) out.append(" ").append(shortForm(arg));
        return out + ')';
    };
    switch (e.kind) {
        case Kind::Number:
        case Kind::Color:
            return std::string(e.span.text());
        case Kind::Text:
        case Kind::Name:
            return e.text;
        case Kind::Member:
            return '(' + shortForm(e.args[0]) + " . " + e.text + ')';
        case Kind::Index:
            return list("index");
        case Kind::Tuple:
            return list("tuple");
        case Kind::Range:
            return list("..");
        case Kind::Ramp:
            return list("~>");
        case Kind::Floating:
            return list("~");
        case Kind::Error:
            return "error";
        default:
            return list(e.text);
    }
}

std::string expression(const std::string& text) {
    Diagnostics diagnostics;
    const SourcePtr source = makeSource(text);
    const std::string out = shortForm(parseExpression(source, diagnostics));
    return diagnostics.hasErrors() ? renderAll(diagnostics) : out;
}

TEST(Parser, SketchParsesWithoutDiagnostics) {
    Diagnostics diagnostics;
    const Ast ast = parse(readSource("tests/syntax/sketch.sgm"), operations::table(), diagnostics);
    EXPECT_EQ(renderAll(diagnostics), "");
    EXPECT_EQ(ast.uses.size(), 1u);
    EXPECT_EQ(ast.params.size(), 9u);
    EXPECT_EQ(ast.maps.size(), 1u);
    EXPECT_EQ(ast.terminals.size(), 8u);
    EXPECT_EQ(ast.starts.size(), 6u);
    EXPECT_EQ(ast.rules.size(), 19u);
    EXPECT_EQ(ast.derives.size(), 2u);
    EXPECT_EQ(ast.lsystems.size(), 1u);
    EXPECT_EQ(ast.styles.size(), 1u);
    EXPECT_EQ(ast.checks.size(), 1u);
    EXPECT_EQ(Dump(ast).badSpan(), "");
}

TEST(Parser, ExpressionsBindAsInArithmetic) {
    EXPECT_EQ(expression("1 + 2m * x - y"), "(- (+ 1 (* 2m x)) y)");
    EXPECT_EQ(expression("-a * b % c"), "(% (* (- a) b) c)");
    EXPECT_EQ(expression("a or b and not c == d"), "(or a (and b (not (== c d))))");
    EXPECT_EQ(expression("scope.x < 1.2m or overlaps(wall)"), "(or (< (scope . x) 1.2m) (overlaps wall))");
    EXPECT_EQ(expression("reach[d] >= i"), "(>= (index reach d) i)");
    EXPECT_EQ(expression("1..i + 1"), "(.. 1 (+ i 1))");
    EXPECT_EQ(expression("(12 ~> 8, 3.5..4)"), "(tuple (~> 12 8) (.. 3.5 4))");
    EXPECT_EQ(expression("a - (b - c)"), "(- a (- b c))");
}

TEST(Parser, NumbersSplitWhereTheyShould) {
    EXPECT_EQ(expression("0..1"), "(.. 0 1)");
    EXPECT_EQ(expression(".2...5"), "(.. .2 .5)");
    EXPECT_EQ(expression("-shiftj..shiftj"), "(.. (- shiftj) shiftj)");
    EXPECT_EQ(expression("20%..60%"), "(.. 20% 60%)");
    EXPECT_EQ(expression("7 % 2"), "(% 7 2)");
    EXPECT_EQ(expression("2.2/m"), "2.2/m");
    EXPECT_EQ(expression("2.2/mass"), "(/ 2.2 mass)");
    EXPECT_EQ(expression("1e-3m"), "1e-3m");
    Diagnostics diagnostics;
    const SourcePtr source = makeSource("1.5e2deg");
    const Expr number = parseExpression(source, diagnostics);
    EXPECT_EQ(number.number, 150);
    EXPECT_EQ(number.unit, "deg");
}

TEST(Parser, AxesAreWordsWhereAValueIsExpected) {
    EXPECT_EQ(expression("free(+x, -x, +z)"), "(free +x -x +z)");
    EXPECT_EQ(expression("a -x"), "(- a x)");
    EXPECT_EQ(expression("- x"), "(- x)");
    EXPECT_EQ(expression("+xy"), "t.sgm:1:1: error: a number has no '+' before it\n  +xy\n  ^\n  leave '+' out\n");
}

TEST(Parser, LiteralsHoldWhatWasWritten) {
    const Ast ast = parsed("param a = #c8b090\nparam b = \"say \\\"hi\\\" \\\\\" \"label\" group G key k\n");
    EXPECT_EQ(ast.params[0].value.number, 0xc8b090);
    EXPECT_EQ(ast.params[1].value.text, "say \"hi\" \\");
    EXPECT_EQ(ast.params[1].label, "label");
    EXPECT_EQ(ast.params[1].group, "G");
    EXPECT_EQ(ast.params[1].key.text, "k");
}

TEST(Parser, AttributesBindTighterThanOperators) {
    const Ast ast = parsed("start A -> cube size 2 - sphere size (1, 2, 3) at +x to centre : B, nil\n");
    ASSERT_EQ(ast.starts[0].body.siblings.size(), 2u);
    const std::vector<Element>& chain = ast.starts[0].body.siblings[0];
    ASSERT_EQ(chain.size(), 2u);
    EXPECT_EQ(chain[0].op, Operator::None);
    EXPECT_EQ(chain[0].after.size(), 1u);
    EXPECT_EQ(chain[1].op, Operator::Difference);
    EXPECT_EQ(chain[1].after.size(), 3u);
    EXPECT_EQ(chain[1].after[1].operation, &operations::at);
    EXPECT_EQ(chain[1].after[2].operation, &operations::to);
    EXPECT_EQ(chain[1].live.text, "B");
    EXPECT_EQ(chain[1].span.text(), "- sphere size (1, 2, 3) at +x to centre : B");
}

TEST(Parser, PrefixAttributesStandBefore) {
    const Ast bothAst = parsed("start A -> size 50% facade turn 30deg\n");
    const Element both = elementOf(bothAst);
    EXPECT_EQ(both.before.size(), 1u);
    EXPECT_EQ(both.after.size(), 1u);
    const Ast aloneAst = parsed("start A -> size 2 split z { ~1: B }\n");
    const Element alone = elementOf(aloneAst);
    EXPECT_EQ(alone.before.size(), 2u);
    EXPECT_FALSE(alone.solid);
}

TEST(Parser, ArgumentsEndBeforeOperators) {
    const Ast ast = parsed("start A -> cube size 2 ~> 1.2 shift -.2 .. .2 + sphere by blend & cone size blend at -z\n");
    const std::vector<Element>& chain = ast.starts[0].body.siblings[0];
    ASSERT_EQ(chain.size(), 3u);
    EXPECT_EQ(shortForm(chain[0].after[0].args[0]), "(~> 2 1.2)");
    EXPECT_EQ(shortForm(chain[0].after[1].args[0]), "(.. (- .2) .2)");
    EXPECT_EQ(shortForm(chain[1].after[0].args[0]), "blend");
    EXPECT_EQ(chain[2].op, Operator::Intersection);
    EXPECT_EQ(shortForm(chain[2].after[0].args[0]), "blend");
    EXPECT_EQ(shortForm(chain[2].after[1].args[0]), "-z");
}

TEST(Parser, WordsThatAreBothSolidAndOperation) {
    EXPECT_EQ(elementOf(parsed("start A -> morph(cube, sphere, .5)\n")).solid->text, "morph");
    EXPECT_EQ(elementOf(parsed("start A -> morph torus by .2\n")).op, Operator::Morph);
    EXPECT_EQ(elementOf(parsed("start A -> morph (torus + cube) by .2\n")).kind, Element::Kind::Group);
    const auto splits = parsed("start A -> split y { ~1: wall } morph split y { 1m: wall } by .2\n");
    ASSERT_EQ(splits.starts[0].body.siblings[0].size(), 2u);
    EXPECT_EQ(splits.starts[0].body.siblings[0][1].op, Operator::Morph);
}

TEST(Parser, WithHoldsItsNameAndItsValue) {
    const Ast ast = parsed("start A -> B with storey = (floors + 1)\n");
    const Element e = elementOf(ast);
    ASSERT_EQ(e.after[0].args.size(), 2u);
    EXPECT_EQ(e.after[0].args[0].text, "storey");
    EXPECT_EQ(shortForm(e.after[0].args[1]), "(+ floors 1)");
    EXPECT_EQ(e.after[0].args[1].span.text(), "(floors + 1)");
}

TEST(Parser, BlocksHoldLabelsTagsAndRepetitions) {
    const Ast ast = parsed("start A -> split x { tag K: split y { { ~3m: Row }* | pane: wall } | side: wall }\n");
    const Element e = elementOf(ast);
    const std::vector<Case>& parts = e.before[0].cases;
    ASSERT_EQ(parts.size(), 2u);
    EXPECT_EQ(parts[0].tag.text, "K");
    EXPECT_EQ(parts[1].label->text, "side");
    const std::vector<Case>& rows = parts[0].body->siblings[0][0].before[0].cases;
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_TRUE(rows[0].repeated);
    EXPECT_EQ(shortForm(*rows[0].cases[0].label), "(~ 3m)");
    EXPECT_EQ(rows[0].span.text(), "{ ~3m: Row }*");
    EXPECT_EQ(rows[1].label->text, "pane");
}

TEST(Parser, ControlHoldsConditionsAndBodies) {
    const Ast ast = parsed(
        "rule A repeat n -> for d in axes when reach[d] >= i { + cube at d : B } while free(d) { + cone } when a { nil "
        "}\n"
        "  finally morph torus by .2\n");
    const std::vector<Element>& chain = ast.rules[0].body.siblings[0];
    ASSERT_EQ(chain.size(), 3u);
    EXPECT_EQ(chain[0].kind, Element::Kind::For);
    EXPECT_EQ(chain[0].variable.text, "d");
    EXPECT_EQ(shortForm(*chain[0].guard), "(>= (index reach d) i)");
    EXPECT_EQ(chain[0].body->siblings[0][0].live.text, "B");
    EXPECT_EQ(chain[1].kind, Element::Kind::While);
    EXPECT_EQ(chain[2].kind, Element::Kind::When);
    ASSERT_TRUE(ast.rules[0].finally_);
    EXPECT_EQ(ast.rules[0].finally_->span.text(), "morph torus by .2");
}

TEST(Parser, RuleHeadsTakeTheirPartsInAnyOrder) {
    const Ast ast = parsed("rule R: A weight 2 beside B repeat n - 1 when a == b -> cube\n");
    const RuleDecl& rule = ast.rules[0];
    EXPECT_EQ(rule.name.text, "R");
    EXPECT_EQ(rule.symbol.text, "A");
    EXPECT_EQ(rule.beside.text, "B");
    EXPECT_EQ(shortForm(*rule.repeat), "(- n 1)");
    EXPECT_EQ(shortForm(*rule.when), "(== a b)");
    EXPECT_EQ(shortForm(*rule.weight), "2");
}

TEST(Parser, DerivationsNamePlaces) {
    const Ast ast = parsed("derive left: R0 => R1 at Cave / Cell[3] => R3\n");
    const DeriveDecl& derive = ast.derives[0];
    ASSERT_EQ(derive.steps.size(), 3u);
    EXPECT_FALSE(derive.steps[0].hasPlace);
    EXPECT_EQ(derive.steps[1].place, "Cave/Cell[3]");
    EXPECT_EQ(derive.steps[1].at.span.text(), "Cave / Cell[3]");
}

TEST(Parser, OtherDeclarations) {
    const Ast ast = parsed(
        "terminal gate = cube color #102030 joint door at (.5, 0, 0) facing -z\n"
        "lsystem P passes 2 angle -90deg axiom \"F\" F -> \"FF\" : 2 G -> \"\"\n"
        "style S { a = 1 b = -2 }\ncheck H { a = 3 } expect bonds == 3\n"
        "param kind = flat of flat, round \"Kind\"\nmap m = \"m.png\" as 0..1\nuse \"std/walls.sgm\"\n");
    EXPECT_EQ(ast.terminals[0].joints[0].name.text, "door");
    EXPECT_EQ(shortForm(ast.terminals[0].joints[0].facing), "-z");
    EXPECT_EQ(ast.lsystems[0].settings.size(), 2u);
    EXPECT_EQ(ast.lsystems[0].productions.size(), 2u);
    EXPECT_EQ(ast.styles[0].settings[1].span.text(), "b = -2");
    EXPECT_EQ(shortForm(*ast.checks[0].expect), "(== bonds 3)");
    EXPECT_EQ(ast.params[0].choices[1].text, "round");
    EXPECT_EQ(shortForm(*ast.maps[0].range), "(.. 0 1)");
    EXPECT_EQ(ast.uses[0].file.text, "std/walls.sgm");
}

TEST(Parser, ByteOrderMarkAndCarriageReturnsAreBlank) {
    Diagnostics diagnostics;
    const Ast ast = parse(makeSource("\xef\xbb\xbfgrammar 1\r\nstart A -> cube\r\nrule B -> cube // c\r\n"),
                          operations::table(), diagnostics);
    EXPECT_EQ(renderAll(diagnostics), "");
    EXPECT_EQ(ast.rules.size(), 1u);
}

TEST(Parser, DeclarationsWithProblemsKeepTheirNames) {
    Diagnostics diagnostics;
    const Ast ast = parse(makeSource("grammar 1\nrule A -> cube size\nparam p = \nstart S -> cube )\n"),
                          operations::table(), diagnostics);
    EXPECT_EQ(diagnostics.all().size(), 3u);
    EXPECT_EQ(ast.rules.at(0).symbol.text, "A");
    EXPECT_EQ(ast.params.at(0).name.text, "p");
    EXPECT_EQ(ast.starts.at(0).symbol.text, "S");
}

TEST(Parser, EveryOperationsExampleParses) {
    for (const Operation* operation : operations::table().rows()) {
        const Operation& row = *operation;
        const Ast ast = parsed("start A -> " + std::string(row.example) + '\n');
        const std::string dump = Dump(ast).text();
        EXPECT_NE(dump.find("(attribute " + std::string(row.name) + ' '), std::string::npos) << row.name;
        EXPECT_EQ(operations::table().find(row.name), &row);
        EXPECT_FALSE(row.doc.empty());
    }
    EXPECT_EQ(operations::table().find("sizes"), nullptr);
}

}  // namespace
}  // namespace sgm::syntax
