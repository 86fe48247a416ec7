# SPDX-License-Identifier: Apache-2.0
"""Pages in Firefox, from a file: they open, findings are flown to, the loop runs, and what is felt replays natively to the same
bytes."""
import pathlib
import shlex
import time
import unittest

from firefox import FirefoxCase
from pages import NON_MANIFOLD, SERVO, sphere


class Firefox(FirefoxCase):
    def saved(self, name):
        path = self.folder / "saved" / name
        end = time.monotonic() + 60
        while time.monotonic() < end and not (path.exists() and path.stat().st_size > 0):
            time.sleep(0.1)
        self.assertTrue(path.exists(), f"{name} was not saved")
        return path

    def test_findings_by_keys(self):
        before = self.open(self.view(self.write("bad.off", NON_MANIFOLD)))
        self.press("n")
        state = self.wait_for(lambda s: s.get("rule") and not s["flying"])
        self.assertEqual("non-manifold-edge", state["rule"])
        self.assertNotEqual(before["camera"], state["camera"])

    def test_touch_replays_natively_to_the_same_bytes(self):
        self.open(self.view(self.write("ball.off", sphere()), "--units", "cm"))
        self.click("#tab-touch")
        self.wait_for(lambda s: s["ready"])
        self.press(" ")
        self.wait_for(lambda s: s.get("contact") == "face")
        self.press(" ")
        self.wait_for(lambda s: s.get("contact") == "free")
        self.click("#record")
        self.wait_for(lambda s: s["recording"] == "on")
        self.script("document.activeElement.blur();")
        self.press(" ")
        self.wait_for(lambda s: s.get("contact") == "face")
        for key in 8 * ["\ue014"] + 4 * ["\ue015"]:  # right, down
            self.press(key)
        time.sleep(1)
        self.click("#record")
        state = self.wait_for(lambda s: s["recorded"] > 0)
        for button in ("save-path", "save-log", "save-graph"):
            self.click(f"#{button}")
        for name in ("hip.csv", "page-log.csv", "ball.fdcg"):
            self.saved(name)
        command = shlex.split(self.script("return document.getElementById('replay-command').textContent;"))
        self.run_program(SERVO, *command[1:], cwd=self.folder / "saved")
        native, page = (pathlib.Path(self.saved(name)).read_text() for name in ("log.csv", "page-log.csv"))
        self.assertTrue(native == page)
        self.assertIn(",face,", native)
        print(f"Firefox: step {state['recordedStepNs']:.0f} ns, p99 of the period {state['timing']['periodP99Ms']:.2f} ms, {state['recorded']} ticks")


if __name__ == "__main__":
    unittest.main()
