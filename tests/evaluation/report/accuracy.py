# SPDX-License-Identifier: Apache-2.0
"""The god-object against exact and high-precision references."""
import page
from figure import COLOURS, finish, legend, subplots

IDENTITY = "accuracy"
TITLE = "God-object against exact references"
INTRODUCTION = """<p>Where the god-object is, in units in the last place (ulp) of the object's extent, f32 in its own, against three
references. <i>certificate</i>: without friction, exact rational arithmetic proves which point is the local minimum of the distance
over every face that contains it. <i>mpfr</i>: the same rules, tested by brute force over all faces with 256 bits. <i>long
double</i>: the same with 64 bits, for more ticks. One step at a time, each from the runtime's own contact; <i>accumulated</i>: the
reference goes its own way along the whole trajectory.</p>"""


def content(run):
    yield from histogram(run)
    yield from conditioning(run)
    yield from worst(run)


def histogram(run):
    table = run.table("god_object_error_histogram")
    if table is None:
        return
    precisions = table.values("precision")
    figure, axes = subplots(len(precisions))
    for ax, precision in zip(axes[0], precisions):
        for index, reference in enumerate(table.values("reference")):
            rows = table.where(precision=precision, reference=reference).sorted_by("from_ulps").rows
            total = sum(r["ticks"] for r in rows)
            if total == 0:
                continue
            above, share = total, []
            for r in rows:
                share.append((r["from_ulps"], above / total))
                above -= r["ticks"]
            ax.step([s[0] for s in share if s[1] > 0], [s[1] for s in share if s[1] > 0], where="post", color=COLOURS[index],
                    label=f"{reference}, {total:,} ticks")
        ax.axvline(8, color="#000", linewidth=.8, linestyle="--")
        ax.axvline(64, color="#000", linewidth=.8)
        ax.axhline(1e-3, color="#000", linewidth=.8, linestyle="--")
        ax.set(xscale="log", yscale="log", xlabel="error of the god-object, ulps of the extent", ylabel="share of ticks at or above",
               title=precision)
        legend(ax, 1)
    yield finish("god_object_error", figure,
                 "Share of ticks whose god-object is further from the exact one than so many units in the last place",
                 "Dashed: the bar for one tick in a thousand (8 ulps); solid: for every tick (64 ulps).")


def conditioning(run):
    table = run.table("god_object_conditioning")
    if table is None:
        return
    figure, axes = subplots(1, width=5.4, height=4)
    ax = axes[0][0]
    for index, precision in enumerate(table.values("precision")):
        rows = [r for r in table.where(precision=precision).rows if r["error_ulps"] > 0 and r["conditioning"] > 0]
        ax.scatter([r["conditioning"] for r in rows], [r["error_ulps"] for r in rows], s=7, alpha=.6, linewidths=0,
                   color=COLOURS[index], label=precision)
    found = run.table("god_object_search")
    for index, precision in enumerate(found.values("precision") if found is not None else []):
        rows = [r for r in found.where(precision=precision).rows if r["error_ulps"] > 0 and r["conditioning"] > 0]
        ax.scatter([r["conditioning"] for r in rows], [r["error_ulps"] for r in rows], s=30, marker="x", linewidths=1,
                   color=COLOURS[index + 2], label=f"{precision}, found by search")
    most = max(ax.get_xlim()[1], ax.get_ylim()[1])
    ax.plot([1, most], [1, most], ":", color="#666", label="error = conditioning")
    ax.axhline(64, color="#000", linewidth=.8)
    ax.set(xscale="log", yscale="log", xlabel="how far the exact answer itself moves for inputs half an ulp off, ulps",
           ylabel="error, ulps", title="The largest errors beside the problem's own conditioning")
    legend(ax)
    yield finish("god_object_conditioning", figure,
                 "Scatter of the god-object's error against the conditioning of the tick, for the ticks with the largest errors",
                 "Where a way grazes a face, or turns round a corner that it all but met, half an ulp in the input moves the exact "
                 "answer by much more: an error on that line is the input's rounding, not the step's.")


def worst(run):
    table = run.table("god_object_error")
    if table is None:
        return
    rows = sorted(table.rows, key=lambda r: -r["max_ulps"] if r["max_ulps"] == r["max_ulps"] else 0)
    columns = ["body", "precision", "planes", "merged", "way", "mu_s", "mu_d", "offset_sizes", "contact_steps", "p50_ulps", "p999_ulps",
               "max_ulps", "wrong_features", "ties", "reference"]
    yield f"<h3>The twenty runs with the largest errors, of {len(rows)}</h3>" + page.table(columns, rows[:20])
    offsets = [r for r in table.rows if r["offset_sizes"] > 0]
    if offsets:
        yield "<h3>Far from the origin</h3><p>The mesh moved by so many of its sizes.</p>" + page.table(columns, offsets)
