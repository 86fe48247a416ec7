# SPDX-License-Identifier: Apache-2.0
"""Figures of pages in Chromium: size, time until they are shown, frames a second, the loop's period, and the processor time of
the first two. measure.py FACES...: prints a line for each; run with FDCG, FDCG_SERVO and FDCG_ROOT as the tests are."""
import array
import csv
import json
import os
import pathlib
import random
import subprocess
import sys
import time

from browser import BrowserCase

TURNED_S = 5
PRESSED_S = 20

# turns the view a little in every frame, and counts the frames that were drawn
TURN = """const [seconds, done] = arguments, canvas = document.querySelector('.stage canvas');
const before = fdcgView.state().frames, start = performance.now();
const step = () => {
  if (performance.now() - start > 1000 * seconds) return done([(fdcgView.state().frames - before) / seconds, fdcgView.state().drawn]);
  canvas.dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowRight', bubbles: true}));
  requestAnimationFrame(step);
};
step();"""


def bumpy_sphere(path, faces):
    """A closed mesh with noise, so that it compresses as a scan does: triangles in a grid of longitudes and latitudes."""
    import numpy  # only here: the tests do without
    rings = max(4, round((faces / 4) ** 0.5))
    sides = 2 * rings
    source = numpy.random.default_rng(1)
    latitude = numpy.pi * numpy.arange(1, rings) / rings
    longitude = numpy.pi * numpy.arange(sides) / rings
    a, b = numpy.meshgrid(latitude, longitude, indexing="ij")
    radius = 1 + 0.05 * numpy.sin(5 * a) * numpy.cos(7 * b) + 1e-4 * source.standard_normal(a.shape)
    points = numpy.stack([radius * numpy.sin(a) * numpy.cos(b), radius * numpy.sin(a) * numpy.sin(b), radius * numpy.cos(a)], -1).reshape(-1, 3)
    points = numpy.vstack([points, [[0, 0, 1.0], [0, 0, -1.0]]]).astype("<f4")
    at = numpy.arange((rings - 1) * sides).reshape(rings - 1, sides)
    here, right = at, numpy.roll(at, -1, 1)
    top, bottom = len(points) - 2, len(points) - 1
    quads = [numpy.stack([here[:-1], here[1:], right[1:]], -1), numpy.stack([here[:-1], right[1:], right[:-1]], -1)]
    caps = [numpy.stack([numpy.full(sides, top), here[0], right[0]], -1), numpy.stack([numpy.full(sides, bottom), right[-1], here[-1]], -1)]
    triangles = numpy.vstack([part.reshape(-1, 3) for part in quads + caps])
    records = numpy.empty(len(triangles), dtype=[("n", "u1"), ("corners", "<i4", 3)])
    records["n"], records["corners"] = 3, triangles
    with open(path, "wb") as file:
        file.write(f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\nproperty float x\nproperty float y\nproperty float z\n"
                   f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n".encode())
        file.write(points.tobytes())
        file.write(records.tobytes())
    return len(triangles)


def native_ns(program, graph, hips, params):
    return float(subprocess.run((program, graph, hips, *map(str, params)), capture_output=True, check=True, text=True).stdout)


def cpu_s(root):
    """Processor seconds of a process and all below it: what a busy machine does not change much."""
    parents, spent = {}, {}
    for name in filter(str.isdigit, os.listdir("/proc")):
        try:
            fields = pathlib.Path(f"/proc/{name}/stat").read_text().rpartition(")")[2].split()
        except OSError:
            continue  # it has ended
        parents[int(name)] = int(fields[1])
        spent[int(name)] = (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def is_below(process):
        while process not in (0, root):
            process = parents.get(process, 0)
        return process == root

    return sum(seconds for process, seconds in spent.items() if is_below(process))


def doubles_of(path_csv, to):
    with open(path_csv) as file:
        numbers = [float(row[axis]) for row in csv.DictReader(file) for axis in "xyz"]
    with open(to, "wb") as file:
        array.array("d", numbers).tofile(file)


class Measure(BrowserCase):
    """A page that is open, to be asked."""
    width, height = 1280, 720

    def runTest(self):
        """Is driven by main()."""

    def cpu_s(self):
        return cpu_s(self.browser.service.process.pid)

    def open_page(self, page):
        before, cpu = time.monotonic(), self.cpu_s()
        self.browser.get("file://" + page)
        self.wait_for(lambda state: state.get("tab") is not None, 600)
        shown = self.browser.execute_script("return performance.getEntriesByName('shown')[0]?.startTime ?? performance.now()")
        return {"page_mb": os.path.getsize(page) / 1e6, "shown_s": shown / 1000, "polled_s": time.monotonic() - before, "shown_cpu_s": self.cpu_s() - cpu}

    def turning(self, seconds=TURNED_S):
        self.wait_for(lambda state: not state["flying"])
        cpu = self.cpu_s()
        frames, drawn = self.browser.execute_async_script(TURN, seconds)
        return {"frames_per_s": frames, "frame_cpu_ms": 1000 * (self.cpu_s() - cpu) / (frames * seconds), "triangles_drawn": drawn}

    def touching(self, seconds=PRESSED_S):
        """Presses and strokes; the loop's period beside what is drawn, and the step's time, in the page and native."""
        self.find("tab-touch").click()
        self.wait_for(lambda state: state["ready"], 120)
        self.find("record").click()
        self.press(" ")
        self.wait_for(lambda state: state["recording"] == "on")
        end = time.monotonic() + seconds
        source = random.Random(3)
        while time.monotonic() < end:
            self.press(source.choice("\ue012\ue013\ue014\ue015"))
        timing = self.state()["timing"]
        self.find("record").click()
        state = self.wait_for(lambda s: s["recorded"] > 0)
        return {"period_p99_ms": timing["periodP99Ms"], "wasm_ns": state["recordedStepNs"], "ticks": state["recorded"], "params": state["params"]}


def main():
    for faces in map(int, sys.argv[1:]):
        case = Measure()
        case.setUp()
        try:
            mesh = case.path("bumpy.ply")
            real = bumpy_sphere(mesh, faces)
            before = time.monotonic()
            page = case.view(mesh, "--jobs", "2", "-q")
            figures = {"faces": real, "written_s": time.monotonic() - before, **case.open_page(page), **case.turning()}
            if real <= 200_000:
                figures |= case.touching()
            figures["load"] = os.getloadavg()[0]
            print(json.dumps({key: round(value, 3) if isinstance(value, float) else value for key, value in figures.items()}), flush=True)
        finally:
            case.doCleanups()


if __name__ == "__main__":
    main()
