#!/usr/bin/python3
"""A baked city in readers of others: three.js with 3d-tiles-renderer on the page that `sgm serve` shows, Cesium, and Khronos'
glTF validator.  city_test.py SGM"""
import http.client
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile

import browser
from small_town import TOWN

SGM = sys.argv[1]


def skip(why):
    print(why)
    sys.exit(77)


class Served:
    """A folder that `sgm serve` shows."""

    def __init__(self, folder):
        self.process = subprocess.Popen([SGM, "serve", folder, "--port", "0"], stdout=subprocess.PIPE, text=True)
        self.url = self.process.stdout.readline().split()[0]
        self.port = int(self.url.rstrip("/").rsplit(":", 1)[1])

    def get(self, path):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=10)
        connection.putrequest("GET", path, skip_accept_encoding=True)
        connection.endheaders()
        answer = connection.getresponse()
        return answer.status, answer.read()

    def stop(self):
        self.process.send_signal(signal.SIGINT)
        assert self.process.wait(10) == 0, "Ctrl-C ends it"


def run(*words):
    done = subprocess.run([SGM, *words], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_server(served, folder):
    assert served.get("/")[0] == 200 and served.get("/tileset.json")[0] == 200
    assert served.get("//cells/../tileset.json")[0] == 200
    os.symlink("/etc/hostname", os.path.join(folder, "outside"))
    for path in ("/../town.sgm", "/%2e%2e/town.sgm", "/cells/../../town.sgm", "//etc/hostname", "/outside", "/cells", "/no", "/%00"):
        status, body = served.get(path)
        assert status in (400, 404), (path, status)
        assert b"grammar" not in body, path
    second = subprocess.run([SGM, "serve", folder, "--port", str(served.port)], capture_output=True, text=True, timeout=20)
    assert second.returncode == 1 and f"port {served.port} is taken" in second.stderr, second
    third = subprocess.run([SGM, "serve", os.path.join(folder, "lib")], capture_output=True, text=True, timeout=20)
    assert third.returncode == 1 and "sgm merge" in third.stderr, third


def test_page(tab, served, manifest):
    tab.open(served.url)
    tab.wait("window.sgmCity && sgmCity.drawn > 2 || document.getElementById('told')?.textContent.includes('without npm')")
    if "without npm" in tab.value("document.getElementById('told').textContent"):
        print("the page has no viewer: sgm was built without npm")
        return
    tab.value("sgmCity.look([120, 900, 180], [0, 0, 0])")
    tab.value("sgmCity.error = 0")
    finest = f"sgmCity.count().instances == {manifest['instances']} && sgmCity.count().triangles == {manifest['triangles']}"
    tab.wait(f"sgmCity.complete && {finest}", 120)
    found = tab.value("""(() => { for (let y = 1; y < 40; ++y) for (let x = 1; x < 40; ++x) {
        const found = sgmCity.pick(x / 40, y / 40); if (found) return found; } })()""")
    assert found["object"] == "House" and found["rule"].startswith("Plot") and found["line"] == 6, found
    assert found["file"] == "town.sgm" and "place" in found["path"], found
    assert "line 6" in tab.value("document.getElementById('picked').textContent")
    names = tab.value("[...document.querySelectorAll('#kinds label, #materials label')].map((e) => e.dataset.name)")
    assert names == ["House", "lawn"], names
    tab.value("document.querySelector('#kinds input').click()")
    assert not tab.value("sgmCity.pick(.5, .5)"), "what is hidden isn't picked"
    assert not tab.errors, tab.errors
    outside = [url for url in tab.requests if not url.startswith((served.url, "data:", "blob:"))]
    assert not outside, outside


def test_cesium(tab, served, folder, manifest):
    cesium = next((p for p in ("build/node_modules/cesium", "node_modules/cesium") if os.path.isdir(p)), None)
    if not cesium:
        return print("cesium isn't installed (npm install --prefix build cesium)")
    shutil.copytree(os.path.abspath(cesium) + "/Build/Cesium", os.path.join(folder, "cesium"), symlinks=False)
    with open(os.path.join(folder, "cesium.html"), "w", encoding="utf-8") as page:
        page.write("""<!DOCTYPE html><meta charset="utf-8"><link rel="icon" href="data:,"><div id="c" style="width:900px;height:600px"></div>
<script>window.CESIUM_BASE_URL = 'cesium/';</script><script src="cesium/Cesium.js"></script><script>
const widget = new Cesium.CesiumWidget('c', { baseLayer: false, skyBox: false, contextOptions: { webgl: { preserveDrawingBuffer: true } } });
widget.scene.globe.show = false;
window.instances = 0; window.failed = [];
Cesium.Cesium3DTileset.fromUrl('tileset.json', { maximumScreenSpaceError: 0, skipLevelOfDetail: false }).then((tileset) => {
  window.tileset = tileset;
  tileset.tileFailed.addEventListener((e) => failed.push(e.message));
  widget.scene.primitives.add(tileset);
  widget.camera.viewBoundingSphere(tileset.boundingSphere, new Cesium.HeadingPitchRange(.4, -1.2, tileset.boundingSphere.radius * 3.4));
  tileset.allTilesLoaded.addEventListener(() => { window.loaded = true; });
}).catch((e) => failed.push(String(e)));
</script>""")
    tab.open(served.url + "cesium.html")
    tab.wait("window.loaded || window.failed?.length", 150)
    assert not tab.value("failed.length"), tab.value("failed")
    count = tab.value("""(() => { let sum = 0; const walk = (tile) => { for (const c of tile.children) walk(c);
        if (!tile.children.length && tile.content?.featuresLength) sum += tile.content.featuresLength; }; walk(tileset.root); return sum; })()""")
    assert count == manifest["instances"], (count, "features that Cesium knows")
    colours = tab.value("""(() => { const c = document.querySelector('canvas'), gl = c.getContext('webgl2') ?? c.getContext('webgl');
        const all = new Uint8Array(4 * c.width * c.height); gl.readPixels(0, 0, c.width, c.height, gl.RGBA, gl.UNSIGNED_BYTE, all);
        return new Set(new Uint32Array(all.buffer)).size; })()""")
    assert colours > 50, colours
    print(f"Cesium: {count} features, {colours} colours")


def test_validator(folder):
    cells = [os.path.join(at, name) for at, _, names in os.walk(os.path.join(folder, "cells")) for name in names if name.endswith(".glb")]
    library = [os.path.join(at, name) for at, _, names in os.walk(os.path.join(folder, "lib")) for name in names if name.endswith(".glb")]
    verdict = subprocess.run(["node", "tests/export/validate_gltf.js", *cells, *library], capture_output=True, text=True)
    if verdict.returncode in (3, 127):
        return print("gltf-validator isn't installed (npm install --prefix build gltf-validator)")
    assert verdict.returncode == 0, verdict.stderr
    verdicts = [json.loads(line) for line in verdict.stdout.splitlines()]
    assert len(verdicts) == len(cells) + len(library)
    bad = [v for v in verdicts if v["errors"] or v["warnings"]]
    assert not bad, bad[0]
    print(f"gltf-validator: {len(cells)} cells, {len(library)} objects")


def main():
    if not browser.installed():
        skip("Chromium isn't installed")
    with tempfile.TemporaryDirectory() as scratch:
        grammar, folder = os.path.join(scratch, "town.sgm"), os.path.join(scratch, "city")
        with open(grammar, "w", encoding="utf-8") as file:
            file.write(TOWN)
        run("bake", grammar, "-o", folder, "--side", "64", "--cell", "1", "--object-cell", ".5", "-q")
        run("merge", folder, "--at", "52.5,13.4", "-q")
        with open(os.path.join(folder, "manifest.json"), encoding="utf-8") as file:
            manifest = json.load(file)
        assert manifest["instances"] == manifest["places"] == 100
        test_validator(folder)
        served = Served(folder)
        try:
            test_server(served, folder)
            with browser.Browser() as tab:
                test_page(tab, served, manifest)
            with browser.Browser() as tab:
                test_cesium(tab, served, folder, manifest)
        finally:
            served.stop()


main()
