# SPDX-License-Identifier: Apache-2.0
"""docs/internals/contact-model.md says enough to write the step anew: model_walker.py, which follows it rule by rule, and the programs
agree on state, slip, transitions and god-object at every tick of random ways over closed, concave, saddle-rich and
open meshes."""
import csv
import itertools
import math
import os
import pathlib
import random
import subprocess
import tempfile
import unittest

from model_walker import Graph, Walker, minus, norm

FDCG, FDCG_SERVO = os.environ["FDCG"], os.environ["FDCG_SERVO"]
STATES = ("free", "face", "edge", "vertex")
TICKS = 1500
SEED = 20041101
MOST_OFF = 1e-13  # of meshes of size 1: some hundred roundings, along different sums
FRICTION = ((0, 0), (0.6, 0.4), (2, 1))


def cube():
    points = [tuple(map(float, p)) for p in itertools.product((-1, 1), repeat=3)]
    quads = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
    return points, [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]


def angle_iron():
    """A prism over an L: it has one groove."""
    outline = ((-1, -1), (1, -1), (1, 0), (0, 0), (0, 1), (-1, 1))
    points = [(float(x), float(y), z) for z in (-0.5, 0.5) for x, y in outline]
    caps = ((0, 1, 3), (1, 2, 3), (0, 3, 5), (3, 4, 5))
    faces = [t[::-1] for t in caps] + [tuple(i + 6 for i in t) for t in caps]
    for i in range(6):
        j = (i + 1) % 6
        faces += [(i, j, j + 6), (i, j + 6, i + 6)]
    return points, faces


def spiky_ball(rng, cuts=3):
    """An octahedron cut up, each vertex at a radius of its own: ridges, grooves and saddles."""
    index, points, faces = {}, [], []

    def vertex(p):
        if p not in index:
            index[p] = len(points)
            radius = rng.uniform(0.4, 1.3) / math.sqrt(sum(c * c for c in p))
            points.append(tuple(radius * c for c in p))
        return index[p]

    for sx, sy, sz in itertools.product((1, -1), repeat=3):
        def at(i, j):
            return vertex((sx * i, sy * j, sz * (cuts - i - j)))
        for i in range(cuts):
            for j in range(cuts - i):
                triangles = [(at(i, j), at(i + 1, j), at(i, j + 1))]
                if i + j + 2 <= cuts:
                    triangles.append((at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)))
                faces += [t if sx * sy * sz > 0 else t[::-1] for t in triangles]
    return points, faces


def sheet(rng, cuts=5):
    points = [(i / 2 - 1, j / 2 - 1, rng.uniform(-0.3, 0.3)) for i in range(cuts) for j in range(cuts)]
    corners = [i * cuts + j for i in range(cuts - 1) for j in range(cuts - 1)]
    return points, [t for c in corners for t in ((c, c + cuts, c + cuts + 1), (c, c + cuts + 1, c + 1))]


def random_way(rng, ticks):
    """Steps of 3e-4 to 0.25, drawn to the middle, and now and then a jump across the whole object."""
    hip = [0.0, 0.0, 3.0]
    for _ in range(ticks):
        if rng.random() < 0.004:
            hip = [rng.uniform(-1.6, 1.6) for _ in range(3)]
        else:
            step = 10 ** rng.uniform(-3.5, -0.6)
            hip = [0.985 * x + rng.gauss(0, 1) * step for x in hip]
        yield tuple(hip)


def replay(folder, mesh, way, mu, edge_friction):
    """The programs' log of a way."""
    points, faces = mesh
    off, graph, hips, log = (str(folder / name) for name in ("mesh.off", "mesh.fdcg", "hip.csv", "log.csv"))
    lines = [f"OFF\n{len(points)} {len(faces)} 0"] + ["%r %r %r" % p for p in points] + ["3 %d %d %d" % f for f in faces]
    pathlib.Path(off).write_text("\n".join(lines) + "\n")
    pathlib.Path(hips).write_text("t,x,y,z\n" + "".join(f"{i / 1000!r},{x!r},{y!r},{z!r}\n" for i, (x, y, z) in enumerate(way)))
    subprocess.run([FDCG, "compile", off, "-o", graph, "-q", "--coplanar", "exact", "--no-merge"], check=True, capture_output=True)
    subprocess.run([FDCG_SERVO, "replay", graph, "--trajectory", hips, "-o", log, "--mu-s", str(mu[0]), "--mu-d", str(mu[1]),
                    "--edge-friction", edge_friction], check=True, capture_output=True)
    with open(log) as rows:
        return list(csv.DictReader(rows))


def first_difference(log, walker, way):
    """The tick at which a walker and the programs part, and how; None: nowhere. And the states it has seen."""
    seen = set()
    for tick, (row, hip) in enumerate(zip(log, way, strict=True)):
        state, transitions = walker.tick(hip)
        seen.add(STATES[state])
        here = (STATES[state], transitions, int(walker.is_slipping))
        there = (row["state"], int(row["transitions"]), int(row["slip"]))
        off = norm(minus(walker.god_object, tuple(float(row["go_" + k]) for k in "xyz")))
        if here != there or off > MOST_OFF:
            return (tick, here, there, off), seen
    return None, seen


class Model(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def test_a_step_written_from_the_page_agrees_at_every_tick(self):
        rng = random.Random(SEED)
        seen = set()
        for name, mesh in (("cube", cube()), ("angle iron", angle_iron()), ("spiky ball", spiky_ball(rng)), ("sheet", sheet(rng))):
            for mu, edge_friction in itertools.product(FRICTION, ("wedge", "paper") if name == "angle iron" else ("wedge",)):
                with self.subTest(mesh=name, mu=mu, edge_friction=edge_friction):
                    way = list(random_way(rng, TICKS))
                    log = replay(self.folder, mesh, way, mu, edge_friction)
                    difference, states = first_difference(log, Walker(Graph(*mesh), *mu, edge_friction == "wedge"), way)
                    self.assertIsNone(difference)
                    seen |= states
        self.assertEqual(seen, set(STATES))

    def test_a_step_that_departs_from_the_page_is_told_apart(self):
        class AnyChangeOfSign(Walker):  # the paper's test: contact-model PAPER-4
            def may_cross(self, s0, s1):
                return s0 * s1 < 0

        class EdgesLetGoTogether(Walker):  # contact-model EDGE-1
            def is_free_of(self, edge, sides):
                return all(side >= 0 for side, _ in sides)

        class StaticCircle(Walker):  # contact-model FRIC-2
            def slip(self, r2, load):
                radius = super().slip(r2, load)
                return radius if radius is None else self.mu_static * load

        class NoSeat(Walker):  # contact-model FACE-1
            def leave_face(self, face):
                return (0, None)

        rng = random.Random(SEED)
        mesh = spiky_ball(rng)
        way = list(random_way(rng, TICKS))
        log = replay(self.folder, mesh, way, FRICTION[1], "wedge")
        for wrong in (AnyChangeOfSign, EdgesLetGoTogether, StaticCircle, NoSeat):
            with self.subTest(wrong=wrong.__name__):
                self.assertIsNotNone(first_difference(log, wrong(Graph(*mesh), *FRICTION[1]), way)[0])


if __name__ == "__main__":
    unittest.main()
