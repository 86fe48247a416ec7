#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The guard's judgement on programs of known figures, and on a runtime that was made slower on purpose."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
FIGURE = "step cube 12 f64 hand p50"


def guard(*arguments):
    return subprocess.run([sys.executable, "-B", str(HERE / "guard.py"), *map(str, arguments)], stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, text=True)


class Judgement(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = pathlib.Path(self.folder.name)

    def program(self, name, lines, body=""):
        """A program that prints these lines, those asked for by --figure alone; `body` may change `lines` before."""
        path = self.path / name
        path.write_text(f"#!{sys.executable}\nimport pathlib, sys\nlines = {lines!r}\nasked = sys.argv[2::2]\n{body}\n"
                        "print('\\n'.join(l for l in lines if not asked or l.split(',')[0] in asked))\n")
        path.chmod(0o755)
        return path

    def run_guard(self, base, head):
        done = guard("--base-program", base, "--head-program", head, "--rounds", 2, "--output", self.path / "out")
        table = (self.path / "out/guard.csv").read_text() if (self.path / "out/guard.csv").exists() else ""
        return done, table

    def test_the_same_passes(self):
        base = self.program("base", ["a,ns,100", "b,s,0.5", "c,bytes,1000000"])
        done, table = self.run_guard(base, base)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("a,ns,100,100,0.000,10,5,ok", table)

    def test_past_both_limits_is_a_regression(self):
        done, table = self.run_guard(self.program("base", ["a,ns,100", "b,ns,100"]), self.program("head", ["a,ns,111", "b,ns,109"]))
        self.assertEqual(done.returncode, 1)
        self.assertIn("measured again: a\n", done.stdout)
        self.assertIn("a,ns,100,111,11.000,10,5,REGRESSION", table)
        self.assertIn("b,ns,100,109,9.000,10,5,ok", table)

    def test_past_one_limit_is_none(self):
        done, _ = self.run_guard(self.program("base", ["a,ns,10", "b,s,100"]), self.program("head", ["a,ns,14.9", "b,s,109"]))
        self.assertEqual(done.returncode, 0, done.stdout)

    def test_a_figure_that_is_slow_but_once_is_not_flagged(self):
        marker = self.path / "runs"
        once = (f"p = pathlib.Path({str(marker)!r})\nn = int(p.read_text()) if p.exists() else 0\np.write_text(str(n + 1))\n"
                "lines = ['a,ns,200'] if n < 2 else lines")  # slow in both rounds of the first look
        done, table = self.run_guard(self.program("base", ["a,ns,100"]), self.program("head", ["a,ns,100"], once))
        self.assertIn("measured again: a", done.stdout)
        self.assertEqual(done.returncode, 0, table)

    def test_bytes_are_exact(self):
        done, table = self.run_guard(self.program("base", ["f,bytes,10000"]), self.program("head", ["f,bytes,10065"]))
        self.assertEqual(done.returncode, 1, table)

    def test_lost_and_new_figures_are_told(self):
        done, table = self.run_guard(self.program("base", ["a,ns,1", "b,ns,1"]), self.program("head", ["b,ns,1", "c,ns,1"]))
        self.assertEqual(done.returncode, 1)
        self.assertRegex(table, "(?m)^a,ns,1,nan,.*LOST")
        self.assertRegex(table, "(?m)^c,ns,nan,1,.*new")

    def test_better_is_said(self):
        done, table = self.run_guard(self.program("base", ["a,ns,100"]), self.program("head", ["a,ns,50"]))
        self.assertEqual(done.returncode, 0)
        self.assertIn("better", table)

    def test_a_program_that_fails_is_an_error(self):
        done, _ = self.run_guard(self.program("base", ["a,ns,1"], "sys.exit(3)"), self.program("head", ["a,ns,1"]))
        self.assertEqual(done.returncode, 2)
        self.assertIn("base: ", done.stderr)

    def test_wrong_usage(self):
        self.assertEqual(guard().returncode, 2)
        self.assertEqual(guard("--against", "HEAD", "--base-program", "x", "--head-program", "y").returncode, 2)


class PlantedSlowdown(unittest.TestCase):
    """The measuring program on the runtime as it is and on a copy that idles in every step."""

    def setUp(self):
        self.program = pathlib.Path(os.environ["FDCG_GUARD"])
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = pathlib.Path(self.folder.name)

    def only_one_figure(self, program, name, mutant=""):
        """The test is of the guard, not of every figure: one is enough, and quick."""
        wrapper = self.path / name
        wrapper.write_text(f"#!/bin/sh\nFDCG_MUTANT='{mutant}' exec '{program}' --figure '{FIGURE}'\n")
        wrapper.chmod(0o755)
        return wrapper

    def compare(self, head, mutant=""):
        return guard("--base-program", self.only_one_figure(self.program, "base"), "--head-program",
                     self.only_one_figure(head, "head", mutant), "--rounds", 3, "--output", self.path)

    def test_the_same_program_passes(self):
        done = self.compare(self.program)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn(FIGURE, done.stdout)

    def test_a_step_with_a_delay_is_flagged(self):
        done = self.compare(os.environ["FDCG_GUARD_MUTANTS"], "slow")
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        self.assertRegex(done.stdout, FIGURE + ".*REGRESSION")


if __name__ == "__main__":
    unittest.main()
