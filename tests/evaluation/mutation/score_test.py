#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What is published of the planted faults is of those that there are and holds the bars; how a judge's finding is read."""
import argparse
import contextlib
import csv
import io
import pathlib
import signal
import sys
import tempfile
import unittest
import unittest.mock

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import score  # noqa: E402


class Published(unittest.TestCase):
    def test_table_and_page_are_of_the_faults_that_there_are(self):
        self.assertEqual([], score.check())

    def test_every_fault_was_given_to_every_judge_and_steps_were_counted(self):
        rows = score.rows_of(score.SCORE)
        for name in score.judges(score.HERE):
            self.assertEqual(len(rows), len(score.asked(rows, name)), name)
        for row in rows:
            for name in score.judges_of(rows):
                self.assertTrue(row[f"{name}_ticks"] != "0" and (row[f"{name}_ticks"] or not row[name]), (row["fault"], name))

    def problems_of(self, change):
        """With a table that was changed."""
        rows = score.rows_of(score.SCORE)
        change(rows)
        path = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory())) / "score.csv"
        with open(path, "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, rows[0])
            writer.writeheader()
            writer.writerows(rows)
        with unittest.mock.patch.object(score, "SCORE", path):
            return score.check()

    def test_a_fault_that_was_not_asked_is_told(self):
        self.assertTrue(any("not of the faults" in p for p in self.problems_of(lambda rows: rows.pop())))

    def test_faults_that_stress_misses_are_told_and_so_is_one_that_all_miss(self):
        def forget(rows):
            for row in rows[:3]:
                row["stress"] = ""
            for name in score.judges_of(rows):
                rows[0][name] = ""
        problems = self.problems_of(forget)
        self.assertTrue(any(p.startswith("stress alone misses") for p in problems), problems)
        self.assertTrue(any(p.startswith("every judge misses force-negated") for p in problems), problems)
        self.assertTrue(any("section is not" in p for p in problems), problems)

    def test_a_name_in_the_list_that_no_source_plants_is_told(self):
        path = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory())) / "faults.csv"
        path.write_text(score.FAULTS.read_text(encoding="utf-8") + "no-such-fault,force,nothing\n", encoding="utf-8")
        with unittest.mock.patch.object(score, "FAULTS", path):
            self.assertTrue(any("no-such-fault" in p for p in score.check()))

    def test_what_is_published_keeps_what_was_not_asked_anew(self):
        folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        first = score.rows_of(score.SCORE)[0]["fault"]
        (folder / "new.csv").write_text(f"fault,kind,stress,stress_ticks\n{first},force,pull,7\n", encoding="utf-8")
        for name in ("SCORE", "PAGE"):
            copy = folder / getattr(score, name).name
            copy.write_text(getattr(score, name).read_text(encoding="utf-8"), encoding="utf-8")
            self.enterContext(unittest.mock.patch.object(score, name, copy))
        before = score.rows_of(score.SCORE)
        score.publish(folder / "new.csv")
        after = score.rows_of(score.SCORE)
        self.assertEqual({**before[0], "stress": "pull", "stress_ticks": "7"}, after[0])
        self.assertEqual(before[1:], after[1:])
        self.assertEqual([], score.check())


class TakenUp(unittest.TestCase):
    """Judges that are scripts: stress and found write what they were asked into a file, and stress finds faults of an odd last letter."""

    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.asked, self.stop = self.folder / "asked", self.folder / "stop"
        self.programs = self.folder / "build" / "tests" / "evaluation"
        self.programs.mkdir(parents=True)
        (self.programs / score.LIBRARY).write_text("a library", encoding="utf-8")
        for name in ("fdcg_stress", "fdcg_test_evaluation_stress_found"):
            self.write_program(name, "")
        self.enterContext(unittest.mock.patch.object(score, "bars", lambda rows: []))
        self.enterContext(contextlib.redirect_stdout(io.StringIO()))
        self.enterContext(contextlib.redirect_stderr(io.StringIO()))

    def write_program(self, name, more):
        program = self.programs / name
        program.write_text(f"""#!/bin/sh
{more}
echo "{name} $FDCG_MUTANT" >> {self.asked}
printf '\\7\\0\\0\\0\\0\\0\\0\\0' > "$FDCG_MUTANT_TICKS"
[ "$FDCG_MUTANT" != b ] || [ ! -e {self.stop} ] || kill -TERM $$
[ "$FDCG_MUTANT" != a ]
""", encoding="utf-8")
        program.chmod(0o755)

    def score(self):
        options = argparse.Namespace(build=self.folder / "build", output=self.folder / "out", jobs=1, ticks=5, publish=False)
        faults = [{"name": name, "kind": "force"} for name in "abc"]
        status = score.score(options, ["stress", "found"], faults)
        asked = self.asked.read_text(encoding="utf-8").split("\n")[:-1] if self.asked.exists() else []
        self.asked.unlink(missing_ok=True)
        return status, asked, (self.folder / "out" / "mutation_score.csv").read_text(encoding="utf-8")

    def test_what_the_same_programs_have_answered_is_not_asked_again(self):
        status, asked, table = self.score()
        self.assertEqual(0, status)
        self.assertIn("a,force,exit code 1,7,exit code 1,7", table)
        self.assertIn("b,force,,14,,7", table)
        self.assertEqual(2 * 3 + 1 + 4, len(asked))  # stress asks twice where the short run finds nothing; nothing planted, too
        self.assertEqual((0, [], table), self.score())

    def test_a_call_that_was_stopped_is_taken_up_where_it_was(self):
        self.stop.touch()
        with self.assertRaises(score.Stopped):
            self.score()
        self.assertIn("fdcg_stress b", self.asked.read_text(encoding="utf-8"))
        self.asked.unlink()
        with open(self.folder / "out" / "runs.csv", "a", encoding="utf-8") as file:
            file.write("stress,b,a line that was c")
        self.stop.unlink()
        _, asked, table = self.score()
        self.assertEqual(["fdcg_stress b"] * 2, asked[:2])
        self.assertFalse(any(line in ("fdcg_stress a", "fdcg_stress ") for line in asked), asked)
        self.assertIn("b,force,,14,,7", table)

    def test_another_program_is_asked_anew_and_the_other_judges_are_not(self):
        self.score()
        self.write_program("fdcg_stress", "# changed")
        self.assertEqual({"fdcg_stress", "fdcg_stress a", "fdcg_stress b", "fdcg_stress c"}, {line.strip() for line in self.score()[1]})

    def test_another_library_or_reproducer_is_asked_anew(self):
        self.score()
        (self.programs / score.LIBRARY).write_text("another", encoding="utf-8")
        self.assertEqual(11, len(self.score()[1]))
        (self.folder / "new.obj").touch()
        with unittest.mock.patch.object(score, "REPRODUCERS", self.folder):
            self.assertEqual({"fdcg_test_evaluation_stress_found"}, {line.split()[0] for line in self.score()[1]})


class Reading(unittest.TestCase):
    def test_stress_bars_tests_and_deaths_are_read(self):
        self.assertIsNone(score.how_found(0, "FAIL x: 1"))
        self.assertEqual("pull", score.how_found(1, "seed 1\nFOUND saddles-f32-pull at tick 7 of x\n"))
        self.assertEqual("own creep", score.how_found(1, "ok   a: 1\nFAIL own creep: 1 m\nFAIL b: 2\n"))
        line = "-" * 79
        self.assertEqual("a corner holds", score.how_found(1, f"~~~\n{line}\na corner holds\n  [friction]\n{line}\nfile.cpp:12: FAILED:\n"))
        self.assertEqual("hangs", score.how_found(-signal.SIGXCPU, ""))
        self.assertEqual(f"signal {int(signal.SIGSEGV)}", score.how_found(-signal.SIGSEGV, ""))
        self.assertEqual("exit code 3", score.how_found(3, ""))

    def test_a_judge_that_somebody_stops_has_found_nothing(self):
        for number in (signal.SIGHUP, signal.SIGINT, signal.SIGTERM):
            self.assertRaises(score.Stopped, score.how_found, -number, "")


if __name__ == "__main__":
    unittest.main()
