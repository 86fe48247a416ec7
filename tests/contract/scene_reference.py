# SPDX-License-Identifier: Apache-2.0
"""COLLADA and 3MF files read a second time, with Python's XML and ZIP modules and numpy, for comparison: points and faces of the
scene that a file shows, in its own unit and axes, in the order of the file."""
import math
import posixpath
import re
import xml.etree.ElementTree as tree
import zipfile

import numpy

MODEL = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"
UNITS = {"micron": 1e-6, "millimeter": 1e-3, "centimeter": 1e-2, "inch": 0.0254, "foot": 0.3048, "meter": 1.0}


class Scene:
    def __init__(self, metres_per_unit):
        self.metres_per_unit = metres_per_unit
        self.points, self.faces, self.is_moved = [], [], False

    def add(self, points, faces, matrix):
        first = len(self.points)
        if not (matrix == numpy.eye(4)).all():
            self.is_moved = True
            points = [tuple((matrix @ numpy.array([*p, 1.0]))[:3]) for p in points]
        self.points += points
        turn = numpy.linalg.det(matrix[:3, :3]) < 0
        for face in faces:
            face = [face[0], *reversed(face[1:])] if turn and face else face
            self.faces.append([first + corner for corner in face])


def local(element):
    return element.tag.rpartition("}")[2]


def attribute(element, name):
    return next((value for key, value in element.attrib.items() if key.rpartition("}")[2] == name), None)


def children(element, *names):
    return [] if element is None else [e for e in element if local(e) in names]


def child(element, name):
    return next(iter(children(element, name)), None)


def text(element):
    return "".join(element.itertext()) if element is not None else ""


def numbers(element):
    return [float(re.sub(r"^([-+]?\d+),(\d+)", r"\1.\2", word)) for word in text(element).split()]


class Collada:
    def __init__(self, path):
        self.root = tree.parse(path).getroot()
        self.by_id = {(local(e), e.get("id")): e for e in self.root.iter() if e.get("id")}
        unit = child(child(self.root, "asset"), "unit")
        metres = (unit.get("meter") if unit is not None else None) or "1"
        self.scene = Scene(float(metres.replace(",", ".")))

    def read(self):
        instance = child(child(self.root, "scene"), "instance_visual_scene")
        shown = self.find(instance, "url", "visual_scene") if instance is not None else next(self.all("visual_scene"), None)
        if shown is None:
            for geometry in self.all("geometry"):
                self.show(geometry, numpy.eye(4))
        for node in children(shown, "node"):
            self.walk(node, numpy.eye(4))
        return self.scene

    def all(self, name):
        return (e for e in self.root.iter() if local(e) == name)

    def find(self, element, key, kind):
        return self.by_id.get((kind, element.get(key).lstrip("#")))

    def walk(self, node, above):
        matrix = above
        for element in node:
            matrix = matrix @ own_transform(element)
        for element in node:
            kind = local(element)
            if kind == "node":
                self.walk(element, matrix)
            elif kind == "instance_node":
                self.walk(self.find(element, "url", "node"), matrix)
            elif kind == "instance_geometry":
                self.show(self.find(element, "url", "geometry"), matrix)
            elif kind == "instance_controller":
                bend = next(e for e in self.find(element, "url", "controller") if local(e) in ("skin", "morph"))
                self.show(self.find(bend, "source", "geometry"), matrix)

    def show(self, geometry, matrix):
        by_source = {}
        for element in children(child(geometry, "mesh"), "triangles", "polylist", "polygons", "trifans", "tristrips"):
            inputs = children(element, "input")
            vertex = next((i for i in inputs if i.get("semantic") == "VERTEX"), None)
            if vertex is None:
                continue
            stride = 1 + max(int(i.get("offset")) for i in inputs)
            position = next(i for i in self.find(vertex, "source", "vertices") if i.get("semantic") == "POSITION")
            faces = by_source.setdefault(position.get("source"), (position, []))[1]
            faces += list(self.faces(element, stride, int(vertex.get("offset"))))
        blocks = [(self.positions(position), faces) for position, faces in by_source.values()]
        for points, faces in blocks:
            self.scene.add(points, faces, matrix)

    def positions(self, position):
        source = self.find(position, "source", "source")
        accessor = child(child(source, "technique_common"), "accessor")
        values = numbers(child(source, "float_array"))
        stride, count = int(accessor.get("stride")), int(accessor.get("count"))
        return [tuple(values[stride * i:stride * i + 3]) for i in range(count)]

    @staticmethod
    def faces(element, stride, offset):
        runs = [[int(word) for word in text(p).split()][offset::stride] for p in children(element, "p")]
        kind = local(element)
        if kind == "polygons":
            yield from runs
        elif kind == "trifans":
            for run in runs:
                yield from ([run[0], b, c] for b, c in zip(run[1:], run[2:]))
        elif kind == "tristrips":
            for run in runs:
                for i, (a, b, c) in enumerate(zip(run, run[1:], run[2:])):
                    if len({a, b, c}) == 3:
                        yield [a, c, b] if i % 2 else [a, b, c]
        else:
            corners = [corner for run in runs for corner in run]
            sizes = [3] * (len(corners) // 3) if kind == "triangles" else [int(word) for word in text(child(element, "vcount")).split()]
            for size in sizes:
                yield corners[:size]
                corners = corners[size:]


def own_transform(element):
    kind, matrix = local(element), numpy.eye(4)
    if kind == "matrix":
        return numpy.array(numbers(element)).reshape(4, 4)
    if kind == "translate":
        matrix[:3, 3] = numbers(element)
    if kind == "scale":
        matrix[:3, :3] = numpy.diag(numbers(element))
    if kind == "rotate":
        x, y, z, degrees = numbers(element)
        if degrees == 0:
            return matrix
        axis = numpy.array([x, y, z]) / math.sqrt(x * x + y * y + z * z)
        cross = numpy.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
        angle = math.radians(degrees)
        matrix[:3, :3] += math.sin(angle) * cross + (1 - math.cos(angle)) * (cross @ cross)
    return matrix


class Package:
    """3MF"""

    def __init__(self, path):
        self.archive, self.parts = zipfile.ZipFile(path), {}
        relations = tree.fromstring(self.archive.read("_rels/.rels"))
        self.root = next(r.get("Target") for r in relations if r.get("Type") == MODEL)
        self.scene = Scene(UNITS[self.part(self.root).get("unit", "millimeter")])

    def part(self, path):
        name = posixpath.normpath(path).lstrip("/")
        if name not in self.parts:
            self.parts[name] = tree.fromstring(self.archive.read(name))
        return self.parts[name]

    def read(self):
        for item in children(child(self.part(self.root), "build"), "item"):
            self.show(self.root, item, numpy.eye(4))
        return self.scene

    def show(self, path, reference, above):
        path = attribute(reference, "path") or path
        objects = children(child(self.part(path), "resources"), "object")
        shown = next(o for o in objects if o.get("id") == reference.get("objectid"))
        matrix = numpy.eye(4)
        if reference.get("transform"):
            matrix[:3, :] = numpy.array([float(word) for word in reference.get("transform").split()]).reshape(4, 3).T
        matrix = above @ matrix
        for component in children(child(shown, "components"), "component"):
            self.show(path, component, matrix)
        mesh = child(shown, "mesh")
        if mesh is None:
            return
        points = [tuple(float(v.get(axis)) for axis in "xyz") for v in children(child(mesh, "vertices"), "vertex")]
        faces = [[int(t.get(corner)) for corner in ("v1", "v2", "v3")] for t in children(child(mesh, "triangles"), "triangle")]
        self.scene.add(points, faces, matrix)


def read(path):
    return (Package if path.suffix.lower() == ".3mf" else Collada)(path).read()
