# SPDX-License-Identifier: Apache-2.0
"""The stress cases of the contact model, and what the judges found."""
import page

IDENTITY = "stress"
TITLE = "Numerical stability under stress"
INTRODUCTION = """<p>Every case that the contact model says must hold, judged at every step: not-a-number, cycles, work beyond the
bounds where no case allows it, a distance to the hand that grows within a step, a hand inside that is felt as free, a god-object
off the surface, a force that pulls inward, a held hand whose god-object moves. The run is cut into blocks, each with a seed of
its own; the hash over all results is the same on every repetition.</p>"""

# the judges' columns: all must be 0
COUNTS = ["nan", "cycles", "growths", "push_through", "thin_air", "off_surface", "pulls", "restless"]


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
    columns = ["case", "precision", "steps", "contact_steps", "transitions", "bound_hits", "growth_worst_eps",
               "off_surface_worst_eps", *counts]
    yield page.table([c for c in columns if c in table.columns], table.rows)
    targets = list({r["case"]: r for r in table.rows}.values())
    yield "<h3>What each case is held to</h3>" + page.table(["case", "target"], targets)
