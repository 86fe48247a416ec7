#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The figures of README and docs/benchmarks.md: small tables in testdata/evaluation, and the text and pictures made of them.

Usage: publish.py RUN_DIR    takes the tables of a full run of tools/bench (contenders, accuracy, hands; of the last alone where that is
                             all there is), then makes text and pictures anew
       publish.py --redraw   makes text and pictures anew of the tables that are there
       publish.py --check    tells where the text is not that of the tables; exit code 1 where it is not
Text stands between <!-- figures: NAME --> and <!-- end of figures -->. Exit code 2: wrong usage, or a table is missing.
"""
import csv
import json
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import frontier  # noqa: E402
from tables import Run, read_table  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[3]
KEPT = ROOT / "testdata" / "evaluation"
PICTURES = ROOT / "testdata" / "pictures"
OURS = "fdcg_f64_stored"
AWKWARD = "awkward"  # group of the bodies as others bring them
NEAREST = "paper_vertices"  # the contender that comes nearest
MOST_NAMED = 4  # ways
MOST_ULPS = 8
BESIDE = ["body", "faces", "way", "seed", "rate_hz", "mu_static", "contender", "ticks", "mean_ns", "contact_p50_ns", "contact_instructions",
          "free_p50_ns", "p99_ns", "god_object_rms_judged_m", "god_object_max_m", "wrong_feature_share", "push_throughs"]
SIZES = {"12 faces": (12, 12), "1 k": (900, 1100), "10 k": (9_000, 11_000), "100 k": (90_000, 110_000), "1 M": (900_000, 1_100_000)}
ROWS = {OURS: "fdcg, f64", "fdcg_f32_stored": "fdcg, f32", "paper": "the paper's algorithm as printed",
        "paper_vertices": "the same with its corrections, `paper_vertices`", "ray_proxy": "ray proxy", "embree_closest": "closest point, Embree",
        "cgal_closest": "closest point, CGAL", "fcl_closest": "closest point, FCL",
        "bullet_closest": "closest point, Bullet's tree", "neighbour_walk": "walk over neighbours", "finger_proxy": "finger-proxy", "openvdb_128": "distance grid on OpenVDB, 128 cells a side",
        "grid_64": "distance grid, 64 cells a side"}


FELT = ["scene", "mu_static", "contender", "hand_rms_n", "hand_max_n", "vibration_n", "direction_p99_deg", "felt_share", "felt_ms", "lost_share"]
HELD = ["scene", "contender", "stable_share_of_exact"]


def rounded(value):
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def take(folder):
    """What of a run's tables the figures need, so rounded that a reader gets the same text."""
    run = Run(folder)
    for name, columns in (("hands", FELT), ("hands_limits", HELD)):
        if name in run.tables:
            write(KEPT / f"{name}.csv", columns, [r for r in run.tables[name].rows if r["contender"] in ROWS])
    if set(run.tables) == {"hands", "hands_limits", "hands_traces"}:
        return
    needed = ("pareto", "pareto_intervals", "contenders", "god_object_error_histogram")
    missing = [name for name in needed if name not in run.tables]
    if missing:
        raise ValueError(f"{folder}: lacks {', '.join(f'{name}.csv' for name in missing)}; run contenders and accuracy in full")
    pareto, intervals, contenders, histogram = (run.tables[name] for name in needed)
    more = {(r["body"], r["contender"]): r for r in intervals.rows}
    columns = [c for c in pareto.columns if c != "beaten_by"] + [c for c in intervals.columns if c not in pareto.columns]
    KEPT.mkdir(exist_ok=True)
    rows = [{**more[r["body"], r["contender"]], **r} for r in pareto.rows]
    write(KEPT / "pareto.csv", columns, rows)
    write(KEPT / "pareto.csv", columns, judged_anew(kept()))
    write(KEPT / "nearest.csv", BESIDE, [r for r in contenders.rows if r["contender"] in (OURS, NEAREST)])
    write(KEPT / "god_object_error_histogram.csv", histogram.columns, histogram.rows)
    environment = json.loads((pathlib.Path(folder) / "environment.json").read_text(encoding="utf-8"))
    (KEPT / "environment.json").write_text(json.dumps(environment, indent=1) + "\n", encoding="utf-8")


def write(path, columns, rows):
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows([rounded(r[c]) for c in columns] for r in rows)


def kept():
    """Rows of the frontier; the rows of NEAREST beside ours are read where they are needed."""
    return read_table(KEPT / "pareto.csv").rows


def judged_anew(rows):
    """With the frontier of the rounded figures, which a hair may decide otherwise than the measured ones."""
    for body in {r["body"] for r in rows}:
        own = [r for r in rows if r["body"] == body]
        best = frontier.frontier(own)
        for row in own:
            row["on_frontier"] = "yes" if row in best else "no"
    return rows


def of_size(rows, contender, size):
    """Of the ladder of sizes."""
    low, high = SIZES[size]
    return [r for r in rows if r["contender"] == contender and r["group"] != AWKWARD and low <= r["faces"] <= high]


def mean(rows, key="mean_ns"):
    return sum(r[key] for r in rows) / len(rows)


def step_times(rows):
    """README's sentence."""
    ns = {size: mean(of_size(rows, OURS, size)) for size in SIZES}
    cold = [r["cold_mean_ns"] for r in rows if r["contender"] == OURS]
    known = json.loads((KEPT / "environment.json").read_text(encoding="utf-8"))
    return (f"{ns['12 faces']:.0f} ns on 12 faces, {ns['100 k']:.0f} ns on 100,000, {ns['1 M']:.0f} ns on a million "
            f"(mean, {known['cores']} cores, beside a load of {known['load_before']:.0f}); {min(cold):.0f} to {max(cold):.0f} ns where the first two levels of the cache were swept before the tick")


def times(rows):
    """The table of docs/benchmarks.md."""
    lines = ["", "| | " + " | ".join(SIZES) + " | error, RMS |", "| --- |" + " --- |" * (len(SIZES) + 1)]
    for contender, name in ROWS.items():
        mine = [r for size in SIZES for r in of_size(rows, contender, size)]
        cells = [f"{mean(found):.0f}" if (found := of_size(rows, contender, size)) else "" for size in SIZES]
        errors = [r["god_object_rms_m"] for r in mine]
        if mine:
            lines.append(f"| {name} | " + " | ".join(cells) + f" | {min(errors):.1g} to {max(errors):.1g} m |")
    cold = [f"{mean(of_size(rows, OURS, size), 'cold_mean_ns'):.0f}" for size in SIZES]
    lines.append(f"| fdcg, f64, in a swept cache | " + " | ".join(cold) + " | |")
    embree = [f"{mean(found, 'cold_mean_ns'):.0f}" if (found := of_size(rows, "embree_closest", size)) else "" for size in SIZES]
    lines.append("| Embree, in a swept cache | " + " | ".join(embree) + " | |")
    return "\n".join(lines) + "\n"


def brought(rows):
    """The table of bodies as others bring them; nothing where none was measured."""
    bodies = list(dict.fromkeys(r["body"] for r in rows if r["group"] == AWKWARD))
    if not bodies:
        return ""
    lines = ["", "| | " + " | ".join(f"`{body}`" for body in bodies) + " | error, RMS |", "| --- |" + " --- |" * (len(bodies) + 1)]
    for contender, name in ROWS.items():
        mine = {r["body"]: r for r in rows if r["contender"] == contender and r["group"] == AWKWARD}
        cells = [f"{mine[body]['mean_ns']:.0f}" if body in mine else "" for body in bodies]
        errors = [r["god_object_rms_m"] for r in mine.values()]
        if mine:
            lines.append(f"| {name} | " + " | ".join(cells) + f" | {min(errors):.1g} to {max(errors):.1g} m |")
    return "\n".join(lines) + "\n"


def losses(rows):
    """Where fdcg loses, to whom, warm and in a swept cache."""
    def said_of(losses_of):
        said = []
        for precision in ("f64", "f32"):
            found = {}
            for body in dict.fromkeys(r["body"] for r in rows):
                lost = [l for l in losses_of([r for r in rows if r["body"] == body]) if precision in l[0]["contender"]]
                if lost:
                    _, other, share = min(lost, key=lambda l: l[2])
                    found[body] = f"{body} to `{other['contender']}` ({share:.2f} of its time)"
            said.append(f"{precision} {'on ' + ', '.join(found.values()) if found else 'nowhere'}")
        return "; ".join(said)

    return (f"Where fdcg loses to a contender that is no less exact: {said_of(frontier.losses)}. In a swept cache: "
            f"{said_of(frontier.cold_losses)}.")


def nearest(_):
    """What the contender that comes nearest does less, and where it errs."""
    rows = read_table(KEPT / "nearest.csv").rows
    plain = [r for r in rows if r["way"] == "hand" and r["mu_static"] == 0 and r["rate_hz"] == 1000]
    said = []
    for name, contender in (("fdcg", OURS), (f"`{NEAREST}`", NEAREST)):
        mine = [r for r in plain if r["contender"] == contender]
        counted = [r for r in mine if r["contact_instructions"] > 0]  # 0: over a thousand
        said.append(f"{name} takes {span(counted, 'contact_instructions')} instructions and {span(mine, 'contact_p50_ns')} ns in a tick of "
                    f"contact, {span(mine, 'free_p50_ns')} ns in free motion (medians of each way), {span(mine, 'p99_ns')} ns in the 99th percentile")
    beside, worst = 0, []
    for theirs in (r for r in rows if r["contender"] == NEAREST):
        ours = next(r for r in rows if r["contender"] == OURS and all(r[k] == theirs[k] for k in BESIDE[:6]))
        beside += 1
        if theirs["god_object_rms_judged_m"] > max(1e-12, 10 * ours["god_object_rms_judged_m"]):
            where = f"{theirs['body']}, {theirs['way']}" + (", with friction" if theirs["mu_static"] else "")
            worst.append((theirs["god_object_rms_judged_m"], f"{where} ({theirs['god_object_rms_judged_m']:.1e} m RMS, {theirs['god_object_max_m']:.1e} m at most)"))
    errs = "; ".join(text for _, text in sorted(worst, reverse=True)[:MOST_NAMED])
    return "; ".join(said) + (f". On {len(worst)} of {beside} ways `{NEAREST}` errs by over 1e-12 m and ten times as much as fdcg" +
                              (f", most on {errs}" if worst else "") + ".")


def hands(_):
    """What the hand feels beside the truth: RMS of the difference, and in how many of the ticks it is felt."""
    rows = read_table(KEPT / "hands.csv").rows
    scenes = list(dict.fromkeys(r["scene"] for r in rows))
    lines = ["", "| | " + " | ".join(scenes) + " |", "| --- |" + " --- |" * len(scenes)]
    for contender, name in ROWS.items():
        mine = {r["scene"]: r for r in rows if r["contender"] == contender}
        cells = [of_hand(mine[scene]) if scene in mine else "" for scene in scenes]
        if mine:
            lines.append(f"| {name} | " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def of_hand(row):
    return f"{row['hand_rms_n']:.1g}" + (f" ({100 * row['felt_share']:.0f} %)" if row["felt_share"] else "")


def held(_):
    """Whose contact is stable up to the exact limit."""
    rows = read_table(KEPT / "hands_limits.csv").rows
    said = []
    for contender, name in ROWS.items():
        off = [f"{r['scene'].replace('_', ' ')} {r['stable_share_of_exact']:.2g}" for r in rows if r["contender"] == contender
               and abs(r["stable_share_of_exact"] - 1) > 0.01]
        if off:
            said.append(f"{name} ({', '.join(off)})")
    ours = [r["stable_share_of_exact"] for r in rows if r["contender"].startswith("fdcg")]
    return (f"fdcg's stiffest stable contact is {min(ours):.3f} to {max(ours):.3f} of that limit; other than 0.99 to 1.01 of it somewhere: " +
            ("; ".join(said) or "none") + ".")


def ulps(_):
    """How many god-objects are within 8 units in the last place, and all within how many."""
    rows, said = read_table(KEPT / "god_object_error_histogram.csv").rows, []
    for precision in ("f64", "f32"):
        own = [r for r in rows if r["precision"] == precision and r["ticks"]]
        ticks, beyond = sum(r["ticks"] for r in own), sum(r["ticks"] for r in own if r["from_ulps"] >= MOST_ULPS)
        said.append(f"{precision}: all but {beyond:,.0f} of {ticks:,.0f} ticks in contact, all within {2 * max(r['from_ulps'] for r in own):.0f}")
    return f"Within {MOST_ULPS} units in the last place (ulps) of the object's extent are in " + "; in ".join(said) + "."


def span(rows, key):
    low, high = min(r[key] for r in rows), max(r[key] for r in rows)
    return f"{low:.0f} to {high:.0f}" if f"{low:.0f}" != f"{high:.0f}" else f"{low:.0f}"


FIGURES = {"README.md": {"step times": step_times}, "docs/benchmarks.md": {"losses": losses, "nearest": nearest, "times": times, "brought": brought, "hands": hands, "held": held, "accuracy": ulps}}


def pattern(name):
    return re.compile(rf"(<!-- figures: {re.escape(name)} -->)(.*?)(<!-- end of figures -->)", re.S)


def texts(rows):
    """(path, name, what stands there, what the tables give)."""
    for path, figures in FIGURES.items():
        text = (ROOT / path).read_text(encoding="utf-8")
        for name, make in figures.items():
            found = pattern(name).search(text)
            if found is None:
                raise ValueError(f"{path}: has no place for the figures '{name}'")
            yield path, name, found.group(2), make(rows)


def redraw():
    import accuracy
    import contenders
    rows = kept()
    for path, name, _, made in list(texts(rows)):
        text = (ROOT / path).read_text(encoding="utf-8")
        (ROOT / path).write_text(pattern(name).sub(lambda m: m.group(1) + made + m.group(3), text), encoding="utf-8")
    run = Run(KEPT)
    for drawn in (next(contenders.overview(run)), next(accuracy.histogram(run))):
        (PICTURES / f"{drawn.name}.svg").write_text(drawn.svg + "\n", encoding="utf-8")


def check():
    wrong = [(path, name, stands, made) for path, name, stands, made in texts(kept()) if stands != made]
    for path, name, stands, made in wrong:
        print(f"{path}: figures '{name}' are not those of testdata/evaluation; publish.py --redraw\n  there: {stands}\n  table: {made}",
              file=sys.stderr)
    return 1 if wrong else 0


def main():
    if len(sys.argv) != 2 or sys.argv[1] in ("-h", "--help"):
        print(__doc__)
        return 2 if len(sys.argv) != 2 else 0
    try:
        if sys.argv[1] == "--check":
            return check()
        if sys.argv[1] != "--redraw":
            take(sys.argv[1])
        redraw()
        return 0
    except (OSError, ValueError, KeyError, ZeroDivisionError) as error:
        print(f"publish.py: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
