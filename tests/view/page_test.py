# SPDX-License-Identifier: Apache-2.0
"""What fdcg view writes: all of the mesh, of the findings and of the graph, in one file that asks for nothing else."""
import json
import os
import re
import shutil
import struct
import unittest

from pages import CUBE, FDCG, NON_MANIFOLD, ROOT, TETRAHEDRON, Page, PageCase

EVIL = "<img src=x onerror=alert(1)></script><script>document.title='gone!'</script>"


class Pages(PageCase):
    def test_a_mesh_is_there_with_every_face_and_a_graph(self):
        page = self.page(self.write("cube.off", CUBE), "--scale", "0.05")
        item, = page.items
        geometry = item["geometry"]
        self.assertEqual([4] * 6, page.words(geometry["sizes"]))
        self.assertEqual([0, 3, 2, 1, 4, 5, 6, 7, 0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7], page.words(geometry["corners"]))
        points = struct.unpack("<24f", page.array(geometry["points"]))
        placed = [[x * geometry["size"] + c for x, c in zip(points[i:i + 3], geometry["centre"])] for i in range(0, 24, 3)]
        self.assertEqual([list(map(float, line.split())) for line in CUBE.splitlines()[2:10]], placed)
        self.assertEqual("pass", item["report"]["verdict"])

    def test_the_graph_is_what_compile_makes_with_the_options_that_the_page_names(self):
        mesh = self.write("cube.off", CUBE)
        for options in ((), ("--precision", "f64", "--units", "mm"), ("--normals", "faces", "--crease", "100")):
            page = self.page(mesh, *options)
            self.fdcg("compile", mesh, "-o", self.path("cube.fdcg"), "-q", *page.items[0]["compile_options"].split())
            self.assertEqual((self.folder / "cube.fdcg").read_bytes(), page.array(page.items[0]["graph"]))

    def test_heights_are_in_the_graph_and_an_image_that_is_not_there_is_an_error(self):
        for name in ("tile.obj", "tile.mtl", "weave.png"):
            shutil.copy(ROOT / "testdata" / "heights" / name, self.folder)
        for options in (("--heights", "file"), ("--heights", self.path("weave.png"), "--height-range", "0.0001")):
            page = self.page(self.path("tile.obj"), "--units", "cm", *options)
            self.fdcg("compile", self.path("tile.obj"), "-o", self.path("tile.fdcg"), "-q", *page.items[0]["compile_options"].split())
            self.assertEqual((self.folder / "tile.fdcg").read_bytes(), page.array(page.items[0]["graph"]))
            self.assertIn("up to", self.fdcg("inspect", self.path("tile.fdcg")).stdout.decode().split("heights", 1)[1])
        (self.folder / "weave.png").unlink()
        self.assert_one_line(self.fdcg("view", self.path("tile.obj"), "--heights", "file", "-o", self.path("gone.html"), code=3), "weave.png")

    def test_findings_are_those_of_validate(self):
        mesh = self.write("bad.off", NON_MANIFOLD)
        item, = self.page(mesh).items
        found = json.loads(self.fdcg("validate", mesh, "--format", "json", code=1).stdout)["files"][0]
        self.assertEqual(found["issues"], item["report"]["issues"])
        self.assertNotIn("graph", item)
        self.assertIn("errors", item["no_graph"])
        self.fdcg("validate", mesh, "--format", f"html={self.path('report.html')}", code=1)
        self.assertEqual(found["issues"], Page(self.path("report.html")).items[0]["report"]["issues"])

    def test_what_repair_does_stands_beside_it(self):
        item, = self.page(self.write("bad.off", NON_MANIFOLD.replace("3 3 5 4", "3 3 4 5")), "--repair").items
        self.assertIn("geometry", item["repaired"])
        self.assertIn("verdict", item["repaired"]["report"])

    def test_a_graph_and_its_log_are_one_item(self):
        graph = self.compiled_cube()
        self.servo("replay", graph, "--trajectory", self.slide(), "-o", self.path("log.csv"), "-q")
        page = self.page(graph, self.path("log.csv"))
        item, = page.items
        self.assertEqual((self.folder / "cube.fdcg").read_bytes(), page.array(item["graph"]))
        self.assertEqual((self.folder / "log.csv").read_bytes(), page.array(item["log"]))

    def test_a_robot_is_the_meshes_that_it_names_at_their_scale(self):
        self.write("cube.off", CUBE)
        robot = self.write("robot.urdf", "<robot name='r'><link name='a'>" + "".join(
            f"<visual><geometry><mesh filename='{name}'/></geometry></visual>"
            for name in ("cube.off", "cube.off' scale='-2 2 2", "gone.stl")) + "</link></robot>")
        done = self.fdcg("view", robot, "-o", self.path("robot.html"), code=3)
        self.assertIn(b"names 3 meshes, 1 of them with a scale", done.stderr)
        self.assertIn(b"gone.stl", done.stderr)
        page = Page(self.path("robot.html"))
        self.assertIn("<title>robot.urdf - fdcg</title>", page.text)
        self.assertEqual(["pass", "pass", "fail"], [item["report"]["verdict"] for item in page.items])
        self.assertEqual([-1, 1, 1], page.items[1]["geometry"]["centre"])
        self.assertIn("graph", page.items[1])

    def test_the_unit_that_a_mesh_states_is_that_of_its_graph(self):
        item, = self.page(str(ROOT / "testdata" / "meshes" / "good" / "cube_quads.dae")).items
        self.assertIn("--scale 0.001", item["compile_options"])
        item, = self.page(str(ROOT / "testdata" / "meshes" / "good" / "cube_quads.dae"), "--units", "m").items
        self.assertNotIn("--scale", item["compile_options"])

    def test_the_same_inputs_give_the_same_bytes(self):
        mesh = self.write("cube.off", CUBE)
        first = self.view(mesh, "--jobs", "1", name="a.html")
        second = self.view(mesh, "--jobs", "4", name="b.html")
        self.assertEqual(open(first, "rb").read(), open(second, "rb").read())

    def test_the_page_names_no_address_that_a_browser_would_ask_for(self):
        text = re.sub(r'<script type="text/plain"[^>]*>[^<]*</script>', "", open(self.view(self.write("cube.off", CUBE))).read())
        self.assertIn("default-src 'none'", text)
        for asks in (r"<(link|img|iframe|script)[^>]+(src|href)=", r"@import|url\(\s*['\"]?(https?:|//)"):
            self.assertIsNone(re.search(asks, text), asks)


class Hostile(PageCase):
    def test_names_and_materials_cannot_leave_their_place(self):
        self.write("m.obj", f"mtllib x.mtl\no {EVIL}\nusemtl {EVIL}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n")
        name = "<img onerror=alert(1) src=x>.obj"
        (self.folder / "m.obj").rename(self.folder / name)
        page = self.page(str(self.folder / name))
        for sign in ("<img", "</script><script>document", "gone!"):  # none that numbers in base 64 may spell
            self.assertEqual(0, page.text.count(sign), sign)
        item, = page.items
        self.assertIn("onerror", item["materials"][0])
        self.assertTrue(item["name"].endswith(name))

    def test_a_name_that_is_no_text(self):
        path = bytes(self.folder) + b"/\xff\xfe.off"
        with open(path, "wb") as file:
            file.write(TETRAHEDRON.encode())
        self.fdcg("view", path, "-o", self.path("page.html"))
        self.assertEqual(1, len(Page(self.path("page.html")).items))


class Wrong(PageCase):
    def test_what_cannot_be_read_leaves_no_page(self):
        self.assert_one_line(self.fdcg("view", self.path("absent.off"), "-o", self.path("p.html"), code=3), "absent.off")
        self.assert_one_line(self.fdcg("view", self.write("broken.fdcg", b"\x89FDCG\r\n\x1a" + bytes(300)), "-o", self.path("p.html"), code=3),
                             "broken.fdcg")
        self.assert_only("broken.fdcg")

    def test_of_several_inputs_the_others_are_shown(self):
        path = self.view(self.write("cube.off", CUBE), self.path("absent.off"), code=3)
        items = Page(path).items
        self.assertEqual(["pass", "fail"], [item["report"]["verdict"] for item in items])

    def test_the_page_does_not_overwrite_an_input(self):
        mesh = self.write("cube.off", CUBE)
        self.fdcg("view", mesh, "-o", mesh, code=2)
        self.assertEqual(CUBE, open(mesh).read())


class Gallery(PageCase):
    """tools/pages with the programs of this build."""

    @unittest.skipUnless(os.path.exists("/usr/share/doc/libcgal-dev/data.tar.gz"), "libcgal-demo is not installed")
    def test_every_card_leads_to_a_page(self):
        site = self.folder / "site"
        self.run_program(str(ROOT / "tools" / "pages"), "--programs", os.path.dirname(FDCG), "--output", str(site))
        index = (site / "index.html").read_text()
        names = re.findall(r'<a href="([^"]+)">', index)
        self.assertEqual(sorted([*names, "index.html"]), sorted(entry.name for entry in site.iterdir()))
        self.assertEqual(len(names), index.count("<p>") - 1)
        items = {name: Page(site / name).items[0] for name in names}
        self.assertEqual("fail", items["broken.html"]["report"]["verdict"])
        self.assertEqual("pass", items["broken.html"]["repaired"]["report"]["verdict"])
        for name in ("slide.html", "friction.html"):
            self.assertIn("log", items[name])
        for name in ("lift_cube.html", "press_sheet.html", "surfaces.html"):
            self.assertTrue(items[name]["session"]["same"], name)
        self.assertEqual(["steel", "rubber"], items["materials.html"]["materials"])
        for text in re.findall(r"<p>(.*?)</p>", index)[1:]:
            self.assertGreaterEqual(len(re.findall(r"[.]( |$)", text)), 3, text)  # three sentences, or a little more
        self.assertLess((site / "bunny.html").stat().st_size, 6_000_000)


if __name__ == "__main__":
    unittest.main()
