# SPDX-License-Identifier: Apache-2.0
"""fdcg-servo on devices: run, replay of what was recorded, check, devices. The devices are simulated, in real time, on a
machine that may be busy: a fault of timing is allowed where a test is not about it. Over 400 lines: a class for each command."""
import csv
import io
import json
import os
import pathlib
import re
import resource
import shutil
import signal
import struct
import subprocess
import time
import unittest

import jsonschema

from support import ROOT, SERVO, Case, checksum

EXAMPLE = ROOT / "testdata" / "scenes" / "cube.json"
PROFILES = sorted((ROOT / "runtime" / "device" / "profiles").glob("*.json"))


def schema(name):
    return json.loads((ROOT / "schemas" / name).read_text())


class ServoCase(Case):
    """The example, with changes, in the test's own folder."""

    def setUp(self):
        super().setUp()
        shutil.copy(EXAMPLE.parent / "cube.fdcg", self.folder)

    def scene(self, name="scene.json", **changes):
        scene = json.loads(EXAMPLE.read_text())
        scene["loop"] = {"servo_priority": 0, "writer_priority": 0, "lock_memory": False}
        scene.update(changes)
        return self.write(name, json.dumps(scene))

    def run_scene(self, *arguments, codes=(0, 1), **options):
        done = subprocess.run([SERVO, "run", *arguments], stdin=subprocess.DEVNULL, capture_output=True, timeout=60,
                              check=False, **options)
        self.assertIn(done.returncode, codes, done.stdout[-2000:] + done.stderr[-2000:])
        return done

    def started(self, *arguments, **options):
        process = subprocess.Popen([SERVO, "run", *arguments], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, **options)
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.stdout.close)
        self.addCleanup(process.stdin.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def session(self, seconds="0.6", *arguments):
        log = self.path("session.fdcglog")
        self.run_scene(self.scene(), "--for", seconds, "--log", log, "-q", *arguments)
        return log


def lines_of(output):
    return [json.loads(line) for line in output.splitlines()]


class Run(ServoCase):
    def test_the_example_runs_and_every_line_of_its_status_fits_the_schema(self):
        jsonschema.validate(json.loads(EXAMPLE.read_text()), schema("servo-scene.schema.json"))
        done = self.run_scene(str(EXAMPLE), "--arm", "--for", "1.5", "--no-log", "--status", "json", "--status-every", "0.1")
        lines = lines_of(done.stdout)
        for line in lines:
            jsonschema.validate(line, schema("servo-status.schema.json"))
        self.assertEqual(["status"] * (len(lines) - 1) + ["end"], [line["event"] for line in lines])
        self.assertGreater(len(lines), 5)
        device = lines[-1]["devices"][0]
        self.assertEqual(("hand", 1), (device["name"], device["opened"]))
        self.assertGreater(device["ticks"], 300)
        self.assertTrue(any(line["devices"][0]["phase"] != "disarmed" for line in lines) or device["disarmed"])
        # code 1 only with a fault that the last line names
        self.assertEqual(done.returncode == 1, device["fault"] not in ("none", "not-armed"))

    def test_the_example_graph_is_what_the_compiler_makes(self):
        mesh = ROOT / "testdata" / "meshes" / "good" / "cube_quads.off"
        self.assertEqual((EXAMPLE.parent / "cube.fdcg").read_bytes(), self.fdcg("compile", str(mesh), "-o", "-").stdout)

    def test_without_arm_no_force_goes_out_and_that_is_said(self):
        log = self.path("a.fdcglog")
        done = self.run_scene(self.scene(), "--for", "1.5", "--log", log, codes=(0,))
        self.assertIn(b"Not armed", done.stdout)
        rows = list(csv.DictReader(io.StringIO(self.servo("replay", log, "-o", "-").stdout.decode())))
        self.assertTrue(any(float(row["fz"]) != 0 for row in rows), "the hand never touched the cube")
        for row in rows:
            self.assertEqual((0, 0, 0), tuple(float(row[f"sent_f{axis}"]) for axis in "xyz"))
            self.assertEqual("disarmed", row["phase"])

    def test_commands_on_standard_input(self):
        process = self.started(self.scene(), "--no-log", "--status", "json", "--status-every", "0.05")

        def wait_for(wanted, command):
            for line in range(200):
                if line % 20 == 0:  # again each second: where a tick was late, a device refuses to be armed
                    process.stdin.write(command)
                    process.stdin.flush()
                device = json.loads(process.stdout.readline())["devices"][0]
                if wanted(device):
                    return
            self.fail(f"nothing came of {command}")

        wait_for(lambda device: device["ticks"] > 0, b"\n")
        wait_for(lambda device: device["phase"] != "disarmed" or device["disarmed"], b" arm \r\n")
        wait_for(lambda device: device["phase"] == "disarmed", b"disarm\n")
        out, err = process.communicate(b"dance\nquit\n", timeout=20)
        self.assertIn(b"arm, disarm, quit", err)
        self.assertEqual("end", lines_of(out)[-1]["event"])

    def test_the_end_of_standard_input_ends_nothing(self):
        before = time.monotonic()
        self.run_scene(self.scene(), "--no-log", "--for", "0.7", "-q")
        self.assertGreater(time.monotonic() - before, 0.7)

    def test_signals_end_it_in_order(self):
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            with self.subTest(signal=number):
                log = self.path("a.fdcglog")
                process = self.started(self.scene(), "--log", log, "--status", "json", "--status-every", "0.05")
                for _ in range(4):
                    process.stdout.readline()
                process.send_signal(number)
                out, _ = process.communicate(timeout=20)
                self.assertEqual(0, process.returncode)
                self.assertEqual("end", lines_of(out)[-1]["event"])
                self.servo("replay", log)

    def test_killed_it_leaves_a_log_that_can_be_read(self):
        log = self.path("a.fdcglog")
        process = self.started(self.scene(), "--log", log, "--status", "json", "--status-every", "0.1")
        for _ in range(6):
            process.stdout.readline()
        process.kill()
        process.wait()
        done = self.servo("replay", log, code=1)
        self.assertRegex(done.stdout, rb"hand: [\d,]+ ticks, every output the same bit for bit\n")
        self.assertRegex(done.stdout, rb"a.fdcglog: byte \d+: the (log ends here without its last record|file ends within)")

    def test_a_reader_that_goes_away_ends_it(self):
        process = self.started(self.scene(), "--no-log", "--status", "json", "--status-every", "0.05")
        process.stdout.readline()
        process.stdout.close()
        process.wait(timeout=20)
        self.assertIn(process.returncode, (0, 1))

    def test_a_disk_that_fills_up_is_told_once_and_the_session_goes_on(self):
        limit = 60_000

        def with_little_disk():
            resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))

        before = time.monotonic()
        done = self.run_scene(self.scene(), "--for", "2", "--log", self.path("a.fdcglog"), "--status", "none", codes=(3,),
                              preexec_fn=with_little_disk)
        self.assertGreater(time.monotonic() - before, 2)
        self.assertEqual(1, done.stderr.count(b"warning: "), done.stderr)
        self.assertIn(b"File too large", done.stderr)
        self.assertLessEqual((self.folder / "a.fdcglog").stat().st_size, limit)
        self.assertIn(b"every output the same", self.servo("replay", self.path("a.fdcglog"), code=1).stdout)

    def test_a_log_that_cannot_be_written_ends_it_before_it_starts(self):
        scene = self.scene()
        for log, words in (("/dev/full", ("/dev/full", "No space left")), (self.path("no/a"), ("no/a",)),
                           (scene, ("would overwrite the scene",)), (self.path("cube.fdcg"), ("graph of 'cube'",))):
            self.assert_one_line(self.run_scene(scene, "--log", log, codes=(3,)), *words)

    def test_what_is_no_log_is_not_overwritten_and_a_log_not_without_a_word(self):
        text = self.write("notes.txt", "mine")
        os.symlink("session.fdcglog", self.path("link"))
        for log, words in ((text, "no session's log"), (self.path("link"), "symbolic link")):
            for how in ((), ("--fast",)):
                self.assert_one_line(self.run_scene(self.scene(), "--for", "0.1", "--log", log, *how, codes=(3,)), words)
        self.assertEqual("mine", pathlib.Path(text).read_text())
        log = self.session("0.2")
        self.assertFalse((self.folder / "link.fdcglog").exists())
        done = self.run_scene(self.scene(), "--for", "0.2", "--log", log, "-q")
        self.assertIn(b"is a session's log, and is overwritten", done.stderr)
        checked = self.servo("check", self.scene("logs.json", log={"file": os.path.basename(log)}))
        self.assertIn(b"a session's log that a run overwrites", checked.stdout)

    def test_a_graph_that_is_cut_short_or_written_anew_meanwhile_changes_nothing(self):
        graph = self.folder / "cube.fdcg"
        whole = graph.read_bytes()
        for change in (lambda: os.truncate(graph, 0), lambda: graph.write_bytes(b"x" * len(whole)), graph.unlink):
            log = self.path("session.fdcglog")
            process = self.started(self.scene(), "--arm", "--for", "1.5", "--log", log, "--status", "none")
            until = time.monotonic() + 30
            while not (os.path.exists(log) and os.path.getsize(log) > 0) and time.monotonic() < until:
                time.sleep(0.01)  # the log begins after the graphs are read
            time.sleep(0.5)
            change()
            self.assertIn(process.wait(timeout=30), (0, 1))
            graph.write_bytes(whole)
            self.assertIn(b"every output the same", self.servo("replay", log).stdout)  # it names what was stepped on
            os.remove(log)

    def test_a_device_that_is_not_there_at_the_start_is_not_armed_by_the_option(self):
        scene = self.scene(devices=[{"name": "hand", "profile": "fdcg-reference", "serial": "no such device"}])
        done = self.run_scene(scene, "--arm", "--no-log", "--for", "0.4", codes=(1,))
        self.assertIn(b"hand: not there at the start; when it is, type arm and Enter", done.stdout)

    def test_a_loop_that_shakes_calms_down_within_three_tenths_of_a_second_and_says_so(self):
        cube = {"name": "cube", "file": "cube.fdcg", "stiffness_n_per_m": 5000,
                "pose": {"scale": 0.1, "translation_m": [-0.05, -0.05, -0.1]}}
        hand = {"name": "hand", "source": "simulated",
                "simulation": {"mass_kg": 0.1, "damping_n_s_per_m": 0.5, "hand_stiffness_n_per_m": 300, "hand_damping_n_s_per_m": 1,
                               "script": [{"at_s": at, "place_m": [0, 0, z]} for at, z in ((0, 0.01), (1, 0.01), (2, -0.005), (100, -0.005))]}}
        scene = self.scene(objects=[cube], devices=[hand], limits={"force_n": 5})
        for _ in range(5):
            out = self.run_scene(scene, "--arm", "--no-log", "--for", "4").stdout
            if not re.search(rb"^  disarmed .*\b(host-late|writer-stuck|silence)\b", out, re.M):
                break  # it was there until it shook
        self.assertRegex(out, rb"hand: (it shakes: the scene's forces are cut to 10 %|disarmed: the loop of hand, device and scene shakes)")
        log = self.path("shaking.fdcglog")
        self.run_scene(scene, "--arm", "--log", log, "--for", "4", "--fast")
        self.servo("replay", log, "-o", self.path("shaking.csv"))
        rows = list(csv.DictReader(io.StringIO((self.folder / "shaking.csv").read_text())))
        force = [(float(row["t"]), float(row["sent_fz"])) for row in rows]
        touched = next(t for t, f in force if f > 0.25)
        late = [f for t, f in force if t > touched + 0.5]  # the hand still comes down, and has come
        steps = [abs(a - b) for a, b in zip(late, late[4:])]
        self.assertLess(max(steps), 0.25)  # 5 % of the limit

    def test_the_round_trip_is_measured_and_shown(self):
        done = self.run_scene(str(EXAMPLE), "--arm", "--for", "1", "--no-log", "--status", "json", "--fast")
        times = lines_of(done.stdout)[-1]["devices"][0]["round_trip_us"]
        self.assertGreater(times["count"], 900)
        self.assertLess(900, times["p50"])
        self.assertLess(times["p50"], 2500)
        self.assertIn(b"round trip     p50 ", self.run_scene(str(EXAMPLE), "--for", "1", "--no-log", "--fast").stdout)

    def test_a_device_that_is_unplugged_is_told_and_costs_the_code(self):
        simulation = {"start_m": [0, 0, 0.03], "amplitude_m": [0, 0, 0], "faults": [{"kind": "unplug", "at_s": 0.8}]}
        scene = self.scene(devices=[{"name": "hand", "source": "simulated", "simulation": simulation}])
        done = self.run_scene(scene, "--arm", "--no-log", "--for", "2", codes=(1,))
        self.assertIn(b"hand: gone", done.stdout)
        self.assertIn(b"hand: disarmed: ", done.stdout)
        self.assertRegex(done.stdout, rb"(?m)^  disarmed .*\bread-failed\b")

    def test_of_devices_that_share_a_scene_one_is_unplugged_and_the_other_goes_on(self):
        scene = json.loads((EXAMPLE.parent / "two_devices.json").read_text())
        scene["loop"] = {"servo_priority": 0, "writer_priority": 0, "lock_memory": False}
        scene["devices"][0]["simulation"]["faults"] = [{"kind": "unplug", "at_s": 0.8}]
        log = self.path("shared.fdcglog")
        done = self.run_scene(self.write("shared.json", json.dumps(scene)), "--arm", "--for", "2", "--log", log, codes=(1,))
        self.assertIn(b"thumb: gone", done.stdout)
        self.assertIn(b"thumb: disarmed: ", done.stdout)
        self.assertNotIn(b"finger: gone", done.stdout)
        text = self.servo("replay", log, "-o", self.path("a.csv")).stdout.decode()
        for name in ("thumb", "finger"):
            self.assertRegex(text, f"{name}: [0-9,]+ ticks, every output the same")
        rows = list(csv.DictReader(io.StringIO(pathlib.Path(self.path("a.csv")).read_text())))
        self.assertGreater(float([row for row in rows if row["device"] == "1"][-1]["t"]), 1.7)
        self.assertLess(float([row for row in rows if row["device"] == "0"][-1]["t"]), 1.2)

    def test_a_device_that_is_pressed_is_not_armed_and_that_is_said(self):
        simulation = {"start_m": [0, 0, -0.01], "amplitude_m": [0, 0, 0], "hand_stiffness_n_per_m": 1000}
        cube = {"name": "cube", "file": "cube.fdcg", "motion": {"kind": "swing", "axis": [0, 0, 1], "rate_hz": 0.1, "amplitude_m": 0.2},
                "pose": {"scale": 0.1, "translation_m": [-0.05, -0.05, -0.13]}}
        scene = self.scene(objects=[cube], devices=[{"name": "hand", "source": "simulated", "simulation": simulation}])
        process = self.started(scene, "--no-log")
        time.sleep(1)  # the cube has come up from below: 2 N by now
        process.stdin.write(b"arm\n")
        process.stdin.flush()
        time.sleep(0.8)
        out, _ = process.communicate(b"quit\n", timeout=20)
        self.assertIn(b"hand: not armed: the tip is pressed against something", out)

    def test_a_device_that_was_never_there_is_told_and_costs_the_code(self):
        scene = self.scene(devices=[{"name": "hand", "profile": "fdcg-reference", "serial": "no such device"}])
        done = self.run_scene(scene, "--no-log", "--for", "0.4", codes=(1,))
        self.assertIn(b"never there: ", done.stdout)

    def test_a_recording_is_played_and_ends_by_itself(self):
        log = self.session("1")
        scene = self.scene(devices=[{"name": "player", "source": "recorded", "recording": os.path.basename(log)}])
        jsonschema.validate(json.loads(pathlib.Path(scene).read_text()), schema("servo-scene.schema.json"))
        done = self.run_scene(scene, "--no-log", "--status", "json", codes=(0,))
        device = lines_of(done.stdout)[-1]["devices"][0]
        self.assertGreater(device["ticks"], 200)
        self.assertIs(True, device["ended"])
        jsonschema.validate(lines_of(done.stdout)[-1], schema("servo-status.schema.json"))
        self.run_scene(scene, "--log", log, codes=(3,))  # would overwrite what it plays

    def test_a_recording_that_ends_while_it_is_armed_is_no_fault_and_is_told_as_its_end(self):
        log = self.path("session.fdcglog")
        hand = {"name": "hand", "source": "simulated", "simulation": {"start_m": [0, 0, 0.03], "amplitude_m": [0, 0, 0]}}
        self.run_scene(self.scene(devices=[hand]), "--fast", "--for", "1.5", "--log", log, "-q", codes=(0,))
        scene = self.scene(devices=[{"name": "hand", "source": "recorded", "recording": os.path.basename(log)}])
        for how in ((), ("--fast",)):
            with self.subTest(how):
                done = self.run_scene(scene, "--arm", "--no-log", *how, codes=(0,) if how else (0, 1))
                self.assertIn(b"the recording has ended", done.stdout)
                self.assertNotIn(b"read-failed", done.stdout)
                self.assertNotIn(b"plug it in", done.stdout)
                self.assertNotIn(b"hand: gone", done.stdout)
                if how:
                    self.assertIn(b"disarmed       never\n", done.stdout)
                last = lines_of(self.run_scene(scene, "--arm", "--no-log", "--status", "json", *how).stdout)[-1]
                jsonschema.validate(last, schema("servo-status.schema.json"))
                self.assertIs(True, last["devices"][0]["ended"])
        self.assertIn(b"(a recording that has ended is no fault)", self.servo("run", "--help").stdout)

    def test_a_device_of_unknown_limits_is_read_but_never_armed(self):
        log = self.session("1")
        profile = json.loads((ROOT / "runtime/device/profiles/fdcg-reference.json").read_text())
        del profile["limits"]
        scene = self.scene(devices=[{"name": "hand", "source": "recorded", "recording": os.path.basename(log), "profile": profile}])
        done = self.run_scene(scene, "--arm", "--no-log")
        self.assertIn(b"limits.force_n", done.stderr)
        self.assertIn(b"hand: not armed: the profile leaves a limit unknown", done.stdout)
        self.assertNotIn(b"hand: armed", done.stdout)

    def test_wrong_usage(self):
        scene = self.scene()
        for arguments, words in (((), ("scene",)), ((scene, "--for", "0"), ("--for",)),
                                 ((scene, "--for", "nan"), ("--for", "'nan' is no number from 0.001")),
                                 ((scene, "--status-every", "inf"), ("--status-every", "'inf'")), ((scene, "--hid", "x"), ("--hid",)),
                                 ((scene, "--status", "xml"), ("--status",)), ((scene, "--log", "a", "--no-log"), ("--no-log",))):
            self.assert_one_line(self.servo("run", *arguments, code=2), *words)
        for name, words in ((self.path("missing.json"), ("missing.json",)), (str(self.folder), (str(self.folder),)),
                            (self.write("bad.json", "{"), ("bad.json", "JSON")),
                            (self.scene("gone.json", objects=[{"name": "a", "file": "gone.fdcg"}]), ("objects[0] 'a'", "gone.fdcg"))):
            self.assert_one_line(self.servo("run", name, code=3), *words)


class Latency(ServoCase):
    def test_the_round_trip_is_told_with_what_the_gate_makes_of_it(self):
        done = self.servo("latency", self.scene(), "--for", "1.5", "-o", self.path("latency.csv"))
        self.assertRegex(done.stdout, rb"round trip     p50 [\d.]+, p99 ")
        self.assertIn(b"arming         allowed: the quickest is below 4000 us", done.stdout)
        self.assertRegex(done.stdout, rb"us +[\d,]+  #")
        rows = list(csv.DictReader(io.StringIO((self.folder / "latency.csv").read_text())))
        trips = [row for row in rows if row["measure"] == "round_trip"]
        self.assertGreater(sum(int(row["count"]) for row in trips), 1000)
        for row in rows:
            self.assertLess(float(row["from_us"]), float(row["to_us"]))
        (device,) = json.loads(self.servo("latency", self.scene(), "--for", "0.5", "--json").stdout)["devices"]
        self.assertEqual(("fits", 1000), (device["arming"], device["stated_rate_hz"]))

    def test_a_round_trip_that_is_too_long_is_told_before_and_at_arming(self):
        late = {"kind": "stale", "at_s": 0, "for_s": 100, "delay_s": 0.009}
        simulation = {"start_m": [0, 0, 0.03], "amplitude_m": [0, 0, 0], "faults": [late]}
        scene = self.scene(devices=[{"name": "hand", "source": "simulated", "simulation": simulation}])
        done = self.servo("latency", scene, "--for", "0.5", code=1)
        self.assertIn(b"arming         refused: what is sent to the device comes back too late", done.stdout)
        self.assertIn(b'"arming": "too-long"', self.servo("latency", scene, "--for", "0.5", "--json", code=1).stdout)
        done = self.run_scene(scene, "--arm", "--no-log", "--for", "1", codes=(1,))
        self.assertIn(b"hand: not armed: what is sent to the device comes back too late", done.stdout)

    def test_the_histograms_overwrite_no_scene_and_stand_alone_on_standard_output(self):
        scene = self.scene()
        self.assertIn(b"would overwrite the scene", self.servo("latency", scene, "-o", scene, code=2).stderr)
        self.assertIn(b"no/a.csv", self.servo("latency", scene, "-o", self.path("no") + "/a.csv", code=3).stderr)
        rows = list(csv.DictReader(io.StringIO(self.servo("latency", scene, "--for", "0.3", "-o", "-").stdout.decode())))
        self.assertEqual({"round_trip", "interval", "work", "write"}, {row["measure"] for row in rows})

    def test_a_device_that_is_not_there_is_told(self):
        scene = self.scene(devices=[{"name": "hand", "profile": "fdcg-reference", "serial": "no such device"}])
        self.assertIn(b"never there: ", self.servo("latency", scene, "--for", "0.3", code=1).stdout)
        self.assertIn(b'"arming": "absent"', self.servo("latency", scene, "--for", "0.3", "--json", code=1).stdout)


class Replay(ServoCase):
    def records(self, log):
        """[(offset, length)] of a log's records, and its bytes, as schemas/session-log.md has them."""
        data = pathlib.Path(log).read_bytes()
        self.assertEqual(b"\x89FLOG\r\n\x1a", data[:8])
        version, size = struct.unpack_from("<II", data, 8)
        self.assertEqual(2, version)
        at = 16 + size + 8
        self.assertEqual(checksum(data[:at - 8]), struct.unpack_from("<Q", data, at - 8)[0])
        records = []
        while at < len(data):
            length = struct.unpack_from("<I", data, at)[0]
            records.append((at, length))
            at += length
        self.assertEqual(len(data), at)
        return records, data

    def test_a_session_replays_to_the_same_bytes(self):
        log = self.session("1.2", "--arm")
        done = self.servo("replay", log, "--write", self.path("again"), "-o", self.path("log.csv"))
        self.assertRegex(done.stdout, rb"^hand: [\d,]+ ticks, every output the same bit for bit\n")
        self.assertEqual(pathlib.Path(log).read_bytes(), (self.folder / "again").read_bytes())
        rows = list(csv.DictReader(io.StringIO((self.folder / "log.csv").read_text())))
        self.assertEqual("t,hip_x,hip_y,hip_z,go_x,go_y,go_z,fx,fy,fz,state,feature,slip,transitions,device,tick,phase,fault,"
                         "sent_fx,sent_fy,sent_fz", ",".join(rows[0]))
        self.assertGreater(len(rows), 200)
        records, _ = self.records(log)
        self.assertLessEqual(len(rows), len(records) - 1)
        for row in rows:
            if row["state"] != "free":
                self.assertLessEqual(float(row["hip_z"]), float(row["go_z"]) + 1e-9)  # on the top, pressed into it
        self.assertEqual(b"", self.servo("replay", log, "-q").stdout)

    def test_the_pages_layout_is_the_files(self):
        log = self.session()
        records, data = self.records(log)
        sample = 0
        for number, (at, length) in enumerate(records[:-1]):
            kind, device, tick = struct.unpack_from("<HHQ", data, at + 4)
            self.assertEqual((1, 0, number), (kind, device, tick))
            self.assertEqual(checksum(data[at:at + length - 8]), struct.unpack_from("<Q", data, at + length - 8)[0])
            p = at + 16
            read, flags, poses, reports = struct.unpack_from("<QQQQIBBBB", data, p)[5:]
            self.assertLessEqual(read, 2)
            self.assertEqual(0, flags & ~31)
            p += 40 + 64 * poses
            for _ in range(reports):
                p += 10 + min(128, struct.unpack_from("<H", data, p + 8)[0])
            parts = data[p]
            sample += data[p + 5]
            p += 6 + sum(size for bit, size in ((1, 48), (2, 28), (4, 24), (8, 58), (16, 17)) if parts & bit)
            self.assertEqual(at + length - 8, p)
        self.assertGreater(sample, 100)
        at, length = records[-1]
        self.assertEqual((2, 1, 0), struct.unpack_from("<HHQ", data, at + 4))
        self.assertEqual((0, len(records) - 1, 0), struct.unpack_from("<BQQ", data, at + 16))

    def test_a_changed_output_is_found_and_named(self):
        log = self.session()
        records, data = self.records(log)
        at, length = records[len(records) // 2]
        changed = bytearray(data)
        changed[at + length - 9] ^= 1  # the last byte before the checksum: of the round trip
        struct.pack_into("<Q", changed, at + length - 8, checksum(bytes(changed[at:at + length - 8])))
        done = self.servo("replay", self.write("changed.fdcglog", bytes(changed)), code=1)
        self.assertIn(f"tick {len(records) // 2}: round_trip_s: ".encode(), done.stdout)
        self.assertIn(b" in the log, ", done.stdout)

    def test_a_lost_tick_ends_the_replay(self):
        log = self.session()
        records, data = self.records(log)
        at, length = records[10]
        done = self.servo("replay", self.write("gap.fdcglog", data[:at] + data[at + length:]), code=1)
        self.assertIn(b"hand: 10 ticks, the same bit for bit; then the log lacks ticks from 10 on", done.stdout)

    def test_what_is_cut_off_or_damaged_is_told_and_the_rest_is_replayed(self):
        log = self.session()
        records, data = self.records(log)
        at = records[20][0]
        done = self.servo("replay", self.write("cut.fdcglog", data[:at + 5]), code=1)
        self.assertIn(b"hand: 20 ticks, every output the same", done.stdout)
        self.assertIn(f"byte {at}: the file ends within a record".encode(), done.stdout)
        damaged = bytearray(data)
        damaged[at + 20] ^= 0x40
        done = self.servo("replay", self.write("damaged.fdcglog", bytes(damaged)), code=1)
        self.assertIn(f"byte {at}: a record whose bytes have changed".encode(), done.stdout)
        self.assert_one_line(self.servo("replay", self.write("header.fdcglog", data[:40]), code=3), "header.fdcglog")

    def test_graphs_are_found_beside_the_log_or_where_told_and_must_be_the_same(self):
        log = self.session()
        elsewhere = self.folder / "elsewhere"
        elsewhere.mkdir()
        moved = str(shutil.move(log, elsewhere))
        graph = self.folder / "cube.fdcg"
        self.servo("replay", moved)
        graph.rename(elsewhere / "cube.fdcg")
        self.servo("replay", moved)
        (elsewhere / "cube.fdcg").rename(graph)
        graphs = self.folder / "graphs"
        graphs.mkdir()
        graph.rename(graphs / "cube.fdcg")
        self.assert_one_line(self.servo("replay", moved, code=3), "object 'cube'", "is not there", "--graphs")
        self.servo("replay", moved, "--graphs", str(graphs))
        other = self.write("other.off", "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n")
        self.fdcg("compile", other, "-o", str(graph), "-q")
        self.assert_one_line(self.servo("replay", moved, code=3), "is not the file that the session had", "--graphs")

    def test_wrong_usage(self):
        log = self.session("0.2")
        graph = self.path("cube.fdcg")
        for arguments, words in (
            ((log, "--trajectory", "x.csv"), ("--trajectory", "session's log")), ((log, "--mu-s", "1"), ("--mu-s",)),
            ((log, "--write", log), ("would overwrite",)), ((log, "-o", log), ("would overwrite",)),
            ((log, "-o", self.path("x"), "--write", self.path("x")), ("one file",)),
            ((graph, "--trajectory", "x.csv", "--write", "y"), ("--write", "session's log")), ((graph,), ("--trajectory",))):
            self.assert_one_line(self.servo("replay", *arguments, code=2), *words)
        self.assert_one_line(self.servo("replay", log, "--write", "/dev/full", code=3), "/dev/full")


class Check(ServoCase):
    def test_what_is_shipped_is_fine_by_schema_and_by_meaning(self):
        done = self.servo("check", str(EXAMPLE), *map(str, PROFILES))
        self.assertEqual(len(PROFILES) + 1, done.stdout.count(b": ok\n"))
        self.assertGreater(len(PROFILES), 3)

    def test_a_refused_scene_is_refused_by_its_schema_too(self):
        validator = jsonschema.Draft202012Validator(schema("servo-scene.schema.json"))
        validator.check_schema(validator.schema)
        cube = {"name": "cube", "file": "cube.fdcg"}
        hand = {"name": "hand", "source": "simulated"}
        for changes in (
            {"fdcg_scene": 2}, {"object": []}, {"objects": [{"name": "cube"}]}, {"devices": []},
            {"objects": [{**cube, "stiffness_n_per_m": -1}]}, {"objects": [{**cube, "pose": {"scale": 0}}]},
            {"objects": [{**cube, "motion": {"kind": "spin"}}]}, {"objects": [{**cube, "motion": {"kind": "fixed", "rate_hz": 1}}]},
            {"objects": [{**cube, "edge_friction": "glue"}]}, {"objects": [{**cube, "shading": 1}]}, {"devices": [{**hand, "profile": "fdcg-reference"}]},
            {"devices": [{"name": "hand"}]}, {"devices": [{"name": "hand", "source": "recorded"}]},
            {"objects": [{**cube, "surface": {"kind": "sphere", "radius_m": 1}}]}, {"ground": {"mu_static": -1}},
            {"objects": [{"name": "ball", "surface": {"kind": "ball"}}]}, {"gravity_m_per_s2": [0, 0]},
            {"objects": [{**cube, "motion": {"kind": "body", "mass_kg": 1, "density_kg_per_m3": 1}}]},
            {"objects": [{**cube, "motion": {"kind": "body", "mass_kg": 0}}]},
            {"objects": [{**cube, "motion": {"kind": "soft", "depth_m": 0}}]},
            {"devices": [{**hand, "turn": {"button": 0}}]}, {"devices": [{**hand, "grip": {"button": 32}}]},
            {"devices": [{**hand, "simulation": {"script": [{"at_s": 0}]}}]},
            {"devices": [{**hand, "simulation": {"script": []}}]},
            {"devices": [{**hand, "contacts": []}]}, {"devices": [{**hand, "force_limit_n": 0}]},
            {"devices": [{**hand, "contacts": [{"offset_m": [0, 0, 0], "pad_radius_m": 1e-12}]}]},
            {"devices": [{**hand, "simulation": {"rate_hz": 0}}]},
            {"devices": [{**hand, "simulation": {"faults": [{"kind": "fire", "at_s": 1}]}}]},
            {"devices": [{**hand, "mapping": {"rotation_xyzw": [0, 0, 0, 1], "rotation_matrix": [1, 0, 0, 0, 1, 0, 0, 0, 1]}}]},
            {"loop": {"servo_priority": 100}}, {"loop": {"backend": "usb"}}, {"log": {}}, {"limits": {"force_n": 0}},
        ):
            with self.subTest(changes=changes):
                path = self.scene(**changes)
                self.assertFalse(validator.is_valid(json.loads(pathlib.Path(path).read_text())))
                done = self.servo("check", path, code=1)
                self.assertEqual(1, done.stdout.count(b"\n"))
                self.assertTrue(done.stdout.startswith(path.encode() + b": "))

    def test_what_only_the_program_can_know(self):
        for name, changes, words in (
            ("a.json", {"objects": [{"name": "cube", "file": "gone.fdcg"}]}, ("objects[0] 'cube'", "gone.fdcg")),
            ("b.json", {"objects": [{"name": "cube", "file": "b.json"}]}, ("b.json",)),
            ("c.json", {"devices": [{"name": "hand", "profile": "fdcg-referense"}]}, ("did you mean 'fdcg-reference'?",)),
            ("d.json", {"log": {"file": "d.json"}}, ("d.json: cannot write the log", "would overwrite the scene")),
            ("e.json", {"log": {"file": "nowhere/e.fdcglog"}}, ("cannot write the log", "folder does not exist")),
            ("f.json", {"log": {"file": "cube.fdcg"}, "objects": []}, ("would overwrite a file that is no session's log",)),
            ("g.json", {"devices": [{"name": name, "profile": "fdcg-reference"} for name in "ab"]},
             ("devices[1]", "finds the same device as that of 'a'", "\"serial\"")),
            ("h.json", {"devices": [{"name": name, "profile": "fdcg-reference", "serial": "1", "path": "/dev/hidraw7"} for name in "ab"]},
             ("path is that of device 'a' too", "one owner")),
        ):
            done = self.servo("check", self.scene(name, **changes), code=1)
            for word in words:
                self.assertIn(word, done.stdout.decode())
        for name, word in (("g.json", "finds the same device as that of 'a'"), ("h.json", "path is that of device 'a' too")):
            self.assert_one_line(self.servo("run", self.path(name), code=3), name, word)  # one node twice

    def test_a_rate_at_which_nothing_stays_armed_is_a_warning_that_says_which_does(self):
        profile = json.loads((ROOT / "runtime/device/profiles/fdcg-reference.json").read_text())
        profile["rate_hz"] = 10
        slow = [{"name": "hand", "source": "simulated", "simulation": {"rate_hz": 10}}]
        for path in (self.scene("slow.json", devices=slow), self.write("device.json", json.dumps(profile)),
                     self.scene(devices=[{"name": "hand", "profile": "device.json"}])):
            done = self.servo("check", path)
            self.assertIn(b": ok\n", done.stdout)
            self.assertEqual(1, done.stdout.count(b"rate_hz is"), done.stdout)
            self.assertIn(b"rate_hz is 10, a report every 100 ms, and the gate disarms after 10 ms", done.stdout)
            self.assertIn(b"above 100 Hz", done.stdout)
        for rate_hz, is_armed in ((10, False), (110, True)):  # as the warning says
            slow[0]["simulation"] = {"rate_hz": rate_hz, "start_m": [0, 0, 0.03], "amplitude_m": [0, 0, 0]}
            done = self.run_scene(self.scene(devices=slow), "--arm", "--for", "3", "--fast", "--no-log")
            self.assertEqual(is_armed, b"disarmed       never" in done.stdout, done.stdout)

    def test_a_stiffness_that_the_device_does_not_bear_is_a_warning_with_the_largest_that_it_does(self):
        cube = {"name": "cube", "file": "cube.fdcg", "stiffness_n_per_m": 5000}
        hand = {"name": "hand", "source": "simulated", "simulation": {"damping_n_s_per_m": 0.5}}
        for mapping, felt in (({}, "5000"), ({"scale": 0.5}, "2500")):
            done = self.servo("check", self.scene(objects=[cube], devices=[{**hand, "mapping": mapping}])).stdout.decode()
            self.assertIn(f"object 'cube': its stiffness is felt as {felt} N/m; the device's own damping of 0.5 N s/m bears 1000 N/m at 1000 Hz", done)
        cube["stiffness_n_per_m"] = 1000
        self.assertNotIn(b"warning", self.servo("check", self.scene(objects=[cube], devices=[hand])).stdout)
        profile = json.loads((ROOT / "runtime/device/profiles/fdcg-reference.json").read_text())
        profile["limits"]["stiffness_n_per_m"] = 800
        done = self.servo("check", self.scene(objects=[cube], devices=[{"name": "hand", "profile": profile}]), code=1)
        self.assertIn(b"the profile allows 800: lower it", done.stdout)

    def test_parts_that_are_switched_off_are_told(self):
        for part in ("passivity", "calming"):
            done = self.servo("check", self.scene(stability={part: False}))
            self.assertIn(f"stability.{part} is switched off".encode(), done.stdout)
            self.assertIn(b"is switched off", self.run_scene(self.scene(stability={part: False}), "--fast", "--for", "0.1", "--no-log").stderr)

    def test_unknown_limits_are_a_warning_that_says_what_follows(self):
        profile = json.loads((ROOT / "runtime/device/profiles/fdcg-reference.json").read_text())
        del profile["limits"]
        for path in (self.write("device.json", json.dumps(profile)),
                     self.scene(devices=[{"name": "hand", "profile": "device.json"}])):
            done = self.servo("check", path)
            self.assertIn(b": ok\n", done.stdout)
            self.assertIn(b"warning: ", done.stdout)
            self.assertIn(b"limits.force_n", done.stdout)

    def test_what_is_neither_and_what_cannot_be_read(self):
        self.assertIn(b"neither a scene nor a device profile", self.servo("check", self.write("x.json", "{}"), code=1).stdout)
        for name, text in (("y.json", "[1,"), ("z.json", "")):
            self.assertIn(b"JSON", self.servo("check", self.write(name, text), code=3).stderr)
        done = self.servo("check", str(EXAMPLE), self.path("missing.json"), code=3)
        self.assertIn(b"missing.json", done.stderr)
        self.assertIn(b": ok\n", done.stdout)
        self.assert_one_line(self.servo("check", code=2), "files")


class Examples(ServoCase):
    """Each from end to end on the command line, as tools/examples runs it; what they do: tests/device/scene/examples_test.cpp."""

    def test_each_runs_without_waiting_replays_and_is_told_as_csv(self):
        scenes = EXAMPLE.parent
        shutil.copy(scenes / "sheet.off", self.folder)
        self.fdcg("compile", self.path("sheet.off"), "--triangles", "-o", self.path("sheet.fdcg"), "-q")
        validator = jsonschema.Draft202012Validator(schema("servo-scene.schema.json"))
        for name, column, contacts, devices in (("lift_cube", "cube_z", 2, 1), ("two_devices", "cube_z", 1, 2),
                                                ("hold_sphere", "ball_z", 3, 1), ("press_sheet", "sheet_dent", 1, 1)):
            with self.subTest(name):
                scene = json.loads((scenes / f"{name}.json").read_text())
                validator.validate(scene)
                path, log = self.write(f"{name}.json", json.dumps(scene)), self.path(f"{name}.fdcglog")
                self.servo("check", path)
                done = self.run_scene(path, "--arm", "--for", "8", "--fast", "--log", log, "--status", "json", codes=(0,))
                last = lines_of(done.stdout)[-1]
                jsonschema.validate(last, schema("servo-status.schema.json"))
                self.assertEqual([8000] * devices, [device["ticks"] for device in last["devices"]])
                rewritten = self.path("again.fdcglog")
                self.servo("replay", log, "-o", self.path("a.csv"), "--touches", self.path("t.csv"), "--write", rewritten)
                self.assertEqual(pathlib.Path(log).read_bytes(), pathlib.Path(rewritten).read_bytes())
                rows = list(csv.DictReader(io.StringIO(pathlib.Path(self.path("a.csv")).read_text())))
                self.assertEqual(8000 * devices, len(rows))
                values = [float(row[column]) for row in rows]
                self.assertGreater(max(values) - values[0], 0.004)
                touches = list(csv.DictReader(io.StringIO(pathlib.Path(self.path("t.csv")).read_text())))
                self.assertEqual({str(i) for i in range(contacts)}, {touch["contact"] for touch in touches})
                self.assertEqual({str(i) for i in range(devices)}, {touch["device"] for touch in touches})
                held = [touch for touch in touches if 2.1 < float(touch["t"]) < 5.7 and name != "press_sheet"]
                self.assertTrue(all(touch["slip"] == "0" and 0 < float(touch["margin"]) <= 1 for touch in held))

    def test_each_draws_its_picture(self):
        self.assertIsNotNone(shutil.which("gnuplot"), "gnuplot-nox of tools/packages draws them")
        for name in ("lift_cube", "two_devices", "hold_sphere", "press_sheet"):
            with self.subTest(name):
                shutil.copy(EXAMPLE.parent / f"{name}.json", self.folder)
                shutil.copy(EXAMPLE.parent / "sheet.off", self.folder)
                self.fdcg("compile", self.path("sheet.off"), "--triangles", "-o", self.path("sheet.fdcg"), "-q")
                log = self.path(f"{name}.fdcglog")
                self.run_scene(self.path(f"{name}.json"), "--arm", "--for", "8", "--fast", "--log", log, "-q", codes=(0,))
                self.servo("replay", log, "-o", self.path(f"{name}.csv"), "--touches", self.path(f"{name}_touches.csv"), "-q")
                done = subprocess.run(["gnuplot", "-e", f"name = '{name}'", str(ROOT / "tools" / "examples.gp")], cwd=self.folder,
                                      capture_output=True, timeout=60, check=False)
                self.assertEqual((0, b"", b""), (done.returncode, done.stdout, done.stderr))
                picture = pathlib.Path(self.path(f"{name}.png")).read_bytes()
                self.assertEqual(b"\x89PNG", picture[:4])
                self.assertGreater(len(picture), 40000)  # an empty frame has some 29 kB

    def test_only_devices_without_real_time_run_fast(self):
        hid = [{"name": "hand", "profile": "fdcg-reference"}]
        done = self.servo("run", self.scene(devices=hid), "--fast", "--for", "1", code=3)
        self.assert_one_line(done, "without --fast")
        self.assert_one_line(self.servo("run", self.scene(), "--fast", "--no-log", "-q", code=2), "--for")

    def test_a_recording_is_played_without_waiting(self):
        log, again = self.path("a.fdcglog"), self.path("b.fdcglog")
        self.run_scene(self.scene(), "--fast", "--for", "20", "--log", log, "-q", codes=(0,))
        recorded = [{"name": "hand", "source": "recorded", "recording": "a.fdcglog"}]
        before = time.monotonic()
        self.run_scene(self.scene("b.json", devices=recorded), "--fast", "--log", again, "-q", codes=(0,))
        self.assertLess(time.monotonic() - before, 15)
        forces = [[(row["fx"], row["fy"], row["fz"]) for row in
                   csv.DictReader(io.StringIO(self.servo("replay", file, "-o", "-").stdout.decode()))] for file in (log, again)]
        self.assertEqual(20000, len(forces[0]))
        self.assertEqual(forces[0], forces[1])


class Hostile(ServoCase):
    """What is no scene, no log, no number: one line that names it, and the promised exit code."""

    def setUp(self):
        super().setUp()
        for name in ("lift_cube.json", "press_sheet.json"):
            shutil.copy(EXAMPLE.parent / name, self.folder)
        self.fdcg("compile", str(EXAMPLE.parent / "sheet.off"), "--triangles", "-q", "-o", self.path("sheet.fdcg"))
        self.fdcg("compile", str(EXAMPLE.parent / "sheet.off"), "-q", "-o", self.path("polygons.fdcg"))

    def test_what_is_no_scene(self):
        (self.folder / "folder").mkdir()
        whole = pathlib.Path(self.path("lift_cube.json")).read_text()
        for name, text, words in (("empty.json", "", ("no JSON",)), ("cut.json", whole[:700], ("no JSON",)),
                                  ("list.json", "[]", ()), ("none.json", "{}", ("fdcg_scene",))):
            with self.subTest(name):
                done = self.servo("run", self.write(name, text), "--fast", "--for", "1", "--no-log", code=3)
                self.assert_one_line(done, name, *words)
        self.assert_one_line(self.servo("run", self.path("folder"), "--fast", "--for", "1", code=3), "folder")

    def test_scenes_with_a_soft_sheet(self):
        whole = pathlib.Path(self.path("press_sheet.json")).read_text()
        part = '"tension_n_per_m": 60'
        for old, new, words in ((part, '"tension_n_per_m": NaN', ("no JSON",)), (part, '"tension_n_per_m": 1e999', ("1e999",)),
                                (part, '"tension_n_per_m": -1', ("tension_n_per_m is -1", "from 0 to 1000000")),
                                (part, '"tenson_n_per_m": 60', ("tenson_n_per_m", "did you mean 'tension_n_per_m'")),
                                (part, '"radius_m": "wide"', ('radius_m is "wide"',)),
                                (part, '"radius_m": 0.5', ("objects[0] 'sheet'", "radius_m is 0.5", "lower radius_m")),
                                ('"damping_n_s_per_m": 1', '"damping_n_s_per_m": 0.01', ("1 contact presses with 1000", "raise")),
                                ('"sheet.fdcg"', '"gone.fdcg"', ("'sheet'", "gone.fdcg")),
                                ('"sheet.fdcg"', '"cube.json"', ("'sheet'",)),
                                ('"sheet.fdcg"', '"polygons.fdcg"', ("'sheet'", "--triangles"))):
            with self.subTest(new):
                self.assertIn(old, whole)
                scene = self.write("hostile.json", whole.replace(old, new, 1))
                done = self.servo("run", scene, "--fast", "--for", "0.1", "--no-log", code=3)
                self.assert_one_line(done, "hostile.json", *words)

    def test_scenes_with_a_body(self):
        for key, value, words in (("mass_kg", 0, ("mass_kg is 0", "above 0")), ("mass_kg", 1e-6, ("with 1e-06 kg it is too light",)),
                                  ("points", 1.5, ("points is 1.5",)), ("points", 10**30, ("points is 1e+30",)),
                                  ("radius_m", 1, ("radius_m",)), ("kind", "bodies", ("kind", "bodies"))):
            with self.subTest(f"{key} {value}"):
                scene = json.loads(pathlib.Path(self.path("lift_cube.json")).read_text())
                scene["objects"][0]["motion"][key] = value
                done = self.servo("run", self.write("hostile.json", json.dumps(scene)), "--fast", "--for", "0.1", "--no-log", code=3)
                self.assert_one_line(done, "objects[0]", *words)

    def test_logs_and_outputs(self):
        log = self.path("a.fdcglog")
        self.run_scene(self.path("lift_cube.json"), "--fast", "--arm", "--for", "0.3", "--log", log, "-q", codes=(0,))
        whole = pathlib.Path(log).read_bytes()
        for name, data in (("empty", b""), ("cut", whole[:5]), ("none", bytes(range(256)))):
            with self.subTest(name):
                pathlib.Path(self.path(name)).write_bytes(data)
                self.assert_one_line(self.servo("replay", self.path(name), "-o", self.path("x.csv"), code=3), name, "nor a graph")
        self.assert_one_line(self.servo("replay", str(self.folder), code=3), "nor a graph")
        self.assert_one_line(self.servo("replay", self.path("sheet.fdcg"), code=2), "--trajectory is required")
        self.assert_one_line(self.servo("replay", log, "--touches", self.path("none/x.csv"), code=3), "none/x.csv")
        self.assert_one_line(self.servo("replay", log, "-o", "/dev/full", code=3), "/dev/full")
        graph = pathlib.Path(self.path("cube.fdcg")).read_bytes()
        done = self.servo("replay", log, "--touches", self.path("cube.fdcg"), code=2)
        self.assert_one_line(done, "would overwrite the graph of 'cube'")
        self.assertEqual(graph, pathlib.Path(self.path("cube.fdcg")).read_bytes())
        self.assertFalse((self.folder / "x.csv").exists())


class Devices(ServoCase):
    def test_udev_rules_name_every_profile(self):
        rules = self.servo("devices", "--udev").stdout.decode()
        for path in PROFILES:
            match = json.loads(path.read_text())["match"]
            vendor, product = (int(str(match[key]), 0) for key in ("vendor_id", "product_id"))
            self.assertIn(f'KERNELS=="*:{vendor:04X}:{product:04X}.*"', rules)
            self.assertIn(f'ATTR{{idVendor}}=="{vendor:04x}", ATTR{{idProduct}}=="{product:04x}"', rules)
        for line in rules.splitlines():
            self.assertTrue(line == "" or line.startswith("#") or 'TAG+="uaccess"' in line, line)

    def test_a_built_in_profile_is_printed_as_it_stands(self):
        for path in PROFILES:
            printed = self.servo("devices", "--print", path.stem).stdout
            self.assertEqual(path.read_bytes(), printed)
            own = self.write("own.json", printed)
            self.servo("devices", "--profile", own, "--udev")
        self.assert_one_line(self.servo("devices", "--print", "woodenhaptic", code=2), "'woodenhaptic'", "woodenhaptics")

    def test_the_list_is_json_where_asked_for(self):
        listed = json.loads(self.servo("devices", "--json").stdout)
        self.assertIn(listed["backend"], ("hidraw", "libusb"))
        self.assertIsInstance(listed["devices"], list)
        self.servo("devices")

    def test_wrong_usage(self):
        self.assert_one_line(self.servo("devices", "--udev", "--json", code=2), "--json")
        self.assert_one_line(self.servo("devices", "--print", "openffboard", "--udev", code=2), "--print")
        self.assert_one_line(self.servo("devices", "--hid", "x", code=2), "--hid")
        self.assert_one_line(self.servo("devices", "--profile", self.path("no.json"), "--udev", code=3), "no.json")
        bad = self.write("bad.json", '{"fdcg_profile": 1}')
        self.assert_one_line(self.servo("devices", "--profile", bad, code=3), "bad.json", "is missing")


if __name__ == "__main__":
    unittest.main()
