# SPDX-License-Identifier: Apache-2.0
"""tools/package makes packages of this build; who has them alone compiles, steps to the hash of the build, and calls the Python
module."""
import hashlib
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tarfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "anywhere"))
from anywhere import C, ROOT, AnywhereCase  # noqa: E402

BUILD = os.environ["FDCG_BUILD"]
GRAPHS = os.environ["FDCG_HASH_GRAPHS"]
HASH_SOURCE = ROOT / "tests" / "anywhere" / "step_hash.c"
PROMISED = re.search(r"printed-by=runtime/examples/press_and_slide.c -->\n```text\n(.*?)```", (ROOT / "docs" / "embed.md").read_text(),
                     re.S).group(1)
NAMES = {"fdcg", "libfdcg0", "libfdcg-bake-c0", "libfdcg-dev", "python3-fdcg"}

# Run as root where every file of this system can be seen, and nothing that is written is kept.
IN_A_COPY = """
set -eu
mount -t tmpfs none "$1/copy"
mkdir "$1/copy/written" "$1/copy/work" "$1/copy/root"
mount -t overlay -o lowerdir=/,upperdir="$1/copy/written",workdir="$1/copy/work" none "$1/copy/root"
mount --bind /dev "$1/copy/root/dev"
cp -r "$1/given" "$1/copy/root/given"
exec chroot "$1/copy/root" /bin/bash -eu /given/script
"""

# With the packages alone. What it prints is one word and an answer a line.
WITH_THE_PACKAGES = """
export PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C HOME=/given
[ ! -e /usr/include/fdcg ] || {{ echo "fdcg is installed here" >&2; exit 1; }}
dpkg --path-include='*' --install /given/*.deb >/given/log 2>&1 || {{ cat /given/log >&2; exit 1; }}
cd /given
examples=/usr/share/doc/libfdcg-dev/examples
fdcg compile $examples/cube.obj --units cm --quiet -o cube.fdcg
for package in fdcg fdcg-shared; do
  cc $examples/press_and_slide.c $(pkg-config --cflags --libs $package) -o program
  ./program >printed-$package
  cc {flags} -I . step_hash.c graphs.c $(pkg-config --cflags --libs $package) -o program
  ./program >hash-$package
done
cmake -S cmake -B cmake/build >/given/log 2>&1 && cmake --build cmake/build >>/given/log 2>&1 || {{ cat /given/log >&2; exit 1; }}
cmake/build/consumer >printed-cmake
ls /usr/share/man/man1/fdcg-compile.1.gz >manual
python3 touch >python
tail -n +1 printed-* hash-* manual python
dpkg --purge {names} >/given/log 2>&1 || {{ cat /given/log >&2; exit 1; }}
find /usr /etc /var -xdev -ipath '*fdcg*' -not -path '/var/log/*' >left
[ ! -s left ] || {{ cat left >&2; exit 1; }}
"""

TOUCH = """
import fdcg
graph = fdcg.compile(fdcg.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]))
contact = fdcg.Contact(graph)
contact.step((0.1, 0.1, -0.1))
print(round(contact.step((0.1, 0.1, 0.01)).force_n[2], 6), fdcg.__file__)
"""


class PackagesCase(AnywhereCase):
    def package(self, what, folder):
        done = subprocess.run((ROOT / "tools" / "package", what, "--built", BUILD, "--output", self.path(folder)), stdin=subprocess.DEVNULL,
                              capture_output=True, text=True, timeout=500, check=False)
        self.assertEqual(0, done.returncode, done.stdout + done.stderr)
        return self.folder / folder


class Archive(PackagesCase):
    def consumer(self, archive):
        folder = self.path("build")
        digest = hashlib.sha256(archive.read_bytes()).hexdigest()
        self.run_program("cmake", "-G", "Ninja", "-S", str(ROOT / "tests" / "consumer" / "archive"), "-B", folder, f"-DARCHIVE=file://{archive}",
                         f"-DARCHIVE_SHA256={digest}", f"-DHASH_SOURCE={HASH_SOURCE}", f"-DHASH_GRAPHS={GRAPHS}")
        self.run_program("cmake", "--build", folder)
        return pathlib.Path(folder)

    def test_programs_and_plugins_by_it_step_to_the_hash_of_the_build(self):
        archive, = self.package("archive", "made").glob("fdcg-*-linux-*.tar.gz")
        again, = self.package("archive", "again").glob("*.tar.gz")
        self.assertEqual(archive.read_bytes(), again.read_bytes(), "the same build gives the same bytes")
        with tarfile.open(archive) as files:
            names = [pathlib.PurePosixPath(name).relative_to(archive.name.removesuffix(".tar.gz")) for name in files.getnames()]
        for name in ("bin/fdcg", "bin/fdcg-servo", "lib/libfdcg.so.0", "lib/libfdcg_runtime.a", "lib/libfdcg_bake_c.so.0", "include/fdcg/fdcg.h",
                     "lib/cmake/fdcg/fdcg-config.cmake", "lib/pkgconfig/fdcg.pc", "share/doc/fdcg/docs/embed.md", "share/man/man1/fdcg.1"):
            self.assertIn(pathlib.PurePosixPath(name), names)
        folder = self.consumer(archive)
        expected = self.run_program(os.environ["FDCG_STEP_HASH"]).stdout
        for library in ("runtime", "shared"):
            self.assertEqual(expected, self.run_program(str(folder / f"program_{library}")).stdout, library)
            self.assertEqual(expected, self.run_program(str(folder / "host"), str(folder / f"plugin_{library}.so")).stdout, library)
            symbols = self.run_program("nm", "-D", "--defined-only", str(folder / f"plugin_{library}.so")).stdout.decode().split()
            self.assertEqual(["plugin_main"], symbols[2::3])


class Debian(PackagesCase):
    def test_the_same_build_gives_packages_of_the_same_bytes_that_are_enough_by_themselves(self):
        self.need("dpkg-buildpackage", "dh", "dh_python3", "lintian")
        made, again = self.package("deb", "made"), self.package("deb", "again")
        packages = sorted(made.glob("*.deb"))
        self.assertEqual(NAMES, {path.name.split("_")[0] for path in packages})
        for path in packages:
            self.assertEqual(path.read_bytes(), (again / path.name).read_bytes(), path.name)
        self.try_them(packages)

    def try_them(self, packages):
        if os.geteuid() != 0 or subprocess.run(("unshare", "--mount", "true"), check=False, capture_output=True).returncode != 0:
            self.skipTest("a copy of this system to install into needs root and mounts")
        given = self.folder / "given"
        given.mkdir()
        (self.folder / "copy").mkdir()
        for path in (*packages, HASH_SOURCE, *HASH_SOURCE.parent.glob("*.h"), *pathlib.Path(GRAPHS).glob("graphs.[ch]")):
            shutil.copy(path, given)
        shutil.copytree(ROOT / "tests" / "consumer" / "c_only", given / "cmake")
        (given / "cmake" / "meshes").mkdir()
        shutil.copy(ROOT / "runtime" / "examples" / "cube.obj", given / "cmake" / "meshes" / "block.obj")
        (given / "touch").write_text(TOUCH)
        (given / "script").write_text(WITH_THE_PACKAGES.format(flags=" ".join((*C, "-O1")), names=" ".join(sorted(NAMES))))
        said = self.run_program("unshare", "--mount", "--propagation", "private", "bash", "-c", IN_A_COPY, "copy", str(self.folder)).stdout.decode()
        answers = {name: text.rstrip("\n") + "\n" for name, text in re.findall(r"==> (\S+) <==\n(.*?)(?=\n==> |\Z)", said, re.S)}
        expected = self.run_program(os.environ["FDCG_STEP_HASH"]).stdout.decode()
        for package in ("fdcg", "fdcg-shared"):
            self.assertEqual(PROMISED, answers["printed-" + package])
            self.assertEqual(expected, answers["hash-" + package])
        self.assertEqual("library 100, nodes 6, real 4, metres per unit 0.001\n", answers["printed-cmake"])
        self.assertEqual("/usr/share/man/man1/fdcg-compile.1.gz\n", answers["manual"])
        self.assertEqual("-10.0 /usr/lib/python3/dist-packages/fdcg/__init__.py\n", answers["python"])


if __name__ == "__main__":
    unittest.main()
