# SPDX-License-Identifier: Apache-2.0
"""Pages by other ways than a mouse: keys alone, a finger, a pen, with reduced motion; every layer of findings; hostile names."""
import math
import time
import unittest

from browser import BrowserCase
from pages import NON_MANIFOLD, ROOT, sphere

try:
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
    from selenium.webdriver.support.ui import Select
except ImportError:
    pass

# Of what can be used now the places in the document; of radio buttons the one that Tab comes to.
USABLE = """return [...document.querySelectorAll('button, input, select, summary, canvas, [tabindex]')].map((e, i) => [e, i])
  .filter(([e]) => e.checkVisibility() && !e.disabled && e.tabIndex >= 0 && !(e.type === 'radio' && !e.checked)).map(([, i]) => i)"""
FOCUSED = """return [...document.querySelectorAll('button, input, select, summary, canvas, [tabindex]')].indexOf(document.activeElement)"""
# Whether the camera still flies two frames after the next finding was asked for.
FLIES = """const done = arguments[0];
document.body.dispatchEvent(new KeyboardEvent('keydown', {key: 'n', bubbles: true}));
requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(() => done(fdcgView.state().flying))));"""


class Keyboard(BrowserCase):
    def assert_all_in_reach(self):
        usable, reached = set(self.browser.execute_script(USABLE)), set()
        self.assertGreater(len(usable), 5)
        for _ in range(2 * len(usable) + 4):
            self.browser.switch_to.active_element.send_keys(Keys.TAB)
            reached.add(self.browser.execute_script(FOCUSED))
            if usable <= reached:
                return
        missing = [self.browser.execute_script("return document.querySelectorAll('button, input, select, summary, canvas, [tabindex]')[arguments[0]].outerHTML", i)
                   for i in usable - reached]
        self.fail(f"Tab does not come to {missing}")

    def test_tab_comes_to_everything_of_every_view(self):
        self.open(self.view(self.write("ball.off", sphere(6))))
        for tab in self.state()["tabs"]:
            self.press(str(self.state()["tabs"].index(tab) + 1))
            self.assertEqual(tab, self.state()["tab"])
            self.assert_all_in_reach()

    def test_a_finding_is_chosen_and_left_by_keys(self):
        self.open(self.view(self.write("bad.off", NON_MANIFOLD)))
        self.browser.execute_script("document.querySelector('.finding').focus()")
        self.browser.switch_to.active_element.send_keys(Keys.ENTER)
        self.wait_for(lambda s: s["rule"] == "non-manifold-edge")
        self.press("/")
        self.assertEqual("filter", self.browser.switch_to.active_element.get_attribute("id"))

    def test_with_reduced_motion_the_camera_is_there_at_once(self):
        page = self.view(self.write("bad.off", NON_MANIFOLD))
        self.open(page)
        self.assertTrue(self.browser.execute_async_script(FLIES))
        self.browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [{"name": "prefers-reduced-motion", "value": "reduce"}]})
        self.open(page)
        before = self.state()["camera"]
        self.assertFalse(self.browser.execute_async_script(FLIES))
        self.assertNotEqual(before, self.state()["camera"])


class Pointers(BrowserCase):
    def setUp(self):
        super().setUp()
        self.open(self.view(self.write("ball.off", sphere(12)), "--units", "cm"))
        self.find("tab-touch").click()
        self.wait_for(lambda s: s["ready"])
        box = self.canvas().rect
        self.middle = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2

    def finger(self, kind, *places):
        self.browser.execute_cdp_cmd("Input.dispatchTouchEvent", {"type": kind, "touchPoints": [{"x": x, "y": y} for x, y in places]})

    def pen(self, kind, force):
        self.browser.execute_cdp_cmd("Input.dispatchMouseEvent", {
            "type": kind, "x": self.middle[0], "y": self.middle[1], "button": "left", "buttons": 1, "clickCount": 1, "pointerType": "pen", "force": force})

    def test_a_finger_presses_strokes_and_lifts(self):
        x, y = self.middle
        self.finger("touchStart", (x, y))
        before = self.wait_for(lambda s: s["contact"] == "face" and s["force"] > 0)
        for k in range(1, 9):
            self.finger("touchMove", (x + 6 * k, y))
        state = self.wait_for(lambda s: math.dist(s["hip"], before["hip"]) > 1e-4)
        self.assertTrue(state["pressed"])
        self.assertEqual(before["camera"], state["camera"])  # the surface is stroked, the view is not turned
        self.finger("touchEnd")
        self.wait_for(lambda s: not s["pressed"] and s["contact"] == "free")
        self.assert_quiet()

    def test_a_pen_presses_by_its_pressure(self):
        self.pen("mousePressed", 0.25)
        self.wait_for(lambda s: s["contact"] == "face" and s["force"] > 0)
        time.sleep(0.4)
        light = self.state()["force"]
        self.pen("mouseMoved", 0.75)
        self.wait_for(lambda s: abs(s["force"] / light - 3) < 0.5)


class Layers(BrowserCase):
    def test_each_layer_of_findings_shows_on_the_model(self):
        rules = ("boundary-edge", "non-manifold-edge", "non-manifold-vertex", "self-intersection", "winding-inconsistent", "duplicate-face")
        bad = ROOT / "testdata" / "meshes" / "bad"
        self.open(self.view(*(str(bad / f"{rule}.off") for rule in rules), "--no-touch"))
        for index, rule in enumerate(rules):
            with self.subTest(rule):
                Select(self.find("item")).select_by_index(index)
                self.wait_for(lambda s, rule=rule: s["item"].endswith(f"{rule}.off") and s.get("tab") and not s["flying"] and
                              self.browser.find_elements(By.CSS_SELECTOR, f".rule[data-rule={rule}]"))
                group = self.browser.find_element(By.CSS_SELECTOR, f".rule[data-rule={rule}]")
                if group.get_attribute("open") is None:
                    group.find_element(By.TAG_NAME, "summary").click()
                box = self.find(f"layer-{rule}")
                pictures = {}
                for _ in range(2):
                    self.wait_for(lambda s: s["pixelRatio"] == 1)
                    pictures[box.is_selected()] = self.picture()
                    self.browser.execute_script("arguments[0].click()", box)
                self.assertEqual({True, False}, set(pictures))
                self.assertNotEqual(pictures[True], pictures[False])
        self.assert_quiet()

    def test_files_chosen_faster_than_they_are_read_end_at_the_last(self):
        bad = ROOT / "testdata" / "meshes" / "bad"
        self.open(self.view(*(str(bad / f"{rule}.off") for rule in ("boundary-edge", "non-manifold-edge", "self-intersection")), "--no-touch"))
        choose = "const c = document.getElementById('item'); for (const i of arguments[0]) { c.value = i; c.dispatchEvent(new Event('change')); }"
        self.browser.execute_script(choose, [1, 2, 0, 2, 1])
        self.wait_for(lambda s: self.browser.find_elements(By.CSS_SELECTOR, ".rule[data-rule=non-manifold-edge]"))
        self.assertTrue(self.state()["item"].endswith("non-manifold-edge.off"))
        self.assertEqual(["findings"], self.state()["tabs"])  # not one for each that was asked for
        self.assert_quiet()

    def test_fans_at_a_vertex_have_a_colour_each(self):
        self.open(self.view(str(ROOT / "testdata" / "meshes" / "bad" / "non-manifold-vertex.off")))
        self.press("n")
        self.wait_for(lambda s: s["rule"] == "non-manifold-vertex" and not s["flying"])
        self.assertIn("2 fans of faces", self.browser.find_element(By.CSS_SELECTOR, ".hint").text)
        for color in ((200, 170, 175), (160, 176, 208)):  # the first two colours of numbers, over the surface's grey
            self.assertGreater(self.share_of(color, 14), 0.05)

    def test_a_line_of_the_file_finds_its_element(self):
        self.open(self.view(self.write("bad.off", NON_MANIFOLD)))
        self.press("n")
        line = self.wait_for(lambda s: s["rule"])["element"]["line"]
        box = self.find("filter")
        box.send_keys(f"line {line}")
        self.wait_for(lambda s: s["entries"] == 1)
        box.send_keys("0000")
        self.wait_for(lambda s: s["entries"] == 0)

    def test_busy_fans_of_a_graph(self):
        self.fdcg("compile", self.write("ball.off", sphere(24)), "--triangles", "-o", self.path("ball.fdcg"), "-q")
        self.open(self.view(self.path("ball.fdcg")))
        self.assertEqual(2, self.state()["busy"])  # the poles: 48 edges each
        before = self.picture()
        self.find("show-busy").click()
        self.wait_for(lambda _: self.picture() != before)


class Names(BrowserCase):
    def test_of_files_parts_and_materials_stay_text(self):
        evil = "<img src=x onerror=window.gone=1>"
        text = f"o {evil}\nusemtl {evil}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nusemtl </script><script>window.gone=1\nf 1 2 4\n"
        self.open(self.view(self.write(f"{evil}.obj", text), "--repair"))
        for key in ("n", "c", "n"):
            self.press(key)
        self.canvas().click()
        for choice in self.browser.find_elements(By.CSS_SELECTOR, "input[name=version]"):
            choice.click()
        self.assertEqual([], self.browser.find_elements(By.CSS_SELECTOR, "img"))
        self.assertIn(evil, self.browser.find_element(By.TAG_NAME, "h1").text)
        self.assertIsNone(self.browser.execute_script("return window.gone"))
        self.assert_quiet()


if __name__ == "__main__":
    unittest.main()
