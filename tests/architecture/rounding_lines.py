#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Counts the lines of the step that exist for rounding alone: in real numbers they would not be there. What decides exactly, and
the tests that spare it, are not counted.

rounding_lines.txt names them, so that the count can be repeated: a line of the list is a file below runtime/src, what of it, and
the rule of the contact model, separated by " :: ". What of it is

  function NAME     with its template line and attributes, each definition of that name in the file
  file              all of it
  line TEXT         the line that has TEXT
  lines TEXT +N     that one and the N lines of code after it

Blank lines, comments and includes do not count. TEXT must be found once, NAME at least once: a list that the code has outgrown is
an error.

Usage: rounding_lines.py [--revision REVISION] [--list FILE] [--each]
As a test: rounding_lines.py --tolerances: whether the step has a tolerance that graph/tolerances.hpp does not name.
"""
import argparse
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
SOURCES = "runtime/src"


def read(revision, name):
    if revision is None:
        return (ROOT / SOURCES / name).read_text()
    return subprocess.run(["git", "show", f"{revision}:{SOURCES}/{name}"], cwd=ROOT, check=True, capture_output=True, text=True).stdout


def files_of_step(revision):
    if revision is None:
        paths = [str(path.relative_to(ROOT)) for path in (ROOT / SOURCES / "step").iterdir()]
    else:
        paths = subprocess.run(["git", "ls-tree", "--name-only", revision, f"{SOURCES}/step/"], cwd=ROOT, check=True,
                               capture_output=True, text=True).stdout.split()
    return sorted(path.removeprefix(SOURCES + "/") for path in paths)


def is_code(line):
    return re.match(r"\s*(//|#|$)", line) is None


def of_function(lines, name):
    """The numbers of the lines of each definition of a function."""
    found = set()
    for at, line in enumerate(lines):
        if not is_code(line) or not re.search(rf"[\w>&*\]] {re.escape(name)}\(", line) or re.match(r"\s*(return|else)\b", line):
            continue
        indent = re.match(r"\s*", line).group()
        end = at
        while not lines[end].rstrip().endswith(("{", ";", "}")):
            end += 1
        if lines[end].rstrip().endswith(";"):
            continue  # a call, or a declaration
        while not re.match(rf"{indent}}}", lines[end]) and not (end == at and re.search(r"\{.*\}$", lines[end])):
            end += 1
        begin = at
        while begin > 0 and re.match(rf"{indent}(template|\[\[)", lines[begin - 1]):
            begin -= 1
        found.update(range(begin, end + 1))
    return found


def named_by(lines, what):
    kind, _, rest = what.partition(" ")
    if kind == "file":
        return set(range(len(lines)))
    if kind == "function":
        return of_function(lines, rest)
    more = 0
    if kind == "lines":
        rest, _, count = rest.rpartition(" +")
        more = int(count)
    places = [at for at, line in enumerate(lines) if rest in line and is_code(line)]
    if len(places) != 1:
        return set()
    following = [at for at in range(places[0], len(lines)) if is_code(lines[at])]
    return set(following[:more + 1])


def nameless_tolerances(revision):
    """Prints every number of epsilons in the step's own files."""
    count = 0
    for name in files_of_step(revision):
        for number, line in enumerate(read(revision, name).splitlines(), 1):
            if is_code(line) and re.search(r"(\b\d+|\)) \* RealLimits<\w+>::kEpsilon|kEpsilon \* (\d|\()", line):
                print(f"{SOURCES}/{name}:{number}: a tolerance belongs into {SOURCES}/graph/tolerances.hpp, with a name and its reason")
                count += 1
    return 1 if count else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--revision", help="of this commit, not of the working tree")
    parser.add_argument("--list", type=pathlib.Path, default=pathlib.Path(__file__).with_name("rounding_lines.txt"))
    parser.add_argument("--each", action="store_true", help="prints the count of every entry")
    parser.add_argument("--tolerances", action="store_true", help="looks for tolerances without a name, and counts nothing")
    args = parser.parse_args()
    if args.tolerances:
        sys.exit(nameless_tolerances(args.revision))
    texts, counted, errors = {}, {}, []
    for number, entry in enumerate(args.list.read_text().splitlines(), 1):
        if not entry.strip() or entry.startswith("#"):
            continue
        name, what, rule = (part.strip() for part in entry.split(" :: "))
        if name not in texts:
            texts[name] = read(args.revision, name).splitlines()
        found = {at for at in named_by(texts[name], what) if is_code(texts[name][at])}
        if not found:
            errors.append(f"{args.list.name}:{number}: {name} has no {what}, or more than one")
        new = found - counted.setdefault(name, set())
        counted[name] |= new
        if args.each:
            print(f"{len(new):4} {name}: {what} ({rule})")
    whole = sum(sum(map(is_code, read(args.revision, name).splitlines())) for name in files_of_step(args.revision))
    total = sum(map(len, counted.values()))
    print(f"{total} lines of the step exist for rounding alone; its sources have {whole}")
    for error in errors:
        print(error, file=sys.stderr)
    sys.exit(1 if errors else 0)


if __name__ == "__main__":
    main()
