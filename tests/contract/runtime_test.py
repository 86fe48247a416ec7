# SPDX-License-Identifier: Apache-2.0
"""What those who embed the runtime rely on: C alone is enough, the step calls nothing, the documents' commands run."""
import os
import pathlib
import re
import shutil
import subprocess
import unittest

from support import ROOT, Case

LIBRARY = os.environ["FDCG_RUNTIME_LIBRARY"]
CC = os.environ["FDCG_CC"]
NM = os.environ["FDCG_NM"]
C_FLAGS = ["-std=c11", "-pedantic", "-Wall", "-Wextra", "-Werror", "-I", str(ROOT / "runtime" / "include")]

# What a C compiler may call on its own account, and where its library keeps what the processor has; anything else that the
# library does not define itself stands out.
COMPILER_CALLS = {"memcpy", "memset", "memmove", "memcmp", "_GLOBAL_OFFSET_TABLE_", "__cpu_model"}
PLATFORM_CALLS = {"madvise", "mprotect", "read", "sysconf", "open", "open64", "close", "fstat", "fstat64", "mmap", "mmap64", "munmap", "__errno_location"}


def symbols():
    """Of each object of the library: the names it defines, and those it lacks."""
    text = subprocess.run([NM, LIBRARY], capture_output=True, check=True, text=True).stdout
    objects, name = {}, None
    for line in text.splitlines():
        if line.endswith(":"):
            name = line[:-1]
            objects[name] = (set(), set())
        elif line.strip():
            kind, symbol = line.split()[-2:]
            objects[name][1 if kind == "U" else 0].add(symbol)
    return objects


class Embedding(Case):
    def compiled_by_c(self, source):
        program = self.path("program")
        self.run_program(CC, *C_FLAGS, source, LIBRARY, "-o", program, "-lm")
        return program

    def test_a_c_program_needs_the_headers_and_the_library_alone(self):
        graph = self.compiled_cube()
        program = self.compiled_by_c(str(ROOT / "tests" / "contract" / "header_c11.c"))
        self.assertEqual(b"0 0 250\n", self.run_program(program, graph).stdout)

    def test_each_header_compiles_alone(self):
        for header in ("fdcg/format.h", "fdcg/fdcg.h", "fdcg/scene.h", "fdcg/body.h", "fdcg/deform.h", "fdcg/pile.h", "fdcg/surface.h"):
            for compiler, language in ((CC, "c"), (CC, "c++")):
                source = self.write("alone." + language, f'#include "{header}"\n#include "{header}"\n')
                standard = "-std=c11" if language == "c" else "-std=c++20"
                self.run_program(compiler, "-x", language, standard, *C_FLAGS[1:], "-fsyntax-only", source)

    def test_the_library_calls_no_heap_no_exceptions_no_clock_no_locks(self):
        objects = symbols()
        defined = set().union(*(own for own, _ in objects.values()))
        for name, (_, lacking) in objects.items():
            allowed = COMPILER_CALLS | (PLATFORM_CALLS if name.startswith("map_file") else set())
            self.assertEqual(set(), lacking - defined - allowed, name)

    def test_the_step_stands_alone_in_its_object(self):
        objects = {name: lacking for name, (_, lacking) in symbols().items() if name.startswith("servo_step")}
        self.assertEqual(1, len(objects))
        for lacking in objects.values():
            self.assertFalse([symbol for symbol in lacking if re.search(r"malloc|free|_Zn|_Zd|throw|cxa|unwind|clock|pthread", symbol)])


class RuntimeOnly(Case):
    """Where nothing is installed but a compiler and CMake: neither packages nor the other folders of the project."""

    def setUp(self):
        super().setUp()
        self.tree = self.path("tree")
        os.makedirs(self.tree)
        for name in ("CMakeLists.txt", "CMakePresets.json", "LICENSE", "README.md", "CHANGELOG.md", "docs", "runtime", "cmake", "schemas"):
            source = ROOT / name
            (shutil.copytree if source.is_dir() else shutil.copy)(source, os.path.join(self.tree, name))

    def test_the_preset_configures_builds_and_installs(self):
        hidden = [f"-DCMAKE_DISABLE_FIND_PACKAGE_{name}=ON" for name in
                  ("CGAL", "OpenMesh", "draco", "nlohmann_json", "OpenSSL", "CLI11", "Threads", "Catch2", "benchmark")]
        hidden += [f"-DCMAKE_FIND_USE_{where}=OFF" for where in
                   ("CMAKE_ENVIRONMENT_PATH", "CMAKE_SYSTEM_PACKAGE_REGISTRY", "PACKAGE_REGISTRY", "PACKAGE_ROOT_PATH")]
        self.run_program("cmake", "--preset", "runtime-only", *hidden, cwd=self.tree)
        self.run_program("cmake", "--build", "--preset", "runtime-only", cwd=self.tree)
        self.run_program("cmake", "--install", "build/runtime-only", "--prefix", self.path("prefix"), cwd=self.tree)
        self.assertTrue(list(pathlib.Path(self.path("prefix")).glob("**/libfdcg_runtime.a")))

    def test_the_commands_of_the_documents_run(self):
        for program in ("arm-none-eabi-gcc", "qemu-system-arm"):
            if shutil.which(program) is None:
                self.skipTest(f"{program} is missing; tools/check installs it (group test of tools/packages)")
        named = r"<!-- test: by=contract: runtime_test.RuntimeOnly -->\n```sh\n(.*?)```"
        commands = "\n".join(re.findall(named, (ROOT / "docs" / "embed.md").read_text(), re.S))
        environment = {**os.environ, "HOME": self.path("home"), "PATH": os.path.dirname(os.environ["FDCG"]) + ":" + os.environ["PATH"]}
        done = self.run_program("bash", "-e", "-c", commands, cwd=self.tree, env=environment)
        self.assertIn(b"tick 5: state 1, slip 1, force -400 0 1000 mN", done.stdout + done.stderr)


if __name__ == "__main__":
    unittest.main()
