#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The templates of rivals take part as they are; their answers are judged from files alone as the program judges them; a rival that
breaks the rules is refused by name; results merge."""
import csv
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
PROGRAM, CC = os.environ["FDCG_BENCH_CONTENDERS"], os.environ["FDCG_CC"]
PIPE = f"pipe:{sys.executable} -B {HERE / 'template.py'}"
sys.path.insert(0, str(HERE))
import judge  # noqa: E402


def build(source, library, *flags):
    subprocess.run([CC, "-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", "-O2", "-shared", "-fPIC", "-I", HERE, *flags, source,
                    "-o", library, "-lm"], check=True)


def bench(*arguments):
    return subprocess.run([PROGRAM, "--quick", "--no-time-bars", *map(str, arguments)], capture_output=True, text=True, timeout=250)


def rows_of(path):
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


class WithFolder(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))


class Templates(unittest.TestCase):
    """One run of both, in the folder that the tests read."""

    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(cls.enterClassContext(tempfile.TemporaryDirectory()))
        cls.library = cls.folder / "template.so"
        build(HERE / "template.c", cls.library)
        done = bench("--rival", cls.library, "--rival", PIPE, "--body", "cube_12", "--body", "sphere_80", "--ticks", 600, "--way", "hand", "--seeds", 1,
                     "--output", cls.folder, "--export", cls.folder / "files")
        assert done.returncode == 0, done.stdout + done.stderr
        cls.rows = rows_of(cls.folder / "contenders.csv")

    def of(self, contender):
        return [r for r in self.rows if r["contender"] == contender]

    def test_they_are_short(self):
        for name in ("template.c", "template.py"):
            self.assertLess(len((HERE / name).read_text().splitlines()), 80, name)

    def test_both_are_measured_on_every_body_and_ranked(self):
        ranked = rows_of(self.folder / "pareto.csv")
        for name in ("template", "template_pipe"):
            self.assertEqual(["cube_12", "sphere_80"], [r["body"] for r in self.of(name)])
            for row in self.of(name):
                self.assertGreater(float(row["mean_ns"]), 0)
                self.assertGreater(float(row["bytes_per_face"]), 1)
                self.assertGreater(int(row["contact_ticks"]), 50)
            self.assertEqual(2, sum(r["contender"] == name for r in ranked))

    def test_rivals_of_this_folder_take_part_and_hold_the_hand(self):
        """On convex bodies, a millimetre deep: none lets it through, pushes in free air for more than a tick or so, or is off by a fifth
        of the depth."""
        here = {"neighbour_walk", "finger_proxy", "fcl_closest", "bullet_closest", "openvdb_128"} & {r["contender"] for r in self.rows}
        self.assertLessEqual({"neighbour_walk", "finger_proxy"}, here)
        for name in here:
            self.assertEqual(2, len(self.of(name)), name)
            for row in self.of(name):
                self.assertLess(float(row["god_object_rms_m"]), 2e-4, row)
                self.assertEqual("0", row["push_throughs"], row)
                self.assertLess(float(row["phantom_share"]), 0.02, row)
                self.assertGreater(float(row["bytes_per_face"]), 50, row)

    def test_both_are_the_same_method(self):
        for a, b in zip(self.of("template"), self.of("template_pipe")):
            self.assertAlmostEqual(float(a["god_object_rms_m"]), float(b["god_object_rms_m"]), delta=1e-15)

    def test_the_time_of_a_process_is_its_own_not_the_pipes(self):
        """Twelve planes take Python some microseconds; a line there and back takes tens."""
        own_ns = float(self.of("template_pipe")[0]["mean_ns"])
        self.assertLess(own_ns, float(self.of("template_pipe")[0]["batch_ns"]))

    def test_answers_are_judged_from_files_alone_as_by_the_program(self):
        files = sorted((self.folder / "files").glob("*.answers"))
        self.assertEqual(len(files), len(self.rows))
        for path in files:
            found = judge.judge(path)
            body = found["way"].split(".")[0]
            row = next(r for r in self.rows if r["contender"] == found["contender"] and r["body"] == body)
            for column in ("god_object_rms_m", "god_object_rms_judged_m", "god_object_max_m", "force_max_n"):
                self.assertAlmostEqual(found[column], float(row[column]), delta=1e-8 * float(row[column]) + 1e-300, msg=f"{path} {column}")
            for column in ("contact_ticks", "push_throughs"):
                self.assertEqual(found[column], int(row[column]), f"{path} {column}")

    def test_after_a_tie_every_right_answer_is_judged_as_right(self):
        """Into corners exactly, where rounding decides between faces."""
        done = bench("--body", "star_1k", "--way", "corner_dive", "--ticks", 600, "--contender", "fdcg_f64_stored", "--contender", "cgal_closest",
                     "--output", self.folder / "tied", "--export", self.folder / "tied")
        self.assertEqual(0, done.returncode, done.stdout + done.stderr)
        rows = {r["contender"]: r for r in rows_of(self.folder / "tied" / "contenders.csv")}
        self.assertGreater(float(rows["cgal_closest"]["tied_share"]), 0)
        for path in (self.folder / "tied").glob("*.answers"):
            found = judge.judge(path)
            row = rows[found["contender"]]
            self.assertAlmostEqual(found["god_object_rms_judged_m"], float(row["god_object_rms_judged_m"]), delta=1e-8 * found["god_object_rms_m"])
            self.assertEqual(found["push_throughs"], int(row["push_throughs"]))
            self.assertLessEqual(found["god_object_rms_judged_m"], found["god_object_rms_m"])

    def test_a_way_read_from_its_file_is_felt_alike_and_its_truth_is_the_truth(self):
        way = next((self.folder / "files").glob("sphere_80.*.way"))
        done = bench("--way-file", way, "--rival", self.library, "--contender", "template", "--contender", "fdcg_f64_stored", "--output",
                     self.folder / "again")
        self.assertEqual(0, done.returncode, done.stdout + done.stderr)
        again = {r["contender"]: r for r in rows_of(self.folder / "again" / "contenders.csv")}
        self.assertEqual({"template", "fdcg_f64_stored"}, set(again))
        for name, row in again.items():
            before = next(r for r in self.of(name) if r["body"] == "sphere_80")
            self.assertAlmostEqual(float(row["god_object_rms_m"]), float(before["god_object_rms_m"]), delta=1e-16)

    def test_a_truth_that_is_none_fails(self):
        way = next((self.folder / "files").glob("cube_12.*.way"))
        lines = way.read_text().splitlines()
        words = lines[-1].split()
        words[4] = (float.fromhex(words[4]) + 1e-9).hex()
        bad = way.parent / "bad.way"
        bad.write_text("\n".join([*lines[:-1], " ".join(words)]) + "\n")
        done = bench("--way-file", bad, "--contender", "fdcg_f64_stored", "--output", self.folder / "bad")
        self.assertEqual(1, done.returncode, done.stdout + done.stderr)
        self.assertIn("FAIL truth beside the way files'", done.stdout)

    def test_plain_columns_are_a_way_too(self):
        way = next((self.folder / "files").glob("cube_12.*.way"))
        rows = [line.split()[:3] for line in way.read_text().splitlines() if line.startswith(("0x", "-0x"))]
        plain = self.folder / "recorded.traj"
        plain.write_text("# x y z, metres\n" + "".join(" ".join(f"{float.fromhex(w):.17g}" for w in row) + " 7\n" for row in rows))
        done = bench("--way-file", plain, "--mesh", way.parent / "cube_12.off", "--contender", "fdcg_f64_stored", "--output",
                     self.folder / "plain")
        self.assertEqual(0, done.returncode, done.stdout + done.stderr)
        row = rows_of(self.folder / "plain" / "contenders.csv")[0]
        self.assertEqual(("cube_12", "recorded", "600"), (row["body"], row["way"], row["ticks"]))
        self.assertEqual(row["contact_ticks"], self.of("fdcg_f64_stored")[0]["contact_ticks"])

    def test_a_recording_with_the_time_first_in_millimetres_is_the_same_way(self):
        way = next((self.folder / "files").glob("cube_12.*.way"))
        rows = [line.split()[:3] for line in way.read_text().splitlines() if line.startswith(("0x", "-0x"))]
        recorded = self.folder / "recorded.csv"
        recorded.write_text("".join(f"{i / 500},{','.join(f'{1000 * float.fromhex(w):.17g}' for w in row)};0\r\n" for i, row in enumerate(rows)))
        done = bench("--way-file", recorded, "--mesh", way.parent / "cube_12.off", "--hip-column", 2, "--unit-m", 0.001, "--rate-hz", 500,
                     "--contender", "fdcg_f64_stored", "--output", self.folder / "timed")
        self.assertEqual(0, done.returncode, done.stdout + done.stderr)
        row = rows_of(self.folder / "timed" / "contenders.csv")[0]
        self.assertEqual(("600", "500"), (row["ticks"], row["rate_hz"]))
        self.assertEqual(row["contact_ticks"], self.of("fdcg_f64_stored")[0]["contact_ticks"])


class Refused(WithFolder):
    def told(self, *arguments):
        done = bench("--body", "cube_12", "--way", "hand", "--ticks", 200, "--output", self.folder, *arguments)
        self.assertEqual(2, done.returncode, done.stdout + done.stderr)
        return done.stderr

    def changed(self, *changes):
        text = (HERE / "template.c").read_text()
        for old, new in changes:
            self.assertIn(old, text)
            text = text.replace(old, new)
        (self.folder / "changed.c").write_text(text)
        build(self.folder / "changed.c", self.folder / "changed.so", "-Wno-unused-function", "-Wno-unused-parameter")
        return self.folder / "changed.so"

    def test_what_is_no_library(self):
        self.assertIn("nowhere.so", self.told("--rival", self.folder / "nowhere.so"))

    def test_another_abi(self):
        self.assertIn("is not of ABI 1", self.told("--rival", self.changed(("{FDCG_RIVAL_ABI, 0,", "{7, 0,"))))

    def test_our_own_family(self):
        self.assertIn("name another", self.told("--rival", self.changed(('"planes"', '"fdcg"'))))

    def test_a_body_that_does_not_load(self):
        self.assertIn("template does not load cube_12: no memory", self.told("--rival", self.changed(("b == NULL", "b != NULL"))))

    def test_an_answer_that_is_no_number(self):
        self.assertIn("is not finite", self.told("--rival", self.changed(("b->stiffness_n_per_m * offset", "NAN"))))

    def test_a_process_that_ends(self):
        self.assertIn("the process has ended", self.told("--rival", "pipe:true"))

    def test_a_process_that_says_something_else(self):
        self.assertIn("says 'hello', not: ready", self.told("--rival", "pipe:echo hello; cat >/dev/null"))


class Systems(WithFolder):
    COLUMNS = ["body", "faces", "way", "rate_hz", "mu_static", "ticks", "contender", "family", "mean_ns", "p99_ns", "god_object_rms_m",
               "god_object_max_m", "push_throughs", "bytes_per_face", "bake_s"]

    def write(self, name, ours_ns, theirs_ns, error_m):
        rows = [["cube_12", 12, "hand", 1000, 0, 100, "fdcg_f64_stored", "fdcg", ours_ns, 2 * ours_ns, 1e-18, 1e-17, 0, 9, 1],
                ["cube_12", 12, "hand", 1000, 0, 100, "other", "closest_point", theirs_ns, 9, error_m, 1e-4, 3, 9, 1]]
        results = {"tool": "fdcg bench", "bars": [], "facts": {"processor": name, "revision": "abc", "seed": "1"},
                   "tables": {"contenders": {"columns": self.COLUMNS, "rows": rows}}}
        path = self.folder / f"{name}.json"
        path.write_text(json.dumps(results))
        return str(path)

    def merge(self, *paths):
        return subprocess.run([sys.executable, "-B", str(HERE / "systems.py"), *paths], capture_output=True, text=True)

    def test_times_of_two_machines_are_set_against_ours_on_each(self):
        done = self.merge(self.write("fast", 40, 80, 1e-5), self.write("slow", 100, 150, 1e-5))
        self.assertEqual(0, done.returncode, done.stderr)
        rows = list(csv.DictReader(done.stdout.splitlines()))
        self.assertEqual({("fast", "2.0"), ("slow", "1.5")}, {(r["processor"], r["over_fdcg_f64"]) for r in rows if r["contender"] == "other"})

    def test_errors_that_differ_between_runs_are_told(self):
        done = self.merge(self.write("fast", 40, 80, 1e-5), self.write("slow", 100, 150, 2e-5))
        self.assertEqual(1, done.returncode)
        self.assertIn("other on cube_12, hand: 1e-05 m", done.stderr)

    def test_what_is_no_result_is_named(self):
        (self.folder / "x.json").write_text("{}")
        done = self.merge(str(self.folder / "x.json"))
        self.assertEqual(2, done.returncode)
        self.assertIn("x.json", done.stderr)


if __name__ == "__main__":
    unittest.main()
