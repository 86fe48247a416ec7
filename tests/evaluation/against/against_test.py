#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A build beside itself, and builds that are none."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
BUILD = os.environ["FDCG_BUILD"]


def against(base, *options):
    command = [sys.executable, "-B", HERE / "against.py", "--base", base, "--head", BUILD, "--ways", os.environ["FDCG_AGAINST_WAYS"], *options]
    return subprocess.run(list(map(str, command)), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


class Against(unittest.TestCase):
    def test_a_build_beside_itself(self):
        done = against(BUILD, "--bodies", "12", "--ticks", "4000", "--rounds", "3")
        self.assertIn(done.returncode, (0, 1), done.stderr)  # times are not judged beside other work
        rows = [line.split() for line in done.stdout.splitlines()[1:]]
        self.assertEqual(["0.02", "0.05", "0.1", "0.2", "0.5", "1"], [row[1] for row in rows])
        for row in rows:
            self.assertGreater(float(row[2]), 0.5)  # in contact most of the time
            for time in (row[4], row[5], row[8], row[9]):
                self.assertGreater(float(time), 1)
            self.assertGreater(float(row[6]), 0.3)
            self.assertLess(float(row[6]), 3)

    def test_a_folder_that_is_no_build(self):
        with tempfile.TemporaryDirectory() as folder:
            done = against(folder)
            self.assertEqual(2, done.returncode)
            self.assertIn("CMakeCache.txt is missing", done.stderr)
            pathlib.Path(folder, "CMakeCache.txt").write_text(f"CMAKE_HOME_DIRECTORY:INTERNAL={HERE.parents[2]}\n")
            done = against(folder)
            self.assertEqual(2, done.returncode)
            self.assertRegex(done.stderr, "no runtime library; build it: cmake --build .* --target fdcg_runtime fdcg")


if __name__ == "__main__":
    unittest.main()
