# SPDX-License-Identifier: Apache-2.0
"""Run time against error: the contenders on the same bodies and ways."""
import frontier
import page
from figure import COLOURS, finish, legend, style, subplots

IDENTITY = "contenders"
TITLE = "Run time against error"
INTRODUCTION = """<p>The same ways of the same hand over the same bodies, one thread. Time: the mean of a step over the ways of several
seeds, of each tick the median of equally many rounds, less what an empty step takes. Cold: before a tick of contact four times the second
level of the cache was read. Intervals hold 95 % of what other pieces of the same ways would give. Error: the god-object's distance from the true one, RMS over the way's ticks. Truth is the
model's: it remembers on which side the hand came in, which a closest point does not.</p>"""

FAMILIES = {"fdcg": ("fdcg", "o"), "paper": ("the paper's algorithm", "s"), "ablation": ("corrections added to it one by one", "P"),
            "closest_point": ("closest point by a tree", "^"), "proxy": ("ray proxy", "D"), "distance_grid": ("distance grid", "v")}
BODIES = {"sphere": "-", "star": "--"}  # each a line of its own: at one size they differ
LEAST_M = frontier.FLOOR_M  # where smaller errors are drawn


def content(run):
    yield from overview(run)
    yield from pareto(run)
    yield from cold(run)
    yield from nearest(run)
    yield from verdicts(run)
    yield from faults(run)
    yield from details(run)


def colour(row):
    return COLOURS[list(FAMILIES).index(row["family"])] if row["family"] in FAMILIES else COLOURS[-1]


CHOSEN = ["fdcg_f64_stored", "fdcg_f32_stored", "paper", "paper_vertices", "ray_proxy", "embree_closest", "cgal_closest", "grid_64"]


def overview(run):
    """One body's frontier, the largest that all contenders have, and time over the number of faces."""
    frontier = run.table("pareto")
    if frontier is None:
        return
    body = max(frontier.rows, key=lambda r: (r["faces"], r["group"] == "star"))["body"]
    figure, axes = subplots(2, width=5, height=4)
    ax = axes[0][0]
    rows = {r["contender"]: r for r in frontier.where(body=body).rows}
    for index, contender in enumerate(c for c in CHOSEN if c in rows):
        r = rows[contender]
        ax.scatter(max(r["god_object_rms_m"], LEAST_M), r["mean_ns"], s=60, zorder=3, label=contender, **style(index))
    ax.set(xscale="log", yscale="log", xlabel="god-object error, RMS, m", ylabel="ns a step, mean",
           title=f"{body}: {frontier.where(body=body).rows[0]['faces']:,} faces, 0.1 m")
    ax = axes[0][1]
    for index, contender in enumerate(CHOSEN):
        for group, line in BODIES.items():
            rows = frontier.where(contender=contender, group=group).sorted_by("faces").rows
            if rows:
                ax.plot([r["faces"] for r in rows], [r["mean_ns"] for r in rows], line, label=f"{contender}, {group}", **style(index))
    ax.set(xscale="log", yscale="log", xlabel="faces", ylabel="ns a step, mean, without friction",
           title="A hand's step over mesh size")
    for ax in axes[0]:
        legend(ax, 3)
    yield finish("overview", figure,
                 "Left: time of a step against the god-object's error on the largest body; right: time over the number of faces. "
                 "only the distance grid and the paper's algorithm with its corrections are as fast as fdcg",
                 "A hand presses, slides and lifts at 1 kHz without friction. Right: solid, smooth spheres; dashed, rough stars.")


def pareto(run):
    table = run.table("pareto")
    if table is None:
        return
    bodies = table.values("body")
    columns = min(3, len(bodies))
    figure, axes = subplots(columns, -(-len(bodies) // columns), width=4.8, height=3.6)
    flat = [ax for row in axes for ax in row]
    for ax in flat[len(bodies):]:
        ax.set_axis_off()
    for ax, body in zip(flat, bodies):
        rows = table.where(body=body).rows
        for r in rows:
            name, marker = FAMILIES.get(r["family"], (r["family"], "*"))
            is_f32 = "_f32" in r["contender"]
            ax.scatter(max(r["god_object_rms_m"], LEAST_M), r["mean_ns"], marker=marker, s=42, color=colour(r),
                       facecolors="none" if is_f32 else colour(r), label=name, zorder=3)
        best = sorted((frontier.error_m(r), r["mean_ns"]) for r in frontier.frontier(rows))
        ax.plot([b[0] for b in best], [b[1] for b in best], color="#000", linewidth=.7, drawstyle="steps-post", zorder=1)
        guests = [r["contender"] for r in rows if r["family"] not in FAMILIES]
        for prefix in ("fdcg_f64", "fdcg_f32", "paper", "paper_vertices", "cgal_closest", "embree_closest", "fcl_closest", "ray_proxy",
                       "grid_64", *guests):
            named = [r for r in rows if r["contender"] == prefix or (prefix.startswith("fdcg") and r["contender"].startswith(prefix))]
            if named:
                fastest = min(named, key=lambda r: r["mean_ns"])
                ax.annotate(prefix.replace("fdcg_", "fdcg "), (max(fastest["god_object_rms_m"], LEAST_M), fastest["mean_ns"]),
                            textcoords="offset points", xytext=(5, -11), fontsize=7)
        ax.set(xscale="log", yscale="log", xlabel="god-object error, RMS, m", ylabel="ns a step",
               title=f"{body}, {rows[0]['faces']:,} faces")
    yield finish("pareto", figure,
                 "Time of a step against the god-object's error for every contender, one plot a mesh size; fdcg stands at the "
                 "smallest error",
                 "Lower left is better; the line joins those that nobody beats in both. Hollow: 32-bit numbers. Errors below a unit "
                 f"in the last place of the bodies, which have 0.1 m, are drawn at it, {LEAST_M:.2g} m. " +
                 ", ".join(f"<span style='color:{COLOURS[i]}'>&#9632;</span> {name}" for i, (name, _) in enumerate(FAMILIES.values())))


def cold(run):
    """Time over fdcg's of the same ticks, warm and cold, with intervals."""
    table = run.table("pareto_intervals")
    if table is None:
        return
    bodies = table.sorted_by("faces").values("body")
    columns = min(3, len(bodies))
    figure, axes = subplots(columns, -(-len(bodies) // columns), width=4.8, height=2.9)
    flat = [ax for row in axes for ax in row]
    for ax in flat[len(bodies):]:
        ax.set_axis_off()
    for ax, body in zip(flat, bodies):
        rows = {r["contender"]: r for r in table.where(body=body).rows}
        names = [name for name in [*CHOSEN, "fcl_closest"] if name in rows and isinstance(rows[name]["over_ours"], (int, float))]
        for y, name in enumerate(names):
            for key, shift, face in (("over_ours", -.15, colour(rows[name])), ("cold_over_ours", .15, "none")):
                r = rows[name]
                ax.errorbar(r[key], y + shift, xerr=[[max(0, r[key] - r[key + "_low"])], [max(0, r[key + "_high"] - r[key])]], fmt="o", markersize=4,
                            color=colour(r), markerfacecolor=face, linewidth=1)
        ax.axvline(1, color="#000", linewidth=.7)
        ax.set_yticks(range(len(names)), names, fontsize=7)
        ax.invert_yaxis()
        ax.set(xscale="log", xlabel="time over fdcg_f64_stored's", title=f"{body}, {rows[names[0]]['faces']:,} faces" if names else body)
    yield finish("cold", figure, "Time of each contender over that of fdcg in double, warm and in a swept cache, with intervals, one plot a body",
                 "Filled: warm. Hollow: the first and second level of the cache were swept before the tick. Lines: intervals of 95 %.")


NEAREST = "paper_vertices"  # the contender that comes nearest
CASE = ("body", "way", "rate_hz", "mu_static")


def first_ways(table):
    """Of the ways of several seeds the first: contenders.csv has them all."""
    first = {}
    for row in table.rows:
        first.setdefault(tuple(row[k] for k in CASE), row["seed"])
    return [row for row in table.rows if row["seed"] == first[tuple(row[k] for k in CASE)]]


def nearest(run):
    """fdcg in double beside it, way by way: who takes less, where, and who errs."""
    table = run.table("contenders")
    if table is None or not table.where(contender=NEAREST).rows:
        return
    rows = []
    rows_of = first_ways(table)
    ours_of = {tuple(r[k] for k in CASE): r for r in rows_of if r["contender"] == "fdcg_f64_stored"}
    for theirs in (r for r in rows_of if r["contender"] == NEAREST):
        case = {k: theirs[k] for k in (*CASE, "seed")}
        ours = ours_of.get(tuple(theirs[k] for k in CASE))
        if ours is not None:
            both = {k: f"{page.number(ours[c])} / {page.number(theirs[c])}" for k, c in NEAREST_COLUMNS.items()}
            rows.append({**case, "share": round(theirs["mean_ns"] / ours["mean_ns"], 3), **both})
    yield (f"<h3>fdcg beside {NEAREST}</h3><p>The paper's algorithm with the corrections in it, over the graph's planes, and Embree's ray in float for "
           "free motion. In a tick of contact it does less: it checks neither parameters nor contact, writes no public result, and has neither a seat nor "
           "damping. In free motion it takes more far from the body, where fdcg knows a clear ball, "
           "and less near it, where fdcg sweeps the graph exactly. Each cell: fdcg_f64_stored / " + NEAREST + ", on the first way of each kind.</p>" +
           page.table([*CASE, "seed", "share", *NEAREST_COLUMNS], rows, {"share": "its time over ours"}))


NEAREST_COLUMNS = {"mean, ns": "mean_ns", "contact, ns": "contact_p50_ns", "contact, instructions": "contact_instructions",
                   "free, ns": "free_p50_ns", "p99, ns": "p99_ns", "error, m RMS": "god_object_rms_judged_m", "largest error, m": "god_object_max_m",
                   "wrong feature, share": "wrong_feature_share"}


def verdicts(run):
    table = run.table("pareto_verdict")
    if table is not None:
        yield "<h3>Where others are better</h3>" + page.table(
            ["body", "faces", "f64_on_frontier", "f32_on_frontier", "f32_over_f64_time", "where_others_are_better"], table.rows,
            {"f64_on_frontier": "f64 variants on the frontier", "f32_on_frontier": "f32 variants on the frontier",
             "f32_over_f64_time": "time, f32 over f64", "where_others_are_better": "who is faster, smaller or baked earlier"})


def faults(run):
    """What a hand would feel: shares of ticks on a wrong feature, passes through the solid, jumps."""
    table = run.table("contenders")
    if table is None:
        return
    chosen = ["fdcg_f64_stored", "fdcg_f32_stored", "paper", "paper_vertices", "cgal_closest", "ray_proxy", "grid_64", "grid_256"]
    of_case = {}
    for row in table.rows:
        of_case.setdefault((row["body"], row["way"], row["mu_static"]), {}).setdefault(row["contender"], []).append(row)
    figure, axes = subplots(3, width=4.8, height=.28 * len(chosen) * max(1, len(of_case) / 3.2))
    measures = [("wrong_feature_share", "Ticks on a wrong feature, share"), ("noticeable_share", "Ticks with a noticeable force error, share"),
                ("push_throughs", "Passes through the solid")]
    for ax, (column, title) in zip(axes[0], measures):
        y = 0
        ticks, names = [], []
        for (body, way, mu), found in of_case.items():
            for contender in chosen:
                rows = found.get(contender, [])
                if rows:
                    ax.barh(y, max(r[column] for r in rows), color=colour(rows[0]), height=.8)
                    ticks.append(y)
                    names.append(f"{contender}")
                    y += 1
            ax.text(1, y - .3, f"{body}, {way}" + (", friction" if mu > 0 else ""), transform=ax.get_yaxis_transform(), fontsize=7,
                    ha="right", va="center", fontweight="bold")
            y += 1.2
        ax.set_yticks(ticks, names if ax is axes[0][0] else [], fontsize=6)
        ax.set(title=title, xlim=(0, None))
        ax.invert_yaxis()
    yield finish("faults", figure, "Bars for each contender and way: ticks on a wrong feature, noticeable force errors, passes through "
                 "the solid",
                 "Noticeable: the force is off by more than 7 % of itself, the just-noticeable difference.")


def details(run):
    table = run.table("contenders")
    if table is None:
        return
    columns = ["body", "way", "seed", "rate_hz", "mu_static", "contender", "mean_ns", "least_mean_ns", "batch_ns", "p50_ns", "p99_ns", "p999_ns", "max_ns", "met_p999_ns", "met_max_ns", "contact_instructions",
               "cold_mean_ns", "cold_p50_ns", "cold_p99_ns", "cold_max_ns", "bytes_per_face", "bake_s",
               "god_object_rms_m", "god_object_max_m", "force_share_p99", "direction_max_deg", "jump_n_per_ms", "true_jump_n_per_ms",
               "wrong_feature_share", "push_throughs", "creep_m"]
    yield ("<details><summary>All figures of the first way of each kind (contenders.csv has every way)</summary>" +
           page.table(columns, first_ways(table)) + "</details>")
