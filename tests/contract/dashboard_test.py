# SPDX-License-Identifier: Apache-2.0
"""fdcg-servo run --listen and --record: snapshots and commands by WebSocket, who may come, ticks in a file."""
import asyncio
import fcntl
import http.client
import json
import os
import pathlib
import pty
import re
import resource
import select
import signal
import socket
import struct
import subprocess
import sys
import termios
import time
import unittest

import jsonschema
import websockets

from servo_run_test import ROOT, SERVO, ServoCase

LIFT = ROOT / "testdata" / "scenes" / "lift_cube.json"
VALIDATOR = jsonschema.Draft202012Validator(json.loads((ROOT / "schemas" / "servo-snapshot.schema.json").read_text()))


class DashboardCase(ServoCase):
    def listening(self, scene, *arguments):
        """A run that ends by itself, and its port."""
        process = self.started(scene, "--no-log", "--for", "6", "--listen", "0", *arguments)
        line = process.stderr.readline().decode()
        while "dashboard" not in line and line:
            line = process.stderr.readline().decode()
        return process, int(re.search(r":(\d+)/", line).group(1))


class Sockets(DashboardCase):
    def test_snapshots_follow_the_run_and_commands_are_obeyed(self):
        _, port = self.listening(str(LIFT), "--status", "json")

        async def talk():
            async with websockets.connect(f"ws://127.0.0.1:{port}/") as link:
                seen, said = [], []
                await link.send("arm")
                began = time.monotonic()
                while time.monotonic() - began < 2.5:
                    told = json.loads(await asyncio.wait_for(link.recv(), 2))
                    VALIDATOR.validate(told)
                    (seen if told["event"] == "snapshot" else said).append(told)
                await link.send("disarm")
                await link.send("no such command")
                while seen[-1]["devices"][0]["phase"] != "disarmed":
                    told = json.loads(await asyncio.wait_for(link.recv(), 2))
                    if told["event"] == "snapshot":
                        seen.append(told)
                return seen, said

        seen, said = asyncio.run(talk())
        self.assertGreater(len(seen), 30)  # 60 a second, on a machine that may be busy
        ticks = [snapshot["devices"][0]["tick"] for snapshot in seen]
        self.assertEqual(sorted(ticks), ticks)
        self.assertTrue(any("armed" in one["text"] for one in said), said)
        held = [s["devices"][0] for s in seen if all(c["object"] == "cube" for c in s["devices"][0]["contacts"])]
        self.assertTrue(held)
        self.assertEqual("cube", held[-1]["bodies"][0]["name"])

    def test_who_may_come(self):
        _, port = self.listening(str(LIFT))

        async def is_let_in(**options):
            try:
                async with websockets.connect(f"ws://127.0.0.1:{port}/", **options):
                    return True
            except websockets.InvalidStatusCode as refusal:
                self.assertEqual(403, refusal.status_code)
                return False

        self.assertTrue(asyncio.run(is_let_in()))
        self.assertTrue(asyncio.run(is_let_in(origin=f"http://localhost:{port}")))
        for origin in ("http://example.org", "http://localhost.example.org", "https://127.0.0.1.nip.io", "null"):
            self.assertFalse(asyncio.run(is_let_in(origin=origin)), origin)
        page = http.client.HTTPConnection("127.0.0.1", port)
        page.request("GET", "/")
        answer = page.getresponse()
        self.assertEqual((200, True), (answer.status, b"<!doctype html>" in answer.read()))
        page = http.client.HTTPConnection("127.0.0.1", port)
        page.request("GET", "/", headers={"Host": "example.org"})
        self.assertEqual(403, page.getresponse().status)

    def test_hostile_clients_disturb_nobody(self):
        process, port = self.listening(str(LIFT), "--arm", "--status", "json")
        noise = [b"\0" * 100_000, b"GET / HTTP/1.1\r\n" + b"A: b\r\n" * 10_000, b"GET / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 99999999\r\n\r\n",
                 os.urandom(5000), b""]
        kept = []
        for text in noise * 5:
            client = socket.create_connection(("127.0.0.1", port))
            try:
                client.sendall(text)
            except OSError:
                pass  # refused half-way
            kept.append(client)

        async def shout():
            async with websockets.connect(f"ws://127.0.0.1:{port}/") as link:
                await link.send("x" * 10_000)
                try:
                    while True:
                        await asyncio.wait_for(link.recv(), 2)
                except websockets.ConnectionClosed:
                    pass

        for client in kept:
            client.close()
        asyncio.run(shout())
        end = json.loads(process.communicate(timeout=60)[0].splitlines()[-1])
        self.assertEqual("end", end["event"])
        self.assertLess(end["devices"][0]["work_us"]["p99"], 1000)

    def test_a_port_that_is_taken(self):
        with socket.create_server(("127.0.0.1", 0)) as taken:
            port = taken.getsockname()[1]
            done = self.servo("run", str(LIFT), "--no-log", "--listen", str(port), code=3)
            self.assert_one_line(done, f"127.0.0.1:{port}: cannot listen there")
        self.assert_one_line(self.servo("run", str(LIFT), "--listen", "70000", code=2), "--listen")
        self.assert_one_line(self.servo("run", str(LIFT), "--fast", "--for", "1", "--listen", "0", code=2), "real time")


class Bridges(DashboardCase):
    def test_osc(self):
        _, port = self.listening(str(LIFT))
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as ears:
            ears.bind(("127.0.0.1", 0))
            ears.settimeout(20)
            bridge = subprocess.Popen([sys.executable, ROOT / "tools/bridges/osc_bridge.py", str(port), "127.0.0.1", str(ears.getsockname()[1])])
            self.addCleanup(bridge.wait)
            self.addCleanup(bridge.kill)
            heard = {}
            while len(heard) < 3:
                data = ears.recv(1000)
                heard[data.split(b"\0")[0]] = data
        tip = heard[b"/fdcg/gripper/tip"]
        self.assertEqual(b",fff\0\0\0\0", tip[20:28])
        self.assertEqual(3, len(struct.unpack(">fff", tip[28:])))
        self.assertIn(b",si\0", heard[b"/fdcg/gripper/contact"])


class Recordings(DashboardCase):
    def test_every_tick_is_a_line(self):
        file = self.path("ticks.jsonl")
        self.run_scene(str(LIFT), "--arm", "--no-log", "--for", "2", "--record", file, "-q")
        lines = pathlib.Path(file).read_text().splitlines()
        ticks = [json.loads(line) for line in lines]
        self.assertEqual(list(range(len(ticks))), [tick["tick"] for tick in ticks])
        self.assertGreater(len(ticks), 800)
        for tick in ticks[::100]:
            VALIDATOR.validate(tick)
        self.assert_one_line(self.servo("run", str(LIFT), "--record", file, code=3), "is there already")
        self.assertEqual(lines, pathlib.Path(file).read_text().splitlines())
        self.assert_one_line(self.servo("run", str(LIFT), "--record", self.path("no") + "/a", code=3), "No such file")

    def test_it_pauses_and_goes_on(self):
        file = self.path("ticks.jsonl")
        process = self.started(str(LIFT), "--no-log", "--for", "3", "--record", file)
        for command in ("pause", "record"):
            time.sleep(0.8)
            process.stdin.write(f"{command}\n".encode())
            process.stdin.flush()
        out = process.communicate(timeout=60)[0].decode()
        self.assertIn("recording paused", out)
        ticks = [json.loads(line)["tick"] for line in pathlib.Path(file).read_text().splitlines()]
        gaps = [b - a for a, b in zip(ticks, ticks[1:]) if b != a + 1]
        self.assertEqual(1, len(gaps))
        self.assertGreater(gaps[0], 100)

    def test_a_full_disk_is_told(self):
        done = self.run_scene(str(LIFT), "--no-log", "--for", "1", "--record", "/dev/full", "-q", codes=(3,))
        self.assertIn(b"/dev/full: is there already", done.stderr)
        file = self.path("ticks.jsonl")
        limited = {"preexec_fn": lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (50_000, 50_000))}
        done = self.run_scene(str(LIFT), "--no-log", "--for", "1", "--record", file, "-q", codes=(3,), **limited)
        self.assertIn(b"ticks.jsonl: not whole: File too large", done.stderr)

    def test_a_run_that_does_not_begin_leaves_no_file(self):
        file = self.path("ticks.jsonl")
        with socket.create_server(("127.0.0.1", 0)) as taken:
            self.servo("run", str(LIFT), "--record", file, "--no-log", "--listen", str(taken.getsockname()[1]), code=3)
        self.assertFalse(pathlib.Path(file).exists())
        self.servo("run", str(LIFT), "--record", file, "--log", self.path("no") + "/a.fdcglog", code=3)
        self.assertFalse(pathlib.Path(file).exists())


class Keys(DashboardCase):
    def setUp(self):
        super().setUp()
        self.ours, self.theirs = pty.openpty()
        self.addCleanup(os.close, self.ours)
        self.addCleanup(os.close, self.theirs)
        self.shown = b""
        command = [SERVO, "run", str(LIFT), "--no-log", "--for", "20"]
        self.process = subprocess.Popen(command, stdin=self.theirs, stdout=self.theirs, stderr=self.theirs, start_new_session=True,
                                        preexec_fn=lambda: fcntl.ioctl(0, termios.TIOCSCTTY, 0))
        self.addCleanup(self.process.wait)
        self.addCleanup(self.process.kill)

    def look(self):
        if select.select([self.ours], [], [], 0.1)[0]:
            self.shown += os.read(self.ours, 4096)

    def wait_for(self, words):
        until = time.monotonic() + 15
        while words not in self.shown and time.monotonic() < until:
            self.look()
        self.assertIn(words, self.shown)

    def ends(self):
        until = time.monotonic() + 15
        while self.process.poll() is None and time.monotonic() < until:
            self.look()  # or it would wait for its output to be read
        return self.process.wait(timeout=10)

    def edits_lines(self):
        return bool(termios.tcgetattr(self.theirs)[3] & termios.ICANON)

    def test_space_disarms_at_once_and_the_terminal_is_left_as_it_was(self):
        self.wait_for(b"Not armed")
        time.sleep(0.3)
        self.assertFalse(self.edits_lines())
        os.write(self.ours, b"arx\x7fm\n")  # with a mistake that is taken back
        self.wait_for(b"gripper: armed")
        self.shown = b""
        os.write(self.ours, b" ")
        self.wait_for(b"disarmed: not armed, or disarmed by command")
        os.write(self.ours, b"quit\n")
        self.ends()
        self.assertTrue(self.edits_lines())

    def test_a_crash_leaves_the_terminal_as_it_was(self):
        self.wait_for(b"Not armed")
        time.sleep(0.3)
        self.process.send_signal(signal.SIGSEGV)
        self.assertEqual(-signal.SIGSEGV, self.ends())
        self.assertTrue(self.edits_lines())


if __name__ == "__main__":
    unittest.main()
