# SPDX-License-Identifier: Apache-2.0
"""A large mesh in Chromium without a graphics processor: it is drawn coarsely while the view moves, and whole at rest, at a price
that leaves 30 frames a second on two processors."""
import time
import unittest

from browser import BrowserCase
from measure import Measure
from pages import sphere

# Processor time of a frame, which a busy machine changes little: 33 to 38 ms were measured, 82 before there was a coarse version.
# Two processors have 66 ms for a 30th of a second.
MOST_FRAME_MS = 60


class Large(BrowserCase):
    def test_it_is_coarse_in_motion_and_whole_at_rest(self):
        self.open(self.view(self.write("ball.off", sphere(210)), "--no-touch"))
        state = self.wait_for(lambda s: s["drawn"] == s["triangles"])
        self.assertTrue(state["slow"])  # these tests draw by the processor
        self.assertGreater(state["triangles"], 150_000)
        self.browser.execute_script("""window.least = Infinity;
            const canvas = document.querySelector('.stage canvas'), end = performance.now() + 1500;
            const step = () => {
              window.least = Math.min(window.least, fdcgView.state().drawn);
              if (performance.now() > end) return;
              canvas.dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowRight', bubbles: true}));
              requestAnimationFrame(step);
            };
            step();""")
        self.wait_for(lambda s: s["drawn"] < s["triangles"])
        self.wait_for(lambda s: s["drawn"] == s["triangles"])
        least = self.browser.execute_script("return window.least")
        self.assertTrue(15_000 < least < 0.3 * state["triangles"], least)
        self.assert_quiet()


class Frames(Measure):
    def setUp(self):
        super().setUp()
        self.open(self.view(self.write("ball.off", sphere(158)), "--units", "cm"))  # 99,224 faces

    def test_of_a_view_that_moves(self):
        figures = self.turning(3)
        print({name: round(value, 1) for name, value in figures.items()})
        self.assertLess(figures["frame_cpu_ms"], MOST_FRAME_MS)
        self.assertEqual(1, self.wait_for(lambda s: s["drawn"] == s["triangles"])["pixelRatio"])

    def test_while_a_hand_moves_the_model_is_drawn_once(self):
        self.find("tab-touch").click()
        self.wait_for(lambda s: s["ready"])
        self.press(" ")
        self.wait_for(lambda s: s["contact"] == "face" and s["pixelRatio"] == 1)
        time.sleep(0.5)
        before = self.state()
        after = self.wait_for(lambda s: s["frames"] > before["frames"] + 20)
        self.assertLessEqual(after["wholeFrames"], before["wholeFrames"] + 1)
        self.assertLess((after["frames"] - before["frames"]) / (after["ticks"] - before["ticks"]), 0.045)  # 30 of 1000, and what polling adds
        self.canvas().send_keys("+")
        self.wait_for(lambda s: s["wholeFrames"] > after["wholeFrames"])
        self.assert_quiet()


if __name__ == "__main__":
    unittest.main()
