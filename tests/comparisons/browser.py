"""A headless Chromium behind the DevTools protocol over two pipes, without a driver or library between.

Messages are JSON and end with a zero byte; the browser reads messages from the file descriptor 3 and writes to 4.
"""

import base64
import json
import os
import shutil
import subprocess
import sys
from contextlib import contextmanager
from dataclasses import dataclass, field
from itertools import count
from select import select
from tempfile import TemporaryDirectory

NAMES = ("chromium", "chromium-browser", "google-chrome", "chrome")
WANTED = "no Chromium on this machine; on Debian or Ubuntu: apt-get install chromium"
PATIENCE = 60.0
"""Seconds of silence before the test gives up."""

_FLAGS = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--hide-scrollbars",
    "--remote-debugging-pipe",
)
# in the child, the later browser: the two pipes go to the descriptors 3 and 4
_LAUNCH = """
import os, sys
its_in, its_out = (os.dup(int(each)) for each in sys.argv[1:3])
os.dup2(its_in, 3)
os.dup2(its_out, 4)
for each in (3, 4):  # descriptors 3 and 4 of the parent are closed otherwise
    os.set_inheritable(each, True)
os.execv(sys.argv[3], sys.argv[3:])
"""


def found():
    """The path of a Chromium, or None."""
    return next(filter(None, map(shutil.which, NAMES)), None)


@dataclass
class Browser:
    """A tab. ``said`` has all messages of the console, exceptions, and requests to a network."""

    to_it: int
    from_it: int
    session: str = ""
    said: list = field(default_factory=list)
    numbers: count = field(default_factory=lambda: count(1))
    rest: bytes = b""

    def call(self, method, **parameters):
        """The answer of a method of the protocol; earlier events are read first."""
        number = next(self.numbers)
        message = {"id": number, "method": method, "params": parameters}
        if self.session:
            message["sessionId"] = self.session
        os.write(self.to_it, json.dumps(message).encode() + b"\0")
        while True:
            heard = self._next()
            if heard.get("id") == number:
                assert "error" not in heard, heard
                return heard["result"]

    def wait(self, event):
        """Wait for an event."""
        while self._next().get("method") != event:
            pass

    def open(self, path):
        """Load a file."""
        self.call("Page.navigate", url=path.as_uri())
        self.wait("Page.loadEventFired")

    def run(self, script):
        """The value of an expression in the page."""
        answer = self.call("Runtime.evaluate", expression=script, returnByValue=True, awaitPromise=True)
        assert "exceptionDetails" not in answer, answer
        return answer["result"].get("value")

    def seen(self, width, height=900, *, dark=False, phone=False):
        """Show the page in a window of a size, in dark or light."""
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=phone)
        scheme = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
        self.call("Emulation.setEmulatedMedia", features=[scheme])

    def press(self, key):
        """A key, down and up again."""
        codes = {"Enter": (13, "\r"), "ArrowLeft": (37, ""), "ArrowRight": (39, ""), "Tab": (9, "")}
        code, text = codes[key]
        for kind in ("keyDown", "keyUp"):
            self.call("Input.dispatchKeyEvent", type=kind, key=key, code=key, windowsVirtualKeyCode=code,
                      **({"text": text} if text and kind == "keyDown" else {}))  # fmt: skip

    def picture(self, *, whole=False):
        """A picture of the window, as PNG."""
        return base64.b64decode(self.call("Page.captureScreenshot", captureBeyondViewport=whole)["data"])

    def pdf(self):
        """The page as printed on the paper of the style."""
        return base64.b64decode(self.call("Page.printToPDF", preferCSSPageSize=True, printBackground=False)["data"])

    def _next(self):
        while b"\0" not in self.rest:
            assert select([self.from_it], [], [], PATIENCE)[0], "the browser says nothing"
            more = os.read(self.from_it, 1 << 20)
            assert more, "the browser has ended"
            self.rest += more
        one, self.rest = self.rest.split(b"\0", 1)
        heard = json.loads(one)
        method, told = heard.get("method"), heard.get("params", {})
        if method == "Runtime.exceptionThrown":
            self.said.append(told["exceptionDetails"].get("exception", told["exceptionDetails"]))
        elif method == "Runtime.consoleAPICalled":
            self.said.append(told["args"])
        elif method == "Log.entryAdded":
            self.said.append(told["entry"])
        elif method == "Network.requestWillBeSent" and not told["request"]["url"].startswith(("file:", "data:")):
            self.said.append(told["request"]["url"])
        return heard


@contextmanager
def browser(program):
    """A tab of a browser that ends with the context."""
    its_in, to_it = os.pipe()
    from_it, its_out = os.pipe()
    with TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        child = subprocess.Popen(
            [sys.executable, "-c", _LAUNCH, str(its_in), str(its_out), program, *_FLAGS, f"--user-data-dir={profile}"],
            pass_fds=(its_in, its_out),
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        os.close(its_in)
        os.close(its_out)
        try:
            tab = Browser(to_it, from_it)
            page = tab.call("Target.createTarget", url="about:blank")["targetId"]
            tab.session = tab.call("Target.attachToTarget", targetId=page, flatten=True)["sessionId"]
            for domain in ("Page", "Runtime", "Log", "Network"):
                tab.call(f"{domain}.enable")
            yield tab
        finally:
            child.kill()
            child.wait()
            os.close(to_it)
            os.close(from_it)
