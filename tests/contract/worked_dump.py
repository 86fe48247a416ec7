# SPDX-License-Identifier: Apache-2.0
"""The worked dump of schemas/fdcg-v1.md: a tetrahedron's file, byte by byte. Run with --write to renew it there."""
import re
import struct
import subprocess
import sys
import tempfile
import pathlib
import unittest

from support import FDCG, ROOT, TETRAHEDRON, checksum

DOCUMENT = ROOT / "schemas" / "fdcg-v1.md"
BLOCK = re.compile(r"(<!-- dump -->\n```\n)(.*?)(```\n<!-- end of dump -->)", re.S)

HEADER = (("magic", "8s"), ("format_version", "I"), ("header_bytes", "I"), ("file_bytes", "Q"), ("real_bytes", "I"),
          ("section_count", "I"), ("node_count", "I"), ("side_count", "I"), ("connection_count", "I"), ("corner_count", "I"),
          ("fan_count", "I"), ("largest_fan", "I"), ("origin", "3d"), ("metres_per_unit", "d"), ("bounds_min", "3d"),
          ("bounds_max", "3d"), ("extent", "d"), ("max_deviation", "d"), ("quantum", "d"), ("connection_type_count", "4I"),
          ("source_vertex_count", "I"), ("source_face_count", "I"), ("fan_box_count", "I"), ("busy_count", "I"),
          ("node_bytes", "I"), ("flags", "I"), ("reserved", "40s"),
          ("table_checksum", "Q"), ("header_checksum", "Q"))
SECTION = (("id", "I"), ("record_bytes", "I"), ("offset", "Q"), ("record_count", "Q"), ("checksum", "Q"), ("reserved", "Q"))
SIDE = (("link", "I"), ("corner", "I"), ("across", "I"))
PLANE = (("normal", "3d"), ("offset", "d"))


def nested(prefix, layout):
    return tuple((f"{prefix}.{name}", code) for name, code in layout)


RECORDS = {  # the tetrahedron's: every node is a triangle
    1: ("node", nested("plane", PLANE) + (("side_count", "H"), ("flags", "H")) +
        sum((nested(f"sides[{k}]", SIDE) for k in range(3)), ()) + sum((nested(f"voronoi[{k}]", PLANE) for k in range(3)), ())),
    3: ("edge", (("direction", "3d"), ("length", "d"))),
    4: ("connection", (("node", "I"), ("side", "2B"), ("type", "B"), ("flatness", "B"))),
    5: ("corner", (("point", "3d"), ("first", "I"), ("normal", "3h"), ("side", "B"), ("fan", "B"), ("reserved", "I"))),
    7: ("box record", (("origin", "3f"), ("exponent", "3B"), ("reserved", "B"), ("low", "24B"), ("high", "24B"))),
    8: ("source face", (("", "I"),)),
    12: ("mass", (("volume", "d"), ("centroid", "3d"), ("inertia", "6d"), ("density_kg_per_m3", "d"), ("mass_kg", "d"),
                  ("deviation", "d"))),
}
SECTION_NAMES = ("", "NODES", "NODE_OFFSETS", "EDGES", "CONNECTIONS", "CORNERS", "FANS", "HIERARCHY", "SOURCE_MAP", "INFO",
                 "FAN_BOXES", "BUSY_CORNERS", "MASS")


def shown(name, values):
    value = values[0]
    if isinstance(value, bytes):
        return f"{len(value)} zeros" if name == "reserved" and not any(value) else "89 'FDCG' 0d 0a 1a"
    if "checksum" in name:
        return f"{value:#018x}"
    words = [f"{v:.9g}" if isinstance(v, float) else str(v) for v in values]
    return words[0] if len(words) == 1 else "(" + " ".join(words) + ")"


def fields(data, at, layout):
    """offset, name and value of each field."""
    for name, code in layout:
        yield at, name, shown(name, struct.unpack_from("<" + code, data, at))
        at += struct.calcsize("<" + code)


def hexadecimal(data, at, size):
    return " ".join(f"{byte:02x}" for byte in data[at:at + min(size, 8)]) + (" .." if size > 8 else "")


def table(data, at, layout):
    for (offset, name, value), (_, code) in zip(fields(data, at, layout), layout):
        yield f"{offset:5}  {hexadecimal(data, offset, struct.calcsize('<' + code)):27} {name:22} {value}"


def dump(data):
    lines = ["offset bytes                       field                  value", "", "header", *table(data, 0, HEADER)]
    count = struct.unpack_from("<I", data, 28)[0]
    for i in range(count):
        at = 256 + 40 * i
        section_id, size, offset, records = struct.unpack_from("<IIQQ", data, at)
        lines += ["", f"section table, entry {i}: {SECTION_NAMES[section_id]}", *table(data, at, SECTION)]
    for i in range(count):
        section_id, size, offset, records = struct.unpack_from("<IIQQ", data, 256 + 40 * i)
        noun, layout = RECORDS[section_id]
        lines += ["", f"section {SECTION_NAMES[section_id]}: {records} of {size} bytes"]
        if len(layout) > 1:
            lines += table(data, offset, layout)
        for k in range(1 if len(layout) > 1 else 0, records):
            values = "  ".join((f"{name} " if name else "") + value for _, name, value in fields(data, offset + size * k, layout))
            lines.append(f"{offset + size * k:5}  {noun} {k}: {values}")
    return "\n".join(lines) + "\n"


def tetrahedron_file():
    with tempfile.TemporaryDirectory() as folder:
        mesh = pathlib.Path(folder) / "tetrahedron.off"
        mesh.write_text(TETRAHEDRON)
        return subprocess.run([FDCG, "compile", str(mesh), "-o", "-", "-q", "--without", "info"], capture_output=True, check=True).stdout


class WorkedDump(unittest.TestCase):
    maxDiff = None

    def test_the_document_shows_what_the_compiler_writes(self):
        self.assertEqual(BLOCK.search(DOCUMENT.read_text()).group(2), dump(tetrahedron_file()))

    def test_the_checksum_is_the_one_described(self):
        data = tetrahedron_file()
        self.assertEqual(struct.unpack_from("<Q", data, 248)[0], checksum(data[:248]))
        count = struct.unpack_from("<I", data, 28)[0]
        starts = [struct.unpack_from("<Q", data, 256 + 40 * i + 8)[0] for i in range(count)] + [len(data)]
        self.assertEqual(struct.unpack_from("<Q", data, 240)[0], checksum(data[256:starts[0]]))
        for i in range(count):
            self.assertEqual(struct.unpack_from("<Q", data, 256 + 40 * i + 24)[0], checksum(data[starts[i]:starts[i + 1]]))


if __name__ == "__main__":
    if "--write" in sys.argv:
        DOCUMENT.write_text(BLOCK.sub(lambda found: found.group(1) + dump(tetrahedron_file()) + found.group(3), DOCUMENT.read_text()))
    else:
        unittest.main()
