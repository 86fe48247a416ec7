#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A step that the processor stops is a bar that fails, not a judge that dies: a planted fault divides 0 by 0 where laws trap it.

Environment: FDCG_LAWS (the program), FDCG_MUTANTS (a library with faults planted in it).
"""
import os
import subprocess
import tempfile
import unittest


class Death(unittest.TestCase):
    def test_it_is_told_by_name(self):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([os.environ["FDCG_LAWS"], "--quick", "--only", "energy", "--output", folder], capture_output=True, text=True,
                                  timeout=280, env={**os.environ, "FDCG_MUTANT": "along-side", "FDCG_JUDGED_LIBRARY": os.environ["FDCG_MUTANTS"]})
        self.assertEqual(1, done.returncode, done.stdout + done.stderr)
        self.assertRegex(done.stdout, r"(?m)^FAIL step divides by zero, overflows or makes a NaN of finite numbers: signal 8$")


if __name__ == "__main__":
    unittest.main()
