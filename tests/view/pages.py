# SPDX-License-Identifier: Apache-2.0
"""Reads a page of fdcg view without a browser: the arrays and items in it, unpacked by code of its own."""
import base64
import csv
import json
import math
import os
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import zlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "contract"))
from support import CUBE, FDCG, ROOT, SERVO, TETRAHEDRON, Case  # noqa: E402,F401

# two tetrahedra that share an edge
NON_MANIFOLD = """OFF
6 8 0
0 0 0
1 0 0
0 1 0
0 0 1
0 -1 0
0 0 -1
3 0 2 1
3 0 1 3
3 1 2 3
3 0 3 2
3 0 4 1
3 0 1 5
3 1 4 5
3 0 5 4
"""


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


def inflated(text):
    return zlib.decompress(base64.b64decode(text))


def unfiltered(data, runs):
    out, at = bytearray(), 0
    for length, stride in runs:
        records = length // stride if stride else 0
        block = bytearray(length)
        for word in range(stride // 4 if records else 0):
            before = 0
            for record in range(records):
                z = sum(data[at + (4 * word + k) * records + record] << 8 * k for k in range(4))
                before = (before + ((z >> 1) ^ -(z & 1))) & 0xFFFFFFFF
                struct.pack_into("<I", block, record * stride + 4 * word, before)
        block[records * stride:] = data[at + records * stride:at + length]
        out += block
        at += length
    return bytes(out) + data[at:]


class Page:
    def __init__(self, path):
        self.text = pathlib.Path(path).read_text()
        scripts = re.findall(r'<script type="text/plain" (id|class)="([\w-]+)">([^<]*)</script>', self.text)
        self.blobs = {name: body for kind, name, body in scripts if kind == "id"}
        self.about = json.loads(inflated(self.blobs["page"]))
        self.items = [json.loads(inflated(body)) for kind, name, body in scripts if (kind, name) == ("class", "item")]

    def array(self, ref):
        data = unfiltered(inflated(self.blobs[f"blob-{ref['blob']}"]), ref["runs"])
        assert len(data) == ref["bytes"], ref
        return data

    def words(self, ref):
        data = self.array(ref)
        return list(struct.unpack(f"<{len(data) // 4}I", data))


class PageCase(Case):
    def setUp(self):
        super().setUp()
        probe = subprocess.run((FDCG, "view", self.path("absent.off")), capture_output=True, cwd=self.folder, check=False)
        if b"has no viewer" in probe.stderr:
            self.skipTest("this fdcg has no viewer; tools/check installs what it needs (group viewer of tools/packages)")

    def view(self, *arguments, name="page.html", code=0):
        path = self.path(name)
        self.fdcg("view", *arguments, "-o", path, code=code)
        return path

    def page(self, *arguments, **options):
        return Page(self.view(*arguments, **options))


class SessionCase(PageCase):
    """Scenes of testdata/scenes, run without waiting."""

    def session(self, scene, seconds, log=None):
        for path in (ROOT / "testdata" / "scenes").iterdir():
            if path.suffix in (".json", ".fdcg") and not (self.folder / path.name).exists():
                shutil.copy(path, self.folder)
        if scene == "press_sheet":
            self.fdcg("compile", str(ROOT / "testdata/scenes/sheet.off"), "--triangles", "-o", self.path("sheet.fdcg"), "-q")
        log = self.path(log or f"{scene}.fdcglog")
        self.servo("run", self.path(f"{scene}.json"), "--arm", "--for", str(seconds), "--fast", "-q", "--log", log)
        return log

    def replayed(self, log):
        """The rows of the replay, and those of its touches."""
        csv_path, touches = self.path("session.csv"), self.path("touches.csv")
        self.servo("replay", log, "-o", csv_path, "--touches", touches, "-q")
        return [list(csv.DictReader(pathlib.Path(path).read_text().splitlines())) for path in (csv_path, touches)]


def real_mesh(*path):
    """A mesh beside the project, where there is one."""
    found = pathlib.Path(os.path.join(ROOT, "..", "shared", "meshes", *path))
    return str(found) if found.is_file() else None
