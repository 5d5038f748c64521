#!/usr/bin/env python3
"""Tries to crash, hang or exhaust the program with grammars and files that mean no good.

    tests/hostile/attempts.py [PROGRAM] [PATTERN]      (build/release/cli/sgm; only tries whose name holds PATTERN)

Every try runs in a folder of its own, for at most 30 s and 4 GB. It must end by itself with exit code 0, 1, 2 or 3, say
something where that isn't 0, leave no temporary file, and never end by a signal or with an internal error. Prints what
went wrong, and the counts; exit code 1 where anything did.
"""
import os
import resource
import shutil
import subprocess
import sys
import tempfile
import time

PROGRAM = os.path.abspath(sys.argv[1] if len(sys.argv) > 1 else "build/release/cli/sgm")
PATTERN = sys.argv[2] if len(sys.argv) > 2 else ""
LONGEST_S, MOST_BYTES = 30, 4 << 30
HUGE = ["0", "-1", ".0000001", "1e9", "1e18", "1e38", "1e308", "-1e308", "2147483648", "1e-320"]
NUMBERS = HUGE + ["(1e308 * 10)", "(0 / 0)", "(-1 / 0)"]


def grammars():
    """Pairs of a name and the text below the first line, which says the version."""
    # place and its variety
    for n in NUMBERS:
        yield f"place-variety {n}", f"start A -> size 9 split x {{ {{ 1m: place H variety {n} }}* }}\nstart H -> cube size 1..2\n"
        yield f"place-value {n}", f"param w = 1m in .1m..9m\nstart A -> size 9 place H {{ w = {n} }}\nstart H -> cube size w\n"
        yield f"place-size {n}", f"start A -> size {n} place H\nstart H -> cube\n"
    yield "place-self", "start A -> size 9 place A\n"
    yield "place-circle", "start A -> size 9 place B\nstart B -> size 9 place C\nstart C -> size 9 place A\n"
    yield "place-self-variety", "start A -> size 9 split x { { ~1m: place A variety 3 }* }\n"
    yield "place-self-smaller", "param w = 9m in 1m..9m\nstart A -> size w place A { w = w / 2 }\n"
    yield "place-self-counter", "param n = 1 in 0..1000000000\nstart A -> cube place A { n = n + 1 }\n"
    yield "place-exponential", "".join(
        f"start A{i} -> size 8 split x {{ ~1: place A{i + 1} | ~1: place A{i + 1} }}\n" for i in range(40)) + "start A40 -> cube\n"
    yield "place-chain", "".join(f"start A{i} -> size 8 place A{i + 1}\n" for i in range(3000)) + "start A3000 -> cube\n"
    yield "place-many-objects", "param w = 1m in 0m..1000000m\nstart A -> size (2000, 1, 1) split x { { 1m: place H { w = 1mm * i } }* }\nstart H -> cube size w\n"
    yield "place-many-places", "start A -> size (1000, 1, 1000) split x { { 1m: R }* }\nrule R -> split z { { 1m: place H }* }\nstart H -> cube\n"
    yield "place-nothing", "start A -> size 9 place H\nstart H -> nil\n"
    yield "place-unknown", "start A -> size 9 place Nowhere { w = 3 }\n"
    yield "place-endless", "start A -> size 9 place H\nstart H -> cube : C\nrule C -> + cube at +x : C\n"
    yield "place-on-lot", "start A -> footprint outline((0,0),(9,0),(0,9),(9,9)) extrude 3m place H on lot\nstart H -> extrude 4m\n"
    yield "place-in-cut", "start A -> cube size 9 - place H\nstart H -> cube\n"
    yield "place-in-blend", "start A -> cube size 9 + place H blend 1m\nstart H -> sphere\n"
    yield "place-in-morph", "start A -> morph(cube, place H, .5)\nstart H -> sphere\n"
    yield "place-turned", "start A -> cube turn (1e308deg, 0deg, 0deg) place H\nstart H -> sphere\n"
    yield "place-map", 'map m = here.x\nstart A -> size 9 place H\nstart H -> cube size (1 + m)\n'
    # materials
    yield "material-self", "material a of a\nstart A -> cube of a\n"
    yield "material-circle", "material a of b color #ffffff\nmaterial b of a\nstart A -> cube of a\n"
    yield "material-chain", "".join(f"material m{i} of m{i + 1}\n" for i in range(5000)) + "material m5000 color #112233\nstart A -> cube of m0\n"
    yield "material-chain-back", "material m0 color #112233\n" + "".join(f"material m{i + 1} of m{i}\n" for i in range(20000)) + "start A -> cube of m20000\n"
    yield "material-many", "".join(f"material m{i} color #{i:06x}\n" for i in range(50000)) + "start A -> cube of m7\n"
    yield "material-drawn", "start A -> cube of choose { 0: stone | 0: glass }\nmaterial stone\nmaterial glass\n"
    for n in NUMBERS:
        yield f"material-rough {n}", f"material a color #fff rough {n} metal {n}\nstart A -> cube of a\n"
    # let
    yield "let-self", "let a = a\nstart A -> cube size a\n"
    yield "let-later", "let a = b\nlet b = a\nstart A -> cube size a\n"
    yield "let-doubling", "let a0 = 2\n" + "".join(f"let a{i + 1} = a{i} + a{i}\n" for i in range(200)) + "start A -> cube size a200\n"
    yield "let-squares", "let a0 = 10\n" + "".join(f"let a{i + 1} = a{i} * a{i}\n" for i in range(60)) + "start A -> cube size a60\n"
    yield "let-body-doubling", "start A -> let a0 = 1..2 " + " ".join(f"let a{i + 1} = (a{i} + a{i})" for i in range(60)) + " cube size a60\n"
    yield "let-many", "".join(f"let a{i} = {i}\n" for i in range(100000)) + "start A -> cube size a99999\n"
    yield "let-vector-nest", "let a = ((((1, 2, 3))))\nstart A -> cube size a\n"
    # row, around, mirror, from-to
    for n in NUMBERS:
        yield f"row-count {n}", f"start A -> size 9 row {n} along x {{ cube }}\n"
        yield f"row-gap {n}", f"start A -> size 9 row 3 along x gap {n} {{ cube }}\n"
        yield f"around-count {n}", f"start A -> size 9 around {n} radius 3m {{ cube }}\n"
        yield f"around-radius {n}", f"start A -> size 9 around 5 radius {n} {{ cube }}\n"
        yield f"from-to {n}", f"start A -> cube + cylinder from (0, 0, 0) to ({n}, {n}, {n}) size .2m\n"
        yield f"from-to-thick {n}", f"start A -> cube + cylinder from -y to +y size {n}\n"
        yield f"split {n}", f"start A -> size 9 split x {{ {{ {n}: cube }}* }}\n"
        yield f"split-share {n}", f"start A -> size 9 split x {{ 100% - {n}: cube | ~{n}: cube }}\n"
        yield f"through {n}", f"start A -> cube size 9 : M\nrule M -> + F size (100%, 100%, {n}) at +z to centre\nrule F -> - cube size {n} through M\n"
        yield f"extrude {n}", f"start A -> footprint rect({n}, 8) extrude {n}\n"
        yield f"setback {n}", f"start A -> footprint ell(16, 12, 5, 6) setback {n} extrude 3m\n"
        yield f"footprint-ngon {n}", f"start A -> footprint ngon({n}) extrude 3m\n"
        yield f"roof {n}", f"start A -> footprint rect(9, 8) extrude 3m + hipRoof({n}, overhang: {n}) at +y\n"
        yield f"lots {n}", f"start A -> footprint rect(900, 800) extrude 3m lots box({n}, front: {n}) {{ lot: cube | corner: cube }}\n"
        yield f"network {n}", f"roads N {{ limit = {n} }}\nstart A -> size (600, 10, 600) network N {{ street: R }}\nrule R -> extrude .3m\n"
        yield f"network-size {n}", f"roads N {{ }}\nstart A -> size ({n}, 10, {n}) network N {{ street: R }}\nrule R -> extrude .3m\n"
        yield f"map {n}", f"map m = bump(({n}, 0m), {n}) + fbm({n}, 3) / here.x\nstart A -> size 9 cube size (1 + m)\n"
        yield f"blend {n}", f"start A -> cube + sphere at +x blend {n}\n"
        yield f"overlap {n}", f"start A -> cube + cube at +x overlap {n} shift ({n}, 0, 0)\n"
        yield f"clad {n}", f"start A -> cube size 9 clad ornament(passes: 3, bay: {n}, storey: {n}) tile ({n}, 4m) thickness ({n}, .2m)\n"
        yield f"weights {n}", f"start A -> choose {{ {n}: cube | {n}: sphere }}\n"
        yield f"shuffled {n}", f"start A -> size 9 row 5 along x {{ cube size choose shuffled {{ {n}: 1m | {n}: 2m }} }}\n"
        yield f"lsystem {n}", f'lsystem P passes {n} angle {n} step {n}\n  axiom "F+F+F+F"\n  F -> "FF+F-F"\nstart A -> footprint P extrude 3m\n'
        yield f"repeat {n}", f"start A -> cube : B\nrule B repeat {n} -> + cube size (1 ~> {n}) at +y : B\n"
        yield f"check-expect {n}", f"start A -> cube\ncheck A expect shapes == {n}\n"
    yield "row-in-row", "start A -> size 9 " + "row 9 along x { " * 40 + "cube" + " }" * 40 + "\n"
    yield "mirror-in-mirror", "start A -> size 9 " + "mirror x { " * 60 + "cube" + " }" * 60 + "\n"
    yield "around-in-around", "start A -> size 9 " + "around 9 radius 1m { " * 30 + "cube" + " }" * 30 + "\n"
    yield "split-in-split", "start A -> size 9 B\nrule B -> split x { { ~.01m: B }* }\n"
    yield "split-forever", "start A -> size 9 B\nrule B -> split x { ~1: B | ~1: B }\n"
    yield "through-many", "start A -> cube size 90 : M\nrule M -> + F size 100% at +z to centre\nrule F -> row 3000 along x { - cube size .1m through M }\n"
    yield "through-nobody", "start A -> cube - cube through Nobody\n"
    yield "lsystem-exponential", 'lsystem P passes 40 angle 90deg step 1m\n  axiom "F"\n  F -> "FFFFFFFFFFFFFFFFF"\nstart A -> footprint P extrude 3m\n'
    yield "lsystem-brackets", 'lsystem P passes 12 angle 90deg step 1m\n  axiom "[[[[[F"\n  F -> "[F[+F]F"\nstart A -> footprint P extrude 3m\n'
    yield "lsystem-crossings", 'lsystem P passes 9 angle 89deg step 1m\n  axiom "F"\n  F -> "F+F+F+F-F"\nstart A -> footprint P extrude 3m\n'
    yield "roads-everything", "roads N { pull = 1 spread = true water = true park = true height = here.x }\nstart A -> size (6000, 10, 6000) network N { block: B }\nrule B -> lots 20 { lot: cube }\n"
    yield "roads-nan", "map m = sqrt(here.x)\nroads N { pull = m / m height = m }\nstart A -> size (600, 10, 600) network N { block: B }\nrule B -> lots 20 { lot: cube }\n"
    yield "map-self", "map m = m\nstart A -> cube size m\n"
    yield "map-picture-missing", 'map m = "none.png" as 0..1 over (2km, 2km)\nstart A -> cube size m\n'
    yield "map-picture-passwd", 'map m = "/etc/passwd" as 0..1 over (2km, 2km)\nstart A -> cube size m\n'
    yield "map-picture-grammar", 'map m = "a.sgm" as 0..1 over (2km, 2km)\nstart A -> cube size m\n'
    yield "footprint-passwd", 'start A -> footprint file("/etc/passwd", 1) extrude 3m\n'
    yield "footprint-number", 'start A -> footprint file("a.geojson", 1e18) extrude 3m\n'
    yield "footprint-bow", "start A -> footprint outline((0,0),(9,9),(9,0),(0,9)) extrude 3m\n"
    yield "footprint-flat", "start A -> footprint outline((0,0),(9,0),(18,0)) extrude 3m\n"
    yield "footprint-many", "start A -> footprint outline(" + ",".join(f"({i % 97}, {i * 7919 % 101})" for i in range(3000)) + ") extrude 3m\n"
    yield "footprint-sum", "start A -> footprint (" + " + ".join(["ngon(64, 5m)"] * 1500) + ") extrude 3m\n"
    yield "round-many", "start A -> footprint round(100000, 5m) extrude 3m hipRoof(30deg)\n"
    yield "label-control", 'param a = 1 in 0..2 "\\x1b[31m</script><script>alert(1)</script>" group "</title>"\nstart A -> cube size (1 + a)\n'
    yield "name-script", "material script color #ffffff\nstart A -> cube of script\n"
    yield "deep-parens", "start A -> cube size " + "(" * 100000 + "1" + ")" * 100000 + "\n"
    yield "deep-choose", "start A -> cube size " + "choose { 1: " * 5000 + "1" + " }" * 5000 + "\n"
    yield "wide-choose", "start A -> cube size choose { " + " | ".join(f"{i}: {i}" for i in range(1, 50000)) + " }\n"
    yield "many-starts", "".join(f"start A{i} -> cube\n" for i in range(20000))
    yield "many-checks", "start A -> cube\n" + "check A expect shapes == 1\n" * 20000
    yield "many-styles", "param a = 1 in 0..2\nstart A -> cube size (1 + a)\n" + "".join(f"style S{i} {{ a = 2 }}\n" for i in range(20000))
    yield "many-params", "".join(f"param a{i} = 1 in 0..2\n" for i in range(5000)) + "start A -> cube size (" + "+".join(f"a{i}" for i in range(5000)) + ")\n"
    yield "many-derive", "start A -> cube\nrule R: A -> cube\n" + "".join(f"derive d{i}: R\n" for i in range(5000))
    yield "derive-long", "start A -> cube : B\nrule R: B -> + cube at +x : B\nderive d: " + " => ".join(["R"] * 20000) + "\n"
    yield "use-self", 'use "a.sgm" { w = 3 }\nstart A -> cube\n'
    yield "while-true", "start A -> cube while true { + cube at +x }\n"
    yield "endless-morph", "start A -> " + "morph(cube, " * 90 + "sphere" + ", .5)" * 90 + "\n"
    yield "wide-sum", "start A -> cube " + "+ cube at +x " * 20000 + "\n"
    yield "bytes", bytes(range(256)).decode("latin-1") * 50
    yield "unicode", "start Ä -> cube\u202e size \U0001f600\n" * 100
    yield "empty", ""


COMMANDS = {
    "check": ["check", "a.sgm", "--try-seconds", "2"],
    "build": ["build", "a.sgm", "--resolution", "12", "-o", "x.glb", "-o", "x.html", "--max-seconds", "5"],
    "bake": ["bake", "a.sgm", "-o", "folder", "--side", "64", "--max-seconds", "5"],
    "section": ["build", "a.sgm", "--resolution", "12", "--section", "x=50%", "-o", "x.ply", "--max-seconds", "5"],
    "upgrade": ["fmt", "--upgrade", "a.sgm"],
}
#: Commands beside the grammars: options and files.
OPTIONS = [["build", "a.sgm", "--section", s, "-o", "x.ply"] for s in
           ["x=nan", "x=1e308", "x=", "=", "w=1", "x=1=2", "x=-1e308m", "x=50%%", "x=" + "9" * 5000, "-x=0", "y=1e-320", ""]]
OPTIONS += [["bake", "a.sgm", "-o", "folder", *o] for o in
            [["--tile", "0/0"], ["--tile", "5/4"], ["--tile", "-1/4"], ["--tile", "1/99999999999"], ["--tile", "x"], ["--tile", "1/0"],
             ["--side", "nan"], ["--cell", "nan"], ["--side", "1", "--cell", "10000"], ["--side", "1e5", "--cell", ".001"],
             ["--levels", "8"], ["--missing", "1000000"], ["--object-cell", ".001"], ["--threads", "1024"]]]
OPTIONS += [["bake", "a.sgm", "-o", "a.sgm"], ["bake", "a.sgm", "-o", "/proc/x"], ["bake", "a.sgm", "-o", "/dev/null"], ["merge", "none"],
            ["merge", "a.sgm"], ["merge", "/dev/null"], ["merge", "/proc"], ["merge", "."], ["merge", ".", "--verify"], ["merge", ".", "--at", "nan,nan"],
            ["build", "a.sgm", "-o", "x.html", "-o", "./x.html"], ["build", "a.sgm", "-o", "a.sgm/x.html"]]
PLANS = ["", "{", "[]", "null", "3", '{"cells": 3}', '{"cells": [null]}', '{"cells": [[1e308, -1e308]]}', '{"levels": 1e18}', "[" * 100000,
         '{"cells":[{"x":1e99,"z":"a","level":-5}]}', '{"format":"sgm","version":99}', "\x00" * 1000]


def limit():
    resource.setrlimit(resource.RLIMIT_AS, (MOST_BYTES, MOST_BYTES))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def wrong_with(arguments, folder):
    """What is wrong with how a command ended, or ""; and its exit code."""
    started = time.monotonic()
    try:
        run = subprocess.run([PROGRAM, *arguments], cwd=folder, preexec_fn=limit, timeout=LONGEST_S, stdin=subprocess.DEVNULL,
                             stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    except subprocess.TimeoutExpired:
        return f"has not ended after {LONGEST_S} s", None
    took = time.monotonic() - started
    said = run.stdout.decode("utf-8", "replace")
    if run.returncode not in (0, 1, 2, 3):
        return f"ended with {run.returncode}: {said[-300:]}", run.returncode
    if "internal error" in said:
        return f"said: {said[-300:]}", run.returncode
    if run.returncode and not said.strip():
        return f"ended with {run.returncode} and said nothing", run.returncode
    if len(said) > 200_000:
        return f"said {len(said)} characters", run.returncode
    if any(c < " " and c not in "\n\t\r" or "\x7f" <= c < "\xa0" for c in said):
        return "sent control characters", run.returncode
    if took > 20:
        return f"took {took:.0f} s", run.returncode
    left = [f for _, _, files in os.walk(folder) for f in files if ".tmp" in f]
    return ("left " + left[0] if left else ""), run.returncode


def tries():
    for name, text in grammars():
        for version in (1, 2):
            for command, arguments in COMMANDS.items():
                if version == 2 and command in ("upgrade", "section"):
                    continue
                yield f"{name} {command} {version}", {"a.sgm": f"grammar {version}\n{text}"}, arguments
    town = "roads N { }\nstart T -> size (100, 5, 100) network N { block: B }\nrule B -> lots 200 { lot: L }\nrule L -> place H variety 2\nstart H -> cube size 3..4\n"
    for arguments in OPTIONS:
        yield " ".join(arguments)[:80], {"a.sgm": "grammar 1\n" + town}, arguments
    for i, plan in enumerate(PLANS):
        for file in ("plan.json", "cells/0/0_0.json"):
            yield f"merge-{file}-{i}", {f"c/{file}": plan, "c/plan.json" if file != "plan.json" else "c/x": "{}"}, ["merge", "c", "--verify"]


def main():
    counts, faults = {}, 0
    for name, files, arguments in tries():
        if PATTERN not in name:
            continue
        folder = tempfile.mkdtemp(prefix="sgm-try-")
        for file, text in files.items():
            path = os.path.join(folder, file)
            os.makedirs(os.path.dirname(path), exist_ok=True)
            with open(path, "w", encoding="utf-8", errors="replace") as out:
                out.write(text)
        wrong, code = wrong_with(arguments, folder)
        counts[code] = counts.get(code, 0) + 1
        if wrong:
            faults += 1
            print(f"{name}: {wrong}", flush=True)
        shutil.rmtree(folder, ignore_errors=True)
    ends = ", ".join(f"{n} with {'no end' if c is None else c}" for c, n in sorted(counts.items(), key=str))
    print(f"{sum(counts.values())} tries: {ends}; {faults} wrong")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
