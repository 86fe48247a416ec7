# SPDX-License-Identifier: Apache-2.0
"""What a new user meets first: wrong units, a path without a recording, patterns over a folder, contacts in other units."""
import csv
import json
import math
import unittest

from support import CUBE, ROOT, Case

BAD = CUBE.replace("4 3 0 4 7", "4 7 4 0 3")  # one face the other way round


def scaled(factor):
    lines = CUBE.split("\n")
    points = [" ".join(str(float(x) * factor) for x in line.split()) for line in lines[2:10]]
    return "\n".join(lines[:2] + points + lines[10:])


class Units(Case):
    def test_an_implausible_size_is_warned_of_with_the_remedy(self):
        for factor, options, words in ((100, (), ("100 m", "--units mm")), (1e-4, (), ("0.0001 m", "--scale")),
                                       (0.1, ("--units", "mm"), ("0.0001 m", "leave out --units"))):
            with self.subTest(factor):
                done = self.fdcg("compile", self.write("cube.off", scaled(factor)), "-o", self.path("cube.fdcg"), *options)
                self.assert_one_line(done, "fdcg: warning: ", "cube.off: the object measures", *words)

    def test_a_plausible_size_and_a_stated_unit_give_no_warning(self):
        for factor, options in ((1, ()), (9.9, ()), (1.1e-3, ()), (100, ("--units", "m")), (100, ("--units", "mm")), (100, ("-q",))):
            done = self.fdcg("compile", self.write("cube.off", scaled(factor)), "-o", self.path("cube.fdcg"), *options)
            self.assertEqual(b"", done.stderr, (factor, options))

    def test_a_path_that_touches_nothing_is_warned_of(self):
        graph = self.compiled_cube()
        rows = ["t,x,y,z"] + [f"{i / 1000},{300 + i},500,1050" for i in range(10)]
        done = self.servo("replay", graph, "--trajectory", self.write("far.csv", "\n".join(rows) + "\n"), "-q")
        self.assert_one_line(done, "warning", "far.csv", "touches nothing", "1 x 1 x 1 m", "--units")
        near = self.write("near.csv", "t,x,y,z\n0,0.5,0.5,1.5\n0.001,0.5,0.5,1.4\n")
        done = self.servo("replay", graph, "--trajectory", near, "-q")
        self.assert_one_line(done, "near.csv", "touches nothing", "0.4 m")
        self.assertNotIn(b"--units", done.stderr)
        self.assertEqual(b"", self.servo("replay", graph, "--trajectory", self.slide(), "-q").stderr)


class Slide(Case):
    def replay(self, graph, *more):
        self.servo("replay", graph, "--path", "slide", "--write-path", self.path("hip.csv"), "-o", self.path("log.csv"), *more)
        with open(self.path("log.csv"), newline="", encoding="ascii") as file:
            return list(csv.DictReader(file))

    def check(self, rows, size):
        """There, pressed with a sane force, slid to and fro, gone again."""
        states = [row["state"] != "free" for row in rows]
        self.assertFalse(states[0] or states[-1])
        self.assertGreater(sum(states), 0.75 * len(rows))
        largest = max(math.hypot(*(float(row[f]) for f in ("fx", "fy", "fz"))) for row in rows)
        self.assertLess(largest, 3e3 * min(0.0065 * size, 0.005))
        self.assertGreater(largest, 0)
        self.assertGreater(sum(row["slip"] == "1" for row in rows), 100)
        self.assertGreater(sum(row["slip"] == "0" and row["state"] != "free" for row in rows), 10)

    def test_it_makes_a_path_for_objects_of_every_size(self):
        for factor in (1, 0.05, 1e-3):
            graph = self.path("cube.fdcg")
            self.fdcg("compile", self.write("cube.off", scaled(factor)), "-o", graph, "-q")
            self.check(self.replay(graph), factor * math.sqrt(3))

    def test_the_written_path_replays_to_the_same_log(self):
        graph = self.compiled_cube()
        self.replay(graph, "--mu-s", "0.9")
        log = (self.folder / "log.csv").read_bytes()
        self.servo("replay", graph, "--trajectory", self.path("hip.csv"), "-o", self.path("again.csv"), "--mu-s", "0.9")
        self.assertEqual(log, (self.folder / "again.csv").read_bytes())
        path = (self.folder / "hip.csv").read_bytes()
        self.replay(graph)
        self.assertEqual(path, (self.folder / "hip.csv").read_bytes())

    def test_it_finds_the_surface_beside_a_hole(self):
        """A frame: nothing stands where the middle of its box is."""
        points, faces = [], []
        for ring, (r, z) in enumerate(((1, 0), (3, 0), (3, 1), (1, 1))):
            points += [f"{r * x} {r * y} {z}" for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
            for i in range(4):
                j, after = (i + 1) % 4, (ring + 1) % 4
                faces.append(f"4 {4 * ring + j} {4 * ring + i} {4 * after + i} {4 * after + j}")
        mesh = self.write("frame.off", f"OFF\n16 16 0\n" + "\n".join(points + faces) + "\n")
        graph = self.path("frame.fdcg")
        self.fdcg("compile", mesh, "-o", graph, "-q", "--orient", "--scale", "0.02")
        rows = self.replay(graph)
        self.assertGreater(sum(row["state"] != "free" for row in rows), 0.5 * len(rows))

    def test_options_that_do_not_go_together_are_refused(self):
        graph, hip = self.compiled_cube(), self.slide()
        for options, words in ((("--path", "slide", "--trajectory", hip), ("--path", "--trajectory")),
                               (("--write-path", "x", "--trajectory", hip), ("--write-path", "--path")),
                               (("--path", "circle"), ("circle", "slide")),
                               (("--path", "slide", "--write-path", graph), ("overwrite",)),
                               (("--path", "slide", "--write-path", "x", "-o", "x"), ("one file",)), ((), ("--path",))):
            self.assert_one_line(self.servo("replay", graph, *options, code=2), *words)

    def test_the_example_path_slides_over_the_cube(self):
        graph = self.path("cube.fdcg")
        examples = ROOT / "runtime" / "examples"
        self.fdcg("compile", str(examples / "cube.obj"), "-o", graph, "-q", "--units", "cm")
        done = self.servo("replay", graph, "--trajectory", str(examples / "cube_slide.csv"), "-o", self.path("log.csv"))
        self.assertEqual(b"", done.stderr)
        with open(self.path("log.csv"), newline="", encoding="ascii") as file:
            rows = list(csv.DictReader(file))
        self.assertGreater(sum(row["state"] == "face" for row in rows), 0.7 * len(rows))


class Patterns(Case):
    def test_a_pattern_finds_what_the_search_of_a_folder_finds(self):
        (self.folder / "mix" / "deep").mkdir(parents=True)
        for name, mesh in (("mix/good.off", CUBE), ("mix/deep/BAD.OFF", BAD), ("mix/deep/Good.Off", CUBE)):
            self.write(name, mesh)
        found = []
        for argument in ("mix/**/*.{off,stl}", "mix", "MIX/**/*.OFF"):
            done = self.fdcg("validate", "--format", "json", argument, code=1, cwd=self.folder)
            found.append([(f["file"], f["verdict"]) for f in json.loads(done.stdout)["files"]])
        self.assertEqual([("mix/deep/BAD.OFF", "fail"), ("mix/deep/Good.Off", "pass"), ("mix/good.off", "pass")], found[0])
        self.assertEqual(found[0], found[1])
        self.assertEqual(found[0], found[2])


class Grasp(Case):
    def test_contacts_in_other_units_are_no_grasp(self):
        graph = self.compiled_cube()
        near = "x,y,z\n0,0.5,0.5\n1,0.5,0.5\n0.5,0,0.5\n"
        self.fdcg("grasp", graph, "--contacts", self.write("near.csv", near), "--mu", "1")
        far = "x,y,z\n-500,0.5,0.5\n1000,0.5,0.5\n0.5,-500,0.5\n"
        done = self.fdcg("grasp", graph, "--contacts", self.write("far.csv", far), "--mu", "1", code=1)
        self.assertIn(b"fdcg: warning: contact 0 was moved 500 m to the surface", done.stderr)
        self.assertIn(b"--units", done.stderr)


if __name__ == "__main__":
    unittest.main()
