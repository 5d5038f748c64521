// What a command says beside its product.
// Enters: words. Leaves: lines on stderr. Assumes nothing of stderr: where it is closed or full, the words are lost and
// the work goes on.
#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>

#include "grammar/syntax/source.h"

namespace sgm::cli {

/// Writes to stderr as it is.
void writeMessage(const std::string& text);

/// Formats to stderr.
template <class... Arguments>
void printMessage(fmt::format_string<Arguments...> text, Arguments&&... arguments) {
    writeMessage(fmt::format(text, std::forward<Arguments>(arguments)...));
}

/// Prints problems with the lines they stand in: at most a hundred errors and as many warnings, and how many more there
/// are.
void printDiagnostics(const syntax::Diagnostics& diagnostics);

/// Opens the standard streams that are closed on /dev/null, so that no file of ours becomes one of them.
void openStandardStreams();

/// Sends all that was printed. False, with a message, where stdout took not all of it.
bool flushOutput();

}  // namespace sgm::cli
