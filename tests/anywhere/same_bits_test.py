# SPDX-License-Identifier: Apache-2.0
"""One trajectory hash a precision, from every compiler, optimisation level and processor: that of the library as it was built."""
import concurrent.futures
import os
import re
import shutil
import unittest

from anywhere import ALL, C, ROOT, RUNTIME, AnywhereCase, qemu

STEP_HASH = os.environ["FDCG_STEP_HASH"]  # linked with the library that ships
ARRAYS = os.environ["FDCG_HASH_ARRAYS"]  # graphs.c, compiled for this machine
GRAPHS = os.environ["FDCG_HASH_GRAPHS"]  # folder of graphs.h and graphs.c
SOURCE = str(ROOT / "tests" / "anywhere" / "step_hash.c")
MOVING_HASH = os.environ["FDCG_MOVING_HASH"]  # the same of deformable meshes and bodies
MOVING_SOURCE = str(ROOT / "tests" / "anywhere" / "moving_hash.c")


class HashCase(AnywhereCase):
    def setUp(self):
        super().setUp()
        self.expected = self.run_program(STEP_HASH).stdout.decode()

    def hashed_by(self, name, cc, cxx, flags, arrays=None, link=(), run=()):
        include = ["-I", str(RUNTIME / "include"), "-I", GRAPHS]
        objects = self.runtime_objects(name, cxx, flags)
        sources = [SOURCE] if arrays else [SOURCE, os.path.join(GRAPHS, "graphs.c")]
        objects += self.compile_all([([cc, *C, *flags, *include, "-c", source], self.path(f"{name}-{os.path.basename(source)}.o"))
                                     for source in sources])
        objects += [arrays] if arrays else []
        program = self.path(name)
        self.run_program(cc, *flags, *link, *objects, "-lm", "-o", program)
        return self.run_program(*run, program).stdout.decode()

    def assert_same_bits(self, found, what):
        self.assertEqual(self.expected, found, what)
        print(f"{what}: {' '.join(re.findall(r'[0-9a-f]{16}', found))}")


class Reference(HashCase):
    def test_both_precisions_and_all_four_states_are_in_the_hash(self):
        lines = [line.split() for line in self.expected.splitlines()]
        self.assertEqual(["f32", "f64"], [line[0] for line in lines])
        for line in lines:
            for ticks in line[-4:]:
                self.assertGreater(int(ticks), 200, line)
        self.assertNotEqual(lines[0][1], lines[1][1])


    def test_without_short_ways(self):
        self.need("gcc", "g++")
        flags = ["-O2", "-DFDCG_WITH_FAST_FACES=0", "-DFDCG_WITH_CLEAR_BALLS=0"]
        self.assert_same_bits(self.hashed_by("rules", "gcc", "g++", flags, ARRAYS), "without short ways")


class AsOne(HashCase):
    """All sources of the runtime as one: compiled in half the time, and the compiler sees into every function."""

    def runtime_objects(self, name, compiler, flags):
        sources = sorted((RUNTIME / "src").rglob("*.cpp"), reverse=name.endswith("reversed"))
        one = self.write(name + ".cpp", "".join(f'#include "{source}"\n' for source in sources))
        return self.compile_all([(self.runtime_command(compiler, flags, one), self.path(name + ".o"))])

    def assert_every_level(self, cc, cxx):
        self.need(cc, cxx)
        levels = (["-O0"], ["-O2"], ["-O3", "-march=native"])
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            found = pool.map(lambda flags: self.hashed_by(cc + flags[0], cc, cxx, flags, ARRAYS), levels)
            for flags, hashes in zip(levels, found):
                self.assert_same_bits(hashes, " ".join((cc, *flags)))


class Gcc(AsOne):
    def test_every_level(self):
        self.assert_every_level("gcc", "g++")


class Unity(AsOne):
    """In two orders: each source has names of its own, and none hides another's."""

    def test_all_sources_as_one(self):
        self.need("gcc", "g++")
        for name in ("unity", "unity-reversed"):
            self.assert_same_bits(self.hashed_by(name, "gcc", "g++", ["-O1", "-Wshadow"], ARRAYS), f"gcc -O1, {name}")


class Lto(HashCase):
    def test_one_definition_of_each_type_and_function(self):
        self.need("gcc", "g++")
        flags = ["-O2", "-flto=auto", "-Wodr", "-Wlto-type-mismatch", "-Werror"]
        self.assert_same_bits(self.hashed_by("lto", "gcc", "g++", flags, ARRAYS), "gcc -O2 -flto")


class Clang(AsOne):
    def test_every_level(self):
        self.assert_every_level("clang", "clang++")


class Aarch64(HashCase):
    """Its compilers contract a * b + c into one rounding unless they are told not to."""

    def test_clang(self):
        self.need("clang", "clang++", "aarch64-linux-gnu-ld", "qemu-aarch64")
        flags = ["--target=aarch64-linux-gnu", "-O2"]
        self.assert_same_bits(self.hashed_by("clang", "clang", "clang++", flags, None, ["-static"], ["qemu-aarch64"]), "aarch64 clang -O2")

    def test_gcc(self):
        if shutil.which("aarch64-linux-gnu-g++") is None:
            return  # one compiler there is enough; this one is looked at where it is installed anyway
        self.need("qemu-aarch64")
        found = self.hashed_by("gcc", "aarch64-linux-gnu-gcc", "aarch64-linux-gnu-g++", ["-O3"], None, ["-static"], ["qemu-aarch64"])
        self.assert_same_bits(found, "aarch64 gcc -O3")


class Wasm(HashCase):
    """WebAssembly in node, as in the page of fdcg view: no fused operation there, but a compiler of its own behind it."""

    def run_wasm(self, source, objects, flags):
        sources = (source, os.path.join(GRAPHS, "graphs.c"))
        include = ["-I", str(RUNTIME / "include"), "-I", GRAPHS]
        programs = self.compile_all([(["clang", *C, *flags, *include, "-c", one], self.path(os.path.basename(one) + ".o")) for one in sources])
        program = self.path(os.path.basename(source) + ".wasm")
        self.run_program("clang", *flags, *objects, *programs, "-lm", "-o", program)
        runner = str(ROOT / "tests" / "anywhere" / "run_wasi.mjs")
        return self.run_program("node", "--no-warnings", runner, program).stdout.decode()

    def test_steps_scenes_deformable_meshes_and_bodies(self):
        self.need("clang", "clang++", "wasm-ld", "node")
        if not os.path.isdir("/usr/include/wasm32-wasi"):
            self.skipTest("wasi-libc is missing; tools/check installs it (group viewer of tools/packages)")
        flags = ["--target=wasm32-wasi", "--sysroot=/usr", "-isystem", "/usr/include/wasm32-wasi", "-O2", "-Wno-unused-command-line-argument"]
        objects = self.runtime_objects("wasm", "clang++", flags)
        self.assert_same_bits(self.run_wasm(SOURCE, objects, flags), "wasm32 clang -O2")
        self.expected = self.run_program(MOVING_HASH).stdout.decode()
        self.assertEqual(2, len(self.expected.splitlines()))
        self.assert_same_bits(self.run_wasm(MOVING_SOURCE, objects, flags), "wasm32 clang -O2, deform and body")


class CortexM(HashCase):
    """Bare metal: no operating system, the graphs in flash, -Os, the runtime by its own build and a toolchain file."""

    def hashed_on(self, processor, toolchain, *options, flags=(), link=("-Wl,--gc-sections",)):
        self.need("arm-none-eabi-gcc", "arm-none-eabi-g++", "qemu-system-arm", "ninja")
        library = self.cross_runtime(toolchain, *options, of=ALL)
        program = self.firmware(processor, library, SOURCE, os.path.join(GRAPHS, "graphs.c"), flags=["-DFDCG_ON_BOARD", "-I", GRAPHS, *flags],
                                link=link)
        return self.run_program(*qemu(processor), program).stdout.decode()

    def test_cortex_m7_has_the_bits_of_both_precisions(self):
        self.assert_same_bits(self.hashed_on("cortex-m7", "cortex-m7"), "cortex-m7 -Os")

    def test_cortex_m4f_has_the_bits_of_f32_and_a_library_of_one_precision_leaves_the_other_alone(self):
        self.expected = self.expected.splitlines(keepends=True)[0]
        self.assert_same_bits(self.hashed_on("cortex-m4", "cortex-m4f", "-DFDCG_WITH_F64=OFF"), "cortex-m4f -Os")

    def test_cortex_m7_has_the_bits_of_f32_without_short_ways_and_with_link_time_optimisation(self):
        self.expected = self.expected.splitlines(keepends=True)[0]
        less = [f"-DFDCG_WITH_{part}=OFF" for part in ("F64", "MESSAGES", "STATUS_TEXTS", "FAST_FACES", "CLEAR_BALLS")]
        found = self.hashed_on("cortex-m7", "cortex-m7", *less, "-DCMAKE_INTERPROCEDURAL_OPTIMIZATION=ON", flags=["-flto"],
                               link=["-Os", "-flto", "-Wl,--gc-sections"])
        self.assert_same_bits(found, "cortex-m7 -Os -flto, without short ways")


if __name__ == "__main__":
    unittest.main()
