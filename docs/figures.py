"""Draws figures 2, 3 and 6 of paper A (Scott & Bujnowicz 2010) again, from the numbers and maps that towns use.

    python3 docs/figures.py      needs ImageMagick; from the root of the repository
"""

import math
import pathlib
import subprocess
import tempfile

OUT = pathlib.Path("docs/pictures/town")
MAPS = pathlib.Path("examples/city/maps")


def svg(name, width, height, parts):
    body = "\n".join(parts)
    text = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" '
        f'font-family="sans-serif" font-size="11">\n'
        f'<rect width="{width}" height="{height}" fill="#fff"/>\n{body}\n</svg>\n'
    )
    (OUT / name).write_text(text)


def line(a, b, colour, width, more=""):
    return (
        f'<line x1="{a[0]:.1f}" y1="{a[1]:.1f}" x2="{b[0]:.1f}" y2="{b[1]:.1f}" '
        f'stroke="{colour}" stroke-width="{width}" {more}/>'
    )


def label(at, text, colour="#333"):
    return f'<text x="{at[0]:.1f}" y="{at[1]:.1f}" fill="{colour}">{text}</text>'


def people(x, y):
    """Density about a centre at (330, 40), as `bump` has it."""
    t = 1 - ((x - 330) ** 2 + (y - 40) ** 2) / 260**2
    return t * t if t > 0 else 0


def figure3():
    """The probes of a highway: each sums density along its ray, near ground counting more (Growth::best)."""
    look, step, turn = 260, 40, math.radians(28)
    tip = (110, 150)
    parts = []
    stops = []
    for k in range(0, 9):
        grey = 255 - int(130 * (1 - (k / 8) ** 2) ** 2)
        stops.append(f'<stop offset="{k / 8}" stop-color="rgb({grey},{grey},{grey})"/>')
    parts.append(
        '<radialGradient id="d" gradientUnits="userSpaceOnUse" cx="330" cy="40" r="260">' + "".join(stops)
        + '</radialGradient><rect width="420" height="220" fill="url(#d)"/>'
    )
    parts.append(line((20, 160), tip, "#e0a030", 8))
    sums = []
    for k in range(-2, 3):
        angle = math.atan2(-10, 90) + turn * k / 2
        way = (math.cos(angle), math.sin(angle))
        at = [(tip[0] + way[0] * r, tip[1] + way[1] * r) for r in range(step, look + 1, step)]
        at = [p for p in at if 0 <= p[0] <= 420 and 0 <= p[1] <= 220]
        sums.append((sum(people(*p) / math.dist(p, tip) for p in at), way, at))
    best = max(s[0] for s in sums)
    for total, way, at in sums:
        colour = "#c0392b" if total == best else "#2c5f8a"
        parts.append(line(tip, at[-1], colour, 1.2, 'stroke-dasharray="4 3"'))
        parts += [f'<circle cx="{p[0]:.1f}" cy="{p[1]:.1f}" r="2.5" fill="{colour}"/>' for p in at]
        parts.append(label((at[-1][0] - 4, at[-1][1] - 6), f"{1000 * total:.1f}", colour))
        if total == best:
            parts.append(line(tip, (tip[0] + way[0] * 80, tip[1] + way[1] * 80), "#e0a030", 8))
    svg("figure3.svg", 420, 220, parts)


def figure6():
    """A road that slips between the ends of others, and the one that its segment's first crossing makes of it."""
    parts = []
    for i, title in enumerate(["ends alone are tested", "the segment is tested"]):
        x = 20 + 200 * i
        parts.append(line((x + 90, 15), (x + 90, 165), "#999", 7))
        parts += [f'<circle cx="{x + 90}" cy="{y}" r="4" fill="#555"/>' for y in (15, 165)]
        parts.append(line((x, 120), (x + 40, 106), "#e0a030", 7))
        end = (x + 170, 62) if i == 0 else (x + 90, 89)
        parts.append(line((x + 40, 106), end, "#c0392b" if i == 0 else "#3a7d44", 5))
        parts.append(f'<circle cx="{end[0]}" cy="{end[1]}" r="5" fill="{"#c0392b" if i == 0 else "#3a7d44"}"/>')
        parts.append(
            f'<circle cx="{x + 170}" cy="62" r="30" fill="none" stroke="#2c5f8a" stroke-dasharray="3 3"/>'
        )
        parts.append(label((x + 12, 190), title))
    svg("figure6.svg", 420, 200, parts)


def figure2():
    """The maps of examples/city: density and land, and a relief as a formula."""
    with tempfile.TemporaryDirectory() as folder:
        size = 150
        rows = []
        for y in range(size):
            for x in range(size):
                h = 0.0
                for cx, cy, r in ((0.78, 0.2, 0.5), (0.15, 0.75, 0.45)):
                    t = 1 - ((x / size - cx) ** 2 + (y / size - cy) ** 2) / r**2
                    h += t * t if t > 0 else 0
                rows.append(int(255 * min(h, 1)))
        relief = pathlib.Path(folder, "relief.pgm")
        relief.write_bytes(b"P5 %d %d 255\n" % (size, size) + bytes(rows))
        tiles = []
        for name, source in (("relief", relief), ("land", MAPS / "land.png"), ("people", MAPS / "people.png")):
            tile = f"{folder}/{name}.png"
            subprocess.run(["convert", str(source), "-resize", "150x150!", "-bordercolor", "white", "-border", "3", tile],
                           check=True)
            tiles.append(tile)
        subprocess.run(["convert", *tiles, "+append", "-quality", "75", "-strip", str(OUT / "figure2.jpg")], check=True)


if __name__ == "__main__":
    figure2()
    figure3()
    figure6()
