# SPDX-License-Identifier: Apache-2.0
"""The table of hazards in docs/safety.md: each row names tests that exist, and every fault of the gate has a row."""
import os
import pathlib
import re
import unittest

ROOT = pathlib.Path(os.environ["FDCG_ROOT"])
PAGE = ROOT / "docs" / "safety.md"


def rows():
    table = re.search(r"^\| hazard \|.*?\n\n", PAGE.read_text(), re.M | re.S)[0].splitlines()
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in table[2:] if line]


def tests():
    """Names of Catch2 cases and of Python's test methods."""
    names = set()
    for file in (ROOT / "tests").rglob("*_test.cpp"):
        names |= set(re.findall(r'TEST_CASE\("([^"]+)"', file.read_text()))
    for file in (ROOT / "tests").rglob("*_test.py"):
        names |= set(re.findall(r"def (test_\w+)", file.read_text()))
    return names


class Hazards(unittest.TestCase):
    def test_each_row_names_tests_that_exist(self):
        known = tests()
        self.assertGreater(len(rows()), 25)
        for row in rows():
            with self.subTest(cause=row[1]):
                self.assertEqual(7, len(row))
                named = re.findall(r"`([^`]+)`", row[5])
                self.assertTrue(named)
                self.assertEqual([], [name for name in named if name not in known])

    def test_every_fault_has_a_row(self):
        words = re.search(r"kWords\[kFaults\] = \{(.*?)\n\};", (ROOT / "runtime/device/src/tick/gate.cpp").read_text(), re.S)[1]
        faults = set(re.findall(r'\{"([\w-]+)", ', words)) - {"none"}
        self.assertGreater(len(faults), 15)
        told = set(re.findall(r"`([\w-]+)`", " ".join(cell for row in rows() for cell in row[2:4] + [row[6]])))
        self.assertEqual(set(), faults - told)


if __name__ == "__main__":
    unittest.main()
