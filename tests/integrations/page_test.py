#!/usr/bin/python3
"""Opens pages that `sgm build -o model.html` writes in Chromium and Firefox: they draw the mesh that was built, ask for nothing, and
answer the pointer.  page_test.py SGM [FOLDER for pictures of what is seen]"""
import json
import os
import socket
import subprocess
import sys
import tempfile

import browser
import firefox

SGM = sys.argv[1]
PICTURES = sys.argv[2] if len(sys.argv) > 2 else None
PALACE_BYTES = 1_500_000


def built(folder, name, *arguments):
    """The page's path and the build's report."""
    page, report = os.path.join(folder, name + ".html"), os.path.join(folder, "report.json")
    run = subprocess.run([SGM, "build", *arguments, "-q", "-o", page, "--report", report], capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
    with open(report, encoding="utf-8") as file:
        return page, json.load(file)


def opened(tab, page):
    tab.open("file://" + page)
    tab.wait("window.sgmPage && document.getElementById('view').dataset.drawn > 0")
    assert set(tab.requests) <= {"file://" + page, "data:,"}, tab.requests
    assert not tab.errors, tab.errors


def colours(tab):
    """How many different colours the canvas shows."""
    return tab.value("""(() => {
        const gl = sgmPage.renderer.gl, w = gl.drawingBufferWidth, h = gl.drawingBufferHeight, all = new Uint8Array(4 * w * h);
        gl.readPixels(0, 0, w, h, gl.RGBA, gl.UNSIGNED_BYTE, all);
        return new Set(new Uint32Array(all.buffer)).size;
    })()""")


def drawn_after(tab, action):
    """Whether what an action changes is drawn otherwise."""
    state = "(() => { const gl = sgmPage.renderer.gl, w = gl.drawingBufferWidth, h = gl.drawingBufferHeight, all = new Uint8Array(4 * w * h); " \
            "gl.readPixels(0, 0, w, h, gl.RGBA, gl.UNSIGNED_BYTE, all); let sum = 0; for (const v of new Uint32Array(all.buffer)) sum = (sum * 31 + v) >>> 0; return sum; })()"
    before, count = tab.value(state), tab.value("document.getElementById('view').dataset.drawn")
    action()
    tab.wait(f"document.getElementById('view').dataset.drawn > {count}")
    return tab.value(state) != before


def test_requests_are_seen(tab, folder):
    """That nothing is asked for means something: what a page does ask for is noticed."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        address = f"http://127.0.0.1:{server.getsockname()[1]}/seen.png"
        page = os.path.join(folder, "asking.html")
        with open(page, "w", encoding="utf-8") as file:
            file.write(f"<!doctype html><script>new Image().src = '{address}'</script>")
        tab.open("file://" + page)
        server.settimeout(30)
        with server.accept()[0] as asked:
            asked.recv(4096)
            asked.sendall(b"HTTP/1.1 200 OK\r\nContent-Type: image/svg+xml\r\nConnection: close\r\n\r\n<svg xmlns='http://www.w3.org/2000/svg'/>")
    tab.value('1')  # lets what was told meanwhile be read
    assert address in tab.requests, (address, tab.requests)


def test_tower(tab, folder):
    page, report = built(folder, "tower", "examples/tower.sgm")
    opened(tab, page)
    model = "sgmPage.model."
    assert tab.value(model + "triangles") == report["mesh"]["triangles"]
    (lo, hi), step = report["mesh"]["bounds"], tab.value(model + "step")
    for axis in range(3):
        found = tab.value(f"(() => {{ let lo = 1e9, hi = -1e9; for (let i = {axis}; i < {model}positions.length; i += 3) {{ lo = Math.min(lo, {model}positions[i]); hi = Math.max(hi, {model}positions[i]); }} return [lo, hi]; }})()")
        assert abs(found[0] - lo[axis]) <= step and abs(found[1] - hi[axis]) <= step, (axis, found)
    volume = tab.value("""(() => { const { positions: p, indices: t } = sgmPage.model; let v = 0;
        for (let i = 0; i < t.length; i += 3) { const q = [0, 1, 2].map((c) => [0, 1, 2].map((a) => p[3 * t[i + c] + a])); for (const [a, b, c] of [[0, 1, 2], [1, 2, 0], [2, 0, 1]]) v += q[0][a] * (q[1][b] * q[2][c] - q[1][c] * q[2][b]); }
        return v / 6; })()""")
    assert abs(volume / report["mesh"]["volume_m3"] - 1) < 1e-3, volume
    assert colours(tab) > 2000, "shaded"
    assert tab.value("document.querySelector('h1').textContent") == "tower"
    facts = tab.value("document.getElementById('facts').textContent")
    assert "tower.sgm" in facts and "floors" in tab.value("document.getElementById('parameters').textContent"), facts
    test_panel(tab)
    test_pointer(tab)


def test_panel(tab):
    names = tab.value("[...document.querySelectorAll('#parts .name')].map((e) => e.textContent)")
    assert {"stone", "plaster"} <= set(names), names
    assert drawn_after(tab, lambda: tab.value("[...document.querySelectorAll('#parts li')].find((e) => e.textContent.startsWith('plaster')).querySelector('input').click()"))
    assert drawn_after(tab, lambda: tab.value("document.getElementById('all').click()"))
    for axis in range(3):
        assert drawn_after(tab, lambda: tab.value(f"document.querySelector('[name=axis][value=\"{axis}\"]').click()")), axis
    assert drawn_after(tab, lambda: tab.value("document.getElementById('turn').click()"))
    assert tab.value("document.getElementById('cutAt').value.endsWith(' m')")
    tab.value("document.querySelector('[name=axis][value=\"-1\"]').click()")
    assert tab.value("document.querySelectorAll('#materials li').length") >= 4


def test_pointer(tab):
    """Where a ray meets the model is where it is drawn: the place is projected back onto the pixel."""
    width, height = tab.value("[innerWidth, innerHeight]")
    x, y = width // 2, int(height * .55)
    tab.click(x, y)
    tab.wait("document.getElementById('picked').textContent.includes('tower.sgm') || document.getElementById('picked').textContent.includes('walls.sgm')")
    back = tab.value(f"(() => {{ const hit = sgmPage.hitAt({{ offsetX: {x}, offsetY: {y} }}), at = sgmPage.camera.project(hit.place); return [(at[0] + 1) / 2 * innerWidth, (1 - at[1]) / 2 * innerHeight]; }})()")
    assert abs(back[0] - x) < .5 and abs(back[1] - y) < .5, back
    assert drawn_after(tab, lambda: tab.drag(x, y, 120, 40)), "orbit"
    tab.value("sgmPage.measure(true)")
    tab.click(x, y)
    tab.click(x, y - 60)
    measured = tab.wait("document.getElementById('measured').value.includes('(') && document.getElementById('measured').value")
    length = float(measured.split(" m")[0])
    points = tab.value("sgmPage.points")
    assert abs(sum((a - b) ** 2 for a, b in zip(*points)) ** .5 - length) < 1e-2, (measured, points)
    tab.value("sgmPage.measure(false)")


def test_palace(tab, folder):
    page, _ = built(folder, "palace", "examples/buildings/palace.sgm", "--resolution", "256")
    size = os.path.getsize(page)
    print(f"palace: {size} bytes")
    assert size <= PALACE_BYTES
    opened(tab, page)
    assert colours(tab) > 2000
    picture = os.path.join(PICTURES or folder, tab.name + ".png")
    tab.screenshot(picture)
    assert os.path.getsize(picture) > 20_000, "a picture of one colour is small"


def test_textures(tab, folder):
    """The bricks are there, and they run on from the front to the side: the page has the coordinates of `lay`."""
    page, _ = built(folder, "warehouse", "examples/buildings/warehouse.sgm", "--resolution", "96")
    opened(tab, page)
    assert tab.value("sgmPage.model.pictures.map((p) => p.width > 64 && p.height > 64)") == [True] * 4
    assert tab.value("sgmPage.renderer.gl.getError()") == 0
    textured = colours(tab)
    assert drawn_after(tab, lambda: tab.value("(sgmPage.model.materials.forEach((m) => { m.texture = null; }), sgmPage.refresh())"))
    assert textured > 2 * colours(tab), "bricks have more colours than plain walls"
    assert tab.value("""(() => {
        const { positions: p, uvs, vertices } = sgmPage.model, places = new Map();
        for (let v = 0; v < vertices; ++v) {
            const key = [0, 1, 2].map((a) => p[3 * v + a].toFixed(2)).join();
            if (!places.has(key)) places.set(key, []);
            if (uvs[2 * v] !== 0) places.get(key).push(uvs[2 * v]);
        }
        const isCorner = (key) => { const [x, y, z] = key.split(",").map(Number); return Math.abs(x - 10.2) < .05 && Math.abs(z - 6.5) < .05; };
        const runsOn = (us) => us.filter((u) => Math.abs(u - 33.4) < .02).length > 1;  // side and front are 13 and 20.4 m wide
        return [...places].some(([key, us]) => isCorner(key) && runsOn(us));
    })()"""), "u at the front's right corner"


def test_objects(tab, folder):
    page, _ = built(folder, "objects", "examples/tower.sgm", "--resolution", "64", "--objects", "Storey,Roof")
    opened(tab, page)
    names = tab.value("[...document.querySelectorAll('#parts .name')].map((e) => e.textContent)")
    assert "Storey_9" in names and "Roof" in names, names


def test_hostile_names(tab, folder):
    grammar = os.path.join(folder, "<b onmouseover=alert(1)>@DATA@ &amp;.sgm")
    with open(grammar, "w", encoding="utf-8") as file:
        file.write("grammar 1\nstart A -> cube\n")
    page, _ = built(folder, "hostile", grammar)
    opened(tab, page)
    assert tab.value("document.title") == os.path.basename(grammar)[:-4]
    assert tab.value("document.querySelectorAll('b[onmouseover]').length") == 0


engines = [engine for engine in (browser, firefox) if engine.installed()]
if not engines:
    print("neither chromium nor firefox-esr with xvfb is installed")
    sys.exit(77)
for engine in (browser, firefox):
    if engine not in engines:
        print(f"{engine.Browser.name} isn't installed: nothing is opened in it")
        continue
    with tempfile.TemporaryDirectory() as folder, engine.Browser() as tab:
        for test in (test_requests_are_seen, test_tower, test_palace, test_textures, test_objects, test_hostile_names):
            test(tab, folder)
            print(f"{tab.name}: {test.__name__}")
