# SPDX-License-Identifier: Apache-2.0
"""Pages in Chromium, from a file: every view by clicks and keys, judged by state and by pixels, and no request leaves."""
import math
import pathlib
import time
import unittest

from browser import BrowserCase
from pages import CUBE, NON_MANIFOLD, SERVO

try:
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
except ImportError:
    pass

GLOW = (217, 130, 0)  # light theme


def sphere(rings=24):
    """A closed mesh of triangles about the origin, radius 1."""
    points, faces = [(0, 0, 1)], []
    for i in range(1, rings):
        for j in range(2 * rings):
            a, b = math.pi * i / rings, math.pi * j / rings
            points.append((math.sin(a) * math.cos(b), math.sin(a) * math.sin(b), math.cos(a)))
    points.append((0, 0, -1))
    at = lambda i, j: 1 + (i - 1) * 2 * rings + j % (2 * rings)  # noqa: E731
    for j in range(2 * rings):
        faces.append((0, at(1, j), at(1, j + 1)))
        faces.append((len(points) - 1, at(rings - 1, j + 1), at(rings - 1, j)))
        for i in range(1, rings - 1):
            faces += [(at(i, j), at(i + 1, j), at(i + 1, j + 1)), (at(i, j), at(i + 1, j + 1), at(i, j + 1))]
    lines = [f"OFF\n{len(points)} {len(faces)} 0"] + ["%.9f %.9f %.9f" % p for p in points] + ["3 %d %d %d" % f for f in faces]
    return "\n".join(lines) + "\n"


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

    def test_a_click_picks_and_layers_go_on_and_off(self):
        self.canvas().click()
        self.assertEqual("node", self.wait_for(lambda s: s["picked"])["picked"]["kind"])
        self.find("edges-convex").click()
        self.assertEqual(False, self.state()["edges"][0])
        self.find("box-level").send_keys("root")
        self.wait_for(lambda s: s["boxes"] == 1)
        self.press(Keys.ESCAPE)
        self.assertIsNone(self.state()["picked"])


class Touch(BrowserCase):
    seconds = 20

    def test_what_is_felt_in_the_page_replays_natively_to_the_same_bytes(self):
        self.open(self.view(self.write("ball.off", sphere()), "--units", "cm"))
        self.find("tab-touch").click()
        self.wait_for(lambda s: s["ready"])
        self.find("record").click()
        hand = ActionChains(self.browser, duration=30)
        hand.move_to_element_with_offset(self.canvas(), 20, 20).perform()
        self.wait_for(lambda s: s["recording"] == "on")
        end = time.monotonic() + self.seconds
        hand.move_to_element_with_offset(self.canvas(), -60, 0).click_and_hold().perform()
        states, slipped, turn = set(), False, 0.0
        while time.monotonic() < end:
            turn += 0.35
            hand.move_to_element_with_offset(self.canvas(), int(90 * math.cos(turn)), int(70 * math.sin(turn))).perform()
            state = self.state()
            states.add(state["contact"])
            slipped = slipped or state["slips"]
        hand.release().perform()
        self.find("record").click()
        state = self.wait_for(lambda s: s["recorded"] > 0)
        self.assertGreater(state["recorded"], 0.8 * 1000 * self.seconds)
        self.assertTrue(slipped and "face" in states, (slipped, states))
        for button in ("save-path", "save-log", "save-graph"):
            self.find(button).click()
        for name in ("hip.csv", "page-log.csv", "ball.fdcg"):
            self.saved(name)
        command = self.find("replay-command").text.split()
        self.assertEqual("fdcg-servo", command[0])
        self.run_program(SERVO, *command[1:], cwd=self.path("saved"))
        native, page = (pathlib.Path(self.saved(name)).read_text() for name in ("log.csv", "page-log.csv"))
        self.assertTrue(native == page, first_difference(native, page))
        self.assert_quiet()
        print(f"step {state['recordedStepNs']:.0f} ns, p99 of the period {state['timing']['periodP99Ms']:.2f} ms, {state['recorded']} ticks")

    def test_keys_press_and_move_and_sliders_change_what_is_felt(self):
        self.open(self.view(self.write("ball.off", sphere(12))))
        self.find("tab-touch").click()
        self.wait_for(lambda s: s["ready"])
        self.press(" ")
        soft = self.wait_for(lambda s: s["contact"] == "face" and s["force"] > 1)
        for _ in range(8):
            self.press(Keys.ARROW_RIGHT)
        self.wait_for(lambda s: s["ticks"] > soft["ticks"] + 100)
        self.find("stiffness").send_keys(Keys.END)
        self.wait_for(lambda s: s["force"] > 3 * soft["force"])
        self.find("mu-s").send_keys(Keys.HOME)
        state = self.wait_for(lambda s: s["params"]["muStatic"] == 0)
        self.assertEqual(0, state["params"]["muDynamic"])
        self.press(Keys.ESCAPE)
        self.wait_for(lambda s: s["contact"] == "free")
        self.assert_quiet()


def first_difference(a, b):
    pairs = enumerate(zip(a.splitlines(), b.splitlines()))
    return next((f"row {i}\n{x}\n{y}" for i, (x, y) in pairs if x != y), f"{len(a)} and {len(b)} bytes")


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
