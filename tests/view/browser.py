# SPDX-License-Identifier: Apache-2.0
"""Chromium without a screen, driven from here; pages are opened from files."""
import json
import os
import shutil
import time

from pages import PageCase

try:
    from selenium import webdriver
    from selenium.webdriver.chrome.options import Options
    from selenium.webdriver.chrome.service import Service
    from selenium.webdriver.common.by import By
except ImportError:
    webdriver = None

ARGUMENTS = ("--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--use-gl=angle", "--use-angle=swiftshader",
             "--enable-unsafe-swiftshader", "--hide-scrollbars", "--force-device-scale-factor=1", "--no-first-run")
PATIENCE_S = 60


class BrowserCase(PageCase):
    width, height = 1280, 860

    def setUp(self):
        super().setUp()
        chromium, driver = shutil.which("chromium"), shutil.which("chromedriver")
        if webdriver is None or chromium is None or driver is None:
            self.skipTest("chromium, chromium-driver or python3-selenium is missing; tools/check installs them (group viewer of tools/packages)")
        options = Options()
        options.binary_location = chromium
        for argument in (*ARGUMENTS, f"--window-size={self.width},{self.height}", f"--user-data-dir={self.path('profile')}"):
            options.add_argument(argument)
        options.add_experimental_option("prefs", {"download.default_directory": self.path("saved"), "download.prompt_for_download": False})
        options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
        os.mkdir(self.path("saved"))
        self.browser = webdriver.Chrome(service=Service(driver), options=options)
        self.addCleanup(self.browser.quit)

    def open(self, path):
        """Opens a page and waits until it is at rest."""
        self.browser.get("file://" + path)
        self.wait_for(lambda state: state.get("tab") is not None and not state["flying"])

    def state(self):
        return self.browser.execute_script("return window.fdcgView ? fdcgView.state() : {}")

    def wait_for(self, holds, patience_s=PATIENCE_S):
        end = time.monotonic() + patience_s
        while time.monotonic() < end:
            state = self.state()
            if state and holds(state):
                return state
            time.sleep(0.05)
        shown = self.browser.find_element(By.TAG_NAME, "body").text[:500]
        self.fail(f"not within {patience_s} s: {json.dumps(self.state())[:1000]}\n{shown}\n{self.browser.get_log('browser')}")

    def find(self, identity):
        return self.browser.find_element(By.ID, identity)

    def canvas(self):
        return self.browser.find_element(By.CSS_SELECTOR, ".stage canvas")

    def press(self, key):
        self.browser.find_element(By.TAG_NAME, "body").send_keys(key)

    def saved(self, name):
        path = os.path.join(self.path("saved"), name)
        end = time.monotonic() + PATIENCE_S
        while time.monotonic() < end and not os.path.exists(path):
            time.sleep(0.05)
        self.assertTrue(os.path.exists(path), f"{name} was not saved")
        return path

    def picture(self):
        """Pixels of the stage as (red, green, blue) by place, coarse: every 8th in both directions."""
        return self.browser.execute_async_script("""
            const done = arguments[0], canvas = document.querySelector('.stage canvas');
            fdcgView.draw();
            const copy = document.createElement('canvas');
            copy.width = canvas.width / 8; copy.height = canvas.height / 8;
            const context = copy.getContext('2d');
            context.drawImage(canvas, 0, 0, copy.width, copy.height);
            done([...context.getImageData(0, 0, copy.width, copy.height).data]);""")

    def share_of(self, color, tolerance=60):
        """Of the stage's pixels those near a colour."""
        data = self.picture()
        near = sum(all(abs(data[i + k] - color[k]) <= tolerance for k in range(3)) for i in range(0, len(data), 4))
        return near / (len(data) / 4)

    def assert_quiet(self):
        """Nothing was asked of a network, and the page had no error."""
        asked = []
        for entry in self.browser.get_log("performance"):
            message = json.loads(entry["message"])["message"]
            if message["method"] == "Network.requestWillBeSent":
                address = message["params"]["request"]["url"]
                if not address.startswith(("file:", "blob:", "data:", "chrome")):
                    asked.append(address)
        self.assertEqual([], asked)
        wrong = [entry["message"] for entry in self.browser.get_log("browser") if entry["level"] in ("SEVERE", "ERROR") or "GL_INVALID" in entry["message"]]
        self.assertEqual([], wrong)
