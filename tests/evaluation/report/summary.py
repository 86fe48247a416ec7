# SPDX-License-Identifier: Apache-2.0
"""The report's first lines: where fdcg loses, how fast it is, how wrong, and whether the bars hold."""
import frontier
import page


def lines(run):
    """Sentences as HTML; the first says where fdcg loses."""
    table = run.table("pareto")
    if table is not None:
        bodies = [(rows[0]["faces"], rows) for rows in (table.where(body=b).rows for b in table.values("body"))]
        yield from against_others(sorted(bodies, key=lambda b: b[0]))
        yield from own_figures(bodies)
    failed = sum(b["verdict"] == "FAIL" for b in run.bars)
    yield f"<b>Bars:</b> {len(run.bars) - failed} of {len(run.bars)} hold."


def against_others(bodies):
    lost = [said for precision in ("f64", "f32") if (said := losses_of(precision, bodies))]
    yield f"<b>Where fdcg loses</b>, to contenders that are no less exact: {'; '.join(lost) or 'nowhere'}."
    faster = {}  # and less exact: error
    for _, rows in bodies:
        own = min((r for r in rows if r["family"] == "fdcg"), key=lambda r: r["mean_ns"], default=None)
        for r in rows if own is not None else []:
            if r["family"] != "fdcg" and r["mean_ns"] < own["mean_ns"] and frontier.error_m(r) > frontier.error_m(own):
                faster[r["contender"]] = max(r["god_object_rms_m"], faster.get(r["contender"], 0))
    if faster:
        said = [f"{page.escape(name)} (error up to {error:.2g} m)" for name, error in faster.items()]
        yield f"<b>Faster and less exact</b> on some body: {', '.join(said)}."


def losses_of(precision, bodies):
    """On which bodies, by whom at best, and by whom else; empty where on none."""
    lost = [(share, body, other["contender"]) for body, (_, rows) in enumerate(bodies) for own, other, share in frontier.losses(rows)
            if precision in own["contender"]]
    if not lost:
        return ""
    share, _, best = min(lost)
    where = sorted({body for _, body, _ in lost})
    faces = ", ".join(f"{bodies[body][0]:,}" for body in where)
    others = [page.escape(name) for name in dict.fromkeys(name for *_, name in lost) if name != best]
    return (f"{precision} on {len(where)} of {len(bodies)} bodies ({faces} faces), at worst to {page.escape(best)}, which takes "
            f"{share:.2f} of its time" + (f"; also to {', '.join(others)}" if others else ""))


def own_figures(bodies):
    for precision in ("f64", "f32"):
        own = [min((r for r in rows if r["family"] == "fdcg" and precision in r["contender"]), key=lambda r: r["mean_ns"], default=None)
               for _, rows in bodies]
        own = [r for r in own if r is not None]
        if own:
            yield (f"<b>fdcg, {precision}:</b> {min(r['mean_ns'] for r in own):.0f} to {max(r['mean_ns'] for r in own):.0f} ns a step "
                   f"on average, error {max(r['god_object_rms_m'] for r in own):.2g} m RMS at most, on bodies of 0.1 m with "
                   f"{min(r['faces'] for r in own):,} to {max(r['faces'] for r in own):,} faces.")
