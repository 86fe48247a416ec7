#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Takes each rule of the contact model that implementers get wrong out of a copy of the runtime, and expects the test of that
rule to fail. A rule whose test passes without it is either not needed or not tested.

Usage: rules_matter.py --source DIR --work DIR --compiler CXX --link ARGUMENTS...
`--link` gets everything that makes the contact_rules program but the runtime's own objects.
"""
import argparse
import concurrent.futures
import pathlib
import shutil
import subprocess
import sys

FLAGS = ["-std=c++20", "-O1", "-w", "-ffp-contract=off", "-fno-math-errno", "-fno-exceptions", "-fno-rtti",
         "-DFDCG_RULE_WORK=1000000000", "-DFDCG_SWEEP_WORK=1000000000"]

# (tag of the test, what is taken out, then for each place: file, the text as it stands, what replaces it)
MUTANTS = [
    ("met-again", "a feature met again is a rest", "step/servo_step.cpp",
     "if (trail.has_met_again(walk) && !trail.retry_without_residual(walk)) return progress;", ""),
    ("crossing", "crossed means on or beyond, and further out than before: the paper's change of sign instead", "step/face.hpp",
     "if (!(s1 > s0)) continue;", "if (!(s1 * s0 < 0)) continue;"),
    ("crossing", "... or from not beyond to beyond instead", "step/face.hpp",
     "if (!(s1 > s0)) continue;", "if (!(s0 <= 0 && s1 > 0)) continue;"),
    ("first-crossing", "the first crossing, not the last", "step/face.hpp",
     "|| fraction < first.fraction)", "|| fraction > first.fraction)"),
    ("along-side", "a way along a side ends where it ends", "step/face.hpp", "s1 <= rounding ? Real(1)", "false ? Real(1)"),
    ("lost", "what rounding takes at an edge is not lost", "step/face.hpp", "walk.rounding_residual = (from - walk.god_object) + ahead", "(void)0"),
    ("on-plane", "on a face's plane is outside", "step/face.hpp", "if (!(side < 0)) return", "if (side > 0) return"),
    ("seat", "the seat's rule decides, and where it is not asked the other wall holds", "step/face.hpp",
     "return go_to(leave_face(walk, node));", "return go_to(kFree);",
     "step/sweep.hpp", "if (start_side >= -from_bound_) try_other_wall(n, node);", ""),
    ("last-tick-segment", "the sweep starts where the HIP was", "step/servo_step.cpp",
     "progress.flags = sweep_to_hip(walk, kFree, walk.god_object, space);",
     "walk.god_object = walk.hip; progress.flags = sweep_to_hip(walk, kFree, walk.god_object, space);"),
    ("exact-feature", "an edge met exactly becomes active, not one of its faces", "step/sweep.hpp",
     "best_.feature = met_exactly ? on_rim(", "best_.feature = false ? on_rim("),
    ("watertight", "exact orientations", "exact/exact_orient.cpp",
     "return exact_sign({a, b, c, d}, bound, work_left);", "return det > 0 ? 1 : (det < 0 ? -1 : 0);"),
    ("leave-out", "the faces at the feature just left are left out", "step/sweep.hpp",
     "> to_bound_ || is_left_out(n, node)) return;", "> to_bound_) return;"),
    ("no-distance-tolerance", "no distance tolerance where contact was lost", "step/sweep.hpp",
     "if (!is_before_best(fraction, n)) return;",
     "if (!is_before_best(fraction, n) || (left_.state != FDCG_FREE && fraction < Real(1e-4))) return;"),
    ("slip-at-once", "dynamic friction holds in the tick in which slip begins", "step/friction.hpp",
     "is_slipping = true;", "is_slipping = true; return {false, mu_static * load};"),
    ("stick-factor", "sticking again only below the circle by a factor", "step/friction.hpp",
     "if (gap2 <= square(kStickAgain * gap))",
     "if (gap2 <= square(gap + RealLimits<Real>::kEpsilon * (norm1(god_object) / 2 + 4 * gap)))"),
    ("slip-flag", "the slip flag survives a change of feature", "step/walk.hpp",
     "const Feature edge = {FDCG_EDGE, connection_index};",
     "walk.friction.is_slipping = false; const Feature edge = {FDCG_EDGE, connection_index};"),
    ("slip-flag", "a tick that ends free resets the slip flag", "step/servo_step.cpp",
     "(!is_free || is_undecided) && walk.friction.is_slipping", "walk.friction.is_slipping"),
    ("rest-untouched", "at rest the god-object is not placed anew", "step/friction.hpp",
     "return {!is_slipping || gap2 <= square(gap + rounding), gap};", "return {false, is_slipping ? gap : root(gap2)};"),
    ("lands-on-vertex", "a god-object that lands on an edge's end is on the vertex", "step/walk.hpp",
     "if (!(from_end <= line.end_tolerance)) continue;", "if (!(from_end < 0)) continue;"),
    ("steeper-face", "behind both faces: the nearer plane", "step/edge.hpp",
     "s.voronoi[1] < s.voronoi[0]", "false"),
    ("open-corner", "an apex with a boundary edge is free", "step/corner.hpp",
     "if (corner.is_open()) return kFree;", ""),
    ("steepest-at-vertex", "the longest way at a corner wins", "step/corner.hpp",
     "if (are_near ? other.distance2 < distance2 : other.reach2 > reach2)", "if (feature == kFree)"),
]


def build(args, name, directory):
    objects = []
    for source in sorted(directory.rglob("*.cpp")):
        if source.name.startswith("deform"):  # the step once more, for meshes that these tests do not have
            continue
        target = directory / (source.name + ".o")
        command = [args.compiler, *FLAGS, "-I", args.source + "/runtime/include", "-I", args.source + "/runtime", "-I", str(directory), "-c", str(source), "-o", str(target)]
        subprocess.run(command, check=True)
        objects.append(str(target))
    program = directory / "contact_rules"
    subprocess.run([args.compiler, *objects, *args.link, "-o", str(program)], check=True)
    return program


def run(program, tag):
    """Whether the tagged tests pass; a program that hangs or dies has failed too."""
    try:
        done = subprocess.run([str(program), f"[{tag}]"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=120)
    except subprocess.TimeoutExpired:
        return False
    return done.returncode == 0


def try_mutant(args, index, mutant):
    tag, rule, *places = mutant
    directory = pathlib.Path(args.work) / f"{index:02d}-{tag}"
    shutil.copytree(args.source + "/runtime/src", directory)
    for file, before, after in zip(*[iter(places)] * 3, strict=True):
        path = directory / file
        text = path.read_text()
        if text.count(before) != 1:
            return f"{tag}: the text of this rule stands {text.count(before)} times in {file}, expected once: {before}"
        path.write_text(text.replace(before, after))
    if run(build(args, tag, directory), tag):
        return f"{tag}: the test passes without the rule: {rule}"
    print(f"without '{rule}' [{tag}] fails, as it must", flush=True)
    return None


def main():
    parser = argparse.ArgumentParser()
    for name in ("source", "work", "compiler"):
        parser.add_argument("--" + name, required=True)
    parser.add_argument("--link", nargs=argparse.REMAINDER, required=True)
    args = parser.parse_args()
    shutil.rmtree(args.work, ignore_errors=True)
    pathlib.Path(args.work).mkdir(parents=True)
    whole = pathlib.Path(args.work) / "whole"
    shutil.copytree(args.source + "/runtime/src", whole)
    program = build(args, "whole", whole)
    for tag in sorted({mutant[0] for mutant in MUTANTS}):
        if not run(program, tag):
            sys.exit(f"[{tag}] fails with every rule in place")
    with concurrent.futures.ThreadPoolExecutor(max_workers=2) as pool:
        faults = [f for f in pool.map(lambda m: try_mutant(args, *m), enumerate(MUTANTS)) if f]
    print(f"{len(MUTANTS) - len(faults)} of {len(MUTANTS)} rules matter")
    sys.exit("\n".join(faults) if faults else 0)


if __name__ == "__main__":
    main()
