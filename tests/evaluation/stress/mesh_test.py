#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""fdcg_stress --mesh: what is inside is judged only where the mesh tells it; all else is judged of any mesh, and a fault is found.

Environment: FDCG_STRESS (the program), FDCG_MUTANTS (a library with faults planted in it), FDCG_WORK (a folder).
"""
import csv
import os
import pathlib
import subprocess
import unittest

FACES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]  # of a box, outwards


def boxes(*bounds, faces=6):
    """An OFF file of boxes, (low, high) each; of the last only so many faces."""
    points = [(x, y, z) for low, high in bounds for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])]
    loops = [[8 * b + v for v in face] for b in range(len(bounds)) for face in FACES[:faces if b == len(bounds) - 1 else 6]]
    lines = ["OFF", f"{len(points)} {len(loops)} 0", *(f"{x} {y} {z}" for x, y, z in points)]
    return "\n".join(lines + [" ".join(map(str, [len(loop), *loop])) for loop in loops]) + "\n"


UNIT = ((0, 0, 0), (1, 1, 1))


class Mesh(unittest.TestCase):
    def stress(self, name, text, mutant=""):
        folder = pathlib.Path(os.environ["FDCG_WORK"]) / (name + mutant)
        folder.mkdir(parents=True, exist_ok=True)
        mesh = folder / "mesh.off"
        mesh.write_text(text)
        planted = {"FDCG_MUTANT": mutant, "FDCG_JUDGED_LIBRARY": os.environ["FDCG_MUTANTS"]} if mutant else {}
        done = subprocess.run([os.environ["FDCG_STRESS"], "--mesh", mesh, "--steps", "1.6e5", "--output", folder],
                              stdout=subprocess.PIPE, text=True, timeout=280, env={**os.environ, **planted})
        notes = [line.removeprefix(f"{mesh}: ") for line in done.stdout.splitlines() if line.endswith("is not judged")]
        with open(folder / "stress_cases.csv", newline="") as file:
            return done, notes, list(csv.DictReader(file))

    def test_a_mesh_that_tells_its_inside_is_judged_so(self):
        for name, text in {"cube": boxes(UNIT), "apart": boxes(UNIT, ((2, 0, 0), (3, 1, 1)))}.items():
            done, notes, _ = self.stress(name, text)
            self.assertEqual((done.returncode, notes), (0, []), done.stdout)

    def test_of_one_that_does_not_the_inside_is_not_judged(self):
        meshes = {
            "crossing": (boxes(UNIT, ((.5, .25, .3), (1.75, 1.5, .8))), "faces cross or touch"),
            "touching": (boxes(UNIT, ((1, .25, .3), (1.75, 1.5, 1))), "faces cross or touch"),
            "open": (boxes(UNIT, faces=5), "it is open"),
            "nested": (boxes(((-4, -4, -4), (4, 4, 4)), UNIT), "faces look inwards"),
        }
        for name, (text, why) in meshes.items():
            with self.subTest(name):
                done, notes, _ = self.stress(name, text)
                self.assertEqual(notes, [f"{why} (f64, f32): what is inside is not judged"], done.stdout)
                self.assertEqual(done.returncode, 0, done.stdout)

    def test_what_needs_no_inside_is_judged_all_the_same(self):
        crossing = boxes(UNIT, ((.5, .25, .3), (1.75, 1.5, .8)))
        for mutant, column in (("corner-never-left", "pulls"), ("edge-never-left", "restless"), ("force-negated", "force"),
                               ("friction-off-once", "friction")):
            with self.subTest(mutant):
                done, _, rows = self.stress("crossing", crossing, mutant)
                self.assertEqual(done.returncode, 1, done.stdout)
                self.assertTrue(any(int(row[column]) > 0 for row in rows), done.stdout)


if __name__ == "__main__":
    unittest.main()
