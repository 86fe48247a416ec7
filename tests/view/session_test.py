# SPDX-License-Identifier: Apache-2.0
"""Logs of sessions in Chromium: they play, bodies, sheets and fingers move as the replay says, lanes show what was when."""
import math
import unittest

from browser import BrowserCase
from pages import SessionCase

try:
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
except ImportError:
    pass

# Of a canvas the share of columns that have a colour at a height.
COLUMNS = """const [lane, y, done] = arguments, canvas = document.querySelectorAll('canvas.lane')[lane];
const data = canvas.getContext('2d').getImageData(0, y, canvas.width, 1).data;
let filled = 0;
for (let x = 0; x < canvas.width; ++x) filled += data[4 * x + 3] > 0 ? 1 : 0;
done(filled / canvas.width);"""


class SessionBrowserCase(SessionCase, BrowserCase):
    def seek(self, t):
        """By the scrubber, as a hand moves it."""
        self.browser.execute_script("""const times = fdcgView.times(), scrubber = document.getElementById('scrub');
            scrubber.value = String(times.findIndex((time) => time >= arguments[0]));
            scrubber.dispatchEvent(new Event('input'));""", t)
        return self.wait_for(lambda s: abs(s["t"] - t) < 0.003)

    def columns(self, lane, y):
        return self.browser.execute_async_script(COLUMNS, lane, y)

    def open_log(self, scene, seconds):
        log = self.session(scene, seconds)
        self.open(self.view(log))
        self.assertEqual("log", self.state()["tab"])
        self.wait_for(lambda s: self.columns(0, 4) > 0)
        return self.replayed(log)


class Session(SessionBrowserCase):
    def test_a_body_is_where_the_replay_has_it(self):
        rows, touches = self.open_log("lift_cube", 8)
        self.assertEqual(len(self.browser.execute_script("return [...fdcgView.times()]")), self.state()["ticks"])
        for t in (1.0, 2.0, 3.0, 4.2, 5.5, 7.9):
            state = self.seek(t)
            row = min(rows, key=lambda r, at=state["t"]: abs(float(r["t"]) - at))
            self.assertLess(math.dist([float(row[f"cube_{axis}"]) for axis in "xyz"], state["objects"][0]["place"]), 1e-6)
            self.assertEqual((row["phase"], row["state"]), (state["devices"][0]["phase"], state["devices"][0]["state"]))
        held = self.seek(3.0)["devices"][0]["contacts"]
        self.assertEqual(["face", "face"], [("free", "face")[contact["state"]] for contact in held])
        self.assertLess(held[0]["force"][0] * held[1]["force"][0], 0)  # two fingers press against each other
        self.assert_quiet()

    def test_it_plays_fast_and_slow_and_over_again(self):
        self.open_log("lift_cube", 2)
        speed = self.find("speed")
        speed.send_keys("4 x")
        self.find("play").click()
        self.wait_for(lambda s: s["playing"] and s["t"] > 0.2)
        self.wait_for(lambda s: not s["playing"] and s["at"] == s["ticks"] - 1)
        self.find("loop").click()
        self.press(" ")
        self.wait_for(lambda s: s["playing"] and s["t"] > 1.5)
        self.wait_for(lambda s: s["playing"] and s["t"] < 1.0)  # begun again
        self.press(" ")
        self.assertFalse(self.state()["playing"])
        self.seek(1.0)
        at = self.state()["at"]
        self.press(".")
        self.assertEqual(at + 1, self.state()["at"])
        self.press(",")
        self.press(",")
        self.assertEqual(at - 1, self.state()["at"])
        self.find("scrub").send_keys(Keys.HOME)
        self.wait_for(lambda s: s["at"] == 0)
        self.assert_quiet()

    def test_lanes_and_events(self):
        rows, _ = self.open_log("press_sheet", 8)
        slipping = sum(row["slip"] == "1" for row in rows) / len(rows)
        self.assertGreater(slipping, 0.05)
        self.assertAlmostEqual(1, self.columns(0, 4), delta=0.02)  # the state is always one
        self.assertAlmostEqual(slipping, self.columns(0, 18), delta=0.05)
        self.assertAlmostEqual(1, self.columns(0, 27), delta=0.02)  # so is the gate
        self.assertEqual(0, self.columns(0, 38))  # no fault
        events = self.browser.find_elements(By.CSS_SELECTOR, "#events button")
        self.assertTrue(any("finger armed" in event.text for event in events), [event.text for event in events])
        armed = next(event for event in events if "armed" in event.text and "dis" not in event.text)
        armed.click()
        state = self.wait_for(lambda s: s["devices"][0]["phase"] == "armed")
        self.assertAlmostEqual(float(armed.text.split()[0]), state["t"], delta=0.0006)
        self.assertIn("armed", self.find("readout").text)

    def test_a_sheet_yields_and_comes_back(self):
        rows, _ = self.open_log("press_sheet", 8)
        flat, pressed, back = (self.seek(t)["objects"][0]["dent"] for t in (0.5, 3.0, 7.9))
        row = min(rows, key=lambda r: abs(float(r["t"]) - 3.0))
        self.assertEqual(0, flat)
        self.assertAlmostEqual(float(row["sheet_dent"]), pressed, delta=0.0005)
        self.assertLess(back, 0.2 * pressed)
        before = self.picture()
        self.seek(3.0)
        self.assertNotEqual(before, self.picture())
        self.assert_quiet()

    def test_two_devices_have_a_lane_and_a_row_each(self):
        self.open_log("two_devices", 4)
        self.assertEqual(2, len(self.browser.find_elements(By.CSS_SELECTOR, "canvas.lane")))
        self.assertEqual(["thumb", "finger"], [row.text.split()[0] for row in self.browser.find_elements(By.CSS_SELECTOR, "#readout tbody tr")])
        state = self.seek(2.8)
        self.assertEqual(["thumb", "finger"], [device["name"] for device in state["devices"]])
        self.assertGreater(state["objects"][0]["place"][2], 0.02)

    def test_surfaces_are_drawn_without_a_mesh(self):
        self.open_log("surfaces", 10)
        self.press("f")
        self.wait_for(lambda s: not s["flying"])
        self.press("t")
        self.press("t")
        faces = self.share_of((120, 135, 150), 70)
        self.assertGreater(faces, 0.01)
        states = {self.seek(t)["devices"][0]["state"] for t in (1.1, 2.3, 3.6, 4.8, 6.1, 7.3, 8.6)}
        self.assertIn("face", states)
        self.assert_quiet()


if __name__ == "__main__":
    unittest.main()
