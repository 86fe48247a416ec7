# SPDX-License-Identifier: Apache-2.0
"""fdcg-servo run beside another host, with files that change, and with lags: strikes.py."""
import json
import os
import signal
import time
import unittest

from strikes import (FOREIGN, FORCE, GONE, HANDED_OUT, LAGS, PATIENCE_S, PERIOD_S, SILENCE_S, STOOD, TAKEN, TAKEN_S, TRIPS, Event,
                     Late, Program, StrikeCase, standstill_s)


class Witnesses(StrikeCase):
    """What is excused, and what is not."""

    def test_a_program_that_is_stopped_is_seen_to_stand_still(self):
        program = self.started()
        self.feel(program)
        begin_s = time.monotonic()
        program.process.send_signal(signal.SIGSTOP)
        time.sleep(0.03)
        program.process.send_signal(signal.SIGCONT)
        time.sleep(0.05)
        events = self.device.events(self.felt)
        self.assertGreater(standstill_s(events, begin_s, time.monotonic()), 0.02)
        with self.assertRaises(Late):
            self.excuse("late", 0.02, begin_s, time.monotonic())
        with self.assertRaises(Late):
            self.excuse_disarming(program, "disarmed", {"host-late"})

    def test_a_host_that_is_late_by_itself_is_not_excused(self):
        if not self.has_witness:
            self.skipTest("no real-time priority is granted, or the host is slow")
        program = self.started()
        self.feel(program)
        end_s = time.monotonic()
        seen_s = standstill_s(self.device.events(self.felt), end_s - 0.01, end_s)
        with self.assertRaises(AssertionError):
            self.excuse("late", seen_s + 0.0001, end_s - 0.01, end_s)

    def test_standstills_of_two_processors_count_once(self):
        def stood(at_s, for_s):
            return Event((round(1e9 * at_s), STOOD, round(1e6 * for_s), 0, 0, 0, 0))
        events = [stood(1.010, 0.010), stood(1.012, 0.004), stood(1.020, 0.001), stood(1.0021, 0.0001)]
        self.assertAlmostEqual(0.013, standstill_s(events, 0.9, 1.1))
        self.assertAlmostEqual(0.007, standstill_s(events, 1.005, 1.012))
        self.assertEqual(0, standstill_s(events, 1.05, 1.1))


class Hosts(StrikeCase):
    def test_another_host_on_the_device_takes_the_force_away(self):
        program = self.started()

        def strike():
            self.device.set(foreign=self.random.randint(100, 1_000_000))

            def known(events):
                sequence = next((event.sequence for event in events if event.kind == FOREIGN), None)
                return next((event.at_s for event in events if event.kind == HANDED_OUT and event.echo == sequence), None)
            return known

        def once():
            self.strike(program, strike, {"other-host"})
            time.sleep(0.5)  # for so long a foreign echo is held against it
        self.often(once)

    def test_a_second_program_is_told_of_the_first_which_goes_on(self):
        program = self.started()

        def once():
            self.feel(program)
            disarmed, since = program.fresh_status()["disarmed"], self.device.count()
            second = self.started()
            owner = f"process {program.process.pid} ("
            self.assertTrue(self.wait(lambda: owner in second.status().get("problem", "")), second.lines[-1:] + second.errors)
            second.say("arm")
            time.sleep(0.05)
            second.say("quit")
            self.assertEqual(1, second.process.wait(timeout=PATIENCE_S))
            self.check_goes_on(program, disarmed, since)
        self.often(once)

    def test_a_node_that_stands_twice_in_a_scene_never_has_force(self):
        hand = self.description["devices"][0]
        twice = self.write("twice.json", json.dumps({**self.description, "devices": [hand, {**hand, "name": "the same"}]}))

        def once():
            program = self.started()
            self.feel(program)
            since = self.device.count()
            program.process.send_signal(signal.SIGTERM)
            program.process.wait(timeout=PATIENCE_S)
            self.judge_zero([event for event in self.device.events(since) if event.kind == TAKEN], 0)
            outputs = self.device.count()
            for refused, code in ((Program(self, self.device, "check", twice), 1), (self.started(twice), 3)):
                self.assertEqual(code, refused.process.wait(timeout=PATIENCE_S))
                for reader in refused.readers:
                    reader.join()
                self.assertIn("finds the same device", "".join(refused.lines + refused.errors))
            self.assertEqual([], [event for event in self.device.events(outputs) if event.kind == TAKEN])
        self.often(once)


class Changes(StrikeCase):
    @staticmethod
    def write_over(file, content):
        with file.open("r+b") as opened:
            opened.write(content)

    def test_a_graph_that_is_cut_written_over_replaced_or_removed_changes_nothing(self):
        graph = self.folder / "cube.fdcg"
        whole = graph.read_bytes()
        changes = {
            "cut": lambda: os.truncate(graph, self.random.randrange(4096)),
            "written over": lambda: self.write_over(graph, b"x" * len(whole)),
            "removed": graph.unlink,
            "replaced": lambda: graph.write_bytes(b"another"),
        }
        log = self.path("session.fdcglog")
        program = self.started(self.scene, "--log", log)
        for name, change in changes.items():
            with self.subTest(change=name):
                def once(change=change):
                    graph.write_bytes(whole)
                    self.feel(program)
                    disarmed, since = program.fresh_status()["disarmed"], self.device.count()
                    change()
                    time.sleep(0.2)
                    self.check_goes_on(program, disarmed, since)
                self.often(once)
        program.say("quit")
        self.assertIn(program.process.wait(timeout=PATIENCE_S), (0, 1))
        graph.write_bytes(whole)
        self.assertIn(b"every output the same", self.servo("replay", log).stdout)

    def test_a_device_that_describes_itself_otherwise_gets_no_force(self):
        program = self.started()

        def once():
            self.feel(program)
            since = self.device.count()
            self.device.set(is_unplugged=1)
            self.assertTrue(self.wait(lambda: program.status()["connection"] == "absent"))
            # version, number of axes, what they measure, counts, rate
            self.device.set(wrong_byte=self.random.choice((1, 3, 4, 6, 29)), is_unplugged=0)
            told = ("feature report says", "the device measures")
            self.assertTrue(self.wait(lambda: any(words in program.status().get("problem", "") for words in told)), program.lines[-1])
            program.say("arm")
            time.sleep(self.random.uniform(0.1, 0.3))
            events = self.device.events(since)
            gone = next(event.at_s for event in events if event.kind == GONE)
            self.assertEqual([], [event for event in events if event.kind == TAKEN and event.at_s > gone])
            self.assertEqual(0, [event for event in events if event.kind == FORCE][-1].force_n)
            self.device.set(is_unplugged=1)
            time.sleep(0.3)
            self.device.set(wrong_byte=0, is_unplugged=0)
            self.assertTrue(self.wait(lambda: program.status()["connection"] == "open"))
        self.often(once)


class Lags(StrikeCase):
    def check_lag(self, lag_s):
        program = self.started()

        def once():
            is_of_outputs = lag_s < SILENCE_S or self.random.random() < 0.5
            if lag_s < SILENCE_S:
                known_after_s = lag_s + (TRIPS + 1) * PERIOD_S
            else:
                known_after_s = TAKEN_S + PERIOD_S if is_of_outputs else 3.5 * PERIOD_S

            def strike():
                self.device.set(**{"output_lag_us" if is_of_outputs else "report_lag_us": round(1e6 * lag_s)})

                def known(events):
                    begun = next((event.at_s for event in events if event.kind == LAGS), None)
                    return None if begun is None else begun + known_after_s
                return known
            try:
                reasons = {"lag"} if lag_s < SILENCE_S else {"not-taken"} if is_of_outputs else {"silence"}
                self.strike(program, strike, reasons)
                self.device.set(is_pressing=0)
                time.sleep(0.35)
                since = self.device.count()
                for _ in range(3):
                    program.say("arm")
                    time.sleep(0.1)
                program.fresh_status()
                outputs = [event for event in self.device.events(since) if event.kind == TAKEN]
                self.assertGreater(len(outputs), 100)
                self.assertEqual(0, sum(event.is_enable for event in outputs), "it was armed while what is sent comes back too late")
            finally:
                self.device.set(report_lag_us=0, output_lag_us=0)
                time.sleep(0.1)
        self.often(once)

    def test_a_constant_lag_of_5_ms(self):
        self.check_lag(0.005)

    def test_a_constant_lag_of_15_ms(self):
        self.check_lag(0.015)

    def test_a_constant_lag_of_30_ms(self):
        self.check_lag(0.030)


if __name__ == "__main__":
    unittest.main()
