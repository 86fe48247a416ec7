# SPDX-License-Identifier: Apache-2.0
"""Projects that use fdcg from outside, by each way there is: an installed package, pkg-config, as a part of themselves, with
graphs baked by their own build, natively and for a board."""
import base64
import os
import pathlib
import re
import shutil
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "anywhere"))
from anywhere import C, FIRMWARE, ROOT, RUNTIME, TOOLCHAINS, AnywhereCase, qemu  # noqa: E402

BUILD = os.environ["FDCG_BUILD"]
CONSUMER = ROOT / "tests" / "consumer"
EXAMPLES = RUNTIME / "examples"


def promised(page, example):
    """What a page of docs says that an example prints."""
    text = (ROOT / "docs" / page).read_text()
    return re.search(rf"printed-by=runtime/examples/{example} -->\n```text\n(.*?)```", text, re.S).group(1)


PROMISED = promised("embed.md", "press_and_slide.c")
PROMISED_OF_SCENES = promised("scene.md", "turntable.c")
PLAIN_PATH = {**os.environ, "PATH": "/usr/bin:/bin"}  # where no fdcg is


class ConsumerCase(AnywhereCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.prefix = os.path.join(folder.name, "moved")
        # installed here, used there: the tree may be moved
        first = os.path.join(folder.name, "prefix")
        cls().run_program("cmake", "--install", BUILD, "--prefix", first)
        os.rename(first, cls.prefix)

    def runTest(self):
        """Lets setUpClass make a case to run programs with."""

    def configure(self, source, build, *options, code=0, prefix=None, generator="Ninja", environment=None):
        return self.run_program("cmake", "-G", generator, "-S", str(source), "-B", build, "-DCMAKE_BUILD_TYPE=Release",
                                f"-DCMAKE_PREFIX_PATH={prefix or self.prefix}", *options, code=code, env=environment or PLAIN_PATH)

    def build(self, folder):
        return self.run_program("cmake", "--build", folder, env=PLAIN_PATH).stdout.decode()

    def copied(self, name):
        """The project in a folder of the test's own, with a mesh, so that its files may be changed."""
        folder = self.folder / name
        shutil.copytree(CONSUMER / name, folder)
        (folder / "meshes").mkdir()
        shutil.copy(EXAMPLES / "cube.obj", folder / "meshes" / "block.obj")
        return folder


class Package(ConsumerCase):
    def test_manual_pages_and_completions_stand_where_shells_look(self):
        share = os.path.join(self.prefix, "share")
        for file in ("man/man1/fdcg.1", "man/man1/fdcg-compile.1", "man/man1/fdcg-servo-run.1", "bash-completion/completions/fdcg",
                     "bash-completion/completions/fdcg-servo", "zsh/site-functions/_fdcg", "zsh/site-functions/_fdcg-servo"):
            self.assertGreater(os.path.getsize(os.path.join(share, file)), 500, file)
        headers = os.listdir(os.path.join(self.prefix, "include", "fdcg"))
        self.assertIn("device.h", headers)
        self.assertNotIn("device_tools.hpp", headers)  # fdcg-servo's own

    def test_the_examples_build_against_it_and_print_what_the_documents_promise(self):
        folder = self.path("build")
        self.configure(EXAMPLES, folder)
        self.build(folder)
        expected = {"press_and_slide_c": PROMISED, "press_and_slide_cpp": PROMISED, "turntable_c": PROMISED_OF_SCENES,
                    "turntable_cpp": PROMISED_OF_SCENES}
        for page, example in (("friction.md", "friction"), ("friction.md", "materials"), ("bodies.md", "bodies"),
                              ("surfaces.md", "surface"), ("deform.md", "deform"), ("effects.md", "effects"), ("relief.md", "relief")):
            expected[example + "_c"] = promised(page, example + ".c")
        for program, text in expected.items():
            done = self.run_program(os.path.join(folder, program), cwd=folder)
            self.assertEqual(text, done.stdout.decode(), program)

    def test_the_examples_stay_short(self):
        for pattern in ("*.c", "*.cpp", "firmware/*"):
            for path in EXAMPLES.glob(pattern):
                self.assertLess(len(path.read_text().splitlines()), 80, path)

    def test_a_project_in_c_alone_embeds_its_graph(self):
        folder = self.path("build")
        self.configure(self.copied("c_only"), folder)
        self.build(folder)
        said = self.run_program(os.path.join(folder, "consumer")).stdout.decode()
        self.assertEqual("library 100, nodes 6, real 4, metres per unit 0.001\n", said)
        self.assertTrue(os.path.exists(os.path.join(folder, "graphs", "block.fdcg")))

    def test_a_project_compiles_meshes_itself(self):
        folder = self.path("build")
        self.configure(CONSUMER / "bake", folder)
        self.build(folder)
        done = self.run_program(os.path.join(folder, "consumer"), str(EXAMPLES / "cube.obj"))
        self.assertEqual(b"nodes 6\n", done.stdout)

    def test_a_program_in_c_drives_a_device(self):
        folder = self.path("build")
        self.configure(CONSUMER / "device", folder)
        self.build(folder)
        self.assertEqual(self.run_program(os.path.join(folder, "consumer")).stdout, b"toy: ticks\n")

    def test_pkg_config_names_what_a_compiler_needs(self):
        self.need("pkg-config")
        found = pathlib.Path(self.prefix).glob("**/fdcg.pc")
        environment = {**os.environ, "PKG_CONFIG_PATH": str(next(found).parent)}
        flags = self.run_program("pkg-config", "--cflags", "--libs", "fdcg >= 0.1", env=environment).stdout.decode().split()
        self.run_program("cc", *C, str(EXAMPLES / "press_and_slide.c"), *flags, "-o", self.path("program"))
        self.fdcg("compile", str(EXAMPLES / "cube.obj"), "--units", "cm", "-q", "-o", self.path("cube.fdcg"))
        done = self.run_program(self.path("program"), cwd=self.folder)
        self.assertEqual(PROMISED, done.stdout.decode())

    def test_programs_by_package_and_by_pkg_config_step_to_one_hash(self):
        self.need("pkg-config")
        graphs = os.environ["FDCG_HASH_GRAPHS"]
        expected = self.run_program(os.environ["FDCG_STEP_HASH"]).stdout
        environment = {**os.environ, "PKG_CONFIG_PATH": str(next(pathlib.Path(self.prefix).glob("**/pkgconfig")))}
        for package in ("fdcg", "fdcg-shared"):
            flags = self.run_program("pkg-config", "--cflags", "--libs", package, env=environment).stdout.decode().split()
            folder = next(flag[2:] for flag in flags if flag.startswith("-L"))
            self.run_program("cc", *C, "-O1", "-I", graphs, str(ROOT / "tests" / "anywhere" / "step_hash.c"), os.environ["FDCG_HASH_ARRAYS"],
                             *flags, f"-Wl,-rpath,{folder}", "-o", self.path(package))
            self.assertEqual(expected, self.run_program(self.path(package)).stdout, package)

    def test_another_minor_version_is_refused(self):
        project = self.copied("c_only")
        text = (project / "CMakeLists.txt").read_text()
        (project / "CMakeLists.txt").write_text(text.replace("fdcg 0.1", "fdcg 0.2"))
        done = self.configure(project, self.path("build"), code=1)
        self.assertIn(b"0.2", done.stderr)


class Parts(ConsumerCase):
    """The runtime's parts as components, each installed by itself."""

    NEEDED = {"step": {"step"}, "query": {"step", "query"}, "scene": {"step", "query", "scene"},
              "surface": {"step", "query", "scene", "surface"}, "deform": {"step", "query", "scene", "deform"},
              "body": {"step", "query", "scene", "body"}, "effect": {"step", "query", "effect"}, "runtime": {"runtime"}}

    def installed(self, *components):
        prefix = self.path("-".join(components))
        for component in components:
            self.run_program("cmake", "--install", BUILD, "--prefix", prefix, "--component", component)
        return prefix

    def test_a_component_brings_its_library_and_those_that_it_needs(self):
        for component, needed in self.NEEDED.items():
            prefix = pathlib.Path(self.installed(component))
            self.assertEqual({f"libfdcg_{name}.a" for name in needed}, {path.name for path in prefix.glob("**/*.a")})
            self.assertTrue((prefix / "include" / "fdcg" / "fdcg.h").exists(), component)
            self.assertFalse((prefix / "bin").exists(), component)

    def test_the_parts_are_all_of_the_runtime_and_share_nothing(self):
        def objects(library):
            return self.run_program("ar", "t", os.path.join(BUILD, "runtime", f"libfdcg_{library}.a")).stdout.decode().split()
        parts = [name for part in self.NEEDED if part != "runtime" for name in objects(part)]
        self.assertEqual(sorted(objects("runtime")), sorted(parts))

    def test_programs_link_the_part_that_they_use(self):
        prefix, folder = self.installed("surface", "effect"), self.path("build")
        self.configure(self.copied("parts"), folder, f"-DFDCG_EXECUTABLE={self.prefix}/bin/fdcg", prefix=prefix)
        self.build(folder)
        for name in ("one_sphere", "one_effect", "one_graph"):
            program = os.path.join(folder, name)
            self.run_program(program)
            self.assert_links_alone("nm", program, program + ".map")

    def test_a_part_that_is_not_installed_is_named(self):
        done = self.configure(self.copied("parts"), self.path("build"), f"-DFDCG_EXECUTABLE={self.prefix}/bin/fdcg", code=1,
                              prefix=self.installed("step"))
        self.assertIn(b"no component 'surface'", b" ".join(done.stderr.split()))

    def test_pkg_config_names_a_part(self):
        self.need("pkg-config")
        environment = {**os.environ, "PKG_CONFIG_PATH": str(next(pathlib.Path(self.installed("surface")).glob("**/pkgconfig")))}
        flags = self.run_program("pkg-config", "--cflags", "--libs", "fdcg-surface", env=environment).stdout.decode().split()
        link_map = self.path("one_sphere.map")
        self.run_program("cc", *C, str(CONSUMER / "parts" / "one_sphere.c"), *flags, f"-Wl,-Map={link_map}", "-o", self.path("program"))
        self.run_program(self.path("program"))
        self.assert_links_alone("nm", self.path("program"), link_map)


class Rebuild(ConsumerCase):
    """A graph is as new as its mesh, what the mesh refers to and the compiler; nothing is baked without need."""

    def rebuilds(self, generator):
        project, folder = self.copied("c_only"), self.path("build-" + generator[:4])
        compiler = self.path("fdcg-" + generator[:4])
        shutil.copy(os.path.join(self.prefix, "bin", "fdcg"), compiler)
        self.configure(project, folder, f"-DFDCG_EXECUTABLE={compiler}", generator=generator)
        graph = pathlib.Path(folder, "graphs", "block.fdcg")
        baking, program = "Baking graph first_block", os.path.join(folder, "consumer")
        self.assertIn(baking, self.build(folder))
        first, bytes_before = self.run_program(program).stdout, graph.read_bytes()
        self.assertNotIn(baking, self.build(folder))

        mesh = project / "meshes" / "block.obj"
        mesh.write_text(mesh.read_text() + "v 9 9 9\nv 10 9 9\nv 9 10 9\nv 9 9 10\nf 9 11 10\nf 9 10 12\nf 10 11 12\nf 9 12 11\n")
        self.assertIn(baking, self.build(folder))
        self.assertIn(b"nodes 10", self.run_program(program).stdout)
        self.assertIn(b"nodes 6", first)
        self.assertNotEqual(bytes_before, graph.read_bytes())
        self.assertNotIn(baking, self.build(folder))

        os.utime(compiler)
        self.assertIn(baking, self.build(folder))

    def test_with_ninja(self):
        self.rebuilds("Ninja")

    def test_with_make(self):
        self.need("make")
        self.rebuilds("Unix Makefiles")

    def test_a_file_that_the_mesh_refers_to_counts(self):
        project, folder = self.copied("c_only"), self.path("build")
        for name in ("cube_embedded.gltf", "mirrored_bytes.gltf"):
            shutil.copy(ROOT / "testdata" / "meshes" / "good" / name, project / "meshes" / name)
        text = (project / "meshes" / "cube_embedded.gltf").read_text()
        data = re.search(r'"data:[^,]*;base64,([^"]*)"', text)
        (project / "meshes" / "cube.bin").write_bytes(base64.b64decode(data.group(1)))
        (project / "meshes" / "cube.gltf").write_text(text.replace(data.group(0), '"cube.bin"'))
        lists = project / "CMakeLists.txt"
        lists.write_text(lists.read_text().replace("block.obj", "cube.gltf"))
        self.configure(project, folder)
        self.build(folder)
        self.assertNotIn("Baking", self.build(folder))
        os.utime(project / "meshes" / "cube.bin")
        self.assertIn("Baking", self.build(folder))


class Subproject(ConsumerCase):
    def test_each_way_builds_the_runtime_alone_and_the_graph_by_the_hosts_compiler(self):
        hashed = [f"-D{name}={os.environ[name]}" for name in ("FDCG_HASH_ARRAYS", "FDCG_HASH_GRAPHS")]
        for how in ("add_subdirectory", "FetchContent", "runtime_folder"):
            folder = self.path(how)
            self.configure(CONSUMER / "subproject", folder, f"-DHOW={how}", f"-DFDCG_SOURCE={ROOT}", *hashed, prefix="/nowhere",
                           environment={**os.environ, "PATH": os.path.join(self.prefix, "bin") + ":/usr/bin:/bin"})
            self.build(folder)
            if how == "runtime_folder":  # the library alone: the graph comes from elsewhere
                self.fdcg("compile", str(EXAMPLES / "cube.obj"), "--units", "cm", "-q", "-o", os.path.join(folder, "cube.fdcg"))
            done = self.run_program(os.path.join(folder, "consumer"), cwd=folder)
            self.assertEqual(PROMISED, done.stdout.decode(), how)
            self.assertEqual(self.run_program(os.environ["FDCG_STEP_HASH"]).stdout,
                             self.run_program(os.path.join(folder, "step_hash")).stdout, how)
            built = [path.name for path in pathlib.Path(folder).glob("**/*.a")]
            self.assertEqual(["libfdcg_runtime.a"], built, how)


class Refusals(ConsumerCase):
    def test_without_a_compiler_the_package_is_found_and_only_fdcg_add_graph_complains(self):
        prefix = self.path("runtime-prefix")
        built = self.path("runtime-build")
        self.configure(ROOT, built, "-DFDCG_RUNTIME_ONLY=ON", "-DFDCG_BUILD_TESTS=OFF")
        self.build(built)
        self.run_program("cmake", "--install", built, "--prefix", prefix)
        self.assertFalse(os.path.exists(os.path.join(prefix, "bin")))
        project = self.copied("c_only")
        done = self.configure(project, self.path("without"), code=1, prefix=prefix)
        message = " ".join(done.stderr.decode().split())
        self.assertIn("there is no compiler. Install fdcg for this host and put it on the path, or set FDCG_EXECUTABLE", message)
        # with the host's program named, the same package is enough
        self.configure(project, self.path("with"), f"-DFDCG_EXECUTABLE={self.prefix}/bin/fdcg", prefix=prefix)
        self.build(self.path("with"))
        # without fdcg_add_graph nothing is missing
        lists = project / "CMakeLists.txt"
        lists.write_text(lists.read_text().split("fdcg_add_graph")[0])
        self.configure(project, self.path("plain"), prefix=prefix)
        # a component that was not built is named
        done = self.configure(CONSUMER / "bake", self.path("bake"), code=1, prefix=prefix)
        self.assertIn(b"no component", done.stderr)
        self.assertIn(b"'tools'", done.stderr)

    def test_wrong_uses_of_fdcg_add_graph_are_named(self):
        for wrong, message in (("consumer MESH meshes/none.obj", "there is no mesh"),
                               ("nobody MESH meshes/block.obj", "there is no target 'nobody'"),
                               ("consumer meshes/block.obj", "cannot use 'meshes/block.obj'"),
                               ("consumer MESH meshes/block.obj NAME 1st EMBED", "'1st' is not a name in C")):
            project = self.copied("c_only")
            lists = project / "CMakeLists.txt"
            lists.write_text(lists.read_text().split("fdcg_add_graph")[0] + f"fdcg_add_graph({wrong})\n")
            done = self.configure(project, self.path("build"), code=1)
            self.assertIn(message, " ".join(done.stderr.decode().split()))
            shutil.rmtree(project)


class Firmware(ConsumerCase):
    def test_the_firmware_example_bakes_embeds_and_runs_on_both_boards(self):
        self.need("arm-none-eabi-gcc", "qemu-system-arm", "ninja")
        for processor, toolchain in (("cortex-m7", "cortex-m7"), ("cortex-m4", "cortex-m4f")):
            prefix, folder = self.path("prefix-" + processor), self.path("build-" + processor)
            library = self.cross_runtime(toolchain, "-DFDCG_WITH_F64=OFF", "-DFDCG_WITH_FRICTION_TERMS=OFF")
            self.run_program("cmake", "--install", os.path.dirname(os.path.dirname(library)), "--prefix", prefix)
            self.configure(FIRMWARE, folder, f"--toolchain={TOOLCHAINS / (toolchain + '.cmake')}", prefix=prefix,
                           environment={**os.environ, "PATH": os.path.join(self.prefix, "bin") + ":/usr/bin:/bin"})
            self.build(folder)
            program = os.path.join(folder, "firmware.elf")
            # one instruction every 64 ns, SysTick at 25 MHz: ticks * 40 / 64 instructions, the reading of the counter included
            said = self.run_program(*qemu(processor, "-icount", "shift=6"), program).stdout.decode()
            expected = re.sub(r"(-?\d+\.\d+)", lambda number: str(round(float(number.group(1)) * 1000)), PROMISED)
            self.assertEqual(expected.replace(" N\n", " mN\n"), re.sub(r", SysTick \d+", "", said))
            spent = [int(ticks) * 40 // 64 for ticks in re.findall(r"SysTick (\d+)", said)]
            print(f"{processor}: instructions a step: {spent}")
            self.assertLess(max(spent), 20000)
            self.assert_graph_lies_in_flash(program)

    def assert_graph_lies_in_flash(self, program):
        """The linker put the array among the code, and RAM holds next to nothing."""
        symbols = self.run_program("arm-none-eabi-nm", "-S", program).stdout.decode()
        address, size = re.search(r"^([0-9a-f]+) ([0-9a-f]+) [RT] cube$", symbols, re.M).groups()
        self.assertEqual(0, int(address, 16) % 64)
        self.assertLess(int(address, 16) + int(size, 16), 4 << 20)
        sizes = self.run_program("arm-none-eabi-size", program).stdout.decode().splitlines()[1].split()
        # 1,060 of them are newlib's errno, which its root of a double sets where the processor has none (Cortex-M4F)
        self.assertLess(int(sizes[1]) + int(sizes[2]), 1200, "data and bss")


if __name__ == "__main__":
    unittest.main()
