// Unsaved work after a crash: kept, offered once its program is gone, and not before.
#include "viewer/document/recovery.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>

#include "tests/document/texts.h"
#include "tests/scratch.h"

namespace sgm::document {
namespace {

size_t filesIn(const std::filesystem::path& folder) {
    return static_cast<size_t>(
        std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator()));
}

TEST(Recoveries, SurviveAKill) {
    const Scratch scratch;
    const auto path = scratch.write("a.sgm", tower);
    const auto state = scratch / "state";
    int ready[2];
    ASSERT_EQ(pipe(ready), 0);
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
        Document document = *Document::open(path);
        Recovery recovery(state);
        recovery.keep(document);
        document.type(replaced(tower, "floors = 3", "floors = 8"));
        recovery.keep(document);
        document.type(replaced(tower, "floors = 3", "floors = 9"));
        recovery.keep(document);
        const char good = recovery.flush().ok() ? 'y' : 'n';
        if (write(ready[1], &good, 1) != 1) _exit(1);
        for (;;) pause();
    }
    close(ready[1]);  // so that reading ends with the child
    char good = 0;
    ASSERT_EQ(read(ready[0], &good, 1), 1);
    EXPECT_EQ(good, 'y');
    EXPECT_TRUE(abandonedWork(state).empty()) << "its program lives";
    ASSERT_EQ(kill(child, SIGKILL), 0);
    waitpid(child, nullptr, 0);

    const auto found = abandonedWork(state);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].document, path);
    EXPECT_EQ(found[0].text, replaced(tower, "floors = 3", "floors = 9"));
    Document document = Document::recovered(found[0].document, found[0].text);
    EXPECT_TRUE(document.dirty());
    EXPECT_EQ(document.history().undoLabel(), "Recover unsaved work");
    document.undo();
    EXPECT_EQ(document.text(), tower);
    EXPECT_FALSE(document.dirty());
    EXPECT_EQ(scratch.read("a.sgm"), tower);
    discard(found[0]);
    EXPECT_TRUE(abandonedWork(state).empty());
    EXPECT_EQ(filesIn(state), 0u);
}

TEST(Recoveries, GoAwayWithTheirReason) {
    const Scratch scratch;
    Document document(tower);
    {
        Recovery recovery(scratch.path());
        recovery.keep(document);
        ASSERT_TRUE(recovery.flush().ok());
        EXPECT_EQ(filesIn(scratch.path()), 0u) << "nothing is unsaved";
        document.type("grammar 1\n// new\n");
        recovery.keep(document);
        ASSERT_TRUE(recovery.flush().ok());
        EXPECT_TRUE(std::filesystem::exists(recovery.file()));
        document.undo();
        recovery.keep(document);
        ASSERT_TRUE(recovery.flush().ok());
        EXPECT_FALSE(std::filesystem::exists(recovery.file()));
        document.redo();
        recovery.keep(document);
        Recovery second(scratch.path());
        second.keep(document);
        ASSERT_TRUE(recovery.flush().ok() && second.flush().ok());
        EXPECT_NE(recovery.file(), second.file());
    }
    EXPECT_EQ(filesIn(scratch.path()), 0u);
}

TEST(Recoveries, SayWhenTheDiskRefuses) {
    const Scratch scratch;
    scratch.write("state", "a file where the folder should be");
    Document document(tower);
    document.type("grammar 1\n");
    Recovery recovery(scratch / "state");
    recovery.keep(document);
    EXPECT_FALSE(recovery.flush().ok());
    std::filesystem::remove(scratch / "state");
    recovery.keep(document);
    EXPECT_TRUE(recovery.flush().ok()) << "it is tried again";
}

TEST(Recoveries, LeaveStrangeFilesAlone) {
    const Scratch scratch;
    scratch.write("1-0.recovery", "sgm-recovery 99999\nshort");
    scratch.write("2-0.recovery", "something else");
    scratch.write("3-0.recovery", "sgm-recovery 0\ngrammar 1\n");
    const auto found = abandonedWork(scratch.path());
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].text, "grammar 1\n");
    EXPECT_TRUE(found[0].document.empty());
    EXPECT_TRUE(abandonedWork(scratch / "none").empty());
}

TEST(Recoveries, LeaveNoLocksOfProcessesThatAreGone) {
    const Scratch scratch;
    const auto aged = [&](const char* name) {
        const auto path = scratch.write(name, "");
        std::filesystem::last_write_time(path, std::filesystem::file_time_type::clock::now() - std::chrono::minutes(5));
        return path;
    };
    const auto idle = aged("1-0.lock"), held = aged("2-0.lock"), guarding = aged("3-0.lock"),
               fresh = scratch.write("4-0.lock", "");
    scratch.write("3-0.recovery", "sgm-recovery 0\ngrammar 1\n");
    const int fd = open(held.c_str(), O_RDWR);
    ASSERT_EQ(flock(fd, LOCK_EX), 0);
    EXPECT_EQ(abandonedWork(scratch.path()).size(), 1u);
    EXPECT_FALSE(std::filesystem::exists(idle));
    for (const auto& kept : {held, guarding, fresh}) EXPECT_TRUE(std::filesystem::exists(kept)) << kept;
    close(fd);
}

TEST(Recoveries, FollowTheDesktopsRules) {
    setenv("XDG_STATE_HOME", "/there", 1);
    EXPECT_EQ(recoveryFolder(), "/there/sgm");
    setenv("XDG_STATE_HOME", "relative", 1);
    setenv("HOME", "/home/someone", 1);
    EXPECT_EQ(recoveryFolder(), "/home/someone/.local/state/sgm");
}

}  // namespace
}  // namespace sgm::document
