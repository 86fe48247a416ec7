# SPDX-License-Identifier: Apache-2.0
"""tools/demo, README's first command, with the programs of this build: a real mesh, a path, a picture."""
import os
import pathlib
import shutil
import struct
import subprocess
import tempfile
import unittest

from pages import ROOT

PROGRAMS = pathlib.Path(os.environ["FDCG"]).parent
ARCHIVE = pathlib.Path("/usr/share/doc/libcgal-dev/data.tar.gz")


class Demo(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def demo(self, *arguments):
        return subprocess.run((ROOT / "tools" / "demo", *arguments), capture_output=True, text=True, check=False, timeout=280)

    @unittest.skipUnless(ARCHIVE.exists() and shutil.which("gnuplot"), "the group demo of tools/packages is not installed")
    def test_it_slides_over_a_real_mesh_and_draws(self):
        done = self.demo("--programs", PROGRAMS, "--output", self.folder / "out")
        self.assertEqual(0, done.returncode, done.stdout + done.stderr)
        picture = (self.folder / "out" / "picture.png").read_bytes()
        self.assertEqual(b"\x89PNG\r\n\x1a\n", picture[:8])
        width, height = struct.unpack(">II", picture[16:24])
        self.assertGreater(min(width, height), 400)
        log = (self.folder / "out" / "log.csv").read_text().splitlines()
        states = {line.split(",")[10] for line in log[1:]}
        self.assertLessEqual({"free", "face"}, states)
        for text in ("75408 faces", "step time", "picture.png"):
            self.assertIn(text, done.stdout.replace(",", ""))

    @unittest.skipUnless(shutil.which("gnuplot"), "the group demo of tools/packages is not installed")
    def test_ones_own_mesh_at_a_size_of_ones_own(self):
        done = self.demo(ROOT / "runtime" / "examples" / "cube.obj", "--size", "0.04", "--programs", PROGRAMS, "--output", self.folder / "out")
        self.assertEqual(0, done.returncode, done.stdout + done.stderr)
        self.assertIn("measures 0.04 x 0.04 x 0.04 m", done.stdout)
        self.assertTrue((self.folder / "out" / "picture.png").is_file())
        if "no page" not in done.stdout:
            self.assertTrue((self.folder / "out" / "page.html").is_file())

    def test_a_mesh_with_errors_is_not_slid_over(self):
        mesh = ROOT / "testdata" / "meshes" / "bad" / "winding-inconsistent.off"
        done = self.demo(mesh, "--programs", PROGRAMS, "--output", self.folder / "out")
        self.assertEqual(1, done.returncode, done.stdout + done.stderr)
        self.assertIn("has errors", done.stderr)

    def test_unknown_options_are_refused(self):
        done = self.demo("--nonsense")
        self.assertEqual(2, done.returncode)
        self.assertIn("--nonsense", done.stderr)


if __name__ == "__main__":
    unittest.main()
