# SPDX-License-Identifier: Apache-2.0
"""The largest stable stiffness of a simulated device, beside the lines of theory."""
from figure import COLOURS, finish, legend, style, subplots

IDENTITY = "closed_loop"
TITLE = "Closed loop: how stiff before it shakes"
INTRODUCTION = """<p>A device of one degree of freedom (mass, damping, zero-order hold, encoder, delay; a hand as spring and damper)
presses on a face through the step itself. Sought: the largest stiffness that is stable. Lines of theory: passivity, K &le; 2b/T
(Colgate and Schenkel 1994), less with delay; the encoder's, K &le; 2f/&Delta; (Abbott and Okamura 2005); and the exact limit of the
sampled linear loop from its eigenvalues.</p>"""


def content(run):
    yield from limits(run)
    yield from quantum(run)
    yield from traces(run)


def limits(run):
    table = run.table("stability")
    if table is None:
        return
    plain = [r for r in table.rows if r["quantum_m"] == 0 and r["coulomb_n"] == 0 and r["virtual_damping_n_s_per_m"] == 0]
    devices = list(dict.fromkeys(r["device"] for r in plain))
    figure, axes = subplots(2)
    ax = axes[0][0]
    for index, device in enumerate(devices):
        rows = sorted((r for r in plain if r["device"] == device and r["delay_ticks"] == 0 and r["hand"] in ("no", "none", 0)),
                      key=lambda r: r["rate_hz"])
        if not rows:
            continue
        x = [r["rate_hz"] for r in rows]
        ax.plot(x, [r["limit_n_per_m"] for r in rows], linestyle="none", label=f"{device}, simulated", **style(index))
        ax.plot(x, [r["exact_n_per_m"] for r in rows], color=COLOURS[index], label="exact limit")
        ax.plot(x, [r["passivity_line_n_per_m"] for r in rows], ":", color=COLOURS[index], label="2b/T")
    ax.set(xscale="log", yscale="log", xlabel="rate, Hz", ylabel="largest stable stiffness, N/m", title="Against rate")
    legend(ax, 2)
    ax = axes[0][1]
    rates = sorted({r["rate_hz"] for r in plain if r["delay_ticks"] > 0})
    for index, rate in enumerate(rates[:6]):
        rows = sorted((r for r in plain if r["device"] == devices[0] and r["rate_hz"] == rate and r["hand"] in ("no", "none", 0)),
                      key=lambda r: r["delay_ticks"])
        x = [r["delay_ticks"] for r in rows]
        ax.plot(x, [r["limit_n_per_m"] for r in rows], linestyle="none", label=f"{rate:g} Hz, simulated", **style(index))
        ax.plot(x, [r["exact_n_per_m"] for r in rows], color=COLOURS[index])
        ax.plot(x, [r["passivity_line_n_per_m"] for r in rows], ":", color=COLOURS[index])
    ax.set(yscale="log", xlabel="delay, ticks", title=f"Against delay, {devices[0]}")
    legend(ax, 2)
    yield finish("closed_loop", figure,
                 "Largest stable stiffness against rate and against delay: the simulation on the exact limit, above the line of passivity",
                 "Marks: simulated; solid: exact limit of the linear loop; dotted: passivity, which is sufficient for any hand.")


def quantum(run):
    table = run.table("stability")
    if table is None:
        return
    rows = [r for r in table.rows if r["quantum_m"] > 0]
    if not rows:
        return
    figure, axes = subplots(1)
    ax = axes[0][0]
    keys = list(dict.fromkeys((r["device"], r["rate_hz"]) for r in rows))
    for index, (device, rate) in enumerate(keys[:6]):
        chosen = sorted((r for r in rows if (r["device"], r["rate_hz"]) == (device, rate) and r["delay_ticks"] == 0),
                        key=lambda r: r["quantum_m"])
        if not chosen:
            continue
        x = [r["quantum_m"] for r in chosen]
        ax.plot(x, [r["limit_n_per_m"] for r in chosen], linestyle="none", label=f"{device}, {rate:g} Hz", **style(index))
        ax.plot(x, [r["encoder_line_n_per_m"] for r in chosen], ":", color=COLOURS[index])
    ax.set(xscale="log", yscale="log", xlabel="encoder quantum, m", ylabel="largest stiffness, N/m", title="Against the encoder's quantum")
    legend(ax, 2)
    yield finish("closed_loop_quantum", figure, "Largest stiffness without a limit cycle against the encoder's quantum", "Dotted: the encoder's line.")


def traces(run):
    table = run.table("closed_loop_traces")
    if table is None:
        return
    figure, axes = subplots(1, width=6)
    ax = axes[0][0]
    for index, share in enumerate(table.values("share_of_exact_limit")):
        rows = table.where(share_of_exact_limit=share).rows
        ax.plot([r["time_s"] for r in rows], [r["deviation_m"] for r in rows], color=COLOURS[index], linewidth=1,
                label=f"{share:g} of the limit")
    ax.set(xlabel="s", ylabel="m", title="Pressed and let go: the deviation from rest")
    legend(ax)
    yield finish("closed_loop_traces", figure, "Deviation over time just below and just above the limit: it dies out or grows",
                 "The same device just below and just above the exact limit.")
