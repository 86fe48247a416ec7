#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Takes each rule of the contact model that implementers get wrong out of the runtime, and expects the test of that rule to fail.
A rule whose test passes without it is either not needed or not tested.

Usage: rules_matter.py PROGRAM
PROGRAM is the contact rules' tests on a runtime built with FDCG_WITH_MUTANTS (runtime/src/base/mutation.hpp): the environment
variable FDCG_MUTANT names the rule that is taken out.
"""
import concurrent.futures
import csv
import os
import pathlib
import re
import subprocess
import sys

SOURCES = pathlib.Path(__file__).resolve().parents[3] / "runtime" / "src"
# circle-at-corner: tests/evaluation/stress/planted_fault_test.py; slow: tests/evaluation/guard/guard_test.py.
OTHER_TESTS = {"circle-at-corner", "slow"}
FAULTS = pathlib.Path(__file__).resolve().parents[2] / "evaluation" / "mutation" / "faults.csv"  # those of the mutation score

# (tag of the test, name of the mutant, what is taken out)
MUTANTS = [
    ("met-again", "met-again", "a feature met again is a rest"),
    ("crossing", "crossing-sign", "crossed means on or beyond: the paper's change of sign instead"),
    ("crossing", "crossing-onto", "... or from not beyond to beyond instead"),
    ("ends-on-plane", "ends-on-plane", "a target on a side's plane up to rounding is on the side"),
    ("first-crossing", "last-crossing", "the first crossing, not the last"),
    ("along-side", "along-side", "a way along a side ends where it ends"),
    ("on-plane", "on-plane", "on a face's plane is outside"),
    ("seat", "seat", "the seat's rule decides, and where it is not asked the other wall holds"),
    ("last-tick-segment", "last-tick-segment", "the sweep starts where the HIP was"),
    ("exact-feature", "exact-feature", "an edge met exactly becomes active, not one of its faces"),
    ("watertight", "watertight", "exact orientations"),
    ("leave-out", "leave-out", "the faces at the feature just left are left out"),
    ("no-distance-tolerance", "distance-tolerance", "no distance tolerance where contact was lost"),
    ("slip-at-once", "slip-later", "dynamic friction holds in the tick in which slip begins"),
    ("stick-factor", "stick-factor", "sticking again only below the circle by a factor"),
    ("slip-flag", "slip-flag-feature", "the slip flag survives a change of feature"),
    ("slip-flag", "slip-flag-free", "a tick that ends free resets the slip flag"),
    ("rest-untouched", "rest-untouched", "at rest the god-object is not placed anew"),
    ("lands-on-vertex", "lands-on-vertex", "a god-object that lands on an edge's end is on the vertex"),
    ("steeper-face", "steeper-face", "behind both faces: the nearer plane"),
    ("open-corner", "open-corner", "an apex with a boundary edge is free"),
    ("free-at-vertex", "free-at-vertex", "a corner that the way to the HIP leaves outside lets go"),
    ("steepest-at-vertex", "steepest-at-vertex", "the longest way at a corner wins"),
]


def passes(program, tag, mutant=""):
    """Whether the tagged tests pass; a program that hangs or dies has failed too."""
    try:
        done = subprocess.run([program, f"[{tag}]"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=120,
                              env={**os.environ, "FDCG_MUTANT": mutant})
    except subprocess.TimeoutExpired:
        return False
    if "No test" in done.stdout:
        sys.exit(f"there is no test [{tag}]")
    return done.returncode == 0


def main():
    program = sys.argv[1]
    planted = {name for source in SOURCES.rglob("*.[ch]pp") for name in re.findall(r'FDCG_MUTANT\("([^"]+)"\)', source.read_text())}
    planted.discard("name")  # mutation.hpp's own example
    with open(FAULTS, newline="") as file:
        scored = {row["name"] for row in csv.DictReader(file)}
    listed = {mutant for _, mutant, _ in MUTANTS} | OTHER_TESTS | scored
    planted |= scored & set(re.findall(r'FDCG_MUTANT\("([^"]+)"\)', (FAULTS.parent / "outer_faults.cpp").read_text()))
    if planted != listed:
        sys.exit(f"in the sources but not here: {sorted(planted - listed)}; here but not in the sources: {sorted(listed - planted)}")
    with concurrent.futures.ThreadPoolExecutor(max_workers=2) as pool:
        tags = sorted({tag for tag, _, _ in MUTANTS})
        faults = [f"[{tag}] fails with every rule in place" for tag, good in zip(tags, pool.map(lambda t: passes(program, t), tags)) if not good]
        for (tag, _, rule), passed in zip(MUTANTS, pool.map(lambda m: passes(program, *m[:2]), MUTANTS)):
            if passed:
                faults.append(f"{tag}: the test passes without the rule: {rule}")
            else:
                print(f"without '{rule}' [{tag}] fails, as it must", flush=True)
    sys.exit("\n".join(faults) if faults else 0)


if __name__ == "__main__":
    main()
