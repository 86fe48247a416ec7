# SPDX-License-Identifier: Apache-2.0
"""fdcg-servo run under signals, from outside: a device with a force on it gets zero force last, and the program dies of the
signal. FDCG_FAKE_HID is the folder of a hidapi whose device passes all that it gets on to a FIFO
(tests/device/transport/fake_hid_node.c). FDCG_STRIKES: how often each is done, at random moments."""
import concurrent.futures
import itertools
import json
import os
import random
import resource
import shutil
import signal
import struct
import subprocess
import threading
import time
import unittest

from support import ROOT, SERVO, Case

SCENES = ROOT / "testdata" / "scenes"
PATIENCE_S = 60  # for a machine that is busy with other things
STRIKES = int(os.environ.get("FDCG_STRIKES", "1"))
AT_ONCE = 3  # hosts, each with a device of its own
OUTPUT, SAFE_STOP = 2, 9  # report ids
SAFE_STOP_REPORT = bytes([SAFE_STOP, 0x5A])

AXES = range(3)
PROFILE = {
    "fdcg_profile": 1,
    "name": "fake node",
    "match": {"vendor_id": "0x1209", "product_id": "0xF002"},
    "rate_hz": 1000,
    "input": {
        "report_id": 1, "bytes": 17,
        "fields": [{"role": "sequence", "offset": 1, "type": "u32"}]
        + [{"role": "axis", "axis": i, "offset": 5 + 4 * i, "type": "i32", "scale": 1e-6, "unit": "m"} for i in AXES],
    },
    "output": {
        "report_id": OUTPUT, "bytes": 18,
        "fields": [{"role": "sequence", "offset": 1, "type": "u32"}]
        + [{"role": "effort", "axis": i, "offset": 5 + 4 * i, "type": "f32", "scale": 1, "unit": "N"} for i in AXES]
        + [{"role": "enable", "offset": 17, "type": "u8", "value": 1}],
    },
    "safe_stop": [{"kind": "output", "hex": SAFE_STOP_REPORT.hex()}],
    "kinematics": {"kind": "cartesian"},
    "limits": {"force_n": 5, "effort": [5, 5, 5], "slew_n_per_s": 2000, "velocity_m_per_s": 10,
               "workspace_m": {"min": [-1, -1, -1], "max": [1, 1, 1]}, "device_watchdog_s": 0.02},
}


class Node(threading.Thread):
    """The device's end: every report in the order in which it came, (sequence, largest force, enabled) or SAFE_STOP."""

    def __init__(self, path):
        super().__init__(daemon=True)
        os.mkfifo(path)
        self.descriptor = os.open(path, os.O_RDONLY | os.O_NONBLOCK)
        self.reports = []
        self.is_closing = False
        self.start()

    def run(self):
        rest = b""
        while True:
            try:
                got = os.read(self.descriptor, 1 << 16)
            except BlockingIOError:
                got = b""
            if not got:
                if self.is_closing:
                    return
                time.sleep(0.001)
                continue
            rest = self.take(rest + got)

    def take(self, data):
        while data:
            size = len(SAFE_STOP_REPORT) if data[0] == SAFE_STOP else 18
            if len(data) < size:
                break
            if data[0] == SAFE_STOP:
                self.reports.append(SAFE_STOP)
            else:
                kind, sequence, x, y, z, enable = struct.unpack("<BI3fB", data[:size])
                assert kind == OUTPUT, data[:size]
                self.reports.append((sequence, max(abs(x), abs(y), abs(z)), enable))
            data = data[size:]
        return data

    def drain(self):
        """All that came, once nobody writes any more."""
        self.is_closing = True
        self.join()
        os.close(self.descriptor)
        return self.reports

    def force(self):
        return self.reports[-1][1] if self.reports and self.reports[-1] != SAFE_STOP else 0


def without_core():
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    os.setpgid(0, 0)  # a group of its own, as a shell's job: one that SIGTSTP stops


def ignoring_quit():
    without_core()
    signal.signal(signal.SIGQUIT, signal.SIG_IGN)


class SignalCase(Case):
    def setUp(self):
        super().setUp()
        shutil.copy(SCENES / "cube.fdcg", self.folder)
        scene = json.loads((SCENES / "cube.json").read_text())
        scene["loop"] = {"servo_priority": 0, "writer_priority": 0, "lock_memory": False}
        scene["devices"] = [{"name": "hand", "profile": PROFILE}]
        self.scene = self.write("scene.json", json.dumps(scene))
        self.count = itertools.count()

    def started(self, before=without_core):
        number = next(self.count)
        path = self.path(f"node{number}")
        node = Node(path)
        environment = {**os.environ, "LD_LIBRARY_PATH": os.environ["FDCG_FAKE_HID"], "FDCG_FAKE_NODE": path}
        log = self.path(f"session{number}.fdcglog")
        process = subprocess.Popen([SERVO, "run", self.scene, "--hid", "hidraw", "--log", log, "-q"], stdin=subprocess.PIPE,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env=environment,
                                   preexec_fn=before)
        self.addCleanup(process.stdin.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process, node

    def press(self, process, node):
        """Until the device is pushed with 2 N. A machine that is late disarms: then once more."""
        until = time.monotonic() + PATIENCE_S
        while time.monotonic() < until:
            process.stdin.write(b"arm\n")
            process.stdin.flush()
            again = time.monotonic() + 1
            while time.monotonic() < again:
                if node.force() > 2:
                    return
                time.sleep(0.001)
        self.fail(f"no force in a minute; the last reports: {node.reports[-3:]}")

    def check_zero_force_sent(self, reports):
        """After the last force only zeros that the device takes for new, then the safe stop."""
        self.assertEqual(SAFE_STOP, reports[-1])
        outputs = [report for report in reports if report != SAFE_STOP]
        self.assertEqual(len(reports) - 1, len(outputs))
        self.assertGreater(max(force for _, force, _ in outputs), 2)
        sequence, force, enable = outputs[-1]
        self.assertEqual((0, 0), (force, enable))
        self.assertGreater(sequence, outputs[-2][0])


class EndingCase(SignalCase):
    def end_by(self, number, moment_s, codes):
        process, node = self.started()
        self.press(process, node)
        time.sleep(moment_s)
        process.send_signal(number)
        process.wait(timeout=PATIENCE_S)
        self.assertIn(process.returncode, codes)
        self.check_zero_force_sent(node.drain())

    def check_signals(self, *numbers, codes=None):
        moments = random.Random(1)
        with concurrent.futures.ThreadPoolExecutor(AT_ONCE) as pool:
            for number in numbers:
                with self.subTest(signal=number):
                    ends = [pool.submit(self.end_by, number, moments.uniform(0, 0.06), codes or (-number,))
                            for _ in range(STRIKES)]
                    for end in ends:
                        end.result()


class Crashes(EndingCase):
    def test_a_crash_leaves_zero_force_and_dies_of_its_signal(self):
        self.check_signals(signal.SIGSEGV, signal.SIGABRT, signal.SIGBUS, signal.SIGFPE, signal.SIGILL, signal.SIGTRAP,
                           signal.SIGSYS)


class Endings(EndingCase):
    def test_so_does_every_other_signal_that_ends_a_program(self):
        self.check_signals(signal.SIGQUIT, signal.SIGXCPU, signal.SIGUSR1, signal.SIGUSR2, signal.SIGALRM, signal.SIGVTALRM,
                           signal.SIGPROF, signal.SIGIO, signal.SIGRTMIN, signal.SIGRTMAX)

    def test_a_stop_that_is_asked_for_leaves_zero_force_in_order(self):
        self.check_signals(signal.SIGINT, signal.SIGTERM, signal.SIGHUP, codes=(0, 1))

    def test_a_signal_that_was_ignored_before_stays_ignored(self):
        process, node = self.started(ignoring_quit)
        self.press(process, node)
        process.send_signal(signal.SIGQUIT)
        time.sleep(0.3)
        self.assertIsNone(process.poll())
        self.assertNotIn(SAFE_STOP, node.reports)
        process.send_signal(signal.SIGUSR1)
        process.wait(timeout=PATIENCE_S)
        self.assertEqual(-signal.SIGUSR1, process.returncode)


class Stops(SignalCase):
    def stop(self, process):
        process.send_signal(signal.SIGTSTP)
        _, status = os.waitpid(process.pid, os.WUNTRACED)
        self.assertTrue(os.WIFSTOPPED(status), status)
        self.assertEqual(signal.SIGTSTP, os.WSTOPSIG(status))
        time.sleep(0.1)  # what is in the FIFO is read

    def test_what_is_stopped_was_disarmed_before_and_stays_so_when_continued(self):
        process, node = self.started()
        for _ in range(max(3, STRIKES)):
            self.press(process, node)
            time.sleep(random.uniform(0, 0.06))
            self.stop(process)
            stopped = len(node.reports)
            self.assertEqual([(0, 0)], list({report[1:] for report in node.reports[-2:]}))
            time.sleep(0.1)
            self.assertEqual(stopped, len(node.reports))
            process.send_signal(signal.SIGCONT)
            time.sleep(0.3)
            self.assertGreater(len(node.reports), stopped + 20)
            self.assertEqual({(0, 0)}, {report[1:] for report in node.reports[stopped:]})
        self.press(process, node)
        process.send_signal(signal.SIGTERM)
        process.wait(timeout=PATIENCE_S)
        self.check_zero_force_sent(node.drain())


if __name__ == "__main__":
    unittest.main()
