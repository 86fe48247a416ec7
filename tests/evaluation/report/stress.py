# SPDX-License-Identifier: Apache-2.0
"""The stress cases of the contact model, and what the judges found."""
import page
from figure import COLOURS, finish, legend, subplots

IDENTITY = "stress"
TITLE = "Numerical stability under stress"
INTRODUCTION = """<p>Every case that the contact model says must hold, judged at every step: not-a-number, work beyond the
bounds where no case allows it, a distance to the hand that grows within a step, a hand inside that is felt as free, a god-object
off the surface, a force that pulls inward, a held hand whose god-object moves. The run is cut into blocks, each with a seed of
its own; the hash over all results is the same on every repetition.</p>"""

# the judges' columns: all must be 0
COUNTS = ["nan", "growths", "push_through", "no_force", "thin_air", "off_surface", "pulls", "restless", "report", "force", "friction",
          "wrong_face", "uncertified", "stalled"]
# contact ticks whose place is not judged, by why
UNJUDGED = ["unjudged_carried", "unjudged_slit", "unjudged_between", "unjudged_other"]


def content(run):
    table = run.table("stress_cases")
    if table is None:
        return
    steps = sum(table.column("steps"))
    counts = [c for c in COUNTS if c in table.columns]
    found = {c: sum(table.column(c)) for c in counts}
    unbounded = sum(max(0, r["bound_hits"]) for r in table.rows if r["bound_hits_allowed"] in (0, "no"))
    yield (f"<p>{steps:,} steps, {sum(table.column('contact_steps')):,} of them in contact, "
           f"{sum(table.column('transitions')):,} changes of state. Found: " +
           ", ".join(f"{page.escape(c)} {n:,}" for c, n in found.items()) +
           f"; bound hits outside the stated cases {unbounded:,}.</p>")
    if all(c in table.columns for c in UNJUDGED):
        contacts = max(1, sum(table.column("contact_steps")))
        yield ("<p>Share of contact steps whose place is not judged: " +
               ", ".join(f"{page.escape(c.removeprefix('unjudged_'))} {sum(table.column(c)) / contacts:.2%}" for c in UNJUDGED) +
               ". Carried ones are judged in all but whether they are at rest.</p>")
    yield margins(table)
    columns = ["case", "precision", "steps", "contact_steps", "transitions", "bound_hits", "growth_worst_eps",
               "off_surface_worst_eps", *counts, *UNJUDGED]
    yield page.table([c for c in columns if c in table.columns], table.rows)
    targets = list({r["case"]: r for r in table.rows}.values())
    yield "<h3>What each case is held to</h3>" + page.table(["case", "target"], targets)


def margins(table):
    """How near each case comes to the judges' limits."""
    figure, axes = subplots(2, width=5, height=.2 * len(table.values("case")) + 1.2)
    cases = table.values("case")
    for ax, (column, limit, title) in zip(axes[0], [("growth_worst_eps", 16, "Growth of |GO - HIP| within a step"),
                                                    ("off_surface_worst_eps", 64, "God-object off its feature")]):
        for index, precision in enumerate(table.values("precision")):
            worst = {r["case"]: r[column] for r in table.where(precision=precision).rows}
            ax.plot([max(worst.get(c, 0), 1e-2) for c in cases], range(len(cases)), "os"[index % 2], color=COLOURS[index], label=precision)
        ax.axvline(limit, color="#000", linewidth=.8, label="limit")
        ax.set(xscale="log", xlabel="eps of the scale, the worst of all steps", title=title)
        ax.set_yticks(range(len(cases)), cases if ax is axes[0][0] else [], fontsize=7)
        ax.invert_yaxis()
    legend(axes[0][0])
    return finish("stress_margins", figure, "The worst growth and the worst distance off the surface in each stress case, beside their limits",
                  "The scale is the larger of the object's extent and the HIP's coordinates.")
