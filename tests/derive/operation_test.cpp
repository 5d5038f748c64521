// An operation of a program's own: defined here alone, read by the parser, the checker and the derivation.
#include <gtest/gtest.h>

#include <vector>

#include "grammar/derive/attribute_context.h"
#include "grammar/derive/derive.h"
#include "grammar/derive/parts_context.h"
#include "grammar/operations/operations.h"
#include "grammar/rules/check.h"
#include "grammar/rules/operation_checker.h"

namespace sgm {
namespace {

using syntax::Operation;

constexpr syntax::OperationArgument growArguments[] = {
    {"factor", syntax::ArgumentType::Number, "times the size of the scope"}};

void applyGrow(derive::AttributeContext& context, const rules::Attribute& attribute) {
    context.out.scope.size = context.place.scope.size * context.number(attribute.args[0]);
}

/// Sets the size to a multiple of the scope's.
constexpr Operation grow{
    .name = "grow",
    .doc = "Multiplies the size of the scope.",
    .example = "cube grow 2",
    .arguments = growArguments,
    .range = {1, 10, "1 … 10"},
    .apply = applyGrow,
};

std::shared_ptr<rules::Parts> checkHalves(rules::OperationChecker& checker, const syntax::Attribute& written) {
    auto parts = std::make_shared<rules::Parts>();
    parts->operation = written.operation;
    parts->span = written.span;
    for (const syntax::Case& c : written.cases) parts->parts.emplace_back().body = checker.body(*c.body);
    return parts;
}

bool runHalves(derive::PartsContext& context, const rules::Parts& parts) {
    for (size_t i = 0; i < parts.parts.size(); ++i) {
        derive::Scope half = context.scope();
        half.size.x /= 2;
        half.centre.x += (static_cast<double>(i) - .5) * half.size.x;
        if (!context.run(*parts.parts[i].body, half, i)) return false;
    }
    return true;
}

/// Gives the left and the right half of the scope to a body each.
constexpr Operation halves{
    .name = "halves",
    .doc = "Cuts the scope into a left and a right half.",
    .example = "halves { left: cube | right: sphere }",
    .phase = Operation::Phase::Content,
    .block = {.label = "left"},
    .checkParts = checkHalves,
    .run = runHalves,
};

/// The language's own operations and the two of this test.
class OwnOperations : public testing::Test {
protected:
    OwnOperations() {
        const auto own = operations::table().rows();
        rows_.assign(own.begin(), own.end());
        rows_.insert(rows_.end(), {&grow, &halves});
        table_ = syntax::OperationTable(rows_);
    }

    std::shared_ptr<const rules::Grammar> load(const std::string& text) {
        diagnostics_ = {};
        return rules::load(std::make_shared<const syntax::Source>("own.sgm", text), table_, {}, diagnostics_);
    }
    /// The tree that a grammar derives; empty, with a failure, where it has none.
    derive::ShapeTree tree(const std::string& text) {
        const auto grammar = load(text);
        EXPECT_TRUE(grammar) << (diagnostics_.all().empty() ? "" : diagnostics_.all()[0].message);
        if (!grammar) return {};
        auto derivation = derive::derive(grammar, {}, nullptr);
        EXPECT_TRUE(derivation.ok());
        return derivation.ok() ? derivation->tree : derive::ShapeTree{};
    }

    std::vector<const Operation*> rows_;
    syntax::OperationTable table_;
    syntax::Diagnostics diagnostics_;
};

TEST_F(OwnOperations, ScopeOperationSetsTheSize) {
    const derive::ShapeTree made = tree("grammar 1\nstart A -> cube grow 3\n");
    ASSERT_EQ(made.shapes.size(), 2u);
    EXPECT_EQ(made.shapes[1].scope.size, (Vec3d{3, 3, 3}));
}

TEST_F(OwnOperations, ArgumentsAreCheckedAgainstTheRow) {
    EXPECT_FALSE(load("grammar 1\nstart A -> cube grow 30\n"));
    ASSERT_EQ(diagnostics_.all().size(), 1u);
    EXPECT_EQ(diagnostics_.all()[0].message, "'grow' is 30, but must be 1 … 10");
    EXPECT_FALSE(load("grammar 1\nstart A -> cube grow 2 grow 3\n"));
    EXPECT_EQ(diagnostics_.all()[0].message, "'grow' is given twice");
}

TEST_F(OwnOperations, ContentOperationMakesParts) {
    const derive::ShapeTree made =
        tree("grammar 1\nstart A -> size (4, 2, 2) halves { left: cube | right: Right }\nrule Right -> sphere\n");
    std::vector<double> centres;
    for (const derive::Shape& shape : made.shapes)
        if (shape.solid != derive::none) centres.push_back(shape.scope.centre.x);
    EXPECT_EQ(centres, (std::vector<double>{-1, 1}));
}

TEST_F(OwnOperations, ALanguageWithoutThemDoesNotReadThem) {
    const auto source = std::make_shared<const syntax::Source>("own.sgm", "grammar 1\nstart A -> cube grow 3\n");
    EXPECT_FALSE(rules::load(source, operations::table(), {}, diagnostics_));
    EXPECT_EQ(diagnostics_.all()[0].message, "'grow' can't follow a shape");
}

}  // namespace
}  // namespace sgm
