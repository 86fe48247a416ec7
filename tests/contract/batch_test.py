# SPDX-License-Identifier: Apache-2.0
"""fdcg batch: results, outputs and reports are the same bytes however the work was cut, killed and cached; what is wrong costs one
line and the promised exit code."""
import hashlib
import json
import os
import pathlib
import random
import resource
import shutil
import signal
import struct
import subprocess
import time
import unittest

import jsonschema

from support import CUBE, FDCG, ROOT, TETRAHEDRON, Case

OPEN = CUBE.replace("8 6 0", "8 5 0").replace("4 3 0 4 7\n", "")
FAN = "OFF\n5 3 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n0 -1 0\n3 0 1 2\n3 1 0 3\n3 0 1 4\n"
FLIPPED = TETRAHEDRON.replace("3 0 3 2", "3 0 2 3")
RULES = {"rules": [{"match": "lib/parts/*.off", "action": "compile", "options": ["--units", "mm"]},
                   {"match": "scan*.off", "action": "repair", "options": ["--all", "--format", "ply"]},
                   {"match": "**/loose/**", "action": "validate", "options": ["--fail-on", "warning"]}]}


def schema(name):
    return json.loads((ROOT / "schemas" / f"{name}.schema.json").read_text())


def tree(folder, *left_out):
    """{path: hash} of the files in a folder, but for the cache."""
    files = {}
    for path in sorted(pathlib.Path(folder).rglob("*")):
        name = str(path.relative_to(folder))
        if path.is_file() and not name.startswith(("cache/", *left_out)):
            files[name] = hashlib.sha256(path.read_bytes()).hexdigest()
    return files


def batches(data, size):
    return [data[at:at + size] for at in range(0, len(data) - size + 1, size)]


class BatchCase(Case):
    def setUp(self):
        super().setUp()
        self.environment = {name: value for name, value in os.environ.items() if not name.startswith("SLURM_")}

    def library(self, parts=6, rows=0):
        for folder in ("lib/parts", "lib/loose"):
            (self.folder / folder).mkdir(parents=True, exist_ok=True)
        for i in range(parts):
            scaled = TETRAHEDRON.replace("1 0 0\n0 1 0", f"{1 + i} 0 0\n0 1 0")
            self.write(f"lib/parts/p{i}.off", grid(rows + i) if rows else scaled)
            self.write(f"lib/loose/l{i}.off", OPEN.replace("1 0 0\n", f"{1 + i} 0 0\n", 1) if i % 3 == 0 else scaled)
        self.write("lib/parts/bad.off", FAN)
        self.write("lib/scan.off", FLIPPED)
        self.write("lib/broken.off", "OFF\n3 1 0\n0 0")
        self.write("list.txt", "lib/**/*.off\nlib/absent.off\n")
        self.write("rules.json", json.dumps(RULES))

    def batch(self, *arguments, out="out", code=3, **variables):
        return self.run_program(FDCG, "batch", "--manifest", "list.txt", "--manifest", "rules.json", "-o", out, *arguments, code=code,
                                cwd=self.folder, env=self.environment | variables)

    def lines(self, out="out"):
        return [json.loads(line) for line in (self.folder / out / "results.jsonl").read_text().splitlines()]

    def code_of_shard(self, number, of, out="out"):
        return max((line["exit_code"] for line in self.lines(out)[number - 1::of]), default=0)


def grid(rows):
    points = "".join(f"{x} {y} {(x * y) % 7 / 10}\n" for x in range(rows) for y in range(rows))
    faces = "".join(f"3 {a} {a + rows} {a + 1}\n3 {a + 1} {a + rows} {a + rows + 1}\n"
                    for x in range(rows - 1) for a in range(x * rows, x * rows + rows - 1))
    return f"OFF\n{rows * rows} {2 * (rows - 1) ** 2} 0\n{points}{faces}"


class Results(BatchCase):
    def test_each_mesh_by_its_rule_a_line_each_and_totals(self):
        self.library()
        done = self.batch()
        self.assertIn(b"lib/absent.off: cannot be opened", done.stderr)
        lines = self.lines()
        for line in lines:
            jsonschema.validate(line, schema("batch-result"))
            full = {"tool": "fdcg", "version": "0", "files": [{"file": line["mesh"], **line["report"]}]}
            jsonschema.validate(full, schema("validate-report"))
        names = sorted(str(path.relative_to(self.folder)) for path in self.folder.glob("lib/**/*.off"))
        self.assertEqual([*names, "lib/absent.off"], [line["mesh"] for line in lines])
        by_name = {line["mesh"]: line for line in lines}
        self.assertEqual(("compile", 0, 1), tuple(by_name["lib/parts/bad.off"][key] for key in ("action", "rule", "exit_code")))
        self.assertEqual(("repair", 1, 0), tuple(by_name["lib/scan.off"][key] for key in ("action", "rule", "exit_code")))
        self.assertEqual(("validate", 2, 1), tuple(by_name["lib/loose/l0.off"][key] for key in ("action", "rule", "exit_code")))
        self.assertEqual(("validate", None, 3), tuple(by_name["lib/broken.off"][key] for key in ("action", "rule", "exit_code")))
        for line in lines:
            if "output" in line:
                data = (self.folder / "out/files" / line["output"]).read_bytes()
                self.assertEqual((len(data), hashlib.sha256(data).hexdigest()), (line["output_bytes"], line["output_sha256"]))
        self.assertEqual(7, len([line for line in lines if "output" in line]))
        report = json.loads((self.folder / "out/report.json").read_text())
        jsonschema.validate(report, schema("batch-report"))
        self.assertEqual({"0": 11, "1": 3, "3": 2}, report["exit_codes"])
        totals = [issue["total"] for line in lines for issue in line["report"]["issues"] if issue["rule"] == "boundary-edge"]
        self.assertEqual({"meshes": len(totals), "findings": sum(totals)}, report["rules"]["boundary-edge"])
        run = json.loads((self.folder / "out/report.sarif").read_text())["runs"][0]
        self.assertEqual([line["mesh"] for line in lines], [one["location"]["uri"] for one in run["artifacts"]])
        self.assertEqual(3, run["invocations"][0]["exitCode"])
        self.assertEqual({"cache", "files", "plan.json", "report.json", "report.sarif", "results.jsonl"},
                         {path.name for path in (self.folder / "out").iterdir()})

    def test_outputs_and_findings_are_those_of_the_commands(self):
        self.library()
        self.batch()
        self.fdcg("compile", "lib/parts/p3.off", "-o", "p3.fdcg", "--units", "mm", "-q", cwd=self.folder)
        self.assertEqual((self.folder / "p3.fdcg").read_bytes(), (self.folder / "out/files/lib/parts/p3.off.fdcg").read_bytes())
        self.fdcg("repair", "lib/scan.off", "-o", "scan.ply", "--all", "-q", cwd=self.folder)
        self.assertEqual((self.folder / "scan.ply").read_bytes(), (self.folder / "out/files/lib/scan.off.ply").read_bytes())
        done = self.fdcg("validate", "lib/loose/l0.off", "--fail-on", "warning", "--format", "json", code=1, cwd=self.folder)
        expected = json.loads(done.stdout)["files"][0]
        self.assertEqual(expected, {"file": "lib/loose/l0.off", **{line["mesh"]: line for line in self.lines()}["lib/loose/l0.off"]["report"]})

    def test_bytes_do_not_depend_on_jobs_shards_or_cache(self):
        self.library()
        self.batch()
        whole = tree(self.folder / "out")
        self.batch("--jobs", "5", out="jobs")
        self.assertEqual(whole, tree(self.folder / "jobs"))
        for number in (3, 1, 2):
            self.batch("--shard", f"{number}/3", "--cache", "out/cache", out="cut", code=self.code_of_shard(number, 3))
        self.fdcg("batch", "-o", "cut", "--merge", code=3, cwd=self.folder)
        self.assertEqual(whole, tree(self.folder / "cut", "shards/"))
        done = self.batch("--resume")
        self.assertIn(b"14 from the cache", done.stdout)
        self.assertEqual(whole, tree(self.folder / "out"))

    def test_more_shards_than_meshes(self):
        self.library(parts=1)
        self.batch()
        for number in range(1, 9):
            self.batch("--shard", f"{number}/8", "-q", out="cut", code=self.code_of_shard(number, 8))
        self.fdcg("batch", "-o", "cut", "--merge", "-q", code=3, cwd=self.folder)
        self.assertEqual(tree(self.folder / "out"), tree(self.folder / "cut", "shards/"))

    def test_files_that_a_mesh_refers_to_count_as_its_own(self):
        (self.folder / "lib").mkdir()
        buffer = self.folder / "lib/t.bin"
        buffer.write_bytes(struct.pack("<12f12H", 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2))
        accessors = [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1]},
                     {"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"}]
        self.write("lib/t.gltf", json.dumps(
            {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}], "accessors": accessors,
             "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}], "buffers": [{"uri": "t.bin", "byteLength": 72}],
             "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 24}]}))
        self.write("list.txt", "lib/t.gltf")
        self.write("rules.json", "{}")
        first = self.run_program(FDCG, "batch", "--manifest", "list.txt", "-o", "out", cwd=self.folder)
        self.assertNotIn(b"from the cache", first.stdout)
        self.assertIn(b"1 from the cache", self.run_program(FDCG, "batch", "--manifest", "list.txt", "-o", "out", "--resume", cwd=self.folder).stdout)
        before = tree(self.folder / "out")
        data = buffer.read_bytes()
        buffer.write_bytes(data[:12] + struct.pack("<f", 0.5) + data[16:])
        changed = self.run_program(FDCG, "batch", "--manifest", "list.txt", "-o", "out", "--resume", cwd=self.folder)
        self.assertNotIn(b"from the cache", changed.stdout)
        buffer.write_bytes(data)
        again = self.run_program(FDCG, "batch", "--manifest", "list.txt", "-o", "out", "--resume", cwd=self.folder)
        self.assertIn(b"1 from the cache", again.stdout)
        self.assertEqual(before, tree(self.folder / "out"))

    def test_robots_give_their_meshes_with_scale(self):
        self.write("part.off", TETRAHEDRON)
        self.write("arm.urdf", '<robot name="arm"><link name="a"><visual><geometry><mesh filename="part.off" scale="0.5 0.5 0.5"/>'
                   '</geometry></visual></link><link name="b"><visual><geometry><mesh filename="arm.urdf"/></geometry></visual></link></robot>')
        self.write("list.txt", "arm.urdf\npart.off\n")
        self.write("rules.json", '{"rules": [{"match": "*.off", "action": "compile"}]}')
        self.batch()
        lines = self.lines()
        self.assertEqual([0, 3, 0], [line["exit_code"] for line in lines])
        self.assertEqual(["part.off", "arm.urdf", "part.off"], [line["mesh"] for line in lines])
        self.assertEqual([0.5, 0.5, 0.5], lines[0]["scale"])
        self.assertEqual(["part.off.fdcg", "part.off@0.5,0.5,0.5.fdcg"], sorted(path.name for path in (self.folder / "out/files").iterdir()))


class BadInput(BatchCase):
    def test_wrong_use_is_one_line_and_leaves_nothing(self):
        self.library()
        self.write("action.json", '{"rules": [{"action": "compiel"}]}')
        self.write("option.json", '{"rules": [{"match": "*", "action": "compile", "options": ["--unit", "mm"]}]}')
        self.write("output.json", '{"rules": [{"action": "compile", "options": ["-o", "x"]}]}')
        self.write("key.json", '{"meshs": []}')
        self.write("empty.txt", "# nothing\n\n")
        self.write("repair.json", '{"rules": [{"action": "repair", "options": ["--all", "--format", "ply"]}]}')
        self.write("clash.txt", "lib/scan.off\nlib/scan.off.ply\n")
        for arguments, code, words in (
                (("--shard", "5/4"), 2, "numbered from 1 to 4"),
                (("--shard", "0/4"), 2, "numbered from 1 to 4"),
                (("--shard", "one"), 2, "write 2/4"),
                (("--manifest", "absent.txt"), 3, "absent.txt"),
                (("--manifest", "lib"), 3, "lib"),
                (("--manifest", "action.json"), 2, "did you mean 'compile'"),
                (("--manifest", "option.json"), 2, "rules[0]: compile: '--unit' is no option; did you mean '--units'"),
                (("--manifest", "output.json"), 2, "'-o' is no option"),
                (("--manifest", "key.json"), 2, "meshs")):
            done = self.batch(*arguments, code=code)
            self.assert_one_line(done, words)
            self.assertFalse((self.folder / "out").exists(), arguments)
        self.assert_one_line(self.fdcg("batch", "-o", "out", code=2, cwd=self.folder), "--manifest")
        self.assert_one_line(self.fdcg("batch", "--manifest", "empty.txt", "-o", "out", code=2, cwd=self.folder), "names no mesh")
        (self.folder / "zero.txt").write_bytes(b"a.off\nb.off\0c.off\n")
        self.assert_one_line(self.fdcg("batch", "--manifest", "zero.txt", "-o", "out", code=3, cwd=self.folder), "line 2 holds a zero byte")
        clash = ("--manifest", "clash.txt", "--manifest", "repair.json")
        self.assert_one_line(self.fdcg("batch", *clash, "-o", "out", code=2, cwd=self.folder), "both be written to 'lib/scan.off.ply'")
        self.assertFalse((self.folder / "out").exists())
        self.assert_one_line(self.batch(out="lib/scan.off/out"), "lib/scan.off/out")
        self.assert_one_line(self.batch(out="lib/parts", code=2), "'lib/parts/bad.off' lies in the folder of the results")

    def test_the_task_of_an_array_is_the_shard(self):
        self.library()
        self.batch(out="whole")
        array = {"SLURM_ARRAY_TASK_ID": "6", "SLURM_ARRAY_TASK_MIN": "2", "SLURM_ARRAY_TASK_STEP": "2", "SLURM_ARRAY_TASK_COUNT": "4"}
        done = self.batch(**array, code=self.code_of_shard(3, 4, "whole"))
        self.assertIn(b"shard 3/4, by SLURM_ARRAY_TASK_ID", done.stderr)
        self.assertTrue((self.folder / "out/shards/3-of-4.jsonl").is_file())
        self.assert_one_line(self.batch(**array | {"SLURM_ARRAY_TASK_ID": "20"}, code=2), "SLURM_ARRAY_TASK_ID is 20", "--shard I/N")
        self.batch(CI_NODE_INDEX="2", CI_NODE_TOTAL="4", code=self.code_of_shard(2, 4, "whole"))
        self.assertTrue((self.folder / "out/shards/2-of-4.jsonl").is_file())
        self.batch(SGE_TASK_ID="undefined", SGE_TASK_FIRST="undefined", out="undefined")
        self.assertEqual(tree(self.folder / "whole"), tree(self.folder / "undefined"))

    def test_duplicates_are_done_once_and_named_in_one_line(self):
        self.write("a.off", TETRAHEDRON)
        self.write("list.txt", "a.off\n./a.off\na.off\n")
        self.write("rules.json", "{}")
        done = self.batch(code=0)
        self.assert_one_line(done, "list.txt: 2 entries are named again", "./a.off")
        self.assertEqual(1, len(self.lines()))

    def test_a_second_batch_in_the_folder_is_refused(self):
        self.library()
        self.batch()
        before = tree(self.folder / "out")
        self.assert_one_line(self.batch(code=2), "--resume")
        self.write("list.txt", "lib/scan.off")
        self.assert_one_line(self.batch("--resume", code=2), "other meshes")
        self.assertEqual(before, tree(self.folder / "out"))

    def test_merging_says_which_shard_is_missing_or_damaged(self):
        self.library()
        merge = ("batch", "-o", "out", "--merge")
        self.assert_one_line(self.fdcg(*merge, code=3, cwd=self.folder), "no results of shards")
        self.batch("--shard", "1/2", "-q")
        self.assert_one_line(self.fdcg(*merge, code=3, cwd=self.folder), "shard 2/2 has no results")
        self.batch("--shard", "2/2", "-q")
        second = self.folder / "out/shards/2-of-2.jsonl"
        text = second.read_text()
        for damage, words in ((text[:-30], "ends early"), (text.replace('"report"', '"repot"', 1), "no result"), ("", "no results"),
                              (text.replace('"plan":"', '"plan":"0', 1), "other meshes"), ("x" + text, "begin")):
            second.write_text(damage)
            self.assert_one_line(self.fdcg(*merge, code=3, cwd=self.folder), words)
            self.assertFalse((self.folder / "out/results.jsonl").exists())
        second.write_text(text)
        shutil.copy(second, self.folder / "out/shards/2-of-3.jsonl")
        self.assert_one_line(self.fdcg(*merge, code=2, cwd=self.folder), "in 2 and of one in 3")

    def test_a_cache_that_somebody_else_writes_is_not_believed(self):
        self.library()
        self.batch()
        whole = tree(self.folder / "out")
        packs = list((self.folder / "out/cache").glob("*.pack"))
        places = [struct.unpack("<32sQQ", entry) for pack in packs for entry in batches(pack.with_suffix(".index").read_bytes(), 48)]
        self.assertEqual(14, len(places))
        numbers = random.Random(1)
        for pack in packs:
            data = bytearray(pack.read_bytes())
            for _, offset, size in (struct.unpack("<32sQQ", entry) for entry in batches(pack.with_suffix(".index").read_bytes(), 48)):
                data[offset + numbers.randrange(size)] ^= 1 << numbers.randrange(8)
            pack.write_bytes(data)
        done = self.batch("--resume")
        self.assertNotIn(b"from the cache", done.stdout)
        self.assertEqual(whole, tree(self.folder / "out"))
        self.assertIn(b"14 from the cache", self.batch("--resume").stdout)  # what was made anew stands beside what was damaged

    def test_a_cache_with_any_bytes_costs_time_alone(self):
        self.library()
        self.batch()
        whole, cache = tree(self.folder / "out"), self.folder / "out/cache"
        good = {path.name: path.read_bytes() for path in cache.iterdir()}
        numbers = random.Random(2)
        huge = struct.pack("<QQ", 2 ** 63, 2 ** 63)
        damages = {
            "cut": lambda data: data[:numbers.randrange(len(data))],
            "empty": lambda data: b"",
            "noise": lambda data: numbers.randbytes(len(data)),
            "longer": lambda data: data + b"more",
            "elsewhere": lambda data: b"".join(entry[:32] + huge for entry in batches(data, 48)),
            "exchanged": lambda data: b"".join(a[:32] + b[32:] for a, b in zip(batches(data, 48), batches(data, 48)[::-1])),
            "gone": lambda data: None,
        }
        for kind in (".pack", ".index"):
            for name, damage in damages.items():
                for path, data in good.items():
                    damaged = damage(data) if path.endswith(kind) else data
                    if damaged is None:
                        (cache / path).unlink(missing_ok=True)
                    else:
                        (cache / path).write_bytes(damaged)
                self.batch("--resume")
                self.assertEqual(whole, tree(self.folder / "out"), f"{kind} {name}")
        shutil.rmtree(cache)
        cache.mkdir()
        for name in good:
            (cache / name).mkdir()
        self.batch("--resume")
        self.assertEqual(whole, tree(self.folder / "out"), "folders")

    def test_a_cache_that_cannot_be_written_costs_one_warning(self):
        self.library()
        self.write("file", "")
        done = self.batch("--cache", "file/cache")
        self.assertEqual(1, done.stderr.count(b"warning: the cache does not keep"), done.stderr)
        self.batch(out="other")
        self.assertEqual(tree(self.folder / "other"), tree(self.folder / "out"))

    def test_robots_that_name_one_another_are_lines_of_their_own(self):
        robot = '<robot name="a"><link name="l"><visual><geometry><mesh filename="{}"/></geometry></visual></link></robot>'
        self.write("a.urdf", robot.format("b.urdf"))
        self.write("b.urdf", robot.format("a.urdf"))
        self.write("a.sdf", '<sdf version="1.7"><model name="a"><include><uri>a.sdf</uri></include></model></sdf>')
        self.write("part.off", TETRAHEDRON)
        self.write("list.txt", "a.urdf\nb.urdf\na.sdf\npart.off\n")
        self.write("rules.json", "{}")
        done = self.batch()
        self.assertEqual({"b.urdf": 3, "a.urdf": 3, "a.sdf": 3, "part.off": 0}, {line["mesh"]: line["exit_code"] for line in self.lines()})
        told = [line for line in done.stderr.decode().splitlines() if "which names meshes and is none" in line or "names no mesh" in line]
        self.assertEqual(3, len(told), done.stderr)

    def test_a_full_disk_ends_the_run_and_resume_goes_on(self):
        if os.geteuid() != 0 or subprocess.run(("unshare", "--mount", "true"), check=False, capture_output=True).returncode != 0:
            self.skipTest("a disk of a few megabytes needs root and mounts")
        self.library(parts=20, rows=24)
        self.batch("-q", out="whole")
        (self.folder / "disk").mkdir()
        run = '"$0" batch --manifest list.txt --manifest rules.json -o disk/out -q'
        script = f"""
            mount -t tmpfs -o size=1m none disk
            {run}; echo "code $?"
            ls --ignore=lock disk/out/unfinished/1-of-1
            find disk/out/files -type f -name '*.fdcg' -exec "$0" inspect --verify {{}} ';' >/dev/null || echo half
            mount -o remount,size=100m disk
            {run} --resume 2>/dev/null; echo "code $?"
            cp -r disk/out out"""
        done = self.run_program("unshare", "--mount", "--propagation", "private", "sh", "-c", script, FDCG, cwd=self.folder, env=self.environment)
        self.assertEqual(["code 3", "code 3"], done.stdout.decode().splitlines())  # of the library; nothing unfinished, nothing half-written
        fatal = [line for line in done.stderr.decode().splitlines() if "make room for it and go on with --resume" in line]
        self.assertEqual(1, len(fatal), done.stderr)
        self.assertEqual(tree(self.folder / "whole"), tree(self.folder / "out"))

    def test_no_room_for_an_output_is_one_line_and_nothing_half_written(self):
        self.library(rows=20)

        def limited():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (30000, 30000))
        done = self.run_program(FDCG, "batch", "--manifest", "list.txt", "--manifest", "rules.json", "-o", "out", "--cache", "/dev/null/c", "-q",
                                code=3, cwd=self.folder, preexec_fn=limited)
        fatal = [line for line in done.stderr.decode().splitlines() if "--resume" in line and "cannot write" in line and "warning" not in line]
        self.assertEqual(1, len(fatal), done.stderr)
        self.assertFalse((self.folder / "out/results.jsonl").exists())
        written = list((self.folder / "out/files").rglob("*.fdcg")) if (self.folder / "out/files").exists() else []
        for path in written:
            self.fdcg("inspect", "--verify", str(path))
        self.batch("--resume", "-q")
        self.batch("-q", out="other")
        self.assertEqual(tree(self.folder / "other"), tree(self.folder / "out"))


class Overhead(BatchCase):
    """Beside the work: processor time, which others on the machine disturb least, of the best of some rounds."""

    def seconds(self, *command):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        self.run_program(FDCG, *command, cwd=self.folder, env=self.environment)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        return after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime

    def test_many_small_meshes_cost_little_more_than_their_reports(self):
        (self.folder / "lib").mkdir()
        for i in range(1000):
            self.write(f"lib/m{i}.off", grid(8 + i % 8))
        self.write("list.txt", "lib\n")
        ratios = []
        for i in range(4):
            alone = self.seconds("validate", "lib", "--jobs", "1", "-q", "--format", "json=all.json", "--format", "sarif=all.sarif")
            ratios.append(self.seconds("batch", "--manifest", "list.txt", "-o", f"out{i}", "-q") / alone)
        self.assertLess(min(ratios), 1.6, ratios)
        packs = list((self.folder / "out0/cache").iterdir())
        self.assertLessEqual(len(packs), 2 * os.cpu_count())


class Killed(BatchCase):
    """At any moment, and resumed: the bytes of an undisturbed run."""

    def start(self, *arguments):
        command = [FDCG, "batch", "--manifest", "list.txt", "--manifest", "rules.json", "-o", "out", "--resume", "-q", *arguments]
        return subprocess.Popen(command, cwd=self.folder, env=self.environment, start_new_session=True, stdin=subprocess.DEVNULL,
                                stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def undisturbed(self):
        started = time.monotonic()
        self.batch("-q", out="whole")
        return tree(self.folder / "whole"), time.monotonic() - started

    def test_with_kill_9_at_random_moments(self):
        self.library(parts=30, rows=12)
        whole, seconds = self.undisturbed()
        numbers, kills, trial = random.Random(25), 0, 0
        while trial < 12 or (kills <= 12 and trial < 48):  # a machine whose speed changes lets more of them end first
            trial += 1
            shutil.rmtree(self.folder / "out", ignore_errors=True)
            for _ in range(3):
                run = self.start()
                time.sleep(numbers.uniform(0, 0.9 * seconds))
                if run.poll() is None:
                    kills += 1
                    (os.killpg if trial % 2 else os.kill)(run.pid, signal.SIGKILL)  # all its processes, or the first alone
                run.wait()
            self.batch("--resume", "-q")
            self.assertEqual(whole, tree(self.folder / "out"), f"trial {trial}")
        self.assertGreater(kills, 12)

    def test_by_a_signal_that_can_be_caught(self):
        self.library(parts=30, rows=12)
        whole, seconds = self.undisturbed()
        for number in (signal.SIGINT, signal.SIGTERM):
            run = self.start()
            time.sleep(0.4 * seconds)
            os.kill(run.pid, number)
            run.wait()
            time.sleep(0.3)
            left = [path.name for path in (self.folder / "out").rglob("*") if "unfinished" in str(path) and path.is_file()]
            self.assertLessEqual(set(left), {"lock"})
        self.batch("--resume", "-q")
        self.assertEqual(whole, tree(self.folder / "out"))

    @staticmethod
    def children(parent):
        try:
            return [int(child) for child in pathlib.Path(f"/proc/{parent}/task/{parent}/children").read_text().split()]
        except OSError:
            return []

    @staticmethod
    def resident_kb(process):
        try:
            return int(pathlib.Path(f"/proc/{process}/status").read_text().split("VmRSS:")[1].split()[0])
        except (OSError, IndexError):
            return 0

    def test_a_worker_that_dies_costs_its_mesh_alone(self):
        self.library(parts=3)
        self.write("lib/large.off", grid(600))
        self.batch("-q", out="whole")
        run = self.start()
        killed = False
        while not killed and run.poll() is None:
            time.sleep(0.005)
            for child in self.children(run.pid):
                if not killed and self.resident_kb(child) > 60_000:
                    os.kill(child, signal.SIGSEGV)
                    killed = True
        self.assertEqual(4 if killed else 3, run.wait(60))
        self.assertTrue(killed)
        lines = self.lines()
        self.assertEqual([4], [line["exit_code"] for line in lines if line["mesh"] == "lib/large.off"])
        self.assertIn("crashed", [line["error"] for line in lines if line["mesh"] == "lib/large.off"][0])
        self.assertEqual([line for line in self.lines("whole") if line["mesh"] != "lib/large.off"],
                         [line for line in lines if line["mesh"] != "lib/large.off"])
        self.batch("--resume", "-q")
        self.assertEqual(tree(self.folder / "whole"), tree(self.folder / "out"))

    def test_a_mesh_that_takes_too_long_costs_itself_alone(self):
        self.library(parts=3)
        self.write("lib/large.off", grid(400))
        self.batch("-q", "--time-limit", "0.1")
        large = [line for line in self.lines() if line["mesh"] == "lib/large.off"][0]
        self.assertEqual(3, large["exit_code"])
        self.assertIn("--time-limit", large["error"])

    def test_two_runs_of_one_shard_do_not_meet(self):
        self.library(parts=30, rows=60)
        first = self.start()
        time.sleep(0.3)
        second = self.batch("--resume", "-q")  # waits, or finds the first one's results
        first.wait()
        self.batch("--resume", "-q")
        self.batch("-q", out="whole")
        self.assertEqual(tree(self.folder / "whole"), tree(self.folder / "out"), second.stderr)


if __name__ == "__main__":
    unittest.main()
