# SPDX-License-Identifier: Apache-2.0
"""The viewer's bundle: the same sources give the same bytes; no address of a registry, and every version exact."""
import json
import pathlib
import re
import shutil
import subprocess
import os
import unittest

from pages import ROOT, PageCase

SOURCE = ROOT / "tools" / "view"
BUILT = pathlib.Path(os.environ["FDCG_BUILD"]) / "tools" / "view"


class Bundle(PageCase):
    def test_a_second_bundle_has_the_same_bytes(self):
        folder = self.folder / "again"
        shutil.copytree(SOURCE, folder)
        (folder / "node_modules").symlink_to(BUILT / "bundle" / "node_modules")
        subprocess.run(("node", "bundle.mjs", BUILT / "wasm" / "fdcg.wasm", self.path("again.html")), cwd=folder, check=True, timeout=120)
        self.assertEqual((BUILT / "viewer.html").read_bytes(), pathlib.Path(self.path("again.html")).read_bytes())

    def test_versions_are_exact_and_no_address_stands_in_the_lock(self):
        package = json.loads((SOURCE / "package.json").read_text())
        for name, version in package["devDependencies"].items():
            self.assertRegex(version, r"^\d+\.\d+\.\d+$", name)
        lock = (SOURCE / "package-lock.json").read_text()
        self.assertNotIn("resolved", lock)
        self.assertEqual([], re.findall(r"https?://(?!opencollective\.com|github\.com)[^\"]+", lock))


if __name__ == "__main__":
    unittest.main()
