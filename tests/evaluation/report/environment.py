#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What is measured on, recorded when it is measured.

Usage: environment.py BUILD_DIR OUTPUT_DIR
Writes OUTPUT_DIR/environment.json: machine, kernel, governor, load, compiler and flags, versions of the contenders' libraries. What
cannot be read is "not known". Each member is a string or a number.
"""
import json
import os
import pathlib
import platform
import re
import subprocess
import sys

NOT_KNOWN = "not known"
LIBRARIES = ("libembree-dev", "libcgal-dev", "libfcl-dev", "libopenvdb-dev", "libbullet-dev", "libgmp-dev", "libmpfr-dev", "libc6")


def first_line(path):
    try:
        return pathlib.Path(path).read_text(encoding="utf-8").strip().splitlines()[0]
    except (OSError, IndexError, UnicodeDecodeError):
        return NOT_KNOWN


def said(command):
    try:
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip().splitlines()[0]
    except (OSError, subprocess.CalledProcessError, IndexError):
        return NOT_KNOWN


def processor():
    names = re.findall(r"^model name\s*:\s*(.*)$", pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8"), re.M) \
        if pathlib.Path("/proc/cpuinfo").exists() else []
    return names[0] if names else platform.machine()


def is_virtual():
    try:
        return "yes" if re.search(r"^flags\s*:.*\bhypervisor\b", pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8"), re.M) else "no"
    except OSError:
        return NOT_KNOWN


def caches():
    found = []
    for index in sorted(pathlib.Path("/sys/devices/system/cpu/cpu0/cache").glob("index*")):
        found.append(f"L{first_line(index / 'level')} {first_line(index / 'type').lower()} {first_line(index / 'size')}")
    return ", ".join(found) or NOT_KNOWN


def cache_value(build, name):
    try:
        found = re.search(rf"^{name}(?::\w+)?=(.*)$", (build / "CMakeCache.txt").read_text(encoding="utf-8"), re.M)
    except OSError:
        found = None
    return found.group(1) if found else NOT_KNOWN


def flags(build):
    """Of the step and of the contenders, as they are compiled."""
    try:
        commands = json.loads((build / "compile_commands.json").read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    wanted = {"flags_of_the_step": "step/servo_step.cpp", "flags_of_contenders": "contenders/embree_scene.cpp",
              "flags_of_the_clock": "contenders/timing.cpp"}
    found = {}
    for key, ending in wanted.items():
        for command in commands:
            if command["file"].endswith(ending):
                words = command["command"].split()
                found[key] = " ".join(w for w in words if re.match(r"-(O|m|f|std=|g|DNDEBUG)", w))
                break
    return found


def load():
    try:
        return round(os.getloadavg()[0], 2)
    except OSError:
        return NOT_KNOWN


def environment(build):
    root = pathlib.Path(__file__).resolve().parents[3]
    governor = first_line("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor")
    known = {"measured_at": said(["date", "-u", "+%Y-%m-%dT%H:%M:%SZ"]),
             "revision": said(["git", "-C", str(root), "describe", "--always", "--dirty", "--abbrev=12"]),
             "processor": processor(), "cores": len(os.sched_getaffinity(0)), "caches": caches(), "virtual_machine": is_virtual(),
             "governor": governor, "turbo_off": first_line("/sys/devices/system/cpu/intel_pstate/no_turbo"),
             "load_before": load(), "kernel": platform.platform(), "compiler": said([cache_value(build, "CMAKE_CXX_COMPILER"), "--version"]),
             "build_type": cache_value(build, "CMAKE_BUILD_TYPE")}
    known.update(flags(build))
    for package in LIBRARIES:
        known[package] = said(["dpkg-query", "-W", "-f", "${Version}\n", package])
    return known


def main():
    if len(sys.argv) != 3 or sys.argv[1].startswith("-"):
        print(__doc__, file=sys.stderr if len(sys.argv) != 3 else sys.stdout)
        return 2
    known = environment(pathlib.Path(sys.argv[1]))
    (pathlib.Path(sys.argv[2]) / "environment.json").write_text(json.dumps(known, indent=1) + "\n", encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
