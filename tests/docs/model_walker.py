# SPDX-License-Identifier: Apache-2.0
"""The step as docs/internals/contact-model.md has it, written anew rule by rule: double precision, triangles, every face
looked at. Left out are the rules that this needs none of: busy corners (contact-model CORNER-7), inexact nodes (EDGE-7, GRAPH-4),
slits as narrow as a rounding (LEAVE-3), work carried over (BOUND-1 to BOUND-3), what only saves time (TICK-7, FREE-7),
damping, and the friction curve. Over 400 lines: the model in one place, in the page's order."""
import math
from fractions import Fraction

EPS = 2.0 ** -52
FREE, FACE, EDGE, VERTEX = range(4)
CONVEX, CONCAVE, COPLANAR, BOUNDARY = range(4)
NOWHERE = (FREE, None)


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def minus(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def plus(a, b):
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def times(a, s):
    return (a[0] * s, a[1] * s, a[2] * s)


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def norm(a):
    return math.sqrt(dot(a, a))


def norm1(a):
    return abs(a[0]) + abs(a[1]) + abs(a[2])


def over(a, length):
    return (a[0] / length, a[1] / length, a[2] / length)


def exactly(a):
    return tuple(Fraction(x) for x in a)


def orientation(a, b, c, d):
    """1: d is in front of the plane a, b, c; exact."""
    a, b, c, d = map(exactly, (a, b, c, d))
    volume = dot(cross(minus(b, a), minus(c, a)), minus(d, a))
    return (volume > 0) - (volume < 0)


def unit_normal(a, b, c):
    a, b, c = map(exactly, (a, b, c))
    across = cross(minus(b, a), minus(c, a))
    size = max(map(abs, across))
    rounded = tuple(float(x / size) for x in across)
    return over(rounded, norm(rounded))


def balanced_offset(n, corners):
    """That makes the largest distance of the corners smallest."""
    heights = [dot(exactly(n), exactly(p)) for p in corners]
    return -float((min(heights) + max(heights)) / 2)


class Edge:
    def __init__(self, graph, start, end, face_a, face_b):
        self.corner = (start, end)
        self.v0 = graph.point[start]
        along = minus(graph.point[end], self.v0)
        self.length = norm(along)
        self.direction = over(along, self.length)
        self.face = (face_a, face_b)
        self.type = BOUNDARY
        if face_b is not None:
            apex = next(v for v in graph.face[face_b] if v not in (start, end))
            self.type = (COPLANAR, CONCAVE, CONVEX)[orientation(*(graph.point[v] for v in graph.face[face_a]), graph.point[apex])]
        self.voronoi = []  # contact-model GRAPH-3
        for which, face in enumerate(self.face):
            if face is None:
                continue
            n = graph.normal[face]
            out = cross(self.direction, n) if which == 0 else cross(n, self.direction)
            m = over(out, norm(out))
            self.voronoi.append((m, -dot(m, self.v0)))
        self.end_tolerance = 10 * EPS * graph.extent

    def parameter(self, x):
        return dot(minus(x, self.v0), self.direction)

    def at(self, u):
        return plus(self.v0, times(self.direction, u))


class Graph:
    def __init__(self, points, faces):
        self.point, self.face = points, faces
        self.extent = max(abs(c) for p in points for c in p)
        self.normal = [unit_normal(*(points[v] for v in f)) for f in faces]
        self.offset = [balanced_offset(n, [points[v] for v in f]) for n, f in zip(self.normal, faces)]
        half = {(f[k], f[(k + 1) % 3]): (n, k) for n, f in enumerate(faces) for k in range(3)}
        self.edge, self.side = [], [[None] * 3 for _ in faces]  # a side: its edge and which of its faces this is
        for n, f in enumerate(faces):
            for k in range(3):
                if self.side[n][k] is None:
                    across = half.get((f[(k + 1) % 3], f[k]))
                    self.side[n][k] = (len(self.edge), 0)
                    if across:
                        self.side[across[0]][across[1]] = (len(self.edge), 1)
                    self.edge.append(Edge(self, f[k], f[(k + 1) % 3], n, across[0] if across else None))
        self.faces_at = [[n for n, f in enumerate(faces) if v in f] for v in range(len(points))]
        self.edges_at = [[i for i, e in enumerate(self.edge) if v in e.corner] for v in range(len(points))]

    def begins_outside(self, v, x):  # contact-model CORNER-4, by turning the way about v: what does it meet first?
        exact_v = exactly(self.point[v])
        t = minus(exactly(x), exact_v)
        wings = []
        for face in self.faces_at[v]:
            k = self.face[face].index(v)
            wings.append([minus(exactly(self.point[self.face[face][(k + i) % 3]]), exact_v) for i in (1, 2)])
        if any(not any(cross(a, t)) and dot(a, t) > 0 for a, _ in wings):
            return True
        if any(not any(cross(a, t)) for a, _ in wings):  # against an edge: no plane that holds the way is in general position
            t = plus(t, times((3, 5, 7), max(map(abs, t)) / 2 ** 300))
        for turn in range(1, 1000):  # almost any plane that holds the way and passes across a face
            a, b = wings[turn % len(wings)]
            off = tuple(Fraction(turn * k % 17 - 8, 1000) * max(map(abs, a)) for k in (3, 5, 7))
            axis = cross(t, plus(plus(times(a, Fraction(turn % 5 + 1, 3)), b), off))
            up, first, is_outside, is_good = cross(axis, t), None, False, any(axis)
            for a, b in wings:
                at_a, at_b = dot(axis, a), dot(axis, b)
                is_good = is_good and at_a != 0 != at_b
                if (at_a > 0) == (at_b > 0):
                    continue
                ray = plus(times(a, abs(at_b)), times(b, abs(at_a)))
                along, across = dot(ray, t), dot(ray, up)
                if across == 0 and along > 0:
                    return True
                if across > 0 and (first is None or along * first[1] > first[0] * across):
                    first, is_outside = (along, across), dot(cross(a, b), t) > 0
            if is_good and first is not None:
                return is_outside
        raise ValueError("no plane through the way is in general position")

    def rounding(self, x):
        return 8 * EPS * (norm1(x) + 2 * self.extent)  # B(x)

    def distance(self, face, x):
        return dot(self.normal[face], x) + self.offset[face]

    def side_of(self, face, x):  # contact-model SIDE-1
        rounded = self.distance(face, x)
        if abs(rounded) > self.rounding(x):
            return rounded
        sign = orientation(*(self.point[v] for v in self.face[face]), x)
        return rounded if rounded * sign > 0 else 1e-150 * sign

    def voronoi(self, face, k):
        edge, which = self.side[face][k]
        return self.edge[edge].voronoi[which]


def beyond(plane, x):
    return dot(plane[0], x) + plane[1]


class Walker:
    """One contact. tick(h) returns (state, transitions); god_object and is_slipping stand here."""

    def __init__(self, graph, mu_static, mu_dynamic, is_wedge=True):
        self.graph, self.mu_static, self.mu_dynamic, self.is_wedge = graph, mu_static, mu_dynamic, is_wedge
        self.at, self.seat, self.is_slipping, self.god_object, self.hip = NOWHERE, None, False, None, None

    # ---- the tick

    def tick(self, hip):
        self.hip, is_first, self.transitions, self.rim = hip, self.hip is None, 0, None
        if is_first:  # contact-model TICK-3
            self.god_object = hip
        else:
            self.walk()
        if self.at == NOWHERE:
            self.is_slipping = False  # contact-model FRIC-5
        return self.at[0], self.transitions

    def walk(self):
        if self.at == NOWHERE:
            self.sweep(NOWHERE)
            if self.at == NOWHERE:
                return
            self.transitions += 1
        nearest, visited = self.gap2(), [self.at]
        while True:
            before = self.at
            after = (None, self.on_face, self.on_edge, self.on_vertex)[before[0]](before[1])
            if after is None:
                return
            self.at = after
            self.transitions += 1
            if after == NOWHERE:
                self.step_clear(before)
                self.sweep(before)
                if self.at == NOWHERE:
                    return
                self.transitions += 1
            if self.gap2() < nearest:
                nearest, visited = self.gap2(), []
            if not self.may_visit(self.at, visited) and not self.goes_on_at_corner(visited):
                return

    @staticmethod
    def may_visit(feature, visited):  # contact-model TICK-5
        if feature in visited:
            return False
        if len(visited) == 32:
            visited.clear()
        visited.append(feature)
        return True

    def goes_on_at_corner(self, visited):
        if self.rim is None:
            return False
        edge, after = self.graph.edge[self.rim], (EDGE, self.rim)
        if self.seat == after:
            u = edge.parameter(self.god_object)
            if u > edge.end_tolerance and edge.length - u > edge.end_tolerance:
                return False
            after = self.place_on_edge(self.rim, u)
        elif self.seat is None or self.seat[0] != VERTEX or self.seat[1] not in edge.corner:
            return False
        elif any(side < 0 and s < 0 for side, s in self.sides(edge)) and not self.holds(after):
            return False
        if not self.may_visit(after, visited):
            return False
        self.at = after
        return True

    def gap2(self):
        gap = minus(self.god_object, self.hip)
        return dot(gap, gap)

    def place(self, point, seat):
        self.god_object, self.seat = point, seat

    # ---- free space

    def sweep(self, left):
        graph, start, end = self.graph, self.god_object, self.hip
        hit = self.first_hit(start, end, self.left_out(left)) if start != end else None
        if hit is None:  # contact-model FREE-6
            self.place(end, None)
            self.at = NOWHERE
            return
        fraction, face, met_exactly = hit
        point = plus(start, times(minus(end, start), fraction))
        if not met_exactly:
            self.place(point, None)
            self.at = (FACE, face)
            return

        corner = self.corner_met(face, met_exactly)
        if corner is not None:
            self.place(graph.point[corner], (VERTEX, corner))
            self.at = (VERTEX, corner)
            return

        def off(k):
            edge = graph.edge[graph.side[face][k][0]]
            return norm(minus(point, edge.at(min(max(edge.parameter(point), 0.0), edge.length))))

        edge = graph.side[face][min(met_exactly, key=off)][0]  # contact-model FREE-4
        self.at = self.place_on_edge(edge, graph.edge[edge].parameter(point))

    def corner_met(self, face, met_exactly):  # contact-model FREE-4
        if len(met_exactly) != 2:
            return None
        return self.graph.face[face][met_exactly[1] if met_exactly[1] == met_exactly[0] + 1 else 0]

    def first_hit(self, start, end, left_out):  # contact-model FREE-3
        graph, best = self.graph, None
        for face in range(len(graph.face)):
            if face in left_out or graph.distance(face, end) > graph.rounding(end):
                continue
            s1 = graph.side_of(face, end)
            s0 = graph.side_of(face, start) if s1 < 0 else -1
            if s0 < 0 or (best is not None and s0 / (s0 - s1) >= best[0]):
                continue
            corners = [graph.point[v] for v in graph.face[face]]
            signs = [orientation(start, end, corners[k], corners[(k + 1) % 3]) for k in range(3)]
            if max(signs) <= 0:
                best = (s0 / (s0 - s1), face, [k for k in range(3) if signs[k] == 0])
        return best

    def left_out(self, left):  # contact-model LEAVE-1
        state, index = left
        if state == FACE:
            return {index}
        if state == EDGE:
            return set(self.graph.edge[index].face)
        return set(self.graph.faces_at[index]) if state == VERTEX else set()

    def step_clear(self, left):  # contact-model LEAVE-2
        graph, (state, index) = self.graph, left
        if state == FACE:
            self.move_in_front([index], graph.normal[index])
        if state == EDGE:
            edge = graph.edge[index]
            a, b = edge.face
            passed = [f for f in edge.face if f is not None and graph.side_of(f, self.hip) >= 0]
            if edge.type == CONCAVE:
                outward = plus(graph.normal[a], graph.normal[b])
                self.move_in_front([a, b], times(outward, 1 / (norm(outward) + 2.0 ** -1022)))
            elif passed:
                self.move_in_front(passed[:1], graph.normal[passed[0]])

    def move_in_front(self, faces, outward):
        for face in faces:
            step = max(abs(self.graph.distance(face, self.god_object)), EPS * self.graph.extent / 4096)
            for _ in range(16):
                if self.graph.side_of(face, self.god_object) >= 0:
                    break
                self.god_object = plus(self.god_object, times(outward, step))
                step *= 2

    # ---- on a face

    def on_face(self, face):
        graph, hip = self.graph, self.hip
        depth = -graph.side_of(face, hip)
        if depth <= 0:
            return self.leave_face(face)
        n = graph.normal[face]

        def in_plane(a):
            return minus(a, times(n, dot(n, a)))

        q = in_plane(minus(self.god_object, hip))
        radius = self.slip(dot(q, q), depth)
        if radius is None:  # contact-model FACE-3
            return None
        target = plus(plus(hip, times(n, depth)), times(q, radius / norm(q) if radius > 0 and norm(q) > 0 else 0.0))  # contact-model FACE-4
        crossing = self.first_crossing(face, target)
        if crossing is None:
            off = graph.distance(face, target) if norm1(hip) > 16 * graph.extent else 0.0
            if abs(off) <= graph.extent / 1024:
                self.place(minus(target, times(n, off)), None)
            return None
        fraction, k = crossing
        return self.cross_side(face, k, plus(self.god_object, times(minus(target, self.god_object), fraction)))

    def cross_side(self, face, k, point):  # contact-model FACE-6
        graph, plane = self.graph, self.graph.voronoi(face, k)
        on = minus(minus(point, times(graph.normal[face], graph.distance(face, point))), times(plane[0], beyond(plane, point)))
        tolerance = graph.edge[graph.side[face][k][0]].end_tolerance
        others = (beyond(graph.voronoi(face, j), on) for j in range(3) if j != k)
        if norm1(self.hip) > 16 * graph.extent or any(s >= -tolerance for s in others):
            return self.place_on_rim(face, k, point)
        self.rim = graph.side[face][k][0]
        self.place(on, (EDGE, self.rim))
        return self.seat

    def leave_face(self, face):  # contact-model FACE-1
        if self.seat is not None:
            return self.seat
        rounding = 8 * EPS * (norm1(self.god_object) + self.graph.extent)
        for k in range(3):
            is_near = beyond(self.graph.voronoi(face, k), self.god_object) >= -rounding
            if is_near and self.is_between_ends(face, k, self.god_object):
                return self.place_on_rim(face, k, self.god_object)
        self.god_object = self.foot(face, self.god_object)
        return NOWHERE

    def foot(self, face, x):
        return minus(x, times(self.graph.normal[face], self.graph.distance(face, x)))

    def is_between_ends(self, face, k, x):
        return self.past_ends(face, k, x) <= self.graph.edge[self.graph.side[face][k][0]].end_tolerance

    def past_ends(self, face, k, x):
        edge = self.graph.edge[self.graph.side[face][k][0]]
        return max(-edge.parameter(x), edge.parameter(x) - edge.length)

    def first_crossing(self, face, target):  # contact-model FACE-5
        rounding, best = 4 * EPS * (norm1(target) + self.graph.extent), None
        for k in range(3):
            s0, s1 = (beyond(self.graph.voronoi(face, k), x) for x in (self.god_object, target))
            if s1 < -rounding or not self.may_cross(s0, s1):
                continue
            fraction = 1.0 if s1 <= rounding or s1 <= s0 else 0.0 if s0 >= 0 else -s0 / (s1 - s0)
            is_tie = best is not None and fraction == best[0] == 1.0
            is_better = is_tie and max(0.0, self.past_ends(face, k, target)) < self.past_ends(face, best[1], target)
            if best is None or fraction < best[0] or is_better:
                best = (fraction, k)
        return best

    def may_cross(self, _s0, _s1):
        return True

    def place_on_rim(self, face, k, point):
        edge = self.graph.side[face][k][0]
        return self.place_on_edge(edge, self.graph.edge[edge].parameter(point))

    def place_on_edge(self, index, u):  # contact-model FACE-6
        edge, self.rim = self.graph.edge[index], index
        self.place(edge.at(u), (EDGE, index))
        for vertex, from_end in zip(edge.corner, (u, edge.length - u)):
            if from_end <= edge.end_tolerance:
                self.place(self.graph.point[vertex], (VERTEX, vertex))
                break
        return self.seat

    # ---- friction

    def slip(self, r2, load):
        """None: GO rests; else how far from SP it may be. contact-model FRIC-1 to FRIC-4."""
        radius = self.mu_dynamic * load
        if self.is_slipping:
            self.is_slipping = r2 > ((1 - 2.0 ** -20) * radius) ** 2
        else:
            self.is_slipping = r2 > (self.mu_static * load) ** 2
        rounding = EPS * (norm1(self.god_object) / 2 + 4 * radius)
        return None if not self.is_slipping or r2 <= (radius + rounding) ** 2 else radius

    # ---- on an edge

    def sides(self, edge):
        return [(self.graph.side_of(f, self.hip), beyond(m, self.hip)) for f, m in zip(edge.face, edge.voronoi)]

    def is_free_of(self, edge, sides):  # contact-model EDGE-1
        outside = [side >= 0 for side, _ in sides]
        return all(outside) if edge.type == CONCAVE else any(outside)

    def on_edge(self, index):
        edge = self.graph.edge[index]
        sides = self.sides(edge)
        over_ = [(s, face) for (side, s), face in zip(sides, edge.face) if side < 0 and s < 0]
        if edge.type == BOUNDARY:
            return (FACE, edge.face[0]) if over_ else NOWHERE
        if self.is_free_of(edge, sides):
            return NOWHERE
        if over_:  # contact-model EDGE-2
            return FACE, min(over_, key=lambda candidate: candidate[0])[1]
        foot = edge.parameter(self.hip)  # contact-model EDGE-3
        ahead = edge.parameter(self.god_object) - foot
        radius = self.slip(ahead * ahead, self.edge_load(edge, minus(self.hip, edge.at(foot))))
        if radius is None:  # contact-model EDGE-5
            u = foot + ahead
            if self.mu_static > 0 or min(u, edge.length - u) > edge.end_tolerance:
                return None
            radius = 0.0
        landed = self.place_on_edge(index, foot + radius if ahead > 0 else foot - radius)  # contact-model EDGE-6
        return None if landed == (EDGE, index) else landed

    def edge_load(self, edge, w):  # contact-model EDGE-4
        if not self.is_wedge:
            return norm(w)
        normals = plus(*(self.graph.normal[f] for f in edge.face))
        most, squared, load = 1024 * norm(w), dot(normals, normals), -2 * dot(normals, w)
        if squared > 0 and not load > 0:
            return 0.0
        return load / squared if load < most * squared else most

    # ---- on a vertex

    def on_vertex(self, vertex):
        t = minus(self.hip, self.graph.point[vertex])
        is_open = any(self.graph.edge[e].type == BOUNDARY for e in self.graph.edges_at[vertex])
        after = self.after_open_vertex(vertex, t) if is_open else self.after_vertex(vertex, t)
        return None if after == (VERTEX, vertex) else after

    def after_vertex(self, vertex, t):  # contact-model CORNER-3, CORNER-4
        if self.graph.begins_outside(vertex, self.hip):
            return NOWHERE
        return self.steepest(vertex, t, self.holds)

    def after_open_vertex(self, vertex, t):  # contact-model CORNER-5
        found = self.steepest(vertex, t, lambda _: True)
        if found[0] == VERTEX or not self.holds(found):
            return NOWHERE
        edge = self.graph.edge[found[1]] if found[0] == EDGE else None
        return (FACE, edge.face[0]) if edge and edge.type == BOUNDARY else found

    def holds(self, feature):
        state, index = feature
        if state == FACE:
            return self.graph.side_of(index, self.hip) < 0
        edge = self.graph.edge[index]
        sides = self.sides(edge)
        if edge.type == BOUNDARY:
            return sides[0][0] < 0 and sides[0][1] < 0
        return not self.is_free_of(edge, sides)

    def steepest(self, vertex, t, may_be):  # contact-model CORNER-1, CORNER-2
        graph, t2 = self.graph, dot(t, t)
        best = ((VERTEX, vertex), 0.0, t2)

        def steeper(one, other):
            are_near = one[2] < t2 / 2 and other[2] < t2 / 2
            is_steeper = other[2] < one[2] if are_near else other[1] > one[1]
            return other if is_steeper and may_be(other[0]) else one

        for index in graph.edges_at[vertex]:
            edge = graph.edge[index]
            forward = dot(t, edge.direction)
            if forward * (1 if edge.corner[0] == vertex else -1) > 0:
                off = minus(t, times(edge.direction, forward))
                best = steeper(best, ((EDGE, index), forward * forward, dot(off, off)))
        for face in graph.faces_at[vertex]:
            k = graph.face[face].index(vertex)
            if all(dot(graph.voronoi(face, j)[0], t) < 0 for j in (k, (k - 1) % 3)):
                height = dot(graph.normal[face], t)
                in_plane = minus(t, times(graph.normal[face], height))
                best = steeper(best, ((FACE, face), dot(in_plane, in_plane), height * height))
        return best[0]

