#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Formats that hold scenes, as other programs wrote them: points, faces and units as an independent reader has them."""
import json
import os
import pathlib
import subprocess
import unittest

import numpy
import scene_reference
from real_files import ASSIMP_MODELS
from support import CUBE, FDCG, ROOT, TETRAHEDRON, Case

# what fdcg refuses, and the word that says why
REFUSED = {"malformed_property_index_oob.3mf": "1000000", "cameras.dae": "no face", "lights.dae": "no face"}


def scene_files():
    named = os.environ.get("FDCG_REAL_MESHES")
    roots = [pathlib.Path(named) if named else ROOT / ".." / "shared" / "meshes", ASSIMP_MODELS]
    return sorted(path for root in roots if root.is_dir() for path in root.rglob("*") if path.suffix.lower() in (".dae", ".3mf"))


def read_off(path):
    words = iter(path.read_text().split())
    next(words)
    points, faces, _ = int(next(words)), int(next(words)), next(words)
    xyz = [tuple(float(next(words)) for _ in range(3)) for _ in range(points)]
    return xyz, [[int(next(words)) for _ in range(int(next(words)))] for _ in range(faces)]


def exported(case, path):
    """All points and faces as they were read; the mesh may have errors."""
    off = case.folder / "mesh.off"
    subprocess.run((FDCG, "repair", path, "--weld", "none", "-o", off, "-q"), stdin=subprocess.DEVNULL, capture_output=True, timeout=120, check=False)
    return off


class RealFiles(Case):
    def test_as_an_independent_reader_has_them(self):
        files = scene_files()
        if not files:
            self.skipTest("no COLLADA or 3MF files at hand")
        compared = 0
        for path in files:
            with self.subTest(path=str(path)):
                if path.name in REFUSED:
                    done = self.fdcg("validate", path, code=3)
                    self.assertIn(REFUSED[path.name], done.stderr.decode())
                    continue
                self.compare(path)
                compared += 1
        self.assertGreater(compared, 0)

    def compare(self, path):
        want = scene_reference.read(path)
        points, faces = read_off(exported(self, path))
        self.assertEqual(faces, want.faces)
        self.assertEqual(len(points), len(want.points))
        ours, theirs = numpy.array(points), numpy.array(want.points)
        if not want.is_moved:
            self.assertTrue((ours == theirs).all(), "a point differs, and none was moved")
        off_by = numpy.abs(ours - theirs).max()
        self.assertLessEqual(off_by, 8 * numpy.spacing(numpy.abs(theirs).max()))


class Commands(Case):
    GOOD = ROOT / "testdata" / "meshes" / "good"

    def metres_per_unit(self, mesh, *options):
        self.fdcg("compile", self.GOOD / mesh, "-o", self.path("a.fdcg"), "-q", *options)
        return json.loads(self.fdcg("inspect", self.path("a.fdcg"), "--json").stdout)["metres_per_unit"]

    def test_a_stated_unit_is_taken_unless_one_is_given(self):
        self.assertEqual(0.001, self.metres_per_unit("cube_quads.dae"))
        self.assertEqual(0.001, self.metres_per_unit("cube_package.3mf"))
        self.assertEqual(1, self.metres_per_unit("cube_faces.x3d"))
        self.assertEqual(1, self.metres_per_unit("cube_quads.off"))
        self.assertEqual(0.0254, self.metres_per_unit("cube_quads.dae", "--units", "in"))
        self.assertEqual(1, self.metres_per_unit("cube_quads.dae", "--units", "m"))
        done = self.fdcg("compile", self.GOOD / "cube_quads.dae", "-o", self.path("a.fdcg"))
        self.assertIn(b"1 unit = 0.001 m (the file's own)", done.stdout)

    def test_repair_says_that_a_unit_is_dropped(self):
        done = self.fdcg("repair", self.GOOD / "cube_quads.dae", "-o", self.path("a.obj"), "--all", "--report", self.path("r.json"))
        self.assertIn(b"states 1 unit = 0.001 m, which the written formats cannot hold; compile the result with --scale 0.001",
                      done.stdout)
        self.assertEqual(0.001, json.loads((self.folder / "r.json").read_text())["metres_per_unit"])
        done = self.fdcg("repair", self.GOOD / "cube_quads.off", "-o", self.path("b.obj"), "--all", "--report", self.path("r.json"))
        self.assertNotIn(b"unit", done.stdout)
        self.assertIsNone(json.loads((self.folder / "r.json").read_text())["metres_per_unit"])

    def test_physics_of_gltf_is_in_the_file_and_listed(self):
        node = {"name": "crate", "extensions": {"KHR_physics_rigid_bodies": {
            "motion": {"mass": 2.5}, "collider": {"geometry": {"shape": 0}, "physicsMaterial": 0}}}}
        ball = {"name": "ball", "extensions": {"KHR_physics_rigid_bodies": {"collider": {"geometry": {"shape": 1}}}}}
        scene = {"asset": {"version": "2.0"}, "nodes": [node, ball], "extensions": {
            "KHR_implicit_shapes": {"shapes": [{"type": "box", "box": {"size": [0.1, 0.2, 0.3]}}, {"type": "sphere", "sphere": {"radius": 0.05}}]},
            "KHR_physics_rigid_bodies": {"physicsMaterials": [{"name": "wood", "staticFriction": 0.5, "dynamicFriction": 0.4, "frictionCombine": "multiply"}]}}}
        mesh = self.write("crate.gltf", json.dumps(scene))
        done = self.fdcg("compile", mesh, "-o", self.path("a.fdcg"))
        self.assertIn(b"the file states 2.5 kg for 'crate'; --mass 2.5 takes it", done.stdout)
        about = json.loads(self.fdcg("inspect", self.path("a.fdcg"), "--json").stdout)
        self.assertEqual([{"name": "wood", "nodes": 6}], about["materials"]["list"])
        self.assertEqual([{"name": "wood", "static_friction": 0.5, "dynamic_friction": 0.4, "restitution": 0.0, "friction_combine": "multiply",
                           "restitution_combine": None}], about["physics"]["materials"])
        self.assertEqual([("crate", 2.5, False)], [(b["node"], b["mass_kg"], b["kinematic"]) for b in about["physics"]["bodies"]])
        self.assertEqual([({"kind": "box", "half_m": [0.05, 0.1, 0.15]}, True), ({"kind": "sphere", "radius_m": 0.05}, False)],
                         [(s["surface"], s["in_mesh"]) for s in about["physics"]["shapes"]])
        text = self.fdcg("inspect", self.path("a.fdcg")).stdout.decode()
        self.assertIn('  physics      material "wood": friction 0.5 static, 0.4 dynamic (combined: multiply), restitution 0.0\n', text)
        self.assertIn('               body "crate": 2.5 kg\n', text)
        self.assertIn('               shape "ball": {"kind":"sphere","radius_m":0.05}\n', text)
        self.fdcg("compile", self.GOOD / "cube_quads.off", "-o", self.path("b.fdcg"), "-q")
        self.assertIsNone(json.loads(self.fdcg("inspect", self.path("b.fdcg"), "--json").stdout)["physics"])

    def test_a_robot_stands_for_its_meshes(self):
        self.write("cube.off", CUBE)
        self.write("open.off", TETRAHEDRON.replace("4 4 0", "4 3 0").replace("3 0 3 2\n", ""))
        robot = self.write("robot.urdf", "<robot name='r'><link name='a'>" + "".join(
            f"<visual><geometry><mesh filename='{name}'/></geometry></visual>"
            for name in ("cube.off", "cube.off' scale='-2 2 2", "open.off", "gone.stl")) + "</link></robot>")
        done = self.fdcg("validate", robot, "--format", "json", code=3)
        reports = json.loads(done.stdout)["files"]
        self.assertEqual(4, len(reports))
        self.assertEqual(["cube.off", "cube.off", "open.off", "gone.stl"], [pathlib.Path(r["file"]).name for r in reports])
        self.assertEqual([[], [], ["boundary-edge"], ["unreadable"]], [[i["rule"] for i in r["issues"]] for r in reports])
        self.assertIn(b"robot.urdf: names 4 meshes, 1 of them with a scale", done.stderr)
        self.assertIn(b"link 'a'", done.stderr)
        done = self.fdcg("compile", robot, "-o", self.path("a.fdcg"), code=3)
        self.assert_one_line(done, "robot.urdf", "fdcg validate")

    def test_a_search_names_what_it_skipped(self):
        self.write("cube.off", CUBE)
        for name in ("b.fbx", "a.STEP"):
            self.write(name, "x")
        done = self.fdcg("validate", self.folder)
        self.assert_one_line(done, "skipped 2 mesh files", "a.STEP", "b.fbx")
        self.assertEqual(b"", self.fdcg("validate", self.folder, "-q").stderr)

    def test_formats_that_are_not_read_are_refused_with_how_to_convert_them(self):
        for start, words in (("Kaydara FBX Binary  \0", ("FBX", "glTF")), ("ISO-10303-21;", ("STEP", "mesh it")),
                             ("PXR-USDC", ("USD", "glTF")), ("#usda 1.0", ("USD", "glTF")), ("BLENDER-v300", ("Blender", "export"))):
            done = self.fdcg("compile", self.write("mesh.bin", start), "-o", self.path("a.fdcg"), code=3)
            self.assert_one_line(done, *words)


if __name__ == "__main__":
    unittest.main()
