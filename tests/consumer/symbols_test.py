# SPDX-License-Identifier: Apache-2.0
"""The shared libraries: what they export, what they need, and that a program, a plugin and a foreign language step to the hash of
the static library."""
import ctypes
import os
import pathlib
import re
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "anywhere"))
from anywhere import C, ROOT, RUNTIME, AnywhereCase  # noqa: E402

BUILD = pathlib.Path(os.environ["FDCG_BUILD"])
LIBRARY = BUILD / "runtime" / "libfdcg.so"
BAKE = BUILD / "lib" / "libfdcg_bake_c.so"
HEADERS = sorted(path for path in (RUNTIME / "include" / "fdcg").glob("*.h") if path.name != "format.h")
STEP_HASH = os.environ["FDCG_STEP_HASH"]
GRAPHS = os.environ["FDCG_HASH_GRAPHS"]
ARRAYS = os.environ["FDCG_HASH_ARRAYS"]
SYSTEM = r"lib(c|m|gcc_s)\.so\.\d+|ld-linux-x86-64\.so\.2"


def declared(headers):
    """The functions and constants that headers declare."""
    names = set()
    for header in headers:
        text = re.sub(r"/\*.*?\*/", "", header.read_text(), flags=re.S)
        names |= set(re.findall(r"^FDCG_(?:API|INLINE) [^;({]*?(fdcg_\w+)\(", text, re.M))
        names |= set(re.findall(r"^FDCG_API extern [^;({]*?(fdcg_\w+)(?:\[\d+\])?;", text, re.M))
    return names


class SymbolsCase(AnywhereCase):
    def exported(self, library):
        lines = self.run_program("nm", "-D", "--defined-only", str(library)).stdout.decode().splitlines()
        return {line.split()[2].split("@")[0] for line in lines if line.split()[1] != "A"}

    def needed(self, library):
        text = self.run_program("readelf", "-d", str(library)).stdout.decode()
        return re.findall(r"\(NEEDED\).*\[(.*)\]", text), re.findall(r"\(SONAME\).*\[(.*)\]", text)


class Shared(SymbolsCase):
    def test_it_exports_what_the_headers_declare_and_nothing_else(self):
        names = declared(HEADERS)
        self.assertGreater(len(names), 110)
        self.assertEqual(names, self.exported(LIBRARY))

    def test_it_has_a_soname_and_needs_the_c_library_alone(self):
        needed, soname = self.needed(LIBRARY)
        self.assertEqual(["libfdcg.so.0"], soname)
        self.assertEqual([], [name for name in needed if not re.fullmatch(SYSTEM, name)])

    def test_a_program_that_links_it_has_the_hash_of_the_static_one(self):
        program = self.path("step_hash")
        self.run_program("cc", *C, "-O1", "-I", str(RUNTIME / "include"), "-I", GRAPHS, str(ROOT / "tests" / "anywhere" / "step_hash.c"),
                         ARRAYS, str(LIBRARY), f"-Wl,-rpath,{LIBRARY.parent}", "-o", program)
        self.assertIn(b"libfdcg.so.0", self.run_program("readelf", "-d", program).stdout)
        self.assertEqual(self.run_program(STEP_HASH).stdout, self.run_program(program).stdout)

    def test_what_is_inline_in_c_is_called_by_name_too(self):
        library = ctypes.CDLL(str(LIBRARY))

        class Options(ctypes.Structure):
            _fields_ = [("struct_bytes", ctypes.c_uint32), ("verify", ctypes.c_uint32), ("populate", ctypes.c_uint32),
                        ("huge_pages", ctypes.c_uint32)]
        library.fdcg_make_open_options.restype = Options
        options = library.fdcg_make_open_options()
        self.assertEqual((16, 2, 0, 0), (options.struct_bytes, options.verify, options.populate, options.huge_pages))

    def test_fast_math_is_refused_where_the_library_is_compiled(self):
        source = RUNTIME / "src" / "step" / "servo_step.cpp"
        for flag in ("-ffast-math", "-ffinite-math-only"):
            done = self.run_program(*self.runtime_command("g++", [flag], source), "-o", self.path("fast.o"), code=1)
            self.assertIn(b"leave them out", done.stderr)

    def test_a_program_that_flushes_subnormals_is_told_so(self):
        source = self.write("fast.c", """
#include <stdio.h>
#include "graphs.h"
#include "fdcg/fdcg.h"
int main(void) {
  fdcg_graph graph;
  fdcg_error error;
  const fdcg_status status = fdcg_open_memory(graphs[0].bytes, graphs[0].size, FDCG_VERIFY_SAFE, &graph, &error);
  printf("%d %s\\n", (int)status, error.message);
  return 0;
}
""")
        program = self.path("fast")
        self.run_program("gcc", "-ffast-math", "-I", str(RUNTIME / "include"), "-I", GRAPHS, source, ARRAYS,
                         os.environ["FDCG_RUNTIME_LIBRARY"], "-lm", "-o", program)
        self.assertRegex(self.run_program(program).stdout.decode(), "^11 .*flushes subnormal numbers")


class Plugin(SymbolsCase):
    """A shared object with hidden symbols, as an engine loads it."""

    HOST = """
#include <dlfcn.h>
#include <stdio.h>
int main(int argc, char** argv) {
  void* plugin = argc > 1 ? dlopen(argv[1], RTLD_NOW | RTLD_LOCAL) : NULL;
  if (plugin == NULL) return fputs(dlerror(), stderr), 2;
  int (*run)(void);
  *(void**)&run = dlsym(plugin, "plugin_main");
  return run == NULL ? 3 : run();
}
"""

    def test_static_and_shared_in_a_plugin(self):
        host = self.path("host")
        self.run_program("cc", "-x", "c", self.write("host.c", self.HOST), "-ldl", "-o", host)
        source = str(ROOT / "tests" / "anywhere" / "step_hash.c")
        arrays = os.path.join(GRAPHS, "graphs.c")
        export = '-Dmain=__attribute__((visibility("default"))) plugin_main'
        for name, library in (("static", os.environ["FDCG_RUNTIME_LIBRARY"]), ("shared", str(LIBRARY))):
            plugin = self.path(name + ".so")
            self.run_program("cc", *C, "-O1", "-fPIC", "-fvisibility=hidden", "-shared", export, "-I", str(RUNTIME / "include"), "-I",
                             GRAPHS, source, arrays, library, "-lm", f"-Wl,-rpath,{LIBRARY.parent}", "-Wl,--no-undefined", "-o", plugin)
            self.assertEqual({"plugin_main"}, self.exported(plugin))
            self.assertEqual(self.run_program(STEP_HASH).stdout, self.run_program(host, plugin).stdout, name)


class Bake(SymbolsCase):
    def test_it_exports_what_its_header_declares_and_needs_no_reader(self):
        self.assertEqual(declared([ROOT / "lib" / "include" / "fdcg" / "bake.h"]), self.exported(BAKE))
        needed, soname = self.needed(BAKE)
        self.assertEqual(["libfdcg_bake_c.so.0"], soname)
        self.assertEqual([], [name for name in needed if not re.fullmatch(SYSTEM + r"|lib(gmp|mpfr|stdc\+\+)\.so\.\d+", name)])


if __name__ == "__main__":
    unittest.main()
