# SPDX-License-Identifier: Apache-2.0
"""Builds the runtime and small programs with whatever compiler, and runs them where they belong. What is missing on this
machine skips the test that needs it, by name."""
import concurrent.futures
import os
import pathlib
import re
import shutil
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "contract"))
from support import ROOT, Case  # noqa: E402

RUNTIME = ROOT / "runtime"
FIRMWARE = RUNTIME / "examples" / "firmware"
TOOLCHAINS = ROOT / "cmake" / "toolchains"
EXACT = ["-ffp-contract=off", "-fno-math-errno"]  # what the bits of the step rest on
CXX = ["-std=c++20", "-nostdinc++", "-fno-exceptions", "-fno-rtti", "-Wall", "-Wextra", "-Wpedantic", "-Werror", *EXACT]
C = ["-std=c11", "-Wall", "-Wextra", "-Wpedantic", "-Werror", *EXACT]

# board in QEMU, its processor in GCC's words
BOARDS = {"cortex-m7": "mps2-an500", "cortex-m4": "mps2-an386"}


def qemu(processor, *options):
    return ["qemu-system-arm", "-M", BOARDS[processor], "-display", "none", "-monitor", "none", "-serial", "none",
            "-chardev", "stdio,id=out", "-semihosting-config", "enable=on,chardev=out", *options, "-kernel"]


# The library's objects are named after its sources.
ALL = {source.stem for source in (RUNTIME / "src").rglob("*.cpp")}
# Of the library's objects, all that a program with one sphere may link, and all that one may link that steps one graph.
ONE_SPHERE = {"admit", "surface", "surface_sphere", "surface_step", "params", "params_init", "friction_terms", "message", "version"}
ONE_EFFECT = {"effect_step", "message", "vibration", "version"}  # and one with one effect
ONE_GRAPH = {"admit", "arithmetic", "box_distances", "box_tree", "exact_orient", "friction_terms", "hooks", "load", "map_file_none", "map_file_posix",
             "material_section", "message", "node_normals", "params", "params_init", "records", "servo_step", "shaded_face", "small_checksum", "version"}
OPENING = {"arithmetic", "box_tree", "checksum", "fan_run_section", "hooks", "load", "map_file_none", "map_file_posix", "mass_record", "message",
           "open", "open_file", "small_checksum", "verify", "verify_full", "verify_safe", "version"}  # and one that opens and closes a file
OTHER_PARTS = r"scene|soft_finger|deform|body|pile|_of_plane|step_plane|[Cc]ylinder|[Cc]apsule|[Cc]one[^a-z]|[Tt]orus|[Ee]llipsoid"


def linked_objects(link_map):
    """The library's objects in a program, by the linker's map."""
    text = pathlib.Path(link_map).read_text().split("Archive member included")[1].split("Discarded input sections")[0]
    return set(re.findall(r"^\S*libfdcg_\w+\.a\((\w+)\.cpp\.o\w*\)", text, re.M))


class AnywhereCase(Case):
    def assert_links_alone(self, nm, program, link_map):
        """A program of tests/consumer/parts links its own part of the runtime, and of surfaces its own kind."""
        name = pathlib.Path(link_map).stem
        own, objects_of_own, call = {"one_sphere": ("surface_sphere", ONE_SPHERE, "fdcg_surface_step"), "one_effect": ("vibration", ONE_EFFECT, "fdcg_effect_step")}.get(
            name, ("servo_step", ONE_GRAPH, "fdcg_step"))
        objects = linked_objects(link_map)
        self.assertIn(own, objects)
        self.assertEqual(set(), objects - objects_of_own)
        symbols = self.run_program(nm, "--defined-only", program).stdout.decode().split()
        self.assertIn(call, symbols)
        self.assertEqual([], [symbol for symbol in symbols if re.search(f"^(_ZN?4fdcg|fdcg_).*({OTHER_PARTS})", symbol)])

    def need(self, *programs):
        """Skips where a program is missing: tools/packages, group test, has the package."""
        for program in programs:
            if shutil.which(program) is None:
                self.skipTest(f"{program} is missing; tools/check installs it (group test of tools/packages)")

    def compile_all(self, jobs):
        """jobs: (command without -o, object); as many at once as there are cores. Returns the objects."""
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            list(pool.map(lambda job: self.run_program(*job[0], "-o", job[1]), jobs))
        return [job[1] for job in jobs]

    def runtime_objects(self, name, compiler, flags):
        """The runtime as one who has no build system would compile it."""
        return self.compile_all([(self.runtime_command(compiler, flags, source), self.path(f"{name}-{source.name}.o"))
                                 for source in sorted((RUNTIME / "src").rglob("*.cpp"))])

    @staticmethod
    def runtime_command(compiler, flags, source):
        extra = ["-fno-tree-slp-vectorize"] if "clang" not in compiler else []
        return [compiler, *CXX, *extra, *flags, "-I", str(RUNTIME / "include"), "-I", str(RUNTIME), "-I", str(RUNTIME / "src"), "-c",
                str(source)]

    def build_runtime(self, folder, *options, of=None, ar="gcc-ar"):
        """The runtime alone, by its own build; returns the library. of: names of the sources that the library is to have, and
        nothing else is built, in a fraction of the time; a program that needs another does not link."""
        self.run_program("cmake", "-S", str(ROOT), "-B", folder, "-G", "Ninja", "-DFDCG_RUNTIME_ONLY=ON", "-DFDCG_BUILD_TESTS=OFF", *options)
        library = os.path.join(folder, "runtime", "libfdcg_runtime.a")
        if of is None:
            self.run_program("cmake", "--build", folder)
            return library
        targets = self.run_program("ninja", "-C", folder, "-t", "targets", "all").stdout.decode()
        objects = {name: path for path, name in re.findall(r"^(runtime/CMakeFiles/fdcg_runtime\.dir/src/\S*?(\w+)\.cpp\.\w+):", targets, re.M)}
        self.assertEqual(set(), set(of) - set(objects))
        self.run_program("ninja", "-C", folder, *(objects[name] for name in of))
        self.run_program(ar, "rcs", library, *(objects[name] for name in sorted(of)), cwd=folder)
        return library

    def cross_runtime(self, toolchain, *options, name="", of=None):
        """The same by a toolchain file; with `of` for boards of Arm alone."""
        return self.build_runtime(self.path(f"runtime-{toolchain}-{name}"), f"--toolchain={TOOLCHAINS / (toolchain + '.cmake')}", *options,
                                  of=of, ar="arm-none-eabi-gcc-ar")

    def firmware(self, processor, library, *sources, flags=(), link=("-Wl,--gc-sections",)):
        """A program for the board: the example's start-up code, memcpy, memset and linker script, and newlib's C for the rest."""
        target = ["-mcpu=" + processor, "-mthumb", "-mfloat-abi=hard"]
        includes = ["-I", str(RUNTIME / "include"), "-I", str(FIRMWARE), "-I", str(pathlib.Path(__file__).parent)]
        objects = self.compile_all([(["arm-none-eabi-gcc", *target, "-Os", "-ffunction-sections", *C, *includes, *flags, "-c", source],
                                     self.path(f"{processor}-{pathlib.Path(source).name}.o"))
                                    for source in (*sources, str(FIRMWARE / "startup.c"), str(FIRMWARE / "memory.c"))])
        program = self.path(processor + ".elf")
        self.run_program("arm-none-eabi-gcc", *target, "-nostartfiles", *link, "-T", str(FIRMWARE / "mps2.ld"),
                         *objects, library, "-lm", "-o", program)
        return program
