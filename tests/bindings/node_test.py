# SPDX-License-Identifier: Apache-2.0
"""The npm package under Node.js: packed as it is published, it steps to the hash of C."""
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(os.environ["FDCG_ROOT"])
PACKAGE = ROOT / "runtime" / "bindings" / "web" / "npm"


class Node(unittest.TestCase):
    def test_the_package_steps_to_the_hash_of_c(self):
        if shutil.which("node") is None or not os.path.exists(os.environ["FDCG_WASM"]):
            self.skipTest("node or the module is missing; tools/check installs them (group viewer of tools/packages)")
        with tempfile.TemporaryDirectory() as folder:
            shutil.copytree(PACKAGE, os.path.join(folder, "fdcg"))
            shutil.copy(os.environ["FDCG_WASM"], os.path.join(folder, "fdcg", "fdcg.wasm"))
            graph = os.path.join(folder, "cube.fdcg")
            subprocess.run([os.environ["FDCG"], "compile", str(ROOT / "testdata" / "meshes" / "good" / "cube_quads.off"), "-q", "-o", graph],
                           check=True)
            expected = subprocess.run([os.environ["FDCG_PATH_HASH"], graph], capture_output=True, text=True, check=True).stdout
            found = subprocess.run(["node", str(ROOT / "tests" / "bindings" / "path_hash.mjs"), os.path.join(folder, "fdcg"), graph],
                                   capture_output=True, text=True, check=False)
            self.assertEqual(expected, found.stdout, found.stderr)


if __name__ == "__main__":
    unittest.main()
