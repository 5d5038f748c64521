// Ornaments whose details are too fine for a mesh's cells.
#include <gtest/gtest.h>

#include "grammar/pipeline/missing.h"
#include "tests/pipeline/crisp_model.h"

namespace sgm::pipeline {
namespace {

TEST(Ornaments, WhosePassesCellsDontHoldAreTold) {
    Context context{nullptr, 2};
    const Model model = modelOf(
        "grammar 2\n"
        "terminal lace = ornament(center: (.93, .93, .33), fold: rotZ(20deg), passes: 4, bay: 6m, storey: 4m)\n"
        "start T -> Hall size (12, 8, 8)\n"
        "rule Hall -> cube clad lace + cube size (2, 2, 2) at +y\n",
        context);
    const auto warnings = missingWarnings(model, gridOf(model, 32), {});
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_EQ(warnings[0].text,
              "the mesh's cells of 0.375 m hold 2 of 4 passes of the ornament 'lace', whose last details are 0.0459 m "
              "wide: --resolution 131 holds all");
    EXPECT_TRUE(warnings[0].ofCells);
    EXPECT_EQ(warnings[0].place.substr(warnings[0].place.find(':')), ":4: ");
    EXPECT_TRUE(missingWarnings(model, gridOf(model, 131), {}).empty());
    EXPECT_NE(missingWarnings(model, gridOf(model, 128), {})[0].text.find("hold 3 of 4"), std::string::npos);
    EXPECT_NE(missingWarnings(model, gridOf(model, 32), {}, "T")[0].text.find("--object-cell 0.091 holds all"),
              std::string::npos);
}

}  // namespace
}  // namespace sgm::pipeline
