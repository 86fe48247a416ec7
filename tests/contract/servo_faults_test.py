# SPDX-License-Identifier: Apache-2.0
"""fdcg-servo run on a device that begins anew or loses reports, and on a computer that slept: strikes.py. FDCG_CLOCK_SHIM names
tests/device/vm/clock_shim.c, built."""
import json
import mmap
import os
import struct
import time
import unittest

from strikes import HANDED_OUT, LOSING, RESTARTED, ROOT, SILENCE_S, StrikeCase

MISSED_PERIODS = 3.5  # from the last good report until the third missing one is overdue by half a period
BEGUN_REPORTS = 20  # in a row with low numbers are a device that began anew: runtime/device/src/profile/report_codec.hpp
COUNTED_S = 0.1  # in which reports are counted
LEAST_SLEEP_S, MOST_SLEEP_S = 0.02, 3600


class Restarts(StrikeCase):
    def check_restarts(self, rate_hz):
        profile = json.loads((ROOT / "runtime" / "device" / "profiles" / "fdcg-reference.json").read_text())
        self.description["devices"][0]["profile"] = "profile.json"
        self.write("profile.json", json.dumps({**profile, "rate_hz": rate_hz}))
        self.device.set(rate_hz=rate_hz)
        program = self.started(self.write("scene.json", json.dumps(self.description)))

        def strike():
            self.device.set(restarts=1)

            def known(events):
                begun = next((event.at_s for event in events if event.kind == RESTARTED), None)
                return None if begun is None else begun + MISSED_PERIODS / rate_hz
            return known
        # where those take longer than a good report may be missing, that is told
        reasons = {"restarted"} if BEGUN_REPORTS / rate_hz < SILENCE_S else {"restarted", "silence"}
        self.often(lambda: self.strike(program, strike, reasons))

    def test_a_device_that_begins_anew_at_1_khz(self):
        self.check_restarts(1000)

    def test_a_device_that_begins_anew_at_2_khz(self):
        self.check_restarts(2000)

    def test_a_device_that_begins_anew_at_4_khz(self):
        self.check_restarts(4000)

    def test_a_device_that_begins_anew_at_8_khz(self):
        self.check_restarts(8000)


class Losses(StrikeCase):
    def test_half_of_the_reports_lost(self):
        program = self.started()

        def strike():
            self.device.set(loses_half=1)

            def known(events):
                begun = next((event.at_s for event in events if event.kind == LOSING), None)
                return None if begun is None else begun + COUNTED_S
            return known

        def once():
            try:
                self.strike(program, strike, {"reports-lost"})
            finally:
                self.device.set(loses_half=0)
                time.sleep(0.15)  # those that were lost are no longer counted
        self.often(once)


@unittest.skipUnless("FDCG_CLOCK_SHIM" in os.environ, "needs the clock shim")
class Sleeps(StrikeCase):
    def test_a_computer_that_slept(self):
        """Its clock of suspended time goes ahead, while reports and the other clock go on."""
        ahead_file = self.write("ahead", bytes(8))
        with open(ahead_file, "r+b") as file:
            ahead = mmap.mmap(file.fileno(), 0)
        self.addCleanup(ahead.close)
        program = self.started(LD_PRELOAD=os.environ["FDCG_CLOCK_SHIM"], FDCG_BOOT_CLOCK_AHEAD=ahead_file)
        slept_ns = 0

        def strike():
            nonlocal slept_ns
            slept_ns += round(1e9 * self.random.uniform(LEAST_SLEEP_S, MOST_SLEEP_S))
            struct.pack_into("<q", ahead, 0, slept_ns)
            at_s = time.monotonic()
            return lambda events: next((event.at_s for event in events if event.kind == HANDED_OUT and event.at_s > at_s), None)
        self.often(lambda: self.strike(program, strike, {"slept"}))


if __name__ == "__main__":
    unittest.main()
