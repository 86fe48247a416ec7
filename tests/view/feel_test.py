# SPDX-License-Identifier: Apache-2.0
"""Shading, reliefs and effects of the page: switched on by keys and mouse, felt, and replayed natively to the same bytes."""
import json
import math
import os
import pathlib
import shutil
import subprocess
import unittest

from pages import ROOT, PageCase, sphere
from touch_test import TouchCase, first_difference

try:
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
except ImportError:
    pass


# Run where node_modules is: a path of the hand through the page's own runtime, after what was felt before and is off again.
STEP = """
import { buildSync } from 'esbuild';
import { readFileSync, writeFileSync } from 'node:fs';
const entry = "export { Runtime } from './runtime'; export { logCsv } from './touch_csv';";
const code = buildSync({ stdin: { contents: entry, resolveDir: 'src', loader: 'ts' }, bundle: true, write: false, format: 'esm' }).outputFiles[0].text;
const { Runtime, logCsv } = await import('data:text/javascript,' + encodeURIComponent(code));
const { wasm, graph, path, log, felt } = JSON.parse(readFileSync(0, 'utf8'));
const runtime = await Runtime.make(readFileSync(wasm));
runtime.open(readFileSync(graph));
const hips = readFileSync(path, 'utf8').trim().split('\\n').slice(1).map((line) => line.split(',').map(Number));
const run = (params) => {
  const why = runtime.setParams({ muStatic: 0.6, muDynamic: 0.4, stiffness: 1000, damping: 0, curve: {}, shading: false, relief: { kind: 'none', numbers: [] }, effects: {}, ...params });
  if (why !== '') throw new Error(why);
  runtime.reset();
  return hips.map(([t, ...hip]) => {
    const r = runtime.step(hip);
    return [t, ...hip, ...r.godObject, ...r.force, r.state, r.feature, r.slipping, r.transitions];
  });
};
run({ shading: true, relief: { kind: 'bumps', numbers: [1e-4, 2e-3] }, effects: { pulse: [0.5, 0.03, 0.5] } });
writeFileSync(log, logCsv(Float64Array.from(run(felt).flat())));
console.log(JSON.stringify([runtime.hasNormals, runtime.hasHeights]));
"""


class Bits(PageCase):
    def native_and_page(self, graph, felt, *options):
        """Logs of a slide: fdcg-servo's, with these options, and that of the page's runtime."""
        self.servo("replay", graph, "--path", "slide", "--write-path", self.path("hip.csv"), "-o", self.path("native.csv"), "-q", *options)
        built = pathlib.Path(os.environ["FDCG_BUILD"]) / "tools" / "view"
        asked = {"wasm": str(built / "wasm" / "fdcg.wasm"), "graph": graph, "path": self.path("hip.csv"), "log": self.path("page.csv"), "felt": felt}
        done = subprocess.run(("node", "--input-type=module", "-e", STEP), input=json.dumps(asked), cwd=built / "bundle", capture_output=True, text=True,
                              check=False, timeout=300)
        self.assertEqual(0, done.returncode, done.stderr)
        native, page = (pathlib.Path(self.path(name)).read_text() for name in ("native.csv", "page.csv"))
        self.assertTrue(native == page, first_difference(native, page))
        return json.loads(done.stdout), native

    def ball(self, *options):
        self.fdcg("compile", self.write("ball.off", sphere()), "--scale", "0.05", "--planes", "derived", "-q", "-o", self.path("ball.fdcg"), *options)
        return self.path("ball.fdcg")

    def test_all_of_it_has_the_native_bits(self):
        logs = set()
        for precision in ("f32", "f64"):
            ball = self.ball("--precision", precision, "--normals", "faces")
            for felt, options in (
                    ({}, ()),
                    ({"shading": True}, ("--shading",)),
                    ({"relief": {"kind": "ridges", "numbers": [1e-4, 0.002]}}, ("--relief", "ridges=0.0001,0.002")),
                    ({"relief": {"kind": "bumps", "numbers": [1e-4, 0.002]}}, ("--relief", "bumps=0.0001,0.002")),
                    ({"relief": {"kind": "grain", "numbers": [5e-5, 0.001, 0.004]}}, ("--relief", "grain=0.00005,0.001,0.004")),
                    ({"effects": {"magnet": [1, 0.003]}}, ("--effect", "magnet,force_n=1,distance_m=0.003")),
                    ({"effects": {"viscosity": [5]}}, ("--effect", "viscosity,viscosity_n_s_per_m=5")),
                    ({"effects": {"stick-slip": [300, 0.5]}}, ("--effect", "stick-slip,stiffness_n_per_m=300,force_n=0.5")),
                    ({"effects": {"vibration": [0.5, 100]}}, ("--effect", "vibration,force_n=0.5,frequency_hz=100")),
                    ({"effects": {"noise": [0.5, 50, 300]}}, ("--effect", "noise,force_n=0.5,low_hz=50,high_hz=300")),
                    ({"effects": {"tap": [5, 200, 0.02]}}, ("--effect", "tap,impact_n_s_per_m=5,frequency_hz=200,decay_s=0.02")),
                    ({"effects": {"pulse": [0.5, 0.03, 0.5]}}, ("--effect", "pulse,force_n=0.5,duration_s=0.03,period_s=0.5")),
                    ({"shading": True, "relief": {"kind": "ridges", "numbers": [1e-4, 0.002]}, "effects": {"viscosity": [5], "tap": [5, 200, 0.02]}},
                     ("--shading", "--relief", "ridges=0.0001,0.002", "--effect", "viscosity,viscosity_n_s_per_m=5", "--effect",
                      "tap,impact_n_s_per_m=5,frequency_hz=200,decay_s=0.02"))):
                with self.subTest(precision=precision, options=options):
                    has, log = self.native_and_page(ball, felt, *options)
                    self.assertEqual([True, False], has)
                    logs.add(log)
        self.assertEqual(26, len(logs))  # each is felt

    def test_images_have_the_native_bits(self):
        for name in ("tile.obj", "tile.mtl", "weave.png"):
            shutil.copy(ROOT / "testdata" / "heights" / name, self.folder)
        self.fdcg("compile", self.path("tile.obj"), "--units", "cm", "--heights", "file", "-q", "-o", self.path("tile.fdcg"))
        has, felt = self.native_and_page(self.path("tile.fdcg"), {"relief": {"kind": "image", "numbers": []}}, "--relief", "image")
        self.assertEqual([False, True], has)
        self.assertNotEqual(felt, self.native_and_page(self.path("tile.fdcg"), {})[1])


class FeelCase(TouchCase):
    def unfold(self, box):
        self.find(box).find_element(By.TAG_NAME, "summary").send_keys(Keys.ENTER)

    def switch(self, *effects):
        self.unfold("effect-box")
        for kind in effects:
            self.find(f"with-{kind}").send_keys(Keys.SPACE)
        return self.wait_for(lambda s: set(s["params"]["effects"]) == set(effects))

    def choose_relief(self, kind):
        self.unfold("relief-box")
        self.find("relief").send_keys(kind)
        return self.wait_for(lambda s: s["params"]["relief"]["kind"] == kind)

    def stroke(self, turns=25):
        """Approaches, presses, strokes round, lifts, and does so again."""
        for start in (-60, 40):
            self.at(start, 0).click_and_hold().perform()
            for k in range(turns):
                self.at(int(90 * math.cos(0.5 * k)), int(70 * math.sin(0.5 * k))).perform()
            self.hand().release().perform()


class Feel(FeelCase):
    def test_shading_ridges_and_effects_replay_to_the_same_bytes(self):
        self.open_touch(self.write("ball.off", sphere()), "--scale", "0.05", "--normals", "faces")
        self.find("shading").send_keys(Keys.SPACE)
        self.choose_relief("ridges")
        state = self.switch("viscosity", "stick-slip", "tap")
        self.assertTrue(state["params"]["shading"])
        self.begin_recording()
        self.stroke()
        _, command = self.assert_replays("ball.fdcg")
        self.assertIn("--shading", command)
        self.assertIn("ridges=0.0001,0.002", command)
        self.assertEqual(3, command.count("--effect"))


class Panels(FeelCase):
    def test_shading_turns_the_cone_to_the_normal_between_corners(self):
        """While the hand slips, the force leans by the dynamic coefficient about the normal that the page draws."""
        self.open_touch(self.write("ball.off", sphere(12)), "--scale", "0.05", "--normals", "faces")
        self.find("shading").click()
        self.at(-60, 0).click_and_hold().perform()
        ratios, turn = [], 0
        while len(ratios) < 20 and turn < 400:
            turn += 1
            self.at(int(60 * math.cos(0.3 * turn)), int(60 * math.sin(0.3 * turn))).perform()
            state = self.state()
            if state["slips"] and state["contact"] == "face":
                ratios.append(state["ratio"])
        self.assertEqual(20, len(ratios))
        for ratio in ratios:
            self.assertLess(abs(ratio - 0.4), 1e-3)  # in floats; about the faces' normals it is off by up to 0.2

    def test_a_graph_without_normals_has_no_shading_and_says_how_to_get_it(self):
        self.open_touch(self.write("ball.off", sphere(12)))
        self.assertFalse(self.find("shading").is_enabled())
        self.assertIn("--normals faces", self.find("shading-note").text)
        self.assertNotIn("image", [option.get_attribute("value") for option in self.find("relief").find_elements(By.TAG_NAME, "option")])

    def test_sliders_have_units_and_change_what_is_felt(self):
        self.open_touch(self.write("ball.off", sphere(12)), "--scale", "0.05")
        self.switch("magnet", "tap")
        self.choose_relief("bumps")
        self.find("relief-bumps-0").send_keys(Keys.END)
        state = self.wait_for(lambda s: s["params"]["relief"]["numbers"][0] == 0.001)
        self.assertEqual([0.001, 0.002], state["params"]["relief"]["numbers"])
        self.find("effect-magnet-1").send_keys(Keys.HOME)
        self.wait_for(lambda s: s["params"]["effects"]["magnet"] == [1, 0.0002])
        said = {slider: self.find(slider).get_attribute("aria-valuetext") for slider in
                ("relief-bumps-0", "relief-bumps-1", "effect-magnet-0", "effect-magnet-1", "effect-tap-0", "effect-tap-1", "effect-tap-2")}
        self.assertEqual({"relief-bumps-0": "1 mm", "relief-bumps-1": "2 mm", "effect-magnet-0": "1 N", "effect-magnet-1": "0.2 mm", "effect-tap-0": "5 N per m/s",
                          "effect-tap-1": "200 Hz", "effect-tap-2": "20 ms"}, said)
        self.assertEqual("Magnet: Reach", self.find("effect-magnet-1").accessible_name)

    def test_a_vibration_is_felt_as_its_amplitude(self):
        self.open_touch(self.write("ball.off", sphere(24)), "--scale", "0.05")
        self.at(0, 0).click_and_hold().perform()
        self.wait_for(lambda s: s["contact"] == "face" and s["force"] > 1)
        self.switch("vibration")
        self.find("effect-vibration-0").send_keys(Keys.END)
        start = self.wait_for(lambda s: s["params"]["effects"]["vibration"][0] == 5)["ticks"]
        forces = []

        def swings(state):
            if state["ticks"] > start + 100:
                forces.append(state["force"])
            return len(forces) > 1 and max(forces) - min(forces) > 3

        self.wait_for(swings)

    def test_what_the_runtime_refuses_is_said_and_the_old_stays(self):
        self.open_touch(self.write("ball.off", sphere(12)), "--scale", "0.05")
        self.switch("noise")
        self.find("effect-noise-2").send_keys(Keys.HOME)  # below the lowest
        refusal = self.find("refusal")
        self.assertTrue(refusal.is_displayed())
        self.assertIn("_hz", refusal.text)
        self.assertEqual([0.5, 50, 300], self.state()["params"]["effects"]["noise"])
        self.find("effect-noise-2").send_keys(Keys.END)
        self.wait_for(lambda s: s["params"]["effects"]["noise"] == [0.5, 50, 490])
        self.assertFalse(refusal.is_displayed())


if __name__ == "__main__":
    unittest.main()
