#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The frontier of run time against error, computed anew from the measured times and errors of pareto.csv.

Usage: frontier.py DIR|pareto.csv
Prints, for each body, which contenders no other beats, and where fdcg is beaten. Exit codes: 0 the file's own column says the same;
1 it does not; 2 wrong usage.
"""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from tables import read_table  # noqa: E402

FLOOR_M = 0.1 * 2**-53  # a unit in the last place of the bodies, which have 0.1 m: a smaller error is none


def error_m(row):
    return max(row["god_object_rms_m"], FLOOR_M)


def beats(other, row):
    """No less exact, and faster by more than what measuring the same thing twice differs by."""
    return error_m(other) <= error_m(row) and other["mean_ns"] * (1 + row["resolution"]) < row["mean_ns"]


def frontier(rows):
    """Of one body's rows those that no other beats."""
    return [row for row in rows if not any(beats(other, row) for other in rows)]


def losses(rows):
    """[(fdcg's row, the other, its share of fdcg's time)] of one body: for the fastest f64 and f32 those that beat it."""
    found = []
    for precision in ("f64", "f32"):
        own = [r for r in rows if r["family"] == "fdcg" and precision in r["contender"]]
        if own:
            fastest = min(own, key=lambda r: r["mean_ns"])
            others = [r for r in rows if r["family"] != "fdcg" and beats(r, fastest)]
            found += [(fastest, r, r["mean_ns"] / fastest["mean_ns"]) for r in sorted(others, key=lambda r: r["mean_ns"])]
    return found


def cold_losses(rows):
    """The same in a swept cache, where the interval of the ratio says so; tables without those columns have none."""
    found = []
    for precision in ("f64", "f32"):
        own = [r for r in rows if r["family"] == "fdcg" and precision in r["contender"] and r.get("cold_mean_ns")]
        if own:
            fastest = min(own, key=lambda r: r["cold_mean_ns"])
            for r in rows:
                if r["family"] == "fdcg" or not r.get("cold_over_ours") or error_m(r) > error_m(fastest):
                    continue
                share = r["cold_mean_ns"] / fastest["cold_mean_ns"]
                if share * r["cold_over_ours_high"] / r["cold_over_ours"] < 1:
                    found.append((fastest, r, share))
    return found


def main():
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        print(__doc__, file=sys.stderr if len(sys.argv) != 2 else sys.stdout)
        return 2 if len(sys.argv) != 2 else 0
    path = pathlib.Path(sys.argv[1])
    path = path / "pareto.csv" if path.is_dir() else path
    if not path.is_file():
        print(f"{path}: there is no such file; tools/bench --only contenders writes pareto.csv", file=sys.stderr)
        return 2
    table = read_table(path)
    differ = []
    for body in table.values("body"):
        rows = table.where(body=body).rows
        best = frontier(rows)
        named = [f"{r['contender']} ({r['mean_ns']:.0f} ns, {r['god_object_rms_m']:.2g} m)" for r in best]
        print(f"{body}: {', '.join(named)}")
        for own, other, share in losses(rows):
            print(f"  {own['contender']} is beaten by {other['contender']}: {share:.2f} of its time")
        differ += [f"{body}, {r['contender']}" for r in rows if (r in best) != (r["on_frontier"] == "yes")]
    if differ:
        print(f"{path} says otherwise of {'; '.join(differ)}", file=sys.stderr)
    return 1 if differ else 0


if __name__ == "__main__":
    sys.exit(main())
