#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The mutation score: plants each fault of faults.csv in the step in turn, and says which judge finds it out, after how many ticks.

Usage: score.py --build BUILD_DIR --output DIR [--judges NAME,...] [--faults NAME,...] [--jobs N] [--ticks N | --publish]
       score.py --check    tells whether score.csv and the page are of the faults that there are, and hold the bars
Writes mutation_score.csv into DIR: of each judge how it found the fault (a kind of fault, a bar, a test; empty: it did not) and the steps
that it had called by then. The programs are copied there first, so that a build meanwhile changes nothing. Each run is kept in runs.csv
as it ends, and what the same programs have answered is not asked again: the same call takes up one that was stopped. --publish takes the
table into score.csv, where what was not asked stays, and writes the page's section (../README.md) anew. Exit codes: 0 the bars hold; 1
stress misses more than two faults, or a fault is missed by all; 2 wrong usage, a judge that fails with no fault planted, or one that was
stopped.

The judges are the programs as they are; the environment names the library that they judge, libfdcg_mutants, and the fault in it. The
tests of the step are linked with a step of the same faults. A judge that dies or hangs has found the fault too.
"""
import argparse
import concurrent.futures
import csv
import hashlib
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import threading

HERE = pathlib.Path(__file__).resolve().parent
FAULTS, SCORE, PAGE = HERE / "faults.csv", HERE / "score.csv", HERE.parent / "README.md"
SOURCES = HERE.parents[2] / "runtime" / "src"
MARKS = re.compile(r"(<!-- figures: mutation -->\n)(.*?)(<!-- end of figures -->)", re.S)
LIBRARY, REPRODUCERS = "libfdcg_mutants.so", HERE.parent / "stress" / "found"
MOST_MISSED_BY_STRESS = 2
STRESS_TICKS, REFERENCE_TICKS = 3_000_000, 500
MOST_CPU_S, TIMEOUT_S = 300, 14400  # of one run: the clock on the wall is for what sleeps, since a busy machine is no hang


def judges(folder, ticks=STRESS_TICKS):
    """Of each the runs that it has, in turn, until one finds a fault: the short one finds most. The dearest judge is the last."""
    stress = [folder / "fdcg_stress", "--first", "--threads", "1"]
    tests = folder / "fdcg_test_step_faults"
    return {
        "stress": [[*stress, "--quick"], [*stress, "--steps", str(ticks)]],
        "found": [[folder / "fdcg_test_evaluation_stress_found", "--abort"]],
        "accuracy": [[folder / "fdcg_bench_accuracy", "--quick", "--first", "--threads", "1"]],
        "laws": [[folder / "fdcg_bench_laws", "--quick", "--first"]],
        "closed_loop": [[folder / "fdcg_bench_closed_loop", "--quick"]],
        "tests": [[tests, "--abort", "--order", "decl"]],
    }


ABOUT = {
    "stress": f"`fdcg_stress`, quick, then {STRESS_TICKS:,} ticks",
    "found": "the tests of what `fdcg_stress` has found before",
    "accuracy": "`fdcg_bench_accuracy --quick`",
    "laws": "`fdcg_bench_laws --quick`",
    "closed_loop": "`fdcg_bench_closed_loop --quick`",
    "tests": f"the tests of the contact rules and of agreement with the brute-force reference, its walks cut to {REFERENCE_TICKS} steps",
}


class Stopped(Exception):
    """A judge ended by what is no fault of the step."""


def pinned(build, output):
    """A folder with copies of what is judged and of the judges."""
    folder, there = output / "programs", build / "tests" / "evaluation"
    folder.mkdir(parents=True, exist_ok=True)
    for name in (LIBRARY, *{command[0].name for commands in judges(there).values() for command in commands}):
        if (there / name).exists():
            shutil.copy2(there / name, folder / name)
    return folder


def key_of(name, commands):
    """Equal where a judge would answer the same: of its programs, arguments and bounds, of the library, and of what it reads."""
    key = hashlib.sha256(repr((name, [command[1:] for command in commands], MOST_CPU_S, REFERENCE_TICKS)).encode())
    read = sorted(REPRODUCERS.glob("*.obj")) if name == "found" else []
    for path in (*(command[0] for command in commands), commands[0][0].parent / LIBRARY, *read):
        key.update(path.read_bytes())
    return key.hexdigest()


class Runs:
    """What each judge has answered to each fault, in a file that a later call takes up. A fault's name is empty where none is planted."""

    COLUMNS = ["judge", "fault", "key", "how", "ticks"]

    def __init__(self, path, keys):
        self.keys, self.lock = keys, threading.Lock()
        text = path.read_text(encoding="utf-8") if path.exists() else ""
        whole = text[:text.rfind("\n") + 1].splitlines()  # the last line may have been cut
        rows = [r for r in csv.DictReader(whole) if r["key"] == keys.get(r["judge"], r["key"])]
        self.answers = {(r["judge"], r["fault"]): (r["how"] or None, int(r["ticks"])) for r in rows if r["judge"] in keys}
        rewritten = path.with_suffix(".new")
        with open(rewritten, "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, self.COLUMNS, lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)
        rewritten.replace(path)
        self.path = path

    def answer(self, name, fault, ask):
        if (name, fault) in self.answers:
            return self.answers[name, fault]
        how, ticks = ask()
        with self.lock, open(self.path, "a", newline="", encoding="utf-8") as file:
            csv.writer(file, lineterminator="\n").writerow([name, fault, self.keys[name], how or "", ticks])
        return how, ticks


def found_by(commands, library, fault, output):
    """How the judge found the fault, and after how many ticks; the first is None where it did not."""
    ticks = 0
    for command in commands:
        how, more = found_in(command, library, fault, output)
        ticks += more
        if how:
            return how, ticks
    return None, ticks


def found_in(command, library, fault, output):
    output.mkdir(parents=True, exist_ok=True)
    counted = output / "ticks"
    counted.unlink(missing_ok=True)
    environment = {**os.environ, "FDCG_JUDGED_LIBRARY": str(library), "FDCG_MUTANT": fault, "FDCG_MUTANT_TICKS": str(counted),
                   "FDCG_STEPS": str(REFERENCE_TICKS)}
    if "--abort" not in command:
        command = [*command, "--output", output]
    try:
        done = subprocess.run(["prlimit", f"--cpu={MOST_CPU_S}", *map(str, command)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              text=True, errors="replace", timeout=TIMEOUT_S, env=environment, cwd=output)
        status, said = done.returncode, done.stdout
    except subprocess.TimeoutExpired:
        status, said = -signal.SIGXCPU, ""
    ticks = int.from_bytes(counted.read_bytes(), sys.byteorder) if counted.exists() else 0
    return how_found(status, said), ticks


def how_found(status, said):
    """In the words of stress, of a bar or of a test; None: not found."""
    if status == 0:
        return None
    if status == -signal.SIGXCPU:
        return "hangs"
    if status in (-signal.SIGHUP, -signal.SIGINT, -signal.SIGTERM):
        raise Stopped(f"somebody has stopped a judge: signal {-status}")
    for pattern in (r"^FOUND \S+?-f(?:64|32)-(\S+) at", r"^FAIL ([^:\n]+)", r"^-{70,}\n(\S[^\n]*)\n(?:  [^\n]*\n)*-{70,}$"):
        if found := re.search(pattern, said, re.M):
            return found.group(1)
    return f"signal {-status}" if status < 0 else f"exit code {status}"


def faults_there():
    with open(FAULTS, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def asked(rows, name):
    """Rows of the faults that the judge was given."""
    return [r for r in rows if r.get(f"{name}_ticks")]


def missed(rows, name):
    return [r["fault"] for r in asked(rows, name) if not r[name]]


def judges_of(rows):
    """The judges that a table has."""
    return [name for name in judges(HERE) if name in rows[0]]


def bars(rows):
    """What of the bars does not hold."""
    wrong, names = [], judges_of(rows)
    if "stress" in names and len(missed(rows, "stress")) > MOST_MISSED_BY_STRESS:
        wrong.append(f"stress alone misses {', '.join(missed(rows, 'stress'))}")
    if by_all := [r["fault"] for r in rows if not any(r[name] for name in names)]:
        wrong.append(f"every judge misses {', '.join(by_all)}")
    return wrong


def section(rows):
    """The page's: what each judge finds and misses, by kind."""
    names = judges_of(rows)
    kinds = list(dict.fromkeys(r["kind"] for r in rows))
    lines = ["| judge | found | " + " | ".join(kinds) + " |", "| --- | --- |" + " --- |" * len(kinds)]

    def cell(name, of):
        given = asked(of, name)
        found = sum(bool(r[name]) for r in given)
        if not given:
            return ""
        return (f"all {found}" if found == len(given) else f"{found} of {len(given)}") + (" asked" if len(given) < len(of) else "")

    for name in names:
        lines.append(f"| `{name}`: {ABOUT[name]} | {cell(name, rows)} | " +
                     " | ".join(cell(name, [r for r in rows if r["kind"] == kind]) for kind in kinds) + " |")
    what = {f["name"]: f["what"] for f in faults_there()}
    said = [f"`{r['fault']}` ({what[r['fault']]}; found by {', '.join(f'`{n}`' for n in names if r[n]) or 'none'})" for r in rows if not r["stress"]]
    ticks = sorted(int(r["stress_ticks"]) for r in rows if r["stress"])
    lines += ["", f"`fdcg_stress` misses {'; '.join(said) or 'none'}. Those that it finds take it {ticks[len(ticks) // 2]:,} steps in the median, "
              f"{ticks[-1]:,} at most. Missed by all: " + (", ".join(f"`{r['fault']}`" for r in rows if not any(r[n] for n in names)) or "none") + "."]
    unasked = [f"`{name}` of {len(rows) - len(asked(rows, name))}" for name in judges(HERE) if name not in names or len(asked(rows, name)) < len(rows)]
    only = [f"`{r['fault']}` (`{by[0]}`)" for r in rows if len(by := [n for n in names if r[n]]) == 1]
    lines[-1] += f" Not asked yet: {', '.join(unasked)}." if unasked else f" Found by one judge alone: {', '.join(only) or 'none'}."
    return "\n".join(lines) + "\n"


def check():
    """Problems of what is published, in words."""
    faults = {f["name"]: f["kind"] for f in faults_there()}
    planted = {name for path in (*SOURCES.rglob("*.[ch]pp"), HERE / "outer_faults.cpp")
               for name in re.findall(r'FDCG_MUTANT\("([^"]+)"\)', path.read_text(encoding="utf-8"))}
    problems = [f"faults.csv has {name}, which no source plants" for name in sorted(set(faults) - planted)]
    rows = rows_of(SCORE)
    if [(r["fault"], r["kind"]) for r in rows] != list(faults.items()):
        problems.append("score.csv is not of the faults of faults.csv: renew it with --publish")
    names = judges_of(rows)
    if unlike := set(rows[0]) ^ {"fault", "kind", *names, *(f"{n}_ticks" for n in names)}:
        return [*problems, f"score.csv has {', '.join(sorted(unlike))}, which is no judge's: renew it with --publish"]
    if unasked := [r["fault"] for r in rows if not r["stress_ticks"]]:
        problems.append(f"stress was not given {', '.join(unasked)}")
    problems += bars(rows)
    if (found := MARKS.search(PAGE.read_text(encoding="utf-8"))) is None or found.group(2) != section(rows):
        problems.append(f"{PAGE}: the section is not that of score.csv; --publish writes it")
    return problems


def rows_of(path):
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def publish(table):
    """Takes what was asked; the rest stays as score.csv has it."""
    rows = [{"fault": f["name"], "kind": f["kind"]} for f in faults_there()]
    for path in (SCORE, table):
        said = {r["fault"]: r for r in rows_of(path)}
        for row in rows:
            row.update(said.get(row["fault"], {}))
    names = [name for name in judges(HERE) if asked(rows, name)]
    with open(SCORE, "w", newline="", encoding="utf-8") as file:
        columns = ["fault", "kind", *(c for n in names for c in (n, f"{n}_ticks"))]
        writer = csv.DictWriter(file, columns, restval="", lineterminator="\n", extrasaction="ignore")
        writer.writeheader()
        writer.writerows(rows)
    page = PAGE.read_text(encoding="utf-8")
    PAGE.write_text(MARKS.sub(lambda m: m.group(1) + section(rows_of(SCORE)) + m.group(3), page), encoding="utf-8")


def score(options, names, faults):
    output = options.output.resolve()
    folder = pinned(options.build.resolve(), output)
    commands = judges(folder, options.ticks)
    runs_kept = Runs(output / "runs.csv", {name: key_of(name, commands[name]) for name in names})

    def run(which):
        fault, name = which
        how, ticks = runs_kept.answer(
            name, fault, lambda: found_by(commands[name], folder / LIBRARY, fault, output / f"{fault or 'clean'}-{name}"))
        print(f"{fault or 'nothing planted':32} {name:12} {ticks:>10} {how or '-'}", flush=True)
        return how, ticks

    runs = [(fault["name"], name) for name in names for fault in faults]
    with concurrent.futures.ThreadPoolExecutor(max_workers=options.jobs) as pool:
        clean = dict(zip(names, pool.map(run, [("", name) for name in names])))
        if spurious := [name for name in names if clean[name][0]]:
            print(f"with nothing planted, {', '.join(spurious)} finds a fault", file=sys.stderr)
            return 2
        found = dict(zip(runs, pool.map(run, runs)))
    table = output / "mutation_score.csv"
    with open(table, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["fault", "kind", *(column for name in names for column in (name, f"{name}_ticks"))])
        for f in faults:
            writer.writerow([f["name"], f["kind"], *(cell for name in names for how, ticks in [found[f["name"], name]] for cell in (how or "", ticks))])
    wrong = bars(rows_of(table))
    if options.publish:
        publish(table)
    print("\n".join(wrong) or f"{len(faults)} faults: the bars hold")
    return 1 if wrong else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--build", type=pathlib.Path)
    parser.add_argument("--output", type=pathlib.Path)
    parser.add_argument("--judges", default="")
    parser.add_argument("--faults", default="")
    parser.add_argument("--jobs", default=1, type=int)
    parser.add_argument("--ticks", default=STRESS_TICKS, type=float)
    parser.add_argument("--publish", action="store_true")
    options = parser.parse_args()
    if options.check:
        problems = check()
        print("\n".join(problems), file=sys.stderr)
        return 1 if problems else 0
    if options.build is None or options.output is None:
        parser.error("--build and --output are needed")
    if options.publish and options.ticks != STRESS_TICKS:
        parser.error("what is published is of the default's ticks")
    commands = judges(options.build)
    names = options.judges.split(",") if options.judges else list(commands)
    faults = [f for f in faults_there() if not options.faults or f["name"] in options.faults.split(",")]
    if unknown := [name for name in names if name not in commands]:
        parser.error(f"there is no judge {unknown[0]}; there are {', '.join(commands)}")
    if not faults:
        parser.error(f"there is no fault {options.faults}; {FAULTS} has them")
    try:
        return score(options, names, faults)
    except Stopped as stopped:
        print(f"{stopped}; the same call goes on from here", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
