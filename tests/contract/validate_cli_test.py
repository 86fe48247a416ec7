# SPDX-License-Identifier: Apache-2.0
"""fdcg validate as CI systems use it: formats, baselines, settings files, many files, standard input. One class a subject, which
makes it a little longer than 400 lines."""
import base64
import json
import os
import pathlib
import pty
import random
import resource
import shutil
import struct
import subprocess
import unittest
import xml.etree.ElementTree

import jsonschema

from support import CUBE, FDCG, ROOT, TETRAHEDRON, Case

MISSING_FACE = CUBE.replace("8 6 0", "8 5 0").replace("4 3 0 4 7\n", "")
THREE_ON_AN_EDGE = "OFF\n5 3 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n0 -1 0\n3 0 1 2\n3 1 0 3\n3 0 1 4\n"
REPORT_SCHEMA = json.loads((ROOT / "schemas/validate-report.schema.json").read_text())
CONFIG_SCHEMA = json.loads((ROOT / "schemas/validate-config.schema.json").read_text())
CONFIG = ".fdcg-validate.json"


def official_schema(name):
    """Its path, or None where it is not at hand: the tests then check what they can themselves."""
    folder = pathlib.Path(os.environ.get("FDCG_SCHEMAS", ROOT / "../shared/reference/schemas"))
    return folder / name if (folder / name).is_file() else None


def open_strip(quads, shift=0):
    """A strip of triangles, every one with a boundary edge of its own; no two alike."""
    lines = [f"v {i + shift} {j} {(i * i) % 7}" for i in range(quads + 1) for j in (0, 1)]
    for i in range(quads):
        a, b, c, d = (2 * i + k + 1 for k in range(4))
        lines += [f"f {a} {c} {b}", f"f {b} {c} {d}"]
    return "\n".join(lines) + "\n"


class ValidateCase(Case):
    def validate(self, *arguments, code=0, **options):
        return self.fdcg("validate", *arguments, code=code, **options)

    def report(self, *arguments, code=0, **options):
        report = json.loads(self.validate("--format", "json", *arguments, code=code, **options).stdout)
        jsonschema.validate(report, REPORT_SCHEMA)
        return report

    def issues(self, *arguments, code=0, **options):
        return {issue["rule"]: issue for issue in self.report(*arguments, code=code, **options)["files"][0]["issues"]}

    def read_json(self, name):
        return json.loads((self.folder / name).read_text())


class Formats(ValidateCase):
    def meshes(self):
        odd = self.folder / os.fsdecode(b"a \xff&<]]>\n\x1b.obj")
        odd.write_text(open_strip(200))
        return [self.write("cube.off", CUBE), str(odd), self.write("fan.off", THREE_ON_AN_EDGE), self.write("bad.off", "OFF\n1"),
                self.path("missing.stl")]

    def test_every_format_in_one_run_with_every_file_in_each(self):
        meshes = self.meshes()
        text = self.validate(*meshes, "--format", "json=r.json", "--format", "sarif=r.sarif", "--format", "junit=r.xml", "--full",
                             "full.json", code=3, cwd=self.folder).stdout
        self.assertIn(b"5 files: 2 pass, 3 fail\n", text)
        self.assertNotIn(b"\x1b", text)
        report, full = self.read_json("r.json"), self.read_json("full.json")
        for document in (report, full):
            jsonschema.validate(document, REPORT_SCHEMA)
            self.assertEqual(["pass", "pass", "fail", "fail", "fail"], [file["verdict"] for file in document["files"]])
        self.check_sarif(report)
        self.check_junit(report)
        strip, whole = ({issue["rule"]: issue for issue in document["files"][1]["issues"]} for document in (report, full))
        self.assertEqual(402, strip["boundary-edge"]["total"])
        self.assertEqual(100, len(strip["boundary-edge"]["elements"]))
        self.assertEqual(402, len(whole["boundary-edge"]["elements"]))
        self.assertEqual(strip["boundary-edge"]["elements"], whole["boundary-edge"]["elements"][:100])

    def check_sarif(self, report):
        sarif = self.read_json("r.sarif")
        if schema := official_schema("sarif-schema-2.1.0.json"):
            jsonschema.validate(sarif, json.loads(schema.read_text()))
        run = sarif["runs"][0]
        self.assertEqual({"exitCode": 3, "executionSuccessful": False}, run["invocations"][0])
        uris = [artifact["location"]["uri"] for artifact in run["artifacts"]]
        self.assertEqual(["cube.off", "a%20%FF%26%3C%5D%5D%3E%0A%1B.obj", "fan.off", "bad.off", "missing.stl"], uris)
        wanted = [(uris[i], issue["rule"], issue["severity"], issue["total"]) for i, file in enumerate(report["files"])
                  for issue in file["issues"]]
        found = [(result["locations"][0]["physicalLocation"]["artifactLocation"]["uri"], result["ruleId"], result["level"],
                  result["occurrenceCount"]) for result in run["results"]]
        self.assertEqual(wanted, found)
        issues = [issue for file in report["files"] for issue in file["issues"]]
        for issue, result in zip(issues, run["results"]):
            lines = [element.get("line", 1) for element in issue["elements"]] or [1]
            self.assertEqual(lines, [location["physicalLocation"]["region"]["startLine"] for location in result["locations"]])
            self.assertEqual(issue["rule"], run["tool"]["driver"]["rules"][result["ruleIndex"]]["id"])

    def check_junit(self, report):
        schema = official_schema("junit.xsd")
        if schema and shutil.which("xmllint"):
            self.run_program("xmllint", "--noout", "--schema", str(schema), self.path("r.xml"))
        suites = xml.etree.ElementTree.parse(self.path("r.xml")).getroot()
        self.assertEqual(len(report["files"]), len(suites))
        for suite, file in zip(suites, report["files"]):
            cases = suite.findall("testcase")
            self.assertEqual(file["checks"], [case.get("name") for case in cases])
            failing = [issue["rule"] for issue in file["issues"] if issue["severity"] == "error"]
            self.assertEqual(failing, [case.get("name") for case in cases if len(case)])
            self.assertEqual(len(failing), int(suite.get("failures")) + int(suite.get("errors")))
            for issue in file["issues"]:
                if issue["severity"] != "error":
                    self.assertIn(issue["message"], suite.find("system-out").text)

    def test_sarif_for_each_finding_marks_each_line_and_keeps_the_sum(self):
        mesh = self.write("strip.obj", open_strip(200))
        self.validate(mesh, "--format", "sarif", "--sarif-each", "-o", self.path("r.sarif"))
        sarif = self.read_json("r.sarif")
        if schema := official_schema("sarif-schema-2.1.0.json"):
            jsonschema.validate(sarif, json.loads(schema.read_text()))
        results = [result for result in sarif["runs"][0]["results"] if result["ruleId"] == "boundary-edge"]
        self.assertEqual(402, sum(result["occurrenceCount"] for result in results))
        self.assertEqual(101, len(results))
        lines = [result["locations"][0]["physicalLocation"]["region"]["startLine"] for result in results]
        self.assertEqual([element["line"] for element in self.issues(mesh)["boundary-edge"]["elements"]] + [1], lines)

    def test_a_report_of_very_many_findings_stays_small_and_the_full_one_has_them_all(self):
        quads = int(os.environ.get("FDCG_TEST_FINDINGS", "40000")) // 4
        lines = ["OFF", f"{4 * quads} {quads} 0"]
        lines += [f"{3 * i + a} {b} 0" for i in range(quads) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
        lines += [f"4 {4 * i} {4 * i + 1} {4 * i + 2} {4 * i + 3}" for i in range(quads)]
        mesh = self.write("many.off", "\n".join(lines) + "\n")
        self.validate(mesh, "--format", "json", "-o", self.path("r.json"), "--format", "sarif=" + self.path("r.sarif"),
                      "--format", "junit=" + self.path("r.xml"), "--full", self.path("full.json"))
        for name in ("r.json", "r.sarif", "r.xml"):
            self.assertLess(os.path.getsize(self.path(name)), 1_000_000, name)
        listed = {issue["rule"]: issue for issue in self.read_json("r.json")["files"][0]["issues"]}["boundary-edge"]
        self.assertEqual((4 * quads, 100), (listed["total"], len(listed["elements"])))
        full = {issue["rule"]: issue for issue in self.read_json("full.json")["files"][0]["issues"]}["boundary-edge"]
        self.assertEqual([4 * quads] * 2, [full["total"], len(full["elements"])])
        self.assertEqual(4 * quads, len({tuple(map(tuple, element["edges"])) for element in full["elements"]}))
        # and every one of them is known to the next run
        known = self.issues(mesh, "--baseline", self.path("full.json"), "--fail-on", "note")["boundary-edge"]
        self.assertEqual(4 * quads, known["known"])

    def test_text_is_coloured_on_a_terminal_alone_and_not_where_no_color_forbids_it(self):
        mesh = self.write("open.off", MISSING_FACE)
        for environment, has_colour in (({}, True), ({"NO_COLOR": "1"}, False), ({"TERM": "dumb"}, False)):
            master, slave = pty.openpty()
            variables = {key: value for key, value in os.environ.items() if key != "NO_COLOR"}
            subprocess.run([FDCG, "validate", mesh], stdout=slave, stdin=subprocess.DEVNULL, check=True, timeout=60,
                           env=variables | {"TERM": "xterm"} | environment)
            os.close(slave)
            text = os.read(master, 65536)
            os.close(master)
            self.assertIn(b"boundary-edge", text)
            self.assertEqual(has_colour, b"\033[" in text, environment)

    def test_a_name_in_a_mesh_does_not_steer_the_terminal(self):
        text = self.validate(self.write("open.obj", "g \x1b[31mred\x07\n" + open_strip(1))).stdout
        self.assertNotIn(b"\x1b", text)
        self.assertNotIn(b"\x07", text)

    def test_quiet_text_names_files_that_fail_alone(self):
        good, bad = self.write("cube.off", CUBE), self.write("fan.off", THREE_ON_AN_EDGE)
        self.assertEqual(b"", self.validate(good, "-q").stdout)
        text = self.validate(good, bad, "-q", code=1).stdout
        self.assertNotIn(b"cube.off", text)
        self.assertIn(b"fan.off: fail", text)


class Baselines(ValidateCase):
    def test_known_findings_pass_new_ones_fail_and_come_first(self):
        mesh, base = self.write("strip.obj", open_strip(200)), self.path("base.json")
        self.validate(mesh, "--full", base, "--fail-on", "warning", code=1)
        known = self.report(mesh, "--baseline", base, "--fail-on", "warning")["files"][0]
        self.assertEqual("pass", known["verdict"])
        self.assertEqual({}, known["resolved"])
        self.assertEqual([issue["total"] for issue in known["issues"]], [issue["known"] for issue in known["issues"]])
        # 7 more vertices at the end; the 402 known edges but the last are still there
        self.write("strip.obj", open_strip(207))
        worse = self.report(mesh, "--baseline", base, "--fail-on", "warning", code=1)["files"][0]
        edges = {issue["rule"]: issue for issue in worse["issues"]}["boundary-edge"]
        self.assertEqual((416, 401), (edges["total"], edges["known"]))
        self.assertEqual([False] * 15 + [True] * 85, ["known" in element for element in edges["elements"]])
        self.assertEqual({"boundary-edge": 1}, worse["resolved"])
        text = self.validate(mesh, "--baseline", base).stdout
        self.assertIn(b"boundary-edge (401 known)", text)
        self.assertIn(b"resolved since the baseline: 1 boundary-edge", text)

    def test_renumbering_the_file_leaves_every_finding_known(self):
        mesh, base = self.write("strip.obj", open_strip(50)), self.path("base.json")
        self.validate(mesh, "--full", base)
        lines = open_strip(50).splitlines()
        points, faces = [line for line in lines if line[0] == "v"], [line for line in lines if line[0] == "f"]
        order = list(range(len(points)))
        random.Random(20).shuffle(order)
        number = {old + 1: new + 1 for new, old in enumerate(order)}
        random.Random(21).shuffle(faces)
        faces = ["f " + " ".join(str(number[int(v)]) for v in face.split()[1:]) for face in faces]
        self.write("strip.obj", "\n".join([points[i] for i in order] + faces) + "\n")
        edges = self.issues(mesh, "--baseline", base, "--fail-on", "warning")["boundary-edge"]
        self.assertEqual((102, 102), (edges["total"], edges["known"]))

    def test_another_format_leaves_every_finding_known(self):
        """Decimals in text, floats in binary: the same mesh."""
        points = [(x / 10, y / 7, 0.1 * x * y) for x in range(6) for y in range(2)]
        faces = [face for a in range(0, 10, 2) for face in ((a, a + 2, a + 1), (a + 1, a + 2, a + 3))]
        (self.folder / "before").mkdir()
        (self.folder / "after").mkdir()
        for name in ("a", "b"):
            self.write(f"before/{name}.obj", "".join(f"v {x!r} {y!r} {z!r}\n" for x, y, z in points) +
                       "".join("f " + " ".join(str(v + 1) for v in face) + "\n" for face in faces))
            header = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\nproperty float x\nproperty float y\nproperty float z\n"
                      f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n")
            self.write(f"after/{name}.ply", header.encode() + b"".join(struct.pack("<3f", *point) for point in points) +
                       b"".join(struct.pack("<B3i", 3, *face) for face in faces))
        base = self.path("base.json")
        self.validate(self.path("before"), "--full", base)
        self.validate(self.path("after"), "--baseline", base, "--fail-on", "note")
        for file in self.report(self.path("after"), "--baseline", base)["files"]:
            self.assertEqual([issue["total"] for issue in file["issues"]], [issue["known"] for issue in file["issues"]])
            self.assertEqual({}, file["resolved"])

    def test_copies_of_one_finding_are_counted(self):
        triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
        mesh, base = self.write("mesh.obj", triangle + "f 1 2 3\n"), self.path("base.json")
        self.validate(mesh, "--full", base, code=1)
        self.validate(mesh, "--baseline", base)
        self.write("mesh.obj", triangle + "f 1 2 3\nf 1 2 3\n")
        issues = self.issues(mesh, "--baseline", base, code=1)
        self.assertEqual((2, 1), (issues["duplicate-face"]["total"], issues["duplicate-face"]["known"]))

    def test_files_are_told_apart_and_found_again_after_a_move(self):
        strips = {"one/a.obj": open_strip(3), "one/b.obj": open_strip(3), "two/a.obj": open_strip(4)}
        for name, content in strips.items():
            (self.folder / name).parent.mkdir(exist_ok=True)
            self.write(name, content)
        base = self.path("base.json")
        self.validate("one", "two", "--full", "base.json", cwd=self.folder)
        for arguments in (("one", "two"), ("./two/../one/a.obj",), (self.path("one/b.obj"),)):
            for file in self.report(*arguments, "--baseline", base, "--fail-on", "warning", cwd=self.folder)["files"]:
                self.assertEqual({}, file["resolved"])
        # a copy under another name is new: the first one's findings are its own
        shutil.copy(self.path("one/b.obj"), self.path("one/c.obj"))
        verdicts = [file["verdict"] for file in self.report("one", "two", "--baseline", base, "--fail-on", "warning", code=1,
                                                            cwd=self.folder)["files"]]
        self.assertEqual(["pass", "pass", "fail", "pass"], verdicts)
        # a moved file keeps its name
        os.remove(self.path("one/c.obj"))
        os.rename(self.path("one/b.obj"), self.path("two/b.obj"))
        self.report("one", "two", "--baseline", base, "--fail-on", "warning", cwd=self.folder)

    def test_a_single_file_of_another_name_is_compared(self):
        base = self.path("base.json")
        self.validate(self.write("old.obj", open_strip(3)), "--full", base)
        self.validate(self.write("new.obj", open_strip(3)), "--baseline", base, "--fail-on", "warning")

    def test_a_short_json_report_serves_and_a_capped_one_is_refused_with_the_remedy(self):
        mesh, base = self.write("strip.obj", open_strip(3)), self.path("base.json")
        self.validate(mesh, "--format", "json", "-o", base)
        self.validate(mesh, "--baseline", base, "--fail-on", "warning")
        self.write("strip.obj", open_strip(200))
        self.validate(mesh, "--format", "json", "-o", base)
        self.assert_one_line(self.validate(mesh, "--baseline", base, code=2), "base.json", "boundary-edge", "100 of the 402", "--full")

    def test_the_order_of_members_does_not_matter(self):
        mesh, base = self.write("strip.obj", open_strip(3)), self.path("base.json")
        self.validate(mesh, "--full", base)
        (self.folder / "base.json").write_text(json.dumps(self.read_json("base.json"), sort_keys=True, indent=3))
        self.validate(mesh, "--baseline", base, "--fail-on", "warning")

    def test_what_is_no_baseline_is_refused(self):
        mesh = self.write("cube.off", CUBE)
        for name, content, code, words in (
                ("none.json", None, 3, ("none.json", "--full")), ("empty.json", "", 3, ("no JSON",)), ("cut.json", '{"tool": "fdcg", ', 3, ("no JSON",)),
                ("other.json", "{}", 3, ("no report",)), ("list.json", "[]", 3, ("no report",)),
                ("print.json", '{"tool": "fdcg", "files": [{"issues": [{"elements": [{"fingerprint": "xyz"}]}]}]}', 3, ("xyz",))):
            path = self.path(name) if content is None else self.write(name, content)
            self.assert_one_line(self.validate(mesh, "--baseline", path, code=code), *words)
        self.assert_one_line(self.validate(mesh, "--baseline", str(self.folder), code=3), str(self.folder))

    def test_a_baseline_may_be_refreshed_in_place(self):
        mesh, base = self.write("strip.obj", open_strip(3)), self.path("base.json")
        self.validate(mesh, "--full", base)
        self.write("strip.obj", open_strip(5))
        self.validate(mesh, "--baseline", base, "--full", base, "--fail-on", "warning", code=1)
        self.validate(mesh, "--baseline", base, "--fail-on", "warning")


class Settings(ValidateCase):
    def test_the_nearest_file_upwards_counts_and_is_named(self):
        (self.folder / "a/b").mkdir(parents=True)
        for name in ("open.off", "a/open.off", "a/b/open.off"):
            self.write(name, MISSING_FACE)
        self.write(CONFIG, '{"fail-on": "warning"}')
        self.write("a/" + CONFIG, '{"severity": {"boundary-edge": "error"}}')
        files = self.report("open.off", "a/open.off", "a/b/open.off", code=1, cwd=self.folder)["files"]
        self.assertEqual([CONFIG, "a/" + CONFIG, "a/" + CONFIG], [file["config"] for file in files])
        self.assertEqual(["warning", "error", "error"], [file["fail_on"] for file in files])
        self.assertEqual(["warning", "error", "error"], [file["issues"][0]["severity"] for file in files])
        self.assertEqual(["fail"] * 3, [file["verdict"] for file in files])
        self.assertIn(b"settings: a/" + CONFIG.encode(), self.validate("a/b/open.off", code=1, cwd=self.folder).stdout)
        for options in (("--no-config",), ("--config", self.write("other.json", "{}"))):
            self.assertEqual("pass", self.report("a/open.off", *options, cwd=self.folder)["files"][0]["verdict"])

    def test_every_key_does_what_its_option_does_and_the_command_line_overrides_it(self):
        mesh = self.write("open.off", MISSING_FACE)
        base = self.path("base.json")
        self.validate(mesh, "--full", base)
        for settings, options, code in (
                ({}, (), 0), ({"fail-on": "warning"}, (), 1), ({"fail-on": "warning"}, ("--fail-on", "error"), 0),
                ({"fail-on": "warning", "allow": ["boundary-edge"]}, (), 0), ({"severity": {"boundary-edge": "error"}}, (), 1),
                ({"severity": {"boundary-edge": "error"}}, ("--severity", "boundary-edge=note"), 0),
                ({"severity": {"boundary-edge": "off"}, "fail-on": "warning"}, (), 0), ({"fail-on": "never"}, ("--fail-on", "warning"), 1),
                ({"fail-on": "warning", "baseline": "base.json"}, (), 0), ({"weld": "none"}, (), 0), ({"weld": 1.5}, (), 1),
                ({"weld": 1.5}, ("--weld", "exact"), 0), ({"$schema": "x"}, (), 0)):
            with self.subTest(settings=settings, options=options):
                jsonschema.validate(settings, CONFIG_SCHEMA)
                self.write(CONFIG, json.dumps(settings))
                self.validate(mesh, *options, code=code)

    def test_a_wrong_file_is_an_error_that_names_file_key_and_what_is_right(self):
        mesh = self.write("cube.off", CUBE)
        for text, words in (
                ('{"fail_on": "error"}', ("'fail_on'", "did you mean 'fail-on'", "allow, baseline")), ('{"severty": {}}', ("'severity'",)),
                ('{"fail-on": "always"}', ("always", "error, warning, note, never")), ('{"fail-on": 3}', ("fail-on is 3", "a text")),
                ('{"allow": "boundary-edge"}', ("allow is", "a list")), ('{"allow": ["boundry-edge"]}', ("allow[0]: ", "did you mean 'boundary-edge'",)),
                ('{"allow": ["non-manifold-edge"]}', ("cannot be allowed",)), ('{"severity": {"boundary-edge": "fatal"}}', ("severity.boundary-edge: 'fatal'", "off")),
                ('{"severity": {"nonsense": "off"}}', ("no rule",)), ('{"severity": {"unreadable": "off"}}', ("exit code 3",)),
                ('{"severity": []}', ("object",)), ('{"weld": -1}', ("weld is -1", "above 0")), ('{"weld": "some"}', ('weld is "some"', "exact")),
                ('{"baseline": ""}', ('baseline is ""',)), ('{"allow": [], "allow": []}', ("twice",)), ('[]', ("object",)), ('{', ("no JSON",)),
                ("", ("no JSON",))):
            with self.subTest(text=text):
                self.write(CONFIG, text)
                done = self.validate(mesh, "--format", "json", "-o", self.path("r.json"), code=2)
                self.assert_one_line(done, CONFIG, *words)
                self.assert_only(CONFIG, "cube.off")
                self.validate(mesh, "--no-config")
        self.write(CONFIG, "{}")
        self.assert_one_line(self.validate(mesh, "--config", self.path("none.json"), code=3), "none.json", "does not exist")
        self.assert_one_line(self.validate(mesh, "--config", self.path("."), code=3), "is a directory")
        os.unlink(self.path(CONFIG))
        os.mkdir(self.path(CONFIG))
        self.assert_one_line(self.validate(mesh, code=3), CONFIG, "is a directory")
        self.validate(mesh, "--no-config")

    def test_severities_of_the_command_line_reach_every_format(self):
        mesh = self.write("open.off", MISSING_FACE)
        self.validate(mesh, "--severity", "boundary-edge=error", "--format", "sarif", "-o", self.path("r.sarif"), code=1)
        self.assertEqual("error", self.read_json("r.sarif")["runs"][0]["results"][0]["level"])
        self.assertNotIn("boundary-edge", self.report(mesh, "--severity", "boundary-edge=off")["files"][0]["checks"])

    def test_an_error_that_no_graph_can_stand_is_not_lowered_without_a_word(self):
        fan = self.write("fan.off", "OFF\n5 3 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n0 -1 0\n3 0 1 2\n3 1 0 3\n3 0 1 4\n")
        self.fdcg("compile", fan, "-o", self.path("fan.fdcg"), code=1)
        off = ("--severity", "non-manifold-edge=off", "--severity", "winding-inconsistent=off")
        for more in ((), ("-q",)):
            done = self.validate(fan, *off, *more)
            self.assert_one_line(done, "non-manifold-edge, winding-inconsistent are no error", "'fdcg compile' refuses")
        self.assertEqual(b"", self.validate(fan, "--severity", "boundary-edge=off", code=1).stderr)
        self.write(CONFIG, '{"severity": {"non-manifold-edge": "note"}}')
        self.assert_one_line(self.validate(fan, fan), "non-manifold-edge is no error")


class ManyFiles(ValidateCase):
    def test_a_file_too_large_for_memory_leaves_the_others_their_reports(self):
        limit = 160 << 20
        large = self.folder / "large.off"
        with large.open("wb") as file:
            file.truncate(4 * limit)
        done = subprocess.run((FDCG, "validate", str(large), self.write("cube.off", CUBE), "--format", "json", "--jobs", "1", "--no-config"),
                              capture_output=True, check=False,
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)))
        self.assertEqual(3, done.returncode, done.stderr)
        self.assert_one_line(done, "large.off", "memory")
        self.assertEqual(["fail", "pass"], [file["verdict"] for file in json.loads(done.stdout)["files"]])

    def test_what_has_no_end_is_refused_at_once(self):
        done = subprocess.run((FDCG, "validate", "/dev/zero", "--no-config"), capture_output=True, check=False, timeout=10)
        self.assertEqual(3, done.returncode, done.stderr)
        self.assert_one_line(done, "/dev/zero", "device")
        with subprocess.Popen(("yes", "v 0 0 0"), stdout=subprocess.PIPE) as endless:
            done = subprocess.run((FDCG, "validate", "-", "--no-config"), stdin=endless.stdout, capture_output=True, check=False, timeout=30)
            endless.kill()
        self.assertEqual(3, done.returncode, done.stderr)
        self.assert_one_line(done, "64 MiB")

    def test_a_buffer_that_is_a_link_out_of_the_folder_is_not_read(self):
        document = json.loads((ROOT / "testdata/meshes/good/cube_embedded.gltf").read_text())
        bytes_of_buffer = base64.b64decode(document["buffers"][0]["uri"].partition(",")[2])
        document["buffers"][0]["uri"] = "cube.bin"
        folder = self.folder / "models"
        folder.mkdir()
        (folder / "cube.gltf").write_text(json.dumps(document))
        (self.folder / "secret.bin").write_bytes(bytes_of_buffer)
        (folder / "cube.bin").symlink_to(self.folder / "secret.bin")
        done = subprocess.run((FDCG, "validate", str(folder / "cube.gltf"), "--no-config"), capture_output=True, check=False)
        self.assertEqual(3, done.returncode, done.stderr)
        self.assert_one_line(done, "cube.bin", "link")
        (folder / "cube.bin").unlink()
        (folder / "real.bin").write_bytes(bytes_of_buffer)
        (folder / "cube.bin").symlink_to("real.bin")
        done = subprocess.run((FDCG, "validate", str(folder / "cube.gltf"), "--no-config"), capture_output=True, check=False)
        self.assertEqual(0, done.returncode, done.stderr)

    def test_stacked_faces_are_counted_up_to_a_limit(self):
        faces = 3_000
        stack = f"OFF\n3 {faces} 0\n0 0 0\n1 0 0\n0 1 0\n" + "3 0 1 2\n" * faces
        done = subprocess.run((FDCG, "validate", self.write("stack.off", stack), "--format", "json", "--no-config"), capture_output=True, check=False)
        found = {issue["rule"]: issue for issue in json.loads(done.stdout)["files"][0]["issues"]}["self-intersection"]
        self.assertEqual((1_000_000, True), (found["total"], found["at_least"]))
        self.assertIn("at least", found["message"])
        once = subprocess.run((FDCG, "validate", self.path("stack.off"), "--format", "json", "--no-config", "--jobs", "1"), capture_output=True,
                              check=False)
        self.assertEqual(done.stdout, once.stdout)

    def test_files_come_in_a_stable_order_however_many_threads_there_are(self):
        (self.folder / "sub").mkdir()
        chooser = random.Random(5)
        for i in range(40):
            size = chooser.choice((1, 2, 30, 3000))
            self.write(f"{'sub/' if i % 3 else ''}m{i:02}.obj", open_strip(size, i))
        outputs = set()
        for jobs in ("1", "2", "7"):
            done = self.validate("**/*.obj", "--format", "json", "--full", "full.json", "--jobs", jobs, cwd=self.folder)
            outputs.add((done.stdout, (self.folder / "full.json").read_bytes()))
        self.assertEqual(1, len(outputs))
        names = [file["file"] for file in json.loads(outputs.pop()[0])["files"]]
        self.assertEqual(40, len(names))
        self.assertEqual(sorted(names), names)
        walked = [file["file"] for file in self.report(".", cwd=self.folder)["files"]]
        self.assertEqual(["./" + name for name in names], walked)

    def test_an_argument_that_names_no_file_is_in_every_report(self):
        os.mkdir(self.path("empty"))
        cube = self.write("cube.off", CUBE)
        for argument, word in ((self.path("*.stl"), "matches no file"), (self.path("empty"), "directory"), (self.path("no.stl"), "opened")):
            done = self.validate(cube, argument, "--format", "json", code=3)
            self.assert_one_line(done, argument, word)
            files = json.loads(done.stdout)["files"]
            self.assertEqual([cube, argument], [file["file"] for file in files])
            self.assertEqual("unreadable", files[1]["issues"][0]["rule"])

    def test_wrong_options_name_the_right_ones(self):
        mesh = self.write("cube.off", CUBE)
        for arguments, words in (
                (("--formt", "json"), ("--format",)), (("--base-line=x",), ("--baseline",)), (("--format", "jsn"), ("did you mean 'json'", "sarif")),
                (("--format", "json", "--format", "text"), ("two formats", "--format text=FILE")), (("--format", "json="), ("empty",)),
                (("--fail-on", "eror"), ("did you mean 'error'",)), (("--severity", "boundary-edge"), ("RULE=LEVEL",)),
                (("--severity", "boundry-edge=off"), ("did you mean 'boundary-edge'",)), (("--severity", "boundary-edge=of"), ("did you mean 'off'",)),
                (("--severity", "empty-mesh=off"), ("exit code 3",)), (("--allow", "boundry-edge"), ("did you mean 'boundary-edge'",)),
                (("--input-format", "st"), ("did you mean 'stl'",)), (("--jobs", "0"), ("--jobs",)),
                (("--format", "json=a", "--full", "a"), ("'a'", "another")), (("--full", mesh), ("overwrite",)),
                (("--format", f"json={mesh}"), ("overwrite",)), (("--no-config", "--config", "x"), ("--config",))):
            with self.subTest(arguments=arguments):
                done = self.validate(mesh, *arguments, code=2, cwd=self.folder)
                self.assert_one_line(done, *words)
                self.assertEqual(b"", done.stdout)
                self.assert_only("cube.off")
        self.assert_one_line(self.fdcg("valdate", mesh, code=2), "did you mean 'validate'")

    def test_outputs_that_cannot_be_written_are_code_3_and_leave_nothing(self):
        mesh = self.write("cube.off", CUBE)
        for option in ("--full", "-o"):
            self.assert_one_line(self.validate(mesh, option, self.path("no/r.json"), code=3), "no/r.json")
        self.assert_one_line(self.validate(mesh, "--format", "sarif=/dev/full", code=3), "/dev/full")
        self.assert_only("cube.off")


class StandardInput(ValidateCase):
    def validate_bytes(self, content, *arguments, code=0):
        done = subprocess.run([FDCG, "validate", "-", *arguments], input=content, capture_output=True, timeout=60, check=False)
        self.assertEqual(code, done.returncode, done.stderr)
        return done

    def test_a_mesh_comes_through_a_pipe(self):
        file = json.loads(self.validate_bytes(CUBE.encode(), "--format", "json").stdout)["files"][0]
        self.assertEqual(("-", "pass", 6), (file["file"], file["verdict"], file["faces"]))
        self.validate_bytes(THREE_ON_AN_EDGE.encode(), code=1)

    def test_the_format_may_be_given_and_then_counts(self):
        self.validate_bytes(TETRAHEDRON.encode(), "--input-format", "off")
        self.assert_one_line(self.validate_bytes(TETRAHEDRON.encode(), "--input-format", "ply", "-o", os.devnull, code=3), "-")

    def test_nothing_and_nonsense_are_code_3_with_a_report(self):
        for content, rule in ((b"", "empty-mesh"), (b"\xff\xfe\x00nothing", "unreadable"), (b"no mesh", "unreadable")):
            done = self.validate_bytes(content, "--format", "json", code=3)
            self.assertEqual(rule, json.loads(done.stdout)["files"][0]["issues"][0]["rule"])

    def test_compile_reads_it_too(self):
        mesh = self.write("cube.off", CUBE)
        self.fdcg("compile", mesh, "-o", self.path("file.fdcg"), "-q")
        command = [FDCG, "compile", "-", "--input-format", "off", "-o", self.path("pipe.fdcg"), "-q"]
        subprocess.run(command, input=CUBE.encode(), check=True, timeout=60)
        self.assertEqual((self.folder / "file.fdcg").read_bytes(), (self.folder / "pipe.fdcg").read_bytes())
        done = subprocess.run([*command, "--depfile", self.path("d")], input=b"", capture_output=True, check=False, timeout=60)
        self.assertEqual(2, done.returncode)
        self.assert_one_line(done, "--depfile")

    def test_settings_are_found_from_the_current_folder(self):
        self.write(CONFIG, '{"fail-on": "warning"}')
        done = subprocess.run([FDCG, "validate", "-"], input=MISSING_FACE.encode(), capture_output=True, cwd=self.folder, check=False)
        self.assertEqual(1, done.returncode)


if __name__ == "__main__":
    unittest.main()
