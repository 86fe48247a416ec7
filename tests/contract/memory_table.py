# SPDX-License-Identifier: Apache-2.0
"""The memory table of schemas/fdcg-v1.md: bytes a triangle of a closed mesh, by section, from the section tables of files that
the compiler writes. Run with --write to renew it there."""
import itertools
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

from support import FDCG, ROOT

DOCUMENT = ROOT / "schemas" / "fdcg-v1.md"
BLOCK = re.compile(r"(<!-- memory -->\n)(.*?)(<!-- end of memory -->)", re.S)
MODES = (("f64", "stored"), ("f64", "derived"), ("f32", "stored"), ("f32", "derived"))
LIMITS = {("f64", "stored"): 300, ("f32", "stored"): 190, ("f32", "derived"): 90}  # bytes a triangle
CUTS = 100


def octasphere(cuts):
    """An octahedron's faces cut into cuts^2 triangles each, as OFF text, and their number."""
    index, points, faces = {}, [], []

    def vertex(p):
        if p not in index:
            index[p] = len(points)
            size = sum(c * c for c in p) ** 0.5
            points.append(" ".join(repr(c / size) for c in p))
        return index[p]

    for sx, sy, sz in itertools.product((1, -1), repeat=3):
        def at(i, j):
            return vertex((sx * i, sy * j, sz * (cuts - i - j)))
        for i in range(cuts):
            for j in range(cuts - i):
                corners = [(at(i, j), at(i + 1, j), at(i, j + 1))]
                if i + j + 2 <= cuts:
                    corners.append((at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)))
                faces += [c if sx * sy * sz > 0 else c[::-1] for c in corners]
    text = f"OFF\n{len(points)} {len(faces)} 0\n" + "\n".join(points) + "\n" + "\n".join("3 %d %d %d" % f for f in faces) + "\n"
    return text, len(faces)


def measured():
    """For each mode the bytes a triangle of every section."""
    text, faces = octasphere(CUTS)
    with tempfile.TemporaryDirectory() as folder:
        mesh, out = pathlib.Path(folder) / "sphere.off", str(pathlib.Path(folder) / "sphere.fdcg")
        mesh.write_text(text)
        columns = {}
        for precision, planes in MODES:
            subprocess.run([FDCG, "compile", str(mesh), "-o", out, "-q", "--precision", precision, "--planes", planes], check=True)
            about = json.loads(subprocess.run([FDCG, "inspect", "--json", out], capture_output=True, check=True).stdout)
            assert about["nodes"] == faces, "nothing of a sphere is merged"
            columns[precision, planes] = {s["name"]: s["bytes"] / faces for s in about["sections"] if s["name"] not in ("info", "mass")}
    return columns


def table(columns):
    names = list(columns["f64", "stored"])
    lines = ["| section | f64, planes stored | f64, derived | f32, planes stored | f32, derived |", "| --- | --- | --- | --- | --- |"]
    for name in names:
        lines.append(f"| `{name.upper().replace('-', '_')}` | " + " | ".join(f"{columns[m].get(name, 0):.1f}" for m in MODES) + " |")
    lines.append("| all | " + " | ".join(f"**{sum(columns[m].values()):.1f}**" for m in MODES) + " |")
    lines.append("| all but `SOURCE_MAP` | " + " | ".join(f"{sum(columns[m].values()) - columns[m]['source-map']:.1f}" for m in MODES) + " |")
    return "\n".join(lines) + "\n"


class MemoryTable(unittest.TestCase):
    maxDiff = None

    def test_the_document_shows_what_the_compiler_writes_and_no_mode_takes_more_than_it_may(self):
        columns = measured()
        for mode, limit in LIMITS.items():
            self.assertLessEqual(sum(columns[mode].values()), limit, mode)
        self.assertEqual(BLOCK.search(DOCUMENT.read_text()).group(2), table(columns))


if __name__ == "__main__":
    if "--write" in sys.argv:
        DOCUMENT.write_text(BLOCK.sub(lambda found: found.group(1) + table(measured()) + found.group(3), DOCUMENT.read_text()))
    else:
        unittest.main()
