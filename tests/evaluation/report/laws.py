# SPDX-License-Identifier: Apache-2.0
"""Coulomb's law, tessellation, shading, stick-slip, creep, energy."""
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
    yield from shading(run)
    yield from relief(run)
    yield from scans(run)
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
    measures = [("off_surface_max_m", "God-object off the smooth shape, m"), ("god_object_error_max_m", "God-object error, m"),
                ("largest_jump_n_per_ms", "Largest force jump, N per ms")]
    figure, axes = subplots(len(measures))
    for ax, (column, title) in zip(axes[0], measures):
        for index, shape in enumerate(table.values("shape")):
            of_shape = table.where(shape=shape, precision="f64")
            depth = min(of_shape.column("depth_m"))
            rows = [r for r in of_shape.where(depth_m=depth).sorted_by("faces").rows if r["contact_ticks"] == r["ticks"]]
            ax.plot([r["faces"] for r in rows], [r[column] for r in rows], label=f"{shape}, {1e3 * depth:g} mm deep", **style(index))
        ax.set(xscale="log", yscale="log", xlabel="faces", title=title)
        legend(ax, 2)
    yield finish("tessellation", figure, "Error against the smooth shape over the number of faces for sphere, cylinder, torus and cone",
                 "What a tessellation costs: the distance from the shape that the faces stand for falls with the square of "
                 "their edges; along the surface and in direction it falls with the edge.")


def shading(run):
    table = run.table("shading")
    if table is None:
        return
    figure, axes = subplots(2)
    for index, method in enumerate(table.values("method")):
        rows = table.where(method=method).sorted_by("faces").rows
        axes[0][0].plot([r["faces"] for r in rows], [r["vibration_mn"] for r in rows], label=method, **style(index))
        timed = [r for r in rows if r["step_ns"] > 0]
        axes[0][1].plot([r["step_ns"] for r in timed], [r["direction_error_max_rad"] for r in timed], label=method, **style(index))
    axes[0][0].set(xscale="log", yscale="log", xlabel="faces", title="Vibration of the force, 80 to 450 Hz, mN RMS")
    axes[0][1].set(yscale="log", xlabel="ns a step", title="Largest error of direction, rad, over time")
    for ax in axes[0]:
        legend(ax)
    yield finish("shading", figure, "Vibration over faces, and error of direction over time, of facets, shading and others on a sphere",
                 "A hand that slides over a sphere at 0.1 m/s and 1.5 N. A mesh of 4 or 16 times as many facets is the point one or two "
                 "further along its line.")


def relief(run):
    table = run.table("relief")
    if table is None:
        return
    figure, axes = subplots(2)
    names = [r["heights"] for r in table.rows]
    for index, (column, name) in enumerate((("vibration_mn", "felt"), ("formula_mn", "by the formula"))):
        axes[0][0].barh([k + .4 * index for k in range(len(names))], [r[column] for r in table.rows], height=.38, color=COLOURS[index], label=name)
    for index, (column, name) in enumerate((("tick_ns", "with the heights"), ("step_ns", "the step alone"))):
        axes[0][1].barh([k + .4 * index for k in range(len(names))], [r[column] for r in table.rows], height=.38, color=COLOURS[index], label=name)
    axes[0][0].set(yticks=[k + .2 for k in range(len(names))], yticklabels=names, title="Vibration of the force, 80 to 450 Hz, mN RMS")
    axes[0][1].set(yticks=[k + .2 for k in range(len(names))], yticklabels=names, title="ns a tick")
    for ax in axes[0]:
        legend(ax)
    yield finish("relief", figure, "Vibration and time of heights on a flat face: ridges, grain, and an image of ridges",
                 "A hand that strokes a flat face at 0.1 m/s and 1.5 N, beside the formula for its force.")


def scans(run):
    table = run.table("scans")
    if table is None or not table.rows:
        return
    figure, axes = subplots(1)
    ax = axes[0][0]
    labels = [f"{r['scan']}, {r['depth_mm']:g} mm, {r['ways']}" for r in table.rows]
    columns = (("facets_mn", "facets"), ("shaded_mn", "shaded by the cone"), ("refined_mn", "the same, of 16 times the faces"))
    columns = [c for c in columns if c[0] in table.rows[0]]  # an older run's table in the same folder has fewer
    for index, (column, name) in enumerate(columns):
        ax.barh([k + .28 * index for k in range(len(labels))], [r[column] for r in table.rows], height=.26, color=COLOURS[index], label=name)
    ax.set(yticks=[k + .28 for k in range(len(labels))], yticklabels=labels, xlabel="mN RMS", title="Vibration of the force, 80 to 450 Hz, on scans")
    legend(ax)
    yield finish("scans", figure, "Vibration of the force on scans, of facets and with shading",
                 "Scans of 15 cm, a hand at 0.1 m/s with 1 N/mm. The nearest place of the surface leaps within a tick by at most half of "
                 "the depth on smooth ways, by more than the depth on leaping ones: the hand is deeper there than the surface bends, and "
                 "the force leaps with any method. What the shape itself does is told by the scan refined after Loop, twice.")


def stick_slip(run):
    trace, table = run.table("stick_slip_trace"), run.table("stick_slip")
    if trace is None or table is None:
        return
    figure, axes = subplots(2)
    ax = axes[0][0]
    rows = trace.where(rate_hz=max(trace.values("rate_hz"))).rows
    ax.plot([r["time_s"] for r in rows], [r["hand_spring_n"] for r in rows], color=COLOURS[0], linewidth=1, label="the hand's spring")
    ax.plot([r["time_s"] for r in rows], [r["friction_n"] for r in rows], color=COLOURS[1], linewidth=1, label="friction")
    ax.set(xlabel="s", ylabel="N", title="A mass pulled by a spring")
    legend(ax)
    ax = axes[0][1]
    pulled = [r for r in table.rows if r["motion"] == "pulled" and r["relative_error"] == r["relative_error"]]
    for index, quantity in enumerate(dict.fromkeys(r["quantity"] for r in pulled)):
        worst = {}
        for r in pulled:
            if r["quantity"] == quantity:
                worst[r["rate_hz"]] = max(worst.get(r["rate_hz"], 1e-12), abs(r["relative_error"]))
        ax.plot(sorted(worst), [worst[k] for k in sorted(worst)], label=quantity, **style(index))
    ax.set(xscale="log", yscale="log", xlabel="rate, Hz", ylabel="relative error", title="Against the closed form")
    legend(ax, 2)
    yield finish("stick_slip", figure, "Saw-tooth of stick-slip over time, and its error against the closed form over the rate",
                 "The error is that of sampling: it falls with the tick.")


def energy(run):
    table = run.table("energy_histogram")
    if table is None:
        return
    figure, axes = subplots(1, width=5.4)
    ax = axes[0][0]
    for index, precision in enumerate(table.values("precision")):
        loops = {}
        for r in table.where(precision=precision).rows:
            loops[r["work_over_bound_from"]] = loops.get(r["work_over_bound_from"], 0) + r["loops"]
        x = sorted(loops)
        ax.step(x, [loops[v] for v in x], where="post", color=COLOURS[index], label=f"{precision}, {sum(loops.values()):,} loops")
    ax.axvline(1, color="#000", linewidth=.8, label="bound")
    ax.set(yscale="log", xlabel="work on the user over the sampling's bound", ylabel="loops", title="Closed loops of the hand")
    legend(ax)
    yield finish("energy", figure, "Histogram of the work that closed loops do on the user over the zero-order hold's bound: all below 1",
                 "Negative: the user pays. What sampling gives at most is half the stiffness times the sum of the squared steps.")
