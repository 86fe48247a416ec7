#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Takes a rule out of the step, and expects fdcg_stress to find it out, to cut what it found down to a few faces and ticks, and the
whole step to pass what is left.

Environment: FDCG_STRESS (the program), FDCG_MUTANTS (a library with faults planted in it), FDCG_WORK (a folder).
"""
import os
import pathlib
import shutil
import subprocess
import unittest

# (case, precision, fault, name of the mutant, what is taken out, most faces, most ticks)
MUTANTS = [
    ("aimed", "f64", "push-through", "distance-tolerance", "no distance tolerance where contact was lost", 16, 8),
    ("open-boundaries", "f64", "off-surface", "grazing", "a way that grazes a face ends over it", 4, 6),
]

FOUND = pathlib.Path(__file__).parent / "found"
# (name of the mutant, what is taken out, what it brings back)
REPLAYED = [
    ("along-side", "a way that ends on a side's plane crosses it where it ends", "leaves_a_face_narrower_than_a_rounding.obj"),
    ("circle-at-corner", "a circle about a corner goes on there", "along_the_plane_of_a_pits_wall.obj"),
    ("ends-on-plane", "a target on a side's plane but for rounding is on the side", "onto_the_rim_of_a_plate_and_on.obj"),
]


def run(*command, mutant=""):
    judged = {"FDCG_MUTANT": mutant, "FDCG_JUDGED_LIBRARY": os.environ["FDCG_MUTANTS"]} if mutant else {}
    return subprocess.run([str(part) for part in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=280,
                          env={**os.environ, **judged})


class PlantedFault(unittest.TestCase):
    def test_each_is_found_and_cut_down(self):
        program = os.environ["FDCG_STRESS"]
        for case, precision, fault, mutant, rule, most_faces, most_ticks in MUTANTS:
            with self.subTest(rule):
                work = pathlib.Path(os.environ["FDCG_WORK"]) / mutant
                shutil.rmtree(work, ignore_errors=True)
                found = run(program, "--case", case, "--precision", precision, "--steps", "2e5", "--output", work / "found",
                            mutant=mutant)
                self.assertEqual(found.returncode, 1, found.stdout)
                whole = work / "found" / f"{case}-{precision}-{fault}-1.obj"
                self.assertTrue(whole.exists(), found.stdout)
                cut = run(program, "--minimise", whole, mutant=mutant)
                self.assertEqual(cut.returncode, 0, cut.stdout)
                small = whole.with_suffix(".small.obj")
                lines = small.read_text().splitlines()
                self.assertLessEqual(sum(line.startswith("f ") for line in lines), most_faces, cut.stdout)
                self.assertLessEqual(sum(line.startswith("# hip_m ") for line in lines), most_ticks, cut.stdout)
                self.assertIn("TEST_CASE", whole.with_suffix(".test.cpp").read_text())
                self.assertEqual(run(program, "--replay", small, mutant=mutant).returncode, 1, "the mutant fails what is left")
                whole_step = run(program, "--replay", small)
                self.assertEqual(whole_step.returncode, 0, whole_step.stdout)
                print(cut.stdout.strip())

    def test_what_was_found_comes_back_without_its_rule(self):
        for mutant, rule, file in REPLAYED:
            with self.subTest(rule):
                program = os.environ["FDCG_STRESS"]
                self.assertEqual(run(program, "--replay", FOUND / file, mutant=mutant).returncode, 1)
                self.assertEqual(run(program, "--replay", FOUND / file).returncode, 0)


if __name__ == "__main__":
    unittest.main()
