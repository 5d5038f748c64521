#!/usr/bin/python3
"""Makes the site and looks at it in a browser: every link leads somewhere, the search finds, nothing is fetched elsewhere."""
import functools
import http.server
import importlib.util
import os
import re
import subprocess
import sys
import tempfile
import threading

import browser

if importlib.util.find_spec("mkdocs") is None:
    print("mkdocs isn't installed")
    sys.exit(77)


class Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *arguments):
        pass


def look(folder):
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=folder))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    address = f"http://127.0.0.1:{server.server_port}/"
    with browser.Browser() as page:
        page.open(address + "search.html?q=mansard")
        page.wait("document.querySelectorAll('#mkdocs-search-results article').length > 3")
        assert "footprints.html" in page.value("document.querySelector('#mkdocs-search-results').innerHTML")
        page.open(address + "language.html")
        page.wait("document.readyState == 'complete'")
        assert page.value("document.querySelectorAll('.codehilite .kt').length") > 5, "grammars are coloured"
        assert all(url.startswith(address) for url in page.requests), page.requests
        assert not page.errors, page.errors
    server.shutdown()


with tempfile.TemporaryDirectory() as folder:
    run = subprocess.run(["integrations/site/build.py", folder], capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
    pages = sum(name.endswith(".html") for _, _, names in os.walk(folder) for name in names)
    assert pages > 80, pages
    with open(os.path.join(folder, "index.html"), encoding="utf-8") as file:
        assert not re.search(r'<(script|link)[^>]*(src|href)="https?:', file.read()), "asks for nothing elsewhere"
    if browser.installed():
        look(folder)
    else:
        print("chromium isn't installed: the pages weren't looked at")
    print(f"{pages} pages")
