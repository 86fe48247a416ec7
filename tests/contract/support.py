# SPDX-License-Identifier: Apache-2.0
"""Runs the real programs for the contract tests. FDCG, FDCG_SERVO and FDCG_ROOT name them and the project's root."""
import math
import os
import pathlib
import signal
import struct
import subprocess
import tempfile
import unittest

FDCG = os.environ["FDCG"]
SERVO = os.environ["FDCG_SERVO"]
ROOT = pathlib.Path(os.environ["FDCG_ROOT"])

# A shell that starts tests in the background ignores these in them, and what is ignored stays so in the programs that they run.
signal.signal(signal.SIGINT, signal.default_int_handler)
for number in (signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT):
    signal.signal(number, signal.SIG_DFL)

TETRAHEDRON = "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n"
CUBE = """OFF
8 6 0
0 0 0
1 0 0
1 1 0
0 1 0
0 0 1
1 0 1
1 1 1
0 1 1
4 0 3 2 1
4 4 5 6 7
4 0 1 5 4
4 1 2 6 5
4 2 3 7 6
4 3 0 4 7
"""


def checksum(data):
    """As schemas/fdcg-v1.md has it, written from there."""
    mask, multiplier, seed = 2**64 - 1, 0x9E3779B97F4A7C15, 0x4644434700000003

    def spread(lane, factor):
        return lane + (lane & 0xFFFFFFFF) * (factor - 1) & mask

    def absorbed(lane, word):
        once = spread(lane ^ word, 0x9E3779B1)
        return spread((once << 32 | once >> 32) & mask, 0x85EBCA77)

    total = seed + len(data) * multiplier & mask
    for index, at in enumerate(range(0, len(data), 4096)):
        block = data[at:at + 4096]
        lanes = [seed + i * multiplier & mask for i in range(16)]
        for words in struct.iter_unpack("<16Q", block + bytes(-len(block) % 128)):
            lanes = [absorbed(lane, word) for lane, word in zip(lanes, words)]
        one = seed ^ len(block)
        for lane in lanes:
            one = absorbed(one, lane)
        one = (one + index * multiplier) * multiplier & mask
        total = total + (one ^ one >> 32) * multiplier & mask
    return total


class Case(unittest.TestCase):
    """A folder of its own, and the checks that every command shares."""

    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def write(self, name, content):
        path = self.folder / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return str(path)

    def path(self, name):
        return str(self.folder / name)

    def run_program(self, *command, code=0, **options):
        done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, timeout=400, check=False, **options)
        self.assertEqual(code, done.returncode, f"{command}\nstdout: {done.stdout[:2000]}\nstderr: {done.stderr[:2000]}")
        return done

    def fdcg(self, *arguments, code=0, **options):
        return self.run_program(FDCG, *arguments, code=code, **options)

    def servo(self, *arguments, code=0, **options):
        return self.run_program(SERVO, *arguments, code=code, **options)

    def assert_one_line(self, done, *words):
        text = done.stderr.decode()
        self.assertEqual(1, text.count("\n"), text)
        self.assertTrue(text.endswith("\n"))
        for word in words:
            self.assertIn(word, text)

    def assert_only(self, *names):
        self.assertEqual(sorted(names), sorted(entry.name for entry in self.folder.iterdir()))

    def compiled_cube(self, *options):
        mesh = self.write("cube.off", CUBE)
        graph = self.path("cube.fdcg")
        self.fdcg("compile", mesh, "-o", graph, "-q", *options)
        return graph

    def slide(self, ticks=400):
        """A path that comes down on the unit cube's top, slides, and goes round its edge."""
        rows = ["t,x,y,z"]
        for i in range(ticks):
            part = i / ticks
            rows.append(f"{i / 1000},{0.3 + 0.9 * part},{0.5 + 0.1 * math.sin(9 * part)},{1.05 - 0.2 * min(1, 4 * part)}")
        return self.write("hip.csv", "\n".join(rows) + "\n")
