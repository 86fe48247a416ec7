# SPDX-License-Identifier: Apache-2.0
"""Coulomb's law, tessellation, stick-slip, creep, energy."""
import math

import page
from figure import COLOURS, finish, legend, style, subplots

IDENTITY = "laws"
TITLE = "Laws of contact"
INTRODUCTION = """<p>What the step must obey, known without any other program: Coulomb's law on ramps, along grooves and edges;
the shape behind a tessellation; the saw-tooth of stick-slip; rest without creep; no energy from closed loops beyond what
sampling at a fixed rate gives.</p>"""


def content(run):
    yield from ramps(run)
    yield from slides(run)
    yield from grooves(run)
    yield from tessellation(run)
    yield from stick_slip(run)
    yield from energy(run)


def ramps(run):
    table = run.table("coulomb_ramps")
    if table is None:
        return
    figure, axes = subplots(1)
    ax = axes[0][0]
    rows = table.where(precision="f64").rows
    for colour, name, chosen in [("#0072B2", "sticks", lambda r: r["slides"] == 0), ("#D55E00", "slides", lambda r: r["sticks"] == 0),
                                 ("#999999", "both: within rounding of mu", lambda r: r["sticks"] > 0 and r["slides"] > 0)]:
        points = [(r["lean_deg"], r["mu_static"]) for r in rows if chosen(r) and r["wrong"] == 0]
        ax.scatter([p[0] for p in points], [p[1] for p in points], s=6, color=colour, label=name, linewidths=0)
    wrong = [r for r in rows if r["wrong"] > 0]
    ax.scatter([r["lean_deg"] for r in wrong], [r["mu_static"] for r in wrong], s=30, color="#000", marker="x", label="wrong")
    most = max((r["lean_deg"] for r in rows), default=0)
    angles = [most * i / 200 for i in range(201)]
    ax.plot(angles, [math.tan(math.radians(a)) for a in angles], color="#000", linewidth=.8, label="tan(angle)")
    ax.set(xlabel="angle by which the load leans, degrees", ylabel="static coefficient", title="Stick or slide, f64",
           ylim=(0, 1.05 * max(r["mu_static"] for r in rows)))
    legend(ax)
    yield finish("coulomb_ramps", figure, "Grid of friction coefficient against load angle: sticks above the tangent, slides below",
                 f"{sum(r['cases'] for r in rows):,} cases on faces and in grooves, turned at random; wrong: "
                 f"{sum(r['wrong'] for r in rows)}.")


def slides(run):
    table = run.table("coulomb_slides")
    if table is None:
        return
    figure, axes = subplots(1, height=4.4)
    ax = axes[0][0]
    for index, precision in enumerate(table.values("precision")):
        for k, surface in enumerate(table.values("surface")):
            rows = table.where(precision=precision, surface=surface).rows
            worst = {}
            for r in rows:
                if r["moved"] > 0:
                    worst[r["depth_of_extent"]] = max(worst.get(r["depth_of_extent"], 0), r["worst_ratio_error"])
            depths = sorted(worst)
            ax.plot(depths, [max(worst[d], 1e-17) for d in depths], color=COLOURS[index], marker="os^Dv*"[k % 6],
                    linestyle="-" if precision == "f64" else "--", label=f"{surface}, {precision}", linewidth=1)
    ax.axhline(1e-12, color="#000", linewidth=.8, label="bar, f64")
    ax.set(xscale="log", yscale="log", xlabel="depth, share of the extent", ylabel="worst error of |Ft| / |Fn|",
           title="Coulomb friction while sliding")
    legend(ax, 2)
    yield finish("coulomb_slides", figure, "Worst error of the friction ratio over depth, for double and single precision",
                 "Over stiffnesses from 1 to 10<sup>6</sup> N/m, speeds from 10<sup>-4</sup> to 1 m/s and rates from 1 to 40 kHz. The "
                 "error is rounding over depth: deeper is better.")


def grooves(run):
    table = run.table("grooves")
    if table is None:
        return
    figure, axes = subplots(1)
    ax = axes[0][0]
    rows = table.where(precision="f64").sorted_by("opening_deg").rows
    x = [r["opening_deg"] for r in rows]
    ax.plot(x, [r["wedge_in_theory"] for r in rows], color="#000", linewidth=.8, label="two faces carry the load")
    ax.plot(x, [r["along_over_across_wedge"] for r in rows], "o", color=COLOURS[0], label="wedge rule (default)")
    ax.plot(x, [r["along_over_across_paper"] for r in rows], "s", color=COLOURS[1], label="paper's rule")
    ax.set(xlabel="opening of the groove, degrees", ylabel="force along over force across", title="Friction along a groove", ylim=(0, None))
    legend(ax)
    yield finish("grooves", figure, "Friction along V-grooves against opening angle: the wedge rule is on theory, the paper's is lower",
                 "A HIP pulled along the bottom of a groove. The paper takes the distance from the edge for the load.")


def tessellation(run):
    table = run.table("tessellation")
    if table is None:
        return
    columns = [("god_object_error_m", "God-object error, m"), ("force_rms_error_n", "Force error, RMS, N"), ("jump_n_per_ms", "Largest jump, N per ms")]
    columns = [(c, t) for c, t in columns if c in table.columns]
    figure, axes = subplots(len(columns))
    for ax, (column, title) in zip(axes[0], columns):
        for index, shape in enumerate(table.values("shape")):
            rows = table.where(shape=shape, precision="f64").sorted_by("faces").rows
            ax.plot([r["faces"] for r in rows], [r[column] for r in rows], label=shape, **style(index))
        ax.set(xscale="log", yscale="log", xlabel="faces", title=title)
    legend(axes[0][0])
    yield finish("tessellation", figure, "Error against the smooth shape over the number of faces for sphere, cylinder, torus and cone",
                 "The faces' own distance from the shape they stand for: twice as fine, four times as near.")


def stick_slip(run):
    table = run.table("stick_slip")
    if table is None:
        return
    yield "<h3>Stick-slip</h3>" + page.table(table.columns, table.rows)


def energy(run):
    table = run.table("energy")
    if table is None:
        return
    yield "<h3>Closed loops</h3>" + page.table(table.columns, table.rows)
