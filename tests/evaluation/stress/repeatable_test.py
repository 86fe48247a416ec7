#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The run's hash depends on the seed alone: not on the run, not on the threads; and one block can be repeated by its name.

Environment: FDCG_STRESS (the program), FDCG_WORK (a folder).
"""
import csv
import os
import pathlib
import subprocess
import unittest


def table(name, *options):
    folder = pathlib.Path(os.environ["FDCG_WORK"]) / name
    subprocess.run([os.environ["FDCG_STRESS"], "--output", str(folder), *options], stdout=subprocess.DEVNULL, timeout=280)
    with open(folder / "stress_cases.csv", newline="") as file:
        return [{k: v for k, v in row.items() if k != "seconds"} for row in csv.DictReader(file)]


class Repeatable(unittest.TestCase):
    def test_two_runs_on_one_and_on_two_threads_are_the_same(self):
        for case in ("tremor", "encoder"):
            once = table("once", "--case", case, "--steps", "4e5")
            self.assertEqual(once, table("again", "--case", case, "--steps", "4e5", "--threads", "2"))
            self.assertEqual(len(once), 2)

    def test_another_seed_and_another_block_are_another_run(self):
        hashes = [table("block", "--case", "encoder", "--precision", "f64", *rest)[0]["hash"]
                  for rest in (["--block", "0"], ["--block", "1"], ["--block", "0", "--seed", "2"], ["--block", "0"])]
        self.assertEqual(len(set(hashes)), 3)
        self.assertEqual(hashes[0], hashes[3])


if __name__ == "__main__":
    unittest.main()
