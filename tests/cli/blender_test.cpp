// The Blender add-on, from the zip that `./run.sh package` writes, in Blender where it is installed.
#include "tests/cli/program.h"

namespace sgm::cli {
namespace {

bool works(const char* command) { return std::system((std::string(command) + " > /dev/null 2>&1").c_str()) == 0; }

class BlenderAddon : public Cli, public testing::WithParamInterface<const char*> {};

TEST_P(BlenderAddon, DoesWhatItsTestsAsk) {
    if (!works("command -v blender") || !works("/usr/bin/python3 -c 'import numpy'"))
        GTEST_SKIP() << "blender or python3-numpy isn't installed";
    ASSERT_TRUE(works(("integrations/package.sh " + path("packages") + " blender").c_str()));
    const std::string log = path("log.txt");
    const std::string command =
        std::string("blender -b --factory-startup --python-exit-code 1 --python tests/integrations/") + GetParam() +
        ".py -- " + path("packages/sgm_blender.zip") + " " SGM_PROGRAM " " + path("scratch") + " > " + log + " 2>&1";
    fs::create_directory(path("scratch"));
    EXPECT_EQ(std::system(command.c_str()), 0) << read(log);
    EXPECT_NE(read(log).find("\nOK\n"), std::string::npos) << read(log);
}
INSTANTIATE_TEST_SUITE_P(Scripts, BlenderAddon, testing::Values("blender_addon", "blender_city"),
                         [](const auto& script) { return std::string(script.param); });

}  // namespace
}  // namespace sgm::cli
