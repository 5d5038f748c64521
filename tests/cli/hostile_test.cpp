// Grammars, files and machines that mean no good, through the whole program: a message and an exit code, at once.
#include <sys/stat.h>

#include <chrono>
#include <csignal>

#include "tests/cli/program.h"
#include "tests/cpu_time.h"

namespace sgm::cli {
namespace {

class Hostile : public Cli {
protected:
    /// Runs and expects an end within seconds.
    Outcome quick(const std::string& arguments, const std::string& before = "") const {
        const auto started = std::chrono::steady_clock::now();
        const Outcome run = sgm(arguments, before);
        const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - started;
        EXPECT_LT(spent.count(), boundSeconds(10)) << arguments;
        return run;
    }
    /// A cube of 1 m with its low corner at a place, as OBJ.
    std::string cubeAt(const std::string& name, double x, double y, double z) const {
        std::string text;
        for (int i = 0; i < 8; ++i) {
            std::ostringstream line;
            line.precision(17);
            line << "v " << x + (i & 1) << ' ' << y + (i >> 1 & 1) << ' ' << z + (i >> 2) << '\n';
            text += line.str();
        }
        return scratch_.write(name, text + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n")
            .string();
    }
};

TEST_F(Hostile, GrammarsReachNoFileElsewhere) {
    scratch_.write("secret", "root:x:0:0\n");
    for (const std::string& name :
         {std::string("std//etc/passwd"), "std/" + path("secret"), path("secret"), std::string("secret")})
        for (const char* how : {"use \"%\"\nstart A -> cube\n", "start A -> mesh(\"%\")\n"}) {
            std::string text = how;
            text.replace(text.find('%'), 1, name);
            const Outcome run = quick("check " + grammar(text));
            EXPECT_EQ(run.code, 1) << text;
            EXPECT_EQ(run.out.find("root:"), std::string::npos) << run.out;
            EXPECT_NE(run.out.find("can't use"), std::string::npos) << run.out;
        }
}

TEST_F(Hostile, PipesAndDevicesAreNoGrammars) {
    ASSERT_EQ(mkfifo(path("pipe.sgm").c_str(), 0600), 0);
    for (const std::string& file : {path("pipe.sgm"), std::string("/dev/zero")})
        for (const char* command : {"check ", "build -q ", "fmt --check "}) {
            const Outcome run = quick(command + file);
            EXPECT_EQ(run.code, 1) << command << file;
            EXPECT_NE(run.out.find("not a file"), std::string::npos) << run.out;
        }
}

TEST_F(Hostile, MessagesSendNothingToTheTerminal) {
    const Outcome run = quick("check " + grammar("use \"\x1b[31mred.sgm\"\nstart A -> \x1b[2Jcube \xc2\x9b"
                                                 "31m\n"));
    EXPECT_EQ(run.code, 1);
    EXPECT_EQ(run.out.find('\x1b'), std::string::npos);
    EXPECT_EQ(run.out.find("\xc2\x9b"), std::string::npos);
    std::string params;
    for (int i = 0; i < 3000; ++i) params += "param p" + std::to_string(i) + " = 1\n";
    const Outcome many = quick("check " + grammar(params + "start A -> cube\n"));
    EXPECT_LT(many.out.size(), 40'000u);
    EXPECT_NE(many.out.find("2900 more warnings"), std::string::npos);
    EXPECT_LT(quick("check " + grammar("start A -> " + std::string(1 << 20, 'k') + "\n")).out.size(), 10'000u);
}

TEST_F(Hostile, OneFileIsOneFileHoweverItIsSpelt) {
    const Outcome self = quick("check " + grammar("use \"./test.sgm\"\nstart A -> cube\n"));
    EXPECT_EQ(self.code, 1);
    EXPECT_NE(self.out.find("in a circle"), std::string::npos) << self.out;
    EXPECT_LT(self.out.size(), 2000u);
    scratch_.write("wall.sgm", "grammar 1\nterminal wall\n");
    EXPECT_EQ(quick("check " + grammar("use \"wall.sgm\"\nuse \"./wall.sgm\"\nstart A -> wall\n")).code, 0);
}

TEST_F(Hostile, MeshesFarAwayAreTheSameSolid) {
    const auto built_from = [&](double x, double y, double z) {
        cubeAt("cube.obj", x, y, z);
        const Json mesh =
            built(grammar("start A -> mesh(\"cube.obj\") size 1\n") + " --resolution 40 -o " + path("out.ply"))["mesh"];
        EXPECT_NEAR(mesh.is_null() ? 0.0 : mesh["volume_m3"].get<double>(), 1, 0.01);
        return read(path("out.ply"));
    };
    const std::string near = built_from(0, 0, 0);
    ASSERT_FALSE(near.empty());
    EXPECT_EQ(built_from(500000, 5400000, 200), near) << "as a surveyor measures";
    EXPECT_EQ(built_from(0, 0, 1e9), near);
}

TEST_F(Hostile, OutputsReplaceNoInputAndNoOutput) {
    const std::string statue = cubeAt("statue.obj", 0, 0, 0), before = read(statue);
    scratch_.write("part.sgm", "grammar 1\nterminal wall\n");
    const std::string file = grammar("use \"part.sgm\"\nstart A -> mesh(\"statue.obj\")\n"), text = read(file);
    fs::create_symlink(statue, path("link.obj"));
    const std::string out = " -o " + path("x.glb");
    for (const std::string& arguments :
         {" -o " + statue, " -o " + path("./statue.obj"), " -o " + path("link.obj"), out + " --report " + file,
          out + " --report " + path("part.sgm"), out + " --report " + path("x.glb"), out + out,
          out + " --proxy " + path("../") + scratch_.path().filename().string() + "/x.glb",
          " -o " + path("y.obj") + " --report " + path("y.mtl")}) {
        const Outcome run = quick("build -q " + file + " --resolution 20" + arguments);
        EXPECT_EQ(run.code, 2) << arguments << run.out;
        EXPECT_NE(run.out.find("another name"), std::string::npos) << run.out;
    }
    EXPECT_EQ(read(statue), before);
    EXPECT_EQ(read(file), text);
    EXPECT_FALSE(fs::exists(path("x.glb"))) << "refused before the work";
    EXPECT_EQ(quick("build -q " + grammar("param n = 1 in 0..2\nstart A -> cube size (1 + n)\n") +
                    " --resolution 8 --animate n=0..1:12 -o " + path("a_%d.ply") + " -o " + path("a_%02d.ply"))
                  .code,
              2);
    EXPECT_EQ(quick("render -q " + file + " -o " + path("folder.png"), "mkdir -p " + path("folder.png") + "; ").code,
              1);
}

TEST_F(Hostile, NamesThatAreWrittenAlikeShareNoMaterialFile) {
    const std::string file = grammar("start A -> cube color #ff0000\n");
    EXPECT_EQ(quick("build -q " + file + " --resolution 8 -o '" + path("out a.obj") + "' -o " + path("out_a.obj")).code,
              0);
    EXPECT_EQ(scratch_.fileCount(), 5u) << "the grammar, and each its own material file";
}

TEST_F(Hostile, TargetsAreLookedAtBeforeTheWork) {
    const std::string endless =
        grammar("start A -> cube : B\nrule B weight 1 -> + cube at +x : B\nrule B weight 1 -> + cube at +y : B\n");
    ASSERT_EQ(mkfifo(path("pipe.ply").c_str(), 0600), 0);
    fs::create_directory(path("folder.ply"));
    for (const std::string& arguments :
         {"-o " + path("folder.ply"), "-o " + path("pipe.ply"), "-o " + path("gone/x.ply"),
          "-o " + path("x.ply") + " --report " + path("gone/r.json")}) {
        const Outcome run = quick("build -q " + endless + " " + arguments);
        EXPECT_EQ(run.code, 1) << run.out;
        EXPECT_NE(run.out.find("cannot write"), std::string::npos) << run.out;
    }
}

TEST_F(Hostile, AFloorThatCantBeMadeLeavesNothing) {
    const Outcome run =
        quick("build -q " + grammar("start A -> sphere size 2\n") + " --resolution 24 -o " + path("x.ply") +
              " --report " + path("r.json") + " --floor " + path("f.ply") + " --agent 50,100");
    EXPECT_EQ(run.code, 1) << run.out;
    EXPECT_NE(run.out.find("stand nowhere"), std::string::npos) << run.out;
    for (const char* file : {"x.ply", "r.json", "f.ply"}) EXPECT_FALSE(fs::exists(path(file))) << file;
}

TEST_F(Hostile, SmoothingThatMakesTheSurfaceCrossItselfSaysSo) {
    const auto said = [&](const char* options) {
        return quick("build examples/kifs/minster.sgm --resolution 32 -o " + path("x.ply") + options);
    };
    const Outcome smoothed = said(" --smooth 3");
    EXPECT_EQ(smoothed.code, 0);
    EXPECT_NE(smoothed.out.find("crosses itself"), std::string::npos) << smoothed.out;
    EXPECT_EQ(said("").out.find("crosses itself"), std::string::npos);
    EXPECT_EQ(said(" --smooth 3 --validate").code, 1);
}

TEST_F(Hostile, CladdingInCladdingHasABudget) {
    const auto build = [&](int depth) {
        std::string text = "cube size 10 clad ornament()";
        for (int i = 1; i < depth; ++i) text = "(" + text + ") clad ornament()";
        return quick("build -q " + grammar("start A -> " + text + "\n") + " --resolution 24 -o " + path("x.ply"));
    };
    EXPECT_EQ(build(4).code, 0);
    for (const int depth : {14, 20, 60}) {
        const Outcome run = build(depth);
        EXPECT_EQ(run.code, 3) << run.out;
        EXPECT_NE(run.out.find("cladding in cladding"), std::string::npos) << run.out;
        EXPECT_NE(run.out.find("test.sgm:2:"), std::string::npos) << run.out;
    }
}

TEST_F(Hostile, LsystemsOfManyWallsHaveABudget) {
    const Outcome run = quick("check " + grammar("lsystem P passes 12 angle 90deg step 1m\n  axiom \"[[[[[F]]]]]\"\n"
                                                 "  F -> \"[F[+F]F]\"\nstart A -> footprint P extrude 3m\n"));
    EXPECT_EQ(run.code, 3) << run.out;
    EXPECT_NE(run.out.find("walls"), std::string::npos) << run.out;
    EXPECT_NE(run.out.find("test.sgm:5:"), std::string::npos) << run.out;
}

TEST_F(Hostile, OutlinesThatCrossThemselvesMillionsOfTimesAreRefused) {
    std::string ring;
    for (uint32_t i = 0, x = 1; i < 3000; ++i) {
        ring += std::string(i ? "," : "") + "[" + std::to_string((x = x * 1664525 + 1013904223) % 1000) + ",";
        ring += std::to_string((x = x * 1664525 + 1013904223) / 4096 % 1000) + "]";
    }
    scratch_.write("star.geojson", R"({"type":"Polygon","coordinates":[[)" + ring + "]]}");
    const Outcome run = quick("check " + grammar("start A -> footprint file(\"star.geojson\", 1) extrude 3m\n"));
    EXPECT_EQ(run.code, 3) << run.out;
    EXPECT_NE(run.out.find("crosses itself more than"), std::string::npos) << run.out;
    EXPECT_NE(run.out.find("test.sgm:2:"), std::string::npos) << run.out;
}

TEST_F(Hostile, OutlinesThatCrossEachOtherMillionsOfTimesHaveABudget) {
    constexpr int teeth = 800;  // 2,560,000 crossings
    for (const bool isTurned : {false, true}) {
        std::string ring;
        const auto add = [&](int x, int z) {
            ring += (ring.empty() ? "[" : ",[") + std::to_string(isTurned ? z - .5 : x) + "," +
                    std::to_string(isTurned ? x + .5 : z) + "]";
        };
        for (int i = 0; i < teeth; ++i) {
            add(2 * i, i ? 1 : 0), add(2 * i, 2 * teeth), add(2 * i + 1, 2 * teeth);
            add(2 * i + 1, i + 1 < teeth ? 1 : 0);
        }
        scratch_.write(isTurned ? "b.geojson" : "a.geojson", R"({"type":"Polygon","coordinates":[[)" + ring + "]]}");
    }
    const std::string plans = "(file(\"a.geojson\", 1) % file(\"b.geojson\", 1))";
    for (const char* sign : {"+", "-"}) {
        std::string both = plans;
        both.replace(both.find('%'), 1, sign);
        const Outcome run =
            quick("build -q " + grammar("start A -> footprint " + both + " extrude 3m\n") + " -o " + path("x.ply"));
        EXPECT_EQ(run.code, 3) << run.out;
        EXPECT_NE(run.out.find("cross each other more than"), std::string::npos) << run.out;
        EXPECT_NE(run.out.find("test.sgm:2:"), std::string::npos) << run.out;
    }
    const Outcome set =
        sgm("build -q " + grammar("start A -> footprint file(\"a.geojson\", 1) extrude 3m setback 100m\n") + " -o " +
            path("x.ply"));
    EXPECT_EQ(set.code, 3) << set.out;
    EXPECT_NE(set.out.find("test.sgm:2:"), std::string::npos) << set.out;
}

TEST_F(Hostile, FilesThatTakeTooMuchWorkAreRefusedAsBudgetsAre) {
    // Each pair of large triangles covers the whole box, which takes every node of the grid.
    std::string layers;
    for (int i = 0; i < 1000; ++i)
        for (const char* corner : {"0 0", "100 0", "0 100", "100 100"})
            layers += std::string("v ") + corner + " " + std::to_string(i / 10.) + "\n";
    for (int i = 0; i < 1000; ++i) {
        const auto face = [&](int a, int b, int c) {
            layers += "f " + std::to_string(4 * i + a) + " " + std::to_string(4 * i + b) + " " +
                      std::to_string(4 * i + c) + "\n";
        };
        face(1, 2, 4), face(1, 4, 3), face(1, 4, 2), face(1, 3, 4);
    }
    scratch_.write("layers.obj", layers);
    fs::resize_file(scratch_.write("sparse.obj", ""), 2u << 30);
    const auto refused = [&](const std::string& mesh, const std::string& why, const std::string& command) {
        const Outcome run = sgm(command + grammar("start A -> mesh(\"" + mesh + "\")\n"));
        EXPECT_EQ(run.code, 3) << run.out;
        EXPECT_NE(run.out.find("test.sgm:2:"), std::string::npos) << run.out;
        EXPECT_NE(run.out.find(why), std::string::npos) << run.out;
    };
    refused("layers.obj", "too many large triangles", "check ");
    refused("sparse.obj", "larger than 1024 MiB", "check ");
    refused("sparse.obj", "larger than 1024 MiB", "build -q -o " + path("x.ply") + " ");
}

TEST_F(Hostile, NumbersWithoutEndAreToldWhereTheyAre) {
    const auto told = [&](const std::string& body, const std::string& words, int code = 1) {
        const Outcome run = quick("build -q " + grammar(body) + " --resolution 16 -o " + path("x.ply"));
        EXPECT_EQ(run.code, code) << body << run.out;
        EXPECT_NE(run.out.find(words), std::string::npos) << run.out;
        EXPECT_NE(run.out.find("test.sgm:"), std::string::npos) << run.out;
    };
    told("start A -> cube displace fbm(.1m, 1e38, 4)\n", "waves a metre");
    told("start A -> cube displace fbm(1e30m, 1, 4)\n", "waves a metre");
    told("start A -> cube size (1000, 1, .001)\n", "no surface at cells of");
    std::string noisy = "cube";
    for (int i = 0; i < 60; ++i) noisy = "(" + noisy + ") displace fbm(1m, 9, 4)";
    told("start A -> " + noisy + "\n", "noise lies on noise");
    told("start A -> cube turn (1e308deg * 1e10)\n", "no finite number");
    told("start A -> cube for i in 1..1000000000 { + cube at +x }\n", "there is no end", 3);
}

TEST_F(Hostile, BakedFoldersMayHoldAnything) {
    fs::create_directories(path("city/cells/0"));
    fs::create_directories(path("city/cells/19"));
    std::string levels = "0";
    for (int i = 0; i < 20; ++i) levels += ", 1";
    for (const std::string& plan :
         {std::string(R"({"cells": 3})"), std::string(R"({"cells": [null]})"), std::string(R"({"cells": {"a": {}}})"),
          std::string(R"({"errors_m": "x", "cells": []})"), std::string(R"({"errors_m": [1], "cells": ["9/0_0"]})"),
          R"({"errors_m": [)" + levels + R"(], "cells": ["19/0_0"]})",
          std::string(R"({"errors_m": [1], "side_m": -1, "cells": ["0/0_0"]})"),
          std::string(R"({"errors_m": [1], "cells": ["0/0_0"]})"), std::string(100'000, '[')}) {
        scratch_.write("city/plan.json", plan);
        scratch_.write("city/cells/0/0_0.json", R"({"bounds": [1, 2, "x"]})");
        scratch_.write("city/cells/19/0_0.json", R"({"bounds": [0, 0, 0, 1, 1, 1], "triangles": 1})");
        const Outcome run = quick("merge " + path("city"));
        EXPECT_EQ(run.code, 1) << plan.substr(0, 200) << run.out;
        EXPECT_EQ(run.out.find("internal"), std::string::npos) << run.out;
    }
    fs::remove(path("city/plan.json"));
    ASSERT_EQ(mkfifo(path("city/plan.json").c_str(), 0600), 0);
    EXPECT_EQ(quick("merge " + path("city")).code, 1);
}

TEST_F(Hostile, OptionsAreNumbersInTheirRange) {
    const std::string file = grammar("start A -> cube\n");
    for (const std::string option :
         {"--cell nan", "--cell inf", "--cell -1", "--simplify nan", "--max-seconds nan", "--max-seconds -1",
          "--max-seconds 0", "--max-shapes -1", "--max-shapes 99999999999999999999", "--tolerance nan",
          "--max-memory x", "--proxy-tolerance nan --proxy"}) {
        const Outcome run = quick("build -q " + file + " -o " + path("x.ply") + " " + option +
                                  (option.ends_with("--proxy") ? " " + path("y.ply") : ""));
        EXPECT_EQ(run.code, 2) << option << run.out;
    }
}

TEST_F(Hostile, ParsingAndCheckingEndAtOnce) {
    std::string text;
    for (int i = 0; i < 400'000; ++i) text += "rule A" + std::to_string(i) + " -> + cube size 1 at +x\n";
    const std::string file = grammar("start A0 -> cube\n" + text);
    for (const std::string& command : {"build -q " + file + " -o " + path("x.ply"), "check " + file})
        for (const char* signal : {"INT", "TERM"}) {
            const auto started = std::chrono::steady_clock::now();
            const Outcome run = sgm(command, std::string("timeout --preserve-status -s ") + signal + " .4 ");
            const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - started;
            EXPECT_TRUE(run.code == 130 || run.code == 128 + SIGTERM) << command << run.code << run.out;
            EXPECT_LT(spent.count(), boundSeconds(1)) << command;
        }
    EXPECT_FALSE(fs::exists(path("x.ply")));
}

TEST_F(Hostile, ASystemWithoutThreadsIsToldOf) {
    if (isSanitized) GTEST_SKIP() << "the leak checker wants a thread";
    if (geteuid() != 0) GTEST_SKIP() << "a limit of processes binds other users than root alone";
    fs::permissions(scratch_.path(), fs::perms::all);
    const std::string file = grammar("start A -> sphere\n"),
                      nobody = "prlimit --nproc=1 setpriv --reuid=65534 --clear-groups ";
    EXPECT_EQ(quick("build -q " + file + " -o " + path("x.ply"), nobody).code, 0) << "one thread will do";
    for (const std::string& arguments : {"-o " + path("x.vdb"), "--cave -o " + path("y.ply")}) {
        const Outcome run = quick("build -q " + file + " " + arguments, nobody);
        EXPECT_EQ(run.code, 3) << run.out;
        EXPECT_NE(run.out.find("no more threads"), std::string::npos) << run.out;
    }
}

TEST_F(Hostile, LibrariesOfVolumesThatFindNoRoomEndInAMessage) {
    if (isSanitized) GTEST_SKIP() << "memory isn't limited in instrumented programs";
    // They start threads while they are loaded, and end the program where they get none.
    const std::string file = grammar("start A -> sphere\n"), out = path("x.vdb");
    for (const int limit_kB : {182'000, 188'000, 242'000, 314'000}) {
        const Outcome run =
            sgm("build -q " + file + " --resolution 16 -o " + out, "ulimit -v " + std::to_string(limit_kB) + "; ");
        EXPECT_TRUE(run.code == 0 || run.code == 3) << limit_kB << ": " << run.code << ' ' << run.out;
    }
}

TEST_F(Hostile, ClosedAndFullStreamsHarmNoFile) {
    const std::string file = grammar("param unused = 1\nstart A -> cube\n");
    for (const char* streams : {"2>&-", ">&- 2>&-", "<&- >&- 2>&-", "2>/dev/full"}) {
        const std::string out = path("x.off");
        fs::remove(out);
        const int status = std::system((SGM_PROGRAM " build " + file + " --resolution 8 -o " + out + " " + streams +
                                        (std::string(streams).find(">&- ") == std::string::npos ? " >/dev/null" : ""))
                                           .c_str());
        EXPECT_TRUE(WIFEXITED(status)) << streams;
        EXPECT_EQ(read(out).substr(0, 3), "OFF") << streams;
    }
    for (const char* command : {"check ", "params --json ", "tree ", "check --json "}) {
        const int status =
            std::system((std::string(SGM_PROGRAM " ") + command + file + " >/dev/full 2>" + path("said")).c_str());
        EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 1) << command;
        EXPECT_NE(read(path("said")).find("standard output"), std::string::npos) << command << read(path("said"));
    }
}

TEST_F(Hostile, MemoryThatRunsOutIsAMessage) {
    if (isSanitized) GTEST_SKIP() << "memory isn't limited in instrumented programs";
    const std::string out = path("x.ply"), was = "as it was";
    scratch_.write("x.ply", was);
    for (const char* limits : {"--max-memory 300MB", "--max-memory 300MB --threads 1", "--max-memory 500MB --threads 8",
                               "--max-memory 400MB --stream"}) {
        const Outcome run =
            quick(std::string("build -q examples/kifs/mcgraw.sgm --resolution 4096 -o ") + out + " " + limits);
        EXPECT_EQ(run.code, 3) << limits << run.out;
        EXPECT_NE(run.out.find("memory"), std::string::npos) << run.out;
        EXPECT_EQ(read(out), was);
    }
    for (const int limit_kB : {200'000, 300'000}) {
        const Outcome run = sgm("build -q examples/grotto.sgm --resolution 1024 -o " + out,
                                "ulimit -v " + std::to_string(limit_kB) + "; ");
        EXPECT_TRUE(run.code == 3 || run.code == 0) << limit_kB << ": " << run.code << run.out;
    }
    EXPECT_EQ(scratch_.fileCount(), 1u) << "no temporary file is left";
}

}  // namespace
}  // namespace sgm::cli
