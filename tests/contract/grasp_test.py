# SPDX-License-Identifier: Apache-2.0
"""fdcg grasp: what it says of grasps that can be worked out by hand, of random ones against CVXOPT, and of wrong
input. Over 400 lines: the table of wrong inputs is long."""
import concurrent.futures
import json
import math
import os
import random
import pathlib
import re
import subprocess
import traceback
import unittest

import jsonschema
import numpy

import grasp_reference as reference
from support import CUBE, FDCG, ROOT, Case

SCHEMA = json.loads((ROOT / "schemas" / "grasp-report.schema.json").read_text())
CENTRED_CUBE = re.sub(r"(?m)^([01]) ([01]) ([01])$", lambda m: " ".join(str(2 * int(c) - 1) for c in m.groups()), CUBE)  # side 2 m


def octahedron_sphere(rounds=3):
    """A ball of triangles, radius 1, corners on the axes."""
    points = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]
    faces = [(x, y, z) if (x + y + z) % 2 == 0 else (x, z, y) for x in (0, 1) for y in (2, 3) for z in (4, 5)]
    for _ in range(rounds):
        middles, finer = {}, []

        def middle(a, b):
            key = (min(a, b), max(a, b))
            if key not in middles:
                m = [(p + q) / 2 for p, q in zip(points[a], points[b])]
                points.append(tuple(c / math.hypot(*m) for c in m))
                middles[key] = len(points) - 1
            return middles[key]

        for a, b, c in faces:
            ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
            finer += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        faces = finer
    rows = [" ".join(map(repr, p)) for p in points] + [f"3 {a} {b} {c}" for a, b, c in faces]
    return f"OFF\n{len(points)} {len(faces)} 0\n" + "\n".join(rows) + "\n"


def contact(*point, **more):
    return {"point": list(point), **more}


class GraspCase(Case):
    def judge(self, mesh, contacts, *options, code=None):
        """The report; any exit code but a failure's."""
        self.write("contacts.json", json.dumps({"contacts": contacts}))
        where = mesh if mesh.startswith("/") else self.path(mesh)
        report_file = self.path("report.json")
        command = ("grasp", where, "--contacts", self.path("contacts.json"), "--json", "-o", report_file, *options)
        done = subprocess.run((FDCG, *command), stdin=subprocess.DEVNULL, capture_output=True, timeout=120, check=False)
        self.assertIn(done.returncode, (0, 1) if code is None else (code,), done.stderr)
        report = json.loads((self.folder / "report.json").read_text())
        jsonschema.validate(report, SCHEMA)
        return report


class ByHand(GraspCase):
    def setUp(self):
        super().setUp()
        self.write("cube.off", CENTRED_CUBE)
        self.two = [contact(1, 0, 0), contact(-1, 0, 0)]
        self.six = [contact(*(s * e for e in row)) for row in ((1, 0, 0), (0, 1, 0), (0, 0, 1)) for s in (1, -1)]

    def test_two_hard_fingers_turn_about_their_line_and_soft_ones_do_not(self):
        hard = self.judge("cube.off", self.two, "--mu", "0.5", "--torque-scale", "1", code=1)
        self.assertEqual(("no-closure", True), (hard["closure"]["verdict"], hard["closure"]["is_flat"]))
        weakest = hard["closure"]["weakest"]
        self.assertAlmostEqual(1, abs(weakest["torque_nm"][0]), 9)
        self.assertEqual(0, hard["epsilon"]["value"])
        soft = self.judge("cube.off", self.two, "--mu", "0.5", "--torque-scale", "1", "--torsion", "0.1", code=0)
        self.assertEqual("closure", soft["closure"]["verdict"])
        self.assertAlmostEqual(0.1, soft["epsilon"]["value"], 9)  # the moment about the line is the weakest
        self.assertAlmostEqual(1, abs(soft["epsilon"]["weakest"]["torque_nm"][0]), 6)

    def test_two_fingers_hold_twice_mu_times_their_press(self):
        for mu in (0.1, 0.5, 1.2):
            report = self.judge("cube.off", self.two, "--mu", str(mu), "--cap", "10", "--load", "0,0,-1", code=1)
            margin = report["margin"]
            self.assertAlmostEqual(20 * mu, margin["load_factor"], 7)
            self.assertAlmostEqual(20 * mu, margin["upper"], 7)
            for force in margin["contacts"]:
                self.assertAlmostEqual(10, force["press_n"], 7)
                self.assertAlmostEqual(1, force["used"], 7)
                self.assertAlmostEqual(0.5, force["carried"], 7)
                self.assertAlmostEqual(mu * 10, force["tangential_n"][2], 6)
                self.assertAlmostEqual(0, force["load_factor_without"], 9)

    def test_a_load_through_a_fingers_normal_is_held_up_to_its_cap(self):
        margin = self.judge("cube.off", self.two, "--mu", "0.5", "--cap", "10", "--load", "-3,0,0", code=1)["margin"]
        self.assertAlmostEqual(10 / 3, margin["load_factor"], 9)
        self.assertAlmostEqual(0, margin["contacts"][0]["press_n"], 6)

    def test_a_torque_about_the_line_needs_soft_fingers(self):
        twist = ("--mu", "0.5", "--cap", "10", "--load", "0,0,0,0.3,0,0")
        self.assertEqual(0, self.judge("cube.off", self.two, *twist, code=1)["margin"]["load_factor"])
        soft = self.judge("cube.off", self.two, *twist, "--torsion", "0.02", code=0)["margin"]
        self.assertAlmostEqual(2 * 10 * 0.02 / 0.3, soft["load_factor"], 8)
        self.assertAlmostEqual(-0.3 * soft["load_factor"] / 2, -abs(soft["contacts"][0]["moment_nm"]), 7)

    def test_six_contacts_without_friction_hold_no_turning(self):
        report = self.judge("cube.off", self.six, "--mu", "0", code=1)
        self.assertEqual(("no-closure", True), (report["closure"]["verdict"], report["closure"]["is_flat"]))

    def test_six_contacts_with_friction(self):
        # u = (1,..,1) / sqrt 6 has support c / sqrt 6, c = 1 for mu 1/2 and torque scale 1 here; nothing is lower
        report = self.judge("cube.off", self.six, "--mu", "0.5", "--torque-scale", "1", "--epsilon", "together", code=0)
        self.assertAlmostEqual(1 / math.sqrt(6), report["epsilon"]["value"], 8)
        self.assertLess(report["epsilon"]["value"] - report["epsilon"]["lower"], 1e-5)

    def test_frictionless_contacts_in_general_place_are_a_polytope(self):
        # seven or more normals can close; fewer never (Somoff 1900)
        rng = random.Random(1900)
        closed = 0
        for count in (6, 7, 12):
            for _ in range(6):
                contacts = []
                for _ in range(count):
                    axis, sign = rng.randrange(3), rng.choice((1, -1))
                    point = [rng.uniform(-0.9, 0.9) for _ in range(3)]
                    point[axis] = sign
                    contacts.append(contact(*point))
                report = self.judge("cube.off", contacts, "--mu", "0")
                closed += report["closure"]["verdict"] == "closure"
                if count == 6:
                    self.assertEqual("no-closure", report["closure"]["verdict"])
        self.assertGreater(closed, 1)

    def test_three_fingers_on_an_equator_close_with_any_friction(self):
        self.write("sphere.off", octahedron_sphere(1))
        turned = [contact(math.cos(a), math.sin(a), 0, normal=[-math.cos(a), -math.sin(a), 0]) for a in (0, 2 * math.pi / 3, 4 * math.pi / 3)]
        for mu in (0.05, 0.5):
            self.assertEqual("closure", self.judge("sphere.off", turned, "--mu", str(mu), code=0)["closure"]["verdict"])
        report = self.judge("sphere.off", turned, "--mu", "0", code=1)
        self.assertEqual("no-closure", report["closure"]["verdict"])

    def test_fingers_on_one_side_never_close(self):
        report = self.judge("cube.off", [contact(1, y, z) for y in (-0.5, 0.5) for z in (-0.5, 0.5)], "--mu", "0.9", code=1)
        self.assertEqual(("no-closure", False), (report["closure"]["verdict"], report["closure"]["is_flat"]))
        self.assertLess(report["closure"]["upper"], -0.1)

    def test_a_cone_that_just_does_not_reach_is_told_from_one_that_just_does(self):
        # fingers on neighbouring faces, normals at right angles: their line is at 45 degrees to both, so mu = 1 is the limit
        pair = [contact(1, 0, 0), contact(0, 1, 0)]
        for mu, verdict in ((1 - 1e-6, "no-closure"), (1 + 1e-6, "closure")):
            report = self.judge("cube.off", pair, "--mu", str(mu), "--torsion", "0.3")
            self.assertEqual(verdict, report["closure"]["verdict"], (mu, report["closure"]))
        self.assertEqual("marginal", self.judge("cube.off", pair, "--mu", "1", "--torsion", "0.3", code=1)["closure"]["verdict"])

    def test_effort_of_each_is_more_than_of_all_together(self):
        together = self.judge("cube.off", self.two, "--mu", "0.5", "--torsion", "0.1", "--torque-scale", "1")["epsilon"]
        each = self.judge("cube.off", self.two, "--mu", "0.5", "--torsion", "0.1", "--torque-scale", "1", "--epsilon", "each")["epsilon"]
        self.assertAlmostEqual(0.1, together["value"], 9)
        # a push along the line spares one of the two: that of a tenth of the twist costs nothing and makes it longer
        self.assertAlmostEqual(0.2 / math.sqrt(1.01), each["value"], 9)

    def test_centre_and_scale_are_the_volumes_unless_given(self):
        shifted = "\n".join(f"{float(l.split()[0]) + 5} {l.split()[1]} {l.split()[2]}" if 1 < i < 10 else l
                            for i, l in enumerate(CENTRED_CUBE.splitlines())) + "\n"
        self.write("moved.off", shifted)
        about = self.judge("moved.off", [contact(6, 0, 0)], "--mu", "1", "--scale", "0.5", code=1)["object"]
        for axis, expected in enumerate((2.5, 0, 0)):
            self.assertAlmostEqual(expected, about["centre_m"][axis], 12)
        self.assertAlmostEqual(math.sqrt(3) / 2, about["torque_scale_m"], 12)
        about = self.judge("moved.off", [contact(6, 0, 0)], "--mu", "1", "--centre", "1,2,3", "--torque-scale", "7", code=1)["object"]
        self.assertEqual(([1, 2, 3], 7), (about["centre_m"], about["torque_scale_m"]))

    def test_the_centre_changes_no_verdict(self):
        rng = random.Random(40)
        verdicts = set()
        for mu, grip in ((0.5, "30"), (0.3, "3"), (0.15, "12"), (0, "30")):
            contacts = [contact(1, rng.uniform(-0.8, 0.8), rng.uniform(-0.8, 0.8)), contact(-1, rng.uniform(-0.8, 0.8), 0.4), contact(-1, 0.1, -0.6)]
            hold = ("--mu", str(mu), "--grip", grip, "--mass", "0.3", "--gravity", "1,-2,-9")
            first = self.judge("cube.off", contacts, *hold)
            verdicts.add((first["closure"]["verdict"], first["margin"]["holds"]))
            for size in (1, 10, 1e4):
                about = ",".join(repr(size * rng.uniform(-1, 1)) for _ in range(3))
                other = self.judge("cube.off", contacts, *hold, "--centre", about)
                self.assertEqual(first["closure"]["verdict"], other["closure"]["verdict"])
                self.assertAlmostEqual(first["margin"]["load_factor"], other["margin"]["load_factor"], 7)
                self.assertEqual(first["object"]["com_m"], other["object"]["com_m"])
        self.assertGreater(len(verdicts), 1)  # they do differ between grasps

    def test_the_load_acts_at_the_centre_of_mass(self):
        # two soft fingers on the x axis: a weight beside their line turns the cube about it, against their torsion
        hold = ("--mu", "0.5", "--cap", "10", "--torsion", "0.2", "--load", "0,0,-1")
        margin = self.judge("cube.off", self.two, *hold, "--com", "0,0.3,0", "--centre", "0,0,0", code=0)["margin"]
        self.assertAlmostEqual(-0.3, margin["load"]["torque_nm"][0], 12)
        # limit surface of each: (f / 5)^2 + (m / 2)^2 <= 1 with f = 1 / 2, m = 0.3 / 2 of the load
        self.assertAlmostEqual(1 / math.hypot(0.5 / 5, 0.15 / 2), margin["load_factor"], 7)
        again = self.judge("cube.off", self.two, *hold, "--com", "0,0.3,0", "--centre", "3,-2,1", code=0)["margin"]
        self.assertAlmostEqual(margin["load_factor"], again["load_factor"], 7)

    def test_a_pads_radius_is_torsion_over_mu(self):
        by_torsion = self.judge("cube.off", self.two, "--mu", "0.5", "--torsion", "0.1")
        by_radius = self.judge("cube.off", self.two, "--mu", "0.5", "--pad-radius", "0.2")
        in_file = self.judge("cube.off", [contact(*c["point"], pad_radius=0.2) for c in self.two], "--mu", "0.5")
        self.assertEqual(by_torsion, by_radius)
        self.assertEqual(by_torsion, in_file)

    def test_a_normal_that_points_out_of_the_object_is_warned_of(self):
        report = self.judge("cube.off", [contact(1, 0, 0, normal=[1, 0, 0]), contact(-1, 0, 0, normal=[1, 0, 0])], "--mu", "0.5")
        self.assertEqual(1, len(report["warnings"]), report["warnings"])
        self.assertIn("contact 0: its normal points out of the object", report["warnings"][0])

    def test_points_go_to_the_surface_and_normals_come_from_it(self):
        report = self.judge("cube.off", [contact(1.3, 0.2, 0.1), contact(0.2, 0.3, 0.6), contact(1, 1, 0.2)], "--mu", "1")
        first, inside, edge = report["contacts"]
        for got, expected in ((first["point_m"], (1, 0.2, 0.1)), (first["inward"], (-1, 0, 0)), (inside["point_m"], (0.2, 0.3, 1)),
                              (inside["inward"], (0, 0, -1))):
            for g, e in zip(got, expected):
                self.assertAlmostEqual(e, g, 12)
        self.assertAlmostEqual(0.3, first["distance_m"], 12)
        self.assertEqual((False, False, True), (first["is_on_edge"], inside["is_on_edge"], edge["is_on_edge"]))
        self.assertEqual(3, len(report["warnings"]))

    def test_mesh_and_graph_give_the_same_report(self):
        self.fdcg("compile", self.path("cube.off"), "-o", self.path("cube.fdcg"), "-q")
        reports = [self.judge(name, self.six, "--mu", "0.3", "--grip", "5") for name in ("cube.off", "cube.fdcg")]
        self.fdcg("compile", self.path("cube.off"), "-o", self.path("bare.fdcg"), "-q", "--without", "mass")
        reports.append(self.judge("bare.fdcg", self.six, "--mu", "0.3", "--grip", "5"))
        for report in reports:
            del report["object"]["file"]
        self.assertEqual(reports[0], reports[1])
        self.assertEqual(reports[0], reports[2])

    def test_a_files_mass_is_what_pulls(self):
        self.fdcg("compile", self.path("cube.off"), "-o", self.path("cube.fdcg"), "-q", "--mass", "3")
        for options, kilograms in (((), 3), (("--mass", "2"), 2)):
            margin = self.judge("cube.fdcg", self.two, "--mu", "0.5", "--grip", "100", *options, code=1)["margin"]
            self.assertAlmostEqual(-9.80665 * kilograms, margin["load"]["force_n"][2], 12)
            self.assertAlmostEqual(100 * 0.5 / (9.80665 * kilograms), margin["load_factor"], 8)


class AgainstCvxopt(GraspCase):
    """Random grasps; FDCG_GRASP_TRIALS sets how many. tools/nightly judges two thousand."""
    START_LIMIT = 60

    def random_contacts(self, rng):
        contacts = []
        mu, soft = rng.uniform(0.05, 1), rng.choice((0, 0, rng.uniform(0.01, 0.3)))
        for _ in range(rng.randint(3, 7)):
            point = numpy.array([rng.gauss(0, 1) for _ in range(3)])
            point /= numpy.linalg.norm(point)
            normal = -point + 0.3 * numpy.array([rng.gauss(0, 1) for _ in range(3)])
            contacts.append(contact(*point, normal=list(normal), mu=mu * rng.uniform(0.8, 1.2), torsion=soft, cap=rng.uniform(1, 20)))
        return contacts

    def check_closure(self, maps, report):
        depth, span = reference.closure_depth(maps)
        closure = report["closure"]
        if span < 1e-8 or depth is None or abs(depth) < 1e-7:
            return False  # too near to call for a solver of tolerances
        self.assertEqual("closure" if depth > 0 else "no-closure", closure["verdict"], (depth, span, closure))
        return depth > 0

    def check_epsilon(self, maps, report, rng):
        """How far the least of the reference's local minima is from the value: none is lower, and one is it."""
        found = report["epsilon"]
        self.assertTrue(found["is_tight"], found)
        scale = report["object"]["torque_scale_m"]
        weakest = numpy.concatenate((found["weakest"]["force_n"], numpy.array(found["weakest"]["torque_nm"]) / scale))
        self.assertAlmostEqual(1, numpy.linalg.norm(weakest), 9)
        self.assertAlmostEqual(found["value"], reference.support(maps, -weakest), 9)  # the value is met
        self.assertGreaterEqual(found["value"], found["lower"])
        solved = math.inf
        for start in range(self.START_LIMIT):
            if start >= 5 and solved < found["value"] + 1e-6:
                break
            direction = numpy.array([rng.gauss(0, 1) for _ in range(6)])
            if start == 0:
                direction = -weakest + 0.3 * direction
            solved = min(solved, reference.descend(maps, direction / numpy.linalg.norm(direction))[0])
        self.assertLess(abs(solved - found["value"]), 1e-6)
        return abs(solved - found["value"])

    def check_margin(self, maps, report):
        margin, scale = report["margin"], report["object"]["torque_scale_m"]
        load = numpy.concatenate((margin["load"]["force_n"], numpy.array(margin["load"]["torque_nm"]) / scale))
        caps = [c["cap_n"] for c in report["contacts"]]
        solved = reference.load_factor(maps, load, caps, margin["grip_n"])
        off = abs(margin["load_factor"] - solved) / max(1, solved)
        self.assertLess(off, 1e-6)
        total = margin["load_factor"] * load  # what the forces told of leave unbalanced
        for contact_, force in zip(report["contacts"], margin["contacts"]):
            normal = numpy.array(contact_["inward"])
            push = force["press_n"] * normal + force["tangential_n"]
            arm = numpy.array(contact_["point_m"]) - report["object"]["centre_m"]
            total = total + numpy.concatenate((push, (numpy.cross(arm, push) + force["moment_nm"] * normal) / scale))
            friction = numpy.hypot(numpy.linalg.norm(force["tangential_n"]) / contact_["mu"],
                                   force["moment_nm"] / contact_["torsion_m"] if contact_["torsion_m"] else 0)
            self.assertLessEqual(friction, force["press_n"] * (1 + 1e-9) + 1e-12)
            self.assertLessEqual(force["press_n"], contact_["cap_n"] * (1 + 1e-9))
        self.assertLess(numpy.linalg.norm(total), 1e-6)
        self.assertAlmostEqual(1, sum(f["carried"] for f in margin["contacts"]), 6)
        return off

    def check_grasp(self, trial):
        """Whether it closes, and how far epsilon and margin are off."""
        rng = random.Random(2004 + trial)
        load = ",".join(str(rng.gauss(0, 1)) for _ in range(6))
        report = self.judge("sphere.off", self.random_contacts(rng), "--grip", str(rng.uniform(2, 30)), "--load", load)
        maps = reference.wrench_maps(report)
        if not self.check_closure(maps, report):
            return 0, 0, 0
        return 1, self.check_epsilon(maps, report, rng), self.check_margin(maps, report)

    def test_random_grasps(self):
        trials = int(os.environ.get("FDCG_GRASP_TRIALS", "200"))
        with concurrent.futures.ProcessPoolExecutor() as pool:  # as many as there are cores
            outcomes = list(pool.map(check_grasp, range(trials), chunksize=4))
        wrong = [f"grasp {trial}: {outcome}" for trial, outcome in enumerate(outcomes) if isinstance(outcome, str)]
        self.assertEqual([], wrong)
        closed, epsilons, margins = zip(*outcomes)
        self.assertGreater(sum(closed), trials // 8)
        print(f"{sum(closed)} of {trials} grasps close; at most {max(epsilons):.2e} between epsilon and CVXOPT's least, "
              f"{max(margins):.2e} of the margin")


def check_grasp(trial):
    """In a process of its own: the outcome, or what is wrong."""
    case = AgainstCvxopt("test_random_grasps")
    case.setUp()
    try:
        case.write("sphere.off", octahedron_sphere())
        return case.check_grasp(trial)
    except Exception:  # not to be lost on the way back
        return traceback.format_exc()
    finally:
        case.doCleanups()


class Input(GraspCase):
    def setUp(self):
        super().setUp()
        self.cube = self.write("cube.off", CENTRED_CUBE)
        self.fingers = self.write("fingers.csv", "x,y,z\n1,0,0\n-1,0,0\n")

    def test_csv_and_json_say_the_same(self):
        csv = self.write("c.csv", "name, x, y, z, mu, torsion, cap, nx, ny, nz\r\nthumb, 1, 0, 0, 0.5, 0.1, 7, -2, 0, 0\n\nindex,-1,0,0,0.4,,,,,\n")
        both = [contact(1, 0, 0, name="thumb", mu=0.5, torsion=0.1, cap=7, normal=[-2, 0, 0]), contact(-1, 0, 0, name="index", mu=0.4)]
        from_json = self.judge("cube.off", both)
        done = self.fdcg("grasp", self.cube, "--contacts", csv, "--json", code=0)
        self.assertEqual(from_json, json.loads(done.stdout))
        self.write("list.json", json.dumps(both))
        done = self.fdcg("grasp", self.cube, "--contacts", self.path("list.json"), "--json", code=0)
        self.assertEqual(from_json, json.loads(done.stdout))

    def test_wrong_contacts_are_code_3_and_named(self):
        for text, words in (
            ("", ("empty",)),
            ("x,y\n1,2\n", ("line 1", "x, y, z")),
            ("x,y,z,tortion\n1,2,3,4\n", ("'tortion'", "'torsion'")),
            ("x,y,z,x\n1,2,3,4\n", ("twice",)),
            ("x,y,z,nx\n1,2,3,4\n", ("nx, ny, nz",)),
            ("x,y,z\n1,2\n", ("line 2", "2 fields", "3")),
            ("x,y,z\n1,2,nan\n", ("line 2", "z 'nan'")),
            ("x,y,z\n1,2,\n", ("line 2", "z ''")),
            ("x,y,z\n", ("no contacts",)),
            ("x,y,z,nx,ny,nz\n1,0,0,0,0,0\n", ("contact 0", "no direction")),
            ("[]", ("contacts is a list of 0", "1 to 1000")),
            ("[1]", ("contacts[0] is 1", "an object")),
            ("{\"points\": []}", ("points", "contacts")),
            ("{\"contacts\": 3}", ("contacts is 3", "a list")),
            ("[{\"point\": [1, 2]}]", ("contacts[0].point is a list of 2", "3 numbers")),
            ("[{\"point\": [1, 2, \"3\"]}]", ("contacts[0].point[2] is \"3\"",)),
            ("[{\"mu\": 1}]", ("contacts[0].point is missing",)),
            ("[{\"point\": [1, 2, 3], \"nu\": 1}]", ("contacts[0] has 'nu'", "did you mean 'mu'")),
            ("[{\"point\": [1, 2, 3], \"name\": 1}]", ("contacts[0].name is 1", "text")),
            ("[{\"point\": [1, 2, 3]}", ("no JSON: line 1, column 22",)),
            ("{\"contacts\": [{\"point\": [1, 0, 0]}], \"contacts\": []}", ("'contacts' stands twice",)),
            ("[{\"point\": [1, 0, 0], \"mu\": 1, \"mu\": 2}]", ("'mu' stands twice",)),
            (b"[{\"n\xff\": 1}]", ("line 1, column 5", "\ufffd")),
            ("[{\"point\": [1, 0, 1e999]}]", ("1e999",)),
            ("[" * 300000 + "]" * 300000, ("nests deeper than 16 levels",)),
            ("[{\"point\": [1, 0, 0], \"mu\": 200}]", ("contacts[0].mu is 200; it must be a number from 0 to 100",)),
            ("x,y,z,mu\n1,0,0,-1\n", ("line 2: mu is -1; it must be a number from 0 to 100",)),
            ("x,y,z,cap\n1,0,0,0\n", ("line 2: cap is 0; it must be a number from 1e-100 to 1e+100 N",)),
            ("x,y,z,cap\n1,0,0,1e101\n", ("cap is 1e+101",)),
            ("x,y,z,mu,torsion,pad_radius\n1,0,0,1,0.1,0.1\n", ("contact 0 has both torsion and pad_radius",)),
            ("x,y,z,torsion\n1,0,0,-1\n", ("line 2: torsion is -1",)),
            ("x,y,z,torsion\n1,0,0,1e9\n", ("contact 0: torsion is 1e+09", "100 torque scales")),
            ("x,y,z\n1,0,2e12\n", ("line 2: z is 2e+12; it must be a number from -1e+12 to 1e+12 m",)),
            ("x,y,z,nx,ny,nz\n1,0,0,1e-200,0,0\n", ("no direction",)),
            ("x;y;z\n1;0;0\n", ("'x;y;z'", "commas")),
            ("x,y,z\n" + 1001 * "1,0,0\n", ("1001 contacts", "1000")),
            ("x,y,z,name\n1,0,0,a\n0,1,0,b\n-1,0,0,a\n", ("contacts 0 and 2 are both called 'a'", "give each its own")),
            ("[{\"point\": [1, 0, 0], \"name\": \"contact 1\"}, {\"point\": [-1, 0, 0]}]", ("0 and 1", "'contact 1'")),
        ):
            with self.subTest(text=text[:60]):
                done = self.fdcg("grasp", self.cube, "--contacts", self.write("bad", text), "--mu", "1", code=3)
                self.assert_one_line(done, "bad", *words)
                self.assertNotIn(b"json.exception", done.stderr)
                self.assertNotIn(b"while parsing", done.stderr)
                self.assertEqual(b"", done.stdout)
        for path, words in ((self.path("none"), "does not exist"), (str(self.folder), "is a directory"), ("", "does not exist")):
            self.assert_one_line(self.fdcg("grasp", self.cube, "--contacts", path, "--mu", "1", code=3), path, words)

    def test_one_contact_is_told_as_one(self):
        done = self.fdcg("grasp", self.cube, "--contacts", self.write("one.csv", "x,y,z\n1,0,0\n"), "--mu", "1", code=1)
        self.assertIn(b": 1 contact on 6 nodes\n", done.stdout)

    def test_a_mark_of_utf_8_in_front_is_passed_over(self):
        for text in ("x,y,z\n1,0,0\n", "[{\"point\": [1, 0, 0]}]"):
            plain, marked = self.write("plain", text), self.write("marked", b"\xef\xbb\xbf" + text.encode())
            reports = [self.fdcg("grasp", self.cube, "--contacts", path, "--mu", "1", "--json", code=1).stdout for path in (plain, marked)]
            self.assertEqual(*reports)

    def test_wrong_usage_is_code_2_and_one_line(self):
        here = ("grasp", self.cube, "--contacts", self.fingers)
        for arguments, words in (
            (("grasp", self.cube), ("--contacts",)),
            (("grasp", "-", "--contacts", "-", "--mu", "1"), ("OBJECT", "--contacts", "standard input", "only one")),
            (here, ("contact 0", "--mu")),
            ((*here, "--mu", "-1"), ("--mu", "from 0 to 100")),
            ((*here, "--mu", "101"), ("--mu: '101' is no number from 0 to 100",)),
            ((*here, "--mu", "nan"), ("--mu", "'nan'")),
            ((*here, "--mu", "1", "--torsion", "1e9"), ("--torsion is 1e+09", "100 torque scales")),
            ((*here, "--mu", "1", "--cap", "1e300"), ("--cap", "above 0 and up to 1e+100")),
            ((*here, "--mu", "1", "--load", "1e300,0,0"), ("--load", "1e-100 to 1e100")),
            ((*here, "--mu", "1", "--mass", "1e300", "--gravity", "0,0,1e300"), ("--mass", "inf")),
            ((*here, "--mu", "1", "--centre", "1e200,0,0"), ("--centre", "1e12")),
            (("grasp", self.compiled_cube(), *here[2:], "--mu", "1", "--units", "mm"), ("--units", "FDCG file")),
            (("grasp", self.compiled_cube(), *here[2:], "--mu", "1", "--scale", "2"), ("--scale", "FDCG file")),
            ((*here, "--mu", "1", "--torsion", "x"), ("--torsion",)),
            ((*here, "--mu", "1", "--grip", "0"), ("--grip", "above 0")),
            ((*here, "--mu", "1", "--load", "1,2"), ("--load", "2 numbers", "3 or 6")),
            ((*here, "--mu", "1", "--load", "1,2,3", "--mass", "1"), ("--load", "--mass")),
            ((*here, "--mu", "1", "--load", "0,0,0"), ("load",)),
            ((*here, "--mu", "1", "--centre", "0,0"), ("--centre",)),
            ((*here, "--mu", "1", "--torque-scale", "1e-4"), ("contact 0", "torque scale")),
            ((*here, "--mu", "1", "--epsilon", "all"), ("together, each",)),
            ((*here, "--mu", "1", "--units", "furlong"), ("m, mm, cm, in",)),
        ):
            with self.subTest(arguments=arguments):
                done = self.fdcg(*arguments, code=2)
                self.assert_one_line(done, *words)
                self.assertEqual(b"", done.stdout)

    def test_no_input_is_overwritten(self):
        for path in (self.cube, self.fingers):
            with self.subTest(path=path):
                before = pathlib.Path(path).read_bytes()
                done = self.fdcg("grasp", self.cube, "--contacts", self.fingers, "--mu", "1", "-o", path, code=2)
                self.assert_one_line(done, path, "would overwrite")
                self.assertEqual(before, pathlib.Path(path).read_bytes())

    def test_objects_that_cannot_serve(self):
        done = self.fdcg("grasp", self.path("none.off"), "--contacts", self.fingers, "--mu", "1", code=3)
        self.assert_one_line(done, "none.off")
        opened = self.write("open.off", CENTRED_CUBE.replace("8 6 0", "8 5 0").replace("4 3 0 4 7\n", ""))
        self.assert_one_line(self.fdcg("grasp", opened, "--contacts", self.fingers, "--mu", "1", code=2), "open.off", "--com")
        about = ("--mu", "1", "--centre", "0,0,0", "--grip", "1")
        self.assert_one_line(self.fdcg("grasp", opened, "--contacts", self.fingers, *about, code=2), "open.off", "--com")
        across = self.write("across.csv", "x,y,z\n0,1,0\n0,-1,0\n")
        self.fdcg("grasp", opened, "--contacts", across, "--mu", "1", "--torsion", "0.1", "--centre", "0,0,0", code=0)
        twisted = self.write("twisted.off", CENTRED_CUBE.replace("4 0 3 2 1", "4 1 2 3 0"))
        done = self.fdcg("grasp", twisted, "--contacts", self.fingers, "--mu", "1", code=1)
        self.assertIn(b"winding-inconsistent", done.stderr)
        damaged = bytearray(pathlib.Path(self.compiled_cube()).read_bytes())
        damaged[len(damaged) // 2] ^= 1
        done = self.fdcg("grasp", self.write("damaged.fdcg", bytes(damaged)), "--contacts", self.fingers, "--mu", "1", code=3)
        self.assert_one_line(done, "damaged.fdcg")


if __name__ == "__main__":
    unittest.main()
