# SPDX-License-Identifier: Apache-2.0
"""Citations resolve. In comments of code, and in docs/internals:

  contact-model FACE-3, FACE-1 to FACE-6     a rule that docs/internals/contact-model.md declares: <a id="face-3"></a>**FACE-3**
  Melder 2004, section 5c / figure 7         the paper; other works likewise: Ericson 2005, section 5.3.3
  docs/internals/sweep.md#boxes              a page of the repository, and a heading in it; any path from the root
  walk.hpp                                   a file of the repository, by its basename

In docs/internals also: links, `identifiers` and `paths`, and test tags: Test: [seat].
And the other way round: each rule is cited by the code that follows it."""
import functools
import io
import pathlib
import re
import tokenize
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
MODEL = ROOT / "docs" / "internals" / "contact-model.md"
TAGGED_TESTS = ROOT / "tests" / "runtime" / "step" / "contact_rules_test.cpp"
FOLDERS = ("lib", "runtime", "tools", "tests", "schemas", "cmake")
C_LIKE, HASH_LIKE = {".c", ".h", ".cpp", ".hpp"}, {".cmake", ".txt", ".sh", ".bash", ""}
PAPER = {"section": {"1", "2", "3", "4", "5", "5a", "5b", "5c", "5d", "5e", "5f", "5g", "6", "7", "8"},
         "figure": {str(n) for n in range(1, 13)}}

DECLARED = re.compile(r'<a id="([a-z]+-\d+)"></a>\*\*([A-Z]+-\d+)\*\*')
MODEL_CITATION = re.compile(r"\b[Cc]ontact-model(?!\.md|\.hpp)(?P<rule> [A-Z]+-\d+)?")
RULE = re.compile(r"\b([A-Z]{3,})-(\d+)\b(?: to ([A-Z]{3,})-(\d+)\b)?")
PAPER_CITATION = re.compile(r"\bMelder(?: and Harwin,?)? \(?2004((?:(?:, | and | to )(?:(?:section|figure)s? )?\d+[a-z]?\b)*)")
OTHER_WORK = re.compile(r"\b[A-Z][a-z]+(?: and [A-Z][a-z]+)?,? \(?\d{4}\)?, (?:section|figure)s? \d+(?:\.\d+)*")
LOOSE = re.compile(r"\b(?:[Ss]ection|[Ff]igure)s? [1-9]\d*")
PATH = re.compile(r"(?<![\w/.$}{-])((?:" + "|".join(FOLDERS) + r"|docs)/[\w./-]*\w\.[a-z]\w*)(#[\w-]+)?")
BASENAME = re.compile(r"(?<![\w/.\\<-])([a-z0-9_-]+\.(?:hpp|cpp|h|py))\b(?!\w*/)")
LINK = re.compile(r"\]\(([^)\s]+)\)")
CODE_SPAN = re.compile(r"`([^`\n]+)`")
TEST_TAGS = re.compile(r"Tests?: ((?:\[[\w-]+\](?:, | and )?)+)")


# ---- what can be cited -----------------------------------------------------------------------------------------------------

def declared_rules(text):
    return {name: anchor for anchor, name in DECLARED.findall(text)}


@functools.lru_cache(maxsize=None)
def slugs(page):
    """What #... may name in a page: explicit anchors, and headings as they are linked to."""
    text = page.read_text()
    found = set(re.findall(r'<a id="([\w-]+)">', text))
    for heading in re.findall(r"^#+ (.*)$", text, re.M):
        found.add(re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-"))
    return found


@functools.lru_cache(maxsize=None)
def sources():
    files = [f for folder in FOLDERS for f in (ROOT / folder).rglob("*") if f.is_file() and "__pycache__" not in f.parts]
    return [f for f in files if f.suffix in C_LIKE | HASH_LIKE | {".py", ".md", ".json"} and f.stat().st_size < 1 << 20]


@functools.lru_cache(maxsize=None)
def basenames():
    """Of the files there are, and of those that a build writes."""
    built = " ".join(f.read_text() for f in sources() if f.suffix in {".cmake", ".txt"} and f.stat().st_size < 1 << 16)
    return {f.name for folder in FOLDERS for f in (ROOT / folder).rglob("*")} | set(re.findall(r"[\w-]+\.h\b", built))


@functools.lru_cache(maxsize=None)
def words():
    """Every identifier in code. This file and its neighbours are left out: they name what is wrong on purpose."""
    own = pathlib.Path(__file__).parent
    return {w for f in sources() if f.suffix in C_LIKE | {".py", ".txt", ".cmake"} and f.parent != own
            for w in re.findall(r"\w+", f.read_text(errors="replace"))}


# ---- prose in a file: (line, text) for each run of comment ------------------------------------------------------------------

C_TOKENS = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\'', re.S)


def c_comments(text):
    runs = []
    for token in C_TOKENS.finditer(text):
        if not token[0].startswith("/"):
            continue
        line = text.count("\n", 0, token.start()) + 1
        words_ = " ".join(re.sub(r"^[\s*]+", "", part) for part in token[0].strip("/").splitlines())
        whole_line = text[text.rfind("\n", 0, token.start()) + 1:token.start()].strip() == ""
        if runs and whole_line and runs[-1][2] == line - 1 and token[0].startswith("//"):
            runs[-1] = (runs[-1][0], runs[-1][1] + " " + words_.strip(), line)
        else:
            runs.append((line, words_.strip(), line + token[0].count("\n")))
    return [(line, run) for line, run, _ in runs]


def hash_comments(text):
    runs = []
    for number, line in enumerate(text.splitlines(), 1):
        found = re.match(r"\s*#+(.*)|[^#\"']*\s#(.*)", line)
        if not found:
            continue
        part = (found[1] or found[2] or "").strip()
        if runs and runs[-1][2] == number - 1 and found[1] is not None:
            runs[-1] = (runs[-1][0], runs[-1][1] + " " + part, number)
        else:
            runs.append((number, part, number))
    return [(line, run) for line, run, _ in runs]


def python_comments(text):
    runs = []
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type == tokenize.STRING and token.string.lstrip("rbfRBF").startswith(('"""', "'''")):
            runs.append((token.start[0], " ".join(token.string.split())))
    return runs + hash_comments(text)


def prose_of(name, text):
    suffix = pathlib.PurePath(name).suffix
    if suffix in C_LIKE:
        return c_comments(text)
    if suffix == ".py":
        return python_comments(text)
    if suffix == ".md":
        return [(n, line) for n, line in enumerate(text.splitlines(), 1)]
    return hash_comments(text) if suffix in HASH_LIKE else []


# ---- checks ----------------------------------------------------------------------------------------------------------------

def paper_problems(run):
    for citation in PAPER_CITATION.finditer(run):
        kind = None
        for word, place in re.findall(r"(?:(section|figure)s? )?(\d+[a-z]?)\b", citation[1]):
            kind = word or kind
            if kind is None:
                yield f"'{citation[0]}': say section or figure"
            elif place not in PAPER[kind]:
                yield f"the paper has no {kind} {place}"


def rule_problems(run, rules):
    prefixes = {name.split("-")[0] for name in rules}
    for found in RULE.finditer(run):
        for prefix, number in ((found[1], found[2]), (found[3], found[4])):
            if prefix in prefixes and f"{prefix}-{number}" not in rules:
                yield f"contact-model.md declares no {prefix}-{number}"
    for found in MODEL_CITATION.finditer(run):
        if found["rule"] is None:
            yield f"'{run[found.start():found.end() + 20]}': cite a rule: contact-model FACE-3"
        elif found["rule"].strip() not in rules:
            yield f"contact-model.md declares no{found['rule']}"


def path_problems(run, folder=ROOT):
    for path, anchor in PATH.findall(run):
        target = ROOT / path
        if not target.exists():
            yield f"there is no {path}"
        elif anchor and anchor[1:] not in slugs(target):
            yield f"{path} has no {anchor}"


def problems_in(name, text, rules):
    """What does not resolve in the comments of a file: (line, what)."""
    out = []
    for line, run in prose_of(name, text):
        found = list(rule_problems(run, rules)) + list(paper_problems(run)) + list(path_problems(run))
        if not name.endswith(".md"):
            rest = OTHER_WORK.sub("", PAPER_CITATION.sub("", run))
            found += [f"'{loose}' of what? contact-model FACE-3, or Melder 2004, section 5c" for loose in LOOSE.findall(rest)]
            found += [f"there is no file {base}" for base in BASENAME.findall(run) if base not in basenames()]
        out += [(line, problem) for problem in found]
    return out


def page_problems(page, text):
    """What only the pages of docs/internals may get wrong."""
    prose = re.sub(r"^```.*?^```", lambda block: "\n" * block[0].count("\n"), text, flags=re.S | re.M)
    out = []
    for line, run in enumerate(prose.splitlines(), 1):
        for link in LINK.findall(run):
            if re.match(r"[a-z]+:", link):
                continue
            path, _, anchor = link.partition("#")
            target = (page.parent / path).resolve() if path else page
            if not target.exists():
                out.append((line, f"there is no {path}"))
            elif anchor and anchor not in slugs(target):
                out.append((line, f"{target.name} has no #{anchor}"))
        for span in CODE_SPAN.findall(run):
            out += [(line, problem) for problem in span_problems(span)]
        for tags in TEST_TAGS.findall(run):
            out += [(line, f"no test has the tag {tag}") for tag in re.findall(r"\[[\w-]+\]", tags)
                    if f'"{tag}"' not in TAGGED_TESTS.read_text()]
    return out


def span_problems(span):
    if re.fullmatch(r"[\w/-]+/[\w.-]+\.\w+|[\w/-]+/", span):
        homes = (ROOT, ROOT / "runtime" / "src", ROOT / "lib" / "src", ROOT / "runtime")
        if not any((home / span).exists() for home in homes):
            yield f"there is no {span}"
    elif re.fullmatch(r"(?:\w+::)*\w+(?:\.\w+)?", span) and re.search(r"_|^k[A-Z]|^[A-Z][a-z]+[A-Z<]", span):
        for word in re.findall(r"\w+", span):
            if len(word) > 3 and word not in words():
                yield f"`{span}` is not in the code"


def cited_rules(text):
    for found in RULE.finditer(text):
        last = int(found[4]) if found[3] == found[1] else int(found[2])
        yield from (f"{found[1]}-{n}" for n in range(int(found[2]), last + 1))


class Citations(unittest.TestCase):
    maxDiff = None

    @classmethod
    def setUpClass(cls):
        cls.rules = declared_rules(MODEL.read_text())

    def refuse(self, problems):
        if problems:
            self.fail("\n" + "\n".join(f"{file}:{line}: {what}" for file, line, what in problems))

    def test_every_citation_in_the_code_resolves(self):
        own = pathlib.Path(__file__).resolve()
        self.refuse([(f.relative_to(ROOT), line, what) for f in sources() if f != own
                     for line, what in problems_in(f.name, f.read_text(errors="replace"), self.rules)])

    def test_every_reference_in_the_internals_resolves(self):
        pages = sorted(MODEL.parent.glob("*.md"))
        self.assertGreaterEqual(len(pages), 6)
        self.refuse([(f.relative_to(ROOT), line, what) for f in pages
                     for line, what in problems_in(f.name, f.read_text(), self.rules) + page_problems(f, f.read_text())])

    def test_every_rule_is_declared_once_under_its_own_anchor(self):
        found = DECLARED.findall(MODEL.read_text())
        self.assertEqual([name.lower() for _, name in found], [anchor for anchor, _ in found])
        self.assertEqual(len(found), len(set(found)))
        self.assertGreater(len(found), 60)

    def test_every_rule_is_cited_by_the_code_that_follows_it(self):
        cited = {rule for f in sources() if f.relative_to(ROOT).parts[0] in ("lib", "runtime") and f.suffix in C_LIKE
                 for _, run in c_comments(f.read_text()) for rule in cited_rules(run)}
        self.assertEqual(sorted(r for r in self.rules if r not in cited and not r.startswith("PAPER-")), [])


class Planted(unittest.TestCase):
    """What the checks must refuse, and what they must not."""

    RULES = {"FACE-1": "face-1", "FACE-2": "face-2"}

    def problems(self, text, name="a.cpp"):
        return [what for _, what in problems_in(name, text, self.RULES)]

    def test_what_resolves_passes(self):
        for text in ("// contact-model FACE-1", "// (contact-model FACE-1 to FACE-2)", "// Melder 2004, sections 5d to 5f and 6",
                     "// Melder 2004, section 2 and figure 4; contact-model FACE-1.", "/* Ericson 2005, section 5.3.3 */",
                     "// docs/internals/contact-model.md#symbols-and-units".replace("#s", "#2-s"), "// see citations_test.py",
                     'const char* s = "sections 13 and 14";', "// Melder and Harwin (2004) on a graph"):
            self.assertEqual(self.problems(text), [], text)

    def test_what_does_not_resolve_is_found(self):
        for text in ("// contact-model FACE-3", "// contact-model FACE-1 to FACE-9", "// contact-model section 6",
                     "// the rule of section 6", "// see figure 7", "// Melder 2004, section 5h", "// Melder 2004, figure 13",
                     "// Melder 2004, 5c", "// docs/internals/no_such_page.md", "// docs/internals/sweep.md#no-such-heading",
                     "// as in no_such_file.hpp", "/* one line\n * contact-model\n * FACE-3 */", "// by the\n// contact-model\n// section 6"):
            self.assertNotEqual(self.problems(text), [], text)
        self.assertNotEqual(self.problems('"""contact-model FACE-3"""\n', "a.py"), [])
        self.assertNotEqual(self.problems("set(x 1) # contact-model FACE-3\n", "CMakeLists.txt"), [])
        self.assertNotEqual(self.problems("see FACE-3\n", "a.md"), [])

    def test_what_a_page_says_of_the_code_is_looked_up(self):
        page = MODEL.parent / "sweep.md"
        self.assertEqual(page_problems(page, "`side_of` in `step/sweep.hpp`, [here](step.md#files). Test: [seat]"), [])
        for text in ("`no_such_function`", "`step/no_such_file.hpp`", "[gone](no_such_page.md)", "[gone](step.md#no-such)", "Test: [no-such]"):
            self.assertEqual(len(page_problems(page, text)), 1, text)

    def test_the_line_is_that_of_the_comment(self):
        self.assertEqual([line for line, _ in problems_in("a.cpp", "int a;\n\nint b;  // contact-model FACE-3\n", self.RULES)], [3, 3])


if __name__ == "__main__":
    unittest.main()
