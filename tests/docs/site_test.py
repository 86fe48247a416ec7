# SPDX-License-Identifier: Apache-2.0
"""The site that tools/docs makes: whole, without the network, and refused where something public is not documented."""
import html.parser
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest
import urllib.parse

from pages import ROOT

LOADED = {"script": "src", "link": "href", "img": "src", "iframe": "src", "object": "data"}


class Links(html.parser.HTMLParser):
    """What a page loads, what it links, and the anchors that it has."""

    def __init__(self):
        super().__init__()
        self.loaded, self.linked, self.names = [], [], set()

    def handle_starttag(self, tag, attrs):
        attributes = dict(attrs)
        self.names |= {attributes[key] for key in ("id", "name") if attributes.get(key)}
        if tag in LOADED and attributes.get(LOADED[tag]):
            self.loaded.append(attributes[LOADED[tag]])
        if tag == "a" and attributes.get("href"):
            self.linked.append(attributes["href"])


def made(root, output):
    return subprocess.run((root / "tools" / "docs", "--output", output), capture_output=True, text=True, check=False, timeout=200)


@unittest.skipIf(shutil.which("doxygen") is None, "doxygen is missing; tools/docs installs it (group docs of tools/packages)")
class Site(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def parsed(self, site):
        pages = {}
        for path in site.glob("*.html"):
            pages[path.name] = Links()
            pages[path.name].feed(path.read_text())
        return pages

    def test_it_is_whole_and_needs_no_network(self):
        site = self.folder / "site"
        done = made(ROOT, site)
        self.assertEqual(0, done.returncode, done.stdout + done.stderr)
        pages, links = self.parsed(site), 0
        for name, page in pages.items():
            for target in page.loaded:
                if target.startswith("javascript:"):
                    continue
                self.assertNotRegex(target, r"^(https?:)?//", name)
                self.assertTrue((site / urllib.parse.unquote(target)).exists(), f"{name} loads {target}")
            for target in page.linked:
                path, _, anchor = urllib.parse.unquote(target).partition("#")
                if re.match(r"(https?|javascript|mailto):", target):
                    continue
                links += 1
                self.assertTrue((site / (path or name)).exists(), f"{name} links {target}")
                if anchor and (path or name) in pages:
                    self.assertIn(anchor, pages[path or name].names, f"{name} links {target}")
        self.assertGreater(links, 1000)
        main = (site / "index.html").read_text()
        self.assertIn("Two commands", main)
        for function in ("fdcg_step", "fdcg_scene_step_pile", "fdcg_host_arm"):
            self.assertTrue(any(function in path.read_text() for path in site.glob("*_8h.html")), function)

    def test_what_is_not_documented_is_an_error(self):
        tree = self.folder / "tree"
        shutil.copytree(ROOT, tree, ignore=shutil.ignore_patterns("build", ".git", "fuzz", "__pycache__"))
        header = tree / "runtime" / "include" / "fdcg" / "body.h"
        header.write_text(header.read_text().replace("#ifdef __cplusplus\n}\n", "int fdcg_unknown(int x);\n#ifdef __cplusplus\n}\n"))
        done = made(tree, self.folder / "site")
        self.assertNotEqual(0, done.returncode)
        self.assertIn("fdcg_unknown", done.stdout + done.stderr)


if __name__ == "__main__":
    unittest.main()
