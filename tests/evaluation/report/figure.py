# SPDX-License-Identifier: Apache-2.0
"""Figures: matplotlib's axes in the report's style, and their SVG text."""
import dataclasses
import io
import re

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt  # noqa: E402

plt.rcParams.update({
    "svg.fonttype": "none", "svg.hashsalt": "fdcg", "font.family": "sans-serif", "font.size": 10,
    "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True, "grid.color": "#e3e3e3", "grid.linewidth": 0.6,
    "axes.axisbelow": True, "axes.titlesize": 10.5, "axes.titleweight": "bold", "legend.frameon": False,
    "legend.fontsize": 8.5, "lines.linewidth": 1.6, "lines.markersize": 5, "figure.dpi": 100,
})

# Eight colours that remain apart for the colour-blind (Okabe and Ito).
COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000", "#999999"]
MARKERS = ["o", "s", "^", "D", "v", "P", "X", "*"]


def style(index):
    return {"color": COLOURS[index % len(COLOURS)], "marker": MARKERS[(index // len(COLOURS) + index) % len(MARKERS)]}


@dataclasses.dataclass
class Figure:
    """`name`: of the picture's file; `alt`: what one would say to somebody who cannot see it; `caption`: HTML."""
    name: str
    alt: str
    caption: str
    svg: str


def subplots(columns=1, rows=1, width=4.6, height=3.4, **options):
    return plt.subplots(rows, columns, figsize=(width * columns, height * rows), layout="constrained", squeeze=False, **options)


def legend(axes, columns=3, **options):
    """Under the axes, where no data can be."""
    axes.legend(loc="upper center", bbox_to_anchor=(.5, -.17), ncols=columns, **options)


def finish(name, figure, alt, caption):
    text = io.StringIO()
    figure.savefig(text, format="svg", metadata={"Date": None, "Creator": None})
    plt.close(figure)
    return Figure(name, alt, caption, _for_page(name, text.getvalue()))


def _for_page(name, svg):
    """Without the XML head; ids of their own, since all figures stand in one page."""
    svg = svg[svg.index("<svg"):]
    svg = re.sub(r'\bid="([^"]+)"', rf'id="{name}-\1"', svg)
    svg = re.sub(r'(xlink:href=|href=)"#([^"]+)"', rf'\1"#{name}-\2"', svg)
    return re.sub(r"url\(#([^)]+)\)", rf"url(#{name}-\1)", svg)
