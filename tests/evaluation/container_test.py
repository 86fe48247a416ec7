#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The container's recipe: instructions that there are, commands that a shell reads, options that tools/bench knows. Building it takes a
network and gigabytes, and is not tried here."""
import json
import pathlib
import re
import subprocess
import unittest

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
LINES = [line for line in (HERE / "Containerfile").read_text(encoding="utf-8").splitlines() if line and not line.startswith("#")]
TOLD = [line.split(" ", 1) for line in LINES]
HELP = subprocess.run([ROOT / "tools" / "bench", "--help"], capture_output=True, text=True, check=True).stdout


class Container(unittest.TestCase):
    def test_every_instruction_is_one_and_the_first_is_the_system(self):
        self.assertEqual(["FROM", "debian:12"], TOLD[0])
        self.assertLessEqual({word for word, _ in TOLD}, {"FROM", "RUN", "COPY", "WORKDIR", "ENTRYPOINT", "CMD"})

    def test_commands_are_shell(self):
        commands = [rest for word, rest in TOLD if word == "RUN"]
        self.assertGreater(len(commands), 1)
        for command in commands:
            subprocess.run(["sh", "-n", "-c", command], check=True)

    def test_options_are_those_of_the_script(self):
        arguments = [a for word, rest in TOLD if word in ("ENTRYPOINT", "CMD") for a in json.loads(rest)]
        self.assertEqual("tools/bench", arguments[0])
        used = {option for line in LINES for option in re.findall(r"tools/bench (--[a-z]+)", line)}
        for option in used | {a for a in arguments if a.startswith("--")}:
            self.assertRegex(HELP, rf"(?m)^  {option}\b")

    def test_what_was_built_outside_stays_outside(self):
        ignored = (HERE / "Containerfile.dockerignore").read_text(encoding="utf-8").split("\n")
        self.assertIn("/build", ignored)
        listed = subprocess.run(["git", "-C", ROOT, "ls-files", "--error-unmatch", "build"], capture_output=True)
        self.assertNotEqual(0, listed.returncode)


if __name__ == "__main__":
    unittest.main()
