# SPDX-License-Identifier: Apache-2.0
"""Devices on a serial line: fdcg-servo against a simulated one behind a pseudo-terminal (pty_device), in frames of bytes and in
lines of text. In real time, on a machine that may be busy."""
import json
import os
import pathlib
import random
import signal
import subprocess
import time
import unittest

from servo_run_test import ROOT, SERVO, ServoCase, lines_of

PTY_DEVICE = os.environ["FDCG_PTY_DEVICE"]
STRIKES = int(os.environ.get("FDCG_STRIKES", "1"))
PROFILES = {"bytes": ROOT / "runtime/device/profiles/fdcg-reference.json", "text": ROOT / "testdata/profiles/serial_text.json"}
# from above into the cube, which has its top at z = 0
DOWN = [{"at_s": at, "place_m": [0, 0, z]} for at, z in ((0, 0.01), (0.9, 0.01), (1.1, -0.004), (100, -0.004))]


class SerialCase(ServoCase):
    def plug(self, kind="bytes", **simulation):
        """A device that is pressed into the cube after a second. Returns its process, and the scene that names its port."""
        simulated = {"name": "hand", "source": "simulated", "simulation": {"quantum_m": 1e-6, "watchdog_s": 0.05, "script": DOWN, **simulation}}
        port = self.path("port")
        process = subprocess.Popen([PTY_DEVICE, self.scene("device.json", devices=[simulated]), str(PROFILES[kind]), port],
                                   stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        for stream in (process.stdout, process.stdin):
            self.addCleanup(stream.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        self.assertEqual("ready\n", process.stdout.readline())
        return process, self.serial_scene(port=port, profile=str(PROFILES[kind]))

    def serial_scene(self, **device):
        return self.scene(loop={"lock_memory": False}, devices=[{"name": "hand", "source": "serial", **device}])

    def asked(self, process):
        """(force, enabled, outputs) of what the device was asked for last, and whether it says that it applies that."""
        process.stdin.write("?\n")
        process.stdin.flush()
        _, force, _, enabled, _, outputs, _, applies = process.stdout.readline().split()
        return float(force), int(enabled), int(outputs), int(applies)


class Lines(SerialCase):
    def test_a_session_over_bytes_and_over_text(self):
        for kind in PROFILES:
            with self.subTest(kind):
                device, scene = self.plug(kind)
                log = self.path(f"{kind}.fdcglog")
                done = self.run_scene(scene, "--arm", "--for", "2.5", "--log", log, "--status", "json")
                hand = lines_of(done.stdout)[-1]["devices"][0]
                self.assertGreater(hand["ticks"], 1000)  # of 2500, on a machine that may be busy
                damaged = {why: count for why, count in hand["rejected"].items() if why != "stale"}  # stale: the device was kept waiting
                self.assertLess(sum(damaged.values()), 20, damaged)  # what was under way as it was opened
                self.assertGreater(hand["round_trip_us"]["count"], 800)
                self.assertEqual((0, 0), self.asked(device)[:2])
                self.assertGreater(self.asked(device)[2], 1000)
                self.assertIn(b"every output the same", self.servo("replay", log, "-o", self.path("log.csv")).stdout)
                felt = [float(line.split(",")[18 + 2]) for line in (self.folder / "log.csv").read_text().splitlines()[1:]]
                if not hand["disarmed"]:
                    self.assertGreater(max(felt), 0.1)

    def test_latency_is_measured(self):
        _, scene = self.plug()
        done = self.servo("latency", scene, "--for", "1", "--json")
        self.assertEqual("fits", json.loads(done.stdout)["devices"][0]["arming"])

    def test_two_thousand_a_second(self):
        _, scene = self.plug(rate_hz=2000)
        scene = json.loads(pathlib.Path(scene).read_text())
        profile = json.loads(PROFILES["bytes"].read_text())
        profile["rate_hz"] = 2000
        scene["devices"][0]["profile"] = profile
        done = self.run_scene(self.write("fast.json", json.dumps(scene)), "--for", "1.5", "--no-log", "--status", "json")
        self.assertGreater(lines_of(done.stdout)[-1]["devices"][0]["ticks"], 1000)


class Faults(SerialCase):
    # of the simulated device, and what the host may say of it
    FAULTS = {"short": ("silence",), "long": ("silence",), "garbled": ("silence",), "unknown-id": ("silence",),
              "repeated": ("silence",), "out-of-order": ("silence", "reports-lost"), "stall": ("silence",), "restart": ("restarted", "silence"),
              "stale": ("silence", "not-taken"), "no-output": ("not-taken", "writer-stuck"), "device-fault": ("device-fault",),
              "unplug": ("read-failed", "silence")}

    def test_each_fault_takes_the_force_away_for_good(self):
        for kind, said in self.FAULTS.items():
            fault = {"kind": kind, "at_s": 1.6, "for_s": 0.1, "delay_s": 0.05, "reports": 300}
            for attempt in range(4):
                device, scene = self.plug(faults=[fault])
                done = self.run_scene(scene, "--arm", "--no-log", "--for", "2.4", "--status", "json")
                hand = lines_of(done.stdout)[-1]["devices"][0]
                device.kill()
                if set(hand["disarmed"]) & set(said):
                    break  # else the machine was too busy for the hand to be armed so long
            with self.subTest(kind):
                self.assertTrue(set(hand["disarmed"]) & set(said), (hand["disarmed"], attempt))
                self.assertEqual("disarmed", hand["phase"])

    def test_what_is_unplugged_is_opened_again_and_not_armed(self):
        device, scene = self.plug(faults=[{"kind": "unplug", "at_s": 1.0, "for_s": 0.3}])
        done = self.run_scene(scene, "--arm", "--no-log", "--for", "2.5", "--status", "json", codes=(1,))
        hand = lines_of(done.stdout)[-1]["devices"][0]
        self.assertEqual((2, "disarmed", "open"), (hand["opened"], hand["phase"], hand["connection"]))
        self.assertEqual((0, 0), self.asked(device)[:2])

    def test_every_signal_leaves_zero(self):
        for kind in PROFILES:
            for number in (signal.SIGSEGV, signal.SIGABRT, signal.SIGTERM, signal.SIGUSR1):
                with self.subTest(f"{kind} {number.name}"):
                    for _ in range(4):
                        device, scene = self.plug(kind)
                        host = self.started(scene, "--arm", "--no-log", "-q")
                        until = time.monotonic() + 5
                        while self.asked(device)[0] < 0.1 and time.monotonic() < until:
                            time.sleep(0.01)
                        was_felt = self.asked(device)[0] > 0
                        host.send_signal(number)
                        host.wait()
                        until = time.monotonic() + 2  # the device's own thread may be busy
                        while self.asked(device)[:2] != (0, 0) and time.monotonic() < until:
                            time.sleep(0.01)
                        self.assertEqual((0, 0), self.asked(device)[:2])
                        device.kill()
                        if was_felt:
                            break
                    self.assertTrue(was_felt)


class Killed(SerialCase):
    """kill -9, to which no program answers. The device is a process of its own, and goes on."""

    WATCHDOG_S = 0.05
    UNWATCHED_N = 1.001  # what a device without a watchdog gets at most, and the rounding of its reports

    def killed_under_force(self, kind, **simulation):
        """The device, its scene, what it was asked for when the host died, and when that was."""
        for _ in range(4):
            device, scene = self.plug(kind, **simulation)
            if "watchdog_s" in simulation:  # what its profile does not know of
                scene = json.loads(pathlib.Path(scene).read_text())
                profile = json.loads(PROFILES[kind].read_text())
                del profile["limits"]["device_watchdog_s"]
                scene["devices"][0]["profile"] = profile
                scene = self.write("unwatched.json", json.dumps(scene))
            host = self.started(scene, "--arm", "--no-log", "-q")
            until = time.monotonic() + 5
            while not (self.asked(device)[0] > 0.1 and self.asked(device)[3]) and time.monotonic() < until:
                time.sleep(0.01)
            time.sleep(random.uniform(0, 0.2))
            before = self.asked(device)
            host.kill()
            host.wait()
            killed_s = time.monotonic()
            time.sleep(0.01)  # what is still on the line
            after = self.asked(device)
            if min(before[0], after[0]) > 0:
                return device, scene, after, killed_s
            device.kill()
        self.fail("the machine was too busy for the hand to be armed")

    def left_alone_by_the_next_host(self, device, scene, outputs):
        host = self.started(scene, "--no-log", "-q")
        until = time.monotonic() + 5
        while self.asked(device)[2] <= outputs and time.monotonic() < until:
            time.sleep(0.005)
        self.assertEqual((0, 0), self.asked(device)[:2])
        time.sleep(0.1)
        self.assertEqual((0, 0, 0), (*self.asked(device)[:2], self.asked(device)[3]))
        host.terminate()
        host.wait()

    def test_the_devices_watchdog_takes_the_force_away(self):
        for kind in PROFILES:
            for _ in range(STRIKES):
                with self.subTest(kind):
                    device, scene, after, killed_s = self.killed_under_force(kind)
                    while self.asked(device)[3] and time.monotonic() < killed_s + 2:
                        time.sleep(0.001)
                    self.assertLess(time.monotonic() - killed_s, self.WATCHDOG_S + 0.05)  # its next report, and this thread's delay
                    self.assertEqual(after[:3], self.asked(device)[:3], "nobody has sent anything")
                    self.left_alone_by_the_next_host(device, scene, after[2])
                    device.kill()

    def test_without_a_watchdog_the_force_is_small_until_the_next_host(self):
        for kind in PROFILES:
            for _ in range(STRIKES):
                with self.subTest(kind):
                    device, scene, after, _ = self.killed_under_force(kind, watchdog_s=10)
                    time.sleep(random.uniform(0.03, 0.5))
                    self.assertEqual((*after[:3], 1), self.asked(device))
                    self.assertLess(after[0], self.UNWATCHED_N)
                    self.left_alone_by_the_next_host(device, scene, after[2])
                    device.kill()


class Calibrate(SerialCase):
    # three seconds at each place, axis by axis
    PLACES = [[-0.05, 0, 0], [0.05, 0, 0], [0, -0.05, 0], [0, 0.05, 0], [0, 0, -0.05], [0, 0, 0.05]]

    def moved(self, kind, profile):
        script = [{"at_s": 0, "place_m": self.PLACES[0]}]
        for i, place in enumerate(self.PLACES):
            script += [{"at_s": 3 * i + 0.3, "place_m": place}, {"at_s": 3 * i + 3, "place_m": place}]
        process, scene = self.plug(kind, script=script, hand_stiffness_n_per_m=500, hand_damping_n_s_per_m=14)
        scene = json.loads(pathlib.Path(scene).read_text())
        scene["devices"][0]["profile"] = profile
        return process, self.write("calibrate.json", json.dumps(scene))

    def test_wrong_scales_and_signs_are_put_right(self):
        for kind, unit in (("bytes", 1e-6), ("text", 1e-3)):
            with self.subTest(kind):
                profile = json.loads(PROFILES[kind].read_text())
                for field in profile["input"]["fields"]:
                    if field["role"] == "axis":
                        field["scale"] = -2 * unit if field["axis"] == 1 else 3 * unit
                        field["bias"] = 0.01
                _, scene = self.moved(kind, profile)
                out = self.path(f"{kind}.json")
                began = time.monotonic()
                process = subprocess.Popen([SERVO, "calibrate", scene, "-o", out], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
                for i in range(6):
                    time.sleep(max(0, began + 3 * i + 1.2 - time.monotonic()))
                    process.stdin.write(b"\n")
                    process.stdin.flush()
                said = process.communicate(timeout=30)[0].decode()
                self.assertEqual(0, process.returncode, said)
                found = json.loads(pathlib.Path(out).read_text())
                for field in found["input"]["fields"]:
                    if field["role"] == "axis":
                        self.assertAlmostEqual(unit, field["scale"], delta=0.01 * unit)
                        self.assertAlmostEqual(0, field["bias"], delta=0.0005)
                efforts = {field["axis"]: field["scale"] for field in found["output"]["fields"] if field["role"] == "effort"}
                self.assertEqual({0: 1, 1: -1, 2: 1}, efforts)
                self.assertEqual({k: v for k, v in profile.items() if k not in ("input", "output")},
                                 {k: v for k, v in found.items() if k not in ("input", "output")})
                self.assertIn(b"ok", self.servo("check", out).stdout)

    def test_what_goes_wrong(self):
        _, scene = self.plug()
        out = self.path("out.json")

        def calibrate(*arguments, code, text=b"\n" * 40):
            done = subprocess.run([SERVO, "calibrate", *arguments], input=text, capture_output=True, timeout=60, check=False)
            self.assertEqual(code, done.returncode, done.stdout[-500:] + done.stderr)
            return done

        self.assertIn(b"axis 0 did not move", calibrate(scene, "-o", out, code=1).stderr)
        self.assertIn(b"ended before", calibrate(scene, "-o", out, code=1, text=b"").stderr)
        self.assertFalse(pathlib.Path(out).exists())
        self.assertIn(b"would overwrite the scene", calibrate(scene, "-o", scene, code=2).stderr)
        self.assertIn(b"one place", calibrate(scene, "--from", "0.1", "--to", "0.1", "-o", out, code=1).stderr)
        self.assertIn(b"has no device 'x'", calibrate(scene, "--device", "x", "-o", out, code=3).stderr)
        self.assertIn(b"cannot be opened", calibrate(self.serial_scene(port="/dev/none", profile="fdcg-reference"), "-o", out, code=3).stderr)
        simulated = self.scene(devices=[{"name": "hand", "source": "simulated"}])
        self.assertIn(b"has no profile of its own", calibrate(simulated, "-o", out, code=3).stderr)
        text = self.serial_scene(port=self.path("port"), profile=str(PROFILES["text"]))
        self.assertIn(b"is it the right profile?", calibrate(text, "-o", out, code=1).stderr)


class Refusals(SerialCase):
    def port(self, **device):
        return self.serial_scene(profile="fdcg-reference", **device)

    def test_a_second_host_is_told_of_the_first(self):
        device, scene = self.plug()
        host = self.started(scene, "--no-log", "-q")
        until = time.monotonic() + 5
        while self.asked(device)[2] < 10 and time.monotonic() < until:
            time.sleep(0.02)
        done = self.run_scene(scene, "--no-log", "--for", "0.3")
        self.assertIn(f"process {host.pid} (fdcg-servo) drives this device".encode(), done.stdout)

    def test_what_is_no_port(self):
        for port, words in ((self.path("none"), b"cannot be opened: No such file"), (self.write("file", ""), b"is no serial line")):
            self.assertIn(words, self.run_scene(self.port(port=port), "--no-log", "--for", "0.3", codes=(1,)).stdout)

    def refused(self, scene, *words):
        done = self.servo("check", scene, code=1)
        for word in words:
            self.assertIn(word, done.stdout.decode())

    def test_wrong_scenes(self):
        self.refused(self.port(), "devices[0].port is missing")
        self.refused(self.port(port="/dev/x", baud=110), "devices[0].baud is 110; it must be one of 9600, ")
        self.refused(self.port(port="/dev/x", path="/dev/y"), "no key of a serial device")
        twice = [{"name": name, "source": "serial", "profile": "fdcg-reference", "port": "/dev/x"} for name in "ab"]
        self.refused(self.scene(devices=twice), "is that of device 'a' too")
        text = [{"name": "hand", "profile": str(PROFILES["text"])}]
        self.refused(self.scene(devices=text), 'has no "match"')
        self.servo("check", self.port(port="/dev/x"))
        no_button = json.loads(PROFILES["text"].read_text())
        no_button["input"]["fields"] = [field for field in no_button["input"]["fields"] if field["role"] != "buttons"]
        self.refused(self.serial_scene(port="/dev/x", profile=no_button, dead_man={"button": 0}), "asks for a button")


if __name__ == "__main__":
    unittest.main()
