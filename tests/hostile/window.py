#!/usr/bin/env python3
"""Drives the window at random as a user would, and watches its memory, its frames and its gaps.

    tests/hostile/window.py [PROGRAM] [SECONDS] [SEED]      (build/release/cli/sgm-viewer, 3600, 1)

Starts a display of its own (Xvfb) and the window on copies of small examples in a temporary folder, and clicks, drags, types,
opens, saves, exports, resizes and changes files from outside (xdotool, and the places of widgets that `--report` tells).
The seed fixes what is chosen; when it is done depends on the machine, so two runs of a seed are alike and not the same.

Prints a line a minute. Every five minutes the first example is opened again, as it was and in a window of the first size, and
the memory is read at rest. At the end: the actions, the frames, the memory at the first rest and at the last, and the gaps
between two looks at the user's input, with drawing and without, by the wall's clock and by the processor's for that thread.

Exit code 1 where the window ends, where no frame comes within 20 s while something is asked or input isn't taken within 60 s
(with the seed and the last 20 actions), or where the memory at the last rest is more than 20 % and 32 MiB above that of the
first. Gaps are told and not judged: drawing is by software here. SIGUSR1 ends a run early, with its figures.
"""
import glob
import json
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

PROGRAM = os.path.abspath(sys.argv[1] if len(sys.argv) > 1 else "build/release/cli/sgm-viewer")
SECONDS = float(sys.argv[2]) if len(sys.argv) > 2 else 3600
SEED = int(sys.argv[3]) if len(sys.argv) > 3 else 1
EXAMPLES = ["figure1", "grotto", "tower", "joints", "morphs", "tutorial", "cumulus", "knot", "buildings/lots", "buildings/pavilion",
            "buildings/lsystem", "buildings/gothic", "caves/dripstone"]  # so many stand in the dialog without being scrolled
SIZE = (1280, 800)
FRAME_S, INPUT_S, REST_S, LINE_S, SCENE_S = 20, 60, 300, 60, 40
MOST_BYTES = 12 << 30
CLOCKS = ["wall", "processor"]
WRONG = [" colr #ff0000", "}", "(", '"', " size", "rule Q ->", "param z = 1e999", " at free(+q)", "start Q -> Q", "    ->", "grammar 9"]
RIGHT = [" color #ff8800", "  ", " size 1.5"]
FILLS = ["1", "0", "-3", "wide > 1m", "sphere", "cube", "morph(sphere, cube, .5)", "2", "(.2, 0, 0)", "nothing", "Base", "1e30", ""]
KEYS = ["w", "s", "a", "d", "q", "e", "k", "shift+k", "f", "Home", "1", "2", "3", "4", "5", "6", "7", "F1", "n", "h", "b", "Escape"]
UNDOS = ["ctrl+z", "ctrl+z", "ctrl+z", "ctrl+y", "ctrl+shift+z"]


class Wrong(Exception):
    """The window has ended, hangs or takes too much."""


def quiet(arguments, **more):
    return subprocess.run(arguments, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False, **more)


class Display:
    def __init__(self):
        reads, writes = os.pipe()
        self.server = subprocess.Popen(["Xvfb", "-displayfd", str(writes), "-screen", "0", "%dx%dx24" % SIZE, "-nolisten", "tcp"],
                                       pass_fds=[writes], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(writes)
        with os.fdopen(reads) as ready:
            self.name = ":" + ready.readline().strip()  # comes once the server is ready
        self.environment = dict(os.environ, DISPLAY=self.name, LIBGL_ALWAYS_SOFTWARE="1")

    def tool(self, *words):
        try:
            quiet(["xdotool", *map(str, words)], env=self.environment, timeout=120)
        except subprocess.TimeoutExpired as late:
            raise Wrong("xdotool waits in vain: " + " ".join(map(str, words))) from late


class Window:
    """The program, what it reports, and what it was last asked for."""

    def __init__(self, display, folder, file):
        self.display, self.folder = display, folder
        self.path = os.path.join(folder, "report.json")
        self.actions, self.pointer, self.stamp, self.last, self.size = [], None, None, {}, SIZE
        self.asked = self.moved = time.monotonic()
        self.log = open(os.path.join(folder, "log"), "wb")  # pylint: disable=consider-using-with
        self.process = subprocess.Popen([PROGRAM, file, "--report", self.path], cwd=folder, stdout=self.log, stderr=self.log,
                                        env=dict(display.environment, XDG_STATE_HOME=os.path.join(folder, ".state")))
        while not self.report().get("state", {}).get("shapes") or self.state("busy"):
            self.check()
            time.sleep(.05)
        display.tool("search", "--sync", "--onlyvisible", "--name", "sgm$", "windowsize", *SIZE, "windowfocus", "sleep", "0.1")

    def report(self):
        try:
            stamp = os.stat(self.path)
            if (stamp.st_ino, stamp.st_mtime_ns) != self.stamp:
                with open(self.path, encoding="utf-8") as file:
                    self.last = json.load(file)
                self.stamp, self.moved = (stamp.st_ino, stamp.st_mtime_ns), time.monotonic()
        except FileNotFoundError:
            pass
        return self.last

    def state(self, name):
        return self.report()["state"][name]

    def widgets(self):
        return self.report()["widgets"]

    def figure(self, name):
        """A line of /proc/PID/status, in KiB where it is memory."""
        with open(f"/proc/{self.process.pid}/status", encoding="ascii", errors="replace") as file:
            found = re.search(rf"^{name}:\s+(\d+)", file.read(), re.M)
        return int(found.group(1)) if found else 0  # of a process that has just ended

    def files(self):
        return len(os.listdir(f"/proc/{self.process.pid}/fd"))

    def check(self):
        """Raises where the program has ended, shows nothing more or takes too much."""
        code = self.process.poll()
        if code is not None:
            raise Wrong("the window ended " + (f"by {signal.Signals(-code).name}" if code < 0 else f"with {code}"))
        self.report()
        now = time.monotonic()
        working = self.last and (self.last["state"]["busy"] or not self.last["state"]["still"])
        if now - max(self.asked, self.moved) > FRAME_S and (self.moved < self.asked or working):
            raise Wrong(f"no frame for {now - max(self.asked, self.moved):.0f} s")
        if not self.taken() and now - self.asked > INPUT_S:
            raise Wrong(f"input isn't taken within {INPUT_S} s: {self.last['state']['input']}, pointer {self.pointer}")
        if self.figure("VmRSS") * 1024 > MOST_BYTES:
            raise Wrong(f"takes {self.figure('VmRSS') >> 10} MiB")

    def taken(self):
        """Whether the pointer is known where it is, and all buttons and keys are known to be up."""
        given = self.last.get("state", {}).get("input")
        return given is None or (given["buttons"] == 0 and given["keys"] == 0 and (self.pointer is None or (given["x"], given["y"]) == self.pointer))

    def wait(self, holds, seconds):
        """Waits until something holds, at most so long; whether it does."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            self.check()
            if holds():
                return True
            time.sleep(.01)
        return False

    def send(self, *words):
        """Input all at once; returns when it was taken."""
        self.actions.append(" ".join(map(str, words)))
        for i, word in enumerate(words):
            if word == "mousemove":
                self.pointer = (int(words[i + 1]), int(words[i + 2]))
        self.asked = time.monotonic()
        frame = self.report()["frame"]
        self.display.tool(*words)
        self.wait(lambda: self.last["frame"] > frame and self.taken(), INPUT_S + 5)

    def note(self, text):
        self.actions.append(text)

    def rested(self, seconds):
        return self.wait(lambda: self.last["state"]["still"] and not self.last["state"]["busy"], seconds)

    def place(self, name, x=.5, y=.5):
        """A place of a widget in shares of its size, within the window; None where it isn't seen."""
        box = self.widgets().get(name)
        if not box:
            return None
        return tuple(min(max(int(box[i] + share * box[i + 2]), 0), self.size[i] - 1) for i, share in ((0, x), (1, y)))

    def click(self, name, x=.5, y=.5, button=1):
        place = self.place(name, x, y)
        if place:
            self.note(f"click {name}")
            self.send("mousemove", *place, "mousedown", button, "mouseup", button)
        return place is not None

    def drag(self, begin, *ends, button=1, key=None):
        words = ["keydown", key] if key else []
        words += ["mousemove", *begin, "mousedown", button]
        for end in ends:
            words += ["mousemove", *end, "sleep", ".04"]
        self.send(*words, "mouseup", button, *(["keyup", key] if key else []))


class User:
    """Chooses what to do next."""

    def __init__(self, window, folder, names):
        self.window, self.folder, self.names = window, folder, names
        self.random = random.Random(SEED)
        self.done = self.at = 0
        self.originals = {}
        for name in names:
            with open(os.path.join(folder, name), encoding="utf-8") as file:
                self.originals[name] = file.read()
        self.kinds = [(self.any_widget, 26), (self.slider, 14), (self.camera, 12), (self.wheel, 6), (self.keys, 8), (self.undo, 10), (self.type, 10),
                      (self.fill, 5), (self.export, 4), (self.save, 3), (self.outside, 4), (self.resize, 3), (self.carry, 6), (self.picture, 1),
                      (self.step, 4), (self.pane, 4)]

    def share(self):
        return self.random.random()

    def act(self):
        window = self.window
        if window.state("question"):
            self.answer()
        elif "open.cancel" in window.widgets() or "save.cancel" in window.widgets():
            window.click(self.random.choice([n for n in window.widgets() if n.startswith(("open.", "save.")) and not n.endswith((".folder", ".name"))]))
        else:
            self.random.choices([kind for kind, _ in self.kinds], [weight for _, weight in self.kinds])[0]()
        self.done += 1
        window.wait(lambda: False, self.random.choice([0, .02, .1, .3]))
        if self.share() < .2:
            window.rested(5)

    def answer(self, wanted=None):
        answers = [n for n in self.window.widgets() if n.startswith("answer.")]
        if answers:
            self.window.click(wanted if wanted in answers else self.random.choice(answers))

    def some(self, *prefixes):
        """A widget by chance, each kind of them alike; empty where there is none."""
        kinds = {}
        for name in self.window.widgets():
            if name.startswith(prefixes) if prefixes else name != "bar.open":
                kinds.setdefault(name.split(".")[0], []).append(name)
        return self.random.choice(kinds[self.random.choice(sorted(kinds))]) if kinds else ""

    def any_widget(self):
        self.window.click(self.some(), self.share(), self.share(), self.random.choices([1, 2, 3], [8, 1, 1])[0])

    def slider(self):
        name = self.some("param.", "section.share", "letters.letter", "export.cells", "seed")
        if not name:
            return
        if self.share() < .1:
            place = self.window.place(name)
            self.window.note(f"value of {name}")
            self.window.send("keydown", "ctrl", "mousemove", *place, "mousedown", 1, "mouseup", 1, "keyup", "ctrl")
            self.window.send("type", "--delay", 5, "--", self.random.choice(["3", "0.5", "9999", "-1", "x"]))
            self.window.send("key", "Return")
            return
        most = .45 if name == "export.cells" else 1  # as fine as that takes seconds
        self.window.note(f"drag {name}")
        self.window.drag(*[self.window.place(name, self.share() * most) for _ in range(self.random.randint(2, 12))])

    def view(self):
        return self.some("view.")

    def camera(self):
        name = self.view()
        if name:
            self.window.note(f"camera in {name}")
            self.window.drag(*[self.window.place(name, self.share(), self.share()) for _ in range(self.random.randint(2, 8))],
                             button=self.random.randint(1, 3), key=self.random.choice([None, None, None, "alt", "shift", "ctrl"]))

    def wheel(self):
        name = self.some("view.", "view.", "shape.", "rule.", "line.", "param.")
        place = self.window.place(name, self.share(), self.share())
        if place:
            self.window.send("mousemove", *place, "click", "--repeat", self.random.randint(1, 6), "--delay", 10, self.random.choice([4, 5]))

    def keys(self):
        self.window.send("key", "--delay", 4, *self.random.choices(KEYS, k=self.random.randint(1, 5)))

    def undo(self):
        self.window.send("key", "--delay", 4, *self.random.choices(UNDOS, k=self.random.randint(1, 8)))

    def type(self):
        """Into the text: what breaks it, what mends it, and what is right."""
        window = self.window
        if not window.click("tab.Text") or not window.wait(lambda: "text" in window.widgets(), 2):
            return
        line = self.some("line.")
        if not line or not window.click(line, self.random.choice([.99, .99, .5, .1])):
            return
        typed = self.random.choice(WRONG + RIGHT * 2)
        window.send("type", "--delay", 5, "--", typed)
        if self.share() < .3:
            window.rested(3)
        how = self.share()
        if how < .5:
            window.send("key", "--delay", 4, *["BackSpace"] * len(typed))
        elif how < .6:
            window.send("key", "--delay", 4, "Return", "Tab", "shift+Home", "ctrl+c", "ctrl+v", "Delete")
        elif how < .65:
            window.send("key", "--delay", 4, "Home", "shift+End", "ctrl+x", "Down", "ctrl+v")
        elif how < .67:
            window.send("key", "--delay", 4, "ctrl+a", "Delete")
        if self.share() < .5:
            window.send("key", "Escape")

    def fill(self):
        """Into a field of the rules' panel."""
        window = self.window
        window.click("tab.Rules")
        rule = self.some("rule.")
        if rule:
            window.click(rule)
        fields = [n for n in window.widgets() if n.startswith("edit.") or n in ("rule.new", "style.name", "shapes.filter")]
        if fields and window.click(self.random.choice(sorted(fields)), .3):
            window.send("key", "ctrl+a")
            text = self.random.choice(FILLS)
            window.send(*(("type", "--delay", 5, "--", text) if text else ("key", "Delete")))
            window.send("key", self.random.choice(["Return", "Return", "Escape"]))

    def step(self):
        self.window.click("tab.Step")
        for _ in range(self.random.randint(1, 5)):
            name = self.some("step.", "apply.", "live.", "letters.")
            if name:
                self.window.click(name)

    def pane(self):
        self.window.click(self.some("pane.", "mesh.look", "look.", "mesh.wire", "mesh.section"))
        self.window.wait(lambda: False, .2)
        name = self.some("mesh.look.", "look.joints.", "look.motion.")
        if name:
            self.window.click(name)

    def export(self):
        window = self.window
        if not window.click("tab.Export") or not window.wait(lambda: "export.format" in window.widgets(), 2):
            return
        window.click("export.format")
        window.wait(lambda: False, .2)
        name = self.some("export.format..")
        if name:
            window.click(name)
        if window.place("export.cells"):
            window.drag(window.place("export.cells"), window.place("export.cells", self.share() * .4))
        window.click("export.export")
        if self.share() < .3:
            window.click("export.cancel")

    def picture(self):
        self.window.send("key", self.random.choice(["p", "p", "t"]))

    def save(self):
        self.window.send("key", "ctrl+s")

    def carry(self):
        """A shape onto a joint or another, a rule above another, a handle, an edge between panels."""
        name = self.some("shape.", "rule.", "handle.", "left", "right")
        if not name:
            return
        to = self.some("shape.", "rule.", "view.", "joint.") if name.startswith(("shape.", "rule.")) else self.view()
        begin, end = self.window.place(name), self.window.place(to or name, self.share(), self.share())
        self.window.note(f"carry {name} to {to}")
        self.window.drag(begin, (min(begin[0] + 12, self.window.size[0] - 1), begin[1]), end, end)

    def resize(self, size=None):
        size = size or (self.random.randint(720, SIZE[0]), self.random.randint(480, SIZE[1]))
        if size == self.window.size:
            return  # nothing is drawn for that
        self.window.size, self.window.pointer = size, None  # it may be outside now
        self.window.send("search", "--onlyvisible", "--name", "sgm$", "windowsize", *size)

    def outside(self):
        """Another program writes, removes or damages the file that is open."""
        name = self.names[self.at]
        path, text = os.path.join(self.folder, name), self.originals[name]
        how = self.random.randrange(6)
        self.window.note(f"{name} from outside: {how}")
        self.window.asked = time.monotonic()
        if how == 0 and os.path.exists(path):
            os.remove(path)
            return
        changed = [text, text + "// from outside\n", text[:self.random.randrange(len(text))], text.replace("size", "sise", 1), "", "\0\xff" * 40][how]
        aside = path + ".aside"
        with open(aside if self.share() < .5 else path, "w", encoding="utf-8") as file:
            file.write(changed)
        if os.path.exists(aside):
            os.replace(aside, path)

    def open(self, at):
        """Another example as it was; whether it came."""
        window, name = self.window, self.names[at]
        with open(os.path.join(self.folder, name), "w", encoding="utf-8") as file:
            file.write(self.originals[name])
        for left in glob.glob(os.path.join(self.folder, "*")):  # what was exported and pictured
            if os.path.isfile(left) and os.path.basename(left) not in (*self.names, "report.json", "log") and not left.endswith((".geojson", ".new")):
                os.remove(left)
        for _ in range(5):
            if window.state("question"):
                self.answer()
            window.send("key", "Escape")
            window.send("key", "Escape")
            window.send("key", "ctrl+o")
            if not window.wait(lambda: f"open.{name}" in window.widgets(), 3):
                continue
            window.rested(10)  # the list has found its place
            window.click(f"open.{name}")
            window.wait(lambda: window.state("question") or window.state("text") == self.originals[name], 5)
            if window.state("question"):
                window.wait(lambda: any(n.startswith("answer.") for n in window.widgets()), 3)
                self.answer("answer.Open without saving")
            if window.wait(lambda: window.state("text") == self.originals[name] and not window.state("question"), 10):
                self.at = at
                return True
        return False

    def rest(self):
        """Resident memory in KiB with the first example as it was, in a window of the first size, at rest."""
        for _ in range(5):
            self.resize(SIZE)
            if self.open(0) and self.window.click("pane.Field") and self.window.wait(
                    lambda: self.window.state("drawn") and self.window.state("still") and not self.window.state("busy"), 120):
                self.window.wait(lambda: False, 5)
                return self.window.figure("VmRSS")
        raise Wrong("the first example can't be opened again")


def gaps(window):
    """What the program tells of its gaps, as text."""
    told = window.last.get("gaps")
    if not told:
        return "no gaps are reported"
    clocks = lambda g: ", ".join(f"{g[clock]['over']} over 50 ms by the {clock}'s clock, at most {1000 * g[clock]['longest']:.0f} ms" for clock in CLOCKS)
    return "; ".join(f"{how}: {clocks(g)}" for how, g in told.items() if how != "turns")


def line(begun, user, window):
    print(f"{time.monotonic() - begun:5.0f} s  {user.done:6} actions  {window.last['frame']:7} frames  RSS {window.figure('VmRSS') >> 10:5} MiB, "
          f"at most {window.figure('VmHWM') >> 10} MiB  {window.figure('Threads')} threads  {window.files()} files  {gaps(window)}", flush=True)


def end(user, window, rests):
    """Prints the figures; whether the memory is flat."""
    first, last = rests[0][1], rests[-1][1]
    print(f"seed {SEED}: {user.done} actions, {window.last['frame']} frames")
    print("memory at rest: " + ", ".join(f"{at:.0f} s {kib >> 10} MiB" for at, kib in rests))
    for how, told in window.last.get("gaps", {}).items():
        if how == "turns":
            print(f"{told} turns of the loop, each a gap between two looks at the input")
            continue
        for clock in CLOCKS:
            g = told[clock]
            print(f"{how}, by the {clock}'s clock: {g['over']} gaps over 50 ms ({100 * g['over'] / window.last['gaps']['turns']:.3f} %), "
                  f"most of them in {g['most']}")
            print(f"  the longest {1000 * g['longest']:.1f} ms, after frame {g['frame']}: " +
                  ", ".join(f"{name} {1000 * spent:.1f} ms" for name, spent in g["parts"].items() if spent > .001))
    flat = last <= first * 1.2 or last - first <= 32 << 10
    print(f"memory {first >> 10} MiB after {rests[0][0]:.0f} s, {last >> 10} MiB at the end: {'flat' if flat else 'NOT flat'}")
    return flat


def drive(window, user):
    begun = time.monotonic()
    passed = lambda: time.monotonic() - begun
    rests, lines, scenes = [], 1, 1
    first = min(REST_S, SECONDS / 3)
    stopped = []
    signal.signal(signal.SIGUSR1, lambda *_: stopped.append(True))
    while passed() < SECONDS and not stopped:
        user.act()
        if passed() > lines * LINE_S:
            lines += 1
            line(begun, user, window)
        if passed() > first + REST_S * len(rests):
            rests.append((passed(), user.rest()))
            print(f"{rests[-1][0]:5.0f} s  at rest {rests[-1][1] >> 10} MiB", flush=True)
        elif passed() > scenes * SCENE_S:
            scenes = int(passed() / SCENE_S) + 1
            user.resize(SIZE)
            user.open((user.at + 1) % len(user.names))
    rests.append((passed(), user.rest()))
    line(begun, user, window)
    return end(user, window, rests)


def main():
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))  # so that nothing is left running
    display = Display()
    folder = tempfile.mkdtemp(prefix="sgm-window-")
    names = []
    for example in EXAMPLES:
        names.append(os.path.basename(example) + ".sgm")
        shutil.copy(f"examples/{example}.sgm", os.path.join(folder, names[-1]))
    shutil.copytree("examples/meshes", os.path.join(folder, "meshes"))
    shutil.copy("examples/buildings/lots.geojson", folder)
    window = None
    fine = False
    try:
        window = Window(display, folder, os.path.join(folder, names[0]))
        fine = drive(window, User(window, folder, names))
    except Wrong as wrong:
        print(f"{wrong}; seed {SEED}; the last actions:")
        for action in window.actions[-20:] if window else []:
            print("   ", action)
        with open(os.path.join(folder, "log"), encoding="utf-8", errors="replace") as log:
            print(log.read()[-2000:])
        print(f"what it worked on is kept in {folder}")
    finally:
        if window and window.process.poll() is None:
            window.process.kill()
            window.process.wait()
        display.server.terminate()
        display.server.wait()
    if fine:
        shutil.rmtree(folder, ignore_errors=True)
    return 0 if fine else 1


if __name__ == "__main__":
    sys.exit(main())
