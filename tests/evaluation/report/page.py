# SPDX-License-Identifier: Apache-2.0
"""The report as one HTML page that needs nothing else."""
import html

STYLE = """
:root { --ink: #1c1c1c; --soft: #666; --line: #ddd; --good: #1a7f37; --bad: #c1121f; }
body { font: 16px/1.5 system-ui, sans-serif; color: var(--ink); max-width: 62rem; margin: 2rem auto; padding: 0 1rem; background: #fff; }
h1 { font-size: 1.7rem; margin-bottom: .2rem; } h2 { margin-top: 3rem; border-top: 1px solid var(--line); padding-top: 1rem; }
.facts, figcaption, .note { color: var(--soft); font-size: .88rem; }
figure { margin: 1.5rem 0; } figure svg { max-width: 100%; height: auto; }
.scroll { overflow-x: auto; } table { border-collapse: collapse; font-size: .85rem; font-variant-numeric: tabular-nums; }
th, td { text-align: left; padding: .25rem .7rem .25rem 0; border-bottom: 1px solid var(--line); vertical-align: top; }
td.n { text-align: right; white-space: nowrap; } .ok { color: var(--good); } .FAIL { color: var(--bad); font-weight: 700; }
code { font-size: .9em; background: #f4f4f4; padding: 0 .2em; } nav a { margin-right: 1rem; }
"""


def escape(text):
    return html.escape(str(text))


def number(value):
    if isinstance(value, float):
        return f"{value:.4g}"
    if isinstance(value, int) and abs(value) >= 10000:
        return f"{value:,}"
    return str(value)


def table(columns, rows, heads=None):
    """`rows`: dicts. Numbers to the right. `heads`: what to call columns."""
    heads = heads or {}
    out = ["<div class=scroll><table><tr>"]
    out += [f"<th>{escape(heads.get(c, c))}</th>" for c in columns]
    out.append("</tr>")
    for row in rows:
        out.append("<tr>")
        for c in columns:
            value = row[c]
            is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
            verdict = f" class={value}" if value in ("ok", "FAIL") else ""
            out.append(f"<td class=n>{number(value)}</td>" if is_number else f"<td{verdict}>{escape(value)}</td>")
        out.append("</tr>")
    out.append("</table></div>")
    return "".join(out)


def figure(f):
    svg = f.svg.replace("<svg", f'<svg role="img" aria-label="{escape(f.alt)}"', 1)
    return f'<figure id="{f.name}">{svg}<figcaption>{f.caption}</figcaption></figure>'


def bars_table(bars):
    rows = [{**b, "limit": f"{b['relation']} {number(b['limit'])}"} for b in bars]
    return table(["verdict", "bar", "measured", "limit", "unit", "note"], rows, {"verdict": "", "note": ""})


def facts_line(facts):
    return " · ".join(f"{escape(k)}: {escape(v)}" for k, v in facts.items())


def bars_part(bars):
    """Those that fail, and the rest folded."""
    failed, held = [b for b in bars if b["verdict"] == "FAIL"], [b for b in bars if b["verdict"] != "FAIL"]
    folded = f"<details><summary>{len(held)} bars hold</summary>{bars_table(held)}</details>" if held else ""
    return (bars_table(failed) if failed else "") + folded


def environment_part(environment):
    rows = [{"what": k, "is": v} for k, v in environment.items()]
    return "<h2 id=environment>Measured on</h2>" + table(["what", "is"], rows, {"what": "", "is": ""}) if rows else ""


def page(facts, bars, front, sections, environment):
    """`front`: what is to be seen first, as HTML. `sections`: (id, title, introduction as HTML, list of HTML parts)."""
    out = ["<!doctype html><html lang=en><head><meta charset=utf-8><title>fdcg: run time against error</title>",
           "<meta name=viewport content='width=device-width,initial-scale=1'>",
           f"<style>{STYLE}</style></head><body>",
           "<h1>fdcg: run time against error, and stability under stress</h1>",
           f"<p class=facts>{facts_line(facts)}</p>", *front, "<nav><a href='#bars'>Bars</a>",
           "".join(f"<a href='#{i}'>{escape(t)}</a>" for i, t, _, _ in sections),
           "<a href='#environment'>Measured on</a>" if environment else "", "</nav>", "<h2 id=bars>Bars</h2>", bars_part(bars)]
    for identity, title, introduction, parts in sections:
        out.append(f"<h2 id={identity}>{escape(title)}</h2>{introduction}")
        out += parts
    out.append(environment_part(environment))
    out.append("</body></html>\n")
    return "\n".join(out)
