# SPDX-License-Identifier: Apache-2.0
"""The C# declarations: they are what the headers say, and under mono a program steps to the hash of C."""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(os.environ["FDCG_ROOT"])
CSHARP = ROOT / "runtime" / "bindings" / "csharp"
LIBRARY = pathlib.Path(os.environ["FDCG_SHARED"])


class CSharp(unittest.TestCase):
    def test_declarations_are_what_the_headers_say(self):
        done = subprocess.run([sys.executable, "-B", str(CSHARP / "generate.py")], capture_output=True, text=True, check=False)
        self.assertEqual(0, done.returncode, done.stderr)

    def test_a_program_steps_to_the_hash_of_c(self):
        for program in ("mcs", "mono"):
            if shutil.which(program) is None:
                self.skipTest(f"{program} is missing; tools/check installs it (group test of tools/packages)")
        with tempfile.TemporaryDirectory() as folder:
            graph, program = os.path.join(folder, "cube.fdcg"), os.path.join(folder, "PathHash.exe")
            subprocess.run([os.environ["FDCG"], "compile", str(ROOT / "testdata" / "meshes" / "good" / "cube_quads.off"), "-q", "-o", graph],
                           check=True)
            expected = subprocess.run([os.environ["FDCG_PATH_HASH"], graph], capture_output=True, text=True, check=True).stdout
            subprocess.run(["mcs", "-unsafe", "-warnaserror", "-nowarn:649,169", f"-out:{program}",
                            str(ROOT / "tests" / "bindings" / "PathHash.cs"), str(CSHARP / "Fdcg.cs")], check=True)
            found = subprocess.run(["mono", program, graph], capture_output=True, text=True, check=False,
                                   env={**os.environ, "LD_LIBRARY_PATH": str(LIBRARY.parent)})
            self.assertEqual(expected, found.stdout, found.stderr)


if __name__ == "__main__":
    unittest.main()
