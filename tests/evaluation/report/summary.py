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
        yield from caches(run)
        yield from judged(run)
    failed = sum(b["verdict"] == "FAIL" for b in run.bars)
    yield f"<b>Bars:</b> {len(run.bars) - failed} of {len(run.bars)} hold."


def glance(run):
    """A table of the bodies: what fdcg takes and errs, and who does better, in time or at no larger error."""
    table = run.table("pareto_intervals")
    if table is None:
        return ""
    rows = []
    for body in dict.fromkeys(r["body"] for r in table.sorted_by("faces").rows):
        entries = table.where(body=body).rows
        own = {p: min((r for r in entries if r["family"] == "fdcg" and p in r["contender"]), key=lambda r: r["mean_ns"], default=None)
               for p in ("f64", "f32")}
        if own["f64"] is None:
            continue
        others = [r for r in entries if r["family"] != "fdcg"]
        exact = [r for r in others if frontier.error_m(r) <= frontier.error_m(own["f64"])]
        rows.append({"body": body, "faces": own["f64"]["faces"], "ways": own["f64"]["seeds"],
                     **{p: with_interval(r, "mean_ns") if r else "" for p, r in own.items()},
                     "cold": with_interval(own["f64"], "cold_ns"), "p99": f"{own['f64']['p99_ns']:.0f}",
                     "error": f"{own['f64']['god_object_rms_m']:.1g}; {own['f32']['god_object_rms_m']:.1g}" if own["f32"] else "",
                     "exact": named(min(exact, key=lambda r: r["mean_ns"], default=None)),
                     "fastest": named(min(others, key=lambda r: r["mean_ns"], default=None))})
    return page.table(["body", "faces", "ways", "f64", "f32", "cold", "p99", "error", "exact", "fastest"], rows,
                      {"f64": "fdcg f64, ns a step", "f32": "fdcg f32, ns", "cold": "f64 in a swept cache, ns", "p99": "f64, 99th percentile, ns",
                       "error": "error of f64; f32, m RMS", "exact": "fastest other, no less exact", "fastest": "fastest of all others"})


def with_interval(row, key):
    """Mean, and the interval that holds 95 %."""
    return f"{row[key]:.0f} ({row[key + '_low']:.0f} to {row[key + '_high']:.0f})"


def named(row):
    if row is None:
        return "none"
    return f"{row['contender']}: {with_interval(row, 'mean_ns')} ns, {row['god_object_rms_m']:.1g} m; cold {row['cold_ns']:.0f} ns"


def caches(run):
    """What is left of the lead over a tree's closest point when the caches were swept."""
    table = run.table("pareto_intervals")
    rows = [] if table is None else [r for r in table.rows if r["contender"] == "embree_closest"]
    if rows:
        yield (f"<b>Cold:</b> Embree's closest point takes {span(rows, 'over_ours')} times the step of fdcg f64, and {span(rows, 'cold_over_ours')} "
               "times where the first and second level of the cache were swept before each tick.")


def judged(run):
    table = run.table("contenders")
    if table is not None:
        tied, unjudged = (max(table.rows, key=lambda r: r[key]) for key in ("tied_share", "unjudged_share"))
        where = f" ({page.escape(unjudged['contender'])} on {page.escape(unjudged['body'])}, {unjudged['way']})" if unjudged["unjudged_share"] else ""
        yield (f"<b>Not judged:</b> at most {100 * unjudged['unjudged_share']:.2g} % of a way's contact ticks{where}. In up to "
               f"{100 * tied['tied_share']:.2g} % ({page.escape(tied['contender'])} on {page.escape(tied['body'])}, {tied['way']}) the answer is not that of 256 "
               "bits, and rounding makes others as right; there the nearest counts.")


def span(rows, key):
    return f"{min(r[key] for r in rows):.1f} to {max(r[key] for r in rows):.1f}"


def against_others(bodies):
    lost, cold = [[said for precision in ("f64", "f32") if (said := losses_of(precision, bodies, which))]
                  for which in (frontier.losses, frontier.cold_losses)]
    yield (f"<b>Where fdcg loses</b>, to contenders that are no less exact: {'; '.join(lost) or 'nowhere'}."
           + (f" In a swept cache: {'; '.join(cold)}." if cold else ""))
    faster = {}  # and less exact: error
    for _, rows in bodies:
        own = min((r for r in rows if r["family"] == "fdcg"), key=lambda r: r["mean_ns"], default=None)
        for r in rows if own is not None else []:
            if r["family"] != "fdcg" and r["mean_ns"] < own["mean_ns"] and frontier.error_m(r) > frontier.error_m(own):
                faster[r["contender"]] = max(r["god_object_rms_m"], faster.get(r["contender"], 0))
    if faster:
        said = [f"{page.escape(name)} (error up to {error:.2g} m)" for name, error in faster.items()]
        yield f"<b>Faster and less exact</b> on some body: {', '.join(said)}."


def losses_of(precision, bodies, losses):
    """On which bodies, by whom at best, and by whom else; empty where on none."""
    lost = [(share, body, other["contender"]) for body, (_, rows) in enumerate(bodies) for own, other, share in losses(rows)
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
