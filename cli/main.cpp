#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "cli/commands.h"

namespace {

constexpr const char* examples = R"(Examples:
  sgm build examples/grotto.sgm -o grotto.glb -o grotto.vdb     a mesh and a volume
  sgm build examples/tower.sgm --set floors=12 --resolution 256 -o tower.ply
  sgm render examples/cumulus.sgm -o cumulus.png                a picture, no display needed
  sgm tree examples/figure1.sgm --derive left --steps           how it grew
  sgm check my.sgm                                              all problems at once

Exit codes: 0 done, 1 something in the input, 2 wrong usage, 3 a budget ran out, 130 cancelled.)";

}  // namespace

int main(int argc, char** argv) {
    CLI::App app{"sgm: grammars that grow implicit solids: caves, clouds, buildings"};
    app.require_subcommand(1);
    app.footer(examples);
    app.set_version_flag("--version", SGM_VERSION);
    int exitCode = 0;
    using namespace sgm::cli;
    addBuild(app, exitCode);
    addRender(app, exitCode);
    addView(app, exitCode);
    addCheck(app, exitCode);
    addStep(app, exitCode);
    addTree(app, exitCode);
    addMutate(app, exitCode);
    addParams(app, exitCode);
    addFmt(app, exitCode);
    addReference(app, exitCode);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? 0 : 2;
    } catch (const std::bad_alloc&) {
        fmt::print(stderr, "sgm: out of memory; try a lower --resolution\n");
        return 3;
    } catch (const std::exception& e) {
        fmt::print(stderr, "sgm: internal error: {}\n", e.what());
        return 1;
    }
    return exitCode;
}
