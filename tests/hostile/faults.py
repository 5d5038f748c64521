#!/usr/bin/env python3
"""Runs the program where memory, disks and patience end.

    tests/hostile/faults.py memory  [PROGRAM] [EVERY]   every command on every example within 200, 400, 800 MB and 4 GB
    tests/hostile/faults.py kills   [PROGRAM] [COUNT]   COUNT builds killed (SIGKILL) at random moments
    tests/hostile/faults.py signals [PROGRAM] [COUNT]   the same with SIGINT, SIGTERM and SIGHUP, and how long they take
    tests/hostile/faults.py disk    [PROGRAM]           full disks, folders that can't be written, closed pipes

EVERY = 7 runs every seventh case; SIGUSR1 ends a run early, with its counts. Every run has to end by itself with exit code 0, 1 or 3 (130 where it was cancelled), and
an output is afterwards either what it was before or whole. Prints what went wrong, and the counts.

`memory`, `kills` and `signals` keep a line for each case in build/faults-WHAT.txt and leave out those that stand there, so that a run goes on where the last one
ended; the counts are of all of them. Remove the file to begin anew, as with another program.
"""
import collections
import glob
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time

WHAT = sys.argv[1] if len(sys.argv) > 1 else "memory"
PROGRAM = os.path.abspath(sys.argv[2] if len(sys.argv) > 2 else "build/release/cli/sgm")
NUMBER = int(sys.argv[3]) if len(sys.argv) > 3 else (1 if WHAT == "memory" else 1000)
EXAMPLES = sorted(os.path.abspath(p) for p in glob.glob("examples/**/*.sgm", recursive=True))
FOLDER = tempfile.mkdtemp(prefix="sgm-faults-")
COMMANDS = [["build", "-q", "--resolution", "96", "-o", "x.glb"], ["build", "-q", "--resolution", "64", "-o", "x.vdb"],
            ["build", "-q", "--resolution", "96", "--stream", "-o", "x.ply"], ["render", "-q", "-o", "x.png", "--size", "160x120"],
            ["check"], ["tree"], ["params"], ["fmt", "--check"], ["bake", "-q", "-o", "city"]]
KEPT = f"build/faults-{WHAT}.txt"
wrong = 0
stopped = False


def stop(*_):
    """Ends the run after the case in hand, with what it has found."""
    global stopped
    stopped = True


signal.signal(signal.SIGUSR1, stop)


def tell(text):
    global wrong
    wrong += 1
    print(text, flush=True)


class Kept:
    """The cases that have had their turn, in a file that outlasts the run: a name and how it ended, a line each."""

    def __init__(self):
        os.makedirs(os.path.dirname(KEPT), exist_ok=True)
        with open(KEPT, "a+", encoding="utf-8") as file:
            file.seek(0)
            self.ends = dict(line.rstrip("\n").split("\t")[:2] for line in file)

    def keep(self, case, ended):
        self.ends[case] = str(ended)
        with open(KEPT, "a", encoding="utf-8") as file:
            file.write(f"{case}\t{ended}\n")

    def counts(self, kind=lambda case: ""):
        """How many of each kind of case ended in each way."""
        return sorted(collections.Counter((kind(case), ended) for case, ended in self.ends.items()).items())


def run(arguments, limit_bytes=0, **more):
    def prepare():
        resource.setrlimit(resource.RLIMIT_CPU, (300, 310))  # so that a busy machine is no hang
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        if limit_bytes:
            resource.setrlimit(resource.RLIMIT_AS, (limit_bytes, limit_bytes))
    return subprocess.run([PROGRAM, *arguments], cwd=FOLDER, preexec_fn=prepare, timeout=3000, stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False, **more)


def memory():
    kept = Kept()
    cases = [(m, e, c) for m in (200, 400, 800, 4000) for e in EXAMPLES for c in COMMANDS][::NUMBER]
    random.Random(5).shuffle(cases)  # so that a run that is cut short has met all commands and limits
    for mebibytes, example, command in cases:
        what = f"{mebibytes} MB: {' '.join(command)} {os.path.relpath(example)}"
        if what in kept.ends:
            continue
        if stopped:
            break
        try:
            ended = run([command[0], example, *command[1:]], mebibytes * 1_000_000)
        except subprocess.TimeoutExpired:
            tell(f"{what}: waits for ever")
            kept.keep(what, "no end")
            continue
        said = ended.stdout.decode("utf-8", "replace")
        if ended.returncode == -signal.SIGXCPU:
            tell(f"{what}: has not ended after 300 s of processor time")
        elif ended.returncode not in (0, 1, 3) or "internal error" in said:
            tell(f"{what}: ended with {ended.returncode}: {said[-200:]}")
        if ended.returncode == 1 and command[0] not in ("fmt", "check"):
            tell(f"{what}: is refused: {said[-200:]}")
        for file in os.listdir(FOLDER):
            if ".tmp" in file:
                tell(f"{what}: left {file}")
            path = os.path.join(FOLDER, file)
            shutil.rmtree(path) if os.path.isdir(path) else os.remove(path)
        kept.keep(what, ended.returncode)
    print(f"{len(kept.ends)} cases")
    for (limit, ended), count in kept.counts(lambda case: case.split(":")[0]):
        print(f"{limit}: {count} ended with {ended}")


JOBS = [["build", "-q", "--resolution", "160", "-o", "x.glb"], ["build", "-q", "--resolution", "160", "-o", "x.ply", "--stream"],
        ["build", "-q", "--resolution", "96", "-o", "x.vdb"], ["build", "-q", "--resolution", "160", "-o", "x.obj"],
        ["render", "-q", "-o", "x.png"], ["build", "-q", "--resolution", "128", "--simplify", ".3", "-o", "x.stl"],
        ["build", "-q", "--resolution", "64", "-o", "x.html"]]


def interrupted(signals):
    """Interrupts builds at moments spread over the time that they take."""
    kept = Kept()
    grammar = os.path.abspath("examples/tower.sgm")
    whole, lasts = {}, {}
    for job in JOBS:
        name = job[job.index("-o") + 1]
        started = time.monotonic()
        assert run([job[0], grammar, *job[1:]]).returncode == 0, job
        lasts[name] = time.monotonic() - started
        with open(os.path.join(FOLDER, name), "rb") as file:
            whole[name] = file.read()
    waits = [float(ended.split()[1]) for ended in kept.ends.values() if ended != "no end"]
    for i in range(len(kept.ends), NUMBER):
        if stopped:
            break
        draw = random.Random(f"11 {i}")
        job = JOBS[i % len(JOBS)]
        name = job[job.index("-o") + 1]
        path = os.path.join(FOLDER, name)
        old = b"as it was" if draw.random() < .5 else whole[name]
        with open(path, "wb") as file:
            file.write(old)
        process = subprocess.Popen([PROGRAM, job[0], grammar, *job[1:]], cwd=FOLDER, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        time.sleep(draw.random() * lasts[name])
        sent, at = signals[i % len(signals)], time.monotonic()
        process.send_signal(sent)
        try:
            said = process.communicate(timeout=60)[1].decode("utf-8", "replace")
        except subprocess.TimeoutExpired:
            process.kill()
            process.communicate()
            tell(f"{name}: has not ended 60 s after signal {sent}")
            kept.keep(f"{i} {name}", "no end")
            continue
        waits.append(time.monotonic() - at)
        kept.keep(f"{i} {name}", f"{process.returncode} {waits[-1]:.3f}")
        # A program that has not begun to listen ends by the signal, as any does.
        if process.returncode not in (0, 130, -sent) or "internal" in said:
            tell(f"{name}: ended with {process.returncode}: {said[-200:]}")
        with open(path, "rb") as file:
            found = file.read()
        if found not in (old, whole[name]):
            tell(f"{name}: is neither as it was nor whole after signal {sent}")
        if sent != signal.SIGKILL and any(".tmp" in f for f in os.listdir(FOLDER)):
            tell(f"{name}: a temporary file is left after signal {sent}")
    waits.sort()
    ends = collections.Counter(ended.split(" ")[0] for ended in kept.ends.values())
    print(", ".join(f"{n} ended with {c}" for c, n in sorted(ends.items())),
          f"; from the signal to the end {waits[len(waits) // 2]:.3f} s in the median, {waits[-1]:.2f} s at most")
    if signals == [signal.SIGKILL]:
        for file in os.listdir(FOLDER):  # as if a minute had passed, for a file younger than that may be another's
            os.utime(os.path.join(FOLDER, file), (time.time() - 120,) * 2)
        assert run(["build", grammar, "-q", "--resolution", "16", "-o", "x.ply"]).returncode == 0
        left = [f for f in os.listdir(FOLDER) if ".tmp" in f]
        print(f"{len(left)} temporary files are left after the next build")
        for file in left:
            tell(f"left {file}")


def disk():
    grammar = os.path.abspath("examples/tower.sgm")
    names = ["x.glb", "x.gltf", "x.ply", "x.stl", "x.obj", "x.off", "x.usda", "x.vdb", "x.html"]
    for kibibytes in (0, 4, 100):  # as a limit of a file's size, which the system tells of as of a full disk
        for name in names:
            path = os.path.join(FOLDER, name)
            with open(path, "w", encoding="ascii") as file:
                file.write("as it was")
            ended = subprocess.run(["bash", "-c", f"ulimit -f {kibibytes}; exec \"$@\"", "-", PROGRAM, "build", grammar, "-q", "--resolution", "128", "-o", path],
                                   cwd=FOLDER, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
            with open(path, "rb") as file:
                kept = file.read() == b"as it was"
            if ended.returncode not in (0, 1) or (ended.returncode == 1) != kept or len(os.listdir(FOLDER)) != 1:
                tell(f"{name} with at most {kibibytes} KiB: ended with {ended.returncode}, {os.listdir(FOLDER)}: {ended.stdout[-200:]}")
            os.remove(path)
    for arguments in (["-o", "/proc/x.glb"], ["-o", "/dev/full"], ["-o", "/sys/x.ply"], ["-o", "none/x.ply"]):
        ended = run(["build", grammar, "-q", "--resolution", "16", *arguments])
        if ended.returncode not in (1, 2) or not ended.stdout:
            tell(f"{arguments}: ended with {ended.returncode}")
    for command in (["tree"], ["params"], ["reference"], ["check"], ["build", "--resolution", "16", "-o", "x.ply"]):
        arguments = [command[0]] + ([] if command[0] == "reference" else [grammar]) + command[1:]
        process = subprocess.Popen([PROGRAM, *arguments], cwd=FOLDER, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        process.stdout.close()
        process.stderr.close()
        code = process.wait(120)
        if code not in (0, 1, -signal.SIGPIPE):
            tell(f"{command} into a closed pipe: ended with {code}")
    print("full disks, closed pipes: done")


def main():
    {"memory": memory, "kills": lambda: interrupted([signal.SIGKILL]), "disk": disk,
     "signals": lambda: interrupted([signal.SIGINT, signal.SIGTERM, signal.SIGHUP])}[WHAT]()
    shutil.rmtree(FOLDER, ignore_errors=True)
    print(f"{wrong} wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
