# SPDX-License-Identifier: Apache-2.0
"""The log of a session in a page: its numbers are those of fdcg-servo replay, tick by tick."""
import math
import struct
import unittest

from pages import Page, SessionCase

DEVICE, CONTACT, POSE = 7, 12, 7  # numbers of a frame
STATES = ("free", "face", "edge", "vertex")
PHASES = ("disarmed", "ramping", "armed", "fading")


def three(row, prefix):
    return [float(row[f"{prefix}{axis}"]) for axis in "xyz"]


class World:
    """The arrays of one world, unpacked."""

    def __init__(self, page, session, index=0):
        ref = session["worlds"][index]
        self.ticks_per_frame = ref["ticks_per_frame"]
        self.time = self.unpacked(page, ref["time"], "d")
        self.devices = [(device["name"], device["pads"], self.unpacked(page, device["numbers"], "f"), page.words(device["words"])) for device in ref["devices"]]
        self.moving = ref["moving"]
        self.poses = self.unpacked(page, ref["poses"], "f")
        self.soft = [(soft["object"], soft["corners"], self.unpacked(page, soft["time"], "d"), self.unpacked(page, soft["moved"], "f")) for soft in ref["soft"]]

    @staticmethod
    def unpacked(page, ref, kind):
        data = page.array(ref)
        return struct.unpack(f"<{len(data) // struct.calcsize(kind)}{kind}", data)

    def numbers(self, device, frame):
        _, pads, numbers, words = self.devices[device]
        stride = DEVICE + CONTACT * len(pads)
        return numbers[frame * stride:(frame + 1) * stride], words[frame * (1 + len(pads)):(frame + 1) * (1 + len(pads))]

    def pose(self, frame, k):
        at = POSE * (frame * len(self.moving) + k)
        return self.poses[at:at + POSE]


class Session(SessionCase):
    def near(self, expected, found, unit=1):
        for a, b in zip(expected, found, strict=True):
            self.assertLessEqual(abs(a - b), 1e-6 * max(unit, abs(a)), (expected, found))

    def compare(self, scene, seconds):
        log = self.session(scene, seconds)
        item, = (page := Page(self.view(log))).items
        session = item["session"]
        self.assertTrue(session["same"])
        self.assertEqual([], session["remarks"])
        world = World(page, session)
        rows, touches = self.replayed(log)
        names = [fault["name"] for fault in session["faults"]]
        seen = set()
        for row in rows:
            device, frame = int(row["device"]), int(row["tick"])
            numbers, words = world.numbers(device, frame)
            self.near(three(row, "f"), numbers[:3])
            self.near(three(row, "sent_f"), numbers[3:6])
            self.assertAlmostEqual(math.dist(three(row, "f"), (0, 0, 0)), numbers[6], delta=1e-5)
            self.assertEqual((row["state"], int(row["slip"]), row["phase"], row["fault"]),
                             (STATES[words[0] & 3], words[0] >> 2 & 1, PHASES[words[0] >> 3 & 3], names[words[0] >> 5]))
            self.near([float(row["t"])], [world.time[frame]]) if device + 1 == len(world.devices) else None
            seen.add(row["state"])
            for k, body in enumerate(world.moving):
                name = session["objects"][body]["name"]
                self.near(three(row, f"{name}_"), world.pose(frame, k)[:3])
                self.near([float(row[f"{name}_q{axis}"]) for axis in "xyzw"], world.pose(frame, k)[3:])
        return session, world, touches, seen, rows

    def assert_touches(self, session, world, touches):
        objects = [each["name"] for each in session["objects"]]
        most = {}
        for touch in touches:
            key = (int(touch["device"]), int(touch["tick"]), int(touch["contact"]))
            if key not in most or math.hypot(*three(touch, "f")) > math.hypot(*three(most[key], "f")):
                most[key] = touch
        self.assertGreater(len(most), 100)
        for (device, tick, contact), touch in most.items():
            numbers, words = world.numbers(device, tick)
            at = DEVICE + CONTACT * contact
            self.near(three(touch, "go_"), numbers[at + 3:at + 6])
            self.near(three(touch, "f"), numbers[at + 6:at + 9])
            word = words[1 + contact]
            self.assertEqual((touch["state"], int(touch["slip"]), touch["object"]), (STATES[word & 3], word >> 2 & 1, objects[word >> 3]))
            if touch["load"]:  # the normal is the one that the load was measured along
                self.assertAlmostEqual(float(touch["load"]), sum(n * f for n, f in zip(numbers[at + 9:at + 12], numbers[at + 6:at + 9])), delta=1e-4)

    def test_fingers_and_a_body(self):
        session, world, touches, seen, _ = self.compare("lift_cube", 4)
        self.assertIn("face", seen)
        self.assertEqual(2, len(world.devices[0][1]))
        self.assert_touches(session, world, touches)
        self.assertGreater(max(world.pose(frame, 0)[2] for frame in range(len(world.time))), 0.05)  # lifted
        self.assertEqual([0, 0, 1], session["ground"]["normal"])

    def test_two_devices_and_their_pads(self):
        session, world, touches, _, _ = self.compare("two_devices", 3)
        self.assertEqual([("thumb", [0.006]), ("finger", [0.006])], [(name, pads) for name, pads, _, _ in world.devices])
        self.assert_touches(session, world, touches)

    def test_a_sheet_moves_corner_by_corner(self):
        _, world, _, _, rows = self.compare("press_sheet", 3)
        (_, corners, times, moved), = world.soft
        dents = {round(float(row["t"]), 9): float(row["sheet_dent"]) for row in rows}
        compared = 0
        for i, t in enumerate(times):
            if round(t, 9) not in dents:
                continue
            sample = moved[3 * corners * i:3 * corners * (i + 1)]
            self.assertAlmostEqual(dents[round(t, 9)], max(math.hypot(*sample[k:k + 3]) for k in range(0, len(sample), 3)), delta=1e-7)
            compared += 1
        self.assertGreater(compared, 100)
        self.assertGreater(max(dents.values()), 0.005)

    def test_surfaces_have_their_sizes(self):
        session, _, _, seen, _ = self.compare("surfaces", 10)
        kinds = [each["surface"]["kind"] for each in session["objects"]]
        self.assertEqual(["plane", "sphere", "box", "cylinder", "cone", "torus", "ellipsoid", "capsule"], kinds)
        self.assertEqual((0.016, 0.007), (session["objects"][5]["surface"]["radius"], session["objects"][5]["surface"]["tube_radius"]))
        self.assertIn("face", seen)

    def test_a_long_log_keeps_the_largest_force_slip_and_faults(self):
        log = self.session("cube", 70)
        page = Page(self.view(log))
        world = World(page, page.items[0]["session"])
        rows, _ = self.replayed(log)
        self.assertEqual(2, world.ticks_per_frame)
        self.assertLess(len(world.time), 60_000)
        largest, slipped, last = {}, {}, {}
        for row in rows:
            frame = int(row["tick"]) // 2
            largest[frame] = max(largest.get(frame, 0), math.hypot(*three(row, "f")))
            slipped[frame] = slipped.get(frame, 0) | int(row["slip"])
            last[frame] = row
        for frame, force in largest.items():
            numbers, words = world.numbers(0, frame)
            self.assertAlmostEqual(force, numbers[6], delta=1e-5)
            self.assertEqual(slipped[frame], words[0] >> 2 & 1)
            self.near([float(last[frame]["t"])], [world.time[frame]], 100)
        self.assertIn(1, slipped.values())


class Wrong(SessionCase):
    def test_a_graph_that_is_gone_is_named_and_found_again(self):
        log = self.session("lift_cube", 1)
        (self.folder / "elsewhere").mkdir()
        (self.folder / "cube.fdcg").rename(self.folder / "elsewhere" / "cube.fdcg")
        self.assert_one_line(self.fdcg("view", log, "-o", self.path("p.html"), code=3), "cube.fdcg")
        self.assertFalse((self.folder / "p.html").exists())
        self.view(log, "--graphs", self.path("elsewhere"))

    def test_a_log_that_was_cut_off_says_so_in_the_page(self):
        log = self.session("lift_cube", 1)
        whole = (self.folder / "lift_cube.fdcglog").read_bytes()
        (self.folder / "lift_cube.fdcglog").write_bytes(whole[:len(whole) * 2 // 3])
        session = Page(self.view(log)).items[0]["session"]
        self.assertFalse(session["same"])
        self.assertEqual(1, len(session["remarks"]))
        self.assertIn("lift_cube.fdcglog", session["remarks"][0])


if __name__ == "__main__":
    unittest.main()
