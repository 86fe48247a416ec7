#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Times of the step beside those of another build, in one run: tools/bench --against BUILD_DIR.

Each build compiles the meshes with its own program; a hand slides over them at 0.02 to 1 m/s. Both libraries are linked into one
program, each behind one name, and step the same ways in turns. Prints the median and the 99th percentile of ticks in contact, and
the ratios of this build (head) to the other (base). All of it is done over several copies of the files: where in memory the pages
of a file come to lie changes the 99th percentiles of large meshes by a tenth.

Exit code: 0 nothing is slower by more than the limits; 1 something is; 2 wrong usage, or a build that lacks what is needed.
"""

import argparse
import pathlib
import re
import shutil
import statistics
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
BODIES = ("12", "70k", "1M", "3M")
SPEEDS = ("0.02", "0.05", "0.1", "0.2", "0.5", "1")  # m/s, as fdcg_against_ways writes them
MOST_P50, MOST_P99 = 1.05, 1.15  # of ratios: beyond it is slower, and not the machine's unrest


class AgainstError(Exception):
    """Why there is nothing to compare."""


def run(command):
    done = subprocess.run([str(part) for part in command], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        raise AgainstError(f"{' '.join(map(str, command))}\nended with {done.returncode}: {done.stderr.strip()[-600:]}")
    return done.stdout


class Build:
    """A build folder: its sources, its runtime library and its compiler of meshes."""

    def __init__(self, name, folder):
        self.name, self.folder = name, pathlib.Path(folder).resolve()
        cache = self.folder / "CMakeCache.txt"
        if not cache.is_file():
            raise AgainstError(f"{self.folder}: no build folder of CMake (CMakeCache.txt is missing)")
        lines = cache.read_text(encoding="utf-8").splitlines()
        home = [line.split("=", 1)[1] for line in lines if line.startswith("CMAKE_HOME_DIRECTORY:")]
        self.headers = pathlib.Path(home[0]) / "runtime/include"
        self.library = self.folder / "runtime/libfdcg_runtime.a"
        self.program = next((p for p in (self.folder / "tools/fdcg", self.folder / "tools/fdcg/fdcg") if p.is_file()), None)
        for what, found in (("runtime library", self.library.is_file()), ("headers", self.headers.is_dir()), ("program fdcg", self.program)):
            if not found:
                raise AgainstError(f"{self.folder}: no {what}; build it: cmake --build {self.folder} --target fdcg_runtime fdcg")

    def side(self, work):
        """Its library and side.c as one object that shows one symbol."""
        symbol = f"{self.name}_side"
        part, whole = work / f"{symbol}.part.o", work / f"{symbol}.o"
        header = (self.headers / "fdcg/fdcg.h").read_text(encoding="utf-8")
        make_params = re.search(r"^(?:static inline|FDCG_INLINE) fdcg_params (\w+)\(void\)", header, re.M)
        if make_params is None:
            raise AgainstError(f"{self.headers}/fdcg/fdcg.h: no function makes default parameters")
        run(["cc", "-std=c11", "-O2", f"-DSIDE={symbol}", f"-DDEFAULT_PARAMS={make_params.group(1)}", "-I", self.headers, "-c", HERE / "side.c", "-o", part])
        run(["ld", "-r", "--force-group-allocation", "-o", whole, part, self.library])
        run(["objcopy", f"--keep-global-symbol={symbol}", whole])
        return whole

    def graph(self, mesh, work):
        path = work / f"{self.name}.fdcg"
        run([self.program, "compile", mesh, "--no-merge", "-o", path])
        return path


def ratio(head, base):
    return head / base if base > 0 else float("nan")


def copied(graphs, work, is_swapped):
    """New copies of both builds' graphs, made in either order; those before are gone."""
    copies = [work / f"{graph.stem}.copy.fdcg" for graph in graphs]
    for copy in copies:
        copy.unlink(missing_ok=True)
    for graph, copy in list(zip(graphs, copies))[:: -1 if is_swapped else 1]:
        shutil.copy(graph, copy)
    return copies


def measured(program, graphs, ways, work, args):
    """For each way its share of ticks in contact, and the medians of the copies' base p50, base p99, head p50, head p99."""
    found = {way: [] for way in ways}
    for turn in range(args.copies):
        for line in run([program, args.rounds, *copied(graphs, work, turn % 2 == 1), *ways]).splitlines():
            way, *figures = line.split(",")
            found[pathlib.Path(way)].append([float(figure) for figure in figures])
    return {way: [statistics.median(figures) for figures in zip(*lines)] for way, lines in found.items()}


def compare(base, head, args):
    """Prints the table; whether something is slower."""
    is_slower = False
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        program = work / "against"
        run(["c++", "-std=c++20", "-O2", "-I", HERE, "-I", HERE.parent.parent / "bench", HERE / "against.cpp", base.side(work),
             head.side(work), "-Wl,--allow-multiple-definition", "-lm", "-o", program])
        print(f"{'faces':>6} {'m/s':>5} {'contact':>7} | {'p50 base':>9} {'head':>8} {'ratio':>6} | {'p99 base':>9} {'head':>8} {'ratio':>6} | ns")
        for body in args.bodies.split(","):
            run([args.ways, body, args.ticks, work])
            graphs = [build.graph(work / "mesh.ply", work) for build in (base, head)]
            ways = [work / f"{speed}.way" for speed in SPEEDS]
            for way, figures in measured(program, graphs, ways, work, args).items():
                contact, base50, base99, head50, head99 = figures
                of_p50, of_p99 = ratio(head50, base50), ratio(head99, base99)
                slower = of_p50 > MOST_P50 or of_p99 > MOST_P99
                is_slower = is_slower or slower
                print(f"{body:>6} {way.stem:>5} {contact:>7.2f} | {base50:>9.1f} {head50:>8.1f} {of_p50:>6.2f} | "
                      f"{base99:>9.1f} {head99:>8.1f} {of_p99:>6.2f} |{' slower' if slower else ''}", flush=True)
    return is_slower


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--base", required=True, metavar="BUILD_DIR", help="the other build's folder")
    parser.add_argument("--head", required=True, metavar="BUILD_DIR", help="this build's folder")
    parser.add_argument("--ways", required=True, help="the program fdcg_against_ways")
    parser.add_argument("--bodies", default=",".join(BODIES), help="numbers of faces, of: " + " ".join(BODIES))
    parser.add_argument("--ticks", type=int, default=60000, help="of each way (default 60000)")
    parser.add_argument("--rounds", type=int, default=3, help="over each way; the median counts (default 3)")
    parser.add_argument("--copies", type=int, default=3, help="of the files; the median counts (default 3)")
    args = parser.parse_args()
    if min(args.ticks, args.rounds, args.copies) < 1 or not set(args.bodies.split(",")) <= set(BODIES):
        parser.error(f"--ticks, --rounds and --copies are at least 1, --bodies of {', '.join(BODIES)}")
    try:
        return 1 if compare(Build("base", args.base), Build("head", args.head), args) else 0
    except AgainstError as error:
        print(error, file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
