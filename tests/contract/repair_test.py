# SPDX-License-Identifier: Apache-2.0
"""What people's scripts rely on of fdcg repair."""
import json
import pathlib
import subprocess
import unittest

import jsonschema

from support import CUBE, FDCG, ROOT, TETRAHEDRON, Case

# Two tetrahedra that touch in the origin; one face of the second is wound the wrong way, one stands twice, one has no area.
DEFECTIVE = """OFF
7 11 0
0 0 0
1 0 0
0 1 0
0 0 1
-1 0 0
0 -1 0
0 0 -1
3 0 2 1
3 0 1 3
3 1 2 3
3 0 3 2
3 0 4 5
3 0 6 4
3 4 6 5
3 0 6 5
3 2 1 0
3 0 1 1
3 1 1 1
"""
STEPS = ("--weld", "--drop-degenerate", "--drop-duplicates", "--split-non-manifold-vertices", "--orient",
         "--drop-unusable", "--triangulate-crossing", "--unfold", "--cut-non-manifold", "--drop-blocking", "--reverse-inside-out", "--solid", "--simplify", "--all")


def check_schema(report):
    folder = ROOT / "schemas"
    schema = json.loads((folder / "repair-report.schema.json").read_text())
    resolver = jsonschema.RefResolver(folder.as_uri() + "/", schema)  # for what it takes from the schema of validate's report
    jsonschema.Draft202012Validator(schema, resolver=resolver).validate(report)


class Repair(Case):
    def report(self):
        report = json.loads((self.folder / "report.json").read_text())
        check_schema(report)
        return report

    def totals(self, name, *options):
        done = subprocess.run([FDCG, "validate", "--format", "json", *options, self.path(name)], capture_output=True, check=False)
        return {issue["rule"]: issue["total"] for issue in json.loads(done.stdout)["files"][0]["issues"]}

    def test_all_repairs_are_counted_and_the_result_is_clean(self):
        mesh = self.write("bad.off", DEFECTIVE)
        done = self.fdcg("repair", mesh, "-o", self.path("good.ply"), "--all", "--report", self.path("report.json"))
        report = self.report()
        totals = {action["name"]: action["total"] for action in report["actions"]}
        self.assertEqual({"drop-unusable": 0, "weld": 0, "triangulate-crossing": 0, "unfold": 0, "drop-degenerate": 2,
                          "drop-duplicates": 1, "orient": 1, "cut-non-manifold": 0, "split-non-manifold-vertices": 1,
                          "drop-blocking": 0, "reverse-inside-out": 0}, totals)
        self.assertEqual(0, report["effect"]["distance"])
        elements = {action["name"]: action["elements"] for action in report["actions"]}
        self.assertEqual([[9], [10]], [element["faces"] for element in elements["drop-degenerate"]])
        self.assertEqual([[8]], [element["faces"] for element in elements["drop-duplicates"]])
        self.assertEqual([0], elements["split-non-manifold-vertices"][0]["vertices"])
        self.assertEqual((3, [7]), (elements["split-non-manifold-vertices"][0]["line"], elements["orient"][0]["faces"]))
        self.assertEqual(("pass", "none", self.path("good.ply")),
                         (report["verdict"], report["read_with_weld"], report["written"]))
        self.assertEqual("fail", report["before"]["verdict"])
        self.assertIn(b"--weld none", done.stdout)
        after = self.totals("good.ply", "--weld", "none")
        after.pop("self-intersection")  # the two parts still touch in a point
        self.assertEqual({}, after)
        self.assertEqual({"non-manifold-vertex": 1, "duplicate-vertex": 1}, self.totals("good.ply"))
        self.fdcg("compile", self.path("good.ply"), "-o", self.path("good.fdcg"), "-q", "--weld", "none")
        self.assert_only("bad.off", "good.ply", "good.fdcg", "report.json")

    def test_the_totals_of_the_report_are_those_of_validate(self):
        self.write("bad.off", DEFECTIVE)
        for steps in (("--orient",), ("--drop-degenerate", "--drop-duplicates"), ("--weld", "exact"), ("--weld", "none"),
                      ("--weld", "0.5"), ("--all",), ("--all", "--weld", "0.1")):
            with self.subTest(steps=steps):
                self.fdcg("repair", self.path("bad.off"), "-o", self.path("good.obj"), *steps, "--report",
                          self.path("report.json"), "-q", code=0 if "--all" in steps else 1)
                report = self.report()
                for name, entry, weld in (("bad.off", report["before"], "none" if steps[-1] == "none" else "exact"),
                                          ("good.obj", report["after"], report["read_with_weld"])):
                    self.assertEqual(self.totals(name, "--weld", weld), {i["rule"]: i["total"] for i in entry["issues"]})

    def test_only_what_is_asked_for_is_done(self):
        mesh = self.write("bad.off", DEFECTIVE)
        before = self.totals("bad.off")
        self.fdcg("repair", mesh, "-o", self.path("out.off"), "--drop-degenerate", "-q", code=1)
        after = self.totals("out.off")
        self.assertEqual(2, before.pop("degenerate-face"))
        self.assertEqual(before, after)

    def test_every_format_is_written_by_its_ending_or_by_name(self):
        mesh = self.write("cube.off", TETRAHEDRON)
        for name, options, start in (("a.off", (), b"OFF\n"), ("a.OBJ", (), b"v "), ("a.ply", (), b"ply\nformat binary_little"),
                                     ("a.ply", ("--ascii",), b"ply\nformat ascii"), ("a.stl", (), b"binary STL"),
                                     ("a.stl", ("--ascii",), b"solid"), ("a.mesh", ("--format", "obj"), b"v ")):
            self.fdcg("repair", mesh, "-o", self.path(name), "--orient", "-q", *options)
            self.assertTrue((self.folder / name).read_bytes().startswith(start), (name, options))

    def test_stl_refuses_what_it_would_lose(self):
        done = self.fdcg("repair", self.write("cube.off", CUBE), "-o", self.path("a.stl"), "--orient", code=2)
        self.assert_one_line(done, "face 0", "4 corners", "OFF, OBJ or PLY")
        mesh = self.write("bad.off", DEFECTIVE)
        done = self.fdcg("repair", mesh, "-o", self.path("a.stl"), "--all", "--weld", "none", code=2)
        self.assert_one_line(done, "apart on purpose", "OFF, OBJ or PLY")
        self.assert_only("cube.off", "bad.off")

    def test_stl_holds_a_repaired_mesh_that_compiles_without_options(self):
        self.fdcg("repair", self.write("bad.off", DEFECTIVE), "-o", self.path("a.stl"), "--all", "--report", self.path("report.json"))
        actions = {action["name"]: action for action in self.report()["actions"]}
        self.assertEqual(1, actions["part-equal-vertices"]["total"])
        self.assertLess(0, actions["part-equal-vertices"]["effect"]["distance"])
        self.assertGreater(1e-6, self.report()["effect"]["distance"])
        self.fdcg("compile", self.path("a.stl"), "-o", self.path("a.fdcg"), "-q")

    def test_compile_repairs_on_the_way(self):
        mesh = self.write("bad.off", DEFECTIVE)
        self.assertIn(b"--repair", self.fdcg("compile", mesh, "-o", self.path("a.fdcg"), code=1).stderr)
        done = self.fdcg("compile", mesh, "-o", self.path("a.fdcg"), "--repair=safe", "--report", self.path("compiled.json"))
        self.assertIn(b"drop-duplicates: 1 face", done.stdout)
        schema = json.loads((ROOT / "schemas/validate-report.schema.json").read_text())
        resolver = jsonschema.RefResolver((ROOT / "schemas").as_uri() + "/", schema)
        report = json.loads((self.folder / "compiled.json").read_text())
        jsonschema.Draft202012Validator(schema, resolver=resolver).validate(report)
        entry = report["files"][0]
        self.assertEqual("pass", entry["verdict"])
        self.assertEqual("safe", entry["repair"]["level"])
        self.assertEqual(1, entry["repair"]["found"]["non-manifold-vertex"])
        self.assertEqual([11, 8], [entry["repair"]["effect"][name] for name in ("faces_before", "faces_after")])
        info = json.loads(self.fdcg("inspect", "--json", self.path("a.fdcg")).stdout)
        self.assertIn('"volume_after"', json.dumps(info))
        self.fdcg("inspect", "--verify", self.path("a.fdcg"))
        self.assert_one_line(self.fdcg("compile", mesh, "-o", self.path("a.fdcg"), "--repair=most", code=2), "'most'", "safe, full and solid")

    def test_standard_input_and_output(self):
        done = subprocess.run([FDCG, "repair", "-", "-o", "-", "--format", "off", "--all"], input=DEFECTIVE.encode(),
                              capture_output=True, check=True)
        self.assertTrue(done.stdout.startswith(b"OFF\n8 8 0\n"))
        self.assertIn(b"drop-duplicates: 1 face", done.stderr)
        done = subprocess.run([FDCG, "repair", "-", "-o", "-", "--format", "off", "--orient", "-q", "--input-format", "obj"],
                              input=b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", capture_output=True, check=True)
        self.assertEqual((b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", b""), (done.stdout, done.stderr))

    def test_a_dry_run_writes_no_mesh(self):
        mesh = self.write("bad.off", DEFECTIVE)
        done = self.fdcg("repair", mesh, "--all", "--dry-run", "--report", self.path("report.json"))
        self.assertIn(b"drop-degenerate: 2 faces", done.stdout)
        self.assertIsNone(self.report()["written"])
        self.assert_only("bad.off", "report.json")

    def test_errors_that_are_left_are_code_1_and_with_strict_nothing_is_written(self):
        fan = "OFF\n5 3 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n0 -1 0\n3 0 1 2\n3 1 0 3\n3 0 1 4\n"
        mesh = self.write("fan.off", fan)
        self.fdcg("repair", mesh, "-o", self.path("strict.off"), "--orient", "--strict", "-q", code=1)
        self.assert_only("fan.off")
        done = self.fdcg("repair", mesh, "-o", self.path("out.off"), "--orient", code=1)
        self.assertIn(b"non-manifold-edge", done.stdout)
        self.assert_only("fan.off", "out.off")

    def test_a_mesh_of_which_nothing_is_left_is_not_written(self):
        mesh = self.write("flat.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n2 0 0\n3 0 1 2\n")
        done = self.fdcg("repair", mesh, "-o", self.path("out.off"), "--all", "-q", code=1)
        self.assert_one_line(done, "no face is left")
        self.assert_only("flat.off")

    def test_simplify_keeps_to_its_error_and_says_where_it_cannot(self):
        side = 12
        points = [f"{i} {j} 0" for i in range(side + 1) for j in range(side + 1)]
        faces = []
        for i in range(side):
            for j in range(side):
                a = i * (side + 1) + j
                faces += [f"3 {a} {a + side + 1} {a + side + 2}", f"3 {a} {a + side + 2} {a + 1}"]
        mesh = self.write("sheet.off", "\n".join(["OFF", f"{len(points)} {len(faces)} 0", *points, *faces]) + "\n")
        self.fdcg("repair", mesh, "-o", self.path("few.ply"), "--simplify", "0.001", "-q", "--report", self.path("report.json"))
        report = self.report()
        self.assertEqual("simplify", report["actions"][0]["name"])
        self.assertEqual(report["before"]["faces"] - report["after"]["faces"], report["actions"][0]["total"])
        self.assertLess(report["after"]["faces"], 40)
        done = self.fdcg("repair", self.write("cube.off", CUBE), "-o", self.path("few.ply"), "--simplify", "0.1", code=1)
        self.assertIn(b"face 0 has 4 corners", done.stdout)
        self.assert_one_line(self.fdcg("repair", mesh, "-o", self.path("few.ply"), "--simplify", "0", code=2), "--simplify", "above 0")

    # A box without its lid, and a bar that passes through its walls.
    OPEN_BOX = ("OFF", "16 22 0", "0 0 0", "4 0 0", "4 4 0", "0 4 0", "0 0 4", "4 0 4", "4 4 4", "0 4 4",
                "-1 1 1", "5 1 1", "5 2 1", "-1 2 1", "-1 1 2", "5 1 2", "5 2 2", "-1 2 2")
    SIDES = ((0, 2, 1), (0, 3, 2), (0, 1, 5), (0, 5, 4), (1, 2, 6), (1, 6, 5), (2, 3, 7), (2, 7, 6), (3, 0, 4), (3, 4, 7))
    LID = ((4, 5, 6), (4, 6, 7))

    def box_and_bar(self):
        faces = [*self.SIDES, *(tuple(v + 8 for v in side) for side in (*self.SIDES, *self.LID))]
        return self.write("box.off", "\n".join([*self.OPEN_BOX, *(f"3 {a} {b} {c}" for a, b, c in faces)]) + "\n")

    def test_a_solid_is_closed_and_does_not_meet_itself(self):
        mesh = self.box_and_bar()
        self.assertIn("self-intersection", self.totals("box.off"))
        for ending, options in (("off", ()), ("stl", ()), ("stl", ("--ascii",)), ("ply", ("--hole-size", "6")), ("obj", ("--hole-size", "90%"))):
            with self.subTest(ending=ending, options=options):
                out = self.path("solid." + ending)
                self.fdcg("repair", "--solid", mesh, "-o", out, *options, "--report", self.path("report.json"), "-q")
                report = self.report()
                self.assertAlmostEqual(64 + 2, report["effect"]["volume_after"], places=4)
                self.assertLess(report["effect"]["distance"], 1e-6)
                actions = {action["name"]: action for action in report["actions"]}
                self.assertEqual(1, actions["close-holes"]["total"])
                self.assertGreater(actions["close-holes"]["effect"]["distance"], 1)
                self.assertGreater(actions["solid"]["total"], 0)
                found = self.totals("solid." + ending)
                self.assertFalse({"self-intersection", "boundary-edge", "non-manifold-edge", "inside-out"} & set(found), found)

    def test_a_part_with_a_hole_larger_than_the_limit_is_left_out(self):
        self.fdcg("repair", "--solid", self.box_and_bar(), "--hole-size", "1", "-o", self.path("solid.off"), "--report", self.path("report.json"))
        report = self.report()
        self.assertAlmostEqual(6, report["effect"]["volume_after"])
        actions = {action["name"]: action for action in report["actions"]}
        self.assertEqual(1, actions["close-holes"]["left"]["total"])
        self.assertIn("--hole-size", actions["close-holes"]["left"]["message"])
        self.assertEqual(10, actions["solid"]["left"]["total"])

    def test_a_sheet_encloses_nothing_and_says_so(self):
        mesh = self.write("sheet.off", "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n")
        done = self.fdcg("repair", "--solid", mesh, "-o", self.path("solid.off"), code=1)
        self.assertIn(b"no solid was made: its faces enclose nothing", done.stdout)

    def test_a_surface_rebuilt_on_a_lattice_is_closed(self):
        self.fdcg("repair", "--solid=remesh", "--voxel", "0.25", self.box_and_bar(), "-o", self.path("solid.ply"), "-q", "--report", self.path("report.json"))
        report = self.report()
        self.assertGreater(report["effect"]["volume_after"], 40)  # across the lid the surface is where the winding number is a half
        found = self.totals("solid.ply")
        self.assertFalse({"self-intersection", "boundary-edge", "non-manifold-edge", "inside-out"} & set(found), found)
        done = self.fdcg("repair", "--solid=remesh", "--voxel", "0.0001", self.box_and_bar(), "-o", self.path("fine.ply"), code=1)
        self.assertIn(b"--voxel", done.stdout)

    def test_wrong_usage_names_what_is_right(self):
        mesh, out = self.write("cube.off", CUBE), self.path("out.off")
        for arguments, words in (
            ((mesh, "-o", out), STEPS),
            ((mesh, "--orient"), ("-o", "--dry-run")),
            ((mesh, "-o", self.path("out.step"), "--orient"), (".off, .obj, .ply or .stl", "--format")),
            ((mesh, "-o", "-", "--orient"), ("--format",)),
            ((mesh, "-o", out, "--orient", "--format", "glb"), ("off, obj, ply, stl",)),
            ((mesh, "-o", out, "--weld", "-1"), ("exact, none",)),
            ((mesh, "-o", mesh, "--orient"), ("overwrite",)),
            ((mesh, "-o", out, "--solid=best"), ("exact and remesh",)),
            ((mesh, "-o", out, "--all", "--hole-size", "1"), ("--solid",)),
            ((mesh, "-o", out, "--solid", "--voxel", "1"), ("--solid=remesh",)),
            ((mesh, "-o", out, "--solid", "--hole-size", "-5%"), ("percentage",)),
            ((mesh, "-o", out, "--orient", "--report", out), ("different",)),
            (("-o", out, "--orient"), ("mesh",)),
        ):
            with self.subTest(arguments=arguments):
                self.assert_one_line(self.fdcg("repair", *arguments, code=2), *words)
                self.assert_only("cube.off")
        self.assertEqual(CUBE, pathlib.Path(mesh).read_text())

    def test_unreadable_input_and_unwritable_output_are_code_3(self):
        self.assert_one_line(self.fdcg("repair", self.path("none.off"), "-o", self.path("a.off"), "--all", code=3), "none.off")
        mesh = self.write("cube.off", CUBE)
        self.assert_one_line(self.fdcg("repair", mesh, "-o", self.path("no/where.off"), "--all", code=3), "where.off")
        self.assert_only("cube.off")


if __name__ == "__main__":
    unittest.main()
