#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Regression guard: is this tree slower or larger than an older revision?

Both are built alike by one CMake project (project/CMakeLists.txt), from this tree's measuring program and each one's libraries,
and run in turns: base, head, base, head. Of each figure the least of the rounds counts. A figure is flagged only where head is
beyond base by both a relative and an absolute limit, and again so in as many fresh rounds of those figures alone.

Exit code: 0 no regression; 1 a regression; 2 wrong usage, or a side that cannot be built or run (what is missing is said).
"""

import argparse
import csv
import os
import pathlib
import shutil
import subprocess
import sys

# Past both of these a figure is worse, by unit: share of the base, amount. Times of some microseconds' work vary by 2 to 5 % from
# run to run, whatever is done; 5 ns are two cache hits. A file's bytes are the same on every run, and so are the code's, but an
# inlining more or less is no regression.
LIMITS = {"ns": (0.10, 5.0), "s": (0.10, 0.002), "bytes": (0.001, 64.0), "bytes of code": (0.01, 256.0)}
RUN_SECONDS = 600


class GuardError(Exception):
    """Why there is nothing to compare."""


class Side:
    """Base or head: a program that prints `figure,unit,value` lines, and the runtime library whose code is weighed."""

    def __init__(self, name, program, library=None):
        self.name, self.program, self.library = name, program, library

    def figures(self, only=()):
        command = [str(self.program)]
        for figure in only:
            command += ["--figure", figure]
        try:
            done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, timeout=RUN_SECONDS)
        except (OSError, subprocess.TimeoutExpired) as error:
            raise GuardError(f"{self.name}: {error}") from error
        if done.returncode != 0:
            raise GuardError(f"{self.name}: {self.program} ended with {done.returncode}: {done.stderr.strip()[:500]}")
        found = {}
        for line in done.stdout.splitlines():
            figure, unit, value = line.rsplit(",", 2)
            found[figure] = (unit, float(value))
        if self.library and (not only or "code of the runtime" in only):
            found["code of the runtime"] = ("bytes of code", float(text_bytes(self.library)))
        return found


def text_bytes(library):
    """Code and constants of a static library, by binutils' size."""
    done = subprocess.run(["size", "-t", str(library)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        raise GuardError(f"{library}: size says {done.stderr.strip()}")
    return int(done.stdout.splitlines()[-1].split()[0])


# ---- measuring and judging ----------------------------------------------------------------------------------------------------


def least(into, found):
    for figure, (unit, value) in found.items():
        if figure not in into or value < into[figure][1]:
            into[figure] = (unit, value)


def measure(base, head, rounds, only=()):
    """The least of each figure over the rounds, base and head in turns."""
    of_base, of_head = {}, {}
    for _ in range(rounds):
        least(of_base, base.figures(only))
        least(of_head, head.figures(only))
    return of_base, of_head


def is_worse(unit, of_base, of_head):
    share, amount = LIMITS[unit]
    return of_head - of_base > share * of_base and of_head - of_base > amount


def worse_figures(of_base, of_head):
    return [f for f, (unit, value) in of_head.items() if f in of_base and is_worse(unit, of_base[f][1], value)]


def compare(base, head, rounds):
    """Rows of (figure, unit, base, head, verdict), and whether there is a regression."""
    of_base, of_head = measure(base, head, rounds)
    suspects = worse_figures(of_base, of_head)
    confirmed = []
    if suspects:
        print(f"measured again: {', '.join(suspects)}", flush=True)
        again_base, again_head = measure(base, head, rounds, suspects)
        confirmed = worse_figures(again_base, again_head)
        least(of_base, again_base)
        least(of_head, again_head)
    rows = []
    for figure in list(of_base) + [f for f in of_head if f not in of_base]:
        unit = (of_base.get(figure) or of_head.get(figure))[0]
        before, after = (side.get(figure, (unit, float("nan")))[1] for side in (of_base, of_head))
        if figure not in of_head:
            verdict = "LOST"
        elif figure not in of_base:
            verdict = "new"
        elif figure in confirmed:
            verdict = "REGRESSION"
        else:
            verdict = "better" if is_worse(unit, after, before) else "ok"
        rows.append((figure, unit, before, after, verdict))
    return rows, any(row[-1] in ("REGRESSION", "LOST") for row in rows)


def report(rows, folder):
    print(f"{'figure':<32} {'unit':<14} {'base':>12} {'head':>12} {'change':>8}  verdict")
    folder.mkdir(parents=True, exist_ok=True)
    with open(folder / "guard.csv", "w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(["figure", "unit", "base", "head", "change_percent", "limit_percent", "limit_absolute", "verdict"])
        for figure, unit, before, after, verdict in rows:
            change = 100 * (after / before - 1) if before > 0 else float("nan")
            share, amount = LIMITS[unit]
            table.writerow([figure, unit, f"{before:.9g}", f"{after:.9g}", f"{change:.3f}", f"{100 * share:g}", f"{amount:g}", verdict])
            print(f"{figure:<32} {unit:<14} {before:>12.6g} {after:>12.6g} {change:>7.1f}%  {verdict}")


# ---- building -----------------------------------------------------------------------------------------------------------------


def call(command, what):
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode != 0:
        lines = done.stdout.splitlines()
        telling = [line for line in lines if "error" in line.lower() or "missing" in line or "fatal" in line] or lines[-5:]
        raise GuardError(f"{what}:\n  " + "\n  ".join(telling[:8]))
    return done.stdout


def checked_out(root, revision, work):
    """A worktree of the revision under the work folder; made once for each commit."""
    commit = call(["git", "-C", str(root), "rev-parse", "--verify", f"{revision}^{{commit}}"], f"no revision {revision}").strip()
    source = work / commit[:12]
    if not (source / "CMakeLists.txt").exists():
        shutil.rmtree(source, ignore_errors=True)
        call(["git", "-C", str(root), "worktree", "prune"], "git worktree prune")
        call(["git", "-C", str(root), "worktree", "add", "--detach", "--force", str(source), commit], f"cannot check out {revision}")
    return source


def built(name, source, root, work, jobs):
    build = work / f"build-{name}"
    project = root / "tests/evaluation/guard/project"
    call(["cmake", "-S", str(project), "-B", str(build), "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", f"-DFDCG_SOURCE={source}",
          f"-DFDCG_GUARD_ROOT={root}"], f"{name}: cannot be configured")
    call(["cmake", "--build", str(build), "--target", "fdcg_guard", "--parallel", str(jobs)],
         f"{name}: this tree's measuring program cannot be built on its libraries; missing or changed")
    return Side(name, build / "fdcg_guard", build / "runtime.a")


def sides(args):
    if args.base_program:
        return Side("base", args.base_program, args.base_library), Side("head", args.head_program, args.head_library)
    root = args.root.resolve()
    work = root / "build/guard"
    work.mkdir(parents=True, exist_ok=True)
    source = checked_out(root, args.against, work)
    print(f"building base ({source.name}) and head", flush=True)
    return built(f"base-{source.name}", source, root, work, args.jobs), built("head", root, root, work, args.jobs)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter,
                                     epilog="Example: guard.py --against main~5")
    parser.add_argument("--against", "--base", metavar="REV", help="the base: a revision of this repository; the head is this tree as it stands")
    parser.add_argument("--base-program", type=pathlib.Path, help="in place of building: the base's measuring program")
    parser.add_argument("--head-program", type=pathlib.Path)
    parser.add_argument("--base-library", type=pathlib.Path, help="its runtime library, to be weighed")
    parser.add_argument("--head-library", type=pathlib.Path)
    parser.add_argument("--rounds", type=int, default=5, help="of base and head in turns (default 5)")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="of the build")
    parser.add_argument("--root", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parents[3], help="this tree")
    parser.add_argument("--output", type=pathlib.Path, default=pathlib.Path("build/evaluation/guard"), help="folder for guard.csv")
    args = parser.parse_args()
    if bool(args.against) == bool(args.base_program) or bool(args.base_program) != bool(args.head_program) or args.rounds < 1:
        parser.error("either --against REV, or --base-program and --head-program; --rounds at least 1")
    try:
        rows, is_regression = compare(*sides(args), args.rounds)
    except GuardError as error:
        print(error, file=sys.stderr)
        return 2
    report(rows, args.output)
    return 1 if is_regression else 0


if __name__ == "__main__":
    sys.exit(main())
