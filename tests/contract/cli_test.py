# SPDX-License-Identifier: Apache-2.0
"""What people's scripts rely on: options, exit codes, shapes, and that nothing is left behind. Over 400
lines: a class for each command."""
import hashlib
import json
import math
import os
import pathlib
import shutil
import signal
import struct
import subprocess
import time
import unittest

import jsonschema

from support import CUBE, FDCG, ROOT, SERVO, TETRAHEDRON, Case, checksum

MISSING_FACE = CUBE.replace("8 6 0", "8 5 0").replace("4 3 0 4 7\n", "")
THREE_ON_AN_EDGE = "OFF\n5 3 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n0 -1 0\n3 0 1 2\n3 1 0 3\n3 0 1 4\n"


def schema(name):
    return json.loads((ROOT / "schemas" / name).read_text())


def inside_out(off):
    lines = off.splitlines()
    count = int(lines[1].split()[0])
    faces = [" ".join([f.split()[0], *reversed(f.split()[1:])]) for f in lines[2 + count:]]
    return "\n".join(lines[:2 + count] + faces) + "\n"


class Usage(Case):
    def test_help_names_examples_and_version_names_the_format(self):
        for program, commands in ((FDCG, ("compile", "validate", "repair", "inspect", "explain", "grasp")),
                                  (SERVO, ("run", "devices", "check", "latency", "calibrate", "replay"))):
            self.assertIn(b"Examples:", self.run_program(program, "--help").stdout)
            self.assertRegex(self.run_program(program, "--version").stdout, rb"^fdcg(-servo)? \d+\.\d+\.\d+ \(file format 1\)\n$")
            for command in commands:
                done = self.run_program(program, command, "--help")
                self.assertIn(b"Examples:", done.stdout)
                self.assertEqual(b"", done.stderr)

    def test_wrong_usage_is_code_2_and_one_line_that_names_what_is_right(self):
        mesh, out = self.write("cube.off", CUBE), self.path("out.fdcg")
        compile_ = ("compile", mesh, "-o", out)
        for arguments, words in (
            ((), ()),
            (("frobnicate",), ()),
            (("compile", mesh), ("--output",)),
            (("compile", "-o", out), ("mesh",)),
            ((*compile_, "--units", "furlong"), ("furlong", "m, mm, cm, in")),
            ((*compile_, "--scale", "0"), ("--scale", "above 0")),
            ((*compile_, "--scale", "nan"), ("--scale",)),
            ((*compile_, "--scale", "2", "--units", "mm"), ("--scale", "--units")),
            ((*compile_, "--precision", "f16"), ("f64, f32",)),
            ((*compile_, "--coplanar", "90"), ("exact, quantum",)),
            ((*compile_, "--coplanar", "1x"), ("exact, quantum",)),
            ((*compile_, "--weld", "-1"), ("exact, none",)),
            ((*compile_, "--density", "0"), ("--density", "above 0")),
            ((*compile_, "--mass", "1", "--density", "1"), ("--mass", "--density")),
            ((*compile_, "--planes", "some"), ("stored, derived",)),
            ((*compile_, "--without", "nodes"), ("hierarchy, source-map, info, mass",)),
            ((*compile_, "--allow", "non-manifold-edge"), ("cannot be allowed", "boundary-edge")),
            ((*compile_, "--allow", "nonsense"), ("no rule",)),
            ((*compile_, "--jobs", "0"), ("--jobs",)),
            ((*compile_, "-q", "-v"), ()),
            (("compile", mesh, "-o", mesh), ("overwrite",)),
            (("compile", mesh, "-o", "-", "--depfile", self.path("d")), ("--depfile",)),
            (("repair", mesh, "-o", out), ("--orient",)),
            (("validate", mesh, "--format", "xml"), ("text, json",)),
            (("validate", mesh, "--fail-on", "always"), ("error, warning, note, never",)),
            (("validate", mesh, "-o", mesh), ("overwrite",)),
            (("validate",), ("mesh",)),
            (("inspect",), ("file",)),
            (("explain", "boundry-edge"), ("boundary-edge",)),
        ):
            with self.subTest(arguments=arguments):
                done = self.fdcg(*arguments, code=2)
                self.assert_one_line(done, *words)
                self.assertEqual(b"", done.stdout)
                self.assert_only("cube.off")
        self.assertEqual(CUBE, pathlib.Path(mesh).read_text())

    def test_explain_tells_each_rule(self):
        listing = self.fdcg("explain").stdout.decode().splitlines()
        self.assertGreater(len(listing), 15)
        for line in listing:
            self.assertIn("Why it matters", self.fdcg("explain", line.split()[0]).stdout.decode())

    def test_no_colour_where_nobody_looks(self):
        done = self.fdcg("validate", self.write("open.off", MISSING_FACE))
        self.assertNotIn(b"\033", done.stdout + done.stderr)


class Compile(Case):
    def test_cube_has_the_counts_of_the_paper_and_the_report_says_where_things_went(self):
        mesh, out = self.write("cube.off", CUBE), self.path("cube.fdcg")
        done = self.fdcg("compile", mesh, "-o", out, "--report", self.path("report.json"))
        self.assertIn(b"metres (the default)", done.stdout)
        self.assertIn(b"6 nodes, 12 connections (12 convex", done.stdout)
        about = json.loads(self.fdcg("inspect", "--json", out).stdout)
        self.assertEqual((6, 12, 8), (about["nodes"], about["connections"], about["corners"]))
        report = json.loads((self.folder / "report.json").read_text())
        jsonschema.validate(report, schema("validate-report.schema.json"))
        self.assertEqual("pass", report["files"][0]["verdict"])
        self.assert_only("cube.off", "cube.fdcg", "report.json")

    def test_same_input_and_options_give_the_same_bytes(self):
        mesh = self.write("cube.off", CUBE)
        digests = set()
        for jobs in ("1", "2", "7"):
            done = self.fdcg("compile", mesh, "-o", "-", "--jobs", jobs)
            digests.add(hashlib.sha256(done.stdout).hexdigest())
        self.fdcg("compile", mesh, "-o", self.path("file.fdcg"))
        digests.add(hashlib.sha256((self.folder / "file.fdcg").read_bytes()).hexdigest())
        self.assertEqual(1, len(digests))

    def test_standard_output_gets_the_file_alone(self):
        done = self.fdcg("compile", self.write("cube.off", CUBE), "-o", "-")
        self.assertEqual(b"\x89FDCG\r\n\x1a", done.stdout[:8])
        self.assertEqual(len(done.stdout), int.from_bytes(done.stdout[16:24], "little"))
        self.assertIn(b"6 nodes", done.stderr)
        inspected = subprocess.run([FDCG, "inspect", "-"], input=done.stdout, capture_output=True, check=True)
        self.assertIn(b"FDCG version 1, f64", inspected.stdout)

    def test_quiet_says_nothing_and_verbose_says_more(self):
        mesh = self.write("cube.off", CUBE)
        done = self.fdcg("compile", mesh, "-o", self.path("a"), "-q")
        self.assertEqual((b"", b""), (done.stdout, done.stderr))
        plain = self.fdcg("compile", mesh, "-o", self.path("a")).stdout
        self.assertGreater(len(self.fdcg("compile", mesh, "-o", self.path("a"), "-v").stdout), len(plain))

    def test_units_scale_the_object(self):
        mesh, out = self.write("cube.off", CUBE), self.path("cube.fdcg")
        for option, metres in ((("--units", "mm"), 0.001), (("--units", "cm"), 0.01), (("--units", "in"), 0.0254),
                               (("--units", "m"), 1), (("--scale", "0.5"), 0.5)):
            self.fdcg("compile", mesh, "-o", out, "-q", *option)
            about = json.loads(self.fdcg("inspect", "--json", out).stdout)
            self.assertEqual([metres] * 3, about["bounds"]["max"], option)

    def test_every_option_changes_what_it_names(self):
        mesh, out = self.write("cube.off", CUBE), self.path("cube.fdcg")

        def about(*options):
            self.fdcg("compile", mesh, "-o", out, "-q", *options)
            return json.loads(self.fdcg("inspect", "--json", out).stdout)

        def sections(*options):
            return {section["name"] for section in about(*options)["sections"]}

        everything = sections()
        self.assertEqual("f32", about("--precision", "f32")["precision"])
        self.assertEqual({"edges"}, everything - sections("--planes", "derived"))
        node_bytes = {planes: about("--planes", planes)["sections"][0]["bytes"] for planes in ("stored", "derived")}
        self.assertLess(node_bytes["derived"], node_bytes["stored"] / 2)
        for name in ("hierarchy", "source-map", "info", "mass"):
            self.assertEqual({name}, everything - sections("--without", name))
        self.assertEqual({"hierarchy", "info"}, everything - sections("--without", "info", "--without", "hierarchy"))
        self.assertNotIn("materials", everything)  # the mesh has none
        self.assertIsNone(about("--without", "info")["options"])

    def test_materials_are_listed_by_name_and_can_be_left_out(self):
        mesh = self.write("strip.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\n"
                                       "f 1 2 5\nusemtl rubber\nf 1 5 4\nusemtl ice\nf 2 3 6 5\n")

        def about(*options):
            out = self.path("strip.fdcg")
            self.fdcg("compile", mesh, "-q", "-o", out, *options)
            return json.loads(self.fdcg("inspect", "--json", out).stdout), self.fdcg("inspect", out).stdout.decode()

        told, text = about()
        self.assertEqual({"list": [{"name": "rubber", "nodes": 1}, {"name": "ice", "nodes": 1}], "nodes_without": 1},
                         told["materials"])
        self.assertIn("materials    rubber (1 nodes), ice (1 nodes), none (1)", text)
        self.assertLessEqual({"materials", "names"}, {s["name"] for s in told["sections"]})
        told, text = about("--without", "materials")
        self.assertNotIn("rubber", text)
        self.assertIsNone(told["materials"])
        self.assertEqual(1, told["nodes"])

    def test_merging_joins_coplanar_triangles(self):
        lines = CUBE.splitlines()
        faces = []
        for face in lines[10:]:
            _, a, b, c, d = face.split()
            faces += [f"3 {a} {b} {c}", f"3 {a} {c} {d}"]
        mesh = self.write("cube12.off", "\n".join(["OFF", "8 12 0", *lines[2:10], *faces]) + "\n")
        out = self.path("cube.fdcg")
        for options, nodes, connections in (((), 6, 12), (("--merge",), 6, 12), (("--no-merge",), 12, 18)):
            self.fdcg("compile", mesh, "-o", out, "-q", *options)
            about = json.loads(self.fdcg("inspect", "--json", out).stdout)
            self.assertEqual((nodes, connections), (about["nodes"], about["connections"]), options)
            self.assertEqual(12, about["connection_types"]["convex"])
        self.fdcg("compile", mesh, "-o", out, "-q", "--triangles", "--no-merge")
        for options, words in ((("--merge",), "--merge"), (("--coplanar", "5"), "--coplanar")):
            self.assert_one_line(self.fdcg("compile", mesh, "-o", out, "--triangles", *options, code=2), "--triangles", words)

    def test_depfile_names_target_and_mesh_as_make_reads_them(self):
        mesh, out = self.write("my mesh#1.off", CUBE), self.path("out $x.fdcg")
        self.fdcg("compile", mesh, "-o", out, "-q", "--depfile", self.path("out.d"))
        text = (self.folder / "out.d").read_text()
        self.assertEqual(text, f"{self.folder}/out\\ $$x.fdcg: {self.folder}/my\\ mesh\\#1.off\n")

    def test_self_intersections_are_looked_for_on_request_and_do_not_hinder(self):
        lines = CUBE.splitlines()
        points = [[float(c) for c in line.split()] for line in lines[2:10]]
        size = max(c for point in points for c in point) - min(c for point in points for c in point)
        points += [[c + size / 2 + size / 8 * k for k, c in enumerate(point)] for point in points]
        faces = [[int(v) for v in line.split()] for line in lines[10:]]
        faces += [[4] + [v + 8 for v in face[1:]] for face in faces]
        rows = [" ".join(map(str, row)) for row in points + faces]
        mesh, out = self.write("two.off", "\n".join(["OFF", "16 12 0", *rows]) + "\n"), self.path("two.fdcg")
        for options, expected in (((), []), (("--self-intersections",), ["self-intersection"])):
            self.fdcg("compile", mesh, "-o", out, "-q", *options, "--report", self.path("report.json"))
            report = json.loads((self.folder / "report.json").read_text())["files"][0]
            self.assertEqual(expected, [issue["rule"] for issue in report["issues"]])
        self.assertEqual(6, report["issues"][0]["total"])  # a corner of each in the other: three faces of each, two by two
        self.assertIn("6 pairs of faces meet: 6 cross, 0 only touch", report["issues"][0]["message"])

    def test_orient_turns_what_looks_inwards(self):
        mesh, out = self.write("cube.off", inside_out(CUBE)), self.path("cube.fdcg")
        done = self.fdcg("compile", mesh, "-o", out, code=1)
        self.assertIn(b"inside-out", done.stderr)
        done = self.fdcg("compile", mesh, "-o", out, "--orient")
        self.assertIn(b"6 faces turned round", done.stdout)
        about = json.loads(self.fdcg("inspect", "--json", out).stdout)
        self.assertEqual(12, about["connection_types"]["convex"])
        self.fdcg("compile", mesh, "-o", out, "-q", "--allow", "inside-out")
        about = json.loads(self.fdcg("inspect", "--json", out).stdout)
        self.assertEqual(12, about["connection_types"]["concave"])

    def test_a_mesh_with_errors_is_refused_with_the_report_and_nothing_is_written(self):
        mesh = self.write("fan.off", THREE_ON_AN_EDGE)
        done = self.fdcg("compile", mesh, "-o", self.path("out.fdcg"), "--depfile", self.path("d"), "--report",
                         self.path("report.json"), code=1)
        self.assertIn(b"non-manifold-edge", done.stderr)
        self.assertEqual(b"", done.stdout)
        self.assert_only("fan.off", "report.json")
        report = json.loads((self.folder / "report.json").read_text())
        jsonschema.validate(report, schema("validate-report.schema.json"))
        self.assertEqual("fail", report["files"][0]["verdict"])

    def test_a_failed_compile_leaves_the_old_file_as_it_was(self):
        out = self.write("out.fdcg", "old")
        self.fdcg("compile", self.write("fan.off", THREE_ON_AN_EDGE), "-o", out, code=1)
        self.assertEqual("old", pathlib.Path(out).read_text())
        self.assert_only("fan.off", "out.fdcg")

    def test_a_symbolic_link_stays_a_link(self):
        mesh = self.write("cube.off", CUBE)
        target = self.write("target.fdcg", "old")
        os.symlink(target, self.path("link.fdcg"))
        self.fdcg("compile", mesh, "-o", self.path("link.fdcg"), "-q")
        self.assertTrue(os.path.islink(self.path("link.fdcg")))
        self.assertEqual(b"\x89FDCG", pathlib.Path(target).read_bytes()[:5])

    def test_open_mesh_compiles_with_boundary_connections(self):
        out = self.path("open.fdcg")
        self.fdcg("compile", self.write("open.off", MISSING_FACE), "-o", out, "-q")
        about = json.loads(self.fdcg("inspect", "--json", out).stdout)
        self.assertEqual({"convex": 8, "concave": 0, "coplanar": 0, "boundary": 4}, about["connection_types"])


class Validate(Case):
    def test_json_follows_the_schema_and_counts_per_file(self):
        meshes = [self.write("cube.off", CUBE), self.write("fan.off", THREE_ON_AN_EDGE), self.path("missing.off")]
        done = self.fdcg("validate", "--format", "json", *meshes, code=3)
        report = json.loads(done.stdout)
        jsonschema.validate(report, schema("validate-report.schema.json"))
        self.assertEqual(["pass", "fail", "fail"], [file["verdict"] for file in report["files"]])
        self.assertEqual(meshes, [file["file"] for file in report["files"]])
        issues = {issue["rule"]: issue for issue in report["files"][1]["issues"]}
        self.assertEqual(1, issues["non-manifold-edge"]["total"])
        self.assertEqual([[0, 1]], [sorted(edge) for edge in issues["non-manifold-edge"]["elements"][0]["edges"]])
        self.assertEqual("unreadable", report["files"][2]["issues"][0]["rule"])

    def test_exit_code_follows_fail_on(self):
        mesh = self.write("open.off", MISSING_FACE)
        for options, code in (((), 0), (("--fail-on", "error"), 0), (("--fail-on", "warning"), 1), (("--fail-on", "note"), 1),
                              (("--fail-on", "never"), 0), (("--fail-on", "warning", "--allow", "boundary-edge"), 0)):
            self.fdcg("validate", mesh, *options, code=code)
        self.fdcg("validate", self.write("fan.off", THREE_ON_AN_EDGE), "--fail-on", "never")

    def test_several_files_give_the_gravest_code(self):
        good, bad, missing = self.write("cube.off", CUBE), self.write("fan.off", THREE_ON_AN_EDGE), self.path("missing.off")
        self.fdcg("validate", good, good)
        self.fdcg("validate", good, bad, code=1)
        self.fdcg("validate", bad, missing, good, code=3)

    def test_output_file_is_written_whole(self):
        self.fdcg("validate", self.write("cube.off", CUBE), "-o", self.path("report.txt"))
        self.assertIn("pass", (self.folder / "report.txt").read_text())
        self.assert_only("cube.off", "report.txt")

    def test_weld_is_what_joins_a_soup_of_triangles(self):
        points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
        faces = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)]
        lines = ["OFF", "12 4 0"] + [" ".join(map(str, points[v])) for face in faces for v in face]
        lines += [f"3 {3 * i} {3 * i + 1} {3 * i + 2}" for i in range(4)]
        mesh = self.write("soup.off", "\n".join(lines) + "\n")
        self.fdcg("validate", mesh, "--fail-on", "warning")
        self.fdcg("validate", mesh, "--fail-on", "warning", "--weld", "none", code=1)
        self.fdcg("validate", mesh, "--fail-on", "warning", "--weld", "0.001")


class Inspect(Case):
    def test_json_is_what_the_schema_promises(self):
        graph = self.compiled_cube("--units", "cm")
        for options in ((), ("--verify",)):
            about = json.loads(self.fdcg("inspect", "--json", graph, *options).stdout)
            jsonschema.validate(about, schema("inspect.schema.json"))
        self.assertTrue(about["verification"]["passed"])
        self.assertEqual(hashlib.sha256(CUBE.encode()).hexdigest(), about["source"]["file_sha256"])
        self.assertEqual((8, 6), (about["source"]["vertices"], about["source"]["faces"]))
        self.assertEqual("pass", about["verdict"])
        self.assertEqual([0, 0, 0], about["bounds"]["min"])
        self.assertEqual([0.01] * 3, about["bounds"]["max"])
        file_bytes = os.path.getsize(graph)
        for section in about["sections"]:
            self.assertEqual(0, section["offset"] % 64)
            self.assertLessEqual(section["offset"] + section["bytes"], file_bytes)

    def test_json_has_nulls_where_the_file_says_nothing(self):
        about = json.loads(self.fdcg("inspect", "--json", self.compiled_cube("--without", "info")).stdout)
        jsonschema.validate(about, schema("inspect.schema.json"))
        self.assertIsNone(about["source"]["file_sha256"])
        self.assertIsNone(about["options"])
        self.assertIsNone(about["verdict"])

    def test_a_density_or_a_mass_is_told_as_it_was_given(self):
        def told(*options):
            graph = self.compiled_cube("--units", "cm", *options)
            about = json.loads(self.fdcg("inspect", "--json", graph).stdout)
            jsonschema.validate(about, schema("inspect.schema.json"))
            return about["mass"], self.fdcg("inspect", graph).stdout.decode()

        mass, text = told()
        self.assertAlmostEqual(1e-6, mass["volume_m3"], delta=1e-18)
        self.assertIsNone(mass["mass_kg"])
        self.assertIsNone(mass["inertia_kg_m2"])
        self.assertIn("not known", text)
        mass, text = told("--density", "7850")
        self.assertEqual(7850, mass["density_kg_per_m3"])
        self.assertAlmostEqual(7850e-6, mass["mass_kg"], delta=1e-15)
        self.assertAlmostEqual(7850e-6 * 1e-4 / 6, mass["inertia_kg_m2"]["xx"], delta=1e-18)
        self.assertIn("7850.0 kg/m^3", text)
        self.assertEqual(0.3, told("--mass", "0.3")[0]["mass_kg"])
        self.assertIn("not in the file", told("--without", "mass")[1])

    def test_the_mesh_for_the_eye_is_listed_and_its_library_is_a_dependency(self):
        self.assertIsNone(json.loads(self.fdcg("inspect", "--json", self.compiled_cube()).stdout)["visual"])
        blocks = (ROOT / "runtime/examples/steel_and_rubber.obj").read_text()
        mesh, out = self.write("blocks.obj", "mtllib paint.mtl\n" + blocks), self.path("blocks.fdcg")
        library = self.write("paint.mtl", "newmtl steel\nKd 0 0.5 1\n")
        self.fdcg("compile", mesh, "-o", out, "--visual", "--depfile", self.path("blocks.d"))
        self.assertIn(os.path.basename(library), pathlib.Path(self.path("blocks.d")).read_text())
        about = json.loads(self.fdcg("inspect", "--json", out).stdout)
        jsonschema.validate(about, schema("inspect.schema.json"))
        self.assertEqual((32, 20), (about["visual"]["vertices"], about["visual"]["triangles"]))
        self.assertEqual([("steel", [0, 0.5, 1, 1]), ("rubber", [1, 1, 1, 1])],
                         [(m["name"], m["base_colour"]) for m in about["visual"]["materials"]])
        sizes = {section["name"]: section["bytes"] for section in about["sections"]}
        self.assertEqual((1280, 240, 80, 192), tuple(sizes["visual-" + name] for name in ("vertices", "indices", "nodes", "materials")))
        self.assertIn("32 vertices, 20 triangles: steel (10), rubber (10)", self.fdcg("inspect", out).stdout.decode())
        with open(library, "w") as changed:
            changed.write("newmtl steel\nKd 1 0 0\n")
        self.assertIn("would overwrite", self.fdcg("compile", mesh, "-o", library, "--visual", code=2).stderr.decode())

    def test_images_of_heights_are_listed_and_are_dependencies(self):
        self.assertIsNone(json.loads(self.fdcg("inspect", "--json", self.compiled_cube()).stdout)["heights"])
        for name in ("tile.obj", "tile.mtl", "weave.png"):
            shutil.copy(ROOT / "testdata/heights" / name, self.path(name))
        mesh, out = self.path("tile.obj"), self.path("tile.fdcg")
        self.fdcg("compile", mesh, "-o", out, "--units", "cm", "--heights", "file", "--depfile", self.path("tile.d"))
        needed = pathlib.Path(self.path("tile.d")).read_text()
        self.assertIn("tile.mtl", needed)
        self.assertIn("weave.png", needed)
        about = json.loads(self.fdcg("inspect", "--json", out).stdout)
        jsonschema.validate(about, schema("inspect.schema.json"))
        self.assertEqual([{"width": 64, "height": 64, "levels": 6, "nodes": 1}], about["heights"]["maps"])
        self.assertAlmostEqual(6e-5, about["heights"]["most_m"], delta=4e-5)
        sizes = {section["name"]: section["bytes"] for section in about["sections"]}
        texels = 2 * 64 * 64 + 32 * 32 + 16 * 16 + 8 * 8 + 4 * 4
        self.assertEqual((6 * 48, 40, 2 * texels), tuple(sizes[name] for name in ("places", "height-maps", "height-texels")))
        self.assertIn("64 x 64 texels in 6 levels (1 nodes)", self.fdcg("inspect", out).stdout.decode())
        refused = self.fdcg("compile", mesh, "-o", out, "--heights", self.path("weave.png"), code=2).stderr.decode()
        self.assertIn("--height-range", refused)
        self.fdcg("compile", mesh, "-o", out, "--heights", self.path("weave.png"), "--height-range", "0.0001", "--depfile", self.path("tile.d"))
        self.assertIn("weave.png", pathlib.Path(self.path("tile.d")).read_text())
        with open(self.path("weave.png"), "r+b") as image:
            image.truncate(300)
        damaged = self.fdcg("compile", mesh, "-o", out, "--heights", "file", code=3).stderr.decode()
        self.assertIn("weave.png: is no PNG image that can be read (it ends early); save it as PNG again", damaged)
        os.remove(self.path("weave.png"))
        self.assertIn("weave.png", self.fdcg("compile", mesh, "-o", out, "--heights", "file", code=3).stderr.decode())

    def test_normal_textures_and_haptic_materials_of_gltf_are_listed(self):
        seeds = ROOT / "testdata/fuzz/import_gltf"
        out = self.path("sheet.fdcg")
        self.fdcg("compile", str(seeds / "normal-texture"), "-o", out, "--heights", "file")
        self.assertEqual([(3, 2, 1)], [(m["width"], m["height"], m["nodes"])
                                       for m in json.loads(self.fdcg("inspect", "--json", out).stdout)["heights"]["maps"]])
        mesh = str(seeds / "haptic-material")
        self.fdcg("compile", mesh, "-o", out)
        self.assertIsNone(json.loads(self.fdcg("inspect", "--json", out).stdout)["physics"])
        self.fdcg("compile", mesh, "-o", out, "--haptic-materials")
        about = json.loads(self.fdcg("inspect", "--json", out).stdout)
        jsonschema.validate(about, schema("inspect.schema.json"))
        [material] = about["physics"]["haptic_materials"]
        self.assertEqual(("haptic materials[0]", None), (material["name"], material["friction"]))
        self.assertTrue(0 <= material["stiffness"]["least"] < material["stiffness"]["mean"] < material["stiffness"]["most"] <= 1)
        self.assertEqual(["haptic materials[0]"], [m["name"] for m in about["materials"]["list"]])
        self.assertIn("haptic material \"haptic materials[0]\": stiffness 0.", self.fdcg("inspect", out).stdout.decode())
        told = self.fdcg("compile", str(seeds / "normal-texture"), "-o", out, "--haptic-materials").stderr.decode()
        self.assertIn("the file states no MPEG_haptic_material", told)

    def test_a_material_library_that_is_not_read_is_told(self):
        blocks = (ROOT / "runtime/examples/steel_and_rubber.obj").read_text()
        out = self.path("blocks.fdcg")
        mesh = self.write("blocks.obj", "mtllib ../paint.mtl\nmtllib gone.mtl\n" + blocks)
        said = self.fdcg("compile", mesh, "-o", out, "--visual").stderr.decode()
        self.assertIn("its material library '../paint.mtl' was not read: it is not in the mesh's folder or beneath it; copy it there", said)
        self.assertIn("its material library 'gone.mtl' is not there; put it beside the mesh, or remove the line mtllib", said)
        self.assertNotIn("material library", self.fdcg("compile", mesh, "-o", out).stderr.decode())

    def test_an_open_mesh_has_no_mass_and_says_why(self):
        lid_off = CUBE.replace("8 6 0", "8 5 0").replace("4 4 5 6 7\n", "")
        mesh, out = self.write("open.off", lid_off), self.path("open.fdcg")
        self.assertIn(b"not closed: 4 edges", self.fdcg("compile", mesh, "-o", out).stdout)
        about = json.loads(self.fdcg("inspect", "--json", out).stdout)
        jsonschema.validate(about, schema("inspect.schema.json"))
        self.assertIsNone(about["mass"])
        self.assertIn("not closed: 4 edges", about["no_mass"])
        for option in ("--density", "--mass"):
            os.remove(out)
            self.assert_one_line(self.fdcg("compile", mesh, "-o", out, option, "2", code=1), "open.off", "4 edges", "vertex 5 to 4")
            self.assert_only("open.off")
            self.write("open.fdcg", b"")

    def test_dump_names_every_record(self):
        for precision in ("f64", "f32"):
            text = self.fdcg("inspect", "--dump", self.compiled_cube("--precision", precision)).stdout.decode().splitlines()
            for noun, count in (("node", 6), ("connection", 12), ("corner", 8), ("  side", 24)):
                self.assertEqual(count, sum(line.startswith(noun + " ") and line.split(":")[0][len(noun) + 1:].isdigit()
                                            for line in text), noun)

    def test_verify_says_what_was_checked(self):
        text = self.fdcg("inspect", "--verify", self.compiled_cube()).stdout.decode()
        self.assertIn("checksums", text)
        self.assertNotIn("FAIL", text)

    def test_verify_measures_geometry_that_a_wrong_writer_sealed_with_right_checksums(self):
        graph = pathlib.Path(self.compiled_cube())
        whole = graph.read_bytes()
        count = struct.unpack_from("<I", whole, 28)[0]
        starts = {}
        for i in range(count):
            section_id, _, offset = struct.unpack_from("<IIQ", whole, 256 + 40 * i)
            starts[section_id] = (i, offset)
        ends = sorted(offset for _, offset in starts.values()) + [len(whole)]

        def forged(section_id, at, code, value, types=None):
            data = bytearray(whole)
            entry, offset = starts[section_id]
            struct.pack_into(code, data, offset + at, value)
            struct.pack_into("<Q", data, 256 + 40 * entry + 24, checksum(bytes(data[offset:ends[ends.index(offset) + 1]])))
            if types:
                struct.pack_into("<4I", data, 160, *types)
            struct.pack_into("<Q", data, 240, checksum(bytes(data[256:ends[0]])))
            struct.pack_into("<Q", data, 248, checksum(bytes(data[:248])))
            graph.write_bytes(data)

        for section_id, at, code, value, types, invariant in (
                (4, 6, "<B", 1, (11, 1, 0, 0), "types agree"), (1, 24, "<d", -0.25, None, "corners lie"),
                (1, 112, "<d", 0.5, None, "Voronoi planes"), (3, 24, "<d", 0.5, None, "edges lead"),
                (5, 0, "<d", 0.5, None, "corners lie"), (12, 0, "<d", 1.001, None, "mass properties"),
                (12, 8, "<d", 0.001, None, "mass properties"), (12, 40, "<d", 0.1667, None, "mass properties"),
                (12, 72, "<d", 1e-9, None, "mass properties")):
            with self.subTest(invariant=invariant, section=section_id):
                forged(section_id, at, code, value, types)
                self.fdcg("inspect", str(graph))
                text = self.fdcg("inspect", "--verify", str(graph), code=1).stdout.decode()
                self.assertRegex(text, f"FAIL +{invariant}")

    def test_damage_is_refused_wherever_it_is(self):
        graph = pathlib.Path(self.compiled_cube())
        whole = graph.read_bytes()
        for at in (0, 8, 300, len(whole) // 2, len(whole) - 1):
            graph.write_bytes(whole[:at] + bytes([whole[at] ^ 1]) + whole[at + 1:])
            self.assert_one_line(self.fdcg("inspect", str(graph), code=3), "cube.fdcg")
        for size in (0, 8, 255, 256, len(whole) - 64):
            graph.write_bytes(whole[:size])
            self.assert_one_line(self.fdcg("inspect", str(graph), code=3), "cube.fdcg")


class BadInput(Case):
    def test_what_cannot_be_read_is_code_3_one_line_and_leaves_nothing(self):
        os.mkdir(self.path("folder.off"))
        for name, content in (("empty.off", ""), ("zeros.ply", bytes(4096)), ("noise.stl", hashlib.sha512(b"fdcg").digest() * 40),
                              ("words.obj", "this is no mesh\n"), ("cut.off", TETRAHEDRON[:40]),
                              ("promise.off", "OFF\n4000000000 4000000000 0\n0 0 0\n"), ("none.off", "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n")):
            self.write(name, content)
        names = sorted(entry.name for entry in self.folder.iterdir())
        for name in names + ["missing.off", "missing/mesh.off"]:
            with self.subTest(name=name):
                mesh = self.path(name)
                self.assert_one_line(self.fdcg("compile", mesh, "-o", self.path("out.fdcg"), code=3), name)
                done = self.fdcg("validate", "--format", "json", mesh, code=3)
                self.assert_one_line(done, name)
                report = json.loads(done.stdout)
                self.assertEqual("fail", report["files"][0]["verdict"])
                self.assertIn(report["files"][0]["issues"][0]["rule"], ("unreadable", "empty-mesh"))
                self.assert_only(*names)

    def test_a_file_without_faces_is_an_empty_mesh(self):
        mesh = self.write("none.off", "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n")
        report = json.loads(self.fdcg("validate", "--format", "json", mesh, code=3).stdout)
        self.assertEqual("empty-mesh", report["files"][0]["issues"][0]["rule"])

    def test_bad_numbers_are_findings_with_their_place(self):
        for name, mesh, rule in (("nan.off", TETRAHEDRON.replace("1 0 0", "nan 0 0"), "non-finite-coordinate"),
                                 ("inf.off", TETRAHEDRON.replace("1 0 0", "inf 0 0"), "non-finite-coordinate"),
                                 ("index.off", TETRAHEDRON.replace("3 0 3 2", "3 0 3 9"), "index-out-of-range")):
            path = self.write(name, mesh)
            done = self.fdcg("compile", path, "-o", self.path("out.fdcg"), code=1)
            self.assertIn(rule.encode(), done.stderr)
            self.assertFalse(os.path.exists(self.path("out.fdcg")))
            report = json.loads(self.fdcg("validate", "--format", "json", path, code=1).stdout)
            issues = {issue["rule"]: issue for issue in report["files"][0]["issues"]}
            self.assertEqual(1, issues[rule]["total"])
            self.assertIn("line", issues[rule]["elements"][0])

    def test_a_million_gon_is_refused_with_its_limit(self):
        count = 1_000_000
        points = (f"{math.cos(2 * math.pi * i / count):.17g} {math.sin(2 * math.pi * i / count):.17g} 0" for i in range(count))
        mesh = self.write("gon.off", f"OFF\n{count} 1 0\n" + "\n".join(points) + f"\n{count} " + " ".join(map(str, range(count))) + "\n")
        for arguments in (("validate", mesh), ("compile", mesh, "-o", self.path("gon.fdcg"))):
            self.assert_one_line(self.fdcg(*arguments, code=3), "gon.off", "1000000", "limit")
            self.assert_only("gon.off")

    def test_a_polygon_of_many_sides_compiles(self):
        count = 20_000
        lines = ["OFF", f"{2 * count} {count + 2} 0"]
        for z in (0, 1):
            lines += [f"{math.cos(2 * math.pi * i / count):.17g} {math.sin(2 * math.pi * i / count):.17g} {z}" for i in range(count)]
        lines.append(" ".join([str(count), *map(str, reversed(range(count)))]))
        lines.append(" ".join([str(count), *map(str, range(count, 2 * count))]))
        lines += [f"4 {i} {(i + 1) % count} {count + (i + 1) % count} {count + i}" for i in range(count)]
        out = self.path("drum.fdcg")
        self.fdcg("compile", self.write("drum.off", "\n".join(lines) + "\n"), "-o", out, "-q", "--coplanar", "exact")
        about = json.loads(self.fdcg("inspect", "--json", "--verify", out).stdout)
        self.assertEqual(0, about["connection_types"]["boundary"])
        self.assertEqual(0, about["connection_types"]["concave"])

    def test_unwritable_targets_are_code_3_one_line_and_leave_nothing(self):
        mesh, file = self.write("cube.off", CUBE), self.write("file", "")
        os.mkdir(self.path("folder"))
        for target in (self.path("no/such/out"), file + "/out", self.path("folder"), "/dev/full", "/proc/out"):
            with self.subTest(target=target):
                done = self.fdcg("compile", mesh, "-o", target, code=3)
                self.assert_one_line(done, target)
                self.assertEqual("no/such" in target, b"its directory does not exist" in done.stderr)
                self.assert_one_line(self.fdcg("validate", mesh, "-o", target, code=3), target)
                out = self.path("out.fdcg")
                self.assert_one_line(self.fdcg("compile", mesh, "-o", out, "-q", "--report", target, code=3), target)
                self.assert_one_line(self.fdcg("compile", mesh, "-o", out, "-q", "--depfile", target, code=3), target)
                self.assert_only("cube.off", "file", "folder")
                self.assertEqual([], os.listdir(self.path("folder")))
        self.assertTrue(pathlib.Path("/dev/full").is_char_device())

    def test_a_full_standard_output_is_noticed(self):
        mesh = self.write("cube.off", CUBE)
        graph = self.compiled_cube()
        for arguments in (("compile", mesh, "-o", "-"), ("validate", mesh), ("inspect", graph), ("inspect", "--dump", graph), ("explain",)):
            with open("/dev/full", "wb") as full:
                done = subprocess.run([FDCG, *arguments], stdout=full, stderr=subprocess.PIPE, check=False, timeout=60)
            self.assertEqual(3, done.returncode, arguments)
            self.assert_one_line(done, "standard output")

    def test_a_file_that_the_runtime_would_refuse_is_not_written(self):
        side = 72
        lines = ["OFF", f"{(side + 1) ** 2} {side * side} 0"]
        lines += [f"{x} {y} {((x * 7 + y * 13) % 11) / 10}" for y in range(side + 1) for x in range(side + 1)]
        corner = lambda x, y: y * (side + 1) + x
        lines += [f"4 {corner(x, y)} {corner(x + 1, y)} {corner(x + 1, y + 1)} {corner(x, y + 1)}" for y in range(side) for x in range(side)]
        mesh = self.write("hills.off", "\n".join(lines) + "\n")
        self.assert_one_line(self.fdcg("compile", mesh, "-o", self.path("out.fdcg"), "--no-merge", "--without", "hierarchy",
                                       code=2), "hierarchy")
        self.assert_only("hills.off")

    def test_interrupt_leaves_no_half_written_file(self):
        os.mkfifo(self.path("mesh.off"))
        for number in (signal.SIGINT, signal.SIGTERM):
            running = subprocess.Popen([FDCG, "compile", self.path("mesh.off"), "-o", self.path("out.fdcg")], stderr=subprocess.DEVNULL)
            for _ in range(500):
                if any(".part-" in entry.name for entry in self.folder.iterdir()):
                    break
                time.sleep(0.01)
            else:
                self.fail("the file beside the target never appeared")
            running.send_signal(number)
            self.assertEqual(-number, running.wait(timeout=30))
            self.assert_only("mesh.off")

    def test_a_file_name_with_odd_bytes_is_a_file_name(self):
        mesh = self.folder / os.fsdecode(b"\xff caf\xc3\xa9\n.off")
        mesh.write_text(MISSING_FACE)
        self.fdcg("compile", str(mesh), "-o", self.path("out.fdcg"))
        jsonschema.validate(json.loads(self.fdcg("validate", "--format", "json", str(mesh)).stdout), schema("validate-report.schema.json"))


class Replay(Case):
    HEADER = "t,hip_x,hip_y,hip_z,go_x,go_y,go_z,fx,fy,fz,state,feature,slip,transitions"

    def rows(self, text):
        lines = text.decode().splitlines()
        self.assertEqual(self.HEADER, lines[0])
        return [dict(zip(self.HEADER.split(","), line.split(","))) for line in lines[1:]]

    def test_log_has_a_row_a_tick_and_numbers_that_read_back_exactly(self):
        graph, path = self.compiled_cube(), self.slide()
        done = self.servo("replay", graph, "--trajectory", path, "-o", "-")
        rows = self.rows(done.stdout)
        given = [list(map(float, line.split(","))) for line in pathlib.Path(path).read_text().splitlines()[1:]]
        self.assertEqual(given, [[float(row[name]) for name in ("t", "hip_x", "hip_y", "hip_z")] for row in rows])
        self.assertEqual({"free", "face"}, {row["state"] for row in rows} & {"free", "face"})
        for row in rows:
            self.assertIn(row["state"], ("free", "face", "edge", "vertex"))
            self.assertEqual(row["state"] == "free", row["feature"] == "-1")
            if row["state"] == "free":
                self.assertEqual([0, 0, 0], [float(row[name]) for name in ("fx", "fy", "fz")])
        self.assertIn(b"step time", done.stderr)

    def test_force_is_stiffness_times_the_spring_and_slip_is_at_mu_d(self):
        graph, path = self.compiled_cube(), self.slide()
        slipping = 0
        for row in self.rows(self.servo("replay", graph, "--trajectory", path, "-o", "-", "--stiffness", "250").stdout):
            if row["state"] != "face":
                continue
            for axis in "xyz":
                self.assertAlmostEqual(250 * (float(row["go_" + axis]) - float(row["hip_" + axis])), float(row["f" + axis]), delta=1e-12)
            if row["slip"] == "1" and float(row["go_z"]) == 1.0:
                slipping += 1
                self.assertAlmostEqual(0.4, math.hypot(float(row["fx"]), float(row["fy"])) / float(row["fz"]), delta=1e-11)
        self.assertGreater(slipping, 50)

    def test_no_friction_means_no_tangential_force(self):
        graph, path = self.compiled_cube(), self.slide()
        rows = self.rows(self.servo("replay", graph, "--trajectory", path, "-o", "-", "--mu-s", "0", "--mu-d", "0").stdout)
        on_top = [row for row in rows if row["state"] == "face" and float(row["go_z"]) == 1.0]
        self.assertGreater(len(on_top), 50)
        for row in on_top:
            self.assertLess(abs(float(row["fx"])) + abs(float(row["fy"])), 1e-9)

    def test_a_relief_is_felt_as_its_heights_say(self):
        graph = self.compiled_cube("--units", "cm")
        places = [0.0101] * 5 + [0.0085] * 60
        path = self.write("ridges.csv", "t,x,y,z\n" + "".join(f"{i / 1000},{0.002 + 1e-4 * i},0.005,{z}\n" for i, z in enumerate(places)))
        logs = [self.servo("replay", graph, "--trajectory", path, "-o", "-", "--mu-s", "0", "--mu-d", "0", "--relief", "ridges=1e-4,1e-3").stdout
                for _ in range(2)]
        self.assertEqual(*logs)
        wave = 2 * math.pi / 1e-3
        for row in self.rows(logs[0])[7:]:
            x = float(row["hip_x"])
            self.assertAlmostEqual(1.5 + 0.1 * math.sin(wave * x), float(row["fz"]), delta=1e-5)
            self.assertAlmostEqual(-1e-4 * wave * math.cos(wave * x) * float(row["fz"]), float(row["fx"]), delta=1e-4)

    def test_a_relief_of_images_is_that_of_the_file(self):
        graph = self.path("tile.fdcg")
        self.fdcg("compile", str(ROOT / "testdata/heights/tile.obj"), "-o", graph, "--units", "cm", "--heights", "file")
        path = self.write("stroke.csv", "t,x,y,z\n0,0,0,0.01\n" + "".join(f"{i / 1000},{1e-4 * i},0,0.0035\n" for i in range(1, 200)))
        flat, felt = (self.rows(self.servo("replay", graph, "--trajectory", path, "-o", "-", *relief).stdout)
                      for relief in ((), ("--relief", "image")))
        largest = max(abs(float(a["fz"]) - float(b["fz"])) for a, b in zip(flat, felt))
        self.assertGreater(largest, 0.01)
        refused = self.servo("replay", self.compiled_cube(), "--path", "slide", "--relief", "image", code=2).stderr.decode()
        self.assertIn("--relief image: the file has no heights: compile the mesh with --heights", refused)

    def test_effects_come_on_top_of_what_the_step_and_a_relief_give(self):
        graph = self.compiled_cube("--units", "cm")
        path = self.write("press.csv", "t,x,y,z\n" + "".join(f"{i / 1000},0.005,0.005,{0.0101 if i < 5 else 0.0085}\n" for i in range(60)))
        relief, tone = ("--relief", "bumps=1e-5,1e-3"), ("--effect", "vibration,force_n=0.5,frequency_hz=100,along=axis")
        up = ("--effect", '{"kind": "viscosity", "viscosity_n_s_per_m": 2, "when": "always"}')
        plain, felt, both = (self.rows(self.servo("replay", graph, "--trajectory", path, "-o", "-", *relief, *effects).stdout)
                             for effects in ((), tone, (*tone, *up)))
        for i, (without, with_tone, with_both) in enumerate(zip(plain, felt, both)):
            wave = 0.5 * min(1, 0.2 * (i - 4)) * math.sin(2 * math.pi * 0.1 * (i - 5)) if i >= 5 else 0  # a ramp of 5 ms
            self.assertAlmostEqual(float(without["fz"]) + wave, float(with_tone["fz"]), delta=1e-12)
            if i < 5 or i > 50:
                self.assertAlmostEqual(float(with_tone["fz"]), float(with_both["fz"]), delta=1e-3)
        # 1.6 mm down in a millisecond
        self.assertGreater(max(float(b["fz"]) - float(a["fz"]) for a, b in zip(felt, both)), 0.3)
        for words, reason in (("vibration,force_n=0.5", "frequency_hz is missing"), ("glue,force_n=1", 'kind is "glue"'),
                              ("magnet,force_n=1,distance_m=0.01,material=wood", "the graph has no material 'wood'"),
                              ("tap;1", 'kind is "tap;1"'), ("tap,1", "is not KIND,KEY=VALUE,...")):
            refused = self.servo("replay", graph, "--trajectory", path, "--effect", words, code=2).stderr.decode()
            self.assertIn(reason, refused)

    def test_twice_gives_the_same_bytes(self):
        graph, path = self.compiled_cube(), self.slide(9000)
        logs = []
        for name in ("a.csv", "b.csv"):
            done = self.servo("replay", graph, "--trajectory", path, "-o", self.path(name))
            self.assertIn(b"step time", done.stdout)
            logs.append((self.folder / name).read_bytes())
        self.assertEqual(9001, logs[0].count(b"\n"))
        self.assertEqual(logs[0], logs[1])

    def test_columns_are_found_by_name(self):
        graph = self.compiled_cube()
        plain = self.write("plain.csv", "t,x,y,z\n0,0.5,0.5,1.1\n0.001,0.5,0.5,0.9\n")
        odd = self.write("odd.csv", "\ufeffz,\"note\",y , t,x,fx\r\n1.1,\"a, b\",0.5,0,0.5,7\r\n\r\n0.9,,0.5,1e-3,+0.5,\r\n")
        logs = [self.servo("replay", graph, "--trajectory", path, "-o", "-").stdout for path in (plain, odd)]
        self.assertEqual(logs[0], logs[1])
        self.assertIn(b",face,", logs[0])

    def test_bad_rows_are_code_3_with_line_value_and_reason(self):
        graph = self.compiled_cube()
        for text, words in (("", ("empty",)), ("t,x,y\n0,0,0\n", ("line 1", "'z'")), ("t,x,y,z,x\n", ("line 1", "'x'", "twice")),
                            ("t,x,y,z\n", ("no row",)), ("t,x,y,z\n0,0,0\n", ("line 2", "3 columns")),
                            ("t,x,y,z\n0,0,0,0\n1,0,zero,0\n", ("line 3", "'y'", "'zero'")),
                            ("t,x,y,z\n0,0,0,0\n\n1,0,0,1e999\n", ("line 4", "'z'", "'1e999'")),
                            ("t,x,y,z\nnan,0,0,0\n", ("line 2", "time")), ("t,x,y,z\n0,,0,0\n", ("line 2", "'x'", "''"))):
            path = self.write("bad.csv", text)
            done = self.servo("replay", graph, "--trajectory", path, "-o", self.path("log.csv"), code=3)
            self.assert_one_line(done, "bad.csv", *words)
            self.assert_only("bad.csv", "cube.fdcg", "cube.off")

    def test_a_hip_that_is_not_finite_is_counted_and_gives_no_force(self):
        path = self.write("nan.csv", "t,x,y,z\n0,0.5,0.5,1.1\n0.001,0.5,0.5,0.9\n0.002,nan,0.5,0.9\n0.003,0.5,0.5,0.9\n")
        done = self.servo("replay", self.compiled_cube(), "--trajectory", path, "-o", "-")
        rows = self.rows(done.stdout)
        self.assertEqual(["free", "face", "face", "face"], [row["state"] for row in rows])
        self.assertEqual(["0", "0", "0"], [rows[2][name] for name in ("fx", "fy", "fz")])
        self.assertGreater(float(rows[3]["fz"]), 0)
        self.assertIn(b"\n1 tick with a HIP that is NaN", done.stderr)

    def test_wrong_usage_and_bad_files(self):
        graph, path = self.compiled_cube(), self.slide(10)
        for arguments, code, words in (
            ((), 2, ()), (("run", "scene.json"), 3, ("scene.json",)), (("replay", graph), 2, ("--trajectory",)),
            (("replay", graph, "--trajectory", path, "--mu-s", "0.3"), 2, ("--mu-s", "0.3", "0.4", "default")),
            (("replay", graph, "--trajectory", path, "--mu-d", "-1"), 2, ("--mu-d", "'-1'")),
            (("replay", graph, "--trajectory", path, "--stiffness", "nan"), 2, ("--stiffness", "'nan'")),
            (("replay", graph, "--trajectory", path, "--edge-friction", "glue"), 2, ("wedge, paper",)),
            (("replay", graph, "--trajectory", path, "--relief", "ridges=1e-4"), 2, ("--relief", "ridges=1e-4")),
            (("replay", graph, "--trajectory", path, "--relief", "grain=1e-4,1e-3,nan"), 2, ("grain=1e-4,1e-3,nan",)),
            (("replay", graph, "--trajectory", path, "--relief", "bumps=1e-4,0"), 2, ("--relief",)),
            (("replay", graph, "--trajectory", path, "--shading"), 2, ("no normals", "--normals faces")),
            (("replay", graph, "--trajectory", path, "-o", path), 2, ("overwrite",)),
            (("replay", self.path("missing.fdcg"), "--trajectory", path), 3, ("missing.fdcg",)),
            (("replay", path, "--trajectory", path), 3, ("hip.csv",)),
            (("replay", graph, "--trajectory", self.path("missing.csv")), 3, ("missing.csv",)),
            (("replay", graph, "--trajectory", str(self.folder)), 3, (str(self.folder),)),
            (("replay", graph, "--trajectory", path, "-o", self.path("no/log.csv")), 3, ("no/log.csv",)),
            (("replay", graph, "--trajectory", path, "-o", "/dev/full"), 3, ("/dev/full",)),
        ):
            with self.subTest(arguments=arguments):
                self.assert_one_line(self.servo(*arguments, code=code), *words)
                self.assert_only("cube.off", "cube.fdcg", "hip.csv")


if __name__ == "__main__":
    unittest.main()
