// An earlier good file is never lost: not to a full disk, not to a kill, not to an unwritable place.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>

#include "modeler/core/atomic_file.h"
#include "modeler/export/exporter.h"
#include "tests/export/hand_made.h"
#include "tests/export/read_back.h"
#include "tests/scratch.h"
#include "tests/stop_time.h"

namespace sgm::exporter {
namespace {

void put(const std::filesystem::path& path, const std::string& text) { std::ofstream(path) << text; }

/// Runs `body` in a child process and returns its wait status; the body's value is the exit code.
template <class Body>
int inChild(Body body) {
    const pid_t child = fork();
    if (child == 0) _exit(body());
    int status = 0;
    waitpid(child, &status, 0);
    return status;
}

/// Lets no file of this process grow beyond `bytes`: the kernel kills it at the byte beyond, or, where SIGXFSZ is
/// ignored, fails the write as on a disk that is full.
void limitFileSize(rlim_t bytes) {
    const rlimit limit{bytes, bytes}, noCore{0, 0};
    setrlimit(RLIMIT_FSIZE, &limit);
    setrlimit(RLIMIT_CORE, &noCore);
}

class Atomic : public testing::TestWithParam<std::string> {
protected:
    Atomic() : mesh(icosphere({}, 1, 5, 3)), target(folder / ("model" + GetParam())) {
        input.mesh = &mesh;
        put(target, "the old file");
    }
    mesh::Mesh mesh;
    ExportInput input;
    Scratch folder;
    std::filesystem::path target;
};

TEST_P(Atomic, AWriteThatFailsLeavesTheOldFile) {
    const int status = inChild([&] {
        signal(SIGXFSZ, SIG_IGN);  // writes beyond the limit fail with EFBIG
        limitFileSize(100'000);
        const Status written = write(input, target);
        return !written.ok() && written.error().message.find("File too large") != std::string::npos ? 0 : 1;
    });
    EXPECT_EQ(status, 0) << "an error that tells the cause";
    EXPECT_EQ(contentOf(target), "the old file");
    EXPECT_EQ(folder.fileCount(), 1u) << "no temporary stays";
}

TEST_P(Atomic, AKillInTheMiddleOfWritingLeavesTheOldFile) {
    const int status = inChild([&] {
        limitFileSize(100'000);
        return write(input, target).ok() ? 0 : 1;
    });
    ASSERT_TRUE(WIFSIGNALED(status));
    EXPECT_EQ(contentOf(target), "the old file");
}

TEST_P(Atomic, ACancelledWriteLeavesTheOldFile) {
    Progress progress;
    progress.cancel();
    input.progress = &progress;
    const Status written = write(input, target);
    ASSERT_FALSE(written.ok());
    EXPECT_EQ(written.error().kind, Error::Kind::Cancelled);
    EXPECT_EQ(contentOf(target), "the old file");
    EXPECT_EQ(folder.fileCount(), 1u) << "no temporary, no material file";
}

TEST_P(Atomic, AWriteThatIsCancelledOnItsWayStopsSoon) {
    if (GetParam() == ".gltf") GTEST_SKIP() << "its JSON is made in one go by a library";
    mesh = icosphere({}, 1, 5, 1);  // in one chunk, as edited meshes are
    mesh::Chunk& chunk = mesh.chunks[0];
    const size_t once = chunk.triangles.size();
    for (size_t i = once; i < 200 * once; ++i) {  // four million triangles
        chunk.triangles.push_back(chunk.triangles[i - once]);
        chunk.origins.push_back(0);
    }
    const double most_s = boundSeconds(.05);
    const double late_s = leastSecondsToStop(
        most_s, threadClock(), [](const Progress& progress) { return *progress.stage() != 0; },
        [&](Progress& progress) {
            input.progress = &progress;
            const Status written = write(input, target);
            ASSERT_FALSE(written.ok());
            EXPECT_EQ(written.error().kind, Error::Kind::Cancelled);
        });
    input.progress = nullptr;
    EXPECT_LT(late_s, most_s);
    EXPECT_EQ(contentOf(target), "the old file");
}

TEST_P(Atomic, AStreamHasTheBytesOfTheWholeOrLeavesTheOldFile) {
    const ChunkSource all = [&](const mesh::ChunkVisitor& visit) -> Status {
        for (const mesh::Chunk& chunk : mesh.chunks)
            if (Status status = visit(mesh, chunk); !status.ok()) return status;
        return Done{};
    };
    const ChunkSource broken = [&](const mesh::ChunkVisitor& visit) -> Status {
        if (Status status = visit(mesh, mesh.chunks[0]); !status.ok()) return status;
        return Error{Error::Kind::Budget, "no more"};
    };
    if (!findExporter(GetParam())->stream) {
        EXPECT_EQ(writeStreamed(input, all, target).error().kind, Error::Kind::Usage);
        return;
    }
    const auto none = [](const mesh::ChunkVisitor&) -> Status { return Done{}; };
    EXPECT_EQ(writeStreamed(input, broken, target).error().message, "no more");
    EXPECT_EQ(writeStreamed(input, none, target).error().kind, Error::Kind::Input);
    Progress progress;
    progress.cancel();
    input.progress = &progress;
    EXPECT_EQ(writeStreamed(input, all, target).error().kind, Error::Kind::Cancelled);
    EXPECT_EQ(contentOf(target), "the old file");
    EXPECT_EQ(folder.fileCount(), 1u) << "no temporary stays";

    input.progress = nullptr;
    const auto whole = folder / ("whole" + GetParam());
    ASSERT_TRUE(write(input, whole).ok());
    ASSERT_TRUE(writeStreamed(input, all, target).ok());
    EXPECT_EQ(contentOf(target), contentOf(whole));
    EXPECT_EQ(folder.fileCount(), 2u);
}

INSTANTIATE_TEST_SUITE_P(Formats, Atomic, testing::Values(".glb", ".gltf", ".obj", ".ply", ".stl", ".off", ".usda"),
                         [](const auto& info) { return info.param.substr(1); });

TEST(ReplaceFile, Kill9BeforeTheEndLeavesTheOldFile) {
    Scratch folder;
    const auto target = folder / "file";
    put(target, "old");
    const int status = inChild([&] {
        (void)replaceFile(target, [](const std::filesystem::path& temporary) -> Status {
            put(temporary, std::string(100'000, 'x'));
            kill(getpid(), SIGKILL);
            return Done{};
        });
        return 0;
    });
    ASSERT_TRUE(WIFSIGNALED(status));
    EXPECT_EQ(WTERMSIG(status), SIGKILL);
    EXPECT_EQ(contentOf(target), "old");
}

TEST(ReplaceFile, ReplacesAndKeepsPermissionsAndLinks) {
    Scratch folder;
    const auto target = folder / "file", link = folder / "link";
    put(target, "old");
    chmod(target.c_str(), 0640);
    std::filesystem::create_symlink("file", link);
    const auto fill = [](const std::filesystem::path& temporary) -> Status {
        put(temporary, "new");
        return Done{};
    };
    ASSERT_TRUE(replaceFile(link, fill).ok());
    EXPECT_TRUE(std::filesystem::is_symlink(link));
    EXPECT_EQ(contentOf(target), "new");
    struct stat info {};
    stat(target.c_str(), &info);
    EXPECT_EQ(info.st_mode & 07777, 0640u);
    EXPECT_EQ(folder.fileCount(), 2u);

    std::filesystem::create_directory(folder / "deep");
    std::filesystem::create_symlink("deep/later", folder / "ahead");
    ASSERT_TRUE(replaceFile(folder / "ahead", fill).ok()) << "a link to a file that isn't there yet";
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "ahead"));
    EXPECT_EQ(contentOf(folder / "deep/later"), "new");
}

TEST(ReplaceFile, TellsWhyItCannot) {
    Scratch folder;
    put(folder / "file", "text");
    const auto never = [](const std::filesystem::path&) -> Status {
        ADD_FAILURE() << "nothing to fill";
        return Done{};
    };
    const auto messageFor = [&](const std::filesystem::path& target) {
        const Status status = replaceFile(target, never);
        return status.ok() ? std::string() : status.error().message;
    };
    EXPECT_NE(messageFor(folder / "file/a.ply").find("there is no folder"), std::string::npos);
    EXPECT_NE(messageFor(folder.path()).find("not a regular file"), std::string::npos);
    EXPECT_NE(messageFor("/dev/null").find("not a regular file"), std::string::npos);
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    EXPECT_NE(messageFor("/dev/fd/" + std::to_string(ends[1])).find("not a regular file"), std::string::npos);
    for (const int end : ends) close(end);
    EXPECT_NE(messageFor("/proc/sgm-test.ply"), "") << "a folder nobody can write to";
}

TEST(ReplaceFile, AFailingFillLeavesNothingBehind) {
    Scratch folder;
    const Status status = replaceFile(folder / "file", [](const std::filesystem::path&) -> Status {
        return Error{Error::Kind::Cancelled, "stopped"};
    });
    ASSERT_FALSE(status.ok());
    EXPECT_EQ(status.error().message, "stopped");
    EXPECT_EQ(folder.fileCount(), 0u);
}

TEST(Abandoned, TemporaryFilesAreRemovedByTheNextWriter) {
    const Scratch folder;
    const auto make = [&](const char* name, std::chrono::minutes age) {
        const auto path = folder.write(name, "half");
        std::filesystem::last_write_time(path, std::filesystem::file_time_type::clock::now() - age);
        return path;
    };
    using std::chrono_literals::operator""min;
    const auto dead = make(".sgm-1-0.tmp", 5min), fresh = make(".sgm-1-1.tmp", 0min), held = make(".sgm-1-2.tmp", 5min),
               other = make(".sgm-notes", 5min);
    const int fd = open(held.c_str(), O_RDONLY);
    ASSERT_EQ(flock(fd, LOCK_EX), 0) << "as its living process does";
    ASSERT_TRUE(replaceFile(folder / "a", [](const std::filesystem::path&) -> Status { return Done{}; }).ok());
    EXPECT_FALSE(std::filesystem::exists(dead));
    for (const auto& kept : {fresh, held, other}) EXPECT_TRUE(std::filesystem::exists(kept)) << kept;
    close(fd);
}

}  // namespace
}  // namespace sgm::exporter
