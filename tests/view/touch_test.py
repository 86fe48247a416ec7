# SPDX-License-Identifier: Apache-2.0
"""Touch in Chromium: mouse, keys and gamepad move the hand, sliders change what is felt, and what is felt in the page replays
natively to the same bytes."""
import math
import pathlib
import shlex
import time
import unittest

from browser import BrowserCase
from pages import ROOT, SERVO, sphere

try:
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
except ImportError:
    pass

# A gamepad in place of the browser's: what its sticks and buttons show is set by the test.
PAD = """window.pad = {connected: true, axes: [0, 0, 0, 0], buttons: Array.from({length: 16}, () => ({pressed: false, value: 0}))};
navigator.getGamepads = () => [window.pad];
dispatchEvent(new Event('gamepadconnected'));"""


def first_difference(a, b):
    pairs = enumerate(zip(a.splitlines(), b.splitlines()))
    return next((f"row {i}\n{x}\n{y}" for i, (x, y) in pairs if x != y), f"{len(a)} and {len(b)} bytes")


class TouchCase(BrowserCase):
    def open_touch(self, *arguments):
        self.open(self.view(*arguments))
        self.find("tab-touch").click()
        return self.wait_for(lambda s: s["ready"])

    def hand(self):
        return ActionChains(self.browser, duration=30)

    def at(self, x, y):
        """The pointer over the stage, from its middle."""
        return self.hand().move_to_element_with_offset(self.canvas(), x, y)

    def begin_recording(self):
        self.find("record").click()
        self.at(20, 20).perform()
        self.wait_for(lambda s: s["recording"] == "on")

    def assert_replays(self, graph):
        """Stops the recording, saves it, and runs what the page says."""
        self.find("record").click()
        state = self.wait_for(lambda s: s["recorded"] > 0)
        for button in ("save-path", "save-log", "save-graph"):
            self.find(button).click()
        for name in ("hip.csv", "page-log.csv", graph):
            self.saved(name)
        command = shlex.split(self.find("replay-command").text)
        self.assertEqual("fdcg-servo", command[0])
        self.run_program(SERVO, *command[1:], cwd=self.path("saved"))
        native, page = (pathlib.Path(self.saved(name)).read_text() for name in ("log.csv", "page-log.csv"))
        self.assertTrue(native == page, first_difference(native, page))
        return state, command


class Touch(TouchCase):
    seconds = 20

    def test_what_is_felt_in_the_page_replays_natively_to_the_same_bytes(self):
        self.open_touch(self.write("ball.off", sphere()), "--units", "cm")
        self.begin_recording()
        end = time.monotonic() + self.seconds
        self.at(-60, 0).click_and_hold().perform()
        states, slipped, turn = set(), False, 0.0
        while time.monotonic() < end:
            turn += 0.35
            self.at(int(90 * math.cos(turn)), int(70 * math.sin(turn))).perform()
            state = self.state()
            states.add(state["contact"])
            slipped = slipped or state["slips"]
        self.hand().release().perform()
        state, _ = self.assert_replays("ball.fdcg")
        self.assertGreater(state["recorded"], 0.8 * 1000 * self.seconds)
        self.assertTrue(slipped and "face" in states, (slipped, states))
        self.assert_quiet()
        print(f"step {state['recordedStepNs']:.0f} ns, p99 of the period {state['timing']['periodP99Ms']:.2f} ms, {state['recorded']} ticks")

    def test_keys_press_and_move_and_sliders_change_what_is_felt(self):
        self.open(self.view(self.write("ball.off", sphere(12))))
        self.find("tab-touch").click()
        self.wait_for(lambda s: s["ready"])
        self.press(" ")
        soft = self.wait_for(lambda s: s["contact"] == "face" and s["force"] > 1)
        for _ in range(8):
            self.press(Keys.ARROW_RIGHT)
        self.wait_for(lambda s: s["ticks"] > soft["ticks"] + 100)
        self.find("stiffness").send_keys(Keys.END)
        self.wait_for(lambda s: s["force"] > 3 * soft["force"])
        self.find("mu-s").send_keys(Keys.HOME)
        state = self.wait_for(lambda s: s["params"]["muStatic"] == 0)
        self.assertEqual(0, state["params"]["muDynamic"])
        self.press(Keys.ESCAPE)
        self.wait_for(lambda s: s["contact"] == "free")
        self.assert_quiet()

    def test_what_is_seen_of_a_contact(self):
        self.open_touch(self.write("ball.off", sphere(12)))
        self.at(0, 0).perform()
        self.wait_for(lambda s: s["contact"] == "free" and s["seen"]["hip"])
        self.assertIn("touching", self.canvas().get_attribute("class"))  # the pointer is drawn at the god-object
        self.hand().click_and_hold().perform()
        state = self.wait_for(lambda s: s["contact"] == "face" and s["force"] > 1 and s["seen"]["cone"] and s["seen"]["spring"])
        self.assertEqual({"hip": True, "godObject": True, "spring": True, "force": True, "cone": True}, state["seen"])
        # the god-object stays on the ball, the hand is inside
        self.assertLess(math.hypot(*state["hip"]), math.hypot(*state["godObject"]))
        self.hand().release().perform()
        self.wait_for(lambda s: s["contact"] == "free" and not s["seen"]["force"])

    def test_the_wheel_presses_deeper(self):
        self.open_touch(self.write("ball.off", sphere(12)))
        self.at(0, 0).click_and_hold().perform()
        soft = self.wait_for(lambda s: s["contact"] == "face" and s["force"] > 1)
        time.sleep(0.3)
        soft = self.state()
        self.browser.execute_script("document.querySelector('.stage canvas').dispatchEvent(new WheelEvent('wheel', {deltaY: -400, bubbles: true, cancelable: true}))")
        self.wait_for(lambda s: s["force"] > 1.8 * soft["force"])

    def test_a_pen_presses_by_its_pressure(self):
        self.open_touch(self.write("ball.off", sphere(12)))
        pen = """const canvas = document.querySelector('.stage canvas'), box = canvas.getBoundingClientRect();
            const event = (name, pressure) => canvas.dispatchEvent(new PointerEvent(name, {pointerId: 7, pointerType: 'pen', button: name === 'pointermove' ? -1 : 0,
              buttons: 1, pressure, clientX: box.left + box.width / 2, clientY: box.top + box.height / 2, bubbles: true, cancelable: true}));
            canvas.setPointerCapture = () => {};
            event(arguments[0], arguments[1]);"""
        self.browser.execute_script(pen, "pointerdown", 0.25)
        self.wait_for(lambda s: s["contact"] == "face" and s["force"] > 0.5)
        time.sleep(0.3)
        light = self.state()["force"]
        self.browser.execute_script(pen, "pointermove", 0.75)
        self.wait_for(lambda s: abs(s["force"] / light - 3) < 0.5)

    def test_dragged_in_a_plane_the_hand_keeps_its_depth_before_the_eye(self):
        self.open_touch(self.write("ball.off", sphere(24)))
        self.find("way-plane").click()
        self.at(0, 0).click_and_hold().perform()
        self.wait_for(lambda s: s["contact"] == "face" and s["force"] > 1)
        time.sleep(0.3)
        start = self.state()
        self.at(40, 30).perform()
        time.sleep(0.5)
        end = self.state()
        eye = [a - b for a, b in zip(end["camera"], end["target"])]
        along = sum((a - b) * c for a, b, c in zip(end["hip"], start["hip"], eye)) / math.hypot(*eye)
        self.assertGreater(math.dist(start["hip"], end["hip"]), 0.05)
        self.assertLess(abs(along), 0.1 * math.dist(start["hip"], end["hip"]))

    def test_slip_is_heard_on_request(self):
        self.open_touch(self.write("ball.off", sphere(24)))
        self.assertIsNone(self.state().get("loudness"))
        self.find("sound").click()
        self.find("mu-s").send_keys(Keys.HOME)  # without friction everything slips
        self.at(-40, 0).click_and_hold().perform()
        turn, loudest, end = 0.0, 0.0, time.monotonic() + 15
        while loudest < 0.02 and time.monotonic() < end:
            turn += 0.4
            self.at(int(60 * math.cos(turn)), int(60 * math.sin(turn))).perform()
            loudest = max(loudest, self.state()["loudness"] or 0)
        self.assertGreater(loudest, 0.02)

    def test_the_speed_of_the_hand_has_a_limit(self):
        self.open_touch(self.write("ball.off", sphere(12)))
        self.at(-80, 0).perform()
        self.wait_for(lambda s: s.get("hip"))
        self.find("hand-speed").send_keys(Keys.HOME)  # 0.01 of the ball's size a second
        limit = self.wait_for(lambda s: s["handSpeed"] > 0)["handSpeed"]
        self.at(-80, 0).perform()
        time.sleep(0.5)
        self.at(80, 0).perform()
        first = self.state()
        time.sleep(1)
        last = self.state()
        ticks = last["ticks"] - first["ticks"]
        self.assertGreater(ticks, 300)
        self.assertLess(math.dist(first["hip"], last["hip"]), 1.5 * limit * ticks / 1000)


class Gamepad(TouchCase):
    def set_pad(self, axes, trigger=0.0):
        self.browser.execute_script("pad.axes = arguments[0]; pad.buttons[7] = {pressed: arguments[1] > 0, value: arguments[1]};", axes, trigger)

    def test_sticks_move_and_the_trigger_presses(self):
        self.open_touch(self.write("ball.off", sphere(24)))
        self.browser.execute_script(PAD)
        self.assertIn("Gamepad", self.browser.find_element(By.CSS_SELECTOR, ".hint").text)
        self.set_pad([0, 0, 0, 0], 0.5)
        self.wait_for(lambda s: s["contact"] == "face" and s["force"] > 0.5)
        time.sleep(0.4)
        half = self.state()
        self.set_pad([0, 0, 0, 0], 1.0)
        self.wait_for(lambda s: abs(s["force"] / half["force"] - 2) < 0.3)
        before = self.state()
        self.set_pad([0.5, 0, 0, 0], 1.0)
        self.wait_for(lambda s: math.dist(s["hip"], before["hip"]) > 0.1)
        self.set_pad([0, 0, 0, 0], 0.0)
        self.wait_for(lambda s: s["contact"] == "free")
        camera = self.state()["camera"]
        self.set_pad([0, 0, 1, 0])
        self.wait_for(lambda s: math.dist(s["camera"], camera) > 0.1)
        self.set_pad([0.05, 0.05, 0.05, 0])  # a stick at rest is not quite in its middle
        time.sleep(0.3)
        rest = self.state()["camera"]
        time.sleep(0.3)
        self.assertEqual(rest, self.state()["camera"])


class Friction(TouchCase):
    def test_a_curve_is_felt_and_replays_to_the_same_bytes(self):
        self.open_touch(self.write("ball.off", sphere()), "--scale", "0.05")
        self.find("curve-box").find_element(By.TAG_NAME, "summary").click()
        for term in ("lag", "stribeck", "viscous", "presliding"):
            self.find(f"with-{term}").click()
        state = self.wait_for(lambda s: len(s["params"]["curve"]) == 4)
        self.assertEqual({"lag": 0.03, "stribeck": 0.05, "viscous": 0.1, "presliding": 1e5}, state["params"]["curve"])
        self.begin_recording()
        self.at(-60, 0).click_and_hold().perform()
        for k in range(25):
            self.at(int(90 * math.cos(0.5 * k)), int(70 * math.sin(0.5 * k))).perform()
        self.hand().release().perform()
        _, command = self.assert_replays("ball.fdcg")
        self.assertLess({"--lag", "--stribeck", "--viscous", "--presliding"}, set(command))

    def test_a_curve_that_is_too_steep_is_refused_with_the_runtimes_words(self):
        self.open_touch(self.write("ball.off", sphere(12)), "--scale", "0.05")
        self.find("curve-box").find_element(By.TAG_NAME, "summary").click()
        self.find("with-stribeck").click()  # without lag it has several solutions
        refusal = self.find("refusal")
        self.assertTrue(refusal.is_displayed())
        self.assertIn("stribeck_m_per_s", refusal.text)
        self.assertEqual({}, self.state()["params"]["curve"])
        self.find("with-lag").click()
        self.wait_for(lambda s: len(s["params"]["curve"]) == 2)
        self.assertFalse(refusal.is_displayed())

    def test_materials_differ_and_replay_to_the_same_bytes(self):
        self.open_touch(str(ROOT / "runtime" / "examples" / "steel_and_rubber.obj"), "--units", "cm")
        materials = self.state()["params"]["materials"]
        self.assertEqual(2, len(materials))
        self.assertNotEqual(materials[0], materials[1])
        self.find("material").send_keys("rubber")
        self.find("material-mu-d").send_keys(Keys.END)
        state = self.wait_for(lambda s: 2 in [material["muDynamic"] for material in s["params"]["materials"]])
        self.assertIn(2, [material["muStatic"] for material in state["params"]["materials"]])  # at least the dynamic one
        self.begin_recording()
        self.at(-60, 0).click_and_hold().perform()
        for k in range(25):
            self.at(int(80 * math.cos(0.4 * k)), int(20 * math.sin(0.4 * k))).perform()
        self.hand().release().perform()
        _, command = self.assert_replays("steel_and_rubber.fdcg")
        self.assertEqual(2, command.count("--material"))
        self.assertTrue(any(word.startswith("rubber=2,2,") for word in command), command)


if __name__ == "__main__":
    unittest.main()
