# SPDX-License-Identifier: Apache-2.0
"""Windows: built by MinGW, run by Wine. The same bits, a DLL with the functions of the headers, files by any name, parts that link
themselves alone, and an archive that another program builds with."""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import unittest
import zipfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "consumer"))
from anywhere import C, ROOT, RUNTIME, TOOLCHAINS
from same_bits_test import GRAPHS, MOVING_HASH, MOVING_SOURCE, SOURCE, HashCase
from symbols_test import HEADERS, declared

CC = "x86_64-w64-mingw32-gcc"
WINE = shutil.which("wine64") or shutil.which("wine") or "/usr/lib/wine/wine64"
FILES = r"""
#include <stdio.h>
#include "fdcg/fdcg.h"
static void open_it(const char* path, unsigned copied) {
  fdcg_open_options options = fdcg_make_open_options();
  fdcg_graph graph;
  fdcg_error error = {FDCG_OK, 0, ""};
  options.huge_pages = copied;
  options.populate = 1;
  if (fdcg_open_file_with(path, &options, &graph, &error) == FDCG_OK) {
    const unsigned nodes = (unsigned)graph.header->node_count;
    printf("%u nodes; closed: %d\n", nodes, (int)fdcg_close(&graph));
  } else {
    printf("%s\n", error.message);
  }
}
int main(void) {
  open_it("m\xc3\xa4sh \xe2\x82\xac.fdcg", 0);
  open_it("m\xc3\xa4sh \xe2\x82\xac.fdcg", 1);
  open_it("missing.fdcg", 0);
  open_it("folder", 0);
  open_it("empty.fdcg", 0);
  open_it("\xff.fdcg", 0);
  open_it("NUL", 0);
  return 0;
}
"""
CONSUMER = """
cmake_minimum_required(VERSION 3.22)
project(consumer C)
find_package(fdcg REQUIRED COMPONENTS runtime shared surface)
foreach(library runtime shared)
  add_executable(hash_${library} ${HASH_SOURCE} ${HASH_GRAPHS}/graphs.c)
  target_include_directories(hash_${library} PRIVATE ${HASH_GRAPHS})
  target_link_libraries(hash_${library} PRIVATE fdcg::${library})
  target_compile_options(hash_${library} PRIVATE -ffp-contract=off)
endforeach()
add_executable(sphere ${SPHERE_SOURCE})
target_link_libraries(sphere PRIVATE fdcg::surface)
"""


class Windows(HashCase):
    @classmethod
    def tearDownClass(cls):
        subprocess.run((pathlib.Path(WINE).parent / "wineserver", "-k"), check=False, capture_output=True)
        super().tearDownClass()

    def setUp(self):
        super().setUp()
        self.need(CC, "x86_64-w64-mingw32-g++", "x86_64-w64-mingw32-objdump", "ninja")
        if not os.path.exists(WINE):
            self.skipTest("wine64 is missing; tools/check --all installs it (group windows of tools/packages)")
        self.environment = {**os.environ, "WINEPREFIX": self.path("wine"), "WINEDEBUG": "-all", "LC_ALL": "C.UTF-8", "DISPLAY": ""}

    def wine(self, program):
        done = self.run_program(WINE, str(program), env=self.environment, cwd=str(self.folder))
        return done.stdout.decode(errors="replace").replace("\r\n", "\n")

    def built(self, name, source, *flags):
        program = self.path(name + ".exe")
        self.run_program(CC, *C, "-O1", "-I", str(RUNTIME / "include"), "-I", GRAPHS, source, *flags, "-o", program)
        return program

    def test_static_library(self):
        library = self.cross_runtime("mingw-w64", "-DCMAKE_BUILD_TYPE=Release")
        graphs = os.path.join(GRAPHS, "graphs.c")
        self.assert_same_bits(self.wine(self.built("step", SOURCE, graphs, library, "-lm")), "Windows x64, MinGW")
        moving = self.run_program(MOVING_HASH).stdout.decode()
        self.assertEqual(moving, self.wine(self.built("moving", MOVING_SOURCE, graphs, library, "-lm")))
        self.assertEqual("", self.wine(self.built("one_sphere", str(ROOT / "tests/consumer/parts/one_sphere.c"), library)))
        self.try_files(library)

    def try_files(self, library):
        program = self.built("files", self.write("files.c", FILES), library)
        self.fdcg("compile", str(RUNTIME / "examples" / "cube.obj"), "-q", "-o", self.path("mäsh €.fdcg"))
        self.write("empty.fdcg", "")
        os.mkdir(self.path("folder"))
        said = self.wine(program).splitlines()
        self.assertEqual(["6 nodes; closed: 0", "6 nodes; closed: 0", "'missing.fdcg': No such file or directory",
                          "'folder': is a directory; give an .fdcg file", "'empty.fdcg': is empty; compile the mesh again"], said[:5])
        self.assertIn("the name is no UTF-8", said[5])
        self.assertRegex(said[6], "'NUL': (is not a regular file|No such file|the system refuses)")

    def test_archive(self):
        done = subprocess.run((ROOT / "tools" / "package", "windows", "--output", self.path("made")), stdin=subprocess.DEVNULL,
                              capture_output=True, text=True, timeout=500, check=False)
        self.assertEqual(0, done.returncode, done.stdout + done.stderr)
        archive, = (self.folder / "made").glob("fdcg-*-windows-x86_64.zip")
        with zipfile.ZipFile(archive) as files:
            files.extractall(self.path("archive"))
        prefix = self.folder / "archive" / archive.stem
        exports = self.run_program("x86_64-w64-mingw32-objdump", "-p", str(prefix / "bin" / "fdcg.dll")).stdout.decode()
        self.assertEqual(declared(HEADERS), set(re.findall(r"^\s*\[\s*\d+\].*\s(\w+)$", exports.split("[Ordinal/Name Pointer] Table")[1], re.M)))
        self.assertEqual({"KERNEL32.dll", "msvcrt.dll"}, set(re.findall(r"DLL Name: (\S+)", exports)))
        os.mkdir(self.path("consumer"))
        self.write("consumer/CMakeLists.txt", CONSUMER)
        self.run_program("cmake", "-S", self.path("consumer"), "-B", self.path("build"), "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={prefix}",
                         f"--toolchain={TOOLCHAINS / 'mingw-w64.cmake'}", "-DCMAKE_FIND_ROOT_PATH_MODE_PACKAGE=BOTH",
                         f"-DHASH_SOURCE={SOURCE}", f"-DHASH_GRAPHS={GRAPHS}",
                         f"-DSPHERE_SOURCE={ROOT / 'tests/consumer/parts/one_sphere.c'}")
        self.run_program("cmake", "--build", self.path("build"))
        shutil.copy(prefix / "bin" / "fdcg.dll", self.path("build"))
        for library in ("runtime", "shared"):
            self.assert_same_bits(self.wine(self.path(f"build/hash_{library}.exe")), f"Windows x64, {library} of the archive")
        self.wine(self.path("build/sphere.exe"))


class Syntax(HashCase):
    """Systems whose compilers and headers are not at hand: clang reads every source for them, with headers of another C library."""

    def reads(self, target, *flags, leave_out=()):
        sources = [source for source in sorted((RUNTIME / "src").rglob("*.cpp")) if source.stem not in leave_out]
        self.assertGreater(len(sources), 70)
        self.compile_all([([*self.runtime_command("clang++", [f"--target={target}", "-Wno-unknown-attributes", *flags], source), "-fsyntax-only"],
                           self.path(source.name + ".o")) for source in sources])

    def test_windows_by_microsofts_rules(self):
        self.need("clang++", CC)
        self.reads("x86_64-pc-windows-msvc", "-fgnuc-version=12", "-D_MT", "-D__MINGW32__", "-D__MINGW64__", "-isystem",
                   "/usr/x86_64-w64-mingw32/include")

    def test_macos(self):
        self.need("clang++")
        if not os.path.isdir("/usr/include/wasm32-wasi"):
            self.skipTest("wasi-libc is missing; tools/check installs it (group viewer of tools/packages)")
        self.reads("arm64-apple-macos12", "-nostdlibinc", "-D__wasi__", "-DFDCG_WITH_FILES=0", "-isystem", "/usr/include/wasm32-wasi",
                   leave_out=("map_file_posix",))


if __name__ == "__main__":
    unittest.main()
