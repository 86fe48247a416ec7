# SPDX-License-Identifier: Apache-2.0
"""What tools/packaging says agrees with the build: versions, options, packages, files, and scripts."""
import importlib.util
import json
import os
import pathlib
import re
import sys
import tempfile
import types
import unittest

ROOT = pathlib.Path(os.environ["FDCG_ROOT"])
PACKAGING = ROOT / "tools" / "packaging"
DEBIAN = PACKAGING / "debian"
VERSION = re.search(r"project\(fdcg VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text())[1]
COMPILERS = {"g++", "libc6-dev"}  # Debian takes them for granted
FOR_PYTHON = {"dh-python", "pybind11-dev", "python3-dev"}


def options():
    """Of the build, with the runtime's."""
    text = "".join((ROOT / path).read_text() for path in ("CMakeLists.txt", "runtime/CMakeLists.txt"))
    return set(re.findall(r"option\((FDCG_\w+)", text)) | {"FDCG_VIEWER", "FDCG_PYTHON_DIR"}


def group(name):
    return set(re.search(rf"^{name}: (.*)$", (ROOT / "tools" / "packages").read_text(), re.M)[1].split())


def paragraphs():
    """debian/control: {package: {field: value}}; that of the sources is "source"."""
    text = re.sub(r"^#.*\n", "", (DEBIAN / "control").read_text(), flags=re.M)
    found = [dict(re.findall(r"^([\w-]+): *(.*(?:\n[ \t].*)*)", paragraph, re.M)) for paragraph in text.split("\n\n")]
    return {fields.get("Package", "source"): fields for fields in found}


def names(field):
    """Of a list of packages, without versions and substitutions."""
    return {re.sub(r"\s*\(.*?\)", "", name).strip() for name in field.split(",")} - {""}


class Debian(unittest.TestCase):
    def test_the_version_is_that_of_the_build(self):
        first = (DEBIAN / "changelog").read_text().splitlines()[0]
        self.assertRegex(first, rf"^fdcg \({re.escape(VERSION)}-0fdcg\d+\) ")

    def test_it_is_built_with_the_packages_that_the_scripts_install(self):
        wanted = names(paragraphs()["source"]["Build-Depends"])
        self.assertEqual((group("build") - COMPILERS) | FOR_PYTHON | {"debhelper-compat"}, wanted)
        self.assertLessEqual(FOR_PYTHON | {"debhelper"}, group("package"))

    def test_packages_have_the_name_of_their_library_and_every_package_has_files(self):
        packages = set(paragraphs()) - {"source"}
        self.assertEqual(packages, {path.stem for path in DEBIAN.glob("*.install")})
        for folder, library in (("runtime", "libfdcg0"), ("lib", "libfdcg-bake-c0")):
            soversion = re.search(r" VERSION ([\d.]+) SOVERSION (\d+)", (ROOT / folder / "CMakeLists.txt").read_text())
            self.assertEqual(VERSION, soversion[1])
            self.assertEqual(soversion[2], re.search(r"\d+$", library)[0])
            self.assertIn(library, names(paragraphs()["libfdcg-dev"]["Depends"]))

    def test_what_is_suggested_is_what_the_component_bake_links(self):
        suggested = names(paragraphs()["libfdcg-dev"]["Suggests"]) - {"fdcg"}
        self.assertLessEqual(suggested, group("build"))
        config = (ROOT / "cmake" / "fdcg-config.cmake").read_text()
        for name in re.findall(r"find_dependency\((\w+)", config):
            if name != "Threads":
                known = {"OpenSSL": "libssl-dev", "ZLIB": "zlib1g-dev"}.get(name, f"lib{name.lower()}-dev")
                self.assertIn(known, suggested)


class Options(unittest.TestCase):
    def test_every_option_that_is_set_is_one_of_the_build(self):
        known = options()
        for path in (DEBIAN / "rules", PACKAGING / "vcpkg" / "portfile.cmake"):
            used = set(re.findall(r"-D(FDCG_\w+)=", path.read_text()))
            self.assertGreater(len(used), 2, path)
            self.assertLessEqual(used, known, path)
            self.assertIn("FDCG_BUILD_TESTS", used, path)


class Vcpkg(unittest.TestCase):
    def test_the_version_is_that_of_the_build_and_functions_come_from_named_ports(self):
        manifest = json.loads((PACKAGING / "vcpkg" / "vcpkg.json").read_text())
        self.assertEqual(("fdcg", VERSION, "Apache-2.0"), tuple(manifest[key] for key in ("name", "version", "license")))
        port = (PACKAGING / "vcpkg" / "portfile.cmake").read_text()
        hosts = {one["name"] for one in manifest["dependencies"] if one["host"]}
        self.assertEqual({"vcpkg-cmake", "vcpkg-cmake-config"}, hosts)
        called = set(re.findall(r"^(vcpkg_\w+)\(", port, re.M))
        self.assertEqual({"vcpkg_cmake_configure", "vcpkg_cmake_install", "vcpkg_cmake_config_fixup", "vcpkg_fixup_pkgconfig",
                          "vcpkg_install_copyright"}, called)
        self.assertEqual(ROOT, (PACKAGING / "vcpkg" / re.search(r"CURRENT_LIST_DIR}/([./]+)\"", port)[1]).resolve())


def stand_in(calls):
    """Of Conan's modules, what the recipe imports: bases and calls that are written down."""
    def copy(recipe, pattern, src, dst):
        found = [path for path in pathlib.Path(src).glob(pattern)]
        calls.append(("copy", pattern, len(found)))

    class Toolchain:
        def __init__(self, recipe):
            self.cache_variables = {}

        def generate(self):
            calls.append(("variables", dict(self.cache_variables)))

    modules = {"conan": {"ConanFile": object}, "conan.tools": {},
               "conan.tools.files": {"copy": copy, "load": lambda _, path: pathlib.Path(path).read_text()},
               "conan.tools.cmake": {"CMake": object, "CMakeToolchain": Toolchain, "cmake_layout": None}}
    return {name: types.SimpleNamespace(**members) for name, members in modules.items()}


class Conan(unittest.TestCase):
    """The recipe's own code, with a stand-in for Conan: what Conan makes of it is not seen here."""

    def setUp(self):
        self.calls = []
        fakes = stand_in(self.calls)
        sys.modules.update(fakes)
        self.addCleanup(lambda: [sys.modules.pop(name) for name in fakes])
        path = PACKAGING / "conan" / "conanfile.py"
        spec = importlib.util.spec_from_file_location("conanfile", path)
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        self.recipe = module.Fdcg()
        self.recipe.recipe_folder = str(path.parent)

    def test_it_reads_the_version_of_the_build(self):
        self.recipe.set_version()
        self.assertEqual(VERSION, self.recipe.version)

    def test_it_takes_along_what_the_runtime_is_configured_and_installed_with(self):
        with tempfile.TemporaryDirectory() as folder:
            self.recipe.export_sources_folder = folder
            self.recipe.export_sources()
        self.assertEqual([], [call for call in self.calls if call[2] == 0], "patterns that match nothing")
        taken = {call[1].split("/")[0] for call in self.calls}
        text = (ROOT / "cmake" / "FdcgInstall.cmake").read_text()
        installed = re.search(r"install\(FILES (LICENSE .*?) DESTINATION", text)[1].split() + re.search(r"DIRECTORY (docs .*?) DESTINATION", text)[1].split()
        self.assertLessEqual({*installed, "CMakeLists.txt", "cmake", "runtime"}, taken)

    def test_its_options_are_those_of_the_runtime(self):
        runtime = set(re.findall(r"option\(FDCG_(WITH_\w+)", (ROOT / "runtime" / "CMakeLists.txt").read_text()))
        self.assertEqual(runtime, {name.upper() for name in self.recipe.options})
        chosen = types.SimpleNamespace(possible_values=self.recipe.options, **{**self.recipe.default_options, "with_f32": False})
        self.recipe.options = chosen
        self.recipe.generate()
        variables = dict(self.calls)["variables"]
        self.assertLessEqual(set(variables), options())
        self.assertEqual({"FDCG_WITH_F32", "FDCG_BUILD_TESTS", "FDCG_WERROR"}, {name for name, value in variables.items() if not value})


class Container(unittest.TestCase):
    def test_it_builds_with_a_script_of_the_project_and_installs_what_that_makes(self):
        text = (PACKAGING / "Containerfile").read_text()
        lines = re.sub(r"\\\n\s*", "", re.sub(r"^#.*\n", "", text, flags=re.M)).splitlines()
        words = [line.split()[0] for line in lines if line]
        self.assertEqual([], [word for word in words if word not in {"FROM", "COPY", "RUN", "WORKDIR", "ENTRYPOINT"}])
        script, what = re.search(r"^RUN /fdcg/(\S+) (\w+)", text, re.M).groups()
        self.assertTrue(os.access(ROOT / script, os.X_OK))
        self.assertRegex((ROOT / script).read_text(), rf"(?m)^ *{what} \| .*\) what=")
        package = re.search(r"/packages/(\w+)_\*\.deb", text)[1]
        self.assertIn(package, paragraphs())
        self.assertIn("usr/bin\n", (DEBIAN / f"{package}.install").read_text())
        stages = set(re.findall(r"^FROM \S+ AS (\w+)", text, re.M))
        self.assertEqual(stages, set(re.findall(r"--from=(\w+)", text)))


if __name__ == "__main__":
    unittest.main()
