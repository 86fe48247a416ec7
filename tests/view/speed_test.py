# SPDX-License-Identifier: Apache-2.0
"""The loop in the page against its bars: a step takes at most 2.5 times a native one, and beside drawing the period of 99 % of the
ticks is under 2 ms. Other work on the machine only makes it worse, so the best of some attempts counts, and the period is not judged
where others keep the processors busy."""
import os
import time
import unittest

from measure import doubles_of, native_ns
from pages import sphere
from touch_test import TouchCase

MOST_RATIO = 2.5
MOST_PERIOD_MS = 2.0
ATTEMPTS = 4


class Speed(TouchCase):
    def stroke(self, seconds):
        end = time.monotonic() + seconds
        place = 0
        while time.monotonic() < end:
            place += 1
            self.at(-60 + 8 * (place % 15), 20 * (place % 3)).perform()

    def test_steps_and_periods(self):
        is_busy = os.getloadavg()[0] > 0.75 * (os.cpu_count() or 1)  # before this test adds its own
        self.open_touch(self.write("ball.off", sphere(100)), "--units", "cm")
        ratios, periods = [], []
        for _ in range(ATTEMPTS):
            self.begin_recording()
            self.at(-60, 0).click_and_hold().perform()
            self.stroke(5)
            periods.append(self.state()["timing"]["periodP99Ms"])
            self.hand().release().perform()
            self.find("record").click()
            state = self.wait_for(lambda s: s["recorded"] > 500 and s["recording"] == "no")
            for name in ("hip.csv", "ball.fdcg"):
                if os.path.exists(os.path.join(self.path("saved"), name)):
                    os.remove(os.path.join(self.path("saved"), name))
            self.find("save-path").click()
            self.find("save-graph").click()
            doubles_of(self.saved("hip.csv"), self.path("hips"))
            params = [state["params"][name] for name in ("muStatic", "muDynamic", "stiffness")]
            native = native_ns(os.environ["FDCG_STEPS"], self.saved("ball.fdcg"), self.path("hips"), params)
            ratios.append(state["recordedStepNs"] / native)
            print(f"step {state['recordedStepNs']:.0f} ns, native {native:.0f} ns, ratio {ratios[-1]:.2f}; p99 of the period {periods[-1]:.2f} ms, "
                  f"load {os.getloadavg()[0]:.1f}", flush=True)
            if min(ratios) <= MOST_RATIO and (is_busy or min(periods) < MOST_PERIOD_MS):
                break
        self.assertLessEqual(min(ratios), MOST_RATIO, ratios)
        if is_busy:
            self.skipTest(f"other work keeps the machine busy; the period was {min(periods):.1f} ms")
        self.assertLess(min(periods), MOST_PERIOD_MS, periods)


if __name__ == "__main__":
    unittest.main()
