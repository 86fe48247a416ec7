# SPDX-License-Identifier: Apache-2.0
"""pip installs the module from its folder without a network, and the installed one computes a force."""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

FOLDER = pathlib.Path(os.environ["FDCG_ROOT"]) / "runtime" / "bindings" / "python"
TOUCH = """
import fdcg
graph = fdcg.compile(fdcg.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]))
contact = fdcg.Contact(graph)
contact.step((0.1, 0.1, -0.1))
print(round(contact.step((0.1, 0.1, 0.01)).force_n[2], 6), fdcg.__file__)
"""


class Pip(unittest.TestCase):
    def test_install(self):
        if subprocess.run([sys.executable, "-m", "pip", "--version"], capture_output=True, check=False).returncode != 0:
            self.skipTest("pip is missing; tools/check installs it (group test of tools/packages)")
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([sys.executable, "-m", "pip", "install", "--no-index", "--no-deps", "--target", folder, str(FOLDER)],
                                  capture_output=True, text=True, check=False,
                                  env={**os.environ, "CMAKE_ARGS": "-G Ninja '-DCMAKE_CXX_FLAGS_RELEASE=-O0 -DNDEBUG'"})  # half the time
            self.assertEqual(0, done.returncode, done.stdout + done.stderr)
            said = subprocess.run([sys.executable, "-c", TOUCH], capture_output=True, text=True, check=True,
                                  env={**os.environ, "PYTHONPATH": folder}).stdout
            self.assertTrue(said.startswith("-10.0 " + folder), said)


if __name__ == "__main__":
    unittest.main()
