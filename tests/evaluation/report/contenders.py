# SPDX-License-Identifier: Apache-2.0
"""Run time against error: the contenders on the same bodies and ways."""
import frontier
import page
from figure import COLOURS, finish, legend, style, subplots

IDENTITY = "contenders"
TITLE = "Run time against error"
INTRODUCTION = """<p>The same ways of the same hand over the same bodies, one thread, warmed alike. Time: the mean of a step over the
whole way, the least of many rounds. Error: the god-object's distance from the true one, RMS over the way's ticks. Truth is the
model's: it remembers on which side the hand came in, which a closest point does not.</p>"""

FAMILIES = {"fdcg": ("fdcg", "o"), "paper": ("the paper's algorithm", "s"), "ablation": ("corrections added to it one by one", "P"),
            "closest_point": ("closest point by a tree", "^"), "proxy": ("ray proxy", "D"), "distance_grid": ("distance grid", "v")}
BODIES = {"sphere": "-", "star": "--"}  # each a line of its own: at one size they differ
LEAST_M = frontier.FLOOR_M  # where smaller errors are drawn


def content(run):
    yield from overview(run)
    yield from pareto(run)
    yield from verdicts(run)
    yield from faults(run)
    yield from details(run)


def colour(row):
    return COLOURS[list(FAMILIES).index(row["family"])] if row["family"] in FAMILIES else COLOURS[-1]


CHOSEN = ["fdcg_f64_stored", "fdcg_f32_stored", "paper", "paper_vertices", "ray_proxy", "embree_closest", "cgal_closest", "grid_64"]


def overview(run):
    """One body's frontier, the largest that all contenders have, and time over the number of faces."""
    frontier, table = run.table("pareto"), run.table("contenders")
    if frontier is None or table is None:
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
            rows = table.where(contender=contender, way="hand", mu_static=0, rate_hz=1000, group=group).sorted_by("faces").rows
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
    cases = list(dict.fromkeys((r["body"], r["way"], r["mu_static"]) for r in table.rows))
    figure, axes = subplots(3, width=4.8, height=.28 * len(chosen) * max(1, len(cases) / 3.2))
    measures = [("wrong_feature_share", "Ticks on a wrong feature, share"), ("noticeable_share", "Ticks with a noticeable force error, share"),
                ("push_throughs", "Passes through the solid")]
    for ax, (column, title) in zip(axes[0], measures):
        y = 0
        ticks, names = [], []
        for body, way, mu in cases:
            for index, contender in enumerate(chosen):
                rows = [r for r in table.rows if (r["body"], r["way"], r["mu_static"], r["contender"]) == (body, way, mu, contender)]
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
    columns = ["body", "way", "rate_hz", "mu_static", "contender", "p50_ns", "p99_ns", "p999_ns", "max_ns", "bytes_per_face", "bake_s",
               "god_object_rms_m", "god_object_max_m", "force_share_p99", "direction_max_deg", "jump_n_per_ms", "true_jump_n_per_ms",
               "wrong_feature_share", "push_throughs", "creep_m"]
    yield ("<details><summary>All figures</summary>" + page.table(columns, table.rows) + "</details>")
