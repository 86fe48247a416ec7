#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The mutation score: plants each fault of faults.csv in the step in turn, and says which judge finds it out.

Usage: score.py --build BUILD_DIR --output DIR [--judges NAME,...] [--faults NAME,...] [--ticks N] [--jobs N]
Writes mutation_score.csv and mutation_score.md into DIR. Exit codes: 0 the bars hold; 1 stress misses more than two faults, or a fault
is missed by all judges; 2 wrong usage, or a judge that fails with no fault planted.

The judges are the programs as they are; the environment names the library that they judge, libfdcg_mutants, and the fault in it.
A judge that dies or hangs has found the fault too.
"""
import argparse
import concurrent.futures
import csv
import os
import pathlib
import re
import signal
import subprocess
import sys

FAULTS = pathlib.Path(__file__).resolve().parent / "faults.csv"
KNOWN = FAULTS.with_name("score.csv")  # what it has said of stress
MOST_MISSED_BY_STRESS = 2
MOST_CPU_S, TIMEOUT_S = 300, 1800  # of one run


def judges(folder, ticks):
    """Of each the runs that it has, in turn, until one finds a fault: the short one finds most."""
    stress = [folder / "fdcg_stress", "--first", "--threads", "1"]
    return {
        "stress": [[*stress, "--quick"], [*stress, "--steps", str(ticks)]],
        "accuracy": [[folder / "fdcg_bench_accuracy", "--quick"]],
        "laws": [[folder / "fdcg_bench_laws", "--quick"]],
        "closed_loop": [[folder / "fdcg_bench_closed_loop", "--quick"]],
    }


def found_by(commands, library, fault, output):
    """How the judge found the fault: the first bar that failed; None: it did not."""
    return next((how for command in commands if (how := found_in(command, library, fault, output))), None)


def found_in(command, library, fault, output):
    environment = {**os.environ, "FDCG_JUDGED_LIBRARY": str(library), "FDCG_MUTANT": fault}
    try:
        done = subprocess.run(["prlimit", f"--cpu={MOST_CPU_S}", *map(str, command), "--output", str(output)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              text=True, errors="replace", timeout=TIMEOUT_S, env=environment)
    except subprocess.TimeoutExpired:
        return "hangs"
    if done.returncode == 0:
        return None
    if done.returncode == -signal.SIGXCPU:
        return "hangs"
    found = re.search(r"^FOUND \S+?-f(?:64|32)-(\S+) at", done.stdout, re.M) or re.search(r"^FAIL ([^:\n]+)", done.stdout, re.M)
    return found.group(1) if found else f"exit code {done.returncode}"


def table_text(names, faults, how):
    lines = ["| fault | what | " + " | ".join(names) + " |", "| --- | --- |" + " --- |" * len(names)]
    for fault in faults:
        cells = [how[fault["name"], name] or "" for name in names]
        lines.append(f"| `{fault['name']}` | {fault['what']} | " + " | ".join(cells) + " |")
    score = [f"{sum(how[f['name'], name] is not None for f in faults)} of {len(faults)}" for name in names]
    return "\n".join([*lines, "| found | | " + " | ".join(score) + " |"]) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", required=True, type=pathlib.Path)
    parser.add_argument("--output", required=True, type=pathlib.Path)
    parser.add_argument("--judges", default="stress,accuracy,laws,closed_loop")
    parser.add_argument("--faults", default="")
    parser.add_argument("--ticks", default=3_000_000, type=float)
    parser.add_argument("--jobs", default=1, type=int)
    options = parser.parse_args()
    folder = options.build / "tests" / "evaluation"
    library = folder / "libfdcg_mutants.so"
    commands = judges(folder, options.ticks)
    names = options.judges.split(",")
    with open(FAULTS, newline="") as file:
        faults = [f for f in csv.DictReader(file) if not options.faults or f["name"] in options.faults.split(",")]
    with open(FAULTS, newline="") as file, open(KNOWN, newline="") as known:
        if {f["name"] for f in csv.DictReader(file)} != {f["fault"] for f in csv.DictReader(known)}:
            parser.error(f"{KNOWN} is of other faults than {FAULTS}: renew it")
    if unknown := [name for name in names if name not in commands]:
        parser.error(f"there is no judge {unknown[0]}; there are {', '.join(commands)}")
    if not faults:
        parser.error(f"there is no fault {options.faults}; {FAULTS} has them")
    options.output.mkdir(parents=True, exist_ok=True)
    runs = [(fault["name"], name) for fault in faults for name in names]

    def run(which):
        fault, name = which
        how = found_by(commands[name], library, fault, options.output / f"{fault or 'clean'}-{name}")
        print(f"{fault or 'nothing planted':32} {name:12} {how or '-'}", flush=True)
        return how

    with concurrent.futures.ThreadPoolExecutor(max_workers=options.jobs) as pool:
        clean = dict(zip(names, pool.map(run, [("", name) for name in names])))
        if spurious := [name for name in names if clean[name]]:
            print(f"with nothing planted, {', '.join(spurious)} finds a fault", file=sys.stderr)
            return 2
        how = dict(zip(runs, pool.map(run, runs)))
    with open(options.output / "mutation_score.csv", "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["fault", "kind", "what", *names])
        writer.writerows([f["name"], f["kind"], f["what"], *(how[f["name"], name] or "" for name in names)] for f in faults)
    (options.output / "mutation_score.md").write_text(table_text(names, faults, how))
    missed = [f["name"] for f in faults if not any(how[f["name"], name] for name in names)]
    by_stress = [f["name"] for f in faults if "stress" in names and not how[f["name"], "stress"]]
    print(f"{len(faults)} faults; missed by stress: {', '.join(by_stress) or 'none'}; by all: {', '.join(missed) or 'none'}")
    return 1 if missed or len(by_stress) > MOST_MISSED_BY_STRESS else 0


if __name__ == "__main__":
    sys.exit(main())
