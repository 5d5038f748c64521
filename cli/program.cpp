#include "cli/program.h"

#include <CLI/CLI.hpp>
#include <csignal>
#include <exception>
#include <new>
#include <stdexcept>
#include <system_error>

#include "cli/commands.h"
#include "cli/memory.h"
#include "cli/messages.h"
#include "cli/usage.h"

namespace sgm::cli {
namespace {

constexpr const char* programExamples = R"(Examples:
  sgm build examples/grotto.sgm -o grotto.glb -o grotto.vdb     a mesh and a volume
  sgm build examples/tower.sgm --set floors=12 --resolution 256 -o tower.ply
  sgm render examples/cumulus.sgm -o cumulus.png                a picture, no display needed
  sgm tree examples/figure1.sgm --derive left --steps           how it grew
  sgm check my.sgm                                              all problems at once

Exit codes: 0 done, 1 something in the input, 2 wrong usage, 3 a budget ran out, 130 cancelled.)";

/// Runs what the arguments ask for.
int run(CLI::App& app, int argc, char** argv, const int& exitCode) {
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        const std::string problem = e.get_exit_code() == 0 ? "" : usageProblem(app, argc, argv);
        if (problem.empty()) return app.exit(e) == 0 ? 0 : 2;
        printMessage("sgm: {}\nRun with --help for more information.\n", problem);
        return 2;
    } catch (const std::bad_alloc&) {
        printMessage(
            "sgm: out of memory; try a lower --resolution or a smaller model, or allow more with --max-memory\n");
        return 3;
    } catch (const std::length_error&) {  // a size that no memory holds
        printMessage("sgm: out of memory: the input needs more than any machine has\n");
        return 3;
    } catch (const std::system_error& e) {
        printMessage("sgm: {}\n", e.what());
        return 1;
    } catch (const std::exception& e) {
        printMessage("sgm: internal error: {}\n", e.what());
        return 1;
    }
    return exitCode;
}

}  // namespace

int runProgram(int argc, char** argv) {
    openStandardStreams();
    reserveStack();
    std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is an error like a full disk
    CLI::App app{"sgm: grammars that grow implicit solids: caves, clouds, buildings"};
    app.require_subcommand(1);
    app.set_version_flag("--version", SGM_VERSION);
    app.fallthrough();
    uint64_t memory_bytes = usualMemory_bytes();
    app.add_option(
           "--max-memory", memory_bytes,
           "Memory that the command may take, as 4GB or 500MB (default: three quarters of what is there; 0: no limit)")
        ->transform(CLI::AsSizeValue(false));
    int exitCode = 0;
#define SGM_ADD(Name) add##Name(app, exitCode);
    SGM_COMMANDS(SGM_ADD)
#undef SGM_ADD
    app.footer(programExamples);  // now: commands take over what stands there when they are added
    // Subcommands run in their callbacks, when all options are known.
    app.parse_complete_callback([&] {
        if (!app.got_subcommand("view")) limitMemory(memory_bytes);  // drivers map far more than they use
    });
    const int code = run(app, argc, argv, exitCode);
    return flushOutput() || code != 0 ? code : 1;
}

}  // namespace sgm::cli
