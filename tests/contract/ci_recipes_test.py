# SPDX-License-Identifier: Apache-2.0
"""The recipes of docs/ci.md, run as they stand there: nobody else does, until a pipeline breaks."""
import hashlib
import io
import json
import os
import pathlib
import re
import shutil
import subprocess
import tarfile
import textwrap
import unittest

import jsonschema

from support import CUBE, FDCG, ROOT, Case

MISSING_FACE = CUBE.replace("8 6 0", "8 5 0").replace("4 3 0 4 7\n", "")
THREE_ON_AN_EDGE = "OFF\n5 3 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n0 -1 0\n3 0 1 2\n3 1 0 3\n3 0 1 4\n"
PAGE = (ROOT / "docs/ci.md").read_text()


def blocks(heading, language):
    section = re.split(r"^## ", PAGE.split(f"## {heading}\n")[1], flags=re.M)[0]
    found = re.findall(rf"^```{language}\n(.*?)^```$", section, flags=re.M | re.S)
    assert found, f"no {language} under '{heading}'"
    return found


def environment(**more):
    return os.environ | {"PATH": f"{pathlib.Path(FDCG).parent}:{os.environ['PATH']}"} | more  # `more` may have a PATH


class Recipes(Case):
    def setUp(self):
        super().setUp()
        os.mkdir(self.path("meshes"))
        self.write("meshes/part.off", CUBE)

    def shell(self, script, code=0, **variables):
        # as GitHub runs "shell: bash"
        return self.run_program("bash", "--noprofile", "--norc", "-eo", "pipefail", "-c", script, code=code, cwd=self.folder,
                                env=environment(**variables))

    def test_settings(self):
        settings = blocks("Settings beside the meshes", "json")[0]
        jsonschema.validate(json.loads(settings), json.loads((ROOT / "schemas/validate-config.schema.json").read_text()))
        self.write("meshes/.fdcg-validate.json", settings)
        self.write("meshes/open.off", MISSING_FACE)
        self.assertIn(b"settings: meshes/.fdcg-validate.json", self.shell("fdcg validate meshes").stdout)

    def test_shell_step(self):
        script = blocks("A shell step", "sh")[0]
        self.shell(script)
        for name in ("report.xml", "report.sarif"):
            self.assertTrue((self.folder / name).is_file())
        self.write("meshes/fan.off", THREE_ON_AN_EDGE)
        self.assertIn(b"2 files: 1 pass, 1 fail", self.shell(script, code=1).stdout)

    def has_viewer(self):
        return b"no viewer" not in self.shell("fdcg view absent.off", code=3).stderr

    def test_gitlab(self):
        recipe = blocks("GitLab", "yaml")[0]
        script = "\n".join(re.findall(r"^    - (.*)$", recipe, flags=re.M))
        if not self.has_viewer():
            self.skipTest("this fdcg has no viewer")
        self.write("meshes/fan.off", THREE_ON_AN_EDGE)
        self.shell(script, code=1, **self.to_install())
        self.assertTrue((self.folder / ".local/bin/fdcg").is_file())
        kept = [re.search(r"paths: \[(.*)\]", recipe)[1], re.search(r"junit: (.*)", recipe.split("reports:")[1])[1]]
        for name in kept:
            self.assertGreater((self.folder / name).stat().st_size, 0)

    def test_jenkins(self):
        recipe = blocks("Jenkins", "groovy")[0]
        self.assertEqual(recipe.count("{"), recipe.count("}"))
        script = re.search(r"^ *sh '(.*)'$", recipe, flags=re.M)[1]
        self.write("meshes/fan.off", THREE_ON_AN_EDGE)
        self.shell(script, code=1, **self.to_install())
        self.assertTrue((self.folder / ".local/bin/fdcg").is_file())
        for name in re.findall(r"(?:junit|artifacts:) '(.*?)'", recipe):
            self.assertGreater((self.folder / name).stat().st_size, 0)

    def test_baseline(self):
        self.write("meshes/open.off", MISSING_FACE)
        accept, compare = blocks("Meshes that have findings already", "sh")[0].splitlines()
        self.shell(compare, code=3)
        self.shell(accept)
        self.shell(compare)
        self.write("meshes/open.off", MISSING_FACE.replace("8 5 0", "8 4 0").replace("4 2 3 7 6\n", ""))
        self.assertIn(b"known", self.shell(compare, code=1).stdout)

    def test_ctest(self):
        check, compile_ = blocks("CMake and CTest", "cmake")
        self.write("CMakeLists.txt", "cmake_minimum_required(VERSION 3.22)\nproject(consumer NONE)\n" + check + compile_)
        self.shell("cmake -G Ninja -S . -B build && cmake --build build && ctest --test-dir build --no-tests=error")
        self.assertTrue((self.folder / "build/meshes.xml").is_file())
        self.assertTrue((self.folder / "build/part.fdcg").is_file())
        again = self.shell("cmake --build build").stdout
        self.assertIn(b"no work to do", again)
        self.write("meshes/fan.off", THREE_ON_AN_EDGE)
        self.assertIn(b"non-manifold-edge", self.shell("ctest --test-dir build --output-on-failure", code=8).stdout)

    def test_github_action(self):
        action = (ROOT / "tools/ci/action.yml").read_text()
        script = textwrap.dedent(re.findall(r"^      run: \|\n((?:        .*\n)+)", action, flags=re.M)[1])
        self.assertIn("steps.validate.outputs.report", action)
        self.write("meshes/fan with blank.off", THREE_ON_AN_EDGE)
        output = self.write("output", "")
        variables = {"RUNNER_TEMP": str(self.folder), "GITHUB_OUTPUT": output}
        self.shell(script, code=1, MESHES="meshes\n\n", ARGUMENTS="", **variables)
        page = f"page={self.folder}/meshes.html\n" if self.has_viewer() else ""
        self.assertEqual(f"{page}report={self.folder}/fdcg.sarif\n", pathlib.Path(output).read_text())
        self.assertEqual(self.has_viewer(), (self.folder / "meshes.html").is_file())
        self.assertIn("path: ${{ steps.validate.outputs.page }}", action)
        run = json.loads((self.folder / "fdcg.sarif").read_text())["runs"][0]
        self.assertEqual(["meshes/fan%20with%20blank.off", "meshes/part.off"], [artifact["location"]["uri"] for artifact in run["artifacts"]])
        # code scanning shows each result at its first line
        self.assertIn(8, [result["locations"][0]["physicalLocation"]["region"]["startLine"] for result in run["results"]])
        self.shell(script, MESHES="meshes/fan*.off\nmeshes/part.off", ARGUMENTS="--fail-on never --jobs 1", **variables)
        pathlib.Path(output).write_text("")
        self.shell(script, code=2, MESHES="meshes", ARGUMENTS="--nonsense", **variables)
        self.assertEqual("", pathlib.Path(output).read_text())

    def test_github_action_installs_what_is_not_there_and_the_hook_too(self):
        action = (ROOT / "tools/ci/action.yml").read_text()
        steps = [textwrap.dedent(step) for step in re.findall(r"^      run: \|\n((?:        .*\n)+)", action, flags=re.M)]
        self.shell(steps[0], ACTION="/nowhere", PACKAGE="/nowhere", SHA256="", RELEASE="")  # fdcg is on the PATH
        archive = self.archive("bin/fdcg", f'#!/bin/sh\nexec "{FDCG}" "$@"\n')
        bare = {"PATH": self.without_fdcg(), "HOME": str(self.folder)}
        variables = bare | {"ACTION": str(ROOT / "tools/ci"), "RELEASE": "/nowhere", "GITHUB_PATH": self.path("path")}
        wrong = self.shell(steps[0], code=3, PACKAGE=str(archive), SHA256="0" * 64, **variables)
        self.assertIn(b"nothing was installed", wrong.stderr)
        self.assertIn(b"cannot read", self.shell(steps[0], code=3, PACKAGE=str(archive), SHA256="", **variables).stderr)  # no SHA256SUMS
        self.assertFalse((self.folder / ".local").exists())
        self.assertIn(b"/nowhere/fdcg_", self.shell(steps[0], code=3, PACKAGE="", SHA256="", **variables).stderr)
        self.write("SHA256SUMS", f"{hashlib.sha256(archive.read_bytes()).hexdigest()}  {archive.name}\n")
        self.shell(steps[0], PACKAGE=str(archive), SHA256="", **variables)
        self.assertEqual(f"{self.folder}/.local/bin\n", (self.folder / "path").read_text())
        self.assertTrue((self.folder / ".local/bin/fdcg").is_file())
        hook = str(ROOT / "tools/ci/hook")
        self.assertIn(b"FDCG_PACKAGE", self.shell(f"{hook} meshes/part.off", code=3, **bare).stderr)
        for _ in range(2):
            self.shell(f"{hook} meshes/part.off", **bare, FDCG_PACKAGE=str(archive))
            archive.unlink(missing_ok=True)  # the second time it is there

    def to_install(self):
        """The script in the repository of the meshes, and the environment with a package for it."""
        (self.folder / "ci").mkdir()
        shutil.copy(ROOT / "tools/ci/install", self.folder / "ci")
        archive = self.archive("bin/fdcg", f'#!/bin/sh\nexec "{FDCG}" "$@"\n')
        self.write("SHA256SUMS", f"{hashlib.sha256(archive.read_bytes()).hexdigest()}  {archive.name}\n")
        return {"HOME": str(self.folder), "FDCG_PACKAGE": str(archive)}

    def archive(self, name, content):
        path = self.folder / "fdcg-0.1.0-linux.tar.gz"
        with tarfile.open(path, "w:gz") as files:
            entry = tarfile.TarInfo(f"fdcg-0.1.0-linux/{name}")
            entry.size, entry.mode = len(content), 0o755
            files.addfile(entry, io.BytesIO(content.encode()))
        return path

    @staticmethod
    def without_fdcg():
        folders = os.environ["PATH"].split(":")
        return ":".join(folder for folder in folders if not (pathlib.Path(folder) / "fdcg").exists())

    def test_github_workflow_uses_inputs_that_the_action_has(self):
        action = (ROOT / "tools/ci/action.yml").read_text()
        used = re.findall(r"^    (\w+):", blocks("GitHub", "yaml")[0], flags=re.M)
        used += re.findall(r"^    (\w+):", blocks("GitHub", "yaml")[1], flags=re.M)
        self.assertEqual(["meshes", "arguments", "arguments"], used)
        for name in used:
            self.assertRegex(action, rf"(?m)^  {name}:$")

    def test_pre_commit_hook(self):
        hook = dict(re.findall(r"^[- ] (\w+): (.*)$", (ROOT / ".pre-commit-hooks.yaml").read_text(), flags=re.M))
        self.assertIn(f"id: {hook['id']}", blocks("pre-commit", "yaml")[0])
        self.write("meshes/Open.OFF", MISSING_FACE)
        self.write("note.txt", "no mesh")
        staged = [str(path.relative_to(self.folder)) for path in sorted(self.folder.rglob("*")) if path.is_file()]
        chosen = [path for path in staged if re.search(hook["files"], path)]
        self.assertEqual(["meshes/Open.OFF", "meshes/part.off"], chosen)
        arguments = re.search(r"args: \[(.*)\]", blocks("pre-commit", "yaml")[0])[1].split(", ")
        self.assertEqual("script", hook["language"])  # the entry is a path in the hook's repository
        command = [str(ROOT / hook["entry"]), *arguments, *chosen]
        done = subprocess.run(command, cwd=self.folder, env=environment(), capture_output=True, check=False, timeout=60)
        self.assertEqual(1, done.returncode)
        self.assertIn(b"Open.OFF: fail", done.stdout)
        self.assertNotIn(b"part.off", done.stdout)


if __name__ == "__main__":
    unittest.main()
