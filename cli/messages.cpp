#include "cli/messages.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

namespace sgm::cli {

void writeMessage(const std::string& text) {
    std::fwrite(text.data(), 1, text.size(), stderr);
    std::clearerr(stderr);
}

void printDiagnostics(const syntax::Diagnostics& diagnostics) {
    constexpr size_t most = 100;
    size_t errors = 0, warnings = 0;
    for (const syntax::Diagnostic& d : diagnostics.all())
        if ((d.severity == syntax::Severity::Error ? errors : warnings)++ < most)
            printMessage("{}\n", syntax::render(d));
    if (errors > most) printMessage("{} more errors\n", errors - most);
    if (warnings > most) printMessage("{} more warnings\n", warnings - most);
}

void openStandardStreams() {
    for (int fd = STDIN_FILENO; fd <= STDERR_FILENO; ++fd)
        if (fcntl(fd, F_GETFD) < 0 && errno == EBADF) static_cast<void>(open("/dev/null", O_RDWR));
}

bool flushOutput() {
    errno = 0;
    if (std::fflush(stdout) == 0 && !std::ferror(stdout)) return true;
    printMessage("sgm: can't write to the standard output: {}\n", std::strerror(errno ? errno : EIO));
    return false;
}

}  // namespace sgm::cli
