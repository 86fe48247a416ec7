# SPDX-License-Identifier: Apache-2.0
"""Those who judge the step include nothing of the runtime but its public headers, nor does anything that they include: else they
would share its rules, and its faults."""
import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
TESTS = ROOT / "tests"
JUDGES = [TESTS / "reference", *(TESTS / "evaluation" / name for name in ("accuracy", "closed_loop", "judged", "laws", "stress"))]
SEARCHED = [TESTS / "support", TESTS / "reference", *(TESTS / "evaluation" / name for name in ("judged", "accuracy", "closed_loop", "stress", "support"))]
PUBLIC = [ROOT / "runtime" / "include", ROOT / "lib" / "include"]
SEAT, MAY_SEAT = "step/contact_internals.hpp", (TESTS / "reference", TESTS / "support")
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*"([^"\n]+)"', re.M)


def foreign_includes(files):
    """{(included, file)}, of what is neither a test's file nor a public header."""
    foreign, seen, waiting = set(), set(), list(files)
    while waiting:
        file = waiting.pop()
        if file in seen:
            continue
        seen.add(file)
        for name in INCLUDE.findall(file.read_text(encoding="utf-8")):
            found = next((folder / name for folder in [file.parent, *SEARCHED, *PUBLIC] if (folder / name).exists()), None)
            if found is None:
                foreign.add((name, file))
            elif TESTS in found.parents:
                waiting.append(found)
    return foreign, seen


class Judges(unittest.TestCase):
    # The replay takes up the contact where it is: its seat is not public.
    def test_include_nothing_of_the_runtime_but_its_public_headers(self):
        files = [f for folder in JUDGES for f in folder.iterdir() if f.suffix in (".cpp", ".hpp")]
        foreign, seen = foreign_includes(files)
        self.assertGreater(len(seen), 60)
        found = [(name, str(file.relative_to(ROOT))) for name, file in foreign if name != SEAT or file.parent not in MAY_SEAT]
        self.assertEqual(found, [])

    def test_a_private_header_is_found_out(self):
        foreign, _ = foreign_includes([ROOT / "tests" / "evaluation" / "mutation" / "outer_faults.cpp"])
        self.assertIn("base/mutation.hpp", {name for name, _ in foreign})


if __name__ == "__main__":
    unittest.main()
