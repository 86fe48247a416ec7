#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Reads the CSV tables of a run of tools/bench, writes results.json and report.html beside them (schemas/evaluation-results.schema.json)."""
import argparse
import json
import multiprocessing
import os
import pathlib
import platform
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import accuracy  # noqa: E402
import closed_loop  # noqa: E402
import contenders  # noqa: E402
import hands  # noqa: E402
import laws  # noqa: E402
import page  # noqa: E402
import scaling  # noqa: E402
import stress  # noqa: E402
import summary  # noqa: E402
from tables import Run, jsonable  # noqa: E402

PARTS = [contenders, accuracy, hands, laws, closed_loop, stress, scaling]  # in the report's order
FRONT = {"overview"}
MOST_BYTES = 8_000_000


def first_line(command, otherwise):
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=True, cwd=pathlib.Path(__file__).parent)
        return done.stdout.strip().splitlines()[0]
    except (OSError, subprocess.CalledProcessError, IndexError):
        return otherwise


def processor():
    try:
        for line in open("/proc/cpuinfo", encoding="utf-8"):
            if line.startswith("model name"):
                return line.split(":", 1)[1].strip()
    except OSError:
        pass
    return platform.machine()


def facts(options):
    return {"revision": first_line(["git", "describe", "--always", "--dirty", "--abbrev=12"], "not known"), "mode": options.mode,
            "seed": options.seed, "processor": processor(), "cores": len(os.sched_getaffinity(0)),
            "compiler": first_line(["c++", "--version"], "not known")}


def environment(folder):
    """What environment.py has recorded; empty where it was not run."""
    path = folder / "environment.json"
    return json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}


def results(run, known, measured_on):
    return {"tool": "fdcg bench", "facts": {**known, **({"environment": measured_on} if measured_on else {})}, "bars": [{k: jsonable(v) for k, v in b.items()} for b in run.bars],
            "tables": {name: {"columns": t.columns, "rows": [[jsonable(r[c]) for c in t.columns] for r in t.rows]}
                       for name, t in run.tables.items()}}


def content_of(index):
    return list(PARTS[index].content(content_of.run))


def contents(run):
    """What each part gives, drawn on all cores: a figure takes half a second."""
    content_of.run = run  # the processes have it from the start
    with multiprocessing.get_context("fork").Pool(min(len(PARTS), len(os.sched_getaffinity(0)))) as pool:
        return pool.map(content_of, range(len(PARTS)), chunksize=1)


def sections(run):
    """Each part's section, and the figures of FRONT, which stand on the first page. A part that was not run says so."""
    made, front = [], []
    for part, items in zip(PARTS, contents(run)):
        parts = []
        for item in items:
            if isinstance(item, str):
                parts.append(item)
                continue
            (front if item.name in FRONT else parts).append(page.figure(item))
        if not parts:
            parts = ["<p class=note>Not run.</p>"]
        made.append((part.IDENTITY, part.TITLE, part.INTRODUCTION, parts))
    return made, front


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", help="where the CSV tables are, and where the report goes")
    parser.add_argument("--mode", default="full", choices=["full", "quick"], help="said in the report")
    parser.add_argument("--seed", default="1", help="said in the report")
    options = parser.parse_args()
    run = Run(options.folder)
    if not run.tables and not run.bars:
        parser.error(f"{options.folder}: no CSV table there; run tools/bench, which writes them")
    known = facts(options)
    measured_on = environment(run.folder)
    made, front = sections(run)
    text = page.page(known, run.bars, [*(f"<p>{line}</p>" for line in summary.lines(run)), summary.glance(run), *front], made, measured_on)
    if len(text.encode()) > MOST_BYTES:
        sys.exit(f"report.py: the page would have {len(text.encode())} bytes, more than {MOST_BYTES}")
    (run.folder / "results.json").write_text(json.dumps(results(run, known, measured_on), indent=1, allow_nan=False) + "\n", encoding="utf-8")
    (run.folder / "report.html").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
