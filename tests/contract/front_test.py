# SPDX-License-Identifier: Apache-2.0
"""What compile and replay say where options, names and inputs are odd."""
import json
import math
import resource
import subprocess
import unittest

from support import CUBE, FDCG, ROOT, SERVO, Case


def dome(rings=12, sectors=24):
    """A closed half ball: neighbouring faces bend by several degrees."""
    points = ["0 0 1"]
    for i in range(1, rings + 1):
        a = math.pi / 2 * i / rings
        for j in range(sectors):
            b = 2 * math.pi * j / sectors
            points.append(f"{math.sin(a) * math.cos(b)!r} {math.sin(a) * math.sin(b)!r} {math.cos(a)!r}")
    at = lambda i, j: 1 + (i - 1) * sectors + j % sectors
    faces = [(0, at(1, j), at(1, j + 1)) for j in range(sectors)]
    for i in range(1, rings):
        for j in range(sectors):
            faces += [(at(i, j), at(i + 1, j), at(i + 1, j + 1)), (at(i, j), at(i + 1, j + 1), at(i, j + 1))]
    faces.append(tuple(at(rings, j) for j in reversed(range(sectors))))
    rows = points + [" ".join(map(str, (len(face), *face))) for face in faces]
    return f"OFF\n{len(points)} {len(faces)} 0\n" + "\n".join(rows) + "\n"


class Compile(Case):
    def deviation(self, graph):
        return json.loads(self.fdcg("inspect", graph, "--json").stdout)["max_deviation_m"]

    def test_the_summary_tells_how_far_corners_lie_off_their_planes(self):
        mesh, graph = self.write("dome.off", dome()), self.path("dome.fdcg")
        exact = self.fdcg("compile", mesh, "-o", graph)
        self.assertNotIn(b"warning", exact.stderr)
        self.assertRegex(exact.stdout, rb"corners? lies? .* the planes of ")
        wide = self.fdcg("compile", mesh, "-o", graph, "--coplanar", "25")
        off = self.deviation(graph)
        self.assertGreater(off, 2e-3)  # of an object that measures 2 m
        self.assertIn(f"corners lie up to {off:.6g} m off", wide.stdout.decode())
        warning = wide.stderr.decode()
        self.assertEqual(1, warning.count("\n"))
        for word in ("warning", "dome.off", f"{off:.6g} m", f"{50 * off:.6g} %", "0.1 %", "--coplanar"):
            self.assertIn(word, warning)
        quiet = self.fdcg("compile", mesh, "-o", graph, "--coplanar", "25", "-q")
        self.assertEqual((b"", b""), (quiet.stdout, quiet.stderr))

    def test_no_other_name_of_standard_output_mixes_the_summary_into_the_bytes(self):
        mesh = self.write("cube.off", CUBE)
        plain = self.fdcg("compile", mesh, "-o", "-")
        for name in ("/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"):
            with self.subTest(name=name):
                done = self.fdcg("compile", mesh, "-o", name)
                self.assertEqual(plain.stdout, done.stdout)
                self.assertIn(b"connections", done.stderr)
        with open(self.path("out.fdcg"), "wb") as out:
            done = subprocess.run((FDCG, "compile", mesh, "-o", "/dev/stdout"), stdout=out, stderr=subprocess.PIPE, check=True)
        self.assertEqual(plain.stdout, (self.folder / "out.fdcg").read_bytes())
        self.assertIn(b"connections", done.stderr)
        self.assertIn(b"connections", self.fdcg("compile", mesh, "-o", "/dev/null").stderr)

    def test_a_line_break_in_a_name_is_refused_for_the_depfile(self):
        mesh = self.write("cube.off", CUBE)
        for output in ("a\nb.fdcg", "a\rb.fdcg"):
            done = self.fdcg("compile", mesh, "-o", self.path(output), "--depfile", self.path("cube.d"), code=2)
            self.assert_one_line(done, "--depfile", "a?b.fdcg", "line break")
        self.assert_only("cube.off")
        self.fdcg("compile", mesh, "-o", self.path("a\nb.fdcg"), "-q")

    def test_scales_out_of_range_are_named_with_the_range(self):
        mesh = self.write("cube.off", CUBE)
        for scale, words in (("1e-40", ("1e-40", "1e-30")), ("1e40", ("1e+40", "1e30")), ("abc", ("'abc'",)), ("-1", ("'-1'",)),
                             ("0", ("'0'",)), ("inf", ("'inf'",))):
            with self.subTest(scale=scale):
                self.assert_one_line(self.fdcg("compile", mesh, "-o", self.path("c.fdcg"), f"--scale={scale}", code=2), *words)

    def test_running_out_of_memory_is_code_3_and_leaves_nothing(self):
        size = 700  # a grid of a million triangles
        points = [f"{i} {j} 0" for i in range(size) for j in range(size)]
        faces = [f"3 {i * size + j} {(i + 1) * size + j} {i * size + j + 1}\n3 {(i + 1) * size + j} {(i + 1) * size + j + 1} "
                 f"{i * size + j + 1}" for i in range(size - 1) for j in range(size - 1)]
        mesh = self.write("grid.off", f"OFF\n{len(points)} {2 * len(faces)} 0\n" + "\n".join(points + faces) + "\n")
        limit = 160 << 20
        done = subprocess.run((FDCG, "compile", mesh, "-o", self.path("grid.fdcg"), "--jobs", "1", "-q"), capture_output=True,
                              check=False, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)))
        self.assertEqual(3, done.returncode, done.stderr)
        self.assert_one_line(done, "grid.off", "memory")
        self.assert_only("grid.off")


class Validate(Case):
    def verdicts(self, mesh, *options):
        compiled = subprocess.run((FDCG, "compile", mesh, "-o", "-", "-q", "--report", self.path("compile.json"), *options),
                                  capture_output=True, check=False)
        self.fdcg("validate", mesh, "--format", "json", "-o", self.path("validate.json"), *options, code=compiled.returncode)
        reports = [json.loads((self.folder / name).read_text())["files"][0] for name in ("compile.json", "validate.json")]
        for report in reports:  # compile looks for it on request only
            report["checks"] = [rule for rule in report["checks"] if rule != "self-intersection"]
            report["issues"] = [issue for issue in report["issues"] if issue["rule"] != "self-intersection"]
        self.assertEqual(*reports)
        return reports[0]["verdict"]

    def test_options_that_decide_the_verdict_of_compile_are_those_of_validate(self):
        flipped = self.write("flipped.off", CUBE.replace("4 0 3 2 1", "4 1 2 3 0"))
        self.assertEqual("fail", self.verdicts(flipped))
        self.assertEqual("pass", self.verdicts(flipped, "--orient"))
        near = self.write("near.off", CUBE.replace("8 6", "9 7") + "3 0 1 8\n")
        near = self.write("near.off", (self.folder / "near.off").read_text().replace("0 1 1\n", "0 1 1\n0.5 1e-12 0\n", 1))
        for options in ((), ("--precision", "f32"), ("--weld", "none"), ("--weld", "0.1"), ("--orient", "--precision", "f32")):
            with self.subTest(options=options):
                self.verdicts(near, *options)
        thin = self.write("thin.off", "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1e-60\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n")
        self.assertEqual("pass", self.verdicts(thin))
        self.assertEqual("fail", self.verdicts(thin, "--precision", "f32"))

    def test_every_bad_mesh_has_one_verdict(self):
        meshes = sorted((ROOT / "testdata" / "meshes" / "bad").iterdir())
        judged = 0
        for mesh in meshes:
            if mesh.name.startswith(("unreadable", "empty-mesh")):
                continue
            with self.subTest(mesh=mesh.name):
                self.verdicts(str(mesh))
                judged += 1
        self.assertGreaterEqual(judged, 20)


class Replay(Case):
    ROWS = "t,x,y,z\n0,0.5,0.5,1.1\n0.001,0.5,0.5,0.9\n"

    def test_a_trajectory_comes_from_standard_input_and_from_pipes(self):
        graph, path = self.compiled_cube(), self.write("hip.csv", self.ROWS)
        plain = self.servo("replay", graph, "--trajectory", path, "-o", "-").stdout
        for name in ("-", "/dev/stdin"):
            done = subprocess.run((SERVO, "replay", graph, "--trajectory", name, "-o", "-"), input=self.ROWS.encode(),
                                  capture_output=True, check=True)
            self.assertEqual(plain, done.stdout)
        bad = subprocess.run((SERVO, "replay", graph, "--trajectory", "-"), input=b"t,x,y,z\n0,0,zero,0\n", capture_output=True,
                             check=False)
        self.assertEqual(3, bad.returncode)
        self.assert_one_line(bad, "standard input, line 2", "'zero'")

    def test_rows_that_are_not_finite_are_told_even_with_q(self):
        graph = self.compiled_cube()
        one = self.write("one.csv", self.ROWS + "0.002,nan,0.5,0.9\n")
        done = self.servo("replay", graph, "--trajectory", one, "-q")
        self.assert_one_line(done, "warning", "one.csv", "1 of 3 rows has a HIP", "t = 0.002 s", "no force")
        two = self.write("two.csv", self.ROWS + "0.002,0.5,inf,0.9\n0.003,0.5,0.5,-inf\n")
        self.assert_one_line(self.servo("replay", graph, "--trajectory", two, "-q"), "2 of 4 rows have a HIP", "t = 0.002 s")
        fine = self.write("fine.csv", self.ROWS)
        self.assertEqual(b"", self.servo("replay", graph, "--trajectory", fine, "-q").stderr)

    def test_wrong_numbers_say_what_they_may_be(self):
        graph, path = self.compiled_cube(), self.write("hip.csv", self.ROWS)
        for arguments, words in ((("--stiffness", "1e308"), ("--stiffness", "'1e308'", "1e9 N/m")),
                                 (("--stiffness", "infinite"), ("'infinite'", "0 to 1e9 N/m")),
                                 (("--stiffness", "abc"), ("'abc'", "0 to 1e9 N/m")),
                                 (("--mu-s", "much"), ("--mu-s", "'much'")),
                                 (("--mu-s", "0.1"), ("--mu-s 0.1", "--mu-d 0.4 (the default)", "smaller --mu-d")),
                                 (("--mu-s", "0.1", "--mu-d", "0.2"), ("--mu-s 0.1", "--mu-d 0.2;"))):
            with self.subTest(arguments=arguments):
                self.assert_one_line(self.servo("replay", graph, "--trajectory", path, *arguments, code=2), *words)


if __name__ == "__main__":
    unittest.main()
