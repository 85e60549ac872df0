"""A headless Chromium, driven over a pipe by its DevTools protocol; it needs nothing else."""

import json
import os
import shutil
import subprocess
import tempfile
import time

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
WEBGPU = ["--enable-unsafe-webgpu", "--use-webgpu-adapter=swiftshader"]
WEBGPU += ["--use-vulkan=swiftshader"]
PATIENCE = 60.0  # seconds for one answer: much longer than needed on a busy machine


class Browser:
    """One page of one browser, used as a context; `complaints` is the output of its console.

    With `webgpu`, the page can compute on a graphics card that this processor imitates.
    """

    def __init__(self, width=1280, height=900, dark=False, phone=False, script=True, webgpu=False):
        self.complaints, self.requests = [], []
        self._waiting, self._number = b"", 0
        self._folder = tempfile.mkdtemp(prefix="browser.")
        self._start(WEBGPU if webgpu else ["--disable-gpu"])
        target = self._call("Target.createTarget", url="about:blank")["targetId"]
        session = self._call("Target.attachToTarget", targetId=target, flatten=True)
        self._session = session["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self._call(f"{domain}.enable")
        scheme = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
        self._call("Emulation.setEmulatedMedia", features=[scheme])
        self.resize(width, height, phone)
        if not script:
            self._call("Emulation.setScriptExecutionDisabled", value=True)

    def resize(self, width, height, phone=False):
        """The size of the window in CSS pixels; a phone has a denser screen and fingers."""
        size = {"width": width, "height": height, "deviceScaleFactor": 2 if phone else 1}
        self._call("Emulation.setDeviceMetricsOverride", mobile=phone, **size)

    def open(self, path):
        """Opens a file and waits until it is loaded: before that the previous page answers."""
        loader = self._call("Page.navigate", url=f"file://{path}")["loaderId"]
        self._wait(lambda: self._loader() == loader, f"{path} never came")
        self.until("document.readyState === 'complete'")

    def run(self, expression):
        """The value of a JavaScript expression in the page; promises are awaited."""
        found = self._call(
            "Runtime.evaluate", expression=expression, awaitPromise=True, returnByValue=True
        )
        if "exceptionDetails" in found:
            raise AssertionError(f"{expression}: {found['exceptionDetails']}")
        return found["result"].get("value")

    def until(self, expression):
        """Waits until an expression is true; fails if it never is."""
        self._wait(lambda: self.run(expression), f"never true: {expression}")

    def _loader(self):
        """The identifier of the page load that the window shows."""
        return self._call("Page.getFrameTree")["frameTree"]["frame"]["loaderId"]

    def _wait(self, comes_true, message):
        end = time.monotonic() + PATIENCE
        while not comes_true():
            assert time.monotonic() < end, f"{message}; console: {self.complaints}"
            time.sleep(0.05)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._process.kill()
        self._process.wait()
        os.close(self._out)
        os.close(self._in)
        self._wait(self._forgotten, f"{self._folder} cannot be removed")

    def _forgotten(self):
        """Whether the profile is removed: helpers of a killed browser continue writing briefly."""
        shutil.rmtree(self._folder, ignore_errors=True)
        return not os.path.exists(self._folder)

    def _start(self, more):
        """The browser reads from descriptor 3 and writes to 4."""
        read_theirs, self._out = os.pipe()
        self._in, write_theirs = os.pipe()
        flags = ["--headless=new", "--no-sandbox", "--remote-debugging-pipe", *more]
        flags += ["--disable-dev-shm-usage", f"--user-data-dir={self._folder}"]
        words = " ".join(f"'{word}'" for word in (CHROMIUM, *flags, "about:blank"))
        self._process = subprocess.Popen(
            ["bash", "-c", f"exec {words} 3<&{read_theirs} 4>&{write_theirs}"],
            pass_fds=(read_theirs, write_theirs),
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        os.close(read_theirs)
        os.close(write_theirs)

    def _call(self, method, **parameters):
        """Sends one command; records the page's messages in the meantime."""
        self._number += 1
        message = {"id": self._number, "method": method, "params": parameters}
        if hasattr(self, "_session"):
            message["sessionId"] = self._session
        os.write(self._out, json.dumps(message).encode() + b"\0")
        while True:
            answer = self._next()
            if answer.get("id") == self._number:
                assert "error" not in answer, f"{method}: {answer['error']}"
                return answer["result"]
            self._note(answer)

    def _next(self):
        while b"\0" not in self._waiting:
            piece = os.read(self._in, 1 << 20)
            assert piece, "the browser ended"
            self._waiting += piece
        message, self._waiting = self._waiting.split(b"\0", 1)
        return json.loads(message)

    def _note(self, event):
        data = event.get("params", {})
        if event["method"] == "Runtime.exceptionThrown":
            self.complaints.append(data["exceptionDetails"])
        elif event["method"] == "Log.entryAdded" and data["entry"]["level"] in ("error", "warning"):
            self.complaints.append(data["entry"])
        elif event["method"] == "Runtime.consoleAPICalled" and data["type"] in ("error", "warning"):
            self.complaints.append(data["args"])
        elif event["method"] == "Network.requestWillBeSent":
            self.requests.append(data["request"]["url"])
