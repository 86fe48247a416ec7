# SPDX-License-Identifier: Apache-2.0
"""The diagram and the table of docs/internals/architecture.md: drawn from cmake/arrows.txt, which says what may include what.
Run with --write to renew them; as a test it checks that they are current."""
import pathlib
import re
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
ARROWS = ROOT / "cmake" / "arrows.txt"
PAGE = ROOT / "docs" / "internals" / "architecture.md"
PICTURE = ROOT / "docs" / "internals" / "architecture.svg"
BLOCK = re.compile(r"(<!-- arrows -->\n)(.*?)(<!-- end of arrows -->)", re.S)

PARTS = (("tools", "programs"), ("lib", "compiler"), ("runtime/device", "device host"), ("runtime", "runtime"))  # most special first
COLUMNS = (("programs",), ("compiler",), ("runtime",), ("device host",))
BOX = (92, 26)
GAP = (14, 34)
MARGIN = 14


def read_arrows(text):
    """{folder: the folders that it may include}, as declared: FROM -> TO, TO ...; # starts a comment."""
    arrows = {}
    for number, line in enumerate(text.splitlines(), 1):
        line = line.split("#")[0].strip()
        if not line:
            continue
        source, arrow, targets = line.partition("->")
        if not arrow or not source.strip() or not targets.strip():
            raise ValueError(f"cmake/arrows.txt:{number}: {line!r} is not FROM -> TO")
        arrows.setdefault(source.strip(), set()).update(re.split(r"[\s,]+", targets.strip()))
        for target in arrows[source.strip()]:
            arrows.setdefault(target, set())
    return arrows


def reachable(arrows, start):
    found, waiting = set(), [start]
    while waiting:
        for target in arrows[waiting.pop()]:
            if target not in found:
                found.add(target)
                waiting.append(target)
    return found


def reduced(arrows):
    """Without the arrows that a longer way implies. The declaration has no circles (tested where it is enforced)."""
    far = {folder: reachable(arrows, folder) for folder in arrows}
    return {folder: {t for t in targets if not any(t in far[other] for other in targets if other != t)}
            for folder, targets in arrows.items()}


def part_of(folder):
    return next((name for prefix, name in PARTS if folder == prefix or folder.startswith(prefix + "/")), "other")


def short(folder):
    for prefix in ("runtime/device/src/", "runtime/src/", "lib/src/", "runtime/device/", "runtime/", "tools/"):
        if folder.startswith(prefix):
            return folder[len(prefix):]
    return folder


class Panel:
    """The folders of one part in layers, each above all that it may include; long arrows bend at waypoints."""

    def __init__(self, name, folders, arrows):
        self.name = name
        inner = {f: {t for t in arrows[f] if t in folders} for f in folders}
        level = {}

        def level_of(folder):
            if folder not in level:
                level[folder] = 1 + max((level_of(t) for t in inner[folder]), default=-1)
            return level[folder]

        rows = [[] for _ in range(1 + max(level_of(f) for f in folders))]
        for folder in sorted(folders):
            rows[level[folder]].append(folder)
        self.ways = []
        for source in sorted(folders):
            for target in sorted(inner[source]):
                way = [source] + [(source, target, i) for i in range(level[source] - 1, level[target], -1)] + [target]
                for point in way[1:-1]:
                    rows[point[2]].append(point)
                self.ways.append(way)
        self.arrange(rows)

    def arrange(self, rows):
        width = max(len(row) for row in rows)
        at = {item: i for row in rows for i, item in enumerate(row)}
        for sweep in range(8):  # towards the middle of the neighbours in the next layer, downwards and upwards
            for row in (rows if sweep % 2 else rows[::-1]):
                def pull(item):
                    near = [at[b if a == item else a] for way in self.ways for a, b in zip(way, way[1:])
                            if item in (a, b) and (b if a == item else a) not in row]
                    return sum(near) / len(near) if near else at[item]
                row.sort(key=lambda item: (pull(item), str(item)))
                for i, item in enumerate(row):
                    at[item] = i + (width - len(row)) / 2
        self.place = {item: (at[item] * (BOX[0] + GAP[0]), (len(rows) - 1 - y) * (BOX[1] + GAP[1]))
                      for y, row in enumerate(rows) for item in row}
        self.size = (width * (BOX[0] + GAP[0]) - GAP[0] + 2 * MARGIN, len(rows) * (BOX[1] + GAP[1]) - GAP[1] + 2 * MARGIN + 18)

    def draw(self, x, y):
        left, top = x + MARGIN, y + MARGIN + 18
        out = [f'<rect class="part" x="{x}" y="{y}" width="{self.size[0]}" height="{self.size[1]}" rx="6"/>',
               f'<text class="name" x="{x + MARGIN}" y="{y + 20}">{self.name}</text>']
        for way in self.ways:
            middle = [(left + self.place[p][0] + BOX[0] / 2, top + self.place[p][1] + BOX[1] / 2) for p in way]
            points = [(middle[0][0], middle[0][1] + BOX[1] / 2)] + middle[1:-1] + [(middle[-1][0], middle[-1][1] - BOX[1] / 2 - 2)]
            out.append('<polyline points="' + " ".join(f"{a:g},{b:g}" for a, b in points) + '" marker-end="url(#head)"/>')
        for item, (a, b) in self.place.items():
            if isinstance(item, str):
                out.append(f'<rect class="room" x="{left + a:g}" y="{top + b:g}" width="{BOX[0]}" height="{BOX[1]}" rx="4"/>')
                out.append(f'<text x="{left + a + BOX[0] / 2:g}" y="{top + b + BOX[1] / 2 + 4:g}">{short(item)}</text>')
        return out


def picture(arrows):
    plain = reduced(arrows)
    panels = [Panel(name, {f for f in arrows if part_of(f) == name}, plain)
              for (name,) in COLUMNS + (("other",),) if any(part_of(f) == name for f in arrows)]
    x, body = 0, []
    height = max(panel.size[1] for panel in panels)
    for panel in panels:
        body += panel.draw(x, height - panel.size[1])
        x += panel.size[0] + GAP[0]
    return "\n".join([
        "<!-- SPDX-License-Identifier: Apache-2.0; drawn from cmake/arrows.txt by tests/docs/architecture.py -->",
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="-4 -4 {x - GAP[0] + 8} {height + 8}" font-family="sans-serif" font-size="12">',
        "<style>.part{fill:#f6f6f6;stroke:#bbb}.room{fill:#fff;stroke:#456}text{text-anchor:middle;fill:#222}"
        ".name{text-anchor:start;font-weight:bold}polyline{fill:none;stroke:#678}</style>",
        '<defs><marker id="head" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="7" markerHeight="7" orient="auto">'
        '<path d="M0 0L8 4L0 8z" fill="#678"/></marker></defs>', *body, "</svg>", ""])


def table(arrows):
    lines = ["| folder | may include |", "| --- | --- |"]
    order = [name for _, name in PARTS] + ["other"]
    for folder in sorted(arrows, key=lambda f: (order.index(part_of(f)), f)):
        if arrows[folder]:
            lines.append(f"| `{folder}` | " + ", ".join(f"`{t}`" for t in sorted(arrows[folder])) + " |")
    return "\n".join(lines) + "\n"


class Architecture(unittest.TestCase):
    maxDiff = None

    def setUp(self):
        self.arrows = read_arrows(ARROWS.read_text())

    def test_the_page_shows_the_arrows_as_declared(self):
        self.assertEqual(BLOCK.search(PAGE.read_text()).group(2), table(self.arrows), "run tests/docs/architecture.py --write")

    def test_the_picture_is_drawn_from_the_arrows_as_declared(self):
        self.assertEqual(PICTURE.read_text(), picture(self.arrows), "run tests/docs/architecture.py --write")

    def test_another_arrow_gives_another_picture_and_another_table(self):
        more = {folder: set(targets) for folder, targets in self.arrows.items()}
        more["runtime/src/new_room"] = {"runtime/src/base"}
        self.assertNotEqual(picture(more), picture(self.arrows))
        self.assertNotEqual(table(more), table(self.arrows))

    def test_what_is_no_arrow_is_refused_by_its_line(self):
        with self.assertRaisesRegex(ValueError, "arrows.txt:2"):
            read_arrows("a -> b\nc, d\n")


if __name__ == "__main__":
    if "--write" in sys.argv:
        declared = read_arrows(ARROWS.read_text())
        PICTURE.write_text(picture(declared))
        PAGE.write_text(BLOCK.sub(lambda found: found.group(1) + table(declared) + found.group(3), PAGE.read_text()))
    else:
        unittest.main()
