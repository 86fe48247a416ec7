# SPDX-License-Identifier: Apache-2.0
"""Mesh files of other people, where they are at hand, and what a plain count of their faces gives.

Looked for in the folder that FDCG_REAL_MESHES names, else ../shared/meshes beside the project; in Debian's assimp-testmodels; and
in the data of its libcgal-demo, which is unpacked first. None of them is part of the project."""
import json
import os
import pathlib
import re
import struct
import tarfile

from support import ROOT

ENDINGS = (".off", ".obj", ".ply", ".stl", ".gltf", ".glb", ".drc")
ASSIMP_MODELS = pathlib.Path("/usr/share/assimp/models")
CGAL_DATA = pathlib.Path("/usr/share/doc/libcgal-dev/data.tar.gz")


def mesh_files(folder):
    """Every mesh file at hand; archives are unpacked into `folder`."""
    named = os.environ.get("FDCG_REAL_MESHES")
    roots = [pathlib.Path(named) if named else ROOT / ".." / "shared" / "meshes", ASSIMP_MODELS]
    if CGAL_DATA.exists():
        with tarfile.open(CGAL_DATA) as archive:
            archive.extractall(folder, [m for m in archive.getmembers() if m.isfile() and m.name.lower().endswith(ENDINGS)])
        roots.append(pathlib.Path(folder))
    return sorted(path for root in roots if root.is_dir() for path in root.rglob("*")
                  if path.is_file() and path.suffix.lower() in ENDINGS)


def count_faces(path):
    """The faces that a file says it has; None where a plain count cannot tell."""
    data = path.read_bytes()
    return {".off": count_off, ".obj": count_obj, ".ply": count_ply, ".stl": count_stl,
            ".gltf": count_gltf, ".glb": count_gltf}.get(path.suffix.lower(), lambda _: None)(data)


def count_off(data):
    words = re.sub(rb"#[^\n]*", b"", data).split()
    if not words:
        return None
    start = 1 if words[0].upper().endswith(b"OFF") else 0
    try:
        return int(words[start + 1])
    except (IndexError, ValueError):
        return None


def count_obj(data):
    joined = re.sub(rb"\\\r?\n", b" ", data)
    return sum(1 for line in re.split(rb"\r\n|\n|\r", joined) if re.match(rb"\s*fo?(\s|$)", line))


def count_ply(data):
    header = data.split(b"end_header")[0]
    if b"element tristrips" in header:
        return None
    found = re.search(rb"element\s+face\s+(\d+)", header)
    return int(found.group(1)) if found else 0


def count_stl(data):
    if len(data) >= 84 and 84 + 50 * struct.unpack_from("<I", data, 80)[0] == len(data):
        return struct.unpack_from("<I", data, 80)[0]
    return len(re.findall(rb"^\s*facet\s", data, re.MULTILINE | re.IGNORECASE))


def count_gltf(data):
    """The triangles of every node of the scene that has a mesh. Fans and strips give two faces fewer than they have indices."""
    if data[:4] == b"glTF":
        if struct.unpack_from("<I", data, 4)[0] != 2:
            return None
        data = data[20:20 + struct.unpack_from("<I", data, 12)[0]]
    try:
        document = json.loads(data)
    except ValueError:
        return None
    try:
        if not document["asset"]["version"].startswith("2"):
            return None
        nodes, meshes, accessors = (document.get(key, []) for key in ("nodes", "meshes", "accessors"))
    except (LookupError, TypeError, AttributeError):
        return None

    def in_primitive(primitive):
        indices = primitive.get("indices", primitive["attributes"].get("POSITION"))
        if indices is None:
            return 0
        count, mode = accessors[indices]["count"], primitive.get("mode", 4)
        return {4: count // 3, 5: max(0, count - 2), 6: max(0, count - 2)}.get(mode, 0)

    def below(node):
        own = sum(map(in_primitive, meshes[node["mesh"]]["primitives"])) if "mesh" in node else 0
        return own + sum(below(nodes[child]) for child in node.get("children", []))

    try:
        scenes = document.get("scenes", [])
        if scenes:
            roots = scenes[document.get("scene", 0)].get("nodes", [])
        else:
            children = {child for node in nodes for child in node.get("children", [])}
            roots = [i for i in range(len(nodes)) if i not in children]
        return sum(below(nodes[root]) for root in roots)
    except (LookupError, TypeError, AttributeError, RecursionError):
        return None
