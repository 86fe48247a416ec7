# SPDX-License-Identifier: Apache-2.0
"""Every test has one tier, and none may run for longer than ten minutes. Usage: tiers_test.py CTEST BUILD_FOLDER"""
import json
import re
import subprocess
import sys

TIERS = {"fast", "standard", "all", "nightly"}
LONGEST_S = 600


def problems(tests):
    for test in tests:
        if re.search(r"_NOT_BUILT(-\w+)?$", test["name"]):  # a program of another tier
            continue
        properties = {item["name"]: item["value"] for item in test.get("properties", [])}
        labels = properties.get("LABELS", [])
        if len(labels) != 1 or labels[0] not in TIERS:
            yield f"{test['name']}: its labels are {labels}, not one of {sorted(TIERS)}"
        if not 0 < properties.get("TIMEOUT", 0) <= LONGEST_S:
            yield f"{test['name']}: its time-out is {properties.get('TIMEOUT')} s, not {LONGEST_S} s at most"


def main():
    ctest, folder = sys.argv[1:]
    listing = subprocess.run([ctest, "--test-dir", folder, "--show-only=json-v1"], check=True, capture_output=True, text=True)
    tests = json.loads(listing.stdout)["tests"]
    found = list(problems(tests))
    planted = [{"name": "none"}, {"name": "two", "properties": [{"name": "LABELS", "value": ["fast", "all"]}, {"name": "TIMEOUT", "value": 9}]},
               {"name": "long", "properties": [{"name": "LABELS", "value": ["fast"]}, {"name": "TIMEOUT", "value": 601}]}]
    if len(list(problems(planted))) != 4:  # the first has neither label nor time-out
        found.append("this test does not see a missing tier, a second one, or a long time-out")
    print(f"{len(tests)} tests")
    sys.exit("\n".join(found) if found else 0)


if __name__ == "__main__":
    main()
