# SPDX-License-Identifier: Apache-2.0
"""For tools/docs: writes the Markdown pages as Doxygen wants them into a folder, and beside the site the files that they link.
Line by line, so that Doxygen's warnings name the lines of the originals."""
import pathlib
import re
import shutil
import sys

FENCE = re.compile(r"^(`{3,})(.*)$")
LINK = re.compile(r"(!?)\[([^]]*)\]\(([^()\s]+)\)")


def sources(root):
    found = [root / name for name in ("README.md", "CHANGELOG.md", "CONTRIBUTING.md", "SECURITY.md")]
    return found + sorted((root / "docs").glob("**/*.md")) + sorted((root / "schemas").glob("*.md"))


def label(root, page):
    """The page's name in the site. README is the main page."""
    relative = page.relative_to(root).with_suffix("")
    return "mainpage" if str(relative) == "README" else "page-" + re.sub(r"\W", "-", str(relative)).lower()


def slug(heading):
    """GitHub's anchor."""
    text = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", heading)
    return re.sub(r"[^\w\- ]", "", text.lower()).replace(" ", "-")


class Page:
    def __init__(self, root, page, pages, files, pictures):
        self.root, self.page, self.pages, self.files, self.pictures = root, page, pages, files, pictures
        self.name = label(root, page)
        self.seen = {}

    def heading(self, line):
        found = re.match(r"^(#{1,6}) +(.*?)[ #]*$", line)
        if not found:
            return line
        if found[1] == "#":
            return f"# {found[2]} {{#{self.name}}}"
        anchor = slug(found[2])
        count = self.seen.get(anchor, 0)
        self.seen[anchor] = count + 1
        return f"{found[1]} {found[2]} {{#{self.name}-{anchor}{'-%d' % count if count else ''}}}"

    def link(self, found):
        picture, text, target = found.groups()
        if re.match(r"[a-z]+:", target):
            return found[0]
        name, _, anchor = target.partition("#")
        path = (self.page.parent / name).resolve() if name else self.page
        if picture:
            self.pictures.add(path)
            return f"![{text}]({path.name})"
        if path in self.pages:
            return f"[{text}](@ref {label(self.root, path)}{'-' + anchor if anchor else ''})"
        if path.is_dir():
            return text
        relative = path.relative_to(self.root)
        self.files.add(relative)
        return f'<a href="files/{relative}">{text}</a>'

    def staged(self):
        fence, lines = None, []
        for line in self.page.read_text().splitlines():
            found = FENCE.match(line)
            if found and (fence is None or (found[1] == fence and not found[2])):
                fence = found[1] if fence is None else None
                if fence is not None:  # Doxygen knows fences of three and languages of its own
                    line = "~~~~" + ("{.c}" if found[2] == "c" else "")
                else:
                    line = "~~~~"
            elif fence is None:
                line = "" if line.startswith("<!--") else LINK.sub(self.link, self.heading(line))
            lines.append(line)
        return "\n".join(lines) + "\n"


def main():
    root, staged, site = (pathlib.Path(argument).resolve() for argument in sys.argv[1:4])
    pages, files, pictures = set(sources(root)), set(), set()
    for page in sorted(pages):
        target = staged / page.relative_to(root)
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(Page(root, page, pages, files, pictures).staged())
    site.mkdir(parents=True, exist_ok=True)
    for picture in pictures:  # pages and pictures lie in one folder there
        if (site / picture.name).exists():
            sys.exit(f"{picture}: another picture has this name")
        shutil.copy(picture, site / picture.name)
    for relative in files:
        target = site / "files" / relative
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(root / relative, target)


if __name__ == "__main__":
    main()
