#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Judges a contender's answers along a way from files alone (docs/rivals.md): nothing of this project is linked or run.

Usage: judge.py FILE.answers...
Prints, for each: contact ticks of the truth; the god-object's error in metres (RMS from the truth, RMS from the nearest right answer,
largest from the truth); the largest error of the force in newtons; and the passes through the solid. Exit codes: 0; 2 wrong usage or a broken file.
"""
import math
import pathlib
import sys

TOUCH_N = 1e-5 * 1000  # force from which a contact that is lost counts: a depth of 10 micrometres
BACKWARDS = -0.7       # cosine of forces that are opposite
OTHER = 8              # values of another right answer: whether doubles do not tell it apart either, contact, god-object, force


def read(path, first_line):
    """The head's lines as a dict, and the rows as lists of words."""
    head = {}
    with open(path, encoding="ascii") as file:
        if file.readline().rstrip("\n") != first_line:
            raise ValueError(f"{path}:1: is not '{first_line}'")
        for line in file:
            key, _, value = line.rstrip("\n").partition(" ")
            head[key] = value
            if key == "columns":
                break
        rows = [line.split() for line in file if line.strip() and not line.startswith("#")]
    columns = head.get("columns", "").split()
    for number, row in enumerate(rows, 1):
        more = OTHER * int(row[len(columns) - 1]) if columns[-1] == "others" else 0
        if len(row) != len(columns) + more:
            raise ValueError(f"{path}: row {number} has {len(row)} values under {len(columns)} columns")
    return head, rows


def exact(words):
    return [float.fromhex(word) for word in words]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def rms(values):
    return math.sqrt(sum(v * v for v in values) / len(values)) if values else 0.0


def judge(path):
    path = pathlib.Path(path)
    head, answers = read(path, "fdcg-answers 1")
    _, truth = read(path.parent / head["way"], "fdcg-way 1")
    if len(answers) != len(truth):
        raise ValueError(f"{path}: {len(answers)} rows for a way of {len(truth)}")
    is_double = head.get("precision") == "f64"
    errors, judged, force_error, contacts, passes = [], [], 0.0, 0, 0
    was_lost = False
    for answer, true in zip(answers, truth):
        touches, is_carried = answer[0] == "1", answer[1] == "1"
        god_object, force = exact(answer[2:5]), exact(answer[5:8])
        right = [(exact(true[at:at + 3]), exact(true[at + 3:at + 6])) for at in
                 [4, *(at + 2 for at in range(11, len(true), OTHER) if true[at] == "1" or not is_double)]]
        errors.append(math.dist(god_object, right[0][0]))
        judged.append(min(math.dist(god_object, place) for place, _ in right))
        force_error = max(force_error, math.dist(force, right[0][1]))
        if true[3] == "free":
            was_lost = False
            continue
        contacts += 1
        is_lost = not is_carried and all(lost(touches, force, true_force) for _, true_force in right)
        passes += is_lost and not was_lost
        was_lost = is_lost
    return {"contender": head["contender"], "way": head["way"], "contact_ticks": contacts, "god_object_rms_m": rms(errors),
            "god_object_rms_judged_m": rms(judged), "god_object_max_m": max(errors), "force_max_n": force_error,
            "push_throughs": passes}


def lost(touches, force, true_force):
    """Nothing is felt of a surface that the truth is in contact with, or a force away from it."""
    size, true_size = math.hypot(*force), math.hypot(*true_force)
    return true_size > TOUCH_N and (not touches or dot(force, true_force) < BACKWARDS * size * true_size)


def main():
    if len(sys.argv) < 2 or sys.argv[1].startswith("-"):
        print(__doc__, file=sys.stderr if len(sys.argv) < 2 else sys.stdout)
        return 2 if len(sys.argv) < 2 else 0
    for path in sys.argv[1:]:
        try:
            found = judge(path)
        except (OSError, ValueError, KeyError, IndexError) as error:
            print(f"judge.py: {path}: {error}", file=sys.stderr)
            return 2
        print(f"{found['contender']} along {found['way']}: " +
              ", ".join(f"{k} {v:.9g}" for k, v in found.items() if k not in ("contender", "way")))
    return 0


if __name__ == "__main__":
    sys.exit(main())
