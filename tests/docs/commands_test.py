# SPDX-License-Identifier: Apache-2.0
"""Every fenced block of README and docs is run, compared with what it shows, or run by another test that it names.
docs/contributing.md says how; a page is one session in one scratch folder."""
import contextlib
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import textwrap
import threading
import time
import unittest

from pages import ROOT, blocks, tested_pages

BUILD = pathlib.Path(os.environ["FDCG_BUILD"])
PROGRAMS = [str(pathlib.Path(os.environ[name]).parent) for name in ("FDCG", "FDCG_SERVO")]
LIBRARIES = os.environ["FDCG_RUNTIME_LIBRARY"].split(";")
CC = os.environ["FDCG_CC"]
FREE = {"text", "markdown"}  # diagrams and samples: need no directive


def ctest_names():
    """Of all tests that the build registers by add_test."""
    names = set()
    for path in BUILD.glob("**/CTestTestfile.cmake"):
        names |= {a or b for a, b in re.findall(r"^add_test\((?:\[=*\[(.*?)\]=*\]|(\S+))", path.read_text(), re.M)}
    return names


def is_excerpt(piece, text):
    """Whether the piece stands in the text, but for the indentation of the whole."""
    wanted, lines = piece.splitlines(), text.splitlines()
    for start in range(len(lines) - len(wanted) + 1):
        if textwrap.dedent("\n".join(lines[start:start + len(wanted)])).splitlines() == wanted:
            return True
    return False


class Coverage(unittest.TestCase):
    def test_every_block_says_how_it_is_tested(self):
        total = 0
        for page in tested_pages():
            for block in blocks(page):
                total += 1
                with self.subTest(block=str(block)):
                    self.assertTrue(block.language, "the block has no language")
                    if block.language not in FREE:
                        self.assertIsNotNone(block.directive, "no directive stands above it")
                    if block.language != "sh" and block.language not in FREE:
                        self.assertTrue({"as", "prints", "from", "printed-by", "by"} & set(block.directive or {}),
                                        f"nothing tests this {block.language}")
        self.assertGreater(total, 30)

    def test_what_runs_a_block_elsewhere_exists(self):
        names = ctest_names()
        self.assertGreater(len(names), 20, f"no tests are registered in {BUILD}")
        for page in tested_pages():
            for block in blocks(page):
                for name in (block.directive or {}).get("by", []):
                    with self.subTest(block=str(block), by=name):
                        if (ROOT / name).is_file():
                            script, lines = (ROOT / name).read_text(), filter(None, block.text.splitlines())
                            self.assertTrue(any(line.split()[0] in script for line in lines), "does not run it")
                        else:
                            self.assertIn(name, names)


# The loop or its writer was held up, as it may be on a busy machine (no device of the pages holds a write): the commands
# are run again.
LATE = re.compile(r"^  disarmed .*\b(host-late|writer-stuck)\b", re.M)
LATE_TRIES = 10
SHORTEST_LIMIT = 5e-3  # s; what the host allows a write, the shorter of its limits


def run_watched(*arguments, **options):
    """subprocess.run, and how late meanwhile the latest of bare threads woke, one on each processor, in s."""
    ended, delays = threading.Event(), []

    def watch(cpu):
        os.sched_setaffinity(0, {cpu})
        with contextlib.suppress(PermissionError):  # without the right to real time the host has none either
            os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(75))
        while not ended.is_set():
            before = time.monotonic()
            time.sleep(1e-3)
            delays.append(time.monotonic() - before - 1e-3)

    watchers = [threading.Thread(target=watch, args=(cpu,)) for cpu in os.sched_getaffinity(0)]
    for watcher in watchers:
        watcher.start()
    try:
        done = subprocess.run(*arguments, **options)
    finally:
        ended.set()
        for watcher in watchers:
            watcher.join()
    return done, max(delays, default=0)


class Page(unittest.TestCase):
    """A page in a folder of its own."""

    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)
        (self.folder / "home").mkdir()
        self.printed = None

    def shell(self, command, code, what):
        environment = os.environ | {"HOME": str(self.folder / "home"), "PATH": ":".join([*PROGRAMS, os.environ["PATH"]])}
        before, delays = set(self.folder.rglob("*")), []
        for _ in range(LATE_TRIES):
            done, delay = run_watched(("bash", "-eu", "-o", "pipefail", "-c", command), cwd=self.folder, env=environment,
                                      stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=200, check=False)
            delays.append(delay)
            if done.returncode == code or not LATE.search(done.stdout):
                break
            for made in sorted(set(self.folder.rglob("*")) - before, reverse=True):
                made.rmdir() if made.is_dir() else made.unlink()
        if len(delays) == LATE_TRIES and done.returncode != code and min(delays) > SHORTEST_LIMIT:
            self.skipTest(f"{what}: no real time: in each of {LATE_TRIES} tries this machine held bare threads up for over"
                          f" {min(delays) * 1e3:.0f} ms")
        said = [f"{what}\n{command}", f"stdout: {done.stdout[-2000:]}", f"stderr: {done.stderr[-2000:]}",
                f"bare threads were late by up to {max(delays) * 1e3:.1f} ms"]
        self.assertEqual(code, done.returncode, "\n".join(said))
        return done.stdout

    def bring(self, source):
        path, _, name = source.partition(" as ")
        target = self.folder / (name or path)
        target.parent.mkdir(parents=True, exist_ok=True)
        if (ROOT / path).is_dir():
            shutil.copytree(ROOT / path, target, dirs_exist_ok=True)
        else:
            shutil.copy(ROOT / path, target)

    def example(self, path, what):
        program = self.folder / "home" / pathlib.Path(path).stem
        flags = ["-std=c11", "-pedantic", "-Wall", "-Wextra", "-Werror", "-I", str(ROOT / "runtime" / "include")]
        done = subprocess.run((CC, *flags, ROOT / path, *LIBRARIES, "-o", program, "-lm"), capture_output=True, text=True, check=False)
        self.assertEqual(0, done.returncode, f"{what}\n{done.stderr}")
        return self.shell(str(program), 0, what)

    def check_block(self, block):
        directive = block.directive or {}
        for source in directive.get("in", []):
            self.bring(source)
        for name in directive.get("as", []):
            (self.folder / name).write_text(block.text)
        for path in directive.get("from", []):
            self.assertTrue(is_excerpt(block.text, (ROOT / path).read_text()), f"{block}: {path} does not have this text")
        for path in directive.get("printed-by", []):
            self.assertEqual(self.example(path, str(block)), block.text, str(block))
        if "prints" in directive:
            self.assertEqual(self.printed, block.text, str(block))
        if block.language == "sh" and "by" not in directive:
            self.printed = self.shell(block.text, int(directive.get("expect", ["0"])[0]), str(block))

    def check_page(self, page):
        for block in blocks(page):
            self.check_block(block)


class Session(Page):
    """Pages whose commands may take their time."""


class RealTime(Page):
    """Pages with a command that runs at a device's rate."""


def page_test(page):
    return lambda self: self.check_page(page)


def is_real_time(page):
    return any(re.search(r"^fdcg-servo run (?!.*--fast)", block.text, re.M) for block in blocks(page) if block.language == "sh")


for one in tested_pages():
    setattr(RealTime if is_real_time(one) else Session,
            "test_" + re.sub(r"\W", "_", str(one.relative_to(ROOT).with_suffix(""))).lower(), page_test(one))

if __name__ == "__main__":
    unittest.main()
