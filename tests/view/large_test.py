# SPDX-License-Identifier: Apache-2.0
"""A large mesh in Chromium without a graphics processor: it is drawn coarsely while the view moves, and whole at rest, at the price
of a mesh as small as its coarse version."""
import time
import unittest

from browser import BrowserCase
from measure import Measure
from pages import sphere

# Processor time of a frame beside one of a mesh with as many triangles as the coarse version, since processors differ, and one
# that others use too is slower: measured 0.9 to 1.0; before there was a coarse version 2.3.
MOST_RATIO = 1.5


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
    def open_sphere(self, name, rings):
        self.open(self.view(self.write(name, sphere(rings)), "--units", "cm"))

    def test_of_a_view_that_moves(self):
        ratios = []
        for _ in range(3):
            self.open_sphere("small.off", 82)
            small = self.turning(3)
            self.open_sphere("ball.off", 158)  # 99,224 faces
            large = self.turning(3)
            self.assertLess(large["triangles_drawn"], 1.1 * small["triangles_drawn"])
            self.assertEqual(1, self.wait_for(lambda s: s["drawn"] == s["triangles"])["pixelRatio"])
            ratios.append(large["frame_cpu_ms"] / small["frame_cpu_ms"])
            print({name: round(value, 1) for name, value in large.items()}, ratios[-1])
            if ratios[-1] <= MOST_RATIO:
                break
        self.assertLessEqual(min(ratios), MOST_RATIO, ratios)

    def test_while_a_hand_moves_the_model_is_drawn_once(self):
        self.open_sphere("ball.off", 158)
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
