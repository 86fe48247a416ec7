# SPDX-License-Identifier: Apache-2.0
"""A page's log as an animated picture: each moment is set on its time line and photographed; ffmpeg joins the pictures."""
import argparse
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

from selenium import webdriver
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service

ARGUMENTS = ("--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--use-gl=angle", "--use-angle=swiftshader",
             "--enable-unsafe-swiftshader", "--hide-scrollbars", "--force-device-scale-factor=1", "--no-first-run")
CODECS = {".webp": ("-c:v", "libwebp_anim", "-quality", "60", "-loop", "0"),
          ".mp4": ("-vf", "crop=trunc(iw/2)*2:trunc(ih/2)*2", "-c:v", "libx264", "-pix_fmt", "yuv420p", "-movflags", "+faststart")}
PATIENCE_S = 60

# the time line's own scrubber, as a hand moves it; then the next picture that is drawn
SEEK = """const [t, done] = arguments, scrubber = document.getElementById('scrub');
const times = fdcgView.times();
let at = times.findIndex((time) => time >= t);
scrubber.value = String(at < 0 ? times.length - 1 : at);
scrubber.dispatchEvent(new Event('input'));
requestAnimationFrame(() => requestAnimationFrame(() => done()));"""


def stop(message):
    sys.exit(f"clip: {message}")


def start_browser(width, height):
    chromium, driver = shutil.which("chromium"), shutil.which("chromedriver")
    if chromium is None or driver is None:
        stop("chromium or chromium-driver is missing (group clip of tools/packages)")
    options = Options()
    options.binary_location = chromium
    for argument in (*ARGUMENTS, f"--window-size={width},{height}"):
        options.add_argument(argument)
    browser = webdriver.Chrome(service=Service(driver), options=options)
    browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False})
    return browser


def open_log(browser, page):
    browser.get(page.resolve().as_uri())
    end = time.monotonic() + PATIENCE_S
    while not browser.execute_script("return window.fdcgView !== undefined && fdcgView.state().tab !== undefined && !fdcgView.state().flying"):
        if time.monotonic() > end:
            stop(f"{page}: the page is not there after {PATIENCE_S} s")
        time.sleep(0.1)
    tab = browser.find_elements("id", "tab-log")
    if tab:
        browser.execute_script("arguments[0].click()", tab[0])
    if not browser.execute_script("return fdcgView.times().length"):
        stop(f"{page}: it has no log to play; make one of 'fdcg view' with a log")


def main():
    parser = argparse.ArgumentParser(prog="clip")
    parser.add_argument("page", type=pathlib.Path)
    parser.add_argument("clip", type=pathlib.Path)
    parser.add_argument("--from", dest="begin", type=float, default=None)
    parser.add_argument("--to", dest="end", type=float, default=None)
    parser.add_argument("--speed", type=float, default=1)
    parser.add_argument("--fps", type=float, default=12)
    parser.add_argument("--size", default="960x600")
    given = parser.parse_args()
    if given.clip.suffix not in CODECS:
        stop(f"{given.clip}: its name ends with {given.clip.suffix or 'nothing'}; .webp or .mp4 is needed")
    if not given.page.is_file():
        stop(f"{given.page}: there is no such page")
    if given.speed <= 0 or given.fps <= 0:
        stop("--speed and --fps are above 0")
    width, height = map(int, given.size.split("x"))
    browser = start_browser(width, height)
    try:
        open_log(browser, given.page)
        times = browser.execute_script("return [...fdcgView.times()]")
        begin = times[0] if given.begin is None else given.begin
        end = times[-1] if given.end is None else given.end
        count = max(1, round((end - begin) / given.speed * given.fps))
        with tempfile.TemporaryDirectory() as folder:
            for i in range(count):
                browser.execute_async_script(SEEK, begin + i * given.speed / given.fps)
                browser.save_screenshot(os.path.join(folder, f"{i:05d}.png"))
            subprocess.run(("ffmpeg", "-y", "-v", "error", "-framerate", str(given.fps), "-i", os.path.join(folder, "%05d.png"),
                            *CODECS[given.clip.suffix], str(given.clip)), check=True)
    finally:
        browser.quit()
    print(f"{given.clip}: {count} pictures, {given.clip.stat().st_size / 1e6:.2f} MB")


if __name__ == "__main__":
    main()
