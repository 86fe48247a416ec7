# SPDX-License-Identifier: Apache-2.0
"""Pages in Chromium, from a file: every view by clicks and keys, judged by state and by pixels, and no request leaves."""
import math
import pathlib
import unittest

from browser import BrowserCase
from pages import CUBE, NON_MANIFOLD, ROOT, sphere

try:
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
except ImportError:
    pass

GLOW = (217, 130, 0)  # light theme


class Short(BrowserCase):
    def test_a_page_opens_flies_to_a_finding_and_asks_for_nothing(self):
        self.open(self.view(self.write("bad.off", NON_MANIFOLD)))
        before = self.state()
        self.find("next").click()
        state = self.wait_for(lambda s: s.get("rule") and not s["flying"])
        self.assertEqual("non-manifold-edge", state["rule"])
        self.assertEqual([[0, 1]], [sorted(edge) for edge in state["element"]["edges"]])
        self.assertNotEqual(before["camera"], state["camera"])
        self.assertGreater(self.share_of(GLOW), 0.002)
        self.assertTrue(state["ghost"])  # what is around it is translucent
        self.press(Keys.ESCAPE)
        self.assertFalse(self.state()["ghost"])
        self.assert_quiet()


class Findings(BrowserCase):
    def setUp(self):
        super().setUp()
        # an open box: four boundary edges, and a face that is turned round
        lines = CUBE.replace("8 6 0", "8 5 0").splitlines()
        del lines[11]
        lines[-1] = "4 7 4 0 3"
        self.open(self.view(self.write("box.off", "\n".join(lines) + "\n")))

    def rules(self):
        return [group.get_attribute("data-rule") for group in self.browser.find_elements(By.CSS_SELECTOR, ".rule")]

    def test_keys_walk_through_all_findings_and_back(self):
        self.assertIn("winding-inconsistent", self.rules())
        count = self.state()["entries"]
        seen = []
        for _ in range(count):
            self.press("n")
            seen.append((self.state()["rule"], str(self.state()["element"]["edges"])))
        self.assertEqual(count, len(set(seen)))
        self.press("p")
        self.assertEqual(seen[-2], (self.state()["rule"], str(self.state()["element"]["edges"])))
        self.press(Keys.ESCAPE)
        self.assert_quiet()

    def test_the_filter_takes_rules_and_numbers(self):
        box = self.find("filter")
        box.send_keys("boundary")
        self.wait_for(lambda s: s["entries"] == 4)
        self.assertEqual(["boundary-edge"], self.rules())
        box.clear()
        box.send_keys("vertex 4")
        self.wait_for(lambda s: 0 < s["entries"] < 9)
        box.clear()
        box.send_keys("face 1000")
        self.wait_for(lambda s: s["entries"] == 0)
        self.assertIn("Nothing matches", self.browser.find_element(By.CSS_SELECTOR, ".results").text)

    def test_a_click_on_a_face_tells_its_number(self):
        self.canvas().click()
        hint = self.browser.find_element(By.CSS_SELECTOR, ".hint")
        self.assertRegex(hint.text, r"^face \d+ .*vertices \d+, \d+, \d+, \d+")

    def test_edges_winding_theme_and_help_by_keys(self):
        self.press("e")
        self.assertTrue(self.state()["edges"])
        self.assertEqual(12, self.state()["edgeCount"])  # of a box, each once
        orange = (200, 102, 42)
        self.press("t")
        self.press("t")
        with_winding = self.share_of(orange)
        self.press("w")
        self.assertLess(self.share_of(orange), with_winding)
        self.press("?")
        self.assertTrue(self.browser.find_element(By.CSS_SELECTOR, "dialog").get_attribute("open"))
        self.browser.find_element(By.CSS_SELECTOR, "dialog summary").click()
        self.wait_for(lambda s: "three.js" in self.browser.find_element(By.CSS_SELECTOR, ".licences").text)
        self.find("help-close").click()
        before = self.state()["camera"]
        self.canvas().send_keys(Keys.ARROW_LEFT)
        self.wait_for(lambda s: s["camera"] != before)


class Repair(BrowserCase):
    def test_before_after_and_both(self):
        self.open(self.view(self.write("bad.off", NON_MANIFOLD.replace("3 3 5 4", "3 3 4 5")), "--repair"))
        self.assertIn("repair", self.browser.find_element(By.CSS_SELECTOR, ".repair").text)
        self.assertEqual({"before": True, "after": False, "apart": 0}, self.state()["meshes"])
        self.find("version-after").click()
        self.wait_for(lambda s: s["meshes"]["after"] and not s["meshes"]["before"])
        self.find("version-both").click()
        state = self.wait_for(lambda s: s["meshes"]["after"] and s["meshes"]["before"])
        self.assertGreater(state["meshes"]["apart"], 1)  # beside it: the object's size is 1
        self.assert_quiet()


class Patches(BrowserCase):
    def test_each_patch_has_a_color(self):
        self.open(self.view(self.write("two.off", NON_MANIFOLD)))  # two tetrahedra, joined by an edge of four faces
        self.press("c")
        self.assertEqual({"by": "patches", "count": 2}, self.state()["colors"])
        self.assertIn("2 patches", self.browser.find_element(By.CSS_SELECTOR, ".hint").text)
        self.press("c")
        self.assertIsNone(self.state().get("colors"))

    def test_materials_have_colors_at_once(self):
        self.open(self.view(str(ROOT / "runtime" / "examples" / "steel_and_rubber.obj")))
        self.assertEqual({"by": "materials", "count": 2}, self.state()["colors"])
        self.find("show-patches").click()
        self.assertEqual({"by": "patches", "count": 1}, self.state()["colors"])
        self.assertFalse(self.find("show-materials").is_selected())

    def test_faces_of_a_soup_are_joined_where_their_coordinates_are_equal(self):
        triangles = ["0 0 0 0 1 0 1 0 0", "0 0 0 1 0 0 0 0 1", "1 0 0 0 1 0 0 0 1", "0 0 0 0 0 1 0 1 0", "5 0 0 6 0 0 5 1 0"]
        facets = []
        for triangle in triangles:
            numbers = triangle.split()
            corners = "\n".join("vertex " + " ".join(numbers[k:k + 3]) for k in (0, 3, 6))
            facets.append(f"facet normal 0 0 0\nouter loop\n{corners}\nendloop\nendfacet")
        self.open(self.view(self.write("soup.stl", "solid s\n" + "\n".join(facets) + "\nendsolid s\n")))
        self.find("show-patches").click()
        self.assertEqual({"by": "patches", "count": 2}, self.state()["colors"])


class Sight(BrowserCase):
    def test_a_face_that_is_turned_round_is_looked_at_from_outside(self):
        lines = sphere(12).splitlines()
        lines[-40] = " ".join(["3", *reversed(lines[-40].split()[1:])])
        self.open(self.view(self.write("ball.off", "\n".join(lines) + "\n")))
        for _ in range(3):
            before = self.state()["camera"]
            self.press("n")
            state = self.wait_for(lambda s, before=before: s["camera"] != before and not s["flying"])
            self.assertEqual("winding-inconsistent", state["rule"])
            self.assertGreater(math.hypot(*state["camera"]), 0.51)  # the ball's radius is 0.5


class Graph(BrowserCase):
    def setUp(self):
        super().setUp()
        self.graph = self.compiled_cube("--units", "cm")
        self.open(self.view(self.graph))

    def test_records_are_those_of_inspect(self):
        dump = self.fdcg("inspect", "--dump", self.graph).stdout.decode().split("sections\n")[1].splitlines()
        for kind, number in (("node", 3), ("connection", 7), ("corner", 5)):
            self.find("record-kind").send_keys(kind)
            box = self.find("record-number")
            box.clear()
            box.send_keys(str(number))
            self.find("record-show").click()
            state = self.wait_for(lambda s, kind=kind: s["picked"] and s["picked"]["kind"] == kind)
            start = next(i for i, line in enumerate(dump) if line.startswith(f"{kind} {number}:"))
            sides = [line for line in dump[start + 1:start + 5] if line.startswith("  ")] if kind == "node" else []
            self.assertEqual([dump[start], *sides], state["records"].splitlines())
        self.assert_quiet()

    def test_planes_of_what_is_picked_and_regions_in_colours(self):
        for kind, planes in (("node", 4), ("connection", 2), ("corner", 0)):
            self.find("record-kind").send_keys(kind)
            self.find("record-show").click()
            self.assertEqual(planes, self.wait_for(lambda s, kind=kind: s["picked"] and s["picked"]["kind"] == kind)["planes"])
        before = self.picture()
        self.find("node-colour").send_keys("by node")
        self.wait_for(lambda s: s["colours"] == "number")
        self.assertNotEqual(before, self.picture())

    def test_the_mesh_for_the_eye_has_its_materials_colours(self):
        painted = self.path("painted.obj")
        blocks = (ROOT / "runtime/examples/steel_and_rubber.obj").read_text()
        pathlib.Path(painted).write_text("mtllib paint.mtl\n" + blocks)
        pathlib.Path(self.path("paint.mtl")).write_text("newmtl steel\nKd 0 1 0\nnewmtl rubber\nKd 1 0 0\n")
        self.fdcg("compile", painted, "--units", "cm", "--visual", "-o", self.path("painted.fdcg"))
        self.open(self.view(self.path("painted.fdcg")))
        state = self.state()
        self.assertEqual(("seen", ["steel", "rubber"]), (state["colours"], state["seen"]))
        pixels = self.picture()
        of = [tuple(pixels[at:at + 3]) for at in range(0, len(pixels), 4)]
        red = sum(r > 100 > 2 * max(g, b) for r, g, b in of)
        green = sum(g > 100 > 2 * max(r, b) for r, g, b in of)
        self.assertGreater(red, 20)
        self.assertGreater(green, 20)
        self.find("node-colour").send_keys("one colour")
        self.wait_for(lambda s: s["colours"] == "plain")
        self.assertNotEqual(pixels, self.picture())
        self.assertEqual("node", self.wait_for(lambda s: self.canvas().click() or s["picked"])["picked"]["kind"])

    def test_a_click_picks_and_layers_go_on_and_off(self):
        self.canvas().click()
        self.assertEqual("node", self.wait_for(lambda s: s["picked"])["picked"]["kind"])
        self.find("edges-convex").click()
        self.assertEqual(False, self.state()["edges"][0])
        self.find("box-level").send_keys("root")
        self.wait_for(lambda s: s["boxes"] == 1)
        self.press(Keys.ESCAPE)
        self.assertIsNone(self.state()["picked"])


class Log(BrowserCase):
    def test_it_plays_scrubs_and_ends(self):
        graph = self.compiled_cube()
        self.servo("replay", graph, "--trajectory", self.slide(1000), "-o", self.path("log.csv"), "-q")
        self.open(self.view(graph, self.path("log.csv")))
        self.assertEqual(1000, self.state()["ticks"])
        rows = pathlib.Path(self.path("log.csv")).read_text().splitlines()[1:]
        self.press(".")
        self.assertEqual(1, self.state()["at"])
        self.find("scrub").send_keys(Keys.END)
        state = self.wait_for(lambda s: s["at"] == 999)
        self.assertEqual(rows[-1].split(",")[10], state["contact"])
        self.press("f")
        self.find("play").click()
        self.wait_for(lambda s: 0 < s["at"] < 999 and s["playing"])
        self.wait_for(lambda s: s["at"] == 999 and not s["playing"])
        self.assert_quiet()


class Hostile(BrowserCase):
    def test_names_do_not_become_markup(self):
        evil = "<img src=x onerror=document.title='gone'>"
        name = self.write("x.obj", f"o {evil}\nusemtl {evil}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        self.open(self.view(name))
        self.press("n")
        self.canvas().click()
        self.assertEqual([], self.browser.find_elements(By.CSS_SELECTOR, "img"))
        self.assertIn("<img", self.browser.find_element(By.CSS_SELECTOR, ".hint").text)
        self.assertNotIn("gone", self.browser.title)
        self.assert_quiet()


if __name__ == "__main__":
    unittest.main()
