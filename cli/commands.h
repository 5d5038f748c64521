// The subcommands of `sgm`, one file each.
// Enters: the app. Leaves: each subcommand registered; when it ran, `exitCode` holds its exit code.
#pragma once

namespace CLI {
class App;
}

namespace sgm::cli {

void addBuild(CLI::App& app, int& exitCode);
void addRender(CLI::App& app, int& exitCode);
void addView(CLI::App& app, int& exitCode);
void addCheck(CLI::App& app, int& exitCode);
void addStep(CLI::App& app, int& exitCode);
void addTree(CLI::App& app, int& exitCode);
void addMutate(CLI::App& app, int& exitCode);
void addParams(CLI::App& app, int& exitCode);
void addFmt(CLI::App& app, int& exitCode);
void addReference(CLI::App& app, int& exitCode);

}  // namespace sgm::cli
