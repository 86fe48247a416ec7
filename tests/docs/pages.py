# SPDX-License-Identifier: Apache-2.0
"""Reads the project's Markdown pages: headings, links, fenced blocks and the directives above them (docs/contributing.md)."""
import dataclasses
import os
import pathlib
import re

ROOT = pathlib.Path(os.environ["FDCG_ROOT"])
FENCE = re.compile(r"^(`{3,})(.*)$")
DIRECTIVE = re.compile(r"^<!-- test:(.*)-->$")
KEYS = {"in", "expect", "as", "prints", "from", "printed-by", "by"}


def tested_pages():
    """Every page whose blocks are run."""
    return [ROOT / "README.md", ROOT / "CONTRIBUTING.md", ROOT / "SECURITY.md", *sorted((ROOT / "docs").glob("**/*.md"))]


def linked_pages():
    """Every page whose links must resolve."""
    more = [ROOT / "CHANGELOG.md", *sorted((ROOT / "schemas").glob("*.md")), *sorted((ROOT / "tests").glob("**/README.md"))]
    return tested_pages() + more


@dataclasses.dataclass
class Block:
    page: pathlib.Path
    line: int
    language: str
    text: str
    directive: dict | None  # key -> list of values; None: there is no directive

    def __str__(self):
        return f"{self.page.relative_to(ROOT)}:{self.line}"


def parse_directive(line, where):
    found = DIRECTIVE.match(line.strip())
    if not found:
        return None
    directive = {}
    for part in filter(None, (part.strip() for part in found[1].split(";"))):
        key, _, value = part.partition("=")
        if key not in KEYS:
            raise ValueError(f"{where}: there is no directive '{key}'")
        directive.setdefault(key, []).append(value)
    return directive


def blocks(page):
    lines, found, open_fence = page.read_text().splitlines(), [], None
    for number, line in enumerate(lines, 1):
        fence = FENCE.match(line)
        if open_fence is None and fence:
            open_fence = (fence[1], fence[2].strip(), number)
        elif open_fence is not None and fence and fence[1] == open_fence[0] and not fence[2]:
            start = open_fence[2]
            above = lines[start - 2] if start > 1 else ""
            text = "".join(one + "\n" for one in lines[start:number - 1])
            found.append(Block(page, start, open_fence[1], text, parse_directive(above, f"{page}:{start - 1}")))
            open_fence = None
    if open_fence is not None:
        raise ValueError(f"{page}:{open_fence[2]}: the block is not closed")
    return found


def prose(page):
    """The lines outside of fenced blocks, numbered."""
    fence = None
    for number, line in enumerate(page.read_text().splitlines(), 1):
        found = FENCE.match(line)
        if found and (fence is None or (found[1] == fence and not found[2])):
            fence = found[1] if fence is None else None
        elif fence is None:
            yield number, line


def anchors(page):
    """The anchors of a page's headings, as GitHub forms them."""
    seen, names = {}, set()
    for _, line in prose(page):
        heading = re.match(r"^#{1,6} +(.*?)[ #]*$", line)
        if not heading:
            continue
        text = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", heading[1])
        slug = re.sub(r"[^\w\- ]", "", text.lower()).replace(" ", "-")
        count = seen.get(slug, 0)
        seen[slug] = count + 1
        names.add(f"{slug}-{count}" if count else slug)
    return names
