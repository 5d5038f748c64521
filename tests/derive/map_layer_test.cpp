// Maps over a rectangle of the ground.
#include "grammar/derive/map_layer.h"

#include <gtest/gtest.h>

#include "tests/derive/grammars.h"
#include "tests/rules/read.h"

namespace sgm::testing_ {
namespace {

TEST(MapLayer, HasTheValuesOfAFormulaAtTheMiddlesOfItsCells) {
    const auto d = derived(
        "grammar 2\nparam steep = .5 in 0..1.0\nmap rise = here.x * steep - here.z / 1m\n"
        "map low = rise < 0\nstart A -> cube\n");
    const auto layer = derive::mapLayer(d, 0, {{0, 0}, {8, 4}}, 4, 2);
    ASSERT_TRUE(layer.ok()) << layer.error().message;
    EXPECT_EQ(layer->name, "rise");
    ASSERT_EQ(layer->values.size(), 8u);
    for (uint32_t row = 0; row < 2; ++row)
        for (uint32_t column = 0; column < 4; ++column)
            EXPECT_FLOAT_EQ(layer->values[4 * row + column], (2 * column + 1) * .5f - (2 * row + 1));
    EXPECT_FLOAT_EQ(layer->least, -2.5f);
    EXPECT_FLOAT_EQ(layer->most, 2.5f);
    const auto low = derive::mapLayer(d, 1, {{0, 0}, {8, 4}}, 4, 2);
    ASSERT_TRUE(low.ok());
    EXPECT_EQ(low->values, (std::vector<float>{1, 0, 0, 0, 1, 1, 1, 0})) << "false and true";
}

}  // namespace
}  // namespace sgm::testing_
