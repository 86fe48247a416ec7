# SPDX-License-Identifier: Apache-2.0
"""Devices by their makers' libraries: Haply's service, played by a server of ours, and the plugins for Force Dimension's and the
Falcon's libraries, on stand-ins with their names and types (tests/device/plugins/fake_vendor). In real time."""
import asyncio
import json
import os
import pathlib
import signal
import threading
import time
import unittest

import websockets

from servo_run_test import ServoCase, lines_of

PLUGINS = {name: os.environ["FDCG_PLUGIN_" + name.upper()] for name in ("haply_inverse", "force_dimension", "novint_falcon")}
LIMITS = {"force_n": 5, "effort": [5, 5, 5], "slew_n_per_s": 2000, "velocity_m_per_s": 5, "device_watchdog_s": 0.02,
          "workspace_m": {"min": [-0.1, -0.1, -0.1], "max": [0.1, 0.1, 0.1]}}


class InverseService:
    """The Inverse Service as its documentation has it: an inventory, then a state for each message. A hand of 0.1 kg on a spring
    holds the cursor, above for a second, then 3 mm below."""

    def __init__(self, answers=10**9, garbage=None, silent_after=10**9):
        self.answers, self.garbage, self.silent_after = answers, garbage, silent_after
        self.forces, self.names, self.sessions = [], [], 0
        self.place, self.speed, self.force = 0.01, 0.0, 0.0
        self.ready = threading.Event()
        self.thread = threading.Thread(target=lambda: asyncio.run(self.serve()), daemon=True)
        self.thread.start()
        self.ready.wait(10)

    def state(self, is_full=False):
        device = {"device_id": "049D", "state": {"cursor_position": {"x": 0.0, "y": 0.0, "z": self.place}}}
        if is_full:
            device["config"] = {"type": "inverse3"}
        return json.dumps({"session_id": 7, "inverse3": [device],
                           "wireless_verse_grip": [{"device_id": "61", "state": {"buttons": {"a": True, "b": False, "c": True}}}]})

    def move(self, seconds):
        target = 0.01 if time.monotonic() - self.began < 1 else -0.003
        for _ in range(max(1, min(200, int(seconds / 2e-4)))):
            self.speed += (self.force + 200 * (target - self.place) - 6 * self.speed) / 0.1 * 2e-4
            self.place += self.speed * 2e-4

    async def talk(self, link):
        try:
            await self.answer(link)
        except websockets.ConnectionClosed:
            pass
        self.force = 0.0  # commands hold for a tick

    async def answer(self, link):
        self.sessions += 1
        self.began = last = time.monotonic()
        await link.send(self.state(is_full=True))
        count = 0
        async for text in link:
            message, count = json.loads(text), count + 1
            if "session" in message:
                self.names.append(message["session"]["configure"]["profile"]["name"])
            vector = message["inverse3"][0]["commands"]["set_cursor_force"]["vector"]
            assert message["inverse3"][0]["device_id"] == "049D"
            self.force = vector["z"]
            self.forces.append(self.force)
            now = time.monotonic()
            self.move(now - last)
            last = now
            if count > self.answers:
                return  # hangs up
            if count > self.silent_after:
                continue
            await link.send(self.garbage if self.garbage is not None and count > 200 else self.state())

    async def serve(self):
        async with websockets.serve(self.talk, "127.0.0.1", 0) as server:
            self.port = server.sockets[0].getsockname()[1]
            self.ready.set()
            await asyncio.Future()


class PluginCase(ServoCase):
    def scene_of(self, plugin, **settings):
        rate_hz = 250 if plugin == "haply_inverse" else 1000  # a service in Python is no faster
        settings = {"rate_hz": rate_hz, **settings}
        device = {"name": "hand", "source": "plugin", "plugin": PLUGINS[plugin], "settings": settings, "rate_hz": rate_hz, "limits": LIMITS}
        return self.scene(loop={"lock_memory": False}, devices=[device])

    def felt(self, scene, record="ticks.jsonl"):
        """The last status of a run in which the cube was felt, and its ticks; a busy machine gets some attempts."""
        for attempt in range(4):
            file = self.path(f"{attempt}{record}")
            done = self.run_scene(scene, "--arm", "--plugins", "--no-log", "--for", "3", "--status", "json", "--record", file)
            ticks = [json.loads(line) for line in pathlib.Path(file).read_text().splitlines()]
            if max(tick["force_n"][2] for tick in ticks) > 0.2:
                break
        return lines_of(done.stdout)[-1]["devices"][0], ticks


class Libraries(PluginCase):
    def test_force_dimension_and_falcon_are_felt(self):
        for plugin in ("force_dimension", "novint_falcon"):
            with self.subTest(plugin):
                hand, ticks = self.felt(self.scene_of(plugin), f"{plugin}.jsonl")
                self.assertGreater(hand["ticks"], 1000)
                self.assertGreater(max(tick["force_n"][2] for tick in ticks), 0.2)
                self.assertEqual(2, ticks[-1]["buttons"])
                self.assertGreater(hand["round_trip_us"]["count"], 500)

    def test_what_is_missing_is_told(self):
        done = self.run_scene(self.scene_of("force_dimension", device=3), "--plugins", "--no-log", "--for", "0.3", codes=(1,))
        self.assertIn(b"device 3 cannot be opened: no such device", done.stdout)
        for plugin in PLUGINS:
            done = self.run_scene(self.scene_of(plugin, devise=3), "--plugins", "--no-log", "--for", "0.3", codes=(1,))
            self.assertIn(b'settings have "devise", which is no key (the keys are ', done.stdout)
            done = self.run_scene(self.scene_of(plugin, rate_hz="fast"), "--plugins", "--no-log", "--for", "0.3", codes=(1,))
            self.assertIn(b"settings.rate_hz must be a number", done.stdout)


class Haply(PluginCase):
    def test_the_cube_is_felt(self):
        service = InverseService()
        hand, ticks = self.felt(self.scene_of("haply_inverse", port=service.port))
        self.assertEqual("fdcg", service.names[0])
        self.assertGreater(max(tick["force_n"][2] for tick in ticks), 0.2)
        self.assertGreater(max(service.forces), 0.2)
        self.assertEqual(5, ticks[-1]["buttons"])
        self.assertGreater(hand["ticks"], 200)
        self.assertEqual(0.0, service.forces[-1])

    def test_a_service_that_goes_away_or_talks_nonsense_disarms_and_is_tried_again(self):
        for kind in ({"answers": 200}, {"garbage": "}{"}, {"garbage": "[]"}, {"garbage": '{"inverse3": [{"device_id": "049D", "state": 7}]}'},
                     {"garbage": '{"inverse3": []}'}, {"silent_after": 200}):
            with self.subTest(kind):
                service = InverseService(**kind)
                done = self.run_scene(self.scene_of("haply_inverse", port=service.port), "--arm", "--plugins", "--no-log", "--for", "5",
                                      "--status", "json", codes=(1,))
                hand = lines_of(done.stdout)[-1]["devices"][0]
                self.assertEqual("disarmed", hand["phase"])
                self.assertGreater(service.sessions, 1)

    def test_nobody_there_and_another_device(self):
        done = self.run_scene(self.scene_of("haply_inverse", port=9), "--plugins", "--no-log", "--for", "0.3", codes=(1,))
        self.assertIn(b"does the Inverse Service run?", done.stdout)
        service = InverseService()
        scene = self.scene_of("haply_inverse", port=service.port, device="1234")
        done = self.run_scene(scene, "--plugins", "--no-log", "--for", "0.3", codes=(1,))
        self.assertIn(b'the Inverse Service has no device "1234"; it has 049D', done.stdout)

    def test_a_host_that_dies_ends_its_session(self):
        service = InverseService()
        host = self.started(self.scene_of("haply_inverse", port=service.port), "--arm", "--plugins", "--no-log", "-q")
        until = time.monotonic() + 10
        while max(service.forces, default=0) < 0.2 and time.monotonic() < until:
            time.sleep(0.01)
        host.send_signal(signal.SIGSEGV)
        host.wait()
        count = len(service.forces)
        time.sleep(0.1)
        self.assertLessEqual(len(service.forces) - count, 2)
        self.assertEqual(0.0, service.force)  # the session is over


if __name__ == "__main__":
    unittest.main()
