#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Progress bars: on a terminal, of work over a second, gone at the end; nothing where standard error is no terminal."""
import os
import pty
import select
import subprocess
import time
import unittest

from support import CUBE, FDCG, SERVO, Case

PAUSE = 1.3  # seconds: longer than work that shows no bar


class OnATerminal(Case):
    def start(self, *command, **options):
        """The program with a terminal for its standard error, and our end of that."""
        ours, theirs = pty.openpty()
        self.addCleanup(os.close, ours)
        program = subprocess.Popen(command, stderr=theirs, stdout=subprocess.DEVNULL, **options)
        self.addCleanup(program.wait)
        self.addCleanup(program.kill)
        if program.stdin:
            self.addCleanup(program.stdin.close)
        os.close(theirs)
        return program, ours

    def read(self, ours, until, seconds=120):
        text, end = b"", time.monotonic() + seconds
        while time.monotonic() < end and not until(text):
            if not select.select([ours], [], [], 0.1)[0]:
                continue
            try:
                got = os.read(ours, 4096)
            except OSError:  # the other end is closed
                break
            if not got:
                break
            text += got
        return text

    def shown_for(self, command, data, pause):
        """What the terminal gets from a program that waits for its input."""
        program, ours = self.start(*command, stdin=subprocess.PIPE)
        time.sleep(pause)
        program.stdin.write(data)
        program.stdin.close()
        text = self.read(ours, lambda _: False)
        self.assertEqual(0, program.wait())
        return text

    def commands_that_wait(self):
        graph = self.compiled_cube()
        with open(graph, "rb") as file:
            yield (FDCG, "inspect", "--verify", "-"), file.read(), b"%  verify the file"
        with open(self.slide(9000), "rb") as file:
            yield (SERVO, "replay", graph, "--trajectory", "-"), file.read(), b"%  replay"

    def test_long_work_shows_how_far_it_is_and_wipes_it(self):
        for command, data, words in self.commands_that_wait():
            with self.subTest(command=command[1]):
                text = self.shown_for(command, data, PAUSE)
                self.assertIn(words, text)
                self.assertTrue(text.endswith(b"\r\x1b[K"), text[-40:])

    def test_short_work_shows_nothing(self):
        for command, data, _ in self.commands_that_wait():
            with self.subTest(command=command[1]):
                self.assertEqual(b"", self.shown_for(command, data, 0))

    def test_quiet_shows_nothing(self):
        command, data, _ = list(self.commands_that_wait())[1]
        self.assertEqual(b"", self.shown_for((*command, "-q"), data, PAUSE))

    def test_a_search_for_epsilon_shows_how_far_it_is(self):
        mesh = self.write("cube.off", CUBE)
        contacts = self.write("c.csv", "x,y,z\n0,0.5,0.5\n1,0.5,0.5\n0.5,0,0.5\n0.5,1,0.5\n")
        _, ours = self.start(FDCG, "grasp", mesh, "--contacts", contacts, "--mu", "0.5", "--torsion", "0.01", "--cones", "100000000",
                             stdin=subprocess.DEVNULL)
        self.assertIn(b"search for epsilon", self.read(ours, lambda text: b"search for epsilon" in text))


class ElsewhereNothing(Case):
    def test_a_pipe_gets_no_bar(self):
        graph = self.compiled_cube()
        program = subprocess.Popen((FDCG, "inspect", "--verify", "-"), stdin=subprocess.PIPE, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.PIPE)
        time.sleep(PAUSE)
        with open(graph, "rb") as file:
            _, error = program.communicate(file.read(), timeout=60)
        self.assertEqual(b"", error)
        self.assertEqual(0, program.returncode)


if __name__ == "__main__":
    unittest.main()
