#!/usr/bin/python3
"""A baked city has the same bytes however many tasks make it, in any order, with one thread or two, and however often they
are killed:  bake_kills_test.py SGM [--tasks 1,7,64] [--kills 50] [--grammar FILE] [--seed 1]

Tasks are killed with -9 at random moments and started again, a folder after the other, until so many died at work.  Every
file but the journals is compared by its SHA-256."""
import argparse
import hashlib
import json
import os
import random
import signal
import subprocess
import tempfile
import time

from small_town import TOWN

SIZES = ["--side", "64", "--cell", "1", "--object-cell", ".5"]


def digests(folder):
    """SHA-256 by file, without journals and what killed tasks hadn't finished."""
    found = {}
    for at, _, names in os.walk(folder):
        if os.path.relpath(at, folder).split(os.sep)[0] == "journal":
            continue
        for name in names:
            if name.startswith(".sgm-") and name.endswith(".tmp"):
                continue
            with open(os.path.join(at, name), "rb") as file:
                found[os.path.relpath(os.path.join(at, name), folder)] = hashlib.sha256(file.read()).hexdigest()
    return found


class Baker:
    def __init__(self, sgm, grammar, sizes, chance):
        self.sgm, self.grammar, self.sizes, self.chance = sgm, grammar, sizes, chance

    def command(self, folder, task, of, threads):
        return [self.sgm, "bake", self.grammar, "-o", folder, *self.sizes, "--tile", f"{task}/{of}", "--threads", str(threads), "-q"]

    def bake(self, folder, task, of, threads=1):
        subprocess.run(self.command(folder, task, of, threads), check=True)

    def merge(self, folder):
        subprocess.run([self.sgm, "merge", folder, "--verify", "-q"], check=True)
        return digests(folder)

    def missing(self, folder, of):
        words = [self.sgm, "bake", self.grammar, "-o", folder, *self.sizes, "--missing", str(of)]
        said = subprocess.run(words, check=True, capture_output=True, text=True).stdout.strip()
        numbers = []
        for part in filter(None, said.split(",")):
            first, _, last = part.partition("-")
            numbers += range(int(first), int(last or first) + 1)
        return numbers

    def killed(self, folder, of, longest_s, most):
        """Starts tasks and kills them until all cells are there: how many died at work."""
        kills = 0
        while tasks := self.missing(folder, of):
            task = self.chance.choice(tasks)
            if kills >= most:
                self.bake(folder, task, of)
                continue
            process = subprocess.Popen(self.command(folder, task, of, self.chance.choice((1, 2))))
            time.sleep(self.chance.uniform(0, longest_s))
            process.send_signal(signal.SIGKILL)
            kills += process.wait() == -signal.SIGKILL
        return kills


    def interrupted(self, folder, after_s):
        """Ends a task by Ctrl-C; finishes what it left."""
        process = subprocess.Popen(self.command(folder, 1, 1, 1), stderr=subprocess.PIPE, text=True)
        time.sleep(after_s)
        process.send_signal(signal.SIGINT)
        said = process.communicate()[1]
        assert process.returncode == 130 or process.returncode == 0 and not self.missing(folder, 3), (process.returncode, said)
        begun = len(self.missing(folder, 64))
        self.bake(folder, 1, 1)
        return begun


def compare(whole, other, what):
    assert whole.keys() == other.keys(), (what, sorted(whole.keys() ^ other.keys())[:5])
    wrong = [name for name in whole if whole[name] != other[name]]
    assert not wrong, (what, wrong[:5])
    print(f"{what}: {len(whole)} files, all equal", flush=True)


def main():
    options = argparse.ArgumentParser()
    options.add_argument("sgm")
    options.add_argument("--tasks", default="1,7,64")
    options.add_argument("--kills", type=int, default=50)
    options.add_argument("--grammar")
    options.add_argument("--seed", type=int, default=1)
    given, sizes = options.parse_known_args()
    chance = random.Random(given.seed)
    with tempfile.TemporaryDirectory() as scratch:
        grammar = given.grammar or os.path.join(scratch, "town.sgm")
        if not given.grammar:
            sizes = SIZES
            with open(grammar, "w", encoding="utf-8") as file:
                file.write(TOWN)
        baker = Baker(given.sgm, grammar, sizes, chance)
        folder = os.path.join(scratch, "whole")
        begin = time.monotonic()
        baker.bake(folder, 1, 1)
        took_s = time.monotonic() - begin
        whole = baker.merge(folder)
        with open(os.path.join(folder, "manifest.json"), encoding="utf-8") as file:
            manifest = json.load(file)
        print(f"{manifest['places']} places, {len(manifest['cells'])} cells, {len(manifest['library'])} files of the library")
        for of in map(int, given.tasks.split(",")):
            folder = os.path.join(scratch, f"by{of}")
            tasks = list(range(1, of + 1))
            chance.shuffle(tasks)
            for task in tasks:
                baker.bake(folder, task, of, 1 + task % 2)
            compare(whole, baker.merge(folder), f"{of} tasks in any order, one thread and two")
        folder = os.path.join(scratch, "interrupted")
        left = baker.interrupted(folder, .35 * took_s)
        compare(whole, baker.merge(folder), f"ended by Ctrl-C with {left} of 64 tasks to do")
        kills, rounds = 0, 0
        while kills < given.kills:
            rounds += 1
            folder = os.path.join(scratch, f"killed{rounds}")
            kills += baker.killed(folder, 3, took_s, given.kills - kills)
            compare(whole, baker.merge(folder), f"killed {kills} times, {rounds} folders")


main()
