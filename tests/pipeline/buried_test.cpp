// Warnings of parts that add nothing.
#include "grammar/pipeline/buried.h"

#include "tests/pipeline/crisp_model.h"

namespace sgm::pipeline {
namespace {

std::vector<std::string> toldOf(int lines) {
    std::string text = "grammar 2\nstart A -> cube size 4 : B\nrule B -> cube";
    for (int i = 0; i < lines; ++i) text += "\n  + sphere size 1 move (" + std::to_string(.1 * i) + ", 0, 0)";
    Context context{nullptr, 2};
    const CrispModel crisp = crispModel(text + "\n", 48, context);
    const auto warnings = buriedWarnings(crisp.model, crisp.mesh, context);
    EXPECT_TRUE(warnings.ok());
    std::vector<std::string> told;
    for (const MeshWarning& w : *warnings) told.push_back(w.text);
    return told;
}

TEST(BuriedWarnings, CountWhatTheyDoNotName) {
    EXPECT_EQ(toldOf(5).size(), 5u);
    const auto seven = toldOf(7);
    ASSERT_EQ(seven.size(), 6u);
    EXPECT_EQ(seven[0], "a 'sphere' lies within other solids and adds nothing: move it out, or leave it out");
    EXPECT_EQ(seven[5], "parts of 2 more lines add nothing");
}

}  // namespace
}  // namespace sgm::pipeline
