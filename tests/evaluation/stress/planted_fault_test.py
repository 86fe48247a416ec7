#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Takes a rule out of a copy of the step, and expects fdcg_stress to find it out, to cut what it found down to a few faces and
ticks, and the whole step to pass what is left.

Environment: FDCG_STRESS (the program), FDCG_ROOT, FDCG_COMPILER, FDCG_WORK (a folder), FDCG_LINK (objects and libraries that make
the program but the watched step, `;` between them).
"""
import os
import pathlib
import shutil
import subprocess
import unittest

FLAGS = ["-std=c++20", "-O2", "-w", "-ffp-contract=off", "-fno-math-errno", "-fno-tree-slp-vectorize", "-fno-exceptions", "-fno-rtti",
         "-Dfdcg_step=fdcg_step_watched"]

# (case, precision, fault, what is taken out, file, the text as it stands, what replaces it, most faces, most ticks)
MUTANTS = [
    ("aimed", "f64", "push-through", "no distance tolerance where contact was lost", "step/sweep.hpp",
     "if (!is_before_best(fraction, n)) return;",
     "if (!is_before_best(fraction, n) || (left_.state != FDCG_FREE && fraction < Real(1e-4))) return;", 16, 8),
    ("open-boundaries", "f64", "off-surface", "a way that grazes a face ends over it", "step/free_space.hpp",
     "const Real over = is_on_face ? sweep.part_over(first.feature.index, first.fraction, 0) : first.fraction;",
     "const Real over = first.fraction + (is_on_face ? Real(0.01) : Real(0));", 4, 6),
]


def run(*command):
    return subprocess.run([str(part) for part in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=280)


def build(number, mutant):
    _, _, _, rule, file, before, after, _, _ = mutant
    root, work = pathlib.Path(os.environ["FDCG_ROOT"]), pathlib.Path(os.environ["FDCG_WORK"]) / str(number)
    shutil.rmtree(work, ignore_errors=True)
    shutil.copytree(root / "runtime/src", work)
    text = (work / file).read_text()
    assert text.count(before) == 1, f"the text of this rule stands {text.count(before)} times in {file}: {rule}"
    (work / file).write_text(text.replace(before, after))
    compiler, stress = os.environ["FDCG_COMPILER"], root / "tests/evaluation/stress"
    subprocess.run([compiler, *FLAGS, "-include", str(stress / "step_watch.hpp"), "-I", str(root / "runtime/include"), "-I", str(root / "runtime"), "-I", str(work), "-c",
                    str(work / "step/servo_step.cpp"), "-o", str(work / "step.o")], check=True)
    subprocess.run([compiler, str(work / "step.o"), *os.environ["FDCG_LINK"].split(";"), "-o", str(work / "stress")], check=True)
    return work, work / "stress"


class PlantedFault(unittest.TestCase):
    def test_each_is_found_and_cut_down(self):
        for number, mutant in enumerate(MUTANTS):
            case, precision, fault, rule, _, _, _, most_faces, most_ticks = mutant
            with self.subTest(rule):
                work, program = build(number, mutant)
                found = run(program, "--case", case, "--precision", precision, "--steps", "2e5", "--output", work / "found")
                self.assertEqual(found.returncode, 1, found.stdout)
                whole = work / "found" / f"{case}-{precision}-{fault}-1.obj"
                self.assertTrue(whole.exists(), found.stdout)
                cut = run(program, "--minimise", whole)
                self.assertEqual(cut.returncode, 0, cut.stdout)
                small = whole.with_suffix(".small.obj")
                lines = small.read_text().splitlines()
                self.assertLessEqual(sum(line.startswith("f ") for line in lines), most_faces, cut.stdout)
                self.assertLessEqual(sum(line.startswith("# hip_m ") for line in lines), most_ticks, cut.stdout)
                self.assertIn("TEST_CASE", whole.with_suffix(".test.cpp").read_text())
                self.assertEqual(run(program, "--replay", small).returncode, 1, "the mutant fails what is left")
                whole_step = run(os.environ["FDCG_STRESS"], "--replay", small)
                self.assertEqual(whole_step.returncode, 0, whole_step.stdout)
                print(cut.stdout.strip())


if __name__ == "__main__":
    unittest.main()
