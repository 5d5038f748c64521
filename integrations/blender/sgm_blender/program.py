"""Runs `sgm` and reads what it says. Knows nothing of Blender."""
import json
import os
import re
import shutil
import subprocess
import threading
from dataclasses import dataclass

PLACED = re.compile(r"^(.*?):(\d+):(\d+): (error|warning): (.*)$")
PLAIN = re.compile(r"^(sgm|note): (.*)$")
PROGRESS = re.compile(r"^progress: (.*) (\d+)$")
UNIX_FOLDERS = ("/usr/local/bin", "/usr/bin", "/opt/sgm/bin")


@dataclass
class Message:
    """A problem that sgm told: where (line 0: nowhere), a sentence, and the fix where it has one."""

    severity: str
    text: str
    file: str = ""
    line: int = 0
    column: int = 0
    fix: str = ""


class Failed(Exception):
    """sgm couldn't be run, or refused the grammar: `messages` say why."""

    def __init__(self, messages):
        super().__init__("; ".join(message.text for message in messages))
        self.messages = messages


def find(wanted=""):
    """The program's path: `wanted` where it is said, else `sgm` on the PATH or in the usual folders; "" if there is none."""
    if wanted:
        return wanted if os.access(wanted, os.X_OK) and os.path.isfile(wanted) else ""
    return shutil.which("sgm") or shutil.which("sgm", path=os.pathsep.join(UNIX_FOLDERS)) or ""


def read_messages(text):
    """What sgm's standard error holds: a message a problem, in order."""
    found = []
    below = []  # the lines below a placed problem: its text, the caret, the fix

    def close():
        if found and found[-1].line:
            found[-1].fix = " ".join(line.strip() for line in below[2:])
        below.clear()

    for line in text.splitlines():
        placed, plain = PLACED.match(line), PLAIN.match(line)
        if placed:
            close()
            file, at, column, severity, sentence = placed.groups()
            found.append(Message(severity, sentence, file, int(at), int(column)))
        elif plain:
            close()
            found.append(Message("error" if plain[1] == "sgm" else "note", plain[2]))
        elif line.startswith("  "):
            below.append(line)
    close()
    return found


def read_panel(program, grammar, timeout_s=20):
    """The grammar's parameters, starts, styles and ways, as `sgm params --panel` prints them. Raises Failed."""
    if not program:
        raise Failed([Message("error", "the program sgm isn't found", fix="name it in the add-on's preferences")])
    try:
        run = subprocess.run([program, "params", grammar, "--panel"], capture_output=True, timeout=timeout_s)
    except subprocess.TimeoutExpired:
        raise Failed([Message("error", f"sgm took more than {timeout_s} s to read {grammar}")]) from None
    except OSError as problem:
        raise Failed([Message("error", f"sgm doesn't run: {problem}")]) from None
    if run.returncode != 0:
        told = run.stderr.decode("utf-8", "replace")
        raise Failed(read_messages(told) or [Message("error", told.strip() or f"sgm ended with {run.returncode}")])
    return json.loads(run.stdout)


def is_whole(parameter):
    """Whether a number, or every component of a vector, is a whole number."""
    default = parameter["default"]
    return all(isinstance(part, int) for part in (default if isinstance(default, list) else [default]))


def value_text(parameter, value):
    """A parameter's value as `--set` takes it: within its range, with its unit."""
    kind = parameter["kind"]
    if kind == "boolean":
        return "true" if value else "false"
    if kind == "text":
        return '"' + str(value).replace("\\", "\\\\").replace('"', '\\"') + '"'
    if kind not in ("integer", "real", "vector"):
        return str(value)
    unit, whole = parameter.get("unit", ""), is_whole(parameter)

    def one(number, at):
        for name, pick in (("minimum", max), ("maximum", min)):
            if name in parameter:
                end = parameter[name]
                number = pick(number, end[at] if isinstance(end, list) else end)
        return f"{round(number)}{unit}" if whole else f"{number:.7g}{unit}"

    if kind == "vector":
        return "(" + ", ".join(one(number, at) for at, number in enumerate(value)) + ")"
    return one(value, 0)


class Job:
    """A run of sgm in the background."""

    def __init__(self, arguments, folder):
        self.arguments = arguments
        self.folder = folder
        self.stage, self.fraction = "", 0.0
        self.cancelled = False
        self._told = []
        self._process = subprocess.Popen(
            arguments, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self):
        with self._process.stderr as told:
            for raw in told:
                line = raw.decode("utf-8", "replace").rstrip("\r\n")
                progress = PROGRESS.match(line)
                if progress:
                    self.stage, self.fraction = progress[1], int(progress[2]) / 100
                else:
                    self._told.append(line)

    def poll(self):
        """The exit code, or None while it runs."""
        if self._reader.is_alive():
            return None
        return self._process.wait()

    def cancel(self):
        """Asks it to end; nothing of what it wrote is used."""
        self.cancelled = True
        if self._process.poll() is None:
            self._process.terminate()

    def end(self):
        """Ends it now and waits for that."""
        self.cancel()
        try:
            self._process.wait(2)
        except subprocess.TimeoutExpired:
            self._process.kill()
        self._reader.join(2)

    def messages(self):
        told = read_messages("\n".join(self._told))
        if not told and self.poll() not in (0, None):
            told = [Message("error", " ".join(self._told) or f"sgm ended with {self.poll()}")]
        return told
