#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A rival in a process of its own, to begin with: docs/rivals.md has the lines that it reads and writes. It works as it is, on
convex bodies, as template.c does; slowly, being Python.

  tools/bench --only contenders --rival 'pipe:python3 tests/evaluation/rivals/template.py'
"""
import math
import sys
import time


class Body:
    def __init__(self, points_m, triangles, stiffness_n_per_m):
        self.stiffness_n_per_m = stiffness_n_per_m
        self.planes = []  # outward unit normal, distance from the origin
        for a, b, c in triangles:
            p = points_m[a]
            u = [x - y for x, y in zip(points_m[b], p)]
            v = [x - y for x, y in zip(points_m[c], p)]
            n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
            length = math.hypot(*n)
            if length > 0:
                n = [x / length for x in n]
                self.planes.append((*n, sum(x * y for x, y in zip(n, p))))

    def reset(self):
        """Forgets the last tick; this method remembers none."""

    def step(self, hip_m):
        """God-object, force, whether there is contact."""
        x, y, z = hip_m
        height, normal = max((a * x + b * y + c * z - d, (a, b, c)) for a, b, c, d in self.planes)
        if height >= 0:
            return hip_m, [0.0, 0.0, 0.0], False
        offset = [-height * n for n in normal]
        return [h + o for h, o in zip(hip_m, offset)], [self.stiffness_n_per_m * o for o in offset], True


def say(*words):
    print(*words, flush=True)


def numbers(words):
    return [float.fromhex(w) for w in words]


def main():
    body = None
    for line in sys.stdin:
        word, *rest = line.split()
        if word == "mesh":
            points, triangles = map(int, rest[:2])
            points_m = [numbers(sys.stdin.readline().split()) for _ in range(points)]
            corners = [[int(w) for w in sys.stdin.readline().split()] for _ in range(triangles)]
            body = Body(points_m, corners, float.fromhex(rest[2]))
            say("ready", "template_pipe", "planes", "f64", "no", 32 * len(body.planes))
        elif word == "reset":
            body.reset()
        elif word == "step":
            begin = time.perf_counter_ns()
            god_object, force, is_in_contact = body.step(numbers(rest))
            took_ns = time.perf_counter_ns() - begin
            say("contact" if is_in_contact else "free", *(x.hex() for x in [*god_object, *force]), took_ns)


main()
