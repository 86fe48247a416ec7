# SPDX-License-Identifier: Apache-2.0
"""The loop in the page against its bars: a step takes at most 2.5 times a native one, and beside drawing the period of 99 % of the
ticks is under 2 ms. Other work on the machine only makes it worse, so the best of some attempts counts. A kernel that looks at its
threads 250 times a second may leave a woken one waiting for 4 ms while a page is drawn without a GPU: the worker gets real-time
priority here, so that it is the page which is judged, and not the kernel."""
import glob
import os
import time
import unittest

from measure import doubles_of, native_ns
from pages import sphere
from touch_test import TouchCase

MOST_RATIO = 2.5
MOST_PERIOD_MS = 2.0
ATTEMPTS = 4


def hurry_workers():
    """Real-time priority for the threads of the browsers' workers. False: this user may not give it."""
    for name in glob.glob("/proc/[0-9]*/task/*/comm"):
        try:
            with open(name) as comm:
                if comm.read().startswith("DedicatedWorker"):
                    os.sched_setscheduler(int(name.split("/")[4]), os.SCHED_FIFO, os.sched_param(1))
        except PermissionError:
            return False
        except OSError:
            continue  # it has just ended
    return True


class Speed(TouchCase):
    def stroke(self, seconds):
        end = time.monotonic() + seconds
        place = 0
        while time.monotonic() < end:
            place += 1
            self.at(-60 + 8 * (place % 15), 20 * (place % 3)).perform()

    def test_steps_and_periods(self):
        self.open_touch(self.write("ball.off", sphere(100)), "--units", "cm")
        ratios, periods = [], []
        for _ in range(ATTEMPTS):
            self.begin_recording()
            self.at(-60, 0).click_and_hold().perform()
            is_hurried = hurry_workers()
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
            if min(ratios) <= MOST_RATIO and (not is_hurried or min(periods) < MOST_PERIOD_MS):
                break
        self.assertLessEqual(min(ratios), MOST_RATIO, ratios)
        if not is_hurried:
            self.skipTest(f"threads may not be given real-time priority here; the period was {min(periods):.1f} ms")
        self.assertLess(min(periods), MOST_PERIOD_MS, periods)


if __name__ == "__main__":
    unittest.main()
