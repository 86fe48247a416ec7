# SPDX-License-Identifier: Apache-2.0
"""The published schemas against what the programs read: valid files with one value replaced, removed or added, thousands of
them. Whatever a schema refuses, the program refuses too, in one line that names the place; so a file that works is a valid one."""
import copy
import json
import subprocess
import unittest

import jsonschema

from support import CUBE, FDCG, ROOT, SERVO, Case

UNREAD = ("$schema", "notes")  # for editors and people; what stands there is nobody's error
VALUES = (None, True, -1, 0, 1.5, 1e7, "", "zzz", [], {}, [1, 2, 3, 4, 5])


def schema(name):
    return jsonschema.Draft202012Validator(json.loads((ROOT / "schemas" / name).read_text()))


def places(value, path=()):
    yield path
    children = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, child in children:
        yield from places(child, path + (key,))


def variants(document):
    """(the key that was changed, the document with it changed)."""
    for path in places(document):
        for value in ("removed", "added") + VALUES:
            other = copy.deepcopy(document)
            if not path:
                if value == "added":
                    yield "zzz", {**other, "zzz": 1}
                continue
            parent = other
            for key in path[:-1]:
                parent = parent[key]
            if value == "removed":
                del parent[path[-1]]
            elif value != "added":
                parent[path[-1]] = value
            elif isinstance(parent[path[-1]], dict):
                parent[path[-1]]["zzz"] = 1
            else:
                continue
            yield "zzz" if value == "added" else next(str(key) for key in reversed(path) if isinstance(key, str)), other


class Agreement(Case):
    def agree(self, validator, document, lines_of):
        """lines_of(paths): for each file what the program says against it, or nothing."""
        validator.validate(document)
        changed = [("", document), *variants(document)]
        files = [self.write(f"{i}.json", json.dumps(other)) for i, (_, other) in enumerate(changed)]
        lines = lines_of(files)
        self.assertEqual("", lines[0])
        valid = [validator.is_valid(other) for _, other in changed]
        for (key, other), is_valid, line in zip(changed, valid, lines):
            if not is_valid and key not in UNREAD:
                self.assertIn(key, line, json.dumps(other))
        self.assertGreater(valid.count(False), len(valid) / 3)
        self.assertGreater(lines.count(""), 20)

    def judged(self, files):
        done = subprocess.run((SERVO, "check", *files), capture_output=True, text=True)
        said = {}
        for line in (done.stdout + done.stderr).splitlines():
            file = next(part for part in line.split(": ") if part.endswith(".json"))
            said.setdefault(file, "" if line.endswith(": ok") else line)
        return [said[file] for file in files]

    def test_scenes(self):
        (self.folder / "cube.fdcg").write_bytes((ROOT / "testdata/scenes/cube.fdcg").read_bytes())
        whole = json.loads((ROOT / "testdata/fuzz/scene/full").read_text())
        for item in whole["objects"]:
            item["file"] = "cube.fdcg"
        whole["log"]["file"] = "a.fdcglog"
        self.agree(schema("servo-scene.schema.json"), whole, self.judged)
        for name in ("lift_cube.json", "hold_sphere.json", "surfaces.json"):
            self.agree(schema("servo-scene.schema.json"), json.loads((ROOT / "testdata/scenes" / name).read_text()), self.judged)

    def test_profiles(self):
        self.agree(schema("device-profile.schema.json"), json.loads((ROOT / "testdata/profiles/full.json").read_text()), self.judged)

    def test_settings(self):
        cube = self.write("cube.off", CUBE)
        self.fdcg("validate", cube, "--no-config", "--full", self.path("base"))

        def lines_of(files):
            runs = (subprocess.run((FDCG, "validate", cube, "--config", file, "-q"), capture_output=True, text=True) for file in files)
            return [run.stderr if run.returncode not in (0, 1) else "" for run in runs]

        settings = {"$schema": "x", "allow": ["boundary-edge"], "baseline": "base", "fail-on": "warning",
                    "severity": {"sliver-face": "error", "boundary-edge": "off"}, "weld": 1e-6}
        self.agree(schema("validate-config.schema.json"), settings, lines_of)


if __name__ == "__main__":
    unittest.main()
