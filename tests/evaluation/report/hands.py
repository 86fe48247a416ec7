# SPDX-License-Identifier: Apache-2.0
"""Every contender in a loop with a device of three axes that a hand holds."""
import page
from figure import COLOURS, finish, legend, style, subplots

IDENTITY = "hands"
TITLE = "What reaches the hand"
INTRODUCTION = """<p>A simulated device of three axes (0.1 kg, 1 N s/m, 1 kHz), held by a hand as spring and damper (400 N/m, 4 N s/m) that follows a
target over edges, in grooves and corners, on facets and a thin plate. Every contender closes the loop with its own force (1,000 N/m), and so does
the contact model by brute force in long double, the truth. Compared is the force of the hand's spring and damper. Felt: off by over 7 % of the
true force and over 0.05 N. Without friction, those who know none take part too.</p>"""

CHOSEN = ["fdcg_f64_stored", "paper", "paper_vertices", "embree_closest", "ray_proxy", "grid_64", "finger_proxy", "openvdb_128"]
LEAST_N = 1e-12  # where smaller errors are drawn


def content(run):
    yield from errors(run)
    yield from traces(run)
    yield from limits(run)
    yield from details(run)


def errors(run):
    table = run.table("hands")
    if table is None:
        return
    scenes = table.values("scene")
    figure, axes = subplots(2, width=5.2, height=4)
    for ax, key, label in ((axes[0][0], "hand_rms_n", "force at the hand, off by, RMS, N"),
                           (axes[0][1], "vibration_n", "of that from 80 to 450 Hz, RMS, N")):
        for index, contender in enumerate(CHOSEN):
            rows = {r["scene"]: r for r in table.where(contender=contender).rows}
            x = [k for k, scene in enumerate(scenes) if scene in rows]
            if x:
                ax.plot(x, [max(rows[scenes[k]][key], LEAST_N) for k in x], linestyle="none", label=contender, **style(index))
        ax.set_xticks(range(len(scenes)), scenes, rotation=30, ha="right")
        ax.set(yscale="log", ylabel=label)
    axes[0][0].set_title("What the hand feels beside the truth")
    axes[0][1].set_title("What of it skin feels best")
    for ax in axes[0]:
        ax.legend(loc="upper center", bbox_to_anchor=(.5, -.28), ncols=3)
    yield finish("hands", figure, "Error of the force at the hand for each scene and contender, whole and between 80 and 450 Hz; fdcg stands lowest",
                 f"Each contender in a loop of its own. Errors below {LEAST_N:g} N are drawn at it.")


def traces(run):
    table = run.table("hands_traces")
    if table is None:
        return
    scenes = table.values("scene")
    columns = min(2, len(scenes))
    figure, axes = subplots(columns, -(-len(scenes) // columns), width=5.4, height=2.9)
    flat = [ax for row in axes for ax in row]
    for ax in flat[len(scenes):]:
        ax.set_axis_off()
    contenders = [c for c in table.values("contender") if c != "truth"]
    colours = {"truth": "#000000", **{c: COLOURS[(k if k < 6 else k + 1) % len(COLOURS)] for k, c in enumerate(contenders)}}  # black is the truth's
    series = {}
    for r in table.rows:
        series.setdefault((r["scene"], r["contender"]), []).append((r["time_s"], r["hand_n"]))
    for ax, scene in zip(flat, scenes):
        for contender, colour in colours.items():
            if (scene, contender) in series:
                is_truth = contender == "truth"
                ax.plot(*zip(*series[scene, contender]), color=colour, linewidth=3 if is_truth else 1, label=contender, zorder=1 if is_truth else 2)
        ax.set(ylabel="N at the hand", title=scene)
    for ax in flat[:len(scenes)]:
        ax.set_xlabel("s")
    shown = {line.get_label(): line for ax in flat for line in ax.get_lines()}  # who knows no friction is not everywhere
    legend(flat[columns * ((len(scenes) - 1) // columns)], 4, handles=list(shown.values()))
    yield finish("hands_traces", figure, "Size of the force at the hand over time, the truth as a broad line, contenders as thin ones",
                 "Broad and black: the truth. Where a thin line leaves it, the hand feels something that is not there.")


def limits(run):
    table = run.table("hands_limits")
    if table is None:
        return
    scenes = table.values("scene")
    figure, axes = subplots(1, width=8, height=3.6)
    ax = axes[0][0]
    names = table.values("contender")
    for index, scene in enumerate(scenes):
        rows = {r["contender"]: r for r in table.where(scene=scene).rows}
        x = [k for k, name in enumerate(names) if name in rows]
        ax.plot(x, [rows[names[k]]["stable_share_of_exact"] for k in x], linestyle="none", label=scene, **style(index))
    ax.axhline(1, color="#000", linewidth=.7)
    ax.set_xticks(range(len(names)), names, rotation=60, ha="right", fontsize=7)
    ax.set(ylabel="stiffest stable, of the exact", title="Pressed and let go: how stiff before it shakes")
    ax.legend(loc="upper left", bbox_to_anchor=(1, 1))
    yield finish("hands_limits", figure,
                 "Stiffest stable contact of each contender on a face, beside an edge, in a groove and in a corner, as a part of the exact limit",
                 "The line: the limit of one axis by its eigenvalues. 0: shakes, or loses contact, at a hundredth of it; 4: stable there too, since the force does not answer.")


def details(run):
    table = run.table("hands")
    if table is None:
        return
    columns = ["scene", "contender", "hand_rms_n", "hand_max_n", "vibration_n", "direction_p99_deg", "felt_share", "felt_ms", "apart_m", "lost_share",
               "held_swing_m", "gained_j"]
    yield f"<details><summary>Every contender in every scene</summary>{page.table(columns, table.rows)}</details>"
