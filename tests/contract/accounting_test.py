# SPDX-License-Identifier: Apache-2.0
"""Every face of every real file at hand is accounted for: none is lost in silence, nothing crashes or hangs."""
import json
import pathlib
import subprocess
import tempfile
import time
import unittest
import xml.etree.ElementTree

from real_files import count_faces, mesh_files
from support import FDCG, Case

SECONDS_A_FILE = 60  # the largest take about one; only what hangs gets there
# Rules that take faces out, and those that stand for a file without a mesh.
FACE_RULES = ("degenerate-face", "duplicate-face", "index-out-of-range")
FILE_RULES = ("unreadable", "empty-mesh")


class Accounting(Case):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.temporary.cleanup)
        cls.files = mesh_files(cls.temporary.name)

    def validated(self, path):
        """The file's report and exit code."""
        done = subprocess.run((FDCG, "validate", "--format", "json", "-q", str(path)), stdin=subprocess.DEVNULL,
                              capture_output=True, timeout=SECONDS_A_FILE, check=False)
        self.assertIn(done.returncode, (0, 1, 3), f"{path}: {done.stderr[:500]}")
        report = json.loads(done.stdout)["files"]
        self.assertEqual(1, len(report))
        return report[0], done

    def test_every_face_of_every_file_is_kept_or_reported(self):
        read = refused = counted = 0
        slowest = (0, None)
        for path in self.files:
            with self.subTest(file=str(path)):
                start = time.monotonic()
                report, done = self.validated(path)
                slowest = max(slowest, (time.monotonic() - start, path.name))
                totals = {issue["rule"]: issue["total"] for issue in report["issues"]}
                self.assertEqual("fail" if done.returncode else "pass", report["verdict"])
                expected = count_faces(path)
                if done.returncode == 3:
                    refused += 1
                    self.assertEqual(1, len(totals))
                    self.assertIn(next(iter(totals)), FILE_RULES)
                    self.assertEqual(1, done.stderr.count(b"\n"), done.stderr)
                    self.assertIn(path.name.encode(), done.stderr)
                    continue
                read += 1
                self.assertGreater(report["faces"], 0)
                if expected is not None:
                    counted += 1
                    self.assertEqual(expected, report["faces"], "faces in the file, faces in the report")
                lost = report["faces"] - report["kept_faces"]
                reported = [totals.get(rule, 0) for rule in FACE_RULES]
                self.assertGreaterEqual(lost, max(reported))
                if "non-finite-coordinate" not in totals:
                    self.assertLessEqual(lost, sum(reported))
        print(f"{len(self.files)} files: {read} read, {refused} refused, faces of {counted} counted; "
              f"slowest {slowest[1]}, {slowest[0]:.2f} s")

    def test_all_files_in_one_run_give_a_report_of_each_format(self):
        if not self.files:
            return
        names = [str(path) for path in self.files]
        codes = set()
        for output in ("text", "json", "sarif", "junit"):
            done = subprocess.run((FDCG, "validate", "--format", output, "-q", *names), stdin=subprocess.DEVNULL,
                                  capture_output=True, timeout=10 * SECONDS_A_FILE, check=False)
            codes.add(done.returncode)
            if output == "json":
                self.assertEqual(names, [report["file"] for report in json.loads(done.stdout)["files"]])
            elif output == "sarif":
                self.assertEqual("2.1.0", json.loads(done.stdout)["version"])
            elif output == "junit":
                self.assertEqual("testsuites", xml.etree.ElementTree.fromstring(done.stdout).tag)
        self.assertEqual(1, len(codes), codes)
        self.assertLessEqual(codes, {0, 1, 3})


if __name__ == "__main__":
    unittest.main()
