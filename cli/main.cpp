#include "cli/program.h"

int main(int argc, char** argv) { return sgm::cli::runProgram(argc, argv); }
