"""Drives Firefox in a virtual display, by Marionette: what a page shows, asks for and prints. The same calls as browser.Browser has.
Its own headless mode has no WebGL."""
import base64
import json
import os
import shutil
import socket
import subprocess
import tempfile
import time

PREFERENCES = """user_pref("marionette.port", 0);
user_pref("webgl.force-enabled", true);
user_pref("browser.shell.checkDefaultBrowser", false);
user_pref("datareporting.policy.dataSubmissionEnabled", false);
user_pref("toolkit.telemetry.enabled", false);
user_pref("app.normandy.enabled", false);
user_pref("network.captive-portal-service.enabled", false);
user_pref("network.connectivity-service.enabled", false);
user_pref("extensions.update.enabled", false);
user_pref("browser.safebrowsing.update.enabled", false);
user_pref("services.settings.server", "http://127.0.0.1:9/");
"""
# In the browser's own process: every address that a page asks for, and what scripts of pages complain of.
WATCH = """
const seen = (globalThis.sgmSeen = { requests: [], errors: [] });
Services.obs.addObserver((subject) => {
  const channel = subject.QueryInterface(Ci.nsIHttpChannel);
  if (!channel.loadInfo.triggeringPrincipal.isSystemPrincipal) seen.requests.push(channel.URI.spec);
}, "http-on-opening-request");
Services.console.registerListener((message) => {
  if (message instanceof Ci.nsIScriptError && !(message.flags & 1) && /^(file|data|http):/.test(message.sourceName)) seen.errors.push(message.errorMessage);
});
"""


def installed():
    return (shutil.which("firefox-esr") or shutil.which("firefox")) if shutil.which("Xvfb") else None


class Browser:
    """A browser with one page. `requests` are the addresses that were asked for over a network, `errors` what pages complained of."""

    name = "Firefox"

    def __init__(self, width=1000, height=700):
        self.profile = tempfile.mkdtemp()
        with open(os.path.join(self.profile, "user.js"), "w", encoding="utf-8") as file:
            file.write(PREFERENCES)
        self.display = subprocess.Popen(["Xvfb", "-displayfd", "1", "-screen", "0", f"{width + 200}x{height + 300}x24", "-nolisten", "tcp"],
                                        stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        screen = ":" + self.display.stdout.readline().decode().strip()
        command = [installed(), "--marionette", "--remote-allow-system-access", "--no-remote", "--profile", self.profile,
                   "--width", str(width), "--height", str(height)]
        self.process = subprocess.Popen(command, env={**os.environ, "HOME": self.profile, "DISPLAY": screen}, stdin=subprocess.DEVNULL,
                                        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.number, self.pending = 0, b""
        self.socket = self._connect()
        self._message()  # its greeting
        self.call("WebDriver:NewSession", pageLoadStrategy="eager")
        self.call("WebDriver:SetTimeouts", script=120000, pageLoad=120000)
        self.chrome(WATCH)
        grow = "return [window.outerWidth - innerWidth, window.outerHeight - innerHeight]"
        wide, high = self.call("WebDriver:ExecuteScript", script=grow, args=[])["value"]
        self.call("WebDriver:SetWindowRect", width=width + wide, height=height + high)

    def _connect(self):
        until = time.monotonic() + 120
        port = os.path.join(self.profile, "MarionetteActivePort")
        while time.monotonic() < until:
            try:
                with open(port, encoding="utf-8") as file:
                    return socket.create_connection(("127.0.0.1", int(file.read())), timeout=120)
            except (OSError, ValueError):
                time.sleep(.1)
        raise RuntimeError("Firefox doesn't start")

    def _message(self):
        while b":" not in self.pending:
            self._more()
        length, self.pending = self.pending.split(b":", 1)
        while len(self.pending) < int(length):
            self._more()
        text, self.pending = self.pending[: int(length)], self.pending[int(length) :]
        return json.loads(text)

    def _more(self):
        chunk = self.socket.recv(1 << 16)
        if not chunk:
            raise RuntimeError("Firefox has gone")
        self.pending += chunk

    def call(self, command, **parameters):
        self.number += 1
        data = json.dumps([0, self.number, command, parameters]).encode()
        self.socket.sendall(b"%d:" % len(data) + data)
        while True:
            kind, number, error, result = self._message()
            if kind == 1 and number == self.number:
                if error:
                    raise RuntimeError(f"{command}: {error}")
                return result

    def chrome(self, script):
        self.call("Marionette:SetContext", value="chrome")
        try:
            return self.call("WebDriver:ExecuteScript", script=script, args=[], sandbox="system")["value"]
        finally:
            self.call("Marionette:SetContext", value="content")

    @property
    def requests(self):
        return self.chrome("return globalThis.sgmSeen.requests")

    @property
    def errors(self):
        return self.chrome("return globalThis.sgmSeen.errors")

    def open(self, url):
        self.chrome("globalThis.sgmSeen.requests.length = globalThis.sgmSeen.errors.length = 0")
        self.call("WebDriver:Navigate", url=url)

    def value(self, expression):
        """What a script's expression is, as JSON has it; a promise's is what it comes to. It runs in the page, whose names it sees."""
        script = "const done = arguments[0]; (async () => (" + expression + "))().then((v) => done({ v: JSON.stringify(v) }), (e) => done({ e: String(e) }));"
        answer = self.call("WebDriver:ExecuteAsyncScript", script=script, args=[])["value"]
        if "e" in answer:
            raise RuntimeError(answer["e"])
        return json.loads(answer["v"]) if answer.get("v") is not None else None

    def wait(self, expression, seconds=30):
        until = time.monotonic() + seconds
        while time.monotonic() < until:
            value = self.value(expression)
            if value:
                return value
            time.sleep(.05)
        raise RuntimeError(f"{expression} didn't come true in {seconds} s")

    def _pointer(self, *steps):
        self.call("WebDriver:PerformActions", actions=[{"type": "pointer", "id": "mouse", "parameters": {"pointerType": "mouse"}, "actions": list(steps)}])

    def click(self, x, y):
        self._pointer({"type": "pointerMove", "x": x, "y": y}, {"type": "pointerDown", "button": 0}, {"type": "pointerUp", "button": 0})

    def drag(self, x, y, dx, dy):
        self._pointer({"type": "pointerMove", "x": x, "y": y}, {"type": "pointerDown", "button": 0},
                      {"type": "pointerMove", "x": x + dx, "y": y + dy, "duration": 50}, {"type": "pointerUp", "button": 0})

    def screenshot(self, path):
        picture = self.call("WebDriver:TakeScreenshot", full=False)["value"]
        with open(path, "wb") as file:
            file.write(base64.b64decode(picture))

    def close(self):
        try:
            self.call("Marionette:Quit", flags=["eForceQuit"])
        except (OSError, RuntimeError):
            pass
        try:
            self.process.wait(20)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        self.display.terminate()
        self.display.wait()
        shutil.rmtree(self.profile, ignore_errors=True)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()
