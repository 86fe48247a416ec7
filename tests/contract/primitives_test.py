#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Cylinders, prisms, cones, gears and tubes through the programs: compile, inspect --verify, repair, and compile again."""
import json
import math
import unittest

from support import Case

SIDES = (3, 4, 5, 7, 8, 15, 16, 17, 31, 32, 33, 64, 100, 127, 128, 199, 200)


def ring(sides, radius, z, odd_radius=None):
    radii = (radius, radius if odd_radius is None else odd_radius)
    return [(round(radii[i % 2] * math.cos(math.tau * i / sides), 6), round(radii[i % 2] * math.sin(math.tau * i / sides), 6), z)
            for i in range(sides)]


def wall(sides, low, high):
    return [(low + i, low + (i + 1) % sides, high + (i + 1) % sides, high + i) for i in range(sides)]


def prism(sides, height=1.6, odd_radius=None):
    points = ring(sides, 0.5, -height / 2, odd_radius) + ring(sides, 0.5, height / 2, odd_radius)
    caps = [tuple(reversed(range(sides))), tuple(range(sides, 2 * sides))]
    return points, wall(sides, 0, sides) + caps


def cylinder(sides):
    points, faces = prism(sides)
    fans = [(2 * sides, (i + 1) % sides, i) for i in range(sides)]
    fans += [(2 * sides + 1, sides + i, sides + (i + 1) % sides) for i in range(sides)]
    return points + [(0, 0, -0.8), (0, 0, 0.8)], faces[:sides] + fans


def cone(sides):
    sheets = [(i, (i + 1) % sides, sides) for i in range(sides)]
    return ring(sides, 0.5, -0.5) + [(0, 0, 0.5)], sheets + [tuple(reversed(range(sides)))]


def tube(sides):
    points = ring(sides, 0.5, -1) + ring(sides, 0.5, 1) + ring(sides, 0.3, -1) + ring(sides, 0.3, 1)
    return points, [face for a, b in ((0, 1), (1, 3), (3, 2), (2, 0)) for face in wall(sides, a * sides, b * sides)]


FAMILIES = {"prism": prism, "disc": lambda n: prism(n, 1e-3), "gear": lambda n: prism(n, 0.2, 0.35), "cylinder": cylinder, "cone": cone,
            "tube": tube}


def off(points, faces, axis):
    turned = [(p[(0 - axis) % 3], p[(1 - axis) % 3], p[(2 - axis) % 3]) for p in points]
    lines = [f"{len(points)} {len(faces)} 0"] + [" ".join(map(str, p)) for p in turned]
    return "OFF\n" + "\n".join(lines + [" ".join(map(str, (len(face), *face))) for face in faces]) + "\n"


class Families(Case):
    def verified(self, mesh):
        graph = self.path("part.fdcg")
        self.fdcg("compile", mesh, "-o", graph, "-q")
        about = json.loads(self.fdcg("inspect", "--verify", "--json", graph).stdout)
        self.assertTrue(about["verification"]["passed"])
        return about["mass"]["volume_m3"]

    def test_whole_ones_and_ones_without_a_common_point(self):
        for number, (name, family) in enumerate(FAMILIES.items()):
            for sides in SIDES:
                axis = (number + sides) % 3
                with self.subTest(family=name, sides=sides, axis=axis):
                    points, faces = family(sides)
                    mesh = self.write("part.off", off(points, faces, axis))
                    volume = self.verified(mesh)
                    self.assertGreater(volume, 0)
                    loose = [points[corner] for face in faces for corner in face]
                    starts = [sum(len(face) for face in faces[:f]) for f in range(len(faces))]
                    own = [tuple(range(start, start + len(face))) for start, face in zip(starts, faces)]
                    own = [face[::-1] if f % 3 == 1 else face for f, face in enumerate(own)] + own[:1]
                    self.write("loose.off", off(loose, own, axis))
                    self.fdcg("repair", "--all", self.path("loose.off"), "-o", self.path("mended.off"), "-q")
                    self.assertAlmostEqual(1, self.verified(self.path("mended.off")) / volume, delta=1e-12)


if __name__ == "__main__":
    unittest.main()
