# SPDX-License-Identifier: Apache-2.0
"""What each reader says of truncated, forged and mistaken files: one line that names the file, the place, the value and a remedy."""
import copy
import json
import struct
import unittest

from support import TETRAHEDRON, Case

OBJ = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
PLY_HEAD = ("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
            "element face 1\nproperty list uchar int vertex_indices\nend_header\n")
PLY_BODY = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"
POINTS = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)
BINARY_HEAD = PLY_HEAD.replace("ascii", "binary_little_endian")
BINARY_BODY = POINTS + b"\3" + struct.pack("<3i", 0, 1, 2)
STL_TEXT = ("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
            "endsolid a\n")
STL = b" " * 80 + struct.pack("<I3f", 1, 0, 0, 1) + POINTS + b"\0\0"
BILLIONS = 4_000_000_000
GLTF = {
    "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
    "buffers": [{"byteLength": 42}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 6}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
                  {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"}],
}


def glb(document=None, binary=POINTS + struct.pack("<3H", 0, 1, 2), version=2, length=None):
    text = json.dumps(document or GLTF).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text
    if binary:
        binary += bytes(-len(binary) % 4)
        chunks += struct.pack("<II", len(binary), 0x004E4942) + binary
    return struct.pack("<4sII", b"glTF", version, length or 12 + len(chunks)) + chunks


def changed(*path_and_value):
    """The glTF document with one value replaced."""
    *path, last, value = path_and_value
    document = copy.deepcopy(GLTF)
    place = document
    for key in path:
        place = place[key]
    place[last] = value
    return document


class BadMeshes(Case):
    def refused(self, name, content, *words):
        with self.subTest(name=name, words=words):
            path = self.write(name, content)
            done = self.fdcg("validate", "-q", path, code=3)
            self.assert_one_line(done, name, *words)
            self.assertRegex(done.stderr.decode(), r"[;:] .*\b(export|fetch|correct|convert|put|write|cut|run|use|leave|decompress|"
                             r"unpack|compress|save|is it another format)\b")

    def found(self, name, content, rule, total=1):
        with self.subTest(name=name, rule=rule):
            path = self.write(name, content)
            report = json.loads(self.fdcg("validate", "--format", "json", path, code=1).stdout)
            totals = {issue["rule"]: issue["total"] for issue in report["files"][0]["issues"]}
            self.assertEqual(total, totals.get(rule), totals)

    def test_off(self):
        self.refused("cut.off", TETRAHEDRON[:20], "line", "4 vertices", "ends")
        self.refused("cut.off", TETRAHEDRON[:-9], "line 9", "4 faces", "3")
        self.refused("count.off", TETRAHEDRON.replace("4 4 0", f"4 {BILLIONS} 0"), str(BILLIONS), "faces")
        self.refused("count.off", TETRAHEDRON.replace("4 4 0", f"{BILLIONS} 4 0"), str(BILLIONS), "vertices")
        self.refused("count.off", TETRAHEDRON.replace("4 4 0", "-4 4 0"), "line 2", "-4")
        self.refused("word.off", TETRAHEDRON.replace("1 0 0", "1 zero 0"), "line 4", "vertex 1", "zero")
        self.refused("more.off", TETRAHEDRON + "3 0 1 2\n", "line 11", "4 faces")
        self.refused("gon.off", TETRAHEDRON.replace("3 0 2 1", "70000 0 2 1"), "line 7", "70000", "65536")
        self.refused("magic.off", "P" + TETRAHEDRON, "line 1", "POFF")
        self.refused("binary.off", TETRAHEDRON.replace("OFF", "OFF BINARY"), "line 1", "binary")
        self.found("index.off", TETRAHEDRON.replace("3 0 2 1", "3 0 -2 1"), "index-out-of-range")
        self.found("few.off", TETRAHEDRON.replace("3 0 2 1", "2 0 2"), "degenerate-face")

    def test_obj(self):
        self.refused("word.obj", OBJ.replace("1 0 0", "1 x 0"), "line 2", "'x'")
        self.refused("short.obj", OBJ.replace("1 0 0", "1 0"), "line 2", "three coordinates")
        self.refused("index.obj", OBJ.replace("f 1", "f a"), "line 4", "'a'")
        for index in ("0", "9", "-9", "99999999999999999999"):
            self.found("index.obj", OBJ.replace("f 1", f"f {index}"), "index-out-of-range")
        self.found("overflow.obj", OBJ.replace("1 0 0", "1e999 0 0"), "non-finite-coordinate")
        self.found("cut.obj", OBJ[:-3], "degenerate-face")

    def test_ply(self):
        self.refused("cut.ply", PLY_HEAD + PLY_BODY[:8], "3 rows", "vertex")
        self.refused("cut.ply", PLY_HEAD + PLY_BODY[:-4], "line 13", "row 0 of 1", "face")
        self.refused("count.ply", PLY_HEAD.replace("vertex 3", f"vertex {BILLIONS}") + PLY_BODY, str(BILLIONS), "vertex")
        self.refused("head.ply", PLY_HEAD[:-11], "end_header")
        self.refused("version.ply", PLY_HEAD.replace("1.0", "2.0") + PLY_BODY, "line 2", "1.0")
        self.refused("format.ply", PLY_HEAD.replace("ascii", "binary") + PLY_BODY, "line 2", "binary_little_endian")
        self.refused("flat.ply", PLY_HEAD.replace("property float z\n", "") + PLY_BODY, "vertex", "x, y and z")
        self.refused("type.ply", PLY_HEAD.replace("float z", "quad z") + PLY_BODY, "line 6", "quad")
        self.refused("list.ply", PLY_HEAD.replace("list uchar int vertex_indices", "int foo") + PLY_BODY, "vertex_indices")
        self.refused("magic.ply", "plyx" + PLY_HEAD[3:] + PLY_BODY, "'ply'")
        self.refused("more.ply", PLY_HEAD + PLY_BODY + "3 0 1 2\n", "line 14")
        head = BINARY_HEAD.encode()
        self.refused("cut.ply", head + BINARY_BODY[:-3], "byte", "row 0 of 1", "12", "9")
        self.refused("cut.ply", head + BINARY_BODY[:10], "3 rows", "vertex", "10")
        self.refused("count.ply", BINARY_HEAD.replace("face 1", f"face {BILLIONS}").encode() + BINARY_BODY, str(BILLIONS), "face")
        self.refused("more.ply", head + BINARY_BODY + b"xx", "2 bytes")
        self.found("index.ply", head + BINARY_BODY[:-4] + struct.pack("<i", -1), "index-out-of-range")

    def test_stl(self):
        self.refused("cut.stl", STL[:-9], "1 triangles", "134", "125")
        self.refused("count.stl", STL[:80] + struct.pack("<I", BILLIONS) + STL[84:], str(BILLIONS), "134")
        self.refused("count.stl", STL[:80] + struct.pack("<I", 0) + STL[84:], "0 triangles", "134")
        self.refused("head.stl", STL[:50], "84", "50")
        self.refused("none.stl", STL[:80] + bytes(4), "no face")
        self.refused("cut.stl", STL_TEXT[:60], "line 5", "0 facets")
        self.refused("cut.stl", STL_TEXT.replace("endsolid a\n", ""), "line 9", "endsolid")
        self.refused("word.stl", STL_TEXT.replace("1 0 0", "1 x 0"), "line 5", "'x'")
        self.refused("more.stl", STL_TEXT + "blah\n", "line 10", "blah")
        self.found("two.stl", STL_TEXT.replace("vertex 0 1 0\n", ""), "degenerate-face")

    def test_gltf(self):
        whole = glb()
        self.refused("cut.glb", whole[:-10], str(len(whole)), str(len(whole) - 10))
        self.refused("cut.glb", whole[:10], "10")
        self.refused("count.glb", glb(length=BILLIONS), str(BILLIONS), str(len(whole)))
        self.refused("version.glb", glb(version=3), "version 3", "version 2")
        self.refused("binary.glb", glb(binary=b""), "buffers[0]")
        for name, document, words in (
            ("count", changed("accessors", 0, "count", BILLIONS), ("accessors[0]", str(BILLIONS), "3")),
            ("count", changed("accessors", 1, "count", 4), ("accessors[1]", "4", "3")),
            ("type", changed("accessors", 0, "type", "VEC2"), ("POSITION", "VEC3")),
            ("mesh", changed("nodes", 0, "mesh", 7), ("nodes[0].mesh", "7", "1 meshes")),
            ("view", changed("accessors", 0, "bufferView", 9), ("accessors[0].bufferView", "9", "2 bufferViews")),
            ("view", changed("bufferViews", 0, "byteLength", 360), ("bufferViews[0]", "360", "42")),
            ("mode", changed("meshes", 0, "primitives", 0, "mode", 9), ("primitives[0].mode", "9")),
            ("matrix", changed("nodes", 0, "matrix", [1, 2, 3]), ("nodes[0].matrix", "3", "16")),
            ("extension", changed("extensionsRequired", ["EXT_unheard_of"]), ("EXT_unheard_of",)),
            ("loop", changed("nodes", 0, "children", [0]), ("nodes[0]",)),
            ("file", changed("buffers", 0, "uri", "missing.bin"), ("buffers[0].uri", "missing.bin")),
            ("file", changed("buffers", 0, "uri", "../../etc/passwd"), ("buffers[0].uri", "../../etc/passwd")),
        ):
            self.refused(name + ".gltf" if name == "file" else name + ".glb",
                         json.dumps(document) if name == "file" else glb(document), *words)
        self.refused("cut.gltf", json.dumps(GLTF)[:40], "truncated", "JSON", "column 41")
        self.refused("none.gltf", '{"asset": {}}', "version")
        self.found("index.glb", glb(binary=POINTS + struct.pack("<3H", 0, 1, 9)), "index-out-of-range")

    def test_draco(self):
        self.refused("magic.drc", b"DRACX" + bytes(50), "Draco")
        self.refused("cut.drc", b"DRACO", "Draco")
        self.refused("version.drc", b"DRACO\x09\x09\x01\x00\x00\x00" + bytes(40), "version")

    def test_what_is_no_mesh_is_named(self):
        for name, content, word in (
            ("none.off", "", "empty"), ("text.txt", "hello world\n", "no known mesh format"),
            ("zip.obj", b"PK\3\4" + bytes(40), "ZIP"), ("packed.ply", b"\x1f\x8b\x08" + bytes(40), "gunzip"),
            ("page.obj", "<!DOCTYPE html><html></html>\n", "<html>"), ("part.fbx", b"Kaydara FBX Binary  \0" + bytes(40), "FBX"),
            ("pointer.stl", "version https://git-lfs.github.com/spec/v1\noid sha256:" + 64 * "a" + "\nsize 12\n", "git lfs pull"),
            ("wide.obj", OBJ.encode("utf-16"), "UTF-16"),
        ):
            self.refused(name, content, word)


if __name__ == "__main__":
    unittest.main()
