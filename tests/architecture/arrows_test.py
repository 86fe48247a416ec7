# SPDX-License-Identifier: Apache-2.0
"""Which file may include which: cmake/arrows.txt declares it by folder, and the includes of lib, runtime and tools are held to it.
Neither folders nor files include each other in a circle, one basename means one thing, and few files lie outside a room. Tests may
include anything."""
import collections
import pathlib
import posixpath
import re
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SOURCES = (".c", ".cpp", ".h", ".hpp", ".in")
PRODUCTS = ("lib", "runtime/src", "runtime/include", "runtime/shared", "runtime/device", "tools")

# Where the files under a folder look for what they include, in order, after their own folder. What is found by none of these is
# looked for in all the others: it is another library's then.
RUNTIME = ["runtime/include", "runtime"]
DEVICE = ["runtime/device/src", "runtime/device/firmware", "runtime/device/include", *RUNTIME]
SEARCHED = {"runtime/device": DEVICE, "runtime": ["runtime/src", *RUNTIME], "lib": ["lib/src", "lib/include", *RUNTIME],
            "tools": ["tools/common", "tools", "lib/include", "runtime/device/include", *RUNTIME]}
EVERYWHERE = ["lib/src", "runtime/src", "tools/fdcg", "tools/fdcg-servo", *DEVICE, "lib/include", "tools/common"]

MAY_REPEAT = {"main.cpp"}
LOOSE = {"lib/src": 3, "runtime/src": 3, "runtime/device/src": 3}
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*(?:"([^"\n]+)"|<([^>\n]+)>)', re.M)


# What is left of the time before the rooms: (file or folder that includes, what it includes).
KNOWN = [("tools/fdcg-servo", "runtime/device/src")]  # until the host has a header for programs


def read_arrows(text):
    """{folder: the folders that it may include}, from lines of FROM -> TO TO; # starts a comment."""
    arrows = {}
    for line in (line.split("#")[0].strip() for line in text.splitlines()):
        if not line:
            continue
        source, arrow, targets = line.partition("->")
        if not arrow or not source.strip() or not targets.split():
            raise ValueError(f"cmake/arrows.txt: {line!r} is not FROM -> TO")
        arrows.setdefault(source.strip(), set()).update(targets.split())
    return arrows


def circle_in(graph):
    """Names in a circle, the first one last again; None where there is none."""
    done = set()
    for start in sorted(graph):
        way, branches = [start], [iter(sorted(graph[start]))]
        while way and start not in done:
            for name in branches[-1]:
                if name in way:
                    return way[way.index(name):] + [name]
                if name not in done:
                    way.append(name)
                    branches.append(iter(sorted(graph.get(name, ()))))
                    break
            else:
                branches.pop()
                done.add(way.pop())
    return None


class House:
    """The products' files below a root, and what each includes of the others."""

    def __init__(self, root, known=()):
        self.root = pathlib.Path(root)
        self.arrows = read_arrows((self.root / "cmake" / "arrows.txt").read_text())
        self.rooms = set(self.arrows).union(*self.arrows.values())
        paths = (path for product in PRODUCTS for path in (self.root / product).rglob("*"))
        self.text = {path.relative_to(self.root).as_posix(): path.read_text() for path in paths if path.suffix in SOURCES}
        self.includes = {path: {self.found(path, a or b) for a, b in INCLUDE.findall(text)} - {None}
                         for path, text in self.text.items()}
        for path, targets in self.includes.items():
            targets -= {target for target in targets if any(path.startswith(a) and target.startswith(b) for a, b in known)}

    def found(self, path, name):
        own = next(searched for product, searched in SEARCHED.items() if path.startswith(product + "/"))
        for folder in [str(pathlib.PurePosixPath(path).parent), *own, *EVERYWHERE]:
            if (file := posixpath.normpath(f"{folder}/{name}")) in self.text:
                return file
        return None  # of the system, of another project or made by the build

    def room(self, path):
        """The innermost declared folder around a file, or its own folder."""
        folders = [parent.as_posix() for parent in pathlib.PurePosixPath(path).parents]
        return next((folder for folder in folders if folder in self.rooms), folders[0])

    def pairs(self):
        return ((path, target) for path in sorted(self.includes) for target in sorted(self.includes[path]))

    def faults(self):
        """A line for each thing that is not as it should be."""
        yield from self.wrong_arrows()
        yield from self.circles()
        yield from self.repeated_names()
        for folder, most in LOOSE.items():
            loose = sorted(path for path in self.text if str(pathlib.PurePosixPath(path).parent) == folder)
            if len(loose) > most:
                yield f"{folder}: more than {most} files outside of a room: {' '.join(loose)}"
        for path, text in sorted(self.text.items()):
            if "FDCG_DEFORMABLE" in text:
                yield f"{path}: FDCG_DEFORMABLE; geometry is a template's parameter"

    def wrong_arrows(self):
        for path, target in self.pairs():
            room, other = self.room(path), self.room(target)
            if pathlib.PurePosixPath(target).suffix in (".c", ".cpp"):
                yield f"{path} -> {target}: includes a source"
            elif room != other and other not in self.arrows.get(room, ()):
                yield f"{path} -> {target}: no arrow {room} -> {other}"

    def circles(self):
        folders = collections.defaultdict(set)
        for path, target in self.pairs():
            if (room := self.room(path)) != (other := self.room(target)):
                folders[room].add(other)
        for what, graph in (("declared arrows", self.arrows), ("folders", folders), ("files", self.includes)):
            if circle := circle_in(graph):
                yield f"{what} in a circle: {' -> '.join(circle)}"

    def repeated_names(self):
        places = collections.defaultdict(list)
        for path in sorted(self.text):
            places[pathlib.PurePosixPath(path).name].append(path)
        for name, paths in places.items():
            if len(paths) > 1 and name not in MAY_REPEAT:
                yield f"{name}: one name, several files: {' '.join(paths)}"


class Arrows(unittest.TestCase):
    def test_the_project_keeps_to_its_arrows(self):
        house = House(ROOT, KNOWN)
        self.assertGreater(sum(map(len, house.includes.values())), 500)  # it does find includes
        self.assertEqual([], list(house.faults()))

    def test_each_declared_folder_is_there(self):
        house = House(ROOT)
        self.assertEqual(set(), house.rooms - {house.room(path) for path in house.text})


class Checker(unittest.TestCase):
    """It finds what is planted in a small tree that is otherwise in order."""

    TREE = {
        "cmake/arrows.txt": "# rooms\nlib/src/b -> lib/src/a lib/include runtime/include\nlib/src/a -> lib/include # by hand\n"
                            "tools/fdcg -> lib/include\ntools/fdcg-servo -> runtime/device/include\n",
        "lib/include/fdcg/bake.hpp": "#include <vector>\n",
        "lib/src/a/a.hpp": '#include "fdcg/bake.hpp"\n',
        "lib/src/a/own.hpp": "",
        "lib/src/a/a.cpp": '#include "a/a.hpp"\n#include "own.hpp"\n',
        "lib/src/b/b.cpp": '#include "a/a.hpp"\n#include "fdcg/fdcg.h"\n#include "made_by_the_build.h"\n',
        "lib/src/b/b.hpp": "",
        "runtime/include/fdcg/fdcg.h": '#include "fdcg/format.h"\n',
        "runtime/include/fdcg/format.h": "",
        "runtime/src/step/step.hpp": "",
        "runtime/device/include/fdcg/device.h": "",
        "runtime/device/src/host/host.hpp": "",
        "tools/fdcg/main.cpp": '#include "fdcg/bake.hpp"\n',
        "tools/fdcg-servo/main.cpp": '#include <fdcg/device.h>\n',
        "tests/any_test.cpp": '#include "step/step.hpp"\n#include "b/b.hpp"\n',
    }

    def faults(self, **planted):
        with tempfile.TemporaryDirectory() as folder:
            files = {**self.TREE, **{name.replace("__", "/").replace("_dot_", "."): text for name, text in planted.items()}}
            for name, text in files.items():
                path = pathlib.Path(folder, name)
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text)
            return list(House(folder).faults())

    def found(self, expected, **planted):
        found = self.faults(**planted)
        self.assertTrue(any(re.search(expected, fault) for fault in found), f"{expected!r} is not among {found}")

    def test_a_tree_in_order_has_no_fault(self):
        self.assertEqual([], self.faults())

    def test_an_arrow_that_is_not_declared(self):
        self.found(r"a/a\.hpp -> lib/src/b/b\.hpp: no arrow lib/src/a -> lib/src/b", lib__src__a__a_dot_hpp='# include "b/b.hpp"\n')
        self.found(r"no arrow lib/src/c -> lib/src/a", lib__src__c__c_dot_cpp='#include "a/a.hpp"\n')
        self.found(r"no arrow tools/fdcg -> runtime/include", tools__fdcg__main_dot_cpp="#include <fdcg/fdcg.h>\n")

    def test_another_librarys_sources(self):
        self.found(r"no arrow lib/src/b -> runtime/src/step", lib__src__b__b_dot_cpp='#include "step/step.hpp"\n')
        self.found(r"no arrow lib/src/b -> runtime/src/step", lib__src__b__b_dot_cpp='#include "../../../runtime/src/step/step.hpp"\n')
        self.found(r"no arrow tools/fdcg -> runtime/device/src/host", tools__fdcg__main_dot_cpp='#include "host/host.hpp"\n')
        self.found(r"no arrow tools/fdcg -> lib/src/b", tools__fdcg__main_dot_cpp='#include "b/b.hpp"\n')

    def test_a_circle_of_folders(self):
        self.found(r"folders in a circle: lib/src/a -> lib/src/b -> lib/src/a", lib__src__a__a_dot_cpp='#include "b/b.hpp"\n')
        self.found(r"declared arrows in a circle: x -> y -> z -> x", cmake__arrows_dot_txt="x -> y\ny -> z\nz -> x\n")

    def test_a_circle_of_files(self):
        self.found(r"files in a circle: \S+fdcg\.h -> \S+format\.h -> \S+fdcg\.h",
                   runtime__include__fdcg__format_dot_h='#include "fdcg/fdcg.h"\n')
        self.found(r"files in a circle: \S+own\.hpp -> \S+own\.hpp", lib__src__a__own_dot_hpp='#include "own.hpp"\n')

    def test_a_source_that_is_included(self):
        self.found(r"a/own\.hpp -> lib/src/a/a\.cpp: includes a source", lib__src__a__own_dot_hpp='#include "a/a.cpp"\n')

    def test_a_name_that_stands_twice(self):
        self.found(r"b\.hpp: one name, several files", runtime__src__step__b_dot_hpp="")

    def test_files_outside_of_a_room(self):
        loose = {f"runtime__src__loose{i}_dot_cpp": "" for i in range(4)}
        self.found(r"runtime/src: more than 3 files", **loose)
        loose.popitem()
        self.assertEqual([], self.faults(**loose))

    def test_the_macro(self):
        self.found(r"step\.hpp: FDCG_DEFORMABLE", runtime__src__step__step_dot_hpp="#if FDCG_DEFORMABLE\n#endif\n")

    def test_a_line_that_is_no_arrow(self):
        for line in ("lib/src/a lib/src/b", "lib/src/a ->", "-> lib/src/a"):
            with self.assertRaises(ValueError):
                self.faults(cmake__arrows_dot_txt=line + "\n")


if __name__ == "__main__":
    unittest.main()
