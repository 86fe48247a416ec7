#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The report over what the programs' quick modes have written (FDCG_EVALUATION: their folder), and over broken tables."""
import array
import csv
import gzip
import html
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import unittest.mock

import jsonschema

HERE = pathlib.Path(__file__).resolve().parent
SCHEMA = HERE.parents[2] / "schemas" / "evaluation-results.schema.json"
WRITTEN = os.environ.get("FDCG_EVALUATION", "")


def report(folder, *more):
    return subprocess.run([sys.executable, "-B", str(HERE / "report.py"), str(folder), *more], capture_output=True, text=True)


def raw_of(path):
    return subprocess.run([sys.executable, "-B", str(HERE / "raw.py"), str(path)], capture_output=True, text=True)


def read_rows(path):
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def frontier_of(path):
    return subprocess.run([sys.executable, "-B", str(HERE / "frontier.py"), str(path)], capture_output=True, text=True)


class OfQuickRuns(unittest.TestCase):
    """Needs the tables of all programs."""

    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(WRITTEN)
        done = raw_of(cls.folder)
        assert done.returncode == 0, done.stderr
        environment = [sys.executable, "-B", str(HERE / "environment.py"), os.environ["FDCG_BUILD"], str(cls.folder)]
        subprocess.run(environment, check=True)
        cls.run_ = report(cls.folder, "--mode", "quick", "--seed", "1")
        assert cls.run_.returncode == 0, cls.run_.stderr
        cls.page = (cls.folder / "report.html").read_text(encoding="utf-8")
        cls.results = json.loads((cls.folder / "results.json").read_text(encoding="utf-8"))

    def test_the_page_needs_nothing_else_and_is_small(self):
        self.assertLess(len(self.page.encode()), 5_000_000)
        for attribute in re.findall(r'\b(?:src|href|xlink:href)="([^"]*)"', self.page):
            self.assertTrue(attribute.startswith("#"), attribute)
        self.assertFalse("<script" in self.page or "@import" in self.page)

    def test_every_part_is_there_and_every_figure_says_what_it_shows(self):
        self.assertFalse("Not run." in self.page)
        figures = self.page.count("<figure")
        self.assertGreaterEqual(figures, 8)
        self.assertEqual(len(re.findall(r'role="img" aria-label="[^"]{20,}"', self.page)), figures)

    def test_the_first_page_says_where_we_lose_how_fast_how_wrong_and_the_rest_comes_after(self):
        places = [self.page.index(text) for text in ("Where fdcg loses", "fdcg, f64:", "Cold:", "fastest other, no less exact", 'id="overview"',
                                                     "<nav>", "id=bars", 'id="pareto"', "id=environment")]
        self.assertEqual(places, sorted(places))

    def test_what_was_measured_on_is_recorded(self):
        known = self.results["facts"]["environment"]
        for key in ("processor", "caches", "governor", "load_before", "kernel", "compiler", "flags_of_the_step", "libembree-dev"):
            self.assertIn(key, known)
        self.assertIn("-ffp-contract=off", known["flags_of_the_step"])
        self.assertIn(html.escape(known["flags_of_the_step"]), self.page)

    def test_ids_are_unique(self):
        ids = re.findall(r'\bid="([^"]+)"', self.page)
        self.assertEqual(len(ids), len(set(ids)))

    def test_the_results_keep_their_schema_and_leave_no_row_out(self):
        jsonschema.validate(self.results, json.loads(SCHEMA.read_text(encoding="utf-8")))
        for path in self.folder.glob("*.csv"):
            with open(path, newline="", encoding="utf-8") as file:
                rows = list(csv.reader(file))[1:]
            if path.name.endswith(".bars.csv"):
                named = [b["bar"] for b in self.results["bars"] if b["program"] == path.name[:-len(".bars.csv")]]
                self.assertEqual(named, [r[0] for r in rows])
            else:
                self.assertEqual(len(self.results["tables"][path.stem]["rows"]), len(rows), path)

    def test_the_frontier_computed_anew_is_the_files(self):
        done = frontier_of(self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("fdcg_f64", done.stdout)

    def test_the_frontier_by_every_measured_tick_is_the_files(self):
        done = raw_of(self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        rows = read_rows(self.folder / "pareto_intervals.csv")
        self.assertEqual({(r["body"], r["contender"]) for r in rows},
                         {(r["body"], r["contender"]) for r in read_rows(self.folder / "pareto.csv")})
        for row in rows:
            for key in ("mean_ns", "cold_ns", "god_object_rms_m"):
                low, value, high = (float(row[k]) for k in (f"{key}_low", key, f"{key}_high"))
                self.assertTrue(low <= value * 1.001 and value <= high * 1.001 and low >= 0, row)
            self.assertEqual("4", row["seeds"])
        self.assertTrue(any(float(r["mean_ns_high"]) > float(r["mean_ns_low"]) for r in rows))

    def test_every_bar_is_on_the_page(self):
        self.assertGreater(len(self.results["bars"]), 20)
        self.assertIn("contact ticks that are not judged, largest share", [b["bar"] for b in self.results["bars"]])
        for bar in self.results["bars"]:
            self.assertTrue(html.escape(bar["bar"]) in self.page, bar["bar"])


class OfRawTicks(unittest.TestCase):
    """Of a made-up file: two contenders and a control, 1,000 ticks, ten of them cold."""

    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        (self.folder / "raw").mkdir()

    def write(self, seed, ours_ns=40.0, theirs_ns=80.0, cut=0):
        head = {"format": "fdcg-raw 1", "body": "b", "faces": 12, "way": "hand", "seed": seed, "ticks": 1000, "rounds": 5,
                "swept_bytes": 1, "cold_ticks": list(range(10)),
                "contenders": [{"name": "fdcg_f64_stored", "family": "fdcg", "control": False},
                               {"name": "other", "family": "proxy", "control": False},
                               {"name": "fdcg_f64_stored", "family": "fdcg", "control": True}]}
        numbers = array.array("f", [0] * 2000)
        for ns, error_m in ((ours_ns, 0.0), (theirs_ns, 3e-6), (ours_ns, 0.0)):
            numbers.extend([ns - 1, ns + 1] * 500 + [error_m] * 1000 + [3 * ns] * 10)
        content = (json.dumps(head) + "\n").encode() + numbers.tobytes()
        with gzip.open(self.folder / "raw" / f"b.hand.{seed}.raw.gz", "wb") as file:
            file.write(content[:len(content) - cut])

    def summary(self, theirs_ns="80", on_frontier="no"):
        (self.folder / "pareto.csv").write_text(
            "body,contender,mean_ns,cold_mean_ns,god_object_rms_m,on_frontier\nb,fdcg_f64_stored,40,120,0,yes\n"
            f"b,other,{theirs_ns},240,3e-6,{on_frontier}\n")

    def test_two_ways_make_one_figure_with_its_interval(self):
        self.write(1)
        self.write(2, theirs_ns=90.0)
        self.summary("85")
        (self.folder / "pareto.csv").write_text((self.folder / "pareto.csv").read_text().replace(",240,", ",255,"))
        done = raw_of(self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        other = read_rows(self.folder / "pareto_intervals.csv")[1]
        self.assertEqual(("85", "2.125", "2", "2000"), tuple(other[k] for k in ("mean_ns", "over_ours", "seeds", "ticks")))
        self.assertLess(float(other["mean_ns_low"]), 84)
        self.assertGreater(float(other["mean_ns_high"]), 86)
        self.assertEqual(("no", "no"), (other["on_frontier"], other["cold_on_frontier"]))

    def test_a_summary_that_says_otherwise_is_found_out(self):
        self.write(1)
        self.summary("81", "yes")
        done = raw_of(self.folder)
        self.assertEqual(done.returncode, 1)
        self.assertIn("b, other: mean_ns 81, by its ticks 80", done.stderr)
        self.assertIn("b, other: on_frontier yes, by its ticks no", done.stderr)

    def test_a_file_cut_short_is_named(self):
        self.write(1, cut=8)
        self.summary()
        done = raw_of(self.folder)
        self.assertEqual(done.returncode, 2)
        self.assertIn("b.hand.1.raw.gz: is cut short", done.stderr)

    def test_without_ticks_it_says_who_writes_them(self):
        self.assertEqual(raw_of(self.folder).returncode, 2)


class OfFigures(unittest.TestCase):
    def test_a_line_over_mesh_size_is_of_one_body(self):
        """A smooth sphere and a rough star of equal size take different times: neither stands for the other."""
        sys.path.insert(0, str(HERE))
        import contenders
        from tables import Table
        rows = [{"body": f"{group}_{faces}", "group": group, "faces": faces, "contender": "paper", "family": "paper", "way": "hand",
                 "mu_static": 0, "rate_hz": 1000, "mean_ns": ns, "god_object_rms_m": 1e-9}
                for group, faces, ns in (("sphere", 100, 50), ("sphere", 400, 90), ("star", 100, 70), ("star", 400, 60))]
        table = Table("contenders", list(rows[0]), rows)
        run = unittest.mock.Mock()
        run.table = lambda name: table
        with unittest.mock.patch.object(contenders, "finish", side_effect=lambda name, figure, *_: figure):
            axes = next(contenders.overview(run)).axes[1]
        lines = {line.get_label(): list(zip(*line.get_data())) for line in axes.get_lines()}
        self.assertEqual({"paper, sphere": [(100, 50), (400, 90)], "paper, star": [(100, 70), (400, 60)]}, lines)


class OfLosses(unittest.TestCase):
    """Of made-up times and errors."""
    ROWS = [("fdcg_f64_stored", "fdcg", 100, 0, "no"), ("fdcg_f32_stored", "fdcg", 98, 1e-9, "no"),
            ("paper_vertices", "ablation", 80, 1e-18, "yes"), ("grid_64", "distance_grid", 30, 1e-5, "yes"),
            ("proxy", "proxy", 79.5, 1e-17, "yes"), ("cgal_closest", "closest_point", 500, 1e-18, "no")]

    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))

    def write(self, rows):
        head = "body,group,faces,contender,family,mean_ns,god_object_rms_m,bytes_per_face,bake_s,on_frontier,beaten_by,resolution"
        lines = [f"star_1k,star,1000,{name},{family},{ns},{error},1,1,{best},,0.01" for name, family, ns, error, best in rows]
        (self.folder / "pareto.csv").write_text("\n".join([head, *lines]) + "\n", encoding="utf-8")

    def test_the_frontier_is_of_all_contenders_and_what_is_not_told_apart_does_not_beat(self):
        self.write(self.ROWS)
        done = frontier_of(self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("fdcg_f64_stored is beaten by paper_vertices: 0.80 of its time", done.stdout)
        self.assertNotIn("by grid_64", done.stdout)

    def test_a_file_that_says_otherwise_is_found_out(self):
        self.write([(*row[:4], "yes") for row in self.ROWS])
        done = frontier_of(self.folder)
        self.assertEqual(done.returncode, 1)
        self.assertIn("star_1k, cgal_closest", done.stderr)

    def test_the_report_says_first_where_fdcg_loses(self):
        self.write(self.ROWS)
        done = report(self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        first = re.findall(r"<p>(.*?)</p>", (self.folder / "report.html").read_text(encoding="utf-8"))[0]
        self.assertIn("Where fdcg loses", first)
        self.assertIn("f64 on 1 of 1 bodies (1,000 faces), at worst to proxy, which takes 0.80 of its time", first)
        self.assertIn("also to paper_vertices", first)

    def test_where_nobody_is_as_exact_and_faster_it_says_that(self):
        self.write([row for row in self.ROWS if row[0] in ("fdcg_f64_stored", "grid_64", "cgal_closest")])
        self.assertEqual(report(self.folder).returncode, 0)
        self.assertIn("no less exact: nowhere.", (self.folder / "report.html").read_text(encoding="utf-8"))


class OfPublished(unittest.TestCase):
    """The figures of README and docs, and the tables that they are made of."""

    def setUp(self):
        sys.path.insert(0, str(HERE))
        import publish
        self.publish = publish

    def test_every_figure_is_the_tables(self):
        done = subprocess.run([sys.executable, "-B", str(HERE / "publish.py"), "--check"], capture_output=True, text=True)
        self.assertEqual(0, done.returncode, done.stderr)

    def test_a_figure_that_is_not_is_found_out(self):
        folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        shutil.copytree(self.publish.KEPT, folder, dirs_exist_ok=True)
        rows = read_rows(self.publish.KEPT / "pareto.csv")
        for row in rows:
            if row["contender"] == "fdcg_f64_stored" and row["faces"] == "12":
                row["mean_ns"] = str(float(row["mean_ns"]) + 1)
        with open(folder / "pareto.csv", "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, rows[0].keys())
            writer.writeheader()
            writer.writerows(rows)
        with unittest.mock.patch.object(self.publish, "KEPT", folder), unittest.mock.patch("sys.stderr") as told:
            self.assertEqual(1, self.publish.check())
        said = "".join(call.args[0] for call in told.write.call_args_list)
        self.assertIn("README.md: figures 'step times'", said)
        self.assertIn("docs/benchmarks.md: figures 'times'", said)

    def test_the_frontier_of_the_tables_is_what_they_say(self):
        done = frontier_of(self.publish.KEPT)
        self.assertEqual(0, done.returncode, done.stderr)

    def test_a_hair_between_rounded_figures_is_judged_anew(self):
        rows = [{"body": "ball", "god_object_rms_m": 1e-9, "mean_ns": ns, "resolution": 0.02886, "on_frontier": "yes"} for ns in (27.69, 28.49)]
        self.assertEqual(["yes", "no"], [r["on_frontier"] for r in self.publish.judged_anew(rows)])

    def test_what_they_were_measured_on_is_kept(self):
        known = json.loads((self.publish.KEPT / "environment.json").read_text(encoding="utf-8"))
        self.assertTrue({"processor", "compiler", "load_before", "revision"} <= set(known))

    def test_a_run_of_hands_alone_renews_its_tables_and_no_other(self):
        run, kept = (pathlib.Path(self.enterContext(tempfile.TemporaryDirectory())) for _ in range(2))
        for name in ("hands", "hands_limits"):
            (run / f"{name}.csv").write_text((self.publish.KEPT / f"{name}.csv").read_text())
        (run / "hands_traces.csv").write_text("scene,contender,time_s,hand_n,off_n\n")
        with unittest.mock.patch.object(self.publish, "KEPT", kept):
            self.publish.take(run)
        self.assertEqual({"hands.csv", "hands_limits.csv"}, {p.name for p in kept.iterdir()})
        for path in kept.iterdir():
            self.assertEqual((self.publish.KEPT / path.name).read_text(), path.read_text())

    def test_a_run_that_lacks_a_table_is_refused(self):
        folder = self.enterContext(tempfile.TemporaryDirectory())
        done = subprocess.run([sys.executable, "-B", str(HERE / "publish.py"), folder], capture_output=True, text=True)
        self.assertEqual(2, done.returncode)
        self.assertIn("lacks pareto.csv", done.stderr)


class OfBrokenFolders(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))

    def test_an_empty_folder_is_wrong_usage(self):
        done = report(self.folder)
        self.assertEqual(done.returncode, 2)
        self.assertIn("tools/bench", done.stderr)

    def test_a_row_cut_short_names_file_and_line(self):
        (self.folder / "t.csv").write_text("a,b\n1,2\n3\n", encoding="utf-8")
        done = report(self.folder)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("t.csv:3", done.stderr)
        self.assertFalse((self.folder / "report.html").exists())

    def test_a_part_that_was_not_run_is_said_so_and_a_failed_bar_comes_first(self):
        (self.folder / "p.bars.csv").write_text("bar,measured,relation,limit,unit,verdict,note\nholds <too>,1,at most,2,s,ok,\n"
                                                "bad <one>,nan,at most,2,s,FAIL,why\n", encoding="utf-8")
        done = report(self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        text = (self.folder / "report.html").read_text(encoding="utf-8")
        self.assertIn("Not run.", text)
        self.assertLess(text.index("bad &lt;one&gt;"), text.index("holds &lt;too&gt;"))
        self.assertIsNone(json.loads((self.folder / "results.json").read_text())["bars"][1]["measured"])


if __name__ == "__main__":
    unittest.main()
