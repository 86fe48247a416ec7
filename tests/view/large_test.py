# SPDX-License-Identifier: Apache-2.0
"""A large mesh in Chromium without a graphics processor: it is drawn coarsely while the view moves, and whole at rest."""
import unittest

from browser import BrowserCase
from pages import sphere


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
        self.assertTrue(20_000 < least < 0.7 * state["triangles"], least)
        self.assert_quiet()


if __name__ == "__main__":
    unittest.main()
