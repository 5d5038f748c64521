// The program `sgm`.
#pragma once

namespace sgm::cli {

/// Runs the subcommand that the arguments of `main` name and returns the exit code: 0 done, 1 something in the input,
/// 2 wrong usage, 3 a budget ran out, 130 cancelled. Limits the memory of the process.
int runProgram(int argc, char** argv);

}  // namespace sgm::cli
