#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""fdcg_bench_accuracy --first ends at the first run that fails a bar by itself, and says which; without a fault it goes on to the end.

Environment: FDCG_ACCURACY (the program), FDCG_MUTANTS (a library with faults planted in it).
"""
import os
import pathlib
import subprocess
import tempfile
import unittest


class First(unittest.TestCase):
    def tried(self, fault):
        """The run, and whether it went on to the search, which is last."""
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([os.environ["FDCG_ACCURACY"], "--quick", "--first", "--body", "cube", "--output", folder], capture_output=True,
                                  text=True, timeout=280, env={**os.environ, "FDCG_MUTANT": fault, "FDCG_JUDGED_LIBRARY": os.environ["FDCG_MUTANTS"]})
            return done, (pathlib.Path(folder) / "god_object_search.csv").exists()

    def test_a_wrong_force_ends_it_by_name(self):
        done, has_searched = self.tried("force-negated")
        self.assertEqual(1, done.returncode, done.stdout + done.stderr)
        self.assertRegex(done.stdout, r"(?m)^FAIL f(32|64) against long double replay, wrong features: ")
        self.assertFalse(has_searched)

    def test_without_a_fault_all_is_run(self):
        done, has_searched = self.tried("")
        self.assertEqual(0, done.returncode, done.stdout + done.stderr)
        self.assertTrue(has_searched)


if __name__ == "__main__":
    unittest.main()
