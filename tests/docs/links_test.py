# SPDX-License-Identifier: Apache-2.0
"""No link of the documents is dead, no path that they name is missing, every page is reachable, README is short."""
import re
import shutil
import subprocess
import unittest

from pages import ROOT, anchors, linked_pages, prose, tested_pages

LINK = re.compile(r"\[[^]]*\]\(([^()\s]+)\)|<(?:a|img)\s[^>]*(?:href|src)=\"([^\"]+)\"")
NAMED_PATH = re.compile(r"^(?:cmake|docs|lib|runtime|schemas|testdata|tests|tools)/[\w./-]+$")
README_WORDS = 900


def links(page):
    """(line, target) of each; what stands in code is not one."""
    for number, line in prose(page):
        for found in LINK.finditer(re.sub(r"`[^`]*`", "", line)):
            yield number, found[1] or found[2]


def is_kept(path):
    """In the repository, or would be: what a build makes is not."""
    if not (ROOT / ".git").exists() or shutil.which("git") is None:
        return True
    return subprocess.run(("git", "-C", ROOT, "check-ignore", "-q", path), check=False).returncode == 1


class Links(unittest.TestCase):
    def test_every_link_and_anchor_resolves(self):
        checked = 0
        for page in linked_pages():
            for line, target in links(page):
                if re.match(r"[a-z]+:", target):
                    continue
                checked += 1
                name, _, anchor = target.partition("#")
                path = (page.parent / name).resolve() if name else page
                with self.subTest(page=str(page.relative_to(ROOT)), line=line, target=target):
                    self.assertTrue(path.is_relative_to(ROOT.resolve()), "leads out of the repository")
                    self.assertTrue(path.exists(), "there is no such file")
                    self.assertTrue(is_kept(path), "is made by a build")
                    if anchor:
                        self.assertEqual(".md", path.suffix)
                        self.assertIn(anchor, anchors(path))
        self.assertGreater(checked, 100)

    def test_every_path_that_a_page_names_exists(self):
        checked = 0
        for page in tested_pages():
            for line, text in prose(page):
                for span in re.findall(r"`([^`]+)`", text):
                    if NAMED_PATH.match(span):
                        checked += 1
                        with self.subTest(page=str(page.relative_to(ROOT)), line=line):
                            self.assertTrue((ROOT / span).exists(), span)
        self.assertGreater(checked, 20)

    def test_every_page_is_reachable_from_the_readme(self):
        reached, waiting = set(), [ROOT / "README.md"]
        while waiting:
            page = waiting.pop()
            if page in reached:
                continue
            reached.add(page)
            for _, target in links(page):
                path = (page.parent / target.partition("#")[0]).resolve()
                if path.suffix == ".md" and path.exists():
                    waiting.append(path)
        self.assertEqual(set(), {str(page.relative_to(ROOT)) for page in linked_pages() if page.resolve() not in reached})


class Readme(unittest.TestCase):
    def test_it_is_short(self):
        self.assertLess(len((ROOT / "README.md").read_text().split()), README_WORDS)


if __name__ == "__main__":
    unittest.main()
