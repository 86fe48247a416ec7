# SPDX-License-Identifier: Apache-2.0
"""The schema of device profiles against the profiles that ship and against each profile that the parser refuses: the list in
testdata/profiles/refused.json says of each whether a schema can see its error."""
import copy
import json
import os
import pathlib
import unittest

import jsonschema

ROOT = pathlib.Path(os.environ["FDCG_ROOT"])
SCHEMA = json.loads((ROOT / "schemas/device-profile.schema.json").read_text())
FULL = json.loads((ROOT / "testdata/profiles/full.json").read_text())
REFUSED = json.loads((ROOT / "testdata/profiles/refused.json").read_text())


def edited(edits):
    profile = copy.deepcopy(FULL)
    for what, pointer, *value in edits:
        *path, last = pointer.split("/")[1:]
        parent = profile
        for step in path:
            parent = parent[int(step)] if isinstance(parent, list) else parent[step]
        key = int(last) if isinstance(parent, list) else last
        if what == "remove":
            del parent[key]
        else:
            parent[key] = value[0]
    return profile


class ProfileSchema(unittest.TestCase):
    validator = jsonschema.Draft202012Validator(SCHEMA)

    def test_is_a_schema(self):
        jsonschema.Draft202012Validator.check_schema(SCHEMA)

    def test_profiles_that_ship_conform(self):
        profiles = sorted((ROOT / "runtime/device/profiles").glob("*.json"))
        self.assertGreater(len(profiles), 4)
        for path in profiles:
            with self.subTest(path.name):
                self.validator.validate(json.loads(path.read_text()))

    def test_the_profile_with_every_key_conforms_and_has_every_key(self):
        self.validator.validate(FULL)
        self.assertEqual(set(FULL), set(SCHEMA["properties"]))
        self.assertEqual(set(FULL["limits"]), set(SCHEMA["properties"]["limits"]["properties"]))
        self.assertEqual(set(FULL["match"]), set(SCHEMA["properties"]["match"]["properties"]))

    def test_what_the_parser_refuses_is_refused_where_a_schema_can_see_it(self):
        for case in REFUSED:
            if "edits" not in case:
                continue
            with self.subTest(case["says"]):
                errors = list(self.validator.iter_errors(edited(case["edits"])))
                self.assertEqual("refuses" if errors else "accepts", case["schema"], errors[:1])


if __name__ == "__main__":
    unittest.main()
