// The subcommands of `sgm`, one file each.
// Enters: the app. Leaves: each subcommand registered; when it ran, `exitCode` holds its exit code.
#pragma once

namespace CLI {
class App;
}

namespace sgm::cli {

// clang-format off
/// Every subcommand, in the order of `sgm --help`: addBuild(app, exitCode) and so on, each defined in its own file.
/// Examples adds `new` and `examples`, Shell `completion` and `man`.
#define SGM_COMMANDS(X) X(Build) X(Render) X(Bake) X(Merge) X(Serve) X(View) X(Check) X(Step) X(Tree) X(Mutate) X(Params) \
    X(Fmt) X(Reference) X(Lsp) X(Examples) X(Shell)
// clang-format on
#define SGM_DECLARE(Name) void add##Name(CLI::App& app, int& exitCode);
SGM_COMMANDS(SGM_DECLARE)
#undef SGM_DECLARE

}  // namespace sgm::cli
