# SPDX-License-Identifier: Apache-2.0
"""Firefox without a screen, driven by its own protocol (Marionette), since Debian 12 has no geckodriver."""
import json
import os
import shutil
import socket
import subprocess
import time

from pages import PageCase

PATIENCE_S = 120
SETTINGS = {
    "browser.download.folderList": 2,
    "browser.download.useDownloadDir": True,
    "browser.shell.checkDefaultBrowser": False,
    "browser.startup.homepage_override.mstone": "ignore",
    "datareporting.policy.dataSubmissionEnabled": False,
    "toolkit.telemetry.enabled": False,
    "app.update.disabledForTesting": True,
    "network.captive-portal-service.enabled": False,
    "network.connectivity-service.enabled": False,
    "webgl.force-enabled": True,
}


class Marionette:
    """One message after another: its length in digits, a colon, JSON."""

    def __init__(self, port):
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=PATIENCE_S)
        self.number = 0
        self.hello = self.read()

    def read(self):
        digits = b""
        while not digits.endswith(b":"):
            got = self.socket.recv(1)
            if not got:
                raise ConnectionError("Firefox has closed the connection")
            digits += got
        left, parts = int(digits[:-1]), []
        while left > 0:
            parts.append(self.socket.recv(left))
            left -= len(parts[-1])
        return json.loads(b"".join(parts))

    def ask(self, command, **parameters):
        self.number += 1
        message = json.dumps([0, self.number, command, parameters]).encode()
        self.socket.sendall(b"%d:%s" % (len(message), message))
        _, number, error, result = self.read()
        assert number == self.number
        if error is not None:
            raise RuntimeError(f"{command}: {error['error']}: {error['message']}")
        return result


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class FirefoxCase(PageCase):
    def setUp(self):
        super().setUp()
        firefox = shutil.which("firefox-esr") or shutil.which("firefox")
        if firefox is None:
            self.skipTest("firefox-esr is missing; tools/check installs it (group viewer of tools/packages)")
        port = free_port()
        profile, saved = self.folder / "firefox", self.folder / "saved"
        profile.mkdir()
        saved.mkdir()
        settings = SETTINGS | {"marionette.port": port, "browser.download.dir": str(saved)}
        (profile / "user.js").write_text("".join(f"user_pref({json.dumps(name)}, {json.dumps(value)});\n" for name, value in settings.items()))
        environment = os.environ | {"HOME": str(self.folder), "MOZ_HEADLESS": "1", "LIBGL_ALWAYS_SOFTWARE": "1", "MOZ_CRASHREPORTER_DISABLE": "1"}
        self.process = subprocess.Popen((firefox, "--headless", "--marionette", "--no-remote", "--profile", str(profile), "--width", "1280", "--height", "860"),
                                        env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(self.end)
        self.marionette = self.connected(port)
        self.addCleanup(self.marionette.socket.close)
        self.marionette.ask("WebDriver:NewSession", capabilities={"alwaysMatch": {"acceptInsecureCerts": False}})

    def connected(self, port):
        end = time.monotonic() + PATIENCE_S
        while True:
            try:
                return Marionette(port)
            except OSError:
                if time.monotonic() > end or self.process.poll() is not None:
                    raise
                time.sleep(0.2)

    def end(self):
        self.process.terminate()
        try:
            self.process.wait(20)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()

    def open(self, path):
        self.marionette.ask("WebDriver:Navigate", url="file://" + path)
        return self.wait_for(lambda state: state.get("tab") is not None and not state["flying"])

    def script(self, text, *arguments):
        return self.marionette.ask("WebDriver:ExecuteScript", script=text, args=list(arguments), sandbox=None)["value"]

    def state(self):
        return self.script("return window.fdcgView ? JSON.parse(JSON.stringify(window.fdcgView.state())) : {};")

    def wait_for(self, holds):
        end = time.monotonic() + PATIENCE_S
        while time.monotonic() < end:
            state = self.state()
            if state and holds(state):
                return state
            time.sleep(0.1)
        return self.fail(f"not within {PATIENCE_S} s: {json.dumps(self.state())[:600]}\n{self.script('return document.body.innerText.slice(0, 500);')}")

    def element(self, selector):
        found = self.marionette.ask("WebDriver:FindElement", using="css selector", value=selector)["value"]
        return next(iter(found.values()))

    def click(self, selector):
        self.marionette.ask("WebDriver:ElementClick", id=self.element(selector))

    def press(self, key):
        actions = [{"type": kind, "value": key} for kind in ("keyDown", "keyUp")]
        self.marionette.ask("WebDriver:PerformActions", actions=[{"type": "key", "id": "keys", "actions": actions}])
