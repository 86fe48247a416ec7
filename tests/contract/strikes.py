# SPDX-License-Identifier: Apache-2.0
"""For the contract tests that strike fdcg-servo run while there is force, on a device made of the firmware core
(tests/device/transport/fake_hid_firmware.c, whose folder FDCG_FAKE_HID_FIRMWARE names): what the program can know and when, and
what it does then. FDCG_STRIKES: how often each is done, at random moments. All times are the device's, of one clock: what is
struck, what the host was handed, and what it sent.

A machine may stand still by itself. The device's witnesses, threads above the host's on every processor, note when and for how
long: a strike is done once more where that explains what went wrong, and only so often. What they did not see is the host's fault."""
import json
import mmap
import os
import random
import shutil
import signal
import struct
import subprocess
import threading
import time
import unittest

from support import ROOT, SERVO, Case

PATIENCE_S = 60
STRIKES = int(os.environ.get("FDCG_STRIKES", "1"))
MOST_LATE = 4 + STRIKES  # strikes that a busy machine may spoil
ZERO_LIMIT_S = 0.002  # the bar: from the first chance to know until zero is sent
MOST_RISE_N = 0.1  # what the hand's own moving changes in a period, and far below a step
# told where the machine stops a thread of the host, or all of it (the device's watchdog); for how long it stands still at least
BY_ITSELF = {"host-late": 0.005, "writer-stuck": 0.0025, "silence": 0.005, "not-taken": 0.005, "device-fault": 0.005}
STANDSTILL_NEAR_S = 0.05  # before a disarming that it explains, and after
STATUS_AGE_S = 0.025  # of what a status line says
SILENCE_S, TAKEN_S, PERIOD_S, TRIPS = 0.010, 0.010, 0.001, 16

EVENT = struct.Struct("<qIIIIfI")
MOST_EVENTS, HEADER_BYTES = 1 << 17, 64
HANDED_OUT, TAKEN, LAGS, FOREIGN, GONE, FORCE, STOOD, RESTARTED, LOSING = range(1, 10)
FIELDS = {name: 4 * i for i, name in enumerate(
    ("report_lag_us", "output_lag_us", "foreign", "is_unplugged", "wrong_byte", "is_pressing", "event_count", "restarts",
     "loses_half", "rate_hz"))}


def grants_real_time():
    granted = []

    def ask():
        try:
            os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(90))
            granted.append(True)
        except OSError:
            pass
    asking = threading.Thread(target=ask)
    asking.start()
    asking.join()
    return bool(granted)


def standstill_s(events, begin_s, end_s):
    """For how long in this time the machine stood still: on any processor, as its witness noted."""
    spans = sorted((max(begin_s, event.at_s - 1e-6 * event.sequence), min(end_s, event.at_s)) for event in events
                   if event.kind == STOOD)
    total_s, until_s = 0, begin_s
    for first_s, last_s in spans:
        total_s += max(0, last_s - max(first_s, until_s))
        until_s = max(until_s, last_s)
    return total_s


class Event:
    def __init__(self, words):
        ns, self.kind, self.sequence, self.echo, self.is_enable, self.force_n, _ = words
        self.at_s = ns * 1e-9


class Device:
    """What is shared with it, and the host that drives it."""

    def __init__(self, case, name):
        self.node = case.write(name, b"")
        self.memory_file = case.write(name + ".memory", bytes(HEADER_BYTES + MOST_EVENTS * EVENT.size))
        with open(self.memory_file, "r+b") as file:
            self.memory = mmap.mmap(file.fileno(), 0)
        case.addCleanup(self.memory.close)

    def set(self, **values):
        for name, value in values.items():
            struct.pack_into("<I", self.memory, FIELDS[name], value)

    def count(self):
        return struct.unpack_from("<I", self.memory, FIELDS["event_count"])[0]

    def events(self, since):
        end = self.count()
        assert end - since < MOST_EVENTS
        return [Event(EVENT.unpack_from(self.memory, HEADER_BYTES + i % MOST_EVENTS * EVENT.size)) for i in range(since, end)]

    def force_n(self):
        """Of the last output that it was sent."""
        for at in range(self.count() - 1, max(-1, self.count() - 50), -1):
            event = Event(EVENT.unpack_from(self.memory, HEADER_BYTES + at % MOST_EVENTS * EVENT.size))
            if event.kind == TAKEN:
                return event.force_n
        return 0


class Program:
    """fdcg-servo, and what it says: its status lines, one by one."""

    def __init__(self, case, device, *command, **variables):
        environment = {**os.environ, **variables, "LD_LIBRARY_PATH": os.environ["FDCG_FAKE_HID_FIRMWARE"], "FDCG_FAKE_NODE": device.node,
                       "FDCG_FAKE_MEMORY": device.memory_file}
        self.launched_s = time.monotonic()
        self.process = subprocess.Popen([SERVO, *command], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                        env=environment)
        self.lines, self.errors = [], []
        self.readers = [threading.Thread(target=self.read, args=pair, daemon=True)
                        for pair in ((self.process.stdout, self.lines), (self.process.stderr, self.errors))]
        for reader in self.readers:
            reader.start()
        case.addCleanup(self.end)

    @staticmethod
    def read(stream, lines):
        for line in stream:
            lines.append(line.decode())

    def end(self):
        self.process.kill()
        self.process.wait()
        for reader in self.readers:
            reader.join()
        for stream in (self.process.stdin, self.process.stdout, self.process.stderr):
            stream.close()

    def say(self, command):
        self.process.stdin.write(command.encode() + b"\n")
        self.process.stdin.flush()

    def status(self):
        return json.loads(self.lines[-1])["devices"][0] if self.lines else {}

    def fresh_status(self):
        """What is told of a moment from now on. A line's time counts from the session's start, which is after the launch: by the
        clock, since lines may have waited in the pipe."""
        now_s = time.monotonic()
        while time.monotonic() < now_s + PATIENCE_S:
            if self.lines and self.launched_s + json.loads(self.lines[-1])["time_s"] > now_s + STATUS_AGE_S:
                break
            time.sleep(0.005)
        return self.status()


class Late(Exception):
    """This machine stood still, and so nothing can be said."""


class StrikeCase(Case):
    def setUp(self):
        super().setUp()
        shutil.copy(ROOT / "testdata" / "scenes" / "cube.fdcg", self.folder)
        self.device = Device(self, "node")
        self.random = random.Random(self.id())
        self.slowest_s, self.late = 0, []
        self.has_witness = grants_real_time() and "FDCG_SLOW_HOST" not in os.environ
        cube = {"name": "cube", "file": "cube.fdcg", "pose": {"scale": 0.2, "translation_m": [-0.1, -0.1, -0.2]},
                "stiffness_n_per_m": 500, "mu_static": 0.5, "mu_dynamic": 0.4}
        # where real time is granted a busy machine is no matter
        self.description = {"fdcg_scene": 1, "objects": [cube],
                            "devices": [{"name": "hand", "profile": "fdcg-reference", "force_limit_n": 3}],
                            "loop": {"servo_priority": 80, "writer_priority": 70, "lock_memory": False}}
        self.scene = self.write("scene.json", json.dumps(self.description))

    def started(self, scene=None, *arguments, **variables):
        return Program(self, self.device, "run", scene or self.scene, "--hid", "hidraw", "--status", "json", "--status-every",
                       "0.02", *(arguments or ("--no-log",)), **variables)

    def wait(self, condition, limit_s=PATIENCE_S):
        until = time.monotonic() + limit_s
        while not condition():
            if time.monotonic() > until:
                return False
            time.sleep(0.001)
        return True

    def feel(self, program):
        """Armed above the surface, then pressed in, until there are 1.5 N, and for a random moment."""
        until = time.monotonic() + PATIENCE_S
        self.felt = self.device.count()
        while time.monotonic() < until:
            self.device.set(is_pressing=0)
            time.sleep(0.35)  # up there by then
            program.say("arm")
            if not self.wait(lambda: program.status().get("phase") == "armed", 2):
                continue
            self.device.set(is_pressing=1)
            if self.wait(lambda: self.device.force_n() > 1.5, 1):
                time.sleep(self.random.uniform(0.005, 0.06))
                return
        self.fail(f"no force in a minute: {program.lines[-1:]} {program.errors}")

    def excuse(self, what, needed_s, begin_s, end_s):
        """Late, if the machine stood still for so long in this time; else the host has failed. Where threads have no priority
        anything may hold one of them up, and no witness knows; a host with a sanitizer (FDCG_SLOW_HOST) is late by itself."""
        stood_s = standstill_s(self.device.events(self.felt), begin_s, end_s)
        told = f"{what}, and the machine stood still for {1000 * stood_s:.2f} ms"
        if self.has_witness and stood_s < needed_s:
            self.fail(f"{told}: {1000 * needed_s:.2f} would explain it")
        raise Late(told)

    def excuse_disarming(self, program, what, told=()):
        """The last disarming was not meant."""
        what += f" ({program.fresh_status()['fault']})"
        events = self.device.events(self.felt)
        outputs = [event for event in events if event.kind == TAKEN]
        at_s = next((after.at_s for before, after in reversed(list(zip(outputs, outputs[1:])))
                     if before.is_enable and not after.is_enable), outputs[-1].at_s)
        needed_s = max((BY_ITSELF[reason] for reason in told), default=min(BY_ITSELF.values()))
        self.excuse(what, needed_s, at_s - STANDSTILL_NEAR_S, at_s + STANDSTILL_NEAR_S)

    def strike(self, program, strike, reasons):
        """One time: felt, struck, and judged. strike() sets something, and returns how the time of the first chance to know comes
        from the events after it (None: it has not come yet)."""
        self.feel(program)
        before = program.fresh_status()["disarmed"]
        if not self.device.force_n() > 0:
            self.excuse_disarming(program, "disarmed before it was struck")
        since = self.device.count()
        known_of = strike()
        self.assertTrue(self.wait(lambda: known_of(self.device.events(since)) is not None), "the device has not been struck")
        known_s = known_of(self.device.events(since))
        self.assertTrue(self.wait(lambda: time.monotonic() > known_s + 0.1))
        after = program.fresh_status()["disarmed"]
        told = {reason for reason in after if after[reason] > before.get(reason, 0)}
        outputs = [event for event in self.device.events(since) if event.kind == TAKEN]
        zero = self.judge_zero(outputs, known_s)
        if told & BY_ITSELF.keys() - reasons:
            self.excuse_disarming(program, f"{told} is told", told & BY_ITSELF.keys() - reasons)
        self.assertTrue(told and told <= reasons, f"{told or 'nothing'} is told instead of {reasons}")
        late_s = zero.at_s - known_s - ZERO_LIMIT_S
        if late_s > 0:
            self.excuse(f"zero {1000 * late_s:.2f} ms too late", late_s, known_s, zero.at_s)
        self.slowest_s = max(self.slowest_s, zero.at_s - known_s)

    def judge_zero(self, outputs, known_s):
        """The first zero; from it on all are, and none grew that was sent once the host could know. The last disables too."""
        zero = next((event for event in outputs if event.force_n == 0), None)
        self.assertIsNotNone(zero, "the force stays")
        for before, event in zip(outputs, outputs[1:]):
            if event.at_s > zero.at_s:
                self.assertEqual(0, event.force_n, "there is force before it was armed again")
            elif event.at_s > known_s:
                self.assertLess(event.force_n - before.force_n, MOST_RISE_N, "the force steps up")
        self.assertEqual(0, outputs[-1].is_enable)
        return zero

    def check_goes_on(self, program, disarmed, since):
        """The force is there as if nothing were. A thread of the host that is late has its zero sent by another."""
        after = program.fresh_status()["disarmed"]
        told = {reason for reason in after if after[reason] > disarmed.get(reason, 0)}
        outputs = [event for event in self.device.events(since) if event.kind == TAKEN]  # of a program that has run since
        self.assertTrue(told <= BY_ITSELF.keys(), told)
        if told or not all(event.is_enable for event in outputs):
            self.excuse_disarming(program, f"{told or 'nothing'} is told, and it is disarmed", told)
        if len(outputs) <= 20:
            begin_s = self.device.events(since - 1)[0].at_s
            self.excuse(f"{len(outputs)} outputs, {program.lines[-1]}", 0.1, begin_s, time.monotonic())
        for before, event in zip(outputs, outputs[1:]):
            self.assertLess(abs(event.force_n - before.force_n), 4 * MOST_RISE_N)

    def often(self, once):
        done = 0
        while done < STRIKES:
            try:
                once()
                done += 1
            except Late as late:
                self.late.append(str(late))
                self.assertLess(len(self.late), MOST_LATE, self.late)
        if STRIKES > 1:
            print(f"{self.id()}: {done} times, zero within {1000 * self.slowest_s:.3f} ms of the first chance to know; "
                  f"{len(self.late)} spoilt: {self.late}", flush=True)
