#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Results of several runs of tools/bench, of several machines or with several rivals, merged into one table of systems.

Usage: systems.py RESULTS.json... [--output FILE.csv]
Each results.json is one run. A row is one contender of one run on one body and way: time, time over that of fdcg_f64_stored in the
same run (which is what may be compared between machines), error, passes through the solid, size. Errors of one contender on one way
and revision must be alike in all runs: where they are not, the rows are printed and the exit code is 1. 2: wrong usage.
"""
import argparse
import csv
import json
import pathlib
import sys

COLUMNS = ["run", "processor", "revision", "seed", "body", "faces", "way", "rate_hz", "mu_static", "contender", "family", "mean_ns",
           "over_fdcg_f64", "p99_ns", "god_object_rms_m", "god_object_max_m", "push_throughs", "bytes_per_face", "bake_s"]
CASE = ("seed", "body", "way", "rate_hz", "mu_static", "ticks")  # what makes two errors comparable
OURS = "fdcg_f64_stored"
ALIKE = 1e-6, 1e-15  # as a part, and metres: compilers round differently


def rows_of(path):
    """Dicts of one run's contenders, with what the run says of itself."""
    results = json.loads(pathlib.Path(path).read_text(encoding="utf-8"))
    if results.get("tool") != "fdcg bench" or "contenders" not in results.get("tables", {}):
        raise ValueError("is no results.json of tools/bench with the part contenders")
    table = results["tables"]["contenders"]
    rows = [dict(zip(table["columns"], row)) for row in table["rows"]]
    facts = results["facts"]
    for row in rows:
        row.update(run=str(path), processor=facts["processor"], revision=facts["revision"])
        row.setdefault("seed", facts["seed"])
    base = {case_of(row): row["mean_ns"] for row in rows if row["contender"] == OURS}
    for row in rows:
        ours = base.get(case_of(row))
        row["over_fdcg_f64"] = row["mean_ns"] / ours if ours else ""
    return rows


def case_of(row):
    return tuple(str(row[key]) for key in CASE)


def differences(rows):
    """Pairs of rows of one case, contender and revision whose errors are not alike."""
    first, found = {}, []
    for row in rows:
        key = (case_of(row), row["contender"], row["revision"])
        other = first.setdefault(key, row)
        off = abs(row["god_object_rms_m"] - other["god_object_rms_m"])
        if off > max(ALIKE[0] * other["god_object_rms_m"], ALIKE[1]):
            found.append((other, row))
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", nargs="+", metavar="RESULTS.json")
    parser.add_argument("--output", default="-", help="default: standard output")
    options = parser.parse_args()
    rows = []
    for path in options.results:
        try:
            rows += rows_of(path)
        except (OSError, ValueError, KeyError) as error:
            print(f"systems.py: {path}: {error}", file=sys.stderr)
            return 2
    rows.sort(key=lambda r: (r["faces"], r["body"], r["way"], r["rate_hz"], r["mu_static"], r["contender"], r["run"]))
    with (sys.stdout if options.output == "-" else open(options.output, "w", newline="", encoding="utf-8")) as file:
        writer = csv.DictWriter(file, COLUMNS, extrasaction="ignore", lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    found = differences(rows)
    for a, b in found:
        print(f"{a['contender']} on {a['body']}, {a['way']}: {a['god_object_rms_m']:.9g} m in {a['run']}, "
              f"{b['god_object_rms_m']:.9g} m in {b['run']}", file=sys.stderr)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
