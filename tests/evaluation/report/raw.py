#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The frontier of run time against error, computed anew from every tick that was measured.

Usage: raw.py DIR
Reads DIR/raw/*.raw.gz (the format: contenders/raw_data.hpp), writes DIR/pareto_intervals.csv: for each body and contender time, time
after the caches were swept, and error, each with the interval that holds 95 % of what other ways of the same kind would have
given (bootstrap over whole ways, or over pieces of 250 ticks where there are fewer than 20 ways). Compares with DIR/pareto.csv. Exit codes: 0 both say the same; 1 they do not; 2 wrong
usage or a broken file.
"""
import csv
import gzip
import json
import pathlib
import sys

import numpy

MANY = 20         # ways: from here on whole ways are drawn, since pieces of one way are alike
PIECE = 250       # ticks: a hand's action has some
RESAMPLED = 2000  # times
OURS = "fdcg_f64_stored"
ALIKE = 1e-5      # of float32 sums
FINEST, COARSEST = .005, .03  # of what two times are told apart by
FLOOR_M = 0.1 * 2**-53        # a unit in the last place of the bodies
COLUMNS = ["body", "faces", "contender", "family", "seeds", "ticks", "rounds", "mean_ns", "mean_ns_low", "mean_ns_high", "over_ours",
           "over_ours_low", "over_ours_high", "p50_ns", "p99_ns", "p999_ns", "max_ns", "cold_ns", "cold_ns_low", "cold_ns_high",
           "cold_over_ours", "cold_over_ours_low", "cold_over_ours_high", "cold_p50_ns", "cold_p99_ns", "cold_max_ns", "cold_ticks",
           "god_object_rms_m", "god_object_rms_m_low", "god_object_rms_m_high", "resolution", "on_frontier", "cold_on_frontier"]


def read(path):
    """The head, and a list of (name, family, is control, warm_ns, error_m, cold_ns)."""
    with gzip.open(path) as file:
        head = json.loads(file.readline())
        if head.get("format") != "fdcg-raw 1":
            raise ValueError(f"{path}: is not fdcg-raw 1")
        numbers = numpy.frombuffer(file.read(), "<f4").astype(float)
    ticks, cold = head["ticks"], len(head["cold_ticks"])
    if len(numbers) != 2 * ticks + len(head["contenders"]) * (2 * ticks + cold):
        raise ValueError(f"{path}: is cut short")
    at, entries = 2 * ticks, []  # after contact and tied
    for c in head["contenders"]:
        warm, error, chilled = numpy.split(numbers[at:at + 2 * ticks + cold], [ticks, 2 * ticks])
        entries.append((c["name"], c["family"], c["control"], warm, error, chilled))
        at += 2 * ticks + cold
    return head, entries


def sums(ways, piece):
    """Of each piece the sum and the count; `ways`: a list of arrays."""
    parts = ways if len(ways) >= MANY else [p for way in ways for p in numpy.array_split(way, max(1, len(way) // piece))]
    return numpy.array([p.sum() for p in parts]), numpy.array([len(p) for p in parts], float)


class Pieces:
    """Of all contenders of a body the same pieces are drawn, so that ratios are of the same ticks."""

    def __init__(self, count, seed=1):
        self.draws = numpy.random.default_rng(seed).multinomial(count, numpy.full(count, 1 / count), RESAMPLED)

    def means(self, total, count):
        """The mean, and what each drawing gives."""
        return total.sum() / count.sum(), (self.draws @ total) / (self.draws @ count)


def interval(drawn):
    return tuple(numpy.percentile(drawn, [2.5, 97.5]))


def rows_of(files):
    """Rows of one body; `files`: what read() gives of its ways."""
    head, heads = files[0][0], [f[0] for f in files]
    entries = []
    for index, (name, family, is_control, *_) in enumerate(files[0][1]):
        if any(f[1][index][:3] != (name, family, is_control) for f in files):
            raise ValueError(f"{head['body']}: its ways have different contenders")
        entries.append((name, family, is_control, *([f[1][index][k] for f in files] for k in (3, 4, 5))))
    warm_pieces = Pieces(len(sums(entries[0][3], PIECE)[0]))
    has_cold = sum(map(len, entries[0][5])) > 0
    cold_pieces = Pieces(len(sums(entries[0][5], 5)[0])) if has_cold else None
    rows, drawn = [], {}
    for name, family, is_control, warm, error, cold in entries:
        if is_control:
            continue
        mean, means = warm_pieces.means(*sums(warm, PIECE))
        square, squares = warm_pieces.means(*sums([e**2 for e in error], PIECE))
        cold_mean, cold_means = cold_pieces.means(*sums(cold, 5)) if has_cold else (numpy.nan, numpy.full(1, numpy.nan))
        drawn[name] = means, cold_means
        ticks, chilled = numpy.concatenate(warm), numpy.concatenate(cold)
        row = {"body": head["body"], "faces": head["faces"], "contender": name, "family": family, "seeds": len(files),
               "ticks": len(ticks), "rounds": min(h["rounds"] for h in heads), "mean_ns": mean, "cold_ns": cold_mean,
               "god_object_rms_m": square**.5, "cold_ticks": len(chilled)}
        row["mean_ns_low"], row["mean_ns_high"] = interval(means)
        row["cold_ns_low"], row["cold_ns_high"] = interval(cold_means)
        row["god_object_rms_m_low"], row["god_object_rms_m_high"] = interval(numpy.sqrt(squares))
        for key, share in (("p50_ns", 50), ("p99_ns", 99), ("p999_ns", 99.9), ("max_ns", 100)):
            row[key] = numpy.percentile(ticks, share)
            if key != "p999_ns":
                row[f"cold_{key}"] = numpy.percentile(chilled, share) if has_cold else numpy.nan
        rows.append(row)
    if OURS in drawn:
        ours = next(r for r in rows if r["contender"] == OURS)
        for row in rows:
            for key, place, which in (("over_ours", "mean_ns", 0), ("cold_over_ours", "cold_ns", 1)):
                row[key] = row[place] / ours[place]
                row[f"{key}_low"], row[f"{key}_high"] = interval(drawn[row["contender"]][which] / drawn[OURS][which])
    mark_frontier(rows, entries)
    return rows


def resolution_of(entries, place):
    """What the same graph made twice differs by."""
    mean = {is_control: {name: numpy.concatenate(values[place]).mean() for name, _, control, *values in entries if control == is_control}
            for is_control in (False, True)}
    differences = [abs(mean[True][name] / mean[False][name] - 1) for name in mean[True] if name in mean[False]]
    return min(max([FINEST, *differences]), COARSEST)


def mark_frontier(rows, entries):
    for column, place, which in (("on_frontier", "mean_ns", 0), ("cold_on_frontier", "cold_ns", 2)):
        resolution = resolution_of(entries, which)
        if which == 0:
            for row in rows:
                row["resolution"] = resolution
        for row in rows:
            error = max(row["god_object_rms_m"], FLOOR_M)
            row[column] = "no" if any(max(o["god_object_rms_m"], FLOOR_M) <= error and o[place] * (1 + resolution) < row[place]
                                      for o in rows) else "yes"


def differences(rows, path):
    """What pareto.csv says otherwise."""
    with open(path, newline="", encoding="utf-8") as file:
        said = {(r["body"], r["contender"]): r for r in csv.DictReader(file)}
    for row in rows:
        other = said.pop((row["body"], row["contender"]), None)
        where = f"{row['body']}, {row['contender']}"
        if other is None:
            yield f"{where}: not there"
            continue
        for mine, theirs in (("mean_ns", "mean_ns"), ("cold_ns", "cold_mean_ns"), ("god_object_rms_m", "god_object_rms_m")):
            if abs(float(other[theirs]) - row[mine]) > ALIKE * abs(row[mine]):
                yield f"{where}: {theirs} {other[theirs]}, by its ticks {row[mine]:.9g}"
        if other["on_frontier"] != row["on_frontier"]:
            yield f"{where}: on_frontier {other['on_frontier']}, by its ticks {row['on_frontier']}"
    yield from (f"{body}, {contender}: no ticks" for body, contender in said)


def main():
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        print(__doc__, file=sys.stderr if len(sys.argv) != 2 else sys.stdout)
        return 2 if len(sys.argv) != 2 else 0
    folder = pathlib.Path(sys.argv[1])
    bodies = {}
    try:
        for path in sorted(folder.glob("raw/*.raw.gz")):
            head, entries = read(path)
            bodies.setdefault(head["body"], []).append((head, entries))
        if not bodies:
            raise ValueError(f"{folder}/raw: no ticks there; tools/bench --only contenders writes them")
        rows = [row for files in sorted(bodies.values(), key=lambda f: f[0][0]["faces"]) for row in rows_of(files)]
        with open(folder / "pareto_intervals.csv", "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, COLUMNS, restval="nan", lineterminator="\n")
            writer.writeheader()
            writer.writerows({k: f"{v:.6g}" if isinstance(v, float) else v for k, v in row.items()} for row in rows)
        found = list(differences(rows, folder / "pareto.csv"))
    except (OSError, EOFError, ValueError, KeyError) as error:
        print(f"raw.py: {error}", file=sys.stderr)
        return 2
    for body, files in bodies.items():
        best = [r["contender"] for r in rows if r["body"] == body and r["on_frontier"] == "yes"]
        print(f"{body}, {len(files)} ways: {', '.join(best)}")
    for line in found:
        print(f"pareto.csv says otherwise: {line}", file=sys.stderr)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
