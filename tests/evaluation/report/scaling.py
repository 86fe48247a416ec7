# SPDX-License-Identifier: Apache-2.0
"""How bake, memory, loading and the step grow with faces, contacts and objects."""
import page
from figure import finish, legend, style, subplots

IDENTITY = "scaling"
TITLE = "Scaling"
INTRODUCTION = """<p>What grows with the mesh, and what does not. <i>Own</i>: the least of several replays of the same tick, its data
in cache; <i>as met</i>: timed once, in the order in which the hand comes by. A hand slides at 0.1 m/s and 1 kHz, 1 mm deep.</p>"""

SERIES = [("f64", "stored"), ("f64", "derived"), ("f32", "stored"), ("f32", "derived")]


def content(run):
    yield from faces(run)
    yield from steps(run)
    yield from contacts(run)
    yield from objects(run)
    yield from exponents(run)


def label(precision, planes):
    return precision if planes == "stored" else f"{precision}, planes derived"


def body_of(table):
    """The bodies of the ladder share small ones: those of the sphere."""
    return [b for b in table.values("body") if b in ("cube", "sphere")]


def lines(axes, table, y, keep=lambda row: True):
    for index, (precision, planes) in enumerate(SERIES):
        rows = [r for r in table.where(precision=precision, planes=planes).sorted_by("faces").rows
                if r["body"] in body_of(table) and keep(r) and r[y] > 0]
        if rows:
            axes.plot([r["faces"] for r in rows], [r[y] for r in rows], label=label(precision, planes), **style(index))
    axes.set(xscale="log", yscale="log", xlabel="faces")


def faces(run):
    table = run.table("scaling_faces")
    if table is None:
        return
    figure, axes = subplots(3)
    for ax, (column, title, unit) in zip(axes[0], [("bake_s", "Compiling", "s"), ("file_bytes", "File", "bytes"),
                                                   ("open_full_s", "Opening, verified in full", "s")]):
        lines(ax, table, column)
        ax.set(title=title, ylabel=unit)
    lines_of_trust = [r for r in table.where(precision="f64", planes="stored").sorted_by("faces").rows if r["body"] in body_of(table)]
    axes[0][2].plot([r["faces"] for r in lines_of_trust], [r["open_trusted_s"] for r in lines_of_trust], ":", color="#666",
                    label="f64, trusted")
    legend(axes[0][0], 2)
    legend(axes[0][2], 2)
    yield finish("scaling_bake", figure, "Three log-log plots over the number of faces: compile time, file size and opening time",
                 "Time to compile, size of the file and time to open it, a geodesic sphere. Trusted opening reads the header alone.")


def steps(run):
    table = run.table("scaling_steps")
    if table is None:
        return
    figure, axes = subplots(3)
    ways = [("hand", "own", "Hand, own work"), ("hand", "met", "Hand, as met"), ("cross", "own", "One face crossed a tick, own work")]
    for ax, (way, kind, title) in zip(axes[0], ways):
        part = table.where(way=way, kind=kind)
        lines(ax, part, "p50_ns")
        f64 = [r for r in part.where(precision="f64", planes="stored").sorted_by("faces").rows if r["body"] in body_of(part)]
        ax.plot([r["faces"] for r in f64], [r["p99_ns"] for r in f64], "--", color="#0072B2", alpha=.6, label="f64, p99")
        ax.set(title=title, ylabel="ns a step, median")
    legend(axes[0][0], 2)
    yield finish("scaling_faces", figure,
                 "Median time of a contact step over the number of faces from a hundred to millions: flat for own work, rising "
                 "with cache misses as met",
                 "A step in contact looks at the active face and its neighbours: its own work does not depend on the mesh. What "
                 "rises as met are misses of the cache: on a finer mesh the same motion crosses more faces, each new to the cache.")


def contacts(run):
    table = run.table("scaling_contacts")
    if table is None:
        return
    figure, axes = subplots(1)
    ax = axes[0][0]
    index = 0
    for where in table.values("where"):
        for precision in table.values("precision"):
            rows = table.where(where=where, precision=precision).sorted_by("contacts").rows
            if rows:
                ax.plot([r["contacts"] for r in rows], [r["p50_a_contact_ns"] for r in rows], label=f"{where}, {precision}",
                        **style(index))
                index += 1
    ax.set(xscale="log", yscale="log", xlabel="contacts", ylabel="ns a contact and tick", title="Contacts")
    legend(ax)
    yield finish("scaling_contacts", figure, "Time a contact and tick over the number of contacts from one to a hundred thousand",
                 "Contacts on one object, stepped one after the other (<i>graph</i>) and through a scene.")


def objects(run):
    table = run.table("scaling_objects")
    if table is None:
        return
    figure, axes = subplots(1)
    ax = axes[0][0]
    for index, case in enumerate(table.values("case")):
        rows = table.where(case=case).sorted_by("objects").rows
        ax.plot([r["objects"] for r in rows], [r["step_p50_ns"] for r in rows], label=case, **style(index))
    ax.set(xscale="log", yscale="log", xlabel="objects in the scene", ylabel="ns a tick, median", title="Objects, one finger")
    legend(ax)
    yield finish("scaling_objects", figure, "Median time of a scene's tick over the number of objects from one to ten thousand",
                 "<i>far</i>: nothing within reach; <i>touch</i>: one object touched; <i>look</i>: every tick asks every object; "
                 "<i>jump</i>: the finger is elsewhere each tick; <i>all move</i>: every object gets a new pose each tick.")


def exponents(run):
    table = run.table("scaling_exponents")
    if table is not None:
        yield "<h3>Exponents</h3><p>Slope in log-log: 0 is flat, 1 linear.</p>"
        yield page.table(["table", "body", "precision", "planes", "quantity", "from", "to", "exponent"], table.rows)
