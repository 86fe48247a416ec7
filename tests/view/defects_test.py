# SPDX-License-Identifier: Apache-2.0
"""Somebody who does not know the viewer opens the page of a broken mesh: its defect is named, explained and shown within a minute,
by what the page itself says."""
import pathlib
import time
import unittest

from browser import BrowserCase
from pages import ROOT

try:
    from selenium.webdriver.common.by import By
except ImportError:
    pass

GLOW = (217, 130, 0)  # light theme
MEANT_S = 60
# meshes of testdata/meshes/bad whose defect is all that is wrong with them, or the worst of it
MESHES = ("boundary-edge.off", "degenerate-face-on-a-line.off", "duplicate-face.off", "folded-edge.off", "inside-out.off", "non-finite-coordinate.obj",
          "non-manifold-edge.off", "non-manifold-vertex.off", "non-planar-face.off", "not-orientable.off", "self-crossing-face-bow-tie.off",
          "self-intersection.off", "sliver-face.off", "t-junction.off", "winding-inconsistent.off")


def rule_of(name, rules):
    return next(rule for rule in rules if name.startswith(rule))


class Defects(BrowserCase):
    def find_by_eye(self, page, rule):
        """What a new user does: reads the list, and clicks on the first finding of a rule. Seconds until the defect is in view."""
        before = time.monotonic()
        self.open(page)
        groups = {group.get_attribute("data-rule"): group for group in self.browser.find_elements(By.CSS_SELECTOR, ".rule")}
        self.assertIn(rule, groups)
        summary = groups[rule].find_element(By.TAG_NAME, "summary")
        if groups[rule].get_attribute("open") is None:
            summary.click()
        text = groups[rule].text
        self.assertGreater(len(groups[rule].find_element(By.CSS_SELECTOR, ".message").text), 20, text)
        self.assertGreater(len(groups[rule].find_element(By.CSS_SELECTOR, ".why").text), 20, text)
        first = groups[rule].find_element(By.CSS_SELECTOR, ".finding")
        self.browser.execute_script("arguments[0].scrollIntoView({block: 'center'})", first)
        first.click()
        state = self.wait_for(lambda s: s["rule"] and not s["flying"])
        self.assertEqual(rule, state["rule"])
        hint = self.browser.find_element(By.CSS_SELECTOR, ".hint").text
        self.assertTrue(hint.startswith(f"{rule}: "), hint)
        self.assertRegex(hint, r"\d")  # an element by its number
        return time.monotonic() - before

    def test_each_rule_of_the_projects_own_meshes(self):
        bad = ROOT / "testdata" / "meshes" / "bad"
        rules = [line.split("`")[1] for line in (ROOT / "schemas" / "rules.md").read_text().splitlines() if line.startswith("| `")]
        for name in MESHES:
            with self.subTest(name):
                rule = rule_of(name, sorted(rules, key=len, reverse=True))
                spent = self.find_by_eye(self.view(str(bad / name), name=f"{name}.html"), rule)
                self.assertLess(spent, MEANT_S)
                # a vertex that is nowhere shows by dots on its neighbours
                self.assertGreater(self.share_of(GLOW), 0.00015 if "finite" in name else 0.0003, "nothing glows")

    def test_a_file_that_cannot_be_read_says_why(self):
        page = self.view(str(ROOT / "testdata/meshes/bad/index-out-of-range.off"), str(pathlib.Path(self.write("empty.off", ""))), code=3)
        self.open(page)
        self.find("item").send_keys("empty")
        self.wait_for(lambda s: s["item"].endswith("empty.off"))
        self.assertIn("empty.off", self.browser.find_element(By.CSS_SELECTOR, ".panel").text)


if __name__ == "__main__":
    unittest.main()
