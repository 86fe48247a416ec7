#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Formats that hold scenes, as other programs wrote them: points, faces and units as an independent reader has them."""
import os
import pathlib
import subprocess
import unittest

import numpy
import scene_reference
from real_files import ASSIMP_MODELS
from support import FDCG, ROOT, Case

# what fdcg refuses, and the word that says why
REFUSED = {"malformed_property_index_oob.3mf": "1000000", "cameras.dae": "no face", "lights.dae": "no face"}


def scene_files():
    named = os.environ.get("FDCG_REAL_MESHES")
    roots = [pathlib.Path(named) if named else ROOT / ".." / "shared" / "meshes", ASSIMP_MODELS]
    return sorted(path for root in roots if root.is_dir() for path in root.rglob("*") if path.suffix.lower() in (".dae", ".3mf"))


def read_off(path):
    words = iter(path.read_text().split())
    next(words)
    points, faces, _ = int(next(words)), int(next(words)), next(words)
    xyz = [tuple(float(next(words)) for _ in range(3)) for _ in range(points)]
    return xyz, [[int(next(words)) for _ in range(int(next(words)))] for _ in range(faces)]


def exported(case, path):
    """All points and faces as they were read; the mesh may have errors."""
    off = case.folder / "mesh.off"
    subprocess.run((FDCG, "repair", path, "--weld", "none", "-o", off, "-q"), stdin=subprocess.DEVNULL, capture_output=True, timeout=120, check=False)
    return off


class RealFiles(Case):
    def test_as_an_independent_reader_has_them(self):
        files = scene_files()
        if not files:
            self.skipTest("no COLLADA or 3MF files at hand")
        compared = 0
        for path in files:
            with self.subTest(path=str(path)):
                if path.name in REFUSED:
                    done = self.fdcg("validate", path, code=3)
                    self.assertIn(REFUSED[path.name], done.stderr.decode())
                    continue
                self.compare(path)
                compared += 1
        self.assertGreater(compared, 0)

    def compare(self, path):
        want = scene_reference.read(path)
        points, faces = read_off(exported(self, path))
        self.assertEqual(faces, want.faces)
        self.assertEqual(len(points), len(want.points))
        ours, theirs = numpy.array(points), numpy.array(want.points)
        if not want.is_moved:
            self.assertTrue((ours == theirs).all(), "a point differs, and none was moved")
        off_by = numpy.abs(ours - theirs).max()
        self.assertLessEqual(off_by, 8 * numpy.spacing(numpy.abs(theirs).max()))


if __name__ == "__main__":
    unittest.main()
