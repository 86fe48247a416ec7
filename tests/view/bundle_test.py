# SPDX-License-Identifier: Apache-2.0
"""The viewer's bundle: the same sources give the same bytes; no address of a registry, and every version exact."""
import json
import os
import pathlib
import random as randoms
import re
import shutil
import struct
import subprocess
import time
import unittest

from pages import ROOT, PageCase

SOURCE = ROOT / "tools" / "view"
BUILT = pathlib.Path(os.environ["FDCG_BUILD"]) / "tools" / "view"


# run where node_modules is: prints each number of standard input (its bits, in hex) as the page does
PRINT = """
import { transformSync } from 'esbuild';
import { readFileSync } from 'node:fs';
const code = transformSync(readFileSync('src/numbers.ts', 'utf8'), { loader: 'ts', format: 'esm' }).code;
const { precise } = await import('data:text/javascript,' + encodeURIComponent(code));
const view = new DataView(new ArrayBuffer(8));
for (const bits of readFileSync(0, 'utf8').trim().split('\\n')) {
  view.setBigUint64(0, BigInt('0x' + bits));
  console.log(precise(view.getFloat64(0)));
}
"""


class Numbers(PageCase):
    def test_17_digits_are_those_of_printf(self):
        random = randoms.Random(7)
        numbers = [0.0, -0.0, 1.0, -2.5e-5, 1e-4, 1e16, 1e17, 123456789012345678.0, 5e-324, 1.7976931348623157e308]
        numbers += [sign * (1 + k * 2.0 ** -17) for k in range(200) for sign in (1, -1)]  # half way between two of 17 digits
        numbers += [struct.unpack("<d", random.randbytes(8))[0] for _ in range(3000)]
        numbers += [random.uniform(-1, 1) for _ in range(3000)]
        numbers = [x for x in numbers if x == x and abs(x) != float("inf")]
        text = "\n".join(struct.pack(">d", x).hex() for x in numbers)
        done = subprocess.run(("node", "--input-type=module", "-e", PRINT), input=text, cwd=BUILT / "bundle", capture_output=True, text=True,
                              check=True, timeout=120)
        self.assertEqual(["%.17g" % x for x in numbers], done.stdout.splitlines())


class Bundle(PageCase):
    def test_a_second_bundle_has_the_same_bytes(self):
        folder = self.folder / "again"
        shutil.copytree(SOURCE, folder)
        (folder / "node_modules").symlink_to(BUILT / "bundle" / "node_modules")
        subprocess.run(("node", "bundle.mjs", BUILT / "wasm" / "fdcg.wasm", self.path("again.html")), cwd=folder, check=True, timeout=120)
        self.assertEqual((BUILT / "viewer.html").read_bytes(), pathlib.Path(self.path("again.html")).read_bytes())

    def test_from_bare_it_takes_under_three_minutes_and_has_the_same_bytes(self):
        """Packages fetched anew into an empty folder, types checked, bundled."""
        before = time.monotonic()
        made = subprocess.run(("cmake", f"-DSOURCE={SOURCE}", f"-DFOLDER={self.path('bare')}", f"-DWASM={BUILT / 'wasm' / 'fdcg.wasm'}",
                               f"-DOUTPUT={self.path('bare.html')}", f"-DNPM={shutil.which('npm')}", f"-DNODE={shutil.which('node')}", "-DREQUIRED=ON",
                               "-P", SOURCE / "make_page.cmake"), capture_output=True, text=True, timeout=500, check=False)
        spent = time.monotonic() - before
        if "npm could not fetch" in made.stderr:
            self.skipTest("npm cannot reach its registry")
        self.assertEqual(0, made.returncode, made.stderr)
        self.assertEqual((BUILT / "viewer.html").read_bytes(), pathlib.Path(self.path("bare.html")).read_bytes())
        print(f"from bare: {spent:.0f} s")
        self.assertLess(spent, 180)

    def test_versions_are_exact_and_no_address_stands_in_the_lock(self):
        package = json.loads((SOURCE / "package.json").read_text())
        for name, version in package["devDependencies"].items():
            self.assertRegex(version, r"^\d+\.\d+\.\d+$", name)
        lock = (SOURCE / "package-lock.json").read_text()
        self.assertNotIn("resolved", lock)
        self.assertEqual([], re.findall(r"https?://(?!opencollective\.com|github\.com)[^\"]+", lock))


if __name__ == "__main__":
    unittest.main()
