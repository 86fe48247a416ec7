# SPDX-License-Identifier: Apache-2.0
"""Each test boots a virtual machine in which the virtual device (vm_rig) has `fdcg-servo run` as its host. What is judged is
judged in there, line by line; here the exit code and the number of PASS lines count."""
import contextlib
import fcntl
import os
import pathlib
import re
import sys
import tempfile
import unittest

import image
import machine
from monitor import Monitor

ROOT = pathlib.Path(os.environ["FDCG_ROOT"])
FOLDER = pathlib.Path(os.environ["FDCG_VM_FOLDER"])
INIT = ROOT / "tests" / "device" / "vm" / "guest_init.sh"
CUBE = ROOT / "testdata" / "meshes" / "good" / "cube_quads.off"
PROFILE = ROOT / "runtime" / "device" / "profiles" / "fdcg-reference.json"
LIMIT_S = 560  # a boot: a test counts as hung after ten minutes

REPORTS = "short long garbled repeated out-of-order stale nan stalled half-lost".split()
ENDS = "unplugged no-output restarted other-host asleep killed disk-full".split()
STRIKES = ",".join(REPORTS + ENDS)
SIGNALS = "segv abrt bus fpe ill quit xcpu usr1 usr2 term int hup tstp".split()
PROGRAM = "killed-unwatched servo-thread writer-thread second-program node-twice graph other-description".split()
LATE = "lag-5 lag-15 lag-30 clock-jump".split()


@contextlib.contextmanager
def locked(file):
    with open(file, "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield


class VmCase(unittest.TestCase):
    flavour = "amd64"
    mode = machine.TIMED

    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        folder = pathlib.Path(temporary.name)
        self.initramfs = folder / "initramfs"
        self.socket = folder / "monitor"
        FOLDER.mkdir(parents=True, exist_ok=True)
        try:
            with locked(FOLDER / "lock"):
                self.kernel = image.fetch_kernel(FOLDER / "kernels", self.flavour)
            image.need("qemu-system-x86_64")
            image.run(os.environ["FDCG"], "compile", CUBE, "-o", folder / "cube.fdcg")
            files = {"etc/cube.fdcg": folder / "cube.fdcg", "etc/fdcg-reference.json": PROFILE,
                     "lib/vm_clock_shim.so": os.environ["FDCG_VM_CLOCK_SHIM"]}
            programs = [os.environ["FDCG_VM_RIG"], os.environ["FDCG_SERVO"]]
            image.build_initramfs(self.kernel, programs, files, INIT, self.initramfs)
        except image.Missing as missing:
            if os.environ.get("FDCG_VM_REQUIRED"):
                self.fail(str(missing))
            self.skipTest(str(missing))

    def boot(self, *scenarios, monitor=None):
        """Returns the console of a guest in which every scenario passed."""
        outcome = machine.boot(self.kernel, self.initramfs, " then ".join(scenarios).split(), LIMIT_S, self.mode,
                               monitor.options() if monitor else ())
        print(f"{outcome.console}{outcome.wall_s:.0f} s of wall time, {outcome.cpu_s:.0f} s of processor time", file=sys.stderr)
        self.assertEqual(0, outcome.code, "see the FAIL lines above, or what the guest said last")
        self.assertNotIn("FAIL", outcome.console)
        return outcome.console

    def assert_passes(self, count, console):
        self.assertEqual(count, sum(line.startswith("PASS ") for line in console.splitlines()))


class TimingUhid(VmCase):
    def test_ten_seconds_at_1_and_8_khz(self):
        self.assert_passes(2 * 6, self.boot("timing rate=1000", "timing rate=8000"))


class TimingUsb(VmCase):
    mode = machine.TIMED_FASTER  # vhci_hcd's own threads take most of a period otherwise

    def test_ten_seconds_at_1_and_8_khz(self):
        self.assert_passes(2 * 6, self.boot("timing rate=1000 way=usb", "timing rate=8000 way=usb"))


class TimingLibusb(VmCase):
    mode = machine.TIMED_FASTER

    def test_ten_seconds_at_1_and_4_khz(self):  # 8 kHz by way of two more threads is beyond this processor
        way = "way=usb backend=libusb"
        self.assert_passes(2 * 6, self.boot(f"timing rate=1000 {way}", f"timing rate=4000 {way}"))


class FaultsUhid(VmCase):
    def test_each_fault_twenty_times(self):
        self.assert_passes(len(REPORTS + ENDS), self.boot(f"faults only={STRIKES}"))


class ReportsUsb(VmCase):
    def test_each_fault_of_a_report_twenty_times(self):
        self.assert_passes(len(REPORTS), self.boot(f"faults way=usb only={','.join(REPORTS)}"))


class EndsUsb(VmCase):
    def test_each_end_twenty_times(self):
        self.assert_passes(len(ENDS), self.boot(f"faults way=usb only={','.join(ENDS)}"))


class EndsLibusb(VmCase):
    def test_unplugged_and_no_output_twenty_times(self):
        self.assert_passes(2, self.boot("faults way=usb backend=libusb only=unplugged,no-output"))


class LateUhid(VmCase):
    def test_lag_and_a_clock_that_leaps_twenty_times(self):
        self.assert_passes(len(LATE), self.boot(f"faults only={','.join(LATE)}"))


class SignalsUhid(VmCase):
    def test_each_signal_twenty_times(self):
        self.assert_passes(len(SIGNALS), self.boot(f"faults only={','.join(SIGNALS)}"))


class ProgramUhid(VmCase):
    def test_harm_to_the_host_program_twenty_times(self):
        self.assert_passes(len(PROGRAM), self.boot(f"faults only={','.join(PROGRAM)}"))


class RestartedUhid(VmCase):
    def test_restarts_at_2_4_and_8_khz_twenty_times(self):
        self.assert_passes(3, self.boot(*(f"faults rate={rate} only=restarted" for rate in (2000, 4000, 8000))))


class SuspendedUhid(VmCase):
    mode = machine.SUSPENDING

    def test_suspend_to_memory_twenty_times(self):
        monitor = Monitor(self.socket, wakes_after_s=0.3)
        self.assert_passes(1, self.boot("faults only=suspended", monitor=monitor))
        self.assertEqual(20, monitor.woken)


def behaviour(console):
    """What happened, without the digits of times: a plug that is answered in 537.0 ms once may be in 537.1 the other time."""
    return re.sub(r"\d+\.\d+", "#", console)


class SameConsole(VmCase):
    def test_two_runs_do_the_same(self):
        scenarios = ["timing rate=1000 seconds=2", "faults way=usb times=2 only=garbled,stalled,unplugged,asleep,killed"]
        first = behaviour(self.boot(*scenarios))
        monitor = Monitor(self.socket, stops=20)
        self.assertEqual(first, behaviour(self.boot(*scenarios, monitor=monitor)))
        self.assertEqual(20, monitor.stopped)
        self.assert_passes(6 + 5, first)


class Races(VmCase):
    """Two processors at once, where nothing is the same twice: what counts is that no force is wrong and the host lives on. On a
    busy machine, over USB above all, it may find its device silent before it is felt: the lines say how often it was felt."""
    mode = machine.RACING

    def test_faults(self):
        over_usb = "short long garbled repeated out-of-order stale unplugged killed".split()
        console = self.boot(f"faults timed=0 times=2 only={STRIKES}", f"faults way=usb timed=0 times=2 only={','.join(over_usb)}")
        self.assert_passes(len(REPORTS + ENDS + over_usb), console)


class RealTimeKernel(VmCase):
    flavour = "rt-amd64"
    mode = machine.TIMED_FASTER  # its own work at 8 kHz nearly fills a period otherwise

    def test_ten_seconds_at_1_and_8_khz(self):
        self.assert_passes(2 * 6, self.boot("timing rate=1000", "timing rate=8000"))


if __name__ == "__main__":
    if sys.argv[1:2] == ["Custom"]:  # one boot with the scenario of the command line
        scenario = " ".join(sys.argv[2:])

        class Custom(VmCase):
            def test_scenario(self):
                self.boot(scenario)

        sys.argv[2:] = []
    unittest.main()
